//! Track circuit tracking (T-TRK-1): one circuit stands for all.

use crate::Engine;
use crate::engine::{any_byte, any_flag};
use atc_kernel::Machine;
use atc_kernel::interlocking::{
    CircuitSet, Input, Layout, MAX_CIRCUITS, Orders, PerCircuit, Plan, Positions, SegmentSet, State, Track,
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
        let counts = PerCircuit::from_fn(|place| {
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
        let track = Track::from_parts(PerCircuit::from_fn(|_| e.word("reported clear for (cycles)", 0..=1).to_le_bytes()[0]));
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

harness! {
    /// A ghost train passes the joint of two circuits, is lost for a while in the one that it leaves, and then in the one that it enters. With a layout that
    /// the constructor takes it is never lost in both: until the second one has reported it, the first one counts as occupied.
    t_trk_1_joint(e)
    theorem "T-TRK-1";
    requirements ["TRK-1", "LAY-2"];
    assumptions ["loss-of-shunt-within-clear"];
    bound "a layout without routes, T_clear up to 4 cycles, losses up to 2";
    cases 1;
    unwind 65 = 1 + crate::interlocking::LONGEST;
    claims {
        Holds: "the invariant: no more cycles count as clear than have passed since a loss began, or since the train left",
        Behind: "the circuit behind the joint counts as occupied until the train is reported ahead of it",
        Ahead: "and from then on the one ahead of it does, while the train is there",
    }
    covers {
        Lost: "the train has left the circuit behind the joint, and is not reported ahead of it",
        Twice: "and it was lost in the one behind when it left that",
        Seen: "it is reported ahead of the joint for the first time",
    }
    {
        let clear = any_byte(e, "clear (cycles)", 0..=4);
        let loss = any_byte(e, "longest loss (cycles)", 0..=2);
        let plan = Plan::<1, 1, 1, 1> { clear, loss, turn: Ticks(1), ..Plan::EMPTY };
        let Ok(layout) = Layout::new(plan) else { return e.assume(false) };
        let before = Crossing::any(e);
        let counts = PerCircuit::from_fn(|place| match place {
            0 => before.counts.0,
            1 => before.counts.1,
            _ => clear,
        });
        let valid = before.counts.0 <= clear && before.counts.1 <= clear;
        e.assume(valid && before.holds(loss));
        if !valid || !before.holds(loss) {
            return;
        }
        let reported = e.word("reported occupied (bit 0 behind the joint, bit 1 ahead)", 0..=3);
        let (behind, ahead) = (reported & 1 == 1, reported >> 1 & 1 == 1);
        let mut train = before.moves(e).reported(behind, ahead);
        let tolerated = (!train.behind || train.lost.0 <= loss) && (!train.ahead || train.lost.1 <= loss);
        e.suppose("loss-of-shunt-within-clear", tolerated);
        let bits = u64::from(behind) | u64::from(ahead) << 1;
        let (after, occupied) = Track::from_parts(counts).step(layout.plan().clear, CircuitSet::from_bits(bits));
        train.counts = (count(&after, 0), count(&after, 1));
        let counted = (occupied.bits() & 1 == 1, occupied.bits() >> 1 & 1 == 1);
        e.claim(Claim::Holds as u32, train.holds(loss));
        e.claim(Claim::Behind as u32, counted.0 || train.seen && !train.behind);
        e.claim(Claim::Ahead as u32, counted.1 || !train.seen || !train.ahead);
        let lost = train.ahead && !train.behind && !train.seen;
        e.cover(Cover::Lost as u32, lost);
        e.cover(Cover::Twice as u32, lost && train.lost.0 > 0);
        e.cover(Cover::Seen as u32, train.seen && !before.seen && !train.behind);
    }
}

/// A train that passes the joint of circuits 0 and 1.
#[derive(Clone, Copy, Debug)]
struct Crossing {
    /// Whether it is in the circuit behind the joint.
    behind: bool,
    /// Whether it is in the one ahead of it.
    ahead: bool,
    /// Whether it has been reported ahead of the joint.
    seen: bool,
    /// For how many cycles in a row it has not been reported: behind the joint, until it left; ahead of it.
    lost: (u8, u8),
    /// For how many cycles it has been gone from the circuit behind.
    gone: u8,
    /// For how many cycles in a row each circuit has been reported clear.
    counts: (u8, u8),
}

impl Crossing {
    fn any<E: Engine + ?Sized>(e: &mut E) -> Self {
        Self {
            behind: any_flag(e, "it is behind the joint (odd: yes)"),
            ahead: any_flag(e, "it is ahead of it (odd: yes)"),
            seen: any_flag(e, "it has been reported ahead of it (odd: yes)"),
            lost: (any_byte(e, "lost behind (cycles)", 0..=2), any_byte(e, "lost ahead (cycles)", 0..=2)),
            gone: any_byte(e, "gone from behind (cycles)", 0..=2),
            counts: (any_byte(e, "behind, reported clear (cycles)", 0..=3), any_byte(e, "ahead (cycles)", 0..=3)),
        }
    }

    /// The invariant: what there can be of a train that is lost nowhere for longer than `loss`.
    fn holds(self, loss: u8) -> bool {
        let (gone, lost) = (u16::from(self.gone), (u16::from(self.lost.0), u16::from(self.lost.1)));
        let mut holds = (self.behind || self.ahead) && self.lost.0 <= loss && self.lost.1 <= loss;
        holds &= if self.ahead { self.seen || lost.1 > 0 } else { !self.seen && lost.1 == 0 };
        holds &= !self.behind || self.gone == 0 && self.counts.0 <= self.lost.0;
        // It was in both for a cycle or more.
        holds &= self.behind || self.seen || gone > 0 && gone < lost.1 && u16::from(self.counts.0) <= lost.0 + gone;
        holds && (!self.seen || self.counts.1 <= self.lost.1)
    }

    /// What it does in a cycle: its front passes the joint, or its tail, in a later one.
    fn moves<E: Engine + ?Sized>(mut self, e: &mut E) -> Self {
        let (on, up) = (any_flag(e, "its front goes on (odd: yes)"), any_flag(e, "its tail goes on (odd: yes)"));
        self.behind &= !(up && self.ahead);
        self.ahead |= on;
        self
    }

    /// It is reported behind the joint, or ahead of it, or not.
    const fn reported(mut self, behind: bool, ahead: bool) -> Self {
        if self.behind {
            self.lost.0 = if behind { 0 } else { self.lost.0.saturating_add(1) };
        } else {
            self.gone = self.gone.saturating_add(1);
        }
        if self.ahead {
            self.lost.1 = if ahead { 0 } else { self.lost.1.saturating_add(1) };
            self.seen |= ahead;
        }
        self
    }
}
