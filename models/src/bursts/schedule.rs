//! Every regular pattern of bursts, at the real times of a line.

use super::{STALE, duty_cycle, percent};
use crate::line::{Line, credited_gap};
use crate::outcome::Trace;
use crate::replay::{self, Receiving};
use crate::subject::{Claim, Subject};
use atc_kernel::Machine;
use atc_kernel::aspect::{Acceptance, AspectSet, Display, State as Kernel, Times};

/// Every regular pattern: `on` cycles of burst after `off` cycles without, for ever.
#[derive(Clone, Debug)]
pub struct Schedule {
    line: Line,
}

/// One pattern under way.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub struct ScheduleState {
    on: u16,
    off: u16,
    /// Genuine cycles so far, at most T1.
    genuine: u16,
    /// The place in the pattern.
    place: u16,
    /// Cycles of the pattern so far, at most the deadline.
    cycles: u16,
    normative: Kernel<1>,
    conventional: Kernel<1>,
    shown: Display,
    /// The device has shown nothing at some time since the last genuine cycle.
    blank: bool,
    /// So has the conventional device.
    conventional_blank: bool,
}

impl Schedule {
    /// The model on `line`.
    pub fn new(line: Line) -> Self {
        Self { line }
    }

    /// When a device has either lost the aspect once or never will: a first pattern, and T2+T3.
    fn deadline(&self, state: &ScheduleState) -> u16 {
        self.line.ticks().expiry().0 + state.on + state.off
    }
}

/// Whether bursts of `on` with gaps of `off` keep an aspect accepted.
fn keeps(times: Times, on: u16, off: u16) -> bool {
    on >= times.shortened_operate().0 && off <= credited_gap(times)
        || on >= times.operate().0 && off + times.operate().0 <= times.expiry().0
}

/// Whether bursts of `on` with gaps of `off` bring an aspect back that has expired.
fn revives(times: Times, on: u16, off: u16) -> bool {
    on >= times.operate().0 || on >= times.shortened_operate().0 && off <= times.interruption().0
}

impl Subject for Schedule {
    type State = ScheduleState;
    type Action = ();

    fn initial(&self) -> Vec<ScheduleState> {
        let times = self.line.ticks();
        let patterns = (1..=times.operate().0).flat_map(|on| (1..=times.expiry().0 + 1).map(move |off| (on, off)));
        patterns
            .map(|(on, off)| ScheduleState {
                on,
                off,
                genuine: 0,
                place: 0,
                cycles: 0,
                normative: Kernel::INITIAL,
                conventional: Kernel::INITIAL,
                shown: Display::NOTHING,
                blank: false,
                conventional_blank: false,
            })
            .collect()
    }

    fn actions(&self, _: &ScheduleState, actions: &mut Vec<()>) {
        actions.push(());
    }

    fn next(&self, state: &ScheduleState, (): &()) -> Option<ScheduleState> {
        let times = self.line.ticks();
        let detected = self.detected(state, &());
        let device = Acceptance { times };
        let (normative, shown) = device.step(state.normative, detected);
        let device = Acceptance { times: times.conventional() };
        let (conventional, by_conventional) = device.step(state.conventional, detected);
        if state.genuine < times.operate().0 {
            return Some(ScheduleState { genuine: state.genuine + 1, normative, conventional, shown, ..state.clone() });
        }
        Some(ScheduleState {
            place: (state.place + 1) % (state.on + state.off),
            cycles: (state.cycles + 1).min(self.deadline(state)),
            normative,
            conventional,
            shown,
            blank: state.blank || shown == Display::NOTHING,
            conventional_blank: state.conventional_blank || by_conventional == Display::NOTHING,
            ..state.clone()
        })
    }

    fn claims(&self) -> Vec<Claim<Self>> {
        let times = self.line.ticks();
        let ((on, all), (on_conventional, all_conventional)) = (duty_cycle(times), duty_cycle(times.conventional()));
        let (t4, t5) = (times.interruption().0, times.shortened_operate().0);
        let ms = |ticks| self.line.millis(ticks);
        vec![
            Claim::<Self>::always(
                "kept-if",
                "bursts of at least T5 with gaps of at most min(T4, T2+T3-T5) keep the aspect displayed without a gap",
                |m, s| !s.blank || !keeps(m.line.ticks(), s.on, s.off),
            ),
            Claim::<Self>::always(
                "kept-only-if",
                "any other regular bursts do not, for longer than T2+T3 and one pattern",
                |m, s| s.blank || s.cycles < m.deadline(s) || keeps(m.line.ticks(), s.on, s.off),
            ),
            Claim::<Self>::always(
                "conventional-kept-iff",
                "the conventional device: exactly bursts of at least T1 with gaps of at most T2+T3-T1",
                |m, s| {
                    let kept = keeps(m.line.ticks().conventional(), s.on, s.off);
                    if s.conventional_blank { !kept } else { kept || s.cycles < m.deadline(s) }
                },
            ),
            Claim::<Self>::always(
                "no-smaller-share",
                format!("no regular bursts with a share under {on}/{all} keep the aspect displayed"),
                |m, s| {
                    let (on, all) = duty_cycle(m.line.ticks());
                    let share = u32::from(s.on) * u32::from(all) >= u32::from(on) * u32::from(s.on + s.off);
                    s.blank || s.cycles < m.deadline(s) || share
                },
            ),
            Claim::<Self>::hazard(
                "kept-for-ever",
                format!(
                    "bursts of {} ms in every {} ms ({}) keep an aspect displayed for ever that the ground does not send",
                    ms(on),
                    ms(all),
                    percent(on, all),
                ),
                &["no-stale-bursts", "spaced-bursts"],
                |m, s| {
                    !s.blank
                        && s.cycles == m.deadline(s)
                        && s.place == 0
                        && (s.on, s.on + s.off) == duty_cycle(m.line.ticks())
                },
            ),
            Claim::<Self>::always(
                "no-return",
                "T2+T3 after the first pattern the aspect is displayed only with bursts of T5 at most T4 apart, or of T1",
                |m, s| s.shown == Display::NOTHING || s.cycles < m.deadline(s) || revives(m.line.ticks(), s.on, s.off),
            ),
            Claim::<Self>::hazard(
                "returns-for-ever",
                format!(
                    "bursts of {} ms in every {} ms ({}) bring the aspect back again and again, with gaps in the display",
                    ms(t5),
                    ms(t5 + t4),
                    percent(t5, t5 + t4),
                ),
                &["no-stale-bursts", "spaced-bursts"],
                |m, s| {
                    let (t4, t5) = (m.line.ticks().interruption().0, m.line.ticks().shortened_operate().0);
                    s.shown != Display::NOTHING && s.blank && s.cycles == m.deadline(s) && (s.on, s.off) == (t5, t4)
                },
            ),
            Claim::<Self>::hazard(
                "conventional-kept-for-ever",
                format!(
                    "the conventional device needs bursts of {} ms in every {} ms ({})",
                    ms(on_conventional),
                    ms(all_conventional),
                    percent(on_conventional, all_conventional),
                ),
                &["no-stale-bursts", "spaced-bursts"],
                |m, s| {
                    !s.conventional_blank
                        && s.cycles == m.deadline(s)
                        && s.place == 0
                        && (s.on, s.on + s.off) == duty_cycle(m.line.ticks().conventional())
                },
            ),
        ]
    }

    fn parameters(&self) -> String {
        self.line().describe(self.aspects())
    }

    fn trace(&self, path: &[(Self::State, Option<Self::Action>)]) -> Trace {
        replay::trace(self, path)
    }
}

impl Receiving for Schedule {
    fn line(&self) -> Line {
        self.line
    }

    fn aspects(&self) -> usize {
        1
    }

    fn detected(&self, state: &ScheduleState, (): &()) -> AspectSet {
        let genuine = state.genuine < self.line.ticks().operate().0;
        if genuine || state.place >= state.off { STALE } else { AspectSet::EMPTY }
    }

    fn sent(&self, state: &ScheduleState, (): &()) -> Option<AspectSet> {
        Some(if state.genuine < self.line.ticks().operate().0 { STALE } else { AspectSet::EMPTY })
    }

    fn loop_length(&self, last: &ScheduleState) -> Option<usize> {
        Some(usize::from(last.on + last.off))
    }
}
