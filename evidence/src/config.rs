//! The specific application: one line's parameters, checked by the kernel's own constructors, and what follows.

use crate::case::{Derived, Evidence, Kind, Line, LineTime};
use crate::detection::{self, Detection, FileBlock, FileDetection};
use crate::error::{Fault, line_of};
use crate::permitted::{self, FileSection, FileSignal, Signal};
use crate::position::{self, Calibration, FilePosition};
use atc_kernel::aspect::{AspectTable, TableError, Times, TimesError, TimesMs};
use atc_kernel::speed::KmhTenths;
use atc_kernel::supervision::{Supervision, SupervisionError};
use atc_kernel::time::{Millis, Ticks};
use atc_layout::lives::TrainLives;
use serde::Deserialize;
use toml::Spanned;

/// A line as its file gives it. Milliseconds and km/h; a speed has at most one decimal.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct File {
    name: String,
    cycle_ms: Spanned<u32>,
    aspects_km_h: Spanned<Vec<Spanned<f64>>>,
    times: FileTimes,
    #[serde(default)]
    supervision: FileSupervision,
    #[serde(default)]
    detection: Option<FileDetection>,
    #[serde(default, rename = "block")]
    blocks: Vec<FileBlock>,
    #[serde(default)]
    signal: Option<FileSignal>,
    #[serde(default, rename = "section")]
    sections: Vec<FileSection>,
    #[serde(default)]
    position: Option<FilePosition>,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
// The unit belongs to the name in the file.
#[allow(clippy::struct_field_names)]
struct FileTimes {
    operate_ms: Spanned<u32>,
    recovery_ms: Spanned<u32>,
    mask_ms: Spanned<u32>,
    interruption_ms: Spanned<u32>,
    shortened_operate_ms: Spanned<u32>,
}

#[derive(Debug, Default, Deserialize)]
#[serde(deny_unknown_fields)]
struct FileSupervision {
    maximum_km_h: Option<Spanned<f64>>,
    release_margin_km_h: Option<Spanned<f64>>,
}

/// A checked line.
#[derive(Clone, Debug)]
pub struct Checked {
    name: String,
    source: String,
    cycle: Millis,
    asked: TimesMs,
    times: Times,
    table: AspectTable,
    supervision: Supervision,
    detection: Option<Detection>,
    signal: Option<Signal>,
    position: Option<Calibration>,
}

/// The patent's example, for a case without a line of one's own.
pub const EXAMPLE: &str = include_str!("../examples/my-line.toml");

/// Reads and checks a line.
///
/// # Errors
/// The first rule that it breaks, with file, line and column.
pub fn parse(source: &str, text: &str) -> Result<Checked, Fault> {
    let at = |span: std::ops::Range<usize>| {
        let start = text[..span.start.min(text.len())].rfind('\n').map_or(0, |end| end + 1);
        format!("{source}:{}:{}", line_of(text, span.start), span.start - start + 1)
    };
    let file: File = toml::from_str(text).map_err(|error| {
        let place = error.span().map_or_else(|| source.to_owned(), &at);
        Fault::new(&place, error.message())
    })?;
    let times = &file.times;
    let cycle = Millis(*file.cycle_ms.get_ref());
    let asked = TimesMs {
        operate: Millis(*times.operate_ms.get_ref()),
        recovery: Millis(*times.recovery_ms.get_ref()),
        mask: Millis(*times.mask_ms.get_ref()),
        interruption: Millis(*times.interruption_ms.get_ref()),
        shortened_operate: Millis(*times.shortened_operate_ms.get_ref()),
    };
    let checked = Times::from_millis(cycle, asked).map_err(|error| {
        let (field, rule) = match error {
            TimesError::NoCycle => (&file.cycle_ms, "the logic cycle must be 1 ms or more"),
            TimesError::NoOperateTime => (&times.operate_ms, "T1 must be above 0"),
            TimesError::NoRecoveryTime => (&times.recovery_ms, "T2 must be one logic cycle or more (it rounds down)"),
            TimesError::NoShortenedOperateTime => (&times.shortened_operate_ms, "T5 must be above 0"),
            TimesError::ShortenedNotShorter => {
                (&times.shortened_operate_ms, "T5 must be shorter than T1 in whole logic cycles (both round up)")
            }
            TimesError::OperateTooLong => (&times.operate_ms, "T1 must not exceed 60 000 logic cycles"),
            TimesError::RecoveryAndMaskTooLong => (&times.recovery_ms, "T2 + T3 must not exceed 60 000 logic cycles"),
            TimesError::InterruptionTooLong => (&times.interruption_ms, "T4 must not exceed 60 000 logic cycles"),
        };
        Fault::new(&at(field.span()), format!("rule TIME-2 is broken: {rule}; it is {} ms", field.get_ref()))
    })?;
    let list = file.aspects_km_h.get_ref();
    let speeds = list.iter().map(|one| tenths(one, &at)).collect::<Result<Vec<_>, _>>()?;
    let table = AspectTable::new(&speeds).map_err(|error| {
        let (span, rule) = match error {
            TableError::Empty => (file.aspects_km_h.span(), "there must be at least one aspect".to_owned()),
            TableError::TooMany => {
                (file.aspects_km_h.span(), format!("at most 16 aspects; there are {}", speeds.len()))
            }
            TableError::NotRising(place) => (
                list.get(place).map_or_else(|| file.aspects_km_h.span(), Spanned::span),
                format!("the speeds must rise strictly; number {} does not exceed the one before it", place + 1),
            ),
        };
        Fault::new(&at(span), format!("rule TIME-4 is broken: {rule}"))
    })?;
    let supervision = supervision(&file, &at)?;
    let detection = detection::parse(source, &at, cycle, file.detection.as_ref(), &file.blocks)?;
    let speed = |one: &Spanned<f64>| tenths(one, &at);
    let signal = permitted::parse(&at, &speed, cycle, &table, file.signal.as_ref(), &file.sections)?;
    let position = position::parse(&at, file.position.as_ref(), signal.as_ref().and_then(Signal::longest))?;
    let name = file.name.trim().to_owned();
    if name.is_empty() {
        return Err(Fault::new(&source, "the line has no name"));
    }
    let source = source.to_owned();
    Ok(Checked { name, source, cycle, asked, times: checked, table, supervision, detection, signal, position })
}

fn supervision(file: &File, at: &dyn Fn(std::ops::Range<usize>) -> String) -> Result<Supervision, Fault> {
    let usual = Supervision::default();
    let maximum = file.supervision.maximum_km_h.as_ref();
    let margin = file.supervision.release_margin_km_h.as_ref();
    let value = |one: Option<&Spanned<f64>>, otherwise| one.map_or(Ok(otherwise), |one| tenths(one, at));
    let (top, release) = (value(maximum, usual.maximum())?, value(margin, usual.margin())?);
    Supervision::new(top, release).map_err(|error| {
        let (span, rule) = match error {
            SupervisionError::NoMaximum => (maximum, "the highest plausible speed must be above 0"),
            SupervisionError::MarginAboveMaximum => {
                (margin.or(maximum), "the release margin must not exceed the highest plausible speed")
            }
        };
        let place = span.map_or_else(String::new, |one| at(one.span()));
        Fault::new(&place, format!("rule SUP-3 is broken: {rule}"))
    })
}

/// A speed in km/h as tenths; no rounding: what cannot be kept exactly is refused.
fn tenths(speed: &Spanned<f64>, at: &dyn Fn(std::ops::Range<usize>) -> String) -> Result<KmhTenths, Fault> {
    let value = *speed.get_ref();
    let found = (0..=u16::MAX).find(|tenths| (f64::from(*tenths) / 10.0 - value).abs() < 1e-9);
    found.map(KmhTenths).ok_or_else(|| {
        Fault::new(&at(speed.span()), format!("a speed is 0 to 6553.5 km/h in steps of 0.1; it is {value}"))
    })
}

impl Checked {
    /// Its name.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// What its trains do with telegrams, if it sends any.
    pub fn lives(&self) -> Option<TrainLives> {
        self.signal.as_ref().map(Signal::lives)
    }

    /// The specific part of the case, with the verdicts of the theorems that it instantiates.
    pub fn case(&self, evidence: &[Evidence]) -> Line {
        let times = self.times;
        let rows = [
            ("T1", "operate time", self.asked.operate, times.operate().0),
            ("T2", "recovery time", self.asked.recovery, times.recovery().0),
            ("T3", "no-signal mask time", self.asked.mask, times.expiry().0 - times.recovery().0),
            ("T4", "interruption limit", self.asked.interruption, times.interruption().0),
            ("T5", "shortened operate time", self.asked.shortened_operate, times.shortened_operate().0),
        ];
        Line {
            name: self.name.clone(),
            source: self.source.clone(),
            cycle_ms: self.cycle.0,
            aspects_km_h: self.table.speeds().iter().map(|speed| f64::from(speed.0) / 10.0).collect(),
            times: rows.map(|(symbol, name, asked, ticks)| self.time(symbol, name, asked, ticks)).into(),
            blocks: self.detection.as_ref().map_or_else(Vec::new, Detection::blocks),
            sections: self.signal.as_ref().map_or_else(Vec::new, Signal::sections),
            derived: self.derived(),
            notes: self.notes(),
            theorems: evidence
                .iter()
                .filter(|one| one.kind == Kind::Harness)
                .map(|one| (one.id.clone(), one.verdict))
                .collect(),
            checks: self.checks(),
        }
    }

    fn ms(&self, ticks: u16) -> u64 {
        u64::from(ticks) * u64::from(self.cycle.0)
    }

    fn time(&self, symbol: &str, name: &str, asked: Millis, ticks: u16) -> LineTime {
        let kept = self.ms(ticks);
        let rounding = match kept.cmp(&u64::from(asked.0)) {
            std::cmp::Ordering::Equal => "exact",
            std::cmp::Ordering::Greater => "up",
            std::cmp::Ordering::Less if symbol == "T4" && u64::from(asked.0) - kept >= u64::from(self.cycle.0) => {
                "limited to T2 + T3 less one cycle (TIME-3)"
            }
            std::cmp::Ordering::Less if symbol == "T4" && ticks + 1 == self.times.expiry().0 => {
                "limited to T2 + T3 less one cycle (TIME-3)"
            }
            std::cmp::Ordering::Less => "down",
        };
        let (symbol, name, rounding) = (symbol.to_owned(), name.to_owned(), rounding.to_owned());
        LineTime { symbol, name, asked_ms: asked.0, ticks, kept_ms: kept, rounding }
    }

    fn derived(&self) -> Vec<Derived> {
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
                kmh(self.supervision.margin()),
                kmh(self.supervision.maximum())
            ),
            "",
            "SUP-1, SUP-2",
        ));
        rows.extend(self.detection.iter().flat_map(Detection::derived));
        rows.extend(self.signal.iter().flat_map(Signal::derived));
        rows.extend(self.position.iter().flat_map(Calibration::derived));
        rows
    }

    fn notes(&self) -> Vec<String> {
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
        if self.asked.interruption.0 > 1000 {
            notes.push("T4 is above 1000 ms, the most that the patent names.".to_owned());
        }
        if self.table.speeds().len() > atc_proofs::ASPECTS {
            notes.push(format!(
                "This line has {} aspects. A theorem that is proved for {} aspects is not proved for it: see the \
                 condition that carries it further.",
                self.table.speeds().len(),
                atc_proofs::ASPECTS
            ));
        }
        if u64::from(self.cycle.0) != u64::from(atc_proofs::time::CYCLE_MS) {
            notes.push(format!(
                "The rounding theorem is proved for a cycle of {} ms. For this line's cycle of {} ms the rounding of \
                 each time was computed and compared: see the data checks.",
                atc_proofs::time::CYCLE_MS,
                self.cycle.0
            ));
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

    fn checks(&self) -> Vec<String> {
        let rounds = |asked: Millis, ticks: Ticks, up: bool| {
            let (kept, asked, cycle) = (self.ms(ticks.0), u64::from(asked.0), u64::from(self.cycle.0));
            if up { kept >= asked && kept < asked + cycle } else { kept <= asked && kept + cycle > asked }
        };
        let times = self.times;
        let mask = Ticks(times.expiry().0 - times.recovery().0);
        let exact = rounds(self.asked.operate, times.operate(), true)
            && rounds(self.asked.shortened_operate, times.shortened_operate(), true)
            && rounds(self.asked.recovery, times.recovery(), false)
            && rounds(self.asked.mask, mask, false)
            && self.ms(times.interruption().0) <= u64::from(self.asked.interruption.0);
        let rounding = if exact { "rounded in the safe direction: yes" } else { "rounded in the safe direction: NO" };
        let mut checks = vec![
            "TIME-2: the times are accepted by the kernel's constructor".to_owned(),
            format!("TIME-1: T1 and T5 up, T2, T3 and T4 down by less than one cycle, {rounding}"),
            format!("TIME-4: {} aspects, strictly rising", self.table.speeds().len()),
            "SUP-3: the supervision parameters are accepted by the kernel's constructor".to_owned(),
        ];
        checks.extend(self.detection.iter().flat_map(Detection::checks));
        checks.extend(self.signal.iter().flat_map(Signal::checks));
        checks.extend(self.position.iter().flat_map(Calibration::checks));
        checks
    }

    /// Whether every data check passed.
    pub fn is_sound(&self) -> bool {
        !self.checks().iter().any(|check| check.contains("NO"))
    }
}

fn kmh(speed: KmhTenths) -> String {
    format!("{}.{}", speed.0 / 10, speed.0 % 10)
}

#[cfg(test)]
#[path = "config_tests.rs"]
pub(crate) mod tests;
