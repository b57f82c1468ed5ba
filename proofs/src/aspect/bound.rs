//! T-ACC-2, T-ACC-3 and T-ACC-7: what bounds the display from above, and how long a lost aspect stands.

use super::{BOUND, Cycle, HEARD, Lane, any_cycle, any_rank, at_or_above, evident, has, lane, lowest, satisfied};
use crate::ASPECTS;
use atc_kernel::aspect::State;

harness! {
    /// An accepted aspect that is heard bounds the display from above.
    t_acc_2(e)
    theorem "T-ACC-2";
    requirements ["ACC-2"];
    assumptions ["detected-throughout"];
    built_in HEARD;
    bound BOUND;
    cases 1;
    unwind 33 = 1 + crate::aspect::LONGEST;
    claims {
        Bounded: "the display is at most any aspect that is accepted and heard",
        Stays: "an accepted aspect that is heard, and was not lost, stays accepted",
    }
    covers {
        Lower: "an aspect is accepted and heard while a lower one is displayed",
        Nothing: "an aspect is accepted and heard while nothing is displayed",
    }
    {
        let Some(cycle) = any_cycle::<ASPECTS, E>(e) else { return };
        let rank = any_rank::<ASPECTS, E>(e);
        let (was, is) = (lane(&cycle.before, rank), lane(&cycle.after, rank));
        let heard = has(cycle.detected, rank);
        let display = cycle.display.bits();
        let bounds = is.accepted && is.age == 0 && heard;
        e.claim(Claim::Bounded as u32, !bounds || display <= 1 << rank);
        e.claim(Claim::Stays as u32, !(was.accepted && was.age == 0 && heard) || bounds);
        e.cover(Cover::Lower as u32, bounds && display != 0 && display < 1 << rank);
        e.cover(Cover::Nothing as u32, bounds && display == 0);
    }
}

harness! {
    /// An aspect that has not been heard for T2+T3 is not displayed; total silence ends in no display within T2+T3.
    t_acc_3(e)
    theorem "T-ACC-3";
    requirements ["ACC-3", "ACC-6"];
    assumptions ["detected-throughout"];
    built_in HEARD;
    bound BOUND;
    cases 1;
    unwind 33 = 1 + crate::aspect::LONGEST;
    claims {
        Unseen: "an aspect unheard for T2+T3 cycles is neither satisfied nor displayed",
        Silence: "after T2+T3 cycles of silence nothing is displayed",
        Ages: "an aspect is lost at least as long as it is unheard",
        Start: "in the initial state nothing is accepted",
    }
    covers {
        Expires: "an aspect is gone in the very cycle in which it has been unheard for T2+T3",
        Glitch: "an aspect is gone although it was heard in between",
    }
    {
        let Some(cycle) = any_cycle::<ASPECTS, E>(e) else { return };
        let rank = any_rank::<ASPECTS, E>(e);
        let expiry = cycle.asked.expiry;
        // Ghosts: cycles in which this aspect, and in which all aspects, have not been heard, counted to T2+T3.
        let unheard = e.word("cycles this aspect has been unheard", 0..=expiry);
        let silence = e.word("cycles of silence", 0..=expiry);
        let covers = |lane: Lane, cycles: u16| !lane.accepted || lane.age >= cycles;
        e.assume(unheard <= expiry && covers(lane(&cycle.before, rank), unheard));
        e.assume(silence <= expiry && every(&cycle, false, |lane| covers(lane, silence)));

        let count = |cycles: u16, heard: bool| if heard { 0 } else { cycles.saturating_add(1).min(expiry) };
        let unheard = count(unheard, has(cycle.detected, rank));
        let silence = count(silence, cycle.detected != 0);
        let (was, is) = (lane(&cycle.before, rank), lane(&cycle.after, rank));
        let is_shown = has(satisfied(&cycle.after) | cycle.display.bits(), rank);
        e.claim(Claim::Unseen as u32, unheard < expiry || !is_shown);
        e.claim(Claim::Silence as u32, silence < expiry || cycle.display.bits() == 0);
        e.claim(Claim::Ages as u32, covers(is, unheard) && every(&cycle, true, |lane| covers(lane, silence)));
        e.claim(Claim::Start as u32, State::<ASPECTS>::INITIAL.parts().accepted == 0);
        e.cover(Cover::Expires as u32, unheard == expiry && was.accepted && !is.accepted);
        let glitch = was.run > 0 || has(cycle.detected, rank);
        e.cover(Cover::Glitch as u32, glitch && unheard < expiry && was.accepted && !is.accepted);
    }
}

/// Whether `holds` for every lane before (or after) the cycle.
fn every<const N: usize>(cycle: &Cycle<N>, after: bool, holds: impl Fn(Lane) -> bool) -> bool {
    let parts = if after { &cycle.after } else { &cycle.before };
    let mut all = true;
    for rank in 0..N {
        all &= holds(lane(parts, rank));
    }
    all
}

harness! {
    /// Recovery holds a lost aspect; a mask lapses exactly when ACC-5 or ACC-7 says so or its age is T2+T3, and then
    /// until the aspect is accepted again; nothing is displayed only if nothing is satisfied or ACC-9 forbids it.
    t_acc_7(e)
    theorem "T-ACC-7";
    requirements ["ACC-2", "ACC-3", "ACC-4", "ACC-5", "ACC-6", "ACC-7", "ACC-9"];
    assumptions ["detected-throughout"];
    built_in HEARD;
    bound BOUND;
    cases 1;
    unwind 33 = 1 + crate::aspect::LONGEST;
    claims {
        Recovery: "an accepted aspect lost for less than T2 is satisfied",
        Mask: "from T2 to T2+T3 it stays satisfied exactly while no lower aspect is firm and no higher one has T1 evidence",
        Gone: "at T2+T3 it is neither accepted nor satisfied",
        Accepted: "an aspect that is accepted and not lost is satisfied, whatever it was before",
        NoOther: "an aspect that is not accepted becomes satisfied only by an acceptance",
        Lowest: "what is displayed is the lowest satisfied aspect",
        Nothing: "nothing is displayed only if nothing is satisfied, or a rise has no evidence",
    }
    covers {
        Recovering: "an aspect is in recovery",
        Masked: "an aspect is masked and displayed",
        DroppedByLower: "a mask lapses because a lower aspect is firm",
        DroppedByHigher: "a mask lapses because a higher aspect has T1 evidence",
        StaysDropped: "a dropped aspect stays so after the reason is gone",
        Forbidden: "an aspect is satisfied and ACC-9 forbids to display it",
    }
    {
        let Some(cycle) = any_cycle::<ASPECTS, E>(e) else { return };
        let rank = any_rank::<ASPECTS, E>(e);
        let asked = &cycle.asked;
        let (was, is) = (lane(&cycle.before, rank), lane(&cycle.after, rank));
        let heard = has(cycle.detected, rank);
        let reaccepted = is.accepted && is.age == 0 && heard;
        // Cycles since the loss, this one included: 0 if it is not lost.
        let lost_for = if heard && was.age == 0 { 0 } else { was.age.saturating_add(1) };
        let was_satisfied = was.accepted && !was.dropped;
        let is_satisfied = is.accepted && !is.dropped;

        let evident = evident(&cycle);
        let mut lower_firm = false;
        let mut higher_evident = false;
        for other in 0..ASPECTS {
            lower_firm |= other < rank && has(cycle.after.accepted, other) && cycle.after.age[other] < asked.recovery;
            higher_evident |= other > rank && has(evident, other);
        }
        let contradicted = lower_firm || higher_evident;
        let lost = was.accepted && !reaccepted;
        let masked = lost && lost_for >= asked.recovery && lost_for < asked.expiry;
        let lowest = lowest(satisfied(&cycle.after));
        let display = cycle.display.bits();

        e.claim(Claim::Recovery as u32, !(was.accepted && lost_for < asked.recovery) || is_satisfied);
        e.claim(Claim::Mask as u32, !masked || is_satisfied == (was_satisfied && !contradicted));
        e.claim(Claim::Gone as u32, !(lost && lost_for >= asked.expiry) || !is.accepted && !is_satisfied);
        e.claim(Claim::Accepted as u32, !reaccepted || is_satisfied);
        e.claim(Claim::NoOther as u32, was.accepted || reaccepted || !is_satisfied);
        e.claim(Claim::Lowest as u32, display == 0 || display == lowest);
        let forbidden = lowest > cycle.before.last && !at_or_above(evident, lowest);
        e.claim(Claim::Nothing as u32, display != 0 || lowest == 0 || forbidden);
        e.cover(Cover::Recovering as u32, lost && lost_for < asked.recovery);
        e.cover(Cover::Masked as u32, masked && display == 1 << rank);
        e.cover(Cover::DroppedByLower as u32, masked && was_satisfied && lower_firm && !higher_evident);
        e.cover(Cover::DroppedByHigher as u32, masked && was_satisfied && higher_evident && !lower_firm);
        e.cover(Cover::StaysDropped as u32, masked && !was_satisfied && !contradicted);
        e.cover(Cover::Forbidden as u32, lowest != 0 && forbidden);
    }
}
