//! The count: T-BLK-2 (faults), T-BLK-3, and the parameters, the invariant and the machine.

use super::{all, any_block, any_byte, any_cycle, any_flag, any_hold, any_input, any_parts, any_reset, has, ones};
use atc_kernel::Machine;
use atc_kernel::block::{Block, BlockError, Fault, Input, SectionSet, State, Status, step};
use atc_kernel::time::Ticks;

harness! {
    /// Unequal, faulted or unverified means that every section is reported occupied; a fault is latched exactly when the count
    /// is contradicted, and fault and unverified last until a reset.
    t_blk_2(e)
    theorem "T-BLK-2";
    requirements ["BLK-2", "BLK-3"];
    assumptions [];
    bound "";
    cases 1;
    unwind 18 = 1 + crate::block::LONGEST;
    claims {
        Agree: "the counts agree if and only if the count is in force and equals the number of sections that detect",
        All: "if they do not, every section is reported occupied",
        Latched: "without a reset a fault and the unverified state stay as they are",
        Faults: "while the count is in force a fault is latched if and only if it is contradicted, and it is named",
    }
    covers {
        AtZero: "a check-out when all trains are pending",
        AtMaximum: "a check-in at the highest number of trains while a train leaves",
        StaysOn: "a check-in that stays on too long",
        AtLimit: "a check-in that stays on for as long as it may",
        Disagree: "an unequal count that is in force",
    }
    {
        let Some(cycle) = any_cycle(e) else { return };
        let (before, after, input) = (cycle.before, cycle.after, cycle.input);
        let agree = cycle.counts() && u32::from(after.count) == ones(cycle.detected());
        e.claim(Claim::Agree as u32, cycle.output.agree == agree && cycle.output.status == after.status);
        e.claim(Claim::All as u32, agree || cycle.output.occupied.bits() == all(cycle.sections()));
        e.claim(Claim::Latched as u32, input.reset.is_some() || before.status == Status::Counting || after.status == before.status);
        let (rises_in, rises_out) = (input.check_in && before.check_in_for == 0, input.check_out && !before.check_out);
        let stays_on = input.check_in && u32::from(before.check_in_for) + 1 > u32::from(cycle.block.pass().0);
        let at_maximum = rises_in && before.count == cycle.block.max_trains().0;
        let at_zero = rises_out && before.count == before.pending;
        let contradicted = stays_on || at_maximum || at_zero;
        let named = match after.status {
            Status::Fault(Fault::CheckInStaysOn) => stays_on,
            Status::Fault(Fault::CheckInAtMaximum) => at_maximum,
            Status::Fault(Fault::CheckOutAtZero) => at_zero,
            Status::Counting => !contradicted,
            Status::Unverified => false,
        };
        e.claim(Claim::Faults as u32, input.reset.is_some() || before.status != Status::Counting || named);
        let counting = before.status == Status::Counting && input.reset.is_none();
        e.cover(Cover::AtZero as u32, counting && at_zero && before.pending > 0);
        e.cover(Cover::AtMaximum as u32, counting && at_maximum && rises_out && before.count > before.pending);
        e.cover(Cover::StaysOn as u32, counting && stays_on);
        e.cover(Cover::AtLimit as u32, counting && before.check_in_for + 1 == cycle.block.pass().0 && input.check_in && cycle.counts());
        e.cover(Cover::Disagree as u32, cycle.counts() && !agree);
    }
}

harness! {
    /// Whatever the check-in level does in between, with spurious check-ins and lost check-outs, the count is never under the
    /// trains, if entries are at least a pass time apart; and it neither wraps nor exceeds the maximum.
    t_blk_3(e)
    theorem "T-BLK-3";
    requirements ["BLK-3", "BLK-7"];
    assumptions [
        "entries-apart", "check-in-fail-safe", "live-transmitter", "check-out-not-spurious", "verified-reset", "no-reversing-over-exit",
    ];
    bound "";
    cases 1;
    unwind 18 = 1 + crate::block::LONGEST;
    claims {
        NeverUnder: "the count, without what is pending, is at least the trains in the block; one more while the check-in is on and no train has entered since it rose",
        NoWrap: "the count stays between what is pending and the maximum",
    }
    covers {
        Caught: "an entry that makes no edge is caught by the pass time",
        Spurious: "a check-in rises without a train",
        NoEdge: "a train enters without an edge and is counted already",
        Lost: "a train leaves without a check-out",
        Reset: "a reset is accepted with a train in the block",
        Passing: "a train enters while another leaves",
    }
    {
        let Some(cycle) = any_cycle(e) else { return };
        let (before, after, input) = (cycle.before, cycle.after, cycle.input);
        // Ghosts: trains whose nose is between the two checks, and cycles since the last one came in.
        let trains = u32::from(e.word("trains in the block", 0..=u16::from(before.count)));
        let since = u32::from(e.word("cycles since the last entry", 0..=4));
        let under = |count: u8, pending: u8, check_in_for: u16, trains: u32, since: u32| {
            let still_to_come = u32::from(check_in_for > 0 && since >= u32::from(check_in_for));
            u32::from(count) < u32::from(pending) + trains + still_to_come
        };
        let counted = before.status == Status::Counting;
        e.assume(!counted || !under(before.count, before.pending, before.check_in_for, trains, since));

        let enters = any_flag(e, "a train enters (odd: yes)");
        let leaves = any_flag(e, "a train leaves (odd: yes)");
        let rises_out = input.check_out && !before.check_out;
        e.suppose("entries-apart", !enters || since + 1 >= u32::from(cycle.block.pass().0));
        let dead = any_flag(e, "its transmitter is dead (odd: yes)");
        e.suppose("live-transmitter", !enters || !dead);
        e.suppose("check-in-fail-safe", !enters || dead || input.check_in);
        e.assume(!leaves || trains > 0 || enters);
        e.suppose("check-out-not-spurious", !rises_out || leaves);
        let back = any_flag(e, "a train comes back over the exit (odd: yes)");
        e.suppose("no-reversing-over-exit", !back);
        let trains_after = (trains + u32::from(enters) + u32::from(back)).saturating_sub(u32::from(leaves));
        // Everything from the pass time on is alike.
        let since_after = if enters { 0 } else { (since + 1).min(0xFFFF) };
        e.suppose("verified-reset", input.reset.is_none_or(|verified| u32::from(verified.0) == trains_after));

        let bad = cycle.counts() && under(after.count, after.pending, after.check_in_for, trains_after, since_after);
        e.claim(Claim::NeverUnder as u32, !bad);
        e.claim(Claim::NoWrap as u32, after.pending <= after.count && after.count <= cycle.block.max_trains().0);
        let edge = input.check_in && before.check_in_for == 0;
        e.cover(Cover::Caught as u32, counted && enters && !edge && after.status == Status::Fault(Fault::CheckInStaysOn));
        e.cover(Cover::Spurious as u32, counted && cycle.counts() && edge && !enters);
        e.cover(Cover::NoEdge as u32, counted && cycle.counts() && enters && !edge);
        e.cover(Cover::Lost as u32, counted && cycle.counts() && leaves && !rises_out);
        e.cover(Cover::Reset as u32, !counted && cycle.counts() && trains_after > 0);
        e.cover(Cover::Passing as u32, counted && cycle.counts() && enters && leaves && edge && rises_out);
    }
}

harness! {
    /// The constructor of a block accepts exactly what BLK-8 allows, and keeps it.
    blk_8(e)
    theorem "T-BLK-2";
    requirements ["BLK-8"];
    assumptions [];
    bound "";
    cases 1;
    unwind 18 = 1 + crate::block::LONGEST;
    claims {
        Exact: "accepted if and only if there are 1 to 16 sections, 1 to so many trains, and 1 to 60 000 cycles; kept as asked; the error names a broken rule",
        Sections: "the sections of the block are the first ones",
    }
    covers {
        Accepted: "a block is accepted",
        Refused: "a block is refused",
        Longest: "a pass time of 60 000 cycles is accepted",
    }
    {
        let sections = any_byte(e, "sections", 0..=17);
        let max_trains = any_byte(e, "highest number of trains", 0..=17);
        let Some(hold) = any_hold(e, "tail hold (sections)", 16) else { return };
        let pass = e.word("pass time (cycles)", 0..=60_000);
        let legal = (1..=16).contains(&sections) && (1..=sections).contains(&max_trains) && (1..=60_000).contains(&pass);
        let block = Block::new(sections, max_trains, hold, Ticks(pass));
        let (exact, listed) = match block {
            Ok(block) => (
                legal
                    && block.sections() == sections
                    && block.max_trains().0 == max_trains
                    && block.hold() == hold
                    && block.pass() == Ticks(pass),
                block.all().bits() == all(sections),
            ),
            Err(BlockError::NoSections) => (sections == 0, true),
            Err(BlockError::TooManySections) => (sections > 16, true),
            Err(BlockError::NoTrains) => (max_trains == 0, true),
            Err(BlockError::MoreTrainsThanSections) => (max_trains > sections, true),
            Err(BlockError::PassTooShort) => (pass == 0, true),
            Err(BlockError::PassTooLong) => (pass > 60_000, true),
            Err(BlockError::NoCycle) => (false, true),
        };
        e.claim(Claim::Exact as u32, exact);
        e.claim(Claim::Sections as u32, listed);
        e.cover(Cover::Accepted as u32, legal);
        e.cover(Cover::Refused as u32, !legal);
        e.cover(Cover::Longest as u32, legal && pass == 60_000);
    }
}

harness! {
    /// A step ends from any state bits and on any input, and from a state that is not valid it never reports less than all
    /// unless the corrupted count agrees.
    blk_total(e)
    theorem "T-BLK-5";
    requirements ["GEN-2"];
    assumptions [];
    bound "";
    cases 1;
    unwind 18 = 1 + crate::block::LONGEST;
    claims {
        All: "from any state, a step whose counts do not agree reports every section occupied",
    }
    covers {
        Corrupt: "a step from a state that is not valid",
        Agree: "a step after which the counts agree",
    }
    {
        let Some(block) = any_block(e) else { return };
        let state = State::from_parts(any_parts(e, block));
        let reset = any_reset(e);
        let Some(input) = any_input(e, block) else { return };
        let (_, output) = step(block, state, Input { reset, ..input });
        e.claim(Claim::All as u32, output.agree || output.occupied.bits() == all(block.sections()));
        e.cover(Cover::Corrupt as u32, !state.is_valid(block));
        e.cover(Cover::Agree as u32, output.agree);
    }
}

harness! {
    /// A set of sections has what it has, and contains another if and only if it has all of that.
    blk_set(e)
    theorem "T-BLK-5";
    requirements ["BLK-1"];
    assumptions [];
    bound "";
    cases 1;
    unwind 18 = 1 + crate::block::LONGEST;
    claims {
        Has: "a section is in the set if and only if its bit is set; none is from 16 on",
        All: "a set contains another if and only if it has every section of that",
    }
    covers {
        Beyond: "a section that no block has",
        Contained: "a set contains another that is not the same",
    }
    {
        let (one, other) = (e.word("a set (bits)", 0..=7), e.word("another set (bits)", 0..=7));
        let section = any_byte(e, "section looked at", 0..=17);
        let (set, part) = (SectionSet::from_bits(one), SectionSet::from_bits(other));
        e.claim(Claim::Has as u32, set.contains(section) == has(one, section));
        let mut contained = true;
        for place in 0..16 {
            contained &= has(one, place) || !has(other, place);
        }
        e.claim(Claim::All as u32, set.contains_all(part) == contained);
        e.cover(Cover::Beyond as u32, section == 17);
        e.cover(Cover::Contained as u32, contained && one != other);
    }
}

harness! {
    /// Validity is inductive: the initial state, which is unverified, is valid, and every step keeps it so. As a machine a
    /// block is its step, and its safe output contains every report that it can make.
    blk_machine(e)
    theorem "T-BLK-5";
    requirements ["GEN-1"];
    assumptions [];
    bound "";
    cases 1;
    unwind 18 = 1 + crate::block::LONGEST;
    claims {
        Valid: "a step from a valid state ends in a valid state",
        Start: "the initial state is valid and unverified, with the check-in off and the check-out on",
        Step: "the machine steps as the step does",
        Safe: "the safe output reports every section, and asks for the longest hold",
    }
    covers {
        Counting: "a step that counts",
        Reset: "a step with a reset",
    }
    {
        let Some(cycle) = any_cycle(e) else { return };
        let (block, before) = (cycle.block, cycle.before);
        e.claim(Claim::Valid as u32, cycle.next.is_valid(block));
        let initial = block.initial();
        let start = initial.parts();
        e.claim(
            Claim::Start as u32,
            initial.is_valid(block) && start.status == Status::Unverified && start.check_in_for == 0 && start.check_out,
        );
        let (next, output) = block.step(State::from_parts(before), cycle.input);
        let same = output.occupied == cycle.output.occupied
            && output.behind_hold == cycle.output.behind_hold
            && output.agree == cycle.output.agree
            && output.count == cycle.output.count
            && output.status == cycle.output.status
            && output.counted_in == cycle.output.counted_in
            && output.counted_out == cycle.output.counted_out;
        e.claim(Claim::Step as u32, next == cycle.next && same);
        let safe = Block::SAFE;
        e.claim(
            Claim::Safe as u32,
            safe.occupied.contains_all(cycle.output.occupied)
                && safe.occupied.bits() == u16::MAX
                && safe.behind_hold.sections() == 16
                && cycle.output.behind_hold.sections() <= 16
                && !safe.agree
                && !safe.counted_in
                && !safe.counted_out,
        );
        e.cover(Cover::Counting as u32, cycle.output.counted_in);
        e.cover(Cover::Reset as u32, cycle.input.reset.is_some() && cycle.counts());
    }
}
