//! Telegrams and the permitted speed of a line: times, counters, what is assumed, and its sections. Tables `[signal]` and
//! `[[section]]`.

mod file;

pub use file::{FileSection, FileSignal};

use crate::case::{Derived, LineSection};
use crate::error::Fault;
use atc_kernel::aspect::AspectTable;
use atc_kernel::distance::Metres;
use atc_kernel::pattern::{Deceleration, pattern};
use atc_kernel::permitted::{Permitted, PermittedError, Settings};
use atc_kernel::speed::KmhTenths;
use atc_kernel::telegram::Gradient;
use atc_kernel::time::{Millis, Ticks};
use atc_layout::lives::TrainLives;
use std::ops::Range;
use toml::Spanned;

/// Where something stands in the file.
pub(crate) type At<'a> = &'a dyn Fn(Range<usize>) -> String;
/// A speed in km/h, or a fault with its place.
pub(crate) type Tenths<'a> = &'a dyn Fn(&Spanned<f64>) -> Result<KmhTenths, Fault>;

/// The checked parameters.
#[derive(Clone, Debug)]
pub struct Signal {
    cycle: Millis,
    permitted: Permitted,
    frame: u64,
    delay: u64,
    reaction: u64,
    release: u64,
    lead: u64,
    heard_beyond: Metres,
    sections: Vec<LineSection>,
    limits: Vec<KmhTenths>,
}

/// Reads and checks; none if the line sends no telegrams.
///
/// # Errors
/// The first rule that is broken, with its place.
pub(crate) fn parse(
    at: At<'_>,
    tenths: Tenths<'_>,
    cycle: Millis,
    aspects: &AspectTable,
    signal: Option<&FileSignal>,
    sections: &[FileSection],
) -> Result<Option<Signal>, Fault> {
    let Some(given) = signal else {
        return match sections {
            [] => Ok(None),
            [first, ..] => Err(Fault::new(&at(first.number.span()), "there is a [[section]] and no [signal]")),
        };
    };
    let speeds = file::speeds(at, tenths, aspects, given)?;
    let lowest = file::rank(at, tenths, &speeds, &given.lowest_limit_km_h, "PER-9", "the lowest limit")?;
    let memory = file::ticks(at, cycle, &given.memory_ms, "TEL-7", "the memory")?;
    let sequence = file::sequence(at, given, memory)?;
    let brake = Deceleration::brake(*given.brake_mm_s2.get_ref()).ok_or_else(|| {
        let text = format!("rule PAT-3 is broken: a brake is 1 to 4095 mm/s²; it is {}", given.brake_mm_s2.get_ref());
        Fault::new(&at(given.brake_mm_s2.span()), text)
    })?;
    let settings = Settings {
        speeds,
        lowest,
        brake,
        worst: Gradient(*given.worst_gradient_permille.get_ref()),
        margin: Metres(*given.margin_m.get_ref()),
        fresh: file::ticks(at, cycle, &given.fresh_ms, "PER-9", "the freshness")?,
        life: file::ticks(at, cycle, &given.life_ms, "PER-9", "the life")?,
        fixed_life: file::ticks(at, cycle, &given.fixed_life_ms, "PER-9", "the life of sub telegrams")?,
        sequence,
    };
    let permitted = Permitted::new(settings).map_err(|error| {
        let (span, rule) = match error {
            PermittedError::UnknownLimit => {
                (given.lowest_limit_km_h.span(), "the lowest limit is no speed of the table")
            }
            PermittedError::NoFreshness => {
                (given.fresh_ms.span(), "the freshness must be one cycle or more (it rounds down)")
            }
            PermittedError::LifeShorterThanFreshness => {
                (given.life_ms.span(), "the life must not be under the freshness")
            }
            PermittedError::MemoryLongerThanLife => {
                (given.memory_ms.span(), "the memory must not exceed a life, of main or sub telegrams")
            }
            PermittedError::TooLong => (given.life_ms.span(), "no time may exceed 60 000 logic cycles"),
            PermittedError::NoFixedLife => {
                (given.fixed_life_ms.span(), "the life of sub telegrams must be one cycle or more (it rounds down)")
            }
        };
        Fault::new(&at(span), format!("rule PER-9 is broken: {rule}"))
    })?;
    let (sections, limits) = file::sections(at, tenths, &settings, sections)?;
    let milliseconds = |time: &Spanned<u32>| u64::from(*time.get_ref());
    let signal = Signal {
        cycle,
        permitted,
        frame: milliseconds(&given.frame_ms),
        delay: milliseconds(&given.delay_ms),
        reaction: milliseconds(&given.reaction_ms),
        release: milliseconds(&given.release_ms),
        lead: milliseconds(&given.restriction_lead_ms),
        heard_beyond: Metres(*given.heard_beyond_exit_m.get_ref()),
        sections,
        limits,
    };
    signal.check(at, given)?;
    Ok(Some(signal))
}

impl Signal {
    /// The rules on times and distances that the kernel's constructors do not know.
    fn check(&self, at: At<'_>, file: &FileSignal) -> Result<(), Fault> {
        let fault =
            |span, rule: &str, text: String| Err(Fault::new(&at(span), format!("rule {rule} is broken: {text}")));
        let memory = self.ms(self.permitted.settings().sequence.memory());
        if self.frame == 0 {
            return fault(file.frame_ms.span(), "TEL-7", "a telegram takes time to send; frame_ms is 0".to_owned());
        }
        if memory <= self.frame {
            let text = format!(
                "the memory must exceed the time of one telegram ({} ms), or none is ever used; it is {memory} ms",
                self.frame
            );
            return fault(file.memory_ms.span(), "TEL-7", text);
        }
        if self.release < self.obeyed() {
            let text = format!(
                "a withdrawn stretch must stay free for {} ms (content taken ahead {} ms, its life {} ms, the reaction {} ms); \
                 it is {} ms",
                self.obeyed(),
                self.frame,
                self.past(self.permitted.settings().life),
                self.reaction,
                self.release
            );
            return fault(file.release_ms.span(), "PER-8", text);
        }
        if self.lead < self.believed() {
            let text = format!(
                "a restriction must be sent {} ms before it is relied on (content taken ahead {} ms, its life {} ms, the \
                 reaction {} ms); it is {} ms",
                self.believed(),
                self.frame,
                self.past(self.permitted.settings().fixed_life),
                self.reaction,
                self.lead
            );
            return fault(file.restriction_lead_ms.span(), "PER-8", text);
        }
        let margin = self.permitted.settings().margin.0;
        if u64::from(margin) < self.least_margin() {
            let text = format!(
                "the margin must be at least {} m ({} m in which the section behind is still heard, and what the train runs in {} ms at \
                 the highest speed); it is {margin} m",
                self.least_margin(),
                self.heard_beyond.0,
                self.delay
            );
            return fault(file.margin_m.span(), "PER-4", text);
        }
        Ok(())
    }

    fn ms(&self, ticks: Ticks) -> u64 {
        u64::from(ticks.0) * u64::from(self.cycle.0)
    }

    /// Until something with this life is gone: at an age of the life it still counts.
    fn past(&self, life: Ticks) -> u64 {
        self.ms(life) + u64::from(self.cycle.0)
    }

    /// A silence under this cannot take a counter round.
    fn wrap(&self) -> u64 {
        u64::from(256 - u16::from(self.permitted.settings().sequence.window())) * self.frame
    }

    /// The most by which a telegram may be older than the last one and is known to be.
    fn reach(&self) -> u8 {
        u8::MAX - self.permitted.settings().sequence.window()
    }

    /// What a train of this line does with main telegrams.
    pub fn lives(&self) -> TrainLives {
        TrainLives {
            ahead_ms: self.frame,
            life_ms: self.past(self.permitted.settings().life),
            reaction_ms: self.reaction,
        }
    }

    /// The longest that a train runs on a main telegram after the ground has thought better of it.
    fn obeyed(&self) -> u64 {
        self.lives().acts_ms()
    }

    /// The same for a sub telegram.
    fn believed(&self) -> u64 {
        self.frame + self.past(self.permitted.settings().fixed_life) + self.reaction
    }

    fn top(&self) -> KmhTenths {
        self.permitted.settings().speeds.speeds().last().copied().unwrap_or_default()
    }

    /// Metres at the highest speed, rounded up: 0.1 km/h is 1 m in 36 s.
    fn run(&self, milliseconds: u64) -> u64 {
        (u64::from(self.top().0) * milliseconds).div_ceil(36_000)
    }

    /// How many main telegrams may be lost in a row while the last one stays fresh; nothing if it does not without a loss.
    fn may_be_lost(&self) -> Option<u64> {
        let settings = self.permitted.settings();
        let gap = self.frame.div_ceil(u64::from(self.cycle.0));
        // Of age `gap` when it comes, and older by a gap for each one that is lost and the one that comes.
        let fresh = ((u64::from(settings.fresh.0) + 1) / gap).checked_sub(2)?;
        let memory = (u64::from(settings.sequence.memory().0).saturating_sub(1) / gap).checked_sub(1)?;
        Some(fresh.min(memory).min(u64::from(settings.sequence.window()) - 1))
    }

    fn least_margin(&self) -> u64 {
        u64::from(self.heard_beyond.0) + self.run(self.delay)
    }

    /// Its sections, for the case.
    pub fn sections(&self) -> Vec<LineSection> {
        self.sections.clone()
    }

    /// The length of its longest section.
    pub fn longest(&self) -> Option<u16> {
        self.sections.iter().map(|section| section.length_m).max()
    }

    /// What follows.
    pub fn derived(&self) -> Vec<Derived> {
        let row = Derived::row;
        let settings = self.permitted.settings();
        let worst = pattern(settings.brake.on(settings.worst), Metres(100));
        vec![
            row(
                "Telegrams that may be lost in a row without being missed",
                self.may_be_lost()
                    .map_or_else(|| "none: stale before the next one comes".to_owned(), |most| most.to_string()),
                "the age counts from the telegram before: at most the freshness, the memory and the window",
                "T-PER-1, T-PER-8, T-TEL-6",
            ),
            row(
                "A telegram that is late is refused, while its stream is remembered, by up to",
                format!("{} telegrams, {} ms", self.reach(), u64::from(self.reach()) * self.frame),
                "255 less the window; beyond it, after a silence and in another section: the condition counter-reach",
                "T-TEL-6",
            ),
            row(
                "A digital line without telegrams ends in stop within",
                format!("{} ms", self.past(settings.life)),
                "life, and one cycle",
                "T-PER-6",
            ),
            row(
                "A withdrawn stopping point is still obeyed for",
                format!("{} ms, {} m at the highest speed", self.obeyed(), self.run(self.obeyed())),
                "content taken ahead by a telegram + life + reaction; the ground keeps the stretch free for longer",
                "T-PER-8",
            ),
            row(
                "A restriction is not known to every train for",
                format!("{} ms", self.believed()),
                "content taken ahead by a telegram + life of a sub telegram + reaction",
                "T-PER-5",
            ),
            row(
                "Permitted 100 m before a stopping point, no sub telegram heard",
                format!("{} km/h", kmh(worst.min(settings.speeds.speed(settings.lowest).unwrap_or_default()))),
                "pattern on the worst gradient, without the margin; lowest limit",
                "T-PAT-1, T-PER-5",
            ),
        ]
    }

    /// What the user should look at.
    pub fn notes(&self) -> Vec<String> {
        let settings = self.permitted.settings();
        let mut notes = Vec::new();
        match self.may_be_lost() {
            None => notes.push(
                "Without any loss a telegram is stale before the next one comes: the freshness is too short."
                    .to_owned(),
            ),
            Some(0) => notes.push("A single main telegram that is lost is missed at once.".to_owned()),
            Some(_) => {}
        }
        let memory = self.ms(settings.sequence.memory());
        if memory >= self.wrap() {
            notes.push(format!(
                "The memory ({memory} ms) is as long as a counter takes to go round ({} ms): after such a loss a number says nothing, and \
                 only the age bounds what is used (PER-12).",
                self.wrap()
            ));
        }
        if settings.brake.on(settings.worst).mm_s2() == 0 {
            notes.push(
                "On the worst gradient the train does not slow down: nothing is permitted until a sub telegram is heard."
                    .to_owned(),
            );
        }
        if self.sections.is_empty() {
            notes.push(
                "No [[section]] is given: nobody has compared what is assumed with what sub telegrams say.".to_owned(),
            );
        }
        let pairs = self.sections.windows(2).zip(self.limits.windows(2));
        for (pair, _) in pairs.filter(|(_, limits)| limits[1] < limits[0]) {
            notes.push(format!(
                "Section {} has a lower limit than section {}: see the condition limits-reach-over-the-border.",
                pair[1].number, pair[0].number
            ));
        }
        if settings.speeds.speeds().len() > 4 {
            let number = settings.speeds.speeds().len();
            notes.push(format!(
                "Telegrams have {number} speeds; the theorems are proved with 4: see the condition four-speeds."
            ));
        }
        notes
    }

    /// The data checks that were made.
    pub fn checks(&self) -> Vec<String> {
        let memory = self.ms(self.permitted.settings().sequence.memory());
        let mut checks = vec![
            format!(
                "TEL-7: the memory of {memory} ms is longer than a telegram ({} ms), and no longer than its life",
                self.frame
            ),
            "PER-9: the parameters of the permitted speed are accepted by the kernel's constructor".to_owned(),
            format!(
                "PER-8: a withdrawn stretch stays free for {} ms, and {} ms are needed",
                self.release,
                self.obeyed()
            ),
            format!("PER-8: a restriction is sent {} ms ahead, and {} ms are needed", self.lead, self.believed()),
            format!("PER-4: the margin of {} m covers {} m", self.permitted.settings().margin.0, self.least_margin()),
        ];
        if !self.sections.is_empty() {
            let number = self.sections.len();
            checks.push(format!(
                "PER-5: no gradient and no limit of the {number} sections is worse than what is assumed"
            ));
        }
        checks
    }
}

fn kmh(speed: KmhTenths) -> String {
    format!("{}.{}", speed.0 / 10, speed.0 % 10)
}

#[cfg(test)]
#[path = "permitted_tests.rs"]
mod tests;
