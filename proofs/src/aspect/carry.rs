//! From 16 aspects to four: an aspect that does not matter can be taken away, and the rest does the same.
//!
//! Take away one after the other until the four are left that a claim speaks of; what is then above the four is idle, and
//! the machine of 16 is the machine of four. `spec/theorems.md` has the argument.

use super::{BOUND, any_parts, any_set, any_times, at_each_rank, evident_after, has, lowest, ranks, same, satisfied};
use crate::ASPECTS;
use atc_kernel::aspect::{AspectSet, MAX_ASPECTS, Parts, State, step};

/// The machine from which an aspect is taken away has one more than the other proofs of size [`ASPECTS`], at most 16.
const MANY: usize = if ASPECTS < MAX_ASPECTS { ASPECTS + 1 } else { MAX_ASPECTS };

/// The set without the rank `GONE`: what was above it is one rank lower.
fn closed_up<const GONE: usize>(set: u16) -> u16 {
    let below = (1 << GONE) - 1;
    set & below | set >> 1 & !below
}

/// The state without the aspect of rank `GONE`: what was above it is one rank lower, and the highest is idle.
fn taken_away<const GONE: usize>(parts: &Parts<MANY>) -> Parts<MANY> {
    let mut rest = Parts {
        run: [0; MANY],
        age: [0; MANY],
        accepted: closed_up::<GONE>(parts.accepted),
        dropped: closed_up::<GONE>(parts.dropped),
        credited: closed_up::<GONE>(parts.credited),
        last: closed_up::<GONE>(parts.last),
    };
    for rank in 0..MANY - 1 {
        let from = if rank < GONE { rank } else { rank + 1 };
        rest.run[rank] = parts.run[from];
        rest.age[rank] = parts.age[from];
    }
    rest
}

/// The highest of a set as a set of one.
fn highest(set: u16) -> u16 {
    let mut found = 0;
    for rank in 0..MANY {
        if has(set, rank) {
            found = 1 << rank;
        }
    }
    found
}

/// What happens without one aspect.
struct Without {
    valid: bool,
    step: bool,
    display: bool,
}

#[inline]
fn without<const GONE: usize>(
    times: atc_kernel::aspect::Times,
    before: &Parts<MANY>,
    detected: u16,
    after: &Parts<MANY>,
    display: u16,
) -> Without {
    let state = State::from_parts(taken_away::<GONE>(before));
    let (next, shown) = step(times, state, AspectSet::from_bits(closed_up::<GONE>(detected)));
    Without {
        valid: state.is_valid(times),
        step: same(&next.parts(), &taken_away::<GONE>(after)),
        display: shown.bits() == closed_up::<GONE>(display),
    }
}

harness! {
    /// In one cycle at most three aspects matter to the others: the last displayed, the lowest
    /// satisfied, the lowest firm and the highest evident one. Any aspect that is none of these can be taken away: the
    /// others do what they did, and so does the display.
    carry_away(e)
    theorem "T-ACC-8";
    requirements ["GEN-1"];
    assumptions [];
    bound BOUND;
    cases MANY;
    unwind 33 = 1 + crate::aspect::LONGEST;
    apart [0 1 2 3 4];
    claims {
        Three: "the last displayed, the lowest satisfied, the lowest firm and the highest evident aspect are at most three",
        Valid: "without the aspect, the state before is a valid one",
        Step: "without the aspect, the state after is what it was, without the aspect",
        Display: "and the display is what it was",
    }
    covers {
        Heard: "an accepted aspect that is heard is taken away",
        Dropped: "an aspect is dropped",
        Rise: "the display rises",
    }
    {
        let Some(asked) = any_times(e) else { return };
        let rank = e.choose("rank that is taken away", MANY);
        let before = any_parts::<MANY, E>(e, &asked);
        let state = State::from_parts(before);
        e.assume(state.is_valid(asked.times));
        let detected = any_set::<MANY, E>(e).bits() & ranks::<MANY>();
        let (next, display) = step(asked.times, state, AspectSet::from_bits(detected));
        let after = next.parts();

        let mut firm = 0;
        for rank in 0..MANY {
            firm |= u16::from(after.age[rank] < asked.recovery) << rank;
        }
        let firm = firm & after.accepted;
        let evident = evident_after(&asked, &before, detected);
        let matter = before.last | lowest(satisfied(&after)) | lowest(firm) | highest(evident);
        e.claim(Claim::Three as u32, matter.count_ones() <= 3);

        e.assume(!has(matter, rank));
        let nothing = Without { valid: false, step: false, display: false };
        let rest = at_each_rank!(rank, nothing, without(asked.times, &before, detected, &after, display.bits()));
        e.claim(Claim::Valid as u32, rest.valid);
        e.claim(Claim::Step as u32, rest.step);
        e.claim(Claim::Display as u32, rest.display);
        e.cover(Cover::Heard as u32, has(after.accepted & detected, rank));
        e.cover(Cover::Dropped as u32, after.dropped & !before.dropped != 0);
        e.cover(Cover::Rise as u32, display.bits() > before.last && before.last != 0);
    }
}

/// How many aspects are left.
const FEW: usize = 4;

/// Of how many.
const WIDE: usize = if cfg!(kani) { 8 } else { MAX_ASPECTS };

/// The lowest four lanes.
fn lowest_four(parts: &Parts<WIDE>) -> Parts<FEW> {
    let few = |set: u16| set & ranks::<FEW>();
    let mut four = Parts {
        run: [0; FEW],
        age: [0; FEW],
        accepted: few(parts.accepted),
        dropped: few(parts.dropped),
        credited: few(parts.credited),
        last: few(parts.last),
    };
    for rank in 0..FEW {
        four.run[rank] = parts.run[rank];
        four.age[rank] = parts.age[rank];
    }
    four
}

harness! {
    /// While the aspects from rank 4 on are idle and not heard, they stay so, and the machine of 16 is the machine of
    /// four.
    carry_idle(e)
    theorem "T-ACC-8";
    requirements ["GEN-1"];
    assumptions [];
    bound "";
    cases 1;
    unwind 33 = 1 + crate::aspect::LONGEST;
    under_kani "8 aspects";
    claims {
        Valid: "the state of the four is valid",
        Step: "the state of the four after the cycle is what the machine of four makes of it",
        Idle: "the others stay idle",
        Display: "the display is that of the machine of four",
    }
    covers {
        Dropped: "an aspect is dropped",
        Rise: "the display rises",
    }
    {
        let Some(asked) = any_times(e) else { return };
        let four = any_parts::<FEW, E>(e, &asked);
        let mut before = Parts {
            run: [0; WIDE],
            age: [0; WIDE],
            accepted: four.accepted,
            dropped: four.dropped,
            credited: four.credited,
            last: four.last,
        };
        for rank in 0..FEW {
            before.run[rank] = four.run[rank];
            before.age[rank] = four.age[rank];
        }
        let state = State::from_parts(before);
        e.assume(ranks::<FEW>() & (four.accepted | four.last | four.credited | four.dropped)
            == four.accepted | four.last | four.credited | four.dropped);
        e.assume(state.is_valid(asked.times));
        let detected = AspectSet::from_bits(any_set::<FEW, E>(e).bits() & ranks::<FEW>());
        let (next, display) = step(asked.times, state, detected);
        let few = State::from_parts(four);
        let (few_next, few_display) = step(asked.times, few, detected);
        let after = next.parts();

        e.claim(Claim::Valid as u32, few.is_valid(asked.times));
        e.claim(Claim::Step as u32, same(&few_next.parts(), &lowest_four(&after)));
        let mut idle = (after.accepted | after.dropped | after.credited | after.last) & !ranks::<FEW>() == 0;
        for rank in FEW..WIDE {
            idle &= after.run[rank] == 0 && after.age[rank] == 0;
        }
        e.claim(Claim::Idle as u32, idle);
        e.claim(Claim::Display as u32, few_display == display);
        e.cover(Cover::Dropped as u32, after.dropped & !before.dropped != 0);
        e.cover(Cover::Rise as u32, display.bits() > before.last && before.last != 0);
    }
}
