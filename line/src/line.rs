//! A line: its file, read and checked, with what follows from it.

use std::cmp::Ordering;
use std::fmt;
use std::path::Path;

use atc_kernel::aspect::{AspectTable, Times};
use atc_kernel::code::CodeTable;
use atc_kernel::distance::Metres;
use atc_kernel::pattern::Deceleration;
use atc_kernel::position::Position;
use atc_kernel::supervision::Supervision;
use atc_layout::lives::TrainLives;

use crate::blocks::{self, Detection};
use crate::budget::{self, Budget};
use crate::check::{DataCheck, Finding, Outcome};
use crate::code::{self, Names, Pair};
use crate::decimal::{given, list};
use crate::figures::{Derived, LineBlock, LineSection, LineTime};
use crate::form::{self, File};
use crate::kmh::fixed;
use crate::places::Places;
use crate::position::{self, Calibration};
use crate::refusal::{self, Refusal};
use crate::rule::Rule;
use crate::seam::{Borders, Station, Telegram};
use crate::signal::{self, Signal};
use crate::{aspect, seam, supervision};

/// A rule that a file breaks, so that there is no line.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Problem {
    /// The rule.
    pub rule: Rule,
    /// File, line and column; the file alone if it stands nowhere.
    pub at: String,
    /// What is wrong, and what would be right.
    pub what: String,
}

impl fmt::Display for Problem {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.rule {
            Rule::Form | Rule::Range => write!(f, "{}: {}", self.at, self.what),
            rule => write!(f, "{}: rule {} is broken: {}", self.at, rule.id(), self.what),
        }
    }
}

/// Everything that keeps a file from being a line: never empty where it is an error.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Problems(pub Vec<Problem>);

impl Problems {
    /// Whether the file, or one that it names, cannot be read as what it should be: no rule on its values was looked at.
    pub fn is_unreadable(&self) -> bool {
        self.0.iter().any(|one| one.rule == Rule::Form)
    }
}

impl fmt::Display for Problems {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let all: Vec<_> = self.0.iter().map(Problem::to_string).collect();
        f.write_str(&all.join("\n"))
    }
}

impl std::error::Error for Problems {}

/// What is true of every train of a line.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Train {
    /// The length of the longest one.
    pub longest: Metres,
    /// The brake that every one has at least on the level.
    pub brake: Deceleration,
    /// The longest for which one may not be detected where it stands, in ms.
    pub shunt_loss_ms: u32,
}

/// A line whose own parameters the kernel accepts. What its parts count on of each other is held against each other by [`Line::checks`].
#[derive(Clone, Debug)]
pub struct Line {
    name: String,
    aspect: aspect::Config,
    times: Times,
    table: AspectTable,
    supervision: Supervision,
    detection: Option<Detection>,
    signal: Option<Signal>,
    position: Option<Calibration>,
    codes: Option<(CodeTable, Vec<Pair>)>,
    train: Option<Train>,
    budget: Budget,
    stations: Vec<Station>,
    borders: Borders,
    telegrams: Vec<Telegram>,
    places: Places,
}

/// Reads a line's file, and the layouts that it names.
///
/// # Errors
/// The file cannot be read, or as [`parse`].
pub fn read(path: &Path) -> Result<Line, Problems> {
    let name = path.display().to_string();
    let unread = |error| {
        Problems(vec![Problem { rule: Rule::Form, at: name.clone(), what: format!("cannot be read: {error}") }])
    };
    let text = std::fs::read_to_string(path).map_err(unread)?;
    parse(&name, &text, path.parent().unwrap_or(Path::new("")))
}

/// The line that a text in TOML describes. `source` stands in front of what is wrong with it; layouts are named relative to `folder`.
///
/// # Errors
/// The first place where it is not of the form of a line; a layout that cannot be read; the first broken rule of each table.
pub fn parse(source: &str, text: &str, folder: &Path) -> Result<Line, Problems> {
    let places = Places::of(source, text);
    let file: File = toml::from_str(text).map_err(|error| {
        let at = error
            .span()
            .map_or_else(|| source.to_owned(), |span| places.span(&(span.start..span.end.max(span.start + 1))));
        Problems(vec![Problem { rule: Rule::Form, at, what: error.message().replace('\n', " ") }])
    })?;
    Reader { places, problems: Vec::new() }.line(&file, folder)
}

/// Collects the first broken rule of each table.
struct Reader {
    places: Places,
    problems: Vec<Problem>,
}

impl Reader {
    /// Keeps what is right; notes what is refused, whose field is a path in the file.
    fn keep<T>(&mut self, result: Result<T, Refusal>) -> Option<T> {
        self.keep_in(str::to_owned, result)
    }

    /// The same where `path` makes a path in the file of the name of a field.
    fn keep_in<T>(&mut self, path: impl Fn(&str) -> String, result: Result<T, Refusal>) -> Option<T> {
        let Refusal { rule, field, what } = match result {
            Ok(right) => return Some(right),
            Err(refusal) => refusal,
        };
        let problem = Problem { rule, at: self.places.at(&path(&field)), what };
        // A cycle or a table that several groups use is told once.
        if !self.problems.iter().any(|one| one.at == problem.at) {
            self.problems.push(problem);
        }
        None
    }

    fn line(mut self, file: &File, folder: &Path) -> Result<Line, Problems> {
        let aspect = self.keep(aspects(file));
        let name = file.name.trim().to_owned();
        if name.is_empty() {
            self.keep::<()>(Err(Refusal::new(Rule::Form, "name", "the line has no name")));
        }
        let in_times = |field: &str| {
            let own = field == "cycle_ms" || field.starts_with("aspects_km_h");
            if own { field.to_owned() } else { format!("times.{field}") }
        };
        let times = aspect.as_ref().and_then(|aspect| self.keep_in(in_times, aspect.times()));
        let table = aspect.as_ref().and_then(|aspect| self.keep_in(in_times, aspect.table()));
        let supervision = self.keep_in(|field| format!("supervision.{field}"), supervised(&file.supervision));
        let detection = self.keep(blocks::checked(file.cycle_ms, file.detection.as_ref(), &file.blocks));
        let aspects = aspect.as_ref().map_or(&[][..], |aspect| &aspect.aspects_km_h);
        let signal = self.keep(signal::checked(file.cycle_ms, aspects, file.signal.as_ref(), &file.sections));
        let position = file.position.as_ref();
        let position = position.map(|position| self.keep_in(|field| format!("position.{field}"), positioned(position)));
        let codes = file.codes.as_ref().map(|codes| self.codes(codes));
        let train = file.train.as_ref().map(|train| self.train(train));
        let budget = self.keep(budget::checked(file.budget.as_ref()));
        let stations = self.stations(file, folder);
        let borders = self.keep(Borders::of(&file.borders)).unwrap_or_default();
        let telegrams = file.telegrams.iter().map(Telegram::of).collect();
        if !self.problems.is_empty() {
            return Err(Problems(self.problems));
        }
        let all = (aspect, times, table, supervision, detection, signal, budget);
        let (Some(aspect), Some(times), Some(table), Some(supervision), Some(detection), Some(signal), Some(budget)) =
            all
        else {
            return Err(Problems(self.problems));
        };
        let longest = signal.as_ref().and_then(Signal::longest);
        let position = position.flatten().map(|position| Calibration::new(position, longest));
        Ok(Line {
            name,
            aspect,
            times,
            table,
            supervision,
            detection,
            signal,
            position,
            codes: codes.flatten(),
            train: train.flatten(),
            budget,
            stations,
            borders,
            telegrams,
            places: self.places,
        })
    }

    fn codes(&mut self, given: &form::Codes) -> Option<(CodeTable, Vec<Pair>)> {
        let pair = |one: &form::Pair| Pair { main_hz: one.main_hz, sub_hz: one.sub_hz, speed_km_h: one.speed_km_h };
        let pairs: Vec<_> = given.pairs.iter().map(pair).collect();
        let names = Names { codes: "codes.pairs", tolerance_hz: "codes.tolerance_hz" };
        self.keep(code::table(names, given.tolerance_hz, &pairs)).map(|table| (table, pairs))
    }

    fn train(&mut self, given: &form::Train) -> Option<Train> {
        let brake = refusal::brake("brake_mm_s2", given.brake_mm_s2);
        let brake = self.keep_in(|field| format!("train.{field}"), brake)?;
        let longest = if given.longest_m == 0 {
            Err(Refusal::new(Rule::Range, "train.longest_m", "longest_m is 0 m; a train is 1 to 65535 m long"))
        } else {
            Ok(Metres(given.longest_m))
        };
        Some(Train { longest: self.keep(longest)?, brake, shunt_loss_ms: given.shunt_loss_ms })
    }

    fn stations(&mut self, file: &File, folder: &Path) -> Vec<Station> {
        let mut stations = Vec::new();
        for (number, one) in file.stations.iter().enumerate() {
            let path = format!("station[{number}].code_speeds_km_h");
            let speeds = one.code_speeds_km_h.as_ref().map(|speeds| list(&path, speeds)).transpose();
            let speeds = self.keep(speeds).flatten();
            match Station::read(one, speeds, folder) {
                Ok(station) => stations.push(station),
                Err(unreadable) => {
                    let what = format!(
                        "the layout of the station cannot be read: {}",
                        unreadable.to_string().replace('\n', ". ")
                    );
                    self.keep::<()>(Err(Refusal::new(Rule::Form, format!("station[{number}].file"), what)));
                }
            }
        }
        stations
    }
}

fn aspects(file: &File) -> Result<aspect::Config, Refusal> {
    Ok(aspect::Config {
        cycle_ms: file.cycle_ms,
        aspects_km_h: list("aspects_km_h", &file.aspects_km_h)?,
        operate_ms: file.times.operate_ms,
        recovery_ms: file.times.recovery_ms,
        mask_ms: file.times.mask_ms,
        interruption_ms: file.times.interruption_ms,
        shortened_operate_ms: file.times.shortened_operate_ms,
    })
}

fn supervised(file: &form::Supervision) -> Result<Supervision, Refusal> {
    let usual = supervision::Config::default();
    let speed = |field, value: Option<f64>, usual| value.map_or(Ok(usual), |value| given(field, value));
    let config = supervision::Config {
        maximum_km_h: speed("maximum_km_h", file.maximum_km_h, usual.maximum_km_h)?,
        release_margin_km_h: speed("release_margin_km_h", file.release_margin_km_h, usual.release_margin_km_h)?,
    };
    config.supervision()
}

fn positioned(file: &form::Position) -> Result<Position, Refusal> {
    let correction_db = match file.correction_db {
        Some([least, most]) => [given("correction_db[0]", least)?, given("correction_db[1]", most)?],
        None => Default::default(),
    };
    let config = position::Config {
        table: position::TableConfig {
            spacing_m: given("spacing_m", file.spacing_m)?,
            lowest_db: list("lowest_db", &file.lowest_db)?,
            highest_db: list("highest_db", &file.highest_db)?,
        },
        tolerance_db: given("tolerance_db", file.tolerance_db)?,
        floor_db: given("floor_db", file.floor_db)?,
        correction_db,
    };
    config.position_named("")
}

/// What the line is, for who uses it.
impl Line {
    /// Its name.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// One logic cycle, the aspects and the times as the file gives them.
    pub const fn aspect(&self) -> &aspect::Config {
        &self.aspect
    }

    /// The times of aspect acceptance.
    pub const fn times(&self) -> Times {
        self.times
    }

    /// The aspects.
    pub const fn table(&self) -> &AspectTable {
        &self.table
    }

    /// The parameters of speed supervision.
    pub const fn supervision(&self) -> Supervision {
        self.supervision
    }

    /// The counted blocks, if there are any.
    pub const fn detection(&self) -> Option<&Detection> {
        self.detection.as_ref()
    }

    /// The telegrams, if it sends any.
    pub const fn signal(&self) -> Option<&Signal> {
        self.signal.as_ref()
    }

    /// The attenuation table, if there is one.
    pub const fn position(&self) -> Option<&Calibration> {
        self.position.as_ref()
    }

    /// The code table, if the file gives one.
    pub fn codes(&self) -> Option<&CodeTable> {
        self.codes.as_ref().map(|(table, _)| table)
    }

    /// The pairs of code frequencies, if the file gives them.
    pub fn code_pairs(&self) -> &[Pair] {
        self.codes.as_ref().map_or(&[], |(_, pairs)| pairs)
    }

    /// The levels of the train control signal.
    pub const fn budget(&self) -> &Budget {
        &self.budget
    }

    /// What is true of every train, if the file says it.
    pub const fn train(&self) -> Option<Train> {
        self.train
    }

    /// The stations, in the order of the file.
    pub fn stations(&self) -> &[Station] {
        &self.stations
    }

    /// The borders.
    pub const fn borders(&self) -> &Borders {
        &self.borders
    }

    /// The section numbers that are sent in circuits of stations.
    pub fn telegrams(&self) -> &[Telegram] {
        &self.telegrams
    }

    /// What its trains do with telegrams and codes, if it sends telegrams.
    pub fn lives(&self) -> Option<TrainLives> {
        let code_ms = self.ms(self.times.expiry().0);
        self.signal.as_ref().map(|signal| TrainLives { code_way_ms: signal.code_way_ms(), code_ms, ..signal.lives() })
    }

    /// Its file, as the user named it.
    pub fn source(&self) -> &str {
        self.places.name()
    }

    /// Where the values stand in its file.
    pub const fn places(&self) -> &Places {
        &self.places
    }

    /// Its blocks, for a case.
    pub fn blocks(&self) -> Vec<LineBlock> {
        self.detection.as_ref().map_or_else(Vec::new, Detection::blocks)
    }

    /// Its sections, for a case.
    pub fn sections(&self) -> Vec<LineSection> {
        self.signal.as_ref().map_or_else(Vec::new, Signal::sections)
    }
}

/// What follows from it.
impl Line {
    fn ms(&self, ticks: u16) -> u64 {
        u64::from(ticks) * u64::from(self.aspect.cycle_ms)
    }

    /// The five times, as they are kept.
    pub fn times_kept(&self) -> Vec<LineTime> {
        let (times, asked) = (self.times, &self.aspect);
        [
            ("T1", "operate time", asked.operate_ms, times.operate().0),
            ("T2", "recovery time", asked.recovery_ms, times.recovery().0),
            ("T3", "no-signal mask time", asked.mask_ms, times.expiry().0 - times.recovery().0),
            ("T4", "interruption limit", asked.interruption_ms, times.interruption().0),
            ("T5", "shortened operate time", asked.shortened_operate_ms, times.shortened_operate().0),
        ]
        .map(|(symbol, name, asked_ms, ticks)| self.time(symbol, name, asked_ms, ticks))
        .into()
    }

    fn time(&self, symbol: &str, name: &str, asked_ms: u32, ticks: u16) -> LineTime {
        let (kept_ms, cycle) = (self.ms(ticks), u64::from(self.aspect.cycle_ms));
        let lost = u64::from(asked_ms).saturating_sub(kept_ms);
        let rounding = match kept_ms.cmp(&u64::from(asked_ms)) {
            Ordering::Equal => "exact",
            Ordering::Greater => "up",
            Ordering::Less if symbol == "T4" && (lost >= cycle || ticks + 1 == self.times.expiry().0) => {
                "limited to T2 + T3 less one cycle (TIME-3)"
            }
            Ordering::Less => "down",
        };
        LineTime {
            symbol: symbol.to_owned(),
            name: name.to_owned(),
            asked_ms,
            ticks,
            kept_ms,
            rounding: rounding.to_owned(),
        }
    }

    /// What follows from the parameters.
    pub fn derived(&self) -> Vec<Derived> {
        let (new, old) = (self.times, self.times.conventional());
        let span = |ticks: u16| format!("{} ms ({ticks} cycles)", self.ms(ticks));
        let row = Derived::row;
        let gain = new.tolerated_interruption().0 - old.tolerated_interruption().0;
        let mut rows = vec![
            row(
                "Longest interruption without a needless stop",
                span(new.tolerated_interruption().0),
                "largest g ≤ T4 with g + T5 ≤ T2 + T3, or g with g + T1 ≤ T2 + T3",
                "T-ACC-4",
            ),
            row(
                "The same, conventional device",
                span(old.tolerated_interruption().0),
                "largest g with g + T1 ≤ T2 + T3",
                "T-ACC-4",
            ),
            row("Gained by the shortened operate time", span(gain), "the difference", "T-ACC-4"),
            row(
                "An aspect that is no longer heard is displayed for less than",
                span(new.expiry().0),
                "T2 + T3",
                "T-ACC-3",
            ),
            row("Total silence ends in stop within", span(new.expiry().0), "T2 + T3", "T-ACC-3"),
        ];
        for (name, times) in [("new", new), ("conventional", old)] {
            let rest = times.expiry().0.saturating_sub(times.shortened_operate().0);
            let gap = if name == "new" { rest.min(times.interruption().0) } else { rest };
            let on = times.shortened_operate().0;
            rows.push(row(
                &format!("Bursts that could keep a stale aspect displayed for ever, {name} device"),
                if gap == 0 {
                    "only without a gap".to_owned()
                } else {
                    let share = f64::from(on) * 100.0 / (f64::from(on) + f64::from(gap));
                    format!("{} ms in every {} ms ({share:.1} %)", self.ms(on), self.ms(on) + self.ms(gap))
                },
                if name == "new" { "T5 in T5 + min(T4, T2 + T3 − T5)" } else { "T1 in T2 + T3" },
                "model burst-loops",
            ));
        }
        rows.push(row(
            "Speed supervision",
            format!(
                "brake above the permitted speed; release margin {} km/h; implausible above {} km/h",
                fixed(self.supervision.margin()),
                fixed(self.supervision.maximum())
            ),
            "",
            "SUP-1, SUP-2",
        ));
        rows.extend(self.detection.iter().flat_map(Detection::derived));
        rows.extend(self.signal.iter().flat_map(Signal::derived));
        rows.extend(self.position.iter().flat_map(Calibration::derived));
        rows
    }

    /// What the user should look at.
    pub fn notes(&self) -> Vec<String> {
        let times = self.times;
        let mut notes = Vec::new();
        let survives = times.interruption().0 + times.shortened_operate().0 <= times.expiry().0;
        if !survives {
            notes.push(format!(
                "An interruption of exactly T4 ({} ms) still earns the shortened operate time, but the display lapses for \
                 {} ms before the aspect returns, as T4 + T5 exceeds T2 + T3.",
                self.ms(times.interruption().0),
                self.ms(times.interruption().0 + times.shortened_operate().0 - times.expiry().0)
            ));
        }
        if times.tolerated_interruption() == times.conventional().tolerated_interruption() {
            notes.push("The shortened operate time gains nothing with these times: T4 is too short.".to_owned());
        }
        if self.aspect.interruption_ms > 1000 {
            notes.push("T4 is above 1000 ms, the most that the patent names.".to_owned());
        }
        if self.table.speeds().last().is_some_and(|top| *top > self.supervision.maximum()) {
            notes.push(
                "The highest aspect permits more than the highest plausible speed: at that speed the emergency brake acts."
                    .to_owned(),
            );
        }
        notes.extend(self.detection.iter().flat_map(Detection::notes));
        notes.extend(self.signal.iter().flat_map(Signal::notes));
        notes.extend(self.position.iter().flat_map(Calibration::notes));
        notes
    }

    /// Every rule, with what it came to.
    pub fn checks(&self) -> Vec<DataCheck> {
        let met = |rule, scope: String| DataCheck::new(rule, scope, Outcome::Met);
        let mut checks = vec![
            met(Rule::Time2, "5 times".to_owned()),
            self.rounding(),
            met(Rule::Time4, format!("{} aspects", self.table.speeds().len())),
            met(Rule::Sup3, "2 speeds".to_owned()),
        ];
        checks.extend(self.detection.iter().flat_map(Detection::checks));
        checks.extend(self.signal.iter().flat_map(Signal::checks));
        checks.extend(self.position.iter().flat_map(Calibration::checks));
        let codes = self.codes.iter();
        checks.extend(codes.flat_map(|(table, pairs)| code::checks(&self.places, table, pairs, &self.table)));
        checks.extend(seam::checks(self));
        checks
    }

    /// TIME-1, computed again from what was kept.
    fn rounding(&self) -> DataCheck {
        let times = self.times;
        let mask = times.expiry().0 - times.recovery().0;
        let asked = &self.aspect;
        let cycle = u64::from(asked.cycle_ms);
        let up = |asked: u64, kept: u64| kept >= asked && kept < asked + cycle;
        let down = |asked: u64, kept: u64| kept <= asked && kept + cycle > asked;
        // T4 may also be limited by TIME-3.
        let limited = |asked: u64, kept: u64| kept <= asked;
        let broken = [
            ("operate_ms", asked.operate_ms, times.operate().0, &up as &dyn Fn(u64, u64) -> bool),
            ("shortened_operate_ms", asked.shortened_operate_ms, times.shortened_operate().0, &up),
            ("recovery_ms", asked.recovery_ms, times.recovery().0, &down),
            ("mask_ms", asked.mask_ms, mask, &down),
            ("interruption_ms", asked.interruption_ms, times.interruption().0, &limited),
        ]
        .into_iter()
        .filter(|(_, asked, ticks, right)| !right(u64::from(*asked), self.ms(*ticks)))
        .map(|(field, asked, ticks, _)| {
            let at = self.places.at(&format!("times.{field}"));
            let what = format!("{field} is {asked} ms, and {} ms are kept", self.ms(ticks));
            Finding { at, against: None, what, right: String::new() }
        })
        .collect();
        DataCheck::new(Rule::Time1, "5 times", Outcome::of(broken))
    }

    /// Whether nothing speaks against the line: every rule is met, or there is nothing that it is about.
    pub fn is_sound(&self) -> bool {
        self.checks().iter().all(|check| check.outcome.holds())
    }
}
