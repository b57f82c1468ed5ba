//! Bursts that keep a stale aspect alive: how little of a signal that the ground no longer sends is enough.
//!
//! Two models. [`Bursts`] lets any pattern of bursts follow the last genuine cycle, and finds the loops in which the
//! stale aspect is never lost (a state is saved at some time and met again: the loop may be run for ever); none has a
//! smaller share of bursts than the formula says. [`Schedule`] runs every regular pattern, so many cycles on and so
//! many off, at the real times of a line.

use crate::line::{Line, credited_gap};
use crate::outcome::Trace;
use crate::replay::{self, Receiving};
use crate::subject::{Claim, Subject};
use crate::train::Device;
use atc_kernel::aspect::{AspectSet, Display, Times};

mod schedule;

pub use schedule::{Schedule, ScheduleState};

/// The stale aspect.
const STALE: AspectSet = AspectSet::from_bits(1);

/// The smallest share of bursts that keeps an accepted aspect displayed for ever, as (cycles on, cycles in all): the
/// smaller of T5 in min(T4, T2+T3−T5) + T5 and T1 in T2+T3. All of them if only a continuous signal does.
pub fn duty_cycle(times: Times) -> (u16, u16) {
    let (t1, t5, expiry) = (times.operate().0, times.shortened_operate().0, times.expiry().0);
    let shortened = (t5, credited_gap(times) + t5);
    let plain = (t1, expiry.max(t1));
    let product = |a: u16, b: u16| u32::from(a) * u32::from(b);
    if product(shortened.0, plain.1) <= product(plain.0, shortened.1) { shortened } else { plain }
}

/// Any pattern of bursts after the last genuine cycle, for the device `D`.
#[derive(Clone, Debug)]
pub struct Bursts<D> {
    line: Line,
    device: D,
}

/// The device, and the loop that is being looked for.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub struct BurstState<S> {
    device: S,
    shown: Display,
    /// Genuine cycles so far, at most T1.
    genuine: u16,
    /// The state to be met again.
    saved: Option<Saved<S>>,
}

/// A saved state, and what happened since.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
struct Saved<S> {
    device: S,
    /// Cycles since, the stale aspect displayed in each.
    cycles: u16,
    /// Cycles since in which it was detected.
    bursts: u16,
}

/// What happens in a cycle of [`Bursts`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Cycle {
    detected: bool,
    save: bool,
}

impl<D: Device> Bursts<D> {
    /// The model on `line` of the device with the times `times`, the line's own or the conventional ones.
    pub fn new(line: Line, times: Times) -> Self {
        Self { line, device: D::with(times) }
    }

    /// As many states as the device has with the aspect accepted, or more: every simple loop is shorter.
    fn longest_loop(&self) -> u16 {
        let times = self.device.times();
        times.operate().0 * times.expiry().0
    }
}

impl<S: Copy + Eq> BurstState<S> {
    /// Cycles and bursts of the loop that is closed in this state, if one is.
    fn closed(&self) -> Option<(u16, u16)> {
        self.saved
            .filter(|saved| saved.cycles > 0 && saved.device == self.device)
            .map(|saved| (saved.cycles, saved.bursts))
    }
}

impl<D: Device> Subject for Bursts<D> {
    type State = BurstState<D::State>;
    type Action = Cycle;

    fn initial(&self) -> Vec<Self::State> {
        let device = self.device.initial();
        vec![BurstState { device, shown: Display::NOTHING, genuine: 0, saved: None }]
    }

    fn actions(&self, state: &Self::State, actions: &mut Vec<Cycle>) {
        if state.genuine < self.device.times().operate().0 {
            actions.push(Cycle { detected: true, save: false });
            return;
        }
        for detected in [false, true] {
            actions.push(Cycle { detected, save: false });
            if state.saved.is_none() && state.shown != Display::NOTHING {
                actions.push(Cycle { detected, save: true });
            }
        }
    }

    fn next(&self, state: &Self::State, cycle: &Cycle) -> Option<Self::State> {
        let t1 = self.device.times().operate().0;
        let (device, shown) = self.device.step(state.device, self.detected(state, cycle));
        let genuine = (state.genuine + 1).min(t1);
        let started = if cycle.save { Some(Saved { device: state.device, cycles: 0, bursts: 0 }) } else { state.saved };
        let saved = match started {
            None => None,
            // A closed loop need not be run again, nor one that the display does not survive.
            Some(_) if state.closed().is_some() || shown == Display::NOTHING => return None,
            Some(saved) if saved.cycles >= self.longest_loop() => return None,
            Some(saved) => {
                let bursts = saved.bursts + u16::from(cycle.detected);
                Some(Saved { cycles: saved.cycles + 1, bursts, ..saved })
            }
        };
        Some(BurstState { device, shown, genuine, saved })
    }

    fn claims(&self) -> Vec<Claim<Self>> {
        let (on, all) = duty_cycle(self.device.times());
        let off = all - on;
        vec![
            Claim::<Self>::always("valid", "the device's state keeps its invariant", |m, s| {
                m.device.is_valid(&s.device)
            }),
            Claim::<Self>::hazard(
                "kept-for-ever",
                format!(
                    "bursts of {on} cycle{} with {off} cycles between them keep an aspect displayed for ever that the \
                     ground does not send: {}",
                    if on == 1 { "" } else { "s" },
                    percent(on, all),
                ),
                &["no-stale-bursts", "spaced-bursts"],
                |m, s| s.closed().is_some_and(|(cycles, bursts)| (bursts, cycles) == duty_cycle(m.device.times())),
            ),
            Claim::<Self>::always(
                "no-smaller-share",
                format!("no pattern of bursts with a share under {on}/{all} keeps it displayed for ever"),
                |m, s| {
                    let (on, all) = duty_cycle(m.device.times());
                    s.closed().is_none_or(|(cycles, bursts)| {
                        u32::from(bursts) * u32::from(all) >= u32::from(on) * u32::from(cycles)
                    })
                },
            ),
            Claim::<Self>::sometimes("lost", "the stale aspect is lost when the bursts are too few", |m, s| {
                s.genuine >= m.device.times().operate().0 && s.shown == Display::NOTHING
            }),
        ]
    }

    fn parameters(&self) -> String {
        self.line().describe(self.aspects())
    }

    fn trace(&self, path: &[(Self::State, Option<Self::Action>)]) -> Trace {
        replay::trace(self, path)
    }
}

impl<D: Device> Receiving for Bursts<D> {
    fn line(&self) -> Line {
        self.line
    }

    fn aspects(&self) -> usize {
        1
    }

    fn detected(&self, _: &Self::State, cycle: &Cycle) -> AspectSet {
        if cycle.detected { STALE } else { AspectSet::EMPTY }
    }

    fn sent(&self, state: &Self::State, _: &Cycle) -> Option<AspectSet> {
        Some(if state.genuine < self.device.times().operate().0 { STALE } else { AspectSet::EMPTY })
    }

    fn loop_length(&self, last: &Self::State) -> Option<usize> {
        last.closed().map(|(cycles, _)| usize::from(cycles))
    }
}

/// `on` of `all` in per cent, and in words.
fn percent(on: u16, all: u16) -> String {
    let tenths = (u32::from(on) * 1000 + u32::from(all) / 2) / u32::from(all.max(1));
    format!("{}.{} % of the time", tenths / 10, tenths % 10)
}
