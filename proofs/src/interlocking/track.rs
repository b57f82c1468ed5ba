//! Track circuit tracking (T-TRK-1): one circuit stands for all.

use crate::Engine;
use crate::engine::any_byte;
use atc_kernel::Machine;
use atc_kernel::interlocking::{
    CircuitSet, Input, Layout, MAX_CIRCUITS, Orders, Plan, Positions, SegmentSet, State, Track,
};
use atc_kernel::time::Ticks;

/// Any set of all 64 circuits.
fn any_reports<E: Engine + ?Sized>(e: &mut E) -> CircuitSet {
    let mut bits = 0;
    for _ in 0..4 {
        bits = bits << 16 | u64::from(e.word("reported occupied (16 bits)", 0..=1));
    }
    CircuitSet::from_bits(bits)
}

/// The count of circuit `number`, without an index that is not a constant.
fn count(track: &Track, number: usize) -> u8 {
    let mut found = 0;
    for (place, count) in track.clear_for().iter().enumerate() {
        found = if place == number { *count } else { found };
    }
    found
}

/// How many cases the circuits are split into.
const GROUPS: usize = 8;

harness! {
    /// A circuit counts as occupied in the cycle in which it is reported occupied, and as clear exactly from the cycle in which it has been
    /// reported clear for the layout's number of cycles in a row.
    t_trk_1(e)
    theorem "T-TRK-1";
    requirements ["TRK-1"];
    assumptions [];
    bound "";
    cases GROUPS;
    unwind 65 = 1 + crate::interlocking::LONGEST;
    claims {
        AtOnce: "a circuit that is reported occupied counts as occupied",
        Clear: "a circuit counts as clear exactly if it has been reported clear for the layout's number of cycles in a row, this one included",
        Valid: "what is remembered of the circuit is the number of cycles in a row, up to the layout's number: the state stays valid",
        Start: "the initial state is valid, and no circuit has been reported clear in it",
    }
    covers {
        Becomes: "a circuit counts as clear for the first time",
        Nearly: "a circuit that is reported clear still counts as occupied",
        Lost: "a circuit that counted as clear is reported occupied",
        Once: "the number of cycles is 1",
    }
    {
        let clear = any_byte(e, "clear (cycles)", 1..=3);
        if clear == 0 {
            return e.assume(false);
        }
        let first = e.choose("eighth of the circuits", GROUPS) * (MAX_CIRCUITS / GROUPS);
        let number = first + usize::from(e.word("a circuit of it that stands for all (number)", 0..=7) & 7);
        // For how many cycles in a row it has been reported clear, as far as anybody can count.
        let before = u32::from(e.word("reported clear before (cycles)", 0..=4));
        let limit = u32::from(clear);
        let count_before = if before < limit { before.to_le_bytes()[0] } else { clear };
        let others = e.word("count of the other circuits (cycles)", 0..=1).to_le_bytes();
        let counts: [u8; MAX_CIRCUITS] = core::array::from_fn(|place| {
            let other = others[place & 1];
            let other = if other < clear { other } else { clear };
            if place == number { count_before } else { other }
        });
        let track = Track::from_parts(counts);
        let reported = any_reports(e);
        let is_reported = reported.bits() >> number & 1 == 1;
        let now = if is_reported { 0 } else { before + 1 };
        let (after, occupied) = track.step(clear, reported);
        let counts_as_occupied = occupied.bits() >> number & 1 == 1;
        e.claim(Claim::AtOnce as u32, !is_reported || counts_as_occupied);
        e.claim(Claim::Clear as u32, counts_as_occupied == (now < limit));
        let kept = u32::from(count(&after, number)) == if now < limit { now } else { limit };
        e.claim(Claim::Valid as u32, kept);
        let start = State::<1, 1>::INITIAL.track;
        e.claim(Claim::Start as u32, start.is_valid(clear) && count(&start, number) == 0);
        e.cover(Cover::Becomes as u32, now == limit);
        e.cover(Cover::Nearly as u32, !is_reported && counts_as_occupied);
        e.cover(Cover::Lost as u32, before >= limit && is_reported);
        e.cover(Cover::Once as u32, clear == 1 && now == 1);
    }
}

harness! {
    /// In a cycle of the whole device the shared table and the next state have the occupancy that the tracking makes of the reports.
    t_trk_1_shared(e)
    theorem "T-TRK-1";
    requirements ["TRK-1"];
    assumptions [];
    bound "a layout without routes";
    cases 1;
    unwind 65 = 1 + crate::interlocking::LONGEST;
    claims {
        Shared: "the table's occupied circuits and the next state of the tracking are those of the tracking alone",
        AtOnce: "and every circuit that is reported occupied is among them: no layout says otherwise",
    }
    covers {
        Filtered: "a circuit that is reported clear counts as occupied",
    }
    {
        let clear = any_byte(e, "clear (cycles)", 1..=3);
        let track = Track::from_parts(core::array::from_fn(|_| e.word("reported clear for (cycles)", 0..=1).to_le_bytes()[0]));
        let reported = any_reports(e);
        let (after, occupied) = track.step(clear, reported);
        let plan = Plan::<1, 1, 1, 1> { clear, turn: Ticks(1), ..Plan::EMPTY };
        let Ok(layout) = Layout::with_what_proofs_need(plan) else { return e.assume(false) };
        let input = Input { occupied: reported, detected: Positions::NONE, request: None, orders: Orders::default(), consent: SegmentSet::EMPTY };
        let (next, output) = layout.step(State { track, ..State::INITIAL }, input);
        let (_, _, contents) = output.table.parts();
        e.claim(Claim::Shared as u32, contents.occupied.bits() == occupied.bits() && next.track == after);
        e.claim(Claim::AtOnce as u32, reported.bits() & !contents.occupied.bits() == 0);
        e.cover(Cover::Filtered as u32, occupied.bits() & !reported.bits() != 0);
    }
}
