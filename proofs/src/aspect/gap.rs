//! T-ACC-4: the shortened operate time never drops an aspect, in its exact form.

use super::{Asked, BOUND, any_rank, any_times, same};
use crate::ASPECTS;
use atc_kernel::aspect::{AspectSet, Parts, State, step};

/// The operate time that counts after an interruption of `gap` cycles, alone on the line.
fn needed(asked: &Asked, gap: u16) -> u16 {
    if gap <= asked.interruption && gap < asked.expiry { asked.shortened } else { asked.operate }
}

/// Whether the aspect is displayed after `gap` silent and `heard` heard cycles.
fn is_displayed(asked: &Asked, gap: u16, heard: u16) -> bool {
    heard >= needed(asked, gap) || u32::from(gap) + u32::from(heard) < u32::from(asked.expiry)
}

/// The state after an aspect, accepted and heard, was silent for `gap` cycles and then heard for `heard`, alone on
/// the line: the closed form, with every field in it. `run` is its run before the interruption.
fn closed_form(asked: &Asked, rank: usize, run: u16, gap: u16, heard: u16) -> Parts<ASPECTS> {
    let accepted_again = heard >= needed(asked, gap);
    let intact = gap == 0 && heard == 0;
    let lost_for = u32::from(gap) + u32::from(heard);
    let lost = !accepted_again && !intact && lost_for < u32::from(asked.expiry);
    let bit = 1 << rank;
    let mut parts = Parts {
        run: [0; ASPECTS],
        age: [0; ASPECTS],
        accepted: if accepted_again || intact || lost { bit } else { 0 },
        dropped: 0,
        credited: if !accepted_again && !intact && !lost && heard > 0 && gap <= asked.interruption && gap < asked.expiry
        {
            bit
        } else {
            0
        },
        last: bit,
    };
    for place in 0..ASPECTS {
        if place == rank {
            parts.run[place] = if intact { run } else { heard.min(asked.operate) };
            // Below T2+T3, so it fits.
            parts.age[place] = if lost { gap + heard } else { 0 };
        }
    }
    parts
}

/// What one step from the closed form leads to.
struct Steps {
    /// A silent cycle leads to the closed form of one more silent cycle.
    silent: bool,
    /// A heard cycle leads to the closed form of one more heard cycle.
    heard: bool,
    /// The closed form is valid.
    valid: bool,
}

#[inline]
fn steps_of<const RANK: usize>(asked: &Asked, run: u16, gap: u16, heard: u16) -> Steps {
    let state = State::from_parts(closed_form(asked, RANK, run, gap, heard));
    let alone = AspectSet::from_bits(1 << RANK);
    let as_formula = |detected, gap, heard| {
        let (next, display) = step(asked.times, state, detected);
        let shown = if is_displayed(asked, gap, heard) { alone.bits() } else { 0 };
        same(&next.parts(), &closed_form(asked, RANK, run, gap, heard)) && display.bits() == shown
    };
    Steps {
        silent: as_formula(AspectSet::EMPTY, gap + 1, 0),
        heard: as_formula(alone, gap, heard + 1),
        valid: state.is_valid(asked.times),
    }
}

harness! {
    /// The shortened operate time never drops an aspect: alone on the line, an accepted aspect lost for g cycles,
    /// 1 ≤ g ≤ T4, and then heard again is displayed without a gap if and only if g + T5 ≤ T2 + T3. The conventional
    /// device needs g + T1 ≤ T2 + T3, and so does an interruption longer than T4.
    t_acc_4(e)
    theorem "T-ACC-4";
    requirements ["ACC-1", "ACC-4", "ACC-6", "ACC-8"];
    assumptions ["alone-on-the-line", "detected-throughout"];
    bound BOUND;
    claims {
        Silent: "one more silent cycle leads from the closed form of g to that of g + 1",
        Heard: "one more heard cycle leads from the closed form of k heard cycles to that of k + 1",
        NoGap: "if g + T5 ≤ T2 + T3 the aspect is displayed in every cycle",
        Gap: "if not, it is not displayed in the cycle before its acceptance, or in the last silent one",
        Valid: "the closed form is a valid state",
    }
    covers {
        Exact: "g + T5 = T2 + T3",
        OneOver: "g + T5 = T2 + T3 + 1, within T4",
        BeyondLimit: "an interruption longer than T4, shorter than T2 + T3",
        Conventional: "the conventional device",
        Recovered: "an aspect displayed again after a gap",
    }
    {
        let Some(asked) = any_times(e) else { return };
        let rank = any_rank::<ASPECTS, E>(e);
        let run = e.word(asked.shortened..=asked.operate);
        let gap = e.word(0..=asked.expiry);
        let heard = e.word(0..=asked.operate);
        e.assume(asked.shortened <= run && run <= asked.operate);
        e.assume(gap <= 60_000 && heard <= 60_000 && (heard == 0 || gap > 0));
        // One rank after the other, so that the rest of the state is constant.
        macro_rules! at_each {
            ($($place:literal)*) => {
                match rank {
                    $($place if $place < ASPECTS => steps_of::<$place>(&asked, run, gap, heard),)*
                    _ => Steps { silent: false, heard: false, valid: false },
                }
            };
        }
        let steps = at_each!(0 1 2 3 4 5 6 7 8 9 10 11 12 13 14 15);
        e.claim(Claim::Silent as u32, heard > 0 || steps.silent);
        e.claim(Claim::Heard as u32, gap == 0 || steps.heard);
        e.claim(Claim::Valid as u32, steps.valid);

        let sum = u32::from(gap) + u32::from(needed(&asked, gap));
        let tolerated = sum <= u32::from(asked.expiry);
        e.claim(Claim::NoGap as u32, !tolerated || is_displayed(&asked, gap, heard));
        let shows_gap = !is_displayed(&asked, gap, needed(&asked, gap) - 1) || !is_displayed(&asked, gap, 0);
        e.claim(Claim::Gap as u32, tolerated || gap == 0 || shows_gap);
        let credited = gap > 0 && gap <= asked.interruption && gap < asked.expiry;
        e.cover(Cover::Exact as u32, credited && sum == u32::from(asked.expiry));
        e.cover(Cover::OneOver as u32, credited && sum == u32::from(asked.expiry) + 1);
        e.cover(Cover::BeyondLimit as u32, gap > asked.interruption && gap < asked.expiry);
        e.cover(Cover::Conventional as u32, asked.shortened == asked.operate && tolerated && gap > 0);
        e.cover(Cover::Recovered as u32, !tolerated && heard == needed(&asked, gap));
    }
}

harness! {
    /// The tolerated interruption that the kernel and the case print is exactly the longest one of T-ACC-4, and the
    /// conventional device never tolerates more.
    t_acc_4_tolerated(e)
    theorem "T-ACC-4";
    requirements ["ACC-8"];
    assumptions [];
    bound "";
    claims {
        Exact: "an interruption of g cycles leaves no gap if and only if g is at most the tolerated one",
        NeverLess: "the tolerated interruption is at least the conventional one",
    }
    covers {
        More: "the tolerated interruption is longer than the conventional one",
    }
    {
        let Some(asked) = any_times(e) else { return };
        let gap = e.word(1..=asked.expiry);
        e.assume(gap > 0);
        let tolerated = asked.times.tolerated_interruption().0;
        let sum = u32::from(gap) + u32::from(needed(&asked, gap));
        e.claim(Claim::Exact as u32, (sum <= u32::from(asked.expiry)) == (gap <= tolerated));
        let conventional = asked.times.conventional().tolerated_interruption().0;
        e.claim(Claim::NeverLess as u32, tolerated >= conventional);
        e.cover(Cover::More as u32, tolerated > conventional);
    }
}
