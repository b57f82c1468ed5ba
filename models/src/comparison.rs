//! Any detections at all: the device under test beside the conventional one and the machine as claimed.
//!
//! No ground, no channel, no assumption: in each cycle the receiver detects any set of aspects. Whatever holds here
//! holds on every line with these times.

use crate::line::Line;
use crate::outcome::Trace;
use crate::replay::{self, Receiving};
use crate::subject::{Claim, Subject};
use crate::train::{Device, Runs, Train};
use atc_kernel::aspect::{AspectSet, Display};
use std::marker::PhantomData;

/// The model: `N` aspects, 1 to 4, and the device `D` under test.
#[derive(Clone, Debug)]
pub struct Comparison<D, const N: usize> {
    line: Line,
    device: D,
    extras: Vec<Extra>,
    ranks: PhantomData<[(); N]>,
}

/// What can be reached with some times and aspects only, and must be there.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Extra {
    /// An aspect masked and recovered by T5; and one that the machine as claimed rises to on T5. Needs a credit.
    Credit,
    /// A mask. Needs T3.
    Mask,
    /// A credit that outlives expiry.
    CreditPastExpiry,
    /// A rise that ACC-9 forbids. Needs two aspects.
    Rise,
}

/// The train and the runs of detection.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub struct State<S, const N: usize> {
    train: Train<S, N>,
    runs: Runs<N>,
}

impl<S, const N: usize> State<S, N> {
    /// Whether the device shows something lower than it showed last.
    fn falls(&self) -> bool {
        self.train.shown.normative != Display::NOTHING && self.train.shown.normative < self.train.before.normative
    }
}

impl<D: Device, const N: usize> Comparison<D, N> {
    /// The model on `line`, with the cover points and hazards of `extras`.
    pub fn new(line: Line, extras: &[Extra]) -> Self {
        Self { line, device: D::with(line.ticks()), extras: extras.to_vec(), ranks: PhantomData }
    }

    fn evidence(&self, state: &State<D::State, N>, display: Display) -> bool {
        state.runs.at_or_above(display) >= self.device.times().operate().0
    }
}

impl<D: Device, const N: usize> Subject for Comparison<D, N> {
    type State = State<D::State, N>;
    type Action = AspectSet;

    fn initial(&self) -> Vec<Self::State> {
        vec![State { train: Train::initial(&self.device), runs: Runs::NONE }]
    }

    fn actions(&self, _: &Self::State, actions: &mut Vec<AspectSet>) {
        actions.extend((0..1 << N).map(AspectSet::from_bits));
    }

    fn next(&self, state: &Self::State, detected: &AspectSet) -> Option<Self::State> {
        Some(State {
            train: state.train.step(&self.device, *detected),
            runs: state.runs.step(self.device.times(), *detected),
        })
    }

    fn claims(&self) -> Vec<Claim<Self>> {
        let mut claims = self.safety();
        claims.extend(self.extras.iter().flat_map(|extra| self.reached(*extra)));
        claims
    }

    fn parameters(&self) -> String {
        self.line().describe(self.aspects())
    }

    fn trace(&self, path: &[(Self::State, Option<Self::Action>)]) -> Trace {
        replay::trace(self, path)
    }
}

impl<D: Device, const N: usize> Receiving for Comparison<D, N> {
    fn line(&self) -> Line {
        self.line
    }

    fn aspects(&self) -> usize {
        N
    }

    fn detected(&self, _: &Self::State, detected: &AspectSet) -> AspectSet {
        *detected
    }
}

impl<D: Device, const N: usize> Comparison<D, N> {
    fn safety(&self) -> Vec<Claim<Self>> {
        let (operate, t5) = (self.device.times().operate().0, self.device.times().shortened_operate().0);
        vec![
            Claim::<Self>::always("valid", "the device's state keeps its invariant", |m, s| {
                m.device.is_valid(&s.train.normative)
            }),
            Claim::<Self>::always(
                "not-above-conventional",
                "where the conventional device shows something, the device shows nothing higher",
                |_, s| s.train.shown.not_above_conventional(),
            ),
            Claim::<Self>::always(
                "not-above-as-claimed",
                "where the machine as claimed shows something, the device shows nothing higher",
                |_, s| s.train.shown.not_above_as_claimed(),
            ),
            Claim::<Self>::always(
                "rise-has-evidence",
                format!(
                    "the display rises above the last one shown only to an aspect that was detected, itself or a higher \
                     one, on T1 = {operate} consecutive cycles up to now"
                ),
                |m, s| s.train.shown.normative <= s.train.before.normative || m.evidence(s, s.train.shown.normative),
            ),
            Claim::<Self>::always(
                "heard-aspect-binds",
                format!(
                    "an aspect detected on T1 = {operate} consecutive cycles up to now bounds the display from above"
                ),
                |m, s| {
                    let heard = (0..N).filter(|rank| s.runs.of(*rank) >= m.device.times().operate().0);
                    heard.min().is_none_or(|rank| s.train.shown.normative.bits() <= 1 << rank)
                },
            ),
            Claim::<Self>::always(
                "fall-has-evidence",
                format!(
                    "the display falls below the last one shown only to an aspect that is detected now, for T5 = {t5} cycles \
                     or more: what was dropped does not come back by itself"
                ),
                |m, s| {
                    let (shown, t5) = (s.train.shown.normative, m.device.times().shortened_operate().0);
                    !s.falls() || s.runs.of_display(shown) >= t5
                },
            ),
            Claim::<Self>::sometimes("shows-the-highest", "the highest aspect is displayed", |_, s| {
                s.train.shown.normative.bits() == 1 << (N - 1)
            }),
        ]
    }

    fn reached(&self, extra: Extra) -> Vec<Claim<Self>> {
        let t5 = self.device.times().shortened_operate().0;
        match extra {
            Extra::Credit => vec![
                Claim::<Self>::sometimes(
                    "t5-recovers",
                    "after an interruption the device shows an aspect where the conventional device shows nothing",
                    |_, s| {
                        s.train.shown.conventional == Display::NOTHING && s.train.shown.normative != Display::NOTHING
                    },
                ),
                Claim::<Self>::sometimes(
                    "falls-on-t5",
                    format!("the display falls to an aspect that is detected on T5 = {t5} cycles"),
                    |m, s| {
                        let run = s.runs.of_display(s.train.shown.normative);
                        s.falls() && run == m.device.times().shortened_operate().0
                    },
                ),
                Claim::<Self>::sometimes(
                    "lower-than-conventional",
                    "the device shows a lower aspect than the conventional one, which shows something",
                    |_, s| {
                        s.train.shown.normative != Display::NOTHING
                            && s.train.shown.normative < s.train.shown.conventional
                    },
                ),
            ],
            Extra::Mask => vec![
                Claim::<Self>::sometimes(
                    "mask-lapses-below",
                    "the highest aspect loses its mask, which only a lower one that is firm can do",
                    |m, s| m.device.dropped(&s.train.normative).bits() >> (N - 1) == 1,
                ),
                Claim::<Self>::sometimes(
                    "mask-lapses-above",
                    "the lowest aspect loses its mask, which only T1 of evidence for a higher one can do",
                    |m, s| m.device.dropped(&s.train.normative).bits() & 1 == 1,
                ),
                Claim::<Self>::hazard(
                    "as-claimed-rises-in-silence",
                    "the machine as claimed: two aspects are lost one after the other, and the display rises to the \
                     higher one while nothing at all is detected",
                    &["ACC-9"],
                    |_, s| s.runs.silence() && s.train.shown.as_claimed > s.train.before.as_claimed,
                ),
                Claim::<Self>::hazard(
                    "as-claimed-rises-on-t5",
                    format!(
                        "the machine as claimed: the display rises past a masked lower aspect on T5 = {t5} cycles of \
                         evidence instead of T1"
                    ),
                    &["ACC-9"],
                    |m, s| {
                        let (shown, before) = (s.train.shown.as_claimed, s.train.before.as_claimed);
                        let times = m.device.times();
                        let rises = shown > before && before != Display::NOTHING;
                        rises && !m.evidence(s, shown) && s.runs.of_display(shown) == times.shortened_operate().0
                    },
                ),
            ],
            Extra::CreditPastExpiry => vec![Claim::<Self>::sometimes(
                "credit-past-expiry",
                "an aspect is gone and its present detection will still be accepted after T5",
                |m, s| !m.device.credited(&s.train.normative).is_empty(),
            )],
            Extra::Rise => vec![
                Claim::<Self>::sometimes(
                    "acc-9-forbids",
                    "an aspect is satisfied and nothing is displayed, because it would be a rise without evidence",
                    |m, s| {
                        s.train.shown.normative == Display::NOTHING
                            && !m.device.satisfied(&s.train.normative).is_empty()
                    },
                ),
                Claim::<Self>::sometimes(
                    "price-of-acc-9",
                    "the device shows nothing where the machine as claimed shows an aspect",
                    |_, s| s.train.shown.normative == Display::NOTHING && s.train.shown.as_claimed != Display::NOTHING,
                ),
            ],
        }
    }
}
