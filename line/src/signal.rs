//! Telegrams and the permitted speed of a line: times, counters, what is assumed, and its sections. Tables `[signal]` and
//! `[[section]]`.

use atc_kernel::distance::Metres;
use atc_kernel::pattern::pattern;
use atc_kernel::permitted::{Permitted, Settings};
use atc_kernel::speed::KmhTenths;
use atc_kernel::time::{Millis, Ticks};
use atc_layout::lives::TrainLives;

use crate::check::{DataCheck, Outcome};
use crate::decimal::{given as decimal, list};
use crate::figures::{Derived, LineSection};
use crate::form;
use crate::kmh::{Kmh, fixed};
use crate::permitted::{self, Config, rank};
use crate::refusal::{Refusal, gradient};
use crate::rule::Rule;

/// The checked parameters.
#[derive(Clone, Debug)]
pub struct Signal {
    cycle: Millis,
    permitted: Permitted,
    frame: u64,
    delay: u64,
    code_way: u64,
    reaction: u64,
    release: u64,
    lead: u64,
    heard_beyond: Metres,
    sections: Vec<LineSection>,
    limits: Vec<KmhTenths>,
}

/// Checks; none if the line sends no telegrams. `aspects`: the speeds where the table gives none. A refusal's field is a path in the file.
///
/// # Errors
/// The first rule that is broken.
pub(crate) fn checked(
    cycle_ms: u32,
    aspects: &[Kmh],
    signal: Option<&form::Signal>,
    sections: &[form::Section],
) -> Result<Option<Signal>, Refusal> {
    let Some(given) = signal else {
        return match sections {
            [] => Ok(None),
            _ => Err(Refusal::new(Rule::Form, "section[0].number", "there is a [[section]] and no [signal]")),
        };
    };
    let speeds_km_h = match &given.speeds_km_h {
        Some(speeds) => list("signal.speeds_km_h", speeds)?,
        None => aspects.to_vec(),
    };
    let config = Config {
        cycle_ms,
        speeds_km_h,
        lowest_limit_km_h: decimal("signal.lowest_limit_km_h", given.lowest_limit_km_h)?,
        brake_mm_s2: given.brake_mm_s2,
        worst_gradient_permille: given.worst_gradient_permille,
        margin_m: given.margin_m,
        fresh_ms: given.fresh_ms,
        life_ms: given.life_ms,
        fixed_life_ms: given.fixed_life_ms,
        window: given.window,
        run: given.run,
        memory_ms: given.memory_ms,
    };
    let permitted = config.permitted().map_err(|refusal| {
        let field = if refusal.field.starts_with("speeds_km_h") && given.speeds_km_h.is_none() {
            refusal.field.replacen("speeds_km_h", "aspects_km_h", 1)
        } else if refusal.field == "cycle_ms" {
            refusal.field
        } else {
            format!("signal.{}", refusal.field)
        };
        Refusal { field, ..refusal }
    })?;
    let (sections, limits) = described(permitted.settings(), sections)?;
    let signal = Signal {
        cycle: Millis(cycle_ms),
        permitted,
        frame: given.frame_ms.into(),
        delay: given.delay_ms.into(),
        code_way: given.code_way_ms.into(),
        reaction: given.reaction_ms.into(),
        release: given.release_ms.into(),
        lead: given.restriction_lead_ms.into(),
        heard_beyond: Metres(given.heard_beyond_exit_m),
        sections,
        limits,
    };
    signal.check()?;
    Ok(Some(signal))
}

/// The sections, each with its limit, held against what is assumed until a sub telegram is heard.
fn described(settings: &Settings, given: &[form::Section]) -> Result<(Vec<LineSection>, Vec<KmhTenths>), Refusal> {
    let (mut sections, mut limits): (Vec<LineSection>, Vec<KmhTenths>) = (Vec::new(), Vec::new());
    for (place, one) in given.iter().enumerate() {
        let number = one.number;
        let refused = |rule, field: &str, what: String| {
            Err(Refusal::new(rule, format!("section[{place}].{field}"), format!("section {number}: {what}")))
        };
        if sections.iter().any(|other| other.number == number) {
            return refused(
                Rule::SectionTwice,
                "number",
                "it is there twice; a number must name one section".to_owned(),
            );
        }
        if one.length_m == 0 {
            return refused(Rule::Tel4, "length_m", "it has no length; length_m must be 1 or more".to_owned());
        }
        let gradient = match gradient("gradient_permille", one.gradient_permille) {
            Ok(gradient) => gradient,
            Err(Refusal { rule, what, .. }) => return refused(rule, "gradient_permille", what),
        };
        if gradient < settings.worst {
            let what = format!(
                "it falls more than the worst gradient that is assumed ({} ‰); it is {} ‰",
                settings.worst.0, gradient.0
            );
            return refused(Rule::Per5, "gradient_permille", what);
        }
        let speed: Kmh = decimal(&format!("section[{place}].limit_km_h"), one.limit_km_h)?;
        let Some(limit) = rank(&settings.speeds, speed) else {
            let what = format!(
                "limit_km_h is {speed} km/h; it must be a speed of the table: {} km/h",
                permitted::list(&settings.speeds)
            );
            return refused(Rule::Per7, "limit_km_h", what);
        };
        if limit < settings.lowest {
            let lowest = settings.speeds.speed(settings.lowest).map(Kmh::from).unwrap_or_default();
            let what = format!("its limit is under the lowest one that is assumed ({lowest} km/h); it is {speed} km/h");
            return refused(Rule::Per5, "limit_km_h", what);
        }
        limits.extend(settings.speeds.speed(limit));
        sections.push(LineSection {
            number,
            length_m: one.length_m,
            gradient_permille: gradient.0,
            limit_km_h: f64::from(speed.0) / 10.0,
        });
    }
    Ok((sections, limits))
}

impl Signal {
    /// The rules on times and distances that the kernel's constructors do not know.
    fn check(&self) -> Result<(), Refusal> {
        let refused = |rule, field: &str, what: String| Err(Refusal::new(rule, format!("signal.{field}"), what));
        let settings = self.permitted.settings();
        let memory = self.ms(settings.sequence.memory());
        let (period, reaction) = (self.period(), self.reaction);
        if period == 0 {
            return refused(Rule::Tel7, "frame_ms", "frame_ms is 0; a telegram takes time to send".to_owned());
        }
        if memory <= period {
            let what = format!(
                "the memory must exceed the time from one telegram of a direction to the next ({period} ms: both directions are sent in \
                 turn), or none is ever used; it is {memory} ms"
            );
            return refused(Rule::Tel7, "memory_ms", what);
        }
        let parts = |life: Ticks| {
            format!(
                "content taken ahead {period} ms, its way {} ms, its life {} ms, the reaction {reaction} ms",
                self.delay,
                self.past(life)
            )
        };
        if self.release < self.obeyed() {
            let what = format!(
                "a withdrawn stretch must stay free for {} ms ({}); it is {} ms",
                self.obeyed(),
                parts(settings.life),
                self.release
            );
            return refused(Rule::Per8, "release_ms", what);
        }
        if self.lead < self.believed() {
            let what = format!(
                "a restriction must be sent {} ms before it is relied on ({}); it is {} ms",
                self.believed(),
                parts(settings.fixed_life),
                self.lead
            );
            return refused(Rule::Per8, "restriction_lead_ms", what);
        }
        if u64::from(settings.margin.0) < self.least_margin() {
            let what = format!(
                "the margin must be at least {} m ({} m in which the section behind is still heard, and what the train runs in {} ms at \
                 the highest speed); it is {} m",
                self.least_margin(),
                self.heard_beyond.0,
                self.delay,
                settings.margin.0
            );
            return refused(Rule::Per4, "margin_m", what);
        }
        Ok(())
    }

    /// The parameters in the kernel's form.
    pub const fn permitted(&self) -> &Permitted {
        &self.permitted
    }

    /// One telegram takes so long, ms.
    pub const fn frame_ms(&self) -> u64 {
        self.frame
    }

    /// From one telegram for a train to the next, ms: frames for both directions are sent in turn (WAY-7).
    pub(crate) const fn period(&self) -> u64 {
        2 * self.frame
    }

    /// From the last bit of a telegram in the rail to its arrival in the logic, ms.
    pub const fn delay_ms(&self) -> u64 {
        self.delay
    }

    /// From the ground's change of a code until no train's receiver names the old one any more, ms.
    pub const fn code_way_ms(&self) -> u64 {
        self.code_way
    }

    /// For how long the wayside keeps a withdrawn stretch free, in ms.
    pub const fn release_ms(&self) -> u64 {
        self.release
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
        u64::from(256 - u16::from(self.permitted.settings().sequence.window())) * self.period()
    }

    /// The most by which a telegram may be older than the last one and is known to be.
    fn reach(&self) -> u8 {
        u8::MAX - self.permitted.settings().sequence.window()
    }

    /// What a train of this line does with main telegrams. Of codes it says nothing.
    pub(crate) fn lives(&self) -> TrainLives {
        TrainLives {
            // Those of both directions are taken together, and one of them is sent after the other.
            ahead_ms: self.period(),
            way_ms: self.delay,
            life_ms: self.past(self.permitted.settings().life),
            code_way_ms: 0,
            code_ms: 0,
            reaction_ms: self.reaction,
        }
    }

    /// The longest that a train runs on a main telegram after the wayside has revoked it.
    fn obeyed(&self) -> u64 {
        self.lives().acts_ms()
    }

    /// The same for a sub telegram.
    fn believed(&self) -> u64 {
        self.period() + self.delay + self.past(self.permitted.settings().fixed_life) + self.reaction
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
        let gap = self.period().div_ceil(u64::from(self.cycle.0));
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

    /// How far beyond the end of its circuit a train hears, in metres.
    pub const fn heard_beyond(&self) -> Metres {
        self.heard_beyond
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
                format!("{} telegrams, {} ms", self.reach(), u64::from(self.reach()) * self.period()),
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
                "content taken ahead by a telegram + its way + life + reaction; the ground keeps the stretch free for longer",
                "T-PER-8",
            ),
            row(
                "A restriction is not known to every train for",
                format!("{} ms", self.believed()),
                "content taken ahead by a telegram + its way + life of a sub telegram + reaction",
                "T-PER-5",
            ),
            row(
                "Permitted 100 m before a stopping point, no sub telegram heard",
                format!("{} km/h", fixed(worst.min(settings.speeds.speed(settings.lowest).unwrap_or_default()))),
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
    pub fn checks(&self) -> Vec<DataCheck> {
        let memory = self.ms(self.permitted.settings().sequence.memory());
        let met = |rule, scope: String| DataCheck::new(rule, scope, Outcome::Met);
        let mut checks = vec![
            met(Rule::Tel7, format!("memory {memory} ms, a telegram of a direction every {} ms", self.period())),
            met(Rule::Per9, "the parameters of `[signal]`".to_owned()),
            met(
                Rule::Per8,
                format!("a withdrawn stretch stays free for {} ms, and {} ms are needed", self.release, self.obeyed()),
            ),
            met(
                Rule::Per8,
                format!("a restriction is sent {} ms ahead, and {} ms are needed", self.lead, self.believed()),
            ),
            met(
                Rule::Per4,
                format!(
                    "the margin of {} m, and {} m are needed",
                    self.permitted.settings().margin.0,
                    self.least_margin()
                ),
            ),
        ];
        if !self.sections.is_empty() {
            checks.push(met(Rule::Per5, format!("{} sections", self.sections.len())));
        }
        checks
    }
}
