//! Time: rounding and the constructor of the times.

use crate::{Harness, any_u32};
use atc_kernel::aspect::{Times, TimesError, TimesMs};
use atc_kernel::time::{Millis, Ticks};

/// The harnesses of this module.
pub const ALL: &[Harness] = &[time_rounding::HARNESS, time_constructor::HARNESS];

/// The cycle of the rounding proof in milliseconds: a constant, as no prover divides by an arbitrary number.
pub const CYCLE_MS: u32 = 10;

harness! {
    /// A time whose lapse permits something (T1, T5) is rounded up to whole cycles; a time during which a permission
    /// persists (T2, T3, T4) is rounded down.
    time_rounding(e)
    theorem "T-ACC-8";
    requirements ["TIME-1"];
    assumptions ["cycle-10ms"];
    bound "cycle 10 ms; other cycles are tested";
    claims {
        OperateUp: "T1 and T5 last at least what was asked, and less than a cycle more",
        RestDown: "T2+T3 and T4 last at most what was asked, and T2 is less than a cycle short",
    }
    covers {
        Inexact: "a time that is no whole number of cycles is accepted",
    }
    {
        let [operate, recovery, mask, interruption, shortened] =
            [300..=300, 400..=400, 400..=400, 800..=800, 100..=100].map(|likely| any_u32(e, likely));
        let asked = TimesMs {
            operate: Millis(operate),
            recovery: Millis(recovery),
            mask: Millis(mask),
            interruption: Millis(interruption),
            shortened_operate: Millis(shortened),
        };
        let Ok(times) = Times::from_millis(Millis(CYCLE_MS), asked) else { return e.assume(false) };
        let lasts = |ticks: Ticks| u32::from(ticks.0) * CYCLE_MS;
        let up = |ticks: Ticks, ms: u32| lasts(ticks) >= ms && lasts(ticks) < ms + CYCLE_MS;
        let down = |ticks: Ticks, ms: u32| lasts(ticks) <= ms && lasts(ticks) + CYCLE_MS > ms;
        e.claim(Claim::OperateUp as u32, up(times.operate(), operate) && up(times.shortened_operate(), shortened));
        e.claim(
            Claim::RestDown as u32,
            down(times.recovery(), recovery)
                && lasts(times.expiry()) <= recovery + mask
                && lasts(times.expiry()) + 2 * CYCLE_MS > recovery + mask
                && lasts(times.interruption()) <= interruption,
        );
        e.cover(Cover::Inexact as u32, lasts(times.operate()) != operate && lasts(times.recovery()) != recovery);
    }
}

harness! {
    /// The constructor of the times accepts exactly the sets that TIME-2 allows, and a T4 of T2+T3 or more acts as
    /// T2+T3 less one cycle.
    time_constructor(e)
    theorem "T-ACC-8";
    requirements ["TIME-2", "TIME-3"];
    assumptions [];
    bound "";
    claims {
        Exact: "accepted if and only if no rule of TIME-2 is broken",
        Kept: "accepted times are the ones that were asked for, T4 at most T2+T3 less one",
        Told: "the rule that the error names is broken",
    }
    covers {
        Accepted: "some times are accepted",
        Capped: "a T4 of T2+T3 or more is accepted",
        Refused: "some times are refused",
    }
    {
        let [operate, recovery, mask, interruption, shortened] =
            [1..=6, 1..=6, 0..=6, 0..=14, 0..=5].map(|likely| e.word(likely));
        let expiry = u32::from(recovery) + u32::from(mask);
        let result = Times::from_ticks(Ticks(operate), Ticks(recovery), Ticks(mask), Ticks(interruption), Ticks(shortened));
        let allowed = operate > 0
            && recovery > 0
            && shortened > 0
            && shortened < operate
            && expiry <= 60_000
            && operate <= 60_000
            && interruption <= 60_000;
        e.claim(Claim::Exact as u32, result.is_ok() == allowed);
        let kept = |times: &Times| {
            let capped = if u32::from(interruption) < expiry { u32::from(interruption) } else { expiry - 1 };
            times.operate().0 == operate
                && times.recovery().0 == recovery
                && u32::from(times.expiry().0) == expiry
                && times.shortened_operate().0 == shortened
                && u32::from(times.interruption().0) == capped
        };
        e.claim(Claim::Kept as u32, result.as_ref().map_or(true, kept));
        let told = |error: &TimesError| match error {
            TimesError::NoCycle => false,
            TimesError::NoOperateTime => operate == 0,
            TimesError::NoRecoveryTime => recovery == 0,
            TimesError::NoShortenedOperateTime => shortened == 0,
            TimesError::ShortenedNotShorter => shortened >= operate,
            TimesError::OperateTooLong => operate > 60_000,
            TimesError::RecoveryAndMaskTooLong => expiry > 60_000,
            TimesError::InterruptionTooLong => interruption > 60_000,
        };
        e.claim(Claim::Told as u32, result.as_ref().err().is_none_or(told));
        e.cover(Cover::Accepted as u32, result.is_ok());
        e.cover(Cover::Capped as u32, result.is_ok() && u32::from(interruption) >= expiry);
        e.cover(Cover::Refused as u32, result.is_err());
    }
}
