//! One block: the count of trains, its comparison with the detectors, and what is reported.

use super::{Hold, MAX_SECTIONS, SectionSet, TrainCount};
use crate::Machine;
use crate::time::{Cycle, MAX_TICKS, Millis, Ticks};

/// The parameters of a block, checked: 1 to 16 sections, 1 to that many trains, a pass time of 1 to [`MAX_TICKS`] cycles.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Block {
    sections: u8,
    max_trains: u8,
    hold: Hold,
    pass: Ticks,
}

/// Which rule the parameters of a block break. Source: `spec/block.md`, BLK-8.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum BlockError {
    /// The block has no section.
    NoSections,
    /// The block has more than 16 sections.
    TooManySections,
    /// No train may be in the block.
    NoTrains,
    /// More trains may be in the block than it has sections.
    MoreTrainsThanSections,
    /// The logic cycle has no length.
    NoCycle,
    /// The pass time is shorter than one logic cycle.
    PassTooShort,
    /// The pass time is over [`MAX_TICKS`] cycles.
    PassTooLong,
}

impl Block {
    /// A block of `sections` sections (1 to 16) in which at most `max_trains` trains (1 to `sections`) may be, with `hold`
    /// sections held behind every head; `pass` (1 cycle or more) is the longest that a passing train keeps the check-in on.
    ///
    /// # Errors
    /// The first rule of BLK-8 that is broken.
    pub const fn new(sections: u8, max_trains: u8, hold: Hold, pass: Ticks) -> Result<Self, BlockError> {
        //= spec/block.md#blk-8-the-constructor
        //# The constructor MUST reject a block without sections or with more than 16, a highest number of trains that is 0 or over the number of sections, a cycle of 0, and a pass time that is under one cycle or over 60 000 cycles.
        if sections == 0 {
            return Err(BlockError::NoSections);
        }
        if sections > MAX_SECTIONS {
            return Err(BlockError::TooManySections);
        }
        if max_trains == 0 {
            return Err(BlockError::NoTrains);
        }
        if max_trains > sections {
            return Err(BlockError::MoreTrainsThanSections);
        }
        if pass.0 == 0 {
            return Err(BlockError::PassTooShort);
        }
        if pass.0 > MAX_TICKS {
            return Err(BlockError::PassTooLong);
        }
        Ok(Self { sections, max_trains, hold, pass })
    }

    /// [`Block::new`] with the pass time in milliseconds, rounded down to whole cycles of length `cycle`: its lapse restricts.
    ///
    /// # Errors
    /// A rule of BLK-8 that is broken.
    pub fn from_millis(
        sections: u8,
        max_trains: u8,
        hold: Hold,
        cycle: Millis,
        pass: Millis,
    ) -> Result<Self, BlockError> {
        let cycle = Cycle::new(cycle).ok_or(BlockError::NoCycle)?;
        Self::new(sections, max_trains, hold, cycle.at_most(pass).ok_or(BlockError::PassTooLong)?)
    }

    /// The number of sections, 1 to 16.
    pub const fn sections(self) -> u8 {
        self.sections
    }

    /// The most trains that may be in the block, 1 to [`Block::sections`].
    pub const fn max_trains(self) -> TrainCount {
        TrainCount(self.max_trains)
    }

    /// The sections that are held behind every head.
    pub const fn hold(self) -> Hold {
        self.hold
    }

    /// The longest that a passing train keeps the check-in on, in cycles.
    pub const fn pass(self) -> Ticks {
        self.pass
    }

    /// All sections of the block.
    pub const fn all(self) -> SectionSet {
        SectionSet::first(self.sections)
    }
}

/// What a block reads in one logic cycle.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Input {
    /// The check at the entry end is on: a train passes it, or the circuit has failed.
    pub check_in: bool,
    /// The check at the exit end is on.
    pub check_out: bool,
    /// The sections in which a detector hears a head. A section that the block does not have is ignored.
    pub present: SectionSet,
    /// A reset by staff, with the number of trains that they have verified to be in the block.
    pub reset: Option<TrainCount>,
    /// What the block ahead asks to hold on this side of the border, in this same cycle.
    pub ahead_hold: Hold,
    /// The block ahead has a train that is still pending here, or the line ends here.
    pub ahead_entered: bool,
}

/// What a block reports in one logic cycle.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Output {
    /// The sections that are occupied, or not shown to be free.
    pub occupied: SectionSet,
    /// What is asked of the block behind: to hold so many sections next to the border.
    pub behind_hold: Hold,
    /// The count is in force and equals the number of sections that detect.
    pub agree: bool,
    /// C2: check-ins less check-outs that took effect. 0 while unverified; frozen, but for pending check-outs, after a fault.
    pub count: TrainCount,
    /// Whether the count is in force.
    pub status: Status,
    /// A check-in was counted in this cycle.
    pub counted_in: bool,
    /// A check-out took effect in this cycle: the block ahead has the train.
    pub counted_out: bool,
}

/// Whether a block's count is in force.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Status {
    /// Nobody has verified the count since the start, or a reset was refused.
    Unverified,
    /// The count is in force.
    Counting,
    /// The count was contradicted, and is not in force until a reset.
    Fault(Fault),
}

/// What contradicted the count.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Fault {
    /// A train checked out of a block that had none left.
    CheckOutAtZero,
    /// A train checked in to a block that had its most.
    CheckInAtMaximum,
    /// The check-in stayed on for longer than a train takes to pass.
    CheckInStaysOn,
}

/// What the block remembers.
///
/// The fields are private so that only [`step`] moves them; [`Parts`] gives them to proofs, fault injection and
/// storage. `step` is total on every value.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct State {
    /// C2, pending check-outs included.
    count: u8,
    /// Check-outs that the block ahead has not taken over yet.
    pending: u8,
    /// Consecutive cycles with the check-in on, up to now; stops one above the pass time. 0: it was off.
    check_in_for: Ticks,
    /// Whether the check-out was on.
    check_out: bool,
    /// Whether the count is in force.
    status: Status,
}

/// The fields of a [`State`], for proofs, fault injection and storage.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Parts {
    /// C2, pending check-outs included: trains.
    pub count: u8,
    /// Check-outs that the block ahead has not taken over: trains.
    pub pending: u8,
    /// Consecutive cycles with the check-in on.
    pub check_in_for: u16,
    /// Whether the check-out was on.
    pub check_out: bool,
    /// Whether the count is in force.
    pub status: Status,
}

impl State {
    /// Unverified: everything is reported occupied. A check-out that is on at the start is no edge, one of a check-in is.
    pub const INITIAL: Self =
        Self { count: 0, pending: 0, check_in_for: Ticks(0), check_out: true, status: Status::Unverified };

    /// The invariant. Kept by [`step`]; every proof assumes it before a step and nothing more.
    pub const fn is_valid(&self, block: Block) -> bool {
        self.pending <= self.count
            && self.count <= block.max_trains
            && self.check_in_for.0 <= block.pass.0.saturating_add(1)
            && match self.status {
                Status::Unverified => self.count == 0,
                Status::Counting => self.check_in_for.0 <= block.pass.0,
                Status::Fault(_) => true,
            }
    }

    /// The state with these fields, valid or not.
    pub const fn from_parts(parts: Parts) -> Self {
        Self {
            count: parts.count,
            pending: parts.pending,
            check_in_for: Ticks(parts.check_in_for),
            check_out: parts.check_out,
            status: parts.status,
        }
    }

    /// The fields of the state.
    pub const fn parts(&self) -> Parts {
        Parts {
            count: self.count,
            pending: self.pending,
            check_in_for: self.check_in_for.0,
            check_out: self.check_out,
            status: self.status,
        }
    }
}

/// One logic cycle: the levels and detections throughout it, and what is reported from now on.
///
/// Within a cycle: faults, then edges, then the take-over by the block ahead, then a reset, then the comparison.
#[cfg_attr(kani, kani::ensures(|result| !state.is_valid(block) || result.0.is_valid(block)))]
#[cfg_attr(kani, kani::ensures(|result| result.1.agree || result.1.occupied.contains_all(block.all())))]
pub const fn step(block: Block, state: State, input: Input) -> (State, Output) {
    let present = input.present.and(block.all());
    let (counted, counted_in, counted_out) = count(block, state, input);
    let next = match input.reset {
        None => counted,
        Some(verified) => reset(block, state, counted, input, verified, present),
    };
    //= spec/block.md#blk-1-agreement
    //# While the count is in force and equals the number of sections that detect, the sections that detect MUST be reported occupied, and no others but those that are held.
    let agree = matches!(next.status, Status::Counting) && next.count == present.len();
    //= spec/block.md#blk-2-disagreement
    //# While the count is not in force or differs from the number of sections that detect, every section MUST be reported occupied.
    let heads = if agree { present } else { block.all() };
    let output = Output {
        occupied: occupied(block, heads, input.ahead_hold),
        behind_hold: behind_hold(block, heads, input.ahead_hold),
        agree,
        count: TrainCount(next.count),
        status: next.status,
        counted_in,
        counted_out,
    };
    (next, output)
}

/// Whether the check-in rises, counted or not.
pub(super) const fn rises(state: State, input: Input) -> bool {
    input.check_in && state.check_in_for.0 == 0
}

/// The state after the edges of this cycle, and whether a check-in was counted and a check-out took effect.
const fn count(block: Block, state: State, input: Input) -> (State, bool, bool) {
    let stays_on = block.pass.0.saturating_add(1);
    let check_in_for = match (input.check_in, state.check_in_for.0 < stays_on) {
        (false, _) => 0,
        (true, true) => state.check_in_for.0.saturating_add(1),
        (true, false) => stays_on,
    };
    let entering = rises(state, input);
    let leaving = input.check_out && !state.check_out;
    //= spec/block.md#blk-3-contradictions
    //# A check-in at the highest number of trains, a check-out when no train is left that is not pending, and a check-in that stays on for longer than the pass time MUST each latch a fault, judged by the count before the cycle.
    let fault = if check_in_for > block.pass.0 {
        Some(Fault::CheckInStaysOn)
    } else if entering && state.count >= block.max_trains {
        Some(Fault::CheckInAtMaximum)
    } else if leaving && state.count <= state.pending {
        Some(Fault::CheckOutAtZero)
    } else {
        None
    };
    let status = match (state.status, fault) {
        (Status::Counting, Some(fault)) => Status::Fault(fault),
        (status, _) => status,
    };
    //= spec/block.md#blk-7-edges
    //# While the count is in force it MUST change by exactly one for each rising edge of the check-in and for each check-out that takes effect, and while it is not in force no edge MUST be counted.
    let counting = matches!(status, Status::Counting);
    let counted_in = counting && entering;
    let pending = state.pending.saturating_add((counting && leaving) as u8);
    //= spec/block.md#blk-6-border
    //# A check-out MUST take effect only when the block ahead has the train, or the line ends there; until then the train stays in the count.
    let counted_out = pending > 0 && input.ahead_entered;
    let next = State {
        count: state.count.saturating_add(counted_in as u8).saturating_sub(counted_out as u8),
        pending: pending.saturating_sub(counted_out as u8),
        check_in_for: Ticks(check_in_for),
        check_out: input.check_out,
        status,
    };
    (next, counted_in, counted_out)
}

/// The state after a reset with the number `verified`.
const fn reset(
    block: Block,
    before: State,
    counted: State,
    input: Input,
    verified: TrainCount,
    present: SectionSet,
) -> State {
    //= spec/block.md#blk-4-reset
    //# A reset MUST be refused, and leave the count unverified, unless the verified number equals the number of sections that detect and is at most the highest number of trains, both checks are off, and no check-out is pending.
    let accepted = verified.0 == present.len()
        && verified.0 <= block.max_trains
        && !input.check_in
        && !input.check_out
        && before.pending == 0;
    let (count, status) = if accepted { (verified.0, Status::Counting) } else { (0, Status::Unverified) };
    State { count, pending: 0, check_in_for: counted.check_in_for, check_out: counted.check_out, status }
}

/// The heads, the sections that are held behind them, and those that the block ahead asks for.
const fn occupied(block: Block, heads: SectionSet, ahead: Hold) -> SectionSet {
    //= spec/block.md#blk-5-tail-hold
    //# The k sections behind every section with a head MUST be held occupied; of those that are beyond the entry end, and of those that the block ahead asks for beyond this block, the farther MUST be asked of the block behind.
    let asked = block.all().without(SectionSet::first(block.sections.saturating_sub(ahead.sections())));
    heads.with_sections_behind(block.hold).or(asked)
}

/// What is asked of the block behind.
const fn behind_hold(block: Block, heads: SectionSet, ahead: Hold) -> Hold {
    let own = if heads.is_empty() { Hold::NONE } else { block.hold.beyond(heads.nearest_to_entry()) };
    own.or_longer(ahead.beyond(block.sections))
}

impl Machine for Block {
    type State = State;
    type Input = Input;
    type Output = Output;

    /// Every section that a block can have, and everything behind it.
    const SAFE: Output = Output {
        occupied: SectionSet::ALL,
        behind_hold: Hold::MOST,
        agree: false,
        count: TrainCount(0),
        status: Status::Unverified,
        counted_in: false,
        counted_out: false,
    };

    fn initial(&self) -> State {
        State::INITIAL
    }

    fn step(&self, state: State, input: Input) -> (State, Output) {
        step(*self, state, input)
    }
}
