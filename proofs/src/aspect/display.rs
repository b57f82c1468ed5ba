//! T-ACC-8: the invariant is inductive, the display is a function of the state; and the step is total.

use super::{BOUND, any_cycle, any_parts, any_set, any_times, has, lowest, ranks, same, satisfied};
use crate::ASPECTS;
use atc_arithmetic::lowest_member;
use atc_kernel::Machine;
use atc_kernel::aspect::{Acceptance, AspectId, AspectSet, Display, Parts, State, step};

harness! {
    /// Validity is inductive, the initial state is valid and displays nothing, and the display is a function of
    /// the state.
    t_acc_8(e)
    theorem "T-ACC-8";
    requirements ["GEN-1"];
    assumptions [];
    bound BOUND;
    cases 1;
    unwind 33 = 1 + crate::aspect::LONGEST;
    claims {
        Inductive: "the state after a cycle is valid",
        Initial: "the initial state is valid, displays nothing, and has nothing heard, lost, accepted or displayed before",
        Function: "the display is the lowest satisfied aspect if that is not above the last display, else nothing",
        Accessor: "the state tells its own display",
        Machine: "as a machine it is this step, from the initial state, and its safe output is no display",
    }
    covers {
        Displayed: "an aspect is displayed",
        Crowded: "every aspect is accepted",
    }
    {
        let Some(cycle) = any_cycle::<ASPECTS, E>(e) else { return };
        e.claim(Claim::Inductive as u32, cycle.next.is_valid(cycle.asked.times));
        let initial = State::<ASPECTS>::INITIAL;
        let nothing = Parts { run: [0; ASPECTS], age: [0; ASPECTS], accepted: 0, dropped: 0, credited: 0, last: 0 };
        let is_nothing = same(&initial.parts(), &nothing) && initial.display().bits() == 0;
        e.claim(Claim::Initial as u32, initial.is_valid(cycle.asked.times) && is_nothing);
        let machine = Acceptance::<ASPECTS> { times: cycle.asked.times };
        let (next, display) = machine.step(State::from_parts(cycle.before), AspectSet::from_bits(cycle.detected));
        let is_step = same(&next.parts(), &cycle.after) && display.bits() == cycle.display.bits();
        let starts = same(&machine.initial().parts(), &nothing) && Acceptance::<ASPECTS>::SAFE.bits() == 0;
        e.claim(Claim::Machine as u32, is_step && starts);
        let shown = lowest(satisfied(&cycle.after));
        let expected = if shown <= cycle.after.last { shown } else { 0 };
        e.claim(Claim::Function as u32, cycle.display.bits() == expected);
        e.claim(Claim::Accessor as u32, cycle.next.display() == cycle.display);
        e.cover(Cover::Displayed as u32, expected != 0);
        e.cover(Cover::Crowded as u32, cycle.after.accepted == ranks::<ASPECTS>());
    }
}

harness! {
    /// The step is total: from any bits whatever, a corrupted state included, it ends without a panic, an overflow
    /// or an index out of bounds, and displays at most one aspect.
    total(e)
    theorem "T-ACC-8";
    requirements ["GEN-2"];
    assumptions [];
    bound BOUND;
    cases 1;
    unwind 33 = 1 + crate::aspect::LONGEST;
    claims {
        One: "at most one aspect is displayed, and it is satisfied",
    }
    covers {
        Corrupted: "the state is not valid",
    }
    {
        let Some(asked) = any_times(e) else { return };
        let parts = any_parts::<ASPECTS, E>(e, &asked);
        let state = State::from_parts(parts);
        let detected = any_set::<ASPECTS, E>(e);
        let (next, display) = step(asked.times, state, detected);
        let bits = display.bits();
        e.claim(Claim::One as u32, lowest(bits) == bits && satisfied(&next.parts()) & bits == bits);
        e.cover(Cover::Corrupted as u32, !state.is_valid(asked.times));
    }
}

harness! {
    /// The lowest aspect of a set by the bit trick is the lowest by looking at one after the other.
    set_1(e)
    theorem "T-ACC-8";
    requirements ["ACC-2"];
    assumptions [];
    bound "";
    cases 1;
    unwind 33 = 1 + crate::aspect::LONGEST;
    claims {
        Same: "the two ways give the same aspect, for all sets of 16",
        Sides: "what is above the lowest, and what is below the highest, by looking at one after the other",
        Named: "a display names the rank of its bit, and a rank from 16 on is no aspect",
    }
    covers {
        Highest: "the lowest is the highest of all",
        Empty: "the set is empty",
    }
    {
        let bits = e.word("set (bits)", 0..=u16::MAX);
        let flags: [bool; 16] = core::array::from_fn(|rank| has(bits, rank));
        let slow = lowest_member(&flags);
        let fast = AspectSet::from_bits(bits).lowest();
        let same = match slow {
            Some(rank) => rank < 16 && u32::from(fast.bits()) == 1 << rank,
            None => fast.is_empty(),
        };
        e.claim(Claim::Same as u32, same);
        let (above, below) = (AspectSet::from_bits(bits).above_lowest(), AspectSet::from_bits(bits).below_highest());
        let (mut sides, mut some_lower, mut some_higher) = (true, false, false);
        for rank in 0..16 {
            sides &= has(above.bits(), rank) == some_lower && has(below.bits(), 15 - rank) == some_higher;
            some_lower |= has(bits, rank);
            some_higher |= has(bits, 15 - rank);
        }
        e.claim(Claim::Sides as u32, sides);
        let rank = e.word("rank", 0..=16).to_le_bytes()[0];
        let named = match AspectId::new(rank) {
            Some(id) => {
                let alone = AspectSet::EMPTY.with(id);
                let shown = Display::of(id);
                rank < 16
                    && id.rank() == rank
                    && u32::from(alone.bits()) == 1 << rank
                    && shown.bits() == alone.bits()
                    && shown.aspect() == Some(id)
                    && AspectSet::from_bits(bits).contains(id) == has(bits, usize::from(rank))
            }
            None => rank >= 16,
        };
        e.claim(Claim::Named as u32, named && Display::NOTHING.aspect().is_none());
        e.cover(Cover::Highest as u32, slow == Some(15));
        e.cover(Cover::Empty as u32, slow.is_none());
    }
}
