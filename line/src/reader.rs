//! Reads a line's file: each table becomes parameters of the kernel, or the first rule that it breaks.

use std::path::Path;

use atc_kernel::code::CodeTable;
use atc_kernel::distance::Metres;
use atc_kernel::position::Position;
use atc_kernel::supervision::Supervision;

use crate::border::Borders;
use crate::code::{self, Names, Pair};
use crate::decimal::{given, list};
use crate::form::{self, File};
use crate::line::{Line, Train};
use crate::places::Places;
use crate::position::{self, Calibration};
use crate::problem::{Problem, Problems};
use crate::refusal::{self, Refusal};
use crate::rule::Rule;
use crate::signal::{self, Signal};
use crate::station::Station;
use crate::telegram::Telegram;
use crate::{aspect, blocks, budget, supervision};

/// Reads a line's file, and the layouts that it names.
///
/// # Errors
/// The file cannot be read, or as [`parse`].
pub fn read(path: &Path) -> Result<Line, Problems> {
    let name = path.display().to_string();
    let text = atc_layout::text::read(path)
        .map_err(|what| Problems(vec![Problem { rule: Rule::Form, at: name.clone(), what }]))?;
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
        Problems(vec![Problem { rule: Rule::Form, at, what: atc_layout::text::in_words(error.message()) }])
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
