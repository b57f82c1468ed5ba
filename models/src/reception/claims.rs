//! What is claimed of ground, channel and train; and the bounds as formulas.

use super::{Environment, Reception, State};
use crate::line::DEFAULT;
use crate::subject::Claim;
use crate::train::Device;
use atc_kernel::aspect::{Display, Times};

pub use super::purpose::{Bound, Purpose};

impl Bound {
    /// The bound in cycles.
    pub fn cycles(self, times: Times) -> u16 {
        let (t1, t4, t5) = (times.operate().0, times.interruption().0, times.shortened_operate().0);
        match self {
            Self::Heard => t1.min(times.expiry().0) - 1,
            Self::ShortBursts => times.expiry().0 - 1 + (t5 - 1),
            Self::SpacedBursts => t4 + (t1 - 1) + times.expiry().0 - 1,
        }
    }

    /// The bound as a formula, in cycles.
    pub fn formula(self) -> &'static str {
        match self {
            Self::Heard => "min(T1, T2+T3) - 1",
            Self::ShortBursts => "(T2+T3 - 1) + (T5 - 1)",
            Self::SpacedBursts => "T4 + (T1 - 1) + (T2+T3 - 1)",
        }
    }
}

/// The exposure of `display`; 0 for nothing.
fn exposure<S, const N: usize>(state: &State<S, N>, display: Display) -> u16 {
    display.aspect().and_then(|aspect| state.exposure.get(usize::from(aspect.rank())).copied()).unwrap_or(0)
}

impl<D: Device, const N: usize> Reception<D, N> {
    /// An exposure that is counted no further: one beyond the bound.
    pub(super) fn never(&self) -> u16 {
        self.bound().map_or(1, |bound| bound.cycles(self.device.times()) + 1)
    }

    /// The larger of the bounds that are watched.
    fn bound(&self) -> Option<Bound> {
        match self.purpose {
            Purpose::Exposure(bound) | Purpose::Outlives { bound, still: None, .. } => Some(bound),
            Purpose::Outlives { still, .. } => still,
            Purpose::Restrictive | Purpose::Misread => None,
        }
    }

    pub(super) fn purpose_claims(&self) -> Vec<Claim<Self>> {
        let mut claims = vec![Claim::<Self>::always("valid", "the device's state keeps its invariant", |m, s| {
            m.device.is_valid(&s.train.normative)
        })];
        match self.purpose {
            Purpose::Exposure(bound) => claims.extend(self.kept(bound)),
            Purpose::Outlives { bound, excluded_by, text, still } => {
                claims.push(Claim::<Self>::hazard("outlives", self.number(text, bound), excluded_by, |m, s| {
                    let Purpose::Outlives { bound, .. } = m.purpose else { return false };
                    exposure(s, s.train.shown.normative) > bound.cycles(m.device.times())
                }));
                claims.extend(still.into_iter().flat_map(|still| self.kept(still)));
            }
            Purpose::Restrictive => claims.extend(Self::restrictive()),
            Purpose::Misread => claims.extend(self.misread()),
        }
        claims
    }

    fn number(&self, text: &str, bound: Bound) -> String {
        let (cycles, default) = (bound.cycles(self.device.times()), bound.cycles(DEFAULT.ticks()));
        let ms = DEFAULT.millis(default);
        format!(
            "{text}: {} = {cycles} cycles (the formula with {}: {default} = {ms} ms)",
            bound.formula(),
            DEFAULT.about
        )
    }

    fn kept(&self, bound: Bound) -> Vec<Claim<Self>> {
        vec![
            Claim::<Self>::always(
                "exposure-bounded",
                self.number("no aspect is displayed for longer after the ground last sent it or a higher one", bound),
                |m, s| exposure(s, s.train.shown.normative) < m.never(),
            ),
            Claim::<Self>::sometimes("exposure-tight", self.number("the bound is reached", bound), |m, s| {
                exposure(s, s.train.shown.normative) + 1 == m.never()
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
            Claim::<Self>::sometimes("shows-what-is-sent", "the highest aspect is sent and displayed", |_, s| {
                usize::from(s.ground) == N - 1 && s.train.shown.normative.bits() == 1 << (N - 1)
            }),
        ]
    }

    fn restrictive() -> Vec<Claim<Self>> {
        vec![
            Claim::<Self>::always(
                "stays-restrictive",
                "once the aspect that is sent has been displayed, nothing higher is",
                |_, s| !s.met || s.train.shown.normative.bits() <= 1,
            ),
            Claim::<Self>::sometimes("shows-what-is-sent", "the aspect that is sent is displayed", |_, s| s.met),
            Claim::<Self>::sometimes("noise-is-heard", "a burst of a higher aspect is as long as it may be", |m, s| {
                s.burst.contains(&m.environment.burst)
            }),
            Claim::<Self>::sometimes(
                "interrupted",
                "the aspect that is sent is interrupted while it is displayed",
                |_, s| s.out > 0 && s.met && s.train.shown.normative.bits() == 1,
            ),
        ]
    }

    fn misread(&self) -> Vec<Claim<Self>> {
        let Environment { burst, .. } = self.environment;
        vec![
            Claim::<Self>::hazard(
                "misread-is-displayed",
                format!(
                    "an aspect that was never sent is heard for T1 = {burst} cycles while the lower one that is sent has \
                     been without acceptance for T2 or more, and is displayed"
                ),
                &["no-permissive-misread", "short-interruptions"],
                |_, s| s.met && s.train.before.normative.bits() == 1 && s.train.shown.normative.bits() > 1,
            ),
            Claim::<Self>::sometimes("shows-what-is-sent", "the aspect that is sent is displayed", |_, s| s.met),
        ]
    }
}
