//! Time: rounding and the constructor of the times.

use crate::{Harness, any_u32};
use atc_kernel::aspect::{Times, TimesError, TimesMs};
use atc_kernel::time::{Cycle, Millis, Ticks};

/// The harnesses of this module.
#[cfg(not(chosen))]
pub const ALL: &[Harness] = &[time_rounding::HARNESS, time_constructor::HARNESS];

/// The cycle of the rounding proof in milliseconds: a constant, as no prover divides by an arbitrary number.
pub const CYCLE_MS: u32 = 10;

/// The times of a line, T1 to T5: the longest loop goes over 16 bits of each, byte by byte.
const TIMES: usize = 5;

harness! {
    /// A time whose lapse permits something (T1, T5) is rounded up to whole cycles; a time during which a permission
    /// persists (T2, T3, T4) is rounded down.
    time_rounding(e)
    theorem "T-ACC-8";
    requirements ["TIME-1"];
    assumptions ["cycle-10ms"];
    bound "cycle 10 ms; other cycles are tested";
    cases 1;
    unwind 11 = 1 + 2 * TIMES;
    claims {
        Up: "rounded up, a time lasts at least what was asked, and less than a cycle more",
        Down: "rounded down, it lasts at most what was asked, and less than a cycle less",
        Refused: "it is refused if and only if it lasts more than 60 000 cycles",
        Directions: "T1 and T5 are rounded up, T2, T3 and T4 down",
    }
    covers {
        Inexact: "a time that is no whole number of cycles",
        Accepted: "times that are accepted",
    }
    {
        // Drawn, so that the compiler leaves the division to the prover, which knows it better than its bit tricks.
        let cycle_ms = u32::from(e.word("cycle (ms)", 10..=10));
        e.suppose("cycle-10ms", cycle_ms == CYCLE_MS);
        let Some(cycle) = Cycle::new(Millis(cycle_ms)) else { return e.assume(false) };
        let asked = any_u32(e, "time (ms)", 0..=2000);
        let most = 60_000 * CYCLE_MS;
        let lasts = |ticks: Ticks| u64::from(ticks.0) * u64::from(CYCLE_MS);
        let (time, unit) = (u64::from(asked), u64::from(CYCLE_MS));
        let up = cycle.at_least(Millis(asked));
        let down = cycle.at_most(Millis(asked));
        e.claim(Claim::Up as u32, up.is_none_or(|up| lasts(up) >= time && lasts(up) < time + unit));
        e.claim(Claim::Down as u32, down.is_none_or(|down| lasts(down) <= time && lasts(down) + unit > time));
        e.claim(Claim::Refused as u32, up.is_none() == (asked > most) && down.is_none() == (asked >= most + CYCLE_MS));
        e.cover(Cover::Inexact as u32, up != down && up.is_some());

        let ms = [300..=300, 400..=400, 400..=400, 800..=800, 100..=100].map(|likely| Millis(any_u32(e, "T1, T2, T3, T4, T5 (ms)", likely)));
        let [operate, recovery, mask, interruption, shortened_operate] = ms;
        let times = Times::from_millis(
            Millis(cycle_ms),
            TimesMs { operate, recovery, mask, interruption, shortened_operate },
        );
        let rounded = [
            cycle.at_least(operate),
            cycle.at_most(recovery),
            cycle.at_most(mask),
            cycle.at_most(interruption),
            cycle.at_least(shortened_operate),
        ];
        let expected = match rounded {
            [Some(t1), Some(t2), Some(t3), Some(t4), Some(t5)] => Times::from_ticks(t1, t2, t3, t4, t5).ok(),
            _ => None,
        };
        e.claim(Claim::Directions as u32, times.ok() == expected);
        e.cover(Cover::Accepted as u32, times.is_ok());
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
    cases 1;
    unwind 11 = 1 + 2 * TIMES;
    claims {
        Exact: "accepted if and only if no rule of TIME-2 is broken",
        Kept: "accepted times are the ones that were asked for, T4 at most T2+T3 less one",
        Told: "the rule that the error names is broken",
        NoCycle: "a cycle of 0 is refused, whatever the times, and so has no cycle",
    }
    covers {
        Accepted: "some times are accepted",
        Capped: "a T4 of T2+T3 or more is accepted",
        Refused: "some times are refused",
    }
    {
        let [operate, recovery, mask, interruption, shortened] =
            [1..=6, 1..=6, 0..=6, 0..=14, 0..=5].map(|likely| e.word("T1, T2, T3, T4, T5 (cycles)", likely));
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
        let [t1, t2, t3, t4, t5] = [operate, recovery, mask, interruption, shortened].map(|time| Millis(u32::from(time)));
        let asked = TimesMs { operate: t1, recovery: t2, mask: t3, interruption: t4, shortened_operate: t5 };
        let refused = Times::from_millis(Millis(0), asked) == Err(TimesError::NoCycle);
        e.claim(Claim::NoCycle as u32, refused && Cycle::new(Millis(0)).is_none());
        e.cover(Cover::Accepted as u32, result.is_ok());
        e.cover(Cover::Capped as u32, result.is_ok() && u32::from(interruption) >= expiry);
        e.cover(Cover::Refused as u32, result.is_err());
    }
}
