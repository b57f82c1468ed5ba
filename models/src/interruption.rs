//! One aspect, alone on the line, interrupted for every length and by every glitch: T-ACC-4 as a model.
//!
//! The ghosts follow each interruption from the detections alone: how many cycles `g` lie between the loss and the
//! detection that is accepted, and whether the display failed in between.

use crate::line::Line;
use crate::outcome::Trace;
use crate::replay::{self, Receiving};
use crate::subject::{Claim, Subject};
use crate::train::{Device, Runs, Train};
use atc_kernel::aspect::{AspectSet, Display, Times};

/// The model: one aspect, and the device `D` under test.
#[derive(Clone, Debug)]
pub struct Interruption<D> {
    line: Line,
    device: D,
}

/// Where a device should be with the aspect.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
enum Phase {
    /// It was never accepted.
    #[default]
    Unmet,
    /// It is accepted and was not lost since.
    Held,
    /// It was accepted and is lost.
    Lost,
    /// It is accepted again in this cycle.
    Over,
}

/// One interruption as one device should see it: a ghost. Times in cycles.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
struct Loss {
    phase: Phase,
    /// Since the loss, 1 in the first cycle without it; 0 while there is none. Stops at T2+T3+1.
    since: u16,
    /// From the loss to the present detection, if there is one. Stops at T2+T3+1.
    gap: u16,
    /// The aspect was detected since the loss, and not long enough.
    glitch: bool,
    /// Nothing was displayed at some time since the loss.
    blank: bool,
}

/// The train and what its interruptions were like.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub struct State<S> {
    train: Train<S, 1>,
    runs: Runs<1>,
    new: Loss,
    conventional: Loss,
}

impl<D: Device> Interruption<D> {
    /// The model on `line`.
    pub fn new(line: Line) -> Self {
        Self { line, device: D::with(line.ticks()) }
    }

    /// The longest interruption that the conventional device tolerates: T2+T3−T1.
    fn conventional_gap(&self) -> u16 {
        let times = self.device.times();
        times.expiry().0.saturating_sub(times.operate().0)
    }
}

impl Loss {
    /// One cycle later: heard on `run` cycles up to now (stops at T1), with or without a display.
    fn step(self, times: Times, run: u16, display: Display) -> Self {
        let end = times.expiry().0 + 1;
        // An interruption that is over leaves no trace.
        let last = if self.phase == Phase::Lost { self } else { Self { phase: self.phase, ..Self::default() } };
        let gap = match run {
            0 => 0,
            1 => last.since,
            _ => last.gap,
        };
        let credited = gap <= times.interruption().0 && gap < times.expiry().0;
        let needed = if credited { times.shortened_operate() } else { times.operate() };
        let phase = match last.phase {
            Phase::Unmet if run < times.operate().0 => return Self::default(),
            Phase::Unmet => Phase::Held,
            Phase::Held | Phase::Over if run > 0 => Phase::Held,
            Phase::Lost if run > 0 && run >= needed.0 => Phase::Over,
            Phase::Held | Phase::Over | Phase::Lost => Phase::Lost,
        };
        match phase {
            Phase::Unmet | Phase::Held => Self { phase, ..Self::default() },
            Phase::Lost | Phase::Over => Self {
                phase,
                since: if phase == Phase::Lost { (last.since + 1).min(end) } else { 0 },
                gap,
                glitch: last.glitch || run == 0 && last.gap > 0,
                blank: last.blank || display == Display::NOTHING,
            },
        }
    }

    /// Whether the interruption is over in this cycle.
    fn over(self) -> bool {
        self.phase == Phase::Over
    }
}

/// Whether an interruption of `gap` cycles needs no drop: g + T5 ≤ T2 + T3 within T4, or g + T1 ≤ T2 + T3.
fn tolerated(times: Times, gap: u16) -> bool {
    let shortened = gap <= times.interruption().0 && gap + times.shortened_operate().0 <= times.expiry().0;
    shortened || gap + times.operate().0 <= times.expiry().0
}

impl<D: Device> Subject for Interruption<D> {
    type State = State<D::State>;
    type Action = AspectSet;

    fn initial(&self) -> Vec<Self::State> {
        let train = Train::initial(&self.device);
        vec![State { train, runs: Runs::NONE, new: Loss::default(), conventional: Loss::default() }]
    }

    fn actions(&self, _: &Self::State, actions: &mut Vec<AspectSet>) {
        actions.extend([AspectSet::EMPTY, AspectSet::from_bits(1)]);
    }

    fn next(&self, state: &Self::State, detected: &AspectSet) -> Option<Self::State> {
        let times = self.device.times();
        let train = state.train.step(&self.device, *detected);
        let runs = state.runs.step(times, *detected);
        let new = state.new.step(times, runs.of(0), train.shown.normative);
        let conventional = state.conventional.step(times.conventional(), runs.of(0), train.shown.conventional);
        Some(State { train, runs, new, conventional })
    }

    fn claims(&self) -> Vec<Claim<Self>> {
        let times = self.device.times();
        let (new, conventional) = (times.tolerated_interruption().0, self.conventional_gap());
        let ms = |ticks| self.line.millis(ticks);
        let mut claims = vec![
            Claim::<Self>::always("valid", "the device's state keeps its invariant", |m, s| {
                m.device.is_valid(&s.train.normative)
            }),
            Claim::<Self>::always(
                "no-drop",
                format!(
                    "an interruption of g cycles with g + T5 <= T2 + T3 and g <= T4 (or g + T1 <= T2 + T3) is bridged \
                     without a gap in the display: up to {new} cycles = {} ms",
                    ms(new)
                ),
                |m, s| !s.new.over() || !tolerated(m.device.times(), s.new.gap) || !s.new.blank,
            ),
            Claim::<Self>::always("drop", "every other interruption shows in the display before it ends", |m, s| {
                !s.new.over() || tolerated(m.device.times(), s.new.gap) || s.new.blank
            }),
            Claim::<Self>::always(
                "holds-until-expiry",
                "a lost aspect is displayed in every cycle before the one at T2+T3 from its loss",
                |m, s| {
                    let lost = s.new.since > 0 && s.new.since < m.device.times().expiry().0;
                    !lost || s.train.shown.normative != Display::NOTHING
                },
            ),
            Claim::<Self>::always("gone-at-expiry", "from T2+T3 on it is not, until it is accepted again", |m, s| {
                s.new.since < m.device.times().expiry().0 || s.train.shown.normative == Display::NOTHING
            }),
            Claim::<Self>::always(
                "conventional-no-drop",
                format!(
                    "the conventional device bridges an interruption with g + T1 <= T2 + T3: up to {conventional} cycles \
                     = {} ms",
                    ms(conventional)
                ),
                |m, s| !s.conventional.over() || s.conventional.gap > m.conventional_gap() || !s.conventional.blank,
            ),
            Claim::<Self>::always("conventional-drop", "and no other one", |m, s| {
                !s.conventional.over() || s.conventional.gap <= m.conventional_gap() || s.conventional.blank
            }),
            Claim::<Self>::sometimes(
                "longest-bridged",
                format!("an interruption of {new} cycles is bridged"),
                |m, s| s.new.over() && s.new.gap == m.device.times().tolerated_interruption().0 && !s.new.blank,
            ),
            Claim::<Self>::sometimes(
                "shortest-dropped",
                format!("an interruption of {} cycles drops the display", new + 1),
                |m, s| s.new.over() && s.new.gap == m.device.times().tolerated_interruption().0 + 1 && s.new.blank,
            ),
            Claim::<Self>::sometimes("beyond-everything", "an interruption longer than T2+T3 ends after T1", |m, s| {
                s.new.over() && s.new.gap > m.device.times().expiry().0
            }),
            Claim::<Self>::sometimes(
                "conventional-longest-bridged",
                format!("the conventional device bridges {conventional} cycles"),
                |m, s| s.conventional.over() && s.conventional.gap == m.conventional_gap() && !s.conventional.blank,
            ),
            Claim::<Self>::sometimes(
                "conventional-shortest-dropped",
                format!("the conventional device drops the display after {} cycles", conventional + 1),
                |m, s| s.conventional.over() && s.conventional.gap == m.conventional_gap() + 1 && s.conventional.blank,
            ),
        ];
        if times.shortened_operate().0 > 1 {
            claims.push(Claim::<Self>::sometimes(
                "glitch-bridged",
                "an interruption with a detection shorter than T5 in it is bridged",
                |_, s| s.new.over() && s.new.glitch && !s.new.blank,
            ));
        }
        claims
    }

    fn parameters(&self) -> String {
        self.line().describe(self.aspects())
    }

    fn trace(&self, path: &[(Self::State, Option<Self::Action>)]) -> Trace {
        replay::trace(self, path)
    }
}

impl<D: Device> Receiving for Interruption<D> {
    fn line(&self) -> Line {
        self.line
    }

    fn aspects(&self) -> usize {
        1
    }

    fn detected(&self, _: &Self::State, detected: &AspectSet) -> AspectSet {
        *detected
    }
}
