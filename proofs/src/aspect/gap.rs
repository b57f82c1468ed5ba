//! T-ACC-4: the shortened operate time never drops an aspect, in its exact form.

use super::{Asked, any_parts, any_times, at_each_rank, same};
use atc_kernel::aspect::{AspectSet, MAX_ASPECTS, Parts, State, step};

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
fn closed_form(asked: &Asked, run: u16, gap: u16, heard: u16) -> Parts<1> {
    let accepted_again = heard >= needed(asked, gap);
    let intact = gap == 0 && heard == 0;
    let lost_for = u32::from(gap) + u32::from(heard);
    let lost = !accepted_again && !intact && lost_for < u32::from(asked.expiry);
    let gone = !accepted_again && !intact && !lost;
    let has_credit = heard > 0 && gap <= asked.interruption && gap < asked.expiry;
    Parts {
        run: [if intact { run } else { heard.min(asked.operate) }],
        // Below T2+T3, so it fits.
        age: [if lost { gap + heard } else { 0 }],
        accepted: u16::from(!gone),
        dropped: 0,
        credited: u16::from(gone && has_credit),
        last: 1,
    }
}

harness! {
    /// The shortened operate time never drops an aspect: alone on the line, an accepted aspect lost for g cycles,
    /// 1 ≤ g ≤ T4, and then heard again is displayed without a gap if and only if g + T5 ≤ T2 + T3. The conventional
    /// device needs g + T1 ≤ T2 + T3, and so does an interruption longer than T4. (On the machine of one aspect;
    /// t_acc_4_alone carries it to any aspect of 16.)
    t_acc_4(e)
    theorem "T-ACC-4";
    requirements ["ACC-1", "ACC-4", "ACC-6", "ACC-8"];
    assumptions ["alone-on-the-line", "detected-throughout"];
    built_in &[
        ("alone-on-the-line", "the machine has one aspect"),
        ("detected-throughout", "the aspect is heard in a cycle or it is not: never for a part of one"),
    ];
    bound "";
    cases 1;
    unwind 33 = 1 + crate::aspect::LONGEST;
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
        let run = e.word("run before the interruption", asked.shortened..=asked.operate);
        let gap = e.word("g, silent cycles", 0..=asked.expiry);
        let heard = e.word("k, heard cycles", 0..=asked.operate);
        e.assume(asked.shortened <= run && run <= asked.operate);
        e.assume(gap <= 60_000 && heard <= 60_000 && (heard == 0 || gap > 0));
        let state = State::from_parts(closed_form(&asked, run, gap, heard));
        let as_formula = |detected, gap, heard| {
            let (next, display) = step(asked.times, state, AspectSet::from_bits(detected));
            let shown = u16::from(is_displayed(&asked, gap, heard));
            same(&next.parts(), &closed_form(&asked, run, gap, heard)) && display.bits() == shown
        };
        e.claim(Claim::Silent as u32, heard > 0 || as_formula(0, gap.saturating_add(1), 0));
        e.claim(Claim::Heard as u32, gap == 0 || as_formula(1, gap, heard.saturating_add(1)));
        e.claim(Claim::Valid as u32, state.is_valid(asked.times));

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
    cases 1;
    unwind 33 = 1 + crate::aspect::LONGEST;
    claims {
        Exact: "an interruption of g cycles leaves no gap if and only if g is at most the tolerated one",
        NeverLess: "the tolerated interruption is at least the conventional one",
    }
    covers {
        More: "the tolerated interruption is longer than the conventional one",
    }
    {
        let Some(asked) = any_times(e) else { return };
        let gap = e.word("g, silent cycles", 1..=asked.expiry);
        e.assume(gap > 0);
        let tolerated = asked.times.tolerated_interruption().0;
        let sum = u32::from(gap) + u32::from(needed(&asked, gap));
        e.claim(Claim::Exact as u32, (sum <= u32::from(asked.expiry)) == (gap <= tolerated));
        let conventional = asked.times.conventional().tolerated_interruption().0;
        e.claim(Claim::NeverLess as u32, tolerated >= conventional);
        e.cover(Cover::More as u32, tolerated > conventional);
    }
}

/// What one cycle does to the only aspect of the line, on the machine of 16 and on the machine of one.
#[inline]
fn is_alone<const RANK: usize>(asked: &Asked, one: Parts<1>, heard: bool) -> bool {
    let wide = |one: &Parts<1>| {
        let mut parts = Parts {
            run: [0; MAX_ASPECTS],
            age: [0; MAX_ASPECTS],
            accepted: one.accepted << RANK,
            dropped: one.dropped << RANK,
            credited: one.credited << RANK,
            last: one.last << RANK,
        };
        parts.run[RANK] = one.run[0];
        parts.age[RANK] = one.age[0];
        parts
    };
    let detected = |rank: usize| AspectSet::from_bits(u16::from(heard) << rank);
    let (next, display) = step(asked.times, State::from_parts(one), detected(0));
    let (wide_next, wide_display) = step(asked.times, State::from_parts(wide(&one)), detected(RANK));
    same(&wide_next.parts(), &wide(&next.parts())) && wide_display.bits() == display.bits() << RANK
}

harness! {
    /// An aspect that is alone on the line does on the machine of 16 aspects, whatever its rank, what it does on the
    /// machine of one, and the other 15 stay as they are.
    t_acc_4_alone(e)
    theorem "T-ACC-4";
    requirements ["ACC-8"];
    assumptions ["alone-on-the-line"];
    built_in &[("alone-on-the-line", "nothing is heard of the other 15 aspects, and they are idle")];
    bound "";
    cases MAX_ASPECTS;
    unwind 33 = 1 + crate::aspect::LONGEST;
    apart [0 1 2 3 4 5 6 7 8 9 10 11 12 13 14 15];
    claims {
        Same: "the state and the display are those of the machine of one aspect, at this rank",
    }
    covers {
        Highest: "the aspect of rank 15 is accepted again",
    }
    {
        let Some(asked) = any_times(e) else { return };
        let rank = e.choose("rank", MAX_ASPECTS);
        let one = any_parts::<1, E>(e, &asked);
        e.assume(State::from_parts(one).is_valid(asked.times));
        let heard = e.word("heard (odd: yes)", 0..=1) & 1 == 1;
        let alone = at_each_rank!(rank, false, is_alone(&asked, one, heard));
        e.claim(Claim::Same as u32, alone);
        e.cover(Cover::Highest as u32, rank == 15 && heard && one.age[0] > 0 && one.run[0].saturating_add(1) >= asked.shortened);
    }
}
