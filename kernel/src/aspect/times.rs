//! The five times of aspect acceptance.

use crate::time::{Cycle, MAX_TICKS, Millis, Ticks};

/// The times in milliseconds, as a configuration gives them. The default is the example of JP3886280B2 \[0051\],
/// with 800 ms for T4, which the patent leaves at "about a second or less".
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct TimesMs {
    /// T1: an aspect heard for so long is accepted.
    pub operate: Millis,
    /// T2: an accepted aspect that is lost stands so long as if it were heard.
    pub recovery: Millis,
    /// T3: and after that so long, if nothing contradicts it.
    pub mask: Millis,
    /// T4: the longest interruption after which T5 takes the place of T1.
    pub interruption: Millis,
    /// T5: the operate time after a short interruption.
    pub shortened_operate: Millis,
}

impl Default for TimesMs {
    fn default() -> Self {
        Self {
            operate: Millis(300),
            recovery: Millis(400),
            mask: Millis(400),
            interruption: Millis(800),
            shortened_operate: Millis(100),
        }
    }
}

/// The times in logic cycles, checked: `1 ≤ T5 ≤ T1`, `1 ≤ T2 ≤ T2+T3`, `T4 < T2+T3`, all at most
/// [`MAX_TICKS`]. (`T5 = T1` only in [`Times::conventional`].)
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Times {
    pub(super) operate: Ticks,
    pub(super) recovery: Ticks,
    pub(super) expiry: Ticks,
    pub(super) interruption: Ticks,
    pub(super) shortened_operate: Ticks,
}

/// Which rule a set of times breaks. Source: `spec/aspect.md`, TIME-2.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TimesError {
    /// The logic cycle has no length.
    NoCycle,
    /// T1, in whole cycles, is 0.
    NoOperateTime,
    /// T2, in whole cycles, is 0: shorter than one cycle.
    NoRecoveryTime,
    /// T5, in whole cycles, is 0.
    NoShortenedOperateTime,
    /// T5 is not shorter than T1, in whole cycles.
    ShortenedNotShorter,
    /// T1 is over [`MAX_TICKS`] cycles.
    OperateTooLong,
    /// T2 + T3 is over [`MAX_TICKS`] cycles.
    RecoveryAndMaskTooLong,
    /// T4 is over [`MAX_TICKS`] cycles.
    InterruptionTooLong,
}

impl Times {
    /// Checks `times` and turns them into logic cycles of length `cycle`: T1 and T5 round up, T2, T3 and T4 down.
    ///
    /// # Errors
    /// A rule of TIME-2 that is broken; if several are, times that are too long come first.
    pub fn from_millis(cycle: Millis, times: TimesMs) -> Result<Self, TimesError> {
        let cycle = Cycle::new(cycle).ok_or(TimesError::NoCycle)?;
        let operate = cycle.at_least(times.operate).ok_or(TimesError::OperateTooLong)?;
        let recovery = cycle.at_most(times.recovery).ok_or(TimesError::RecoveryAndMaskTooLong)?;
        let mask = cycle.at_most(times.mask).ok_or(TimesError::RecoveryAndMaskTooLong)?;
        let interruption = cycle.at_most(times.interruption).ok_or(TimesError::InterruptionTooLong)?;
        // Over 60 000 cycles, and T1 is not: whatever T1 is, T5 is not shorter.
        let shortened = cycle.at_least(times.shortened_operate).ok_or(TimesError::ShortenedNotShorter)?;
        Self::from_ticks(operate, recovery, mask, interruption, shortened)
    }

    /// Checks times that are in logic cycles already (T1, T2, T3, T4, T5).
    ///
    /// # Errors
    /// A rule of TIME-2 that is broken.
    pub fn from_ticks(
        operate: Ticks,
        recovery: Ticks,
        mask: Ticks,
        interruption: Ticks,
        shortened_operate: Ticks,
    ) -> Result<Self, TimesError> {
        //= spec/aspect.md#time-2-the-constructor
        //# The constructor MUST reject a cycle of 0, a T1, T2 or T5 that is 0 after rounding, a T5 that is not shorter than T1, and a T2+T3, T1 or T4 of more than 60 000 cycles.
        if operate.0 == 0 {
            return Err(TimesError::NoOperateTime);
        }
        if recovery.0 == 0 {
            return Err(TimesError::NoRecoveryTime);
        }
        if shortened_operate.0 == 0 {
            return Err(TimesError::NoShortenedOperateTime);
        }
        if shortened_operate >= operate {
            return Err(TimesError::ShortenedNotShorter);
        }
        if operate.0 > MAX_TICKS {
            return Err(TimesError::OperateTooLong);
        }
        let expiry = match recovery.0.checked_add(mask.0) {
            Some(sum) if sum <= MAX_TICKS => Ticks(sum),
            _ => return Err(TimesError::RecoveryAndMaskTooLong),
        };
        if interruption.0 > MAX_TICKS {
            return Err(TimesError::InterruptionTooLong);
        }
        //= spec/aspect.md#time-3-a-long-interruption-limit
        //# A T4 of T2+T3 or more MUST be accepted and act as T2+T3 less one cycle.
        let interruption = if interruption < expiry { interruption } else { Ticks(expiry.0 - 1) };
        Ok(Self { operate, recovery, expiry, interruption, shortened_operate })
    }

    /// The conventional device: the same times without the shortened operate time (T5 = T1). For theorems and
    /// comparison only.
    #[must_use]
    pub const fn conventional(self) -> Self {
        Self { shortened_operate: self.operate, ..self }
    }

    /// T1 in cycles.
    pub const fn operate(self) -> Ticks {
        self.operate
    }

    /// T2 in cycles.
    pub const fn recovery(self) -> Ticks {
        self.recovery
    }

    /// T2 + T3 in cycles: the age at which a lost aspect is gone.
    pub const fn expiry(self) -> Ticks {
        self.expiry
    }

    /// T4 in cycles, less than T2 + T3.
    pub const fn interruption(self) -> Ticks {
        self.interruption
    }

    /// T5 in cycles.
    pub const fn shortened_operate(self) -> Ticks {
        self.shortened_operate
    }

    /// The longest interruption that never drops an accepted aspect heard alone: the largest g with g ≤ T4 and
    /// g + T5 ≤ T2 + T3, or with g + T1 ≤ T2 + T3 beyond T4 (T-ACC-4). 0 if there is none.
    pub const fn tolerated_interruption(self) -> Ticks {
        let plain = self.expiry.0.saturating_sub(self.operate.0);
        let shortened = self.expiry.0.saturating_sub(self.shortened_operate.0);
        let credited = if shortened < self.interruption.0 { shortened } else { self.interruption.0 };
        Ticks(if plain > credited { plain } else { credited })
    }
}
