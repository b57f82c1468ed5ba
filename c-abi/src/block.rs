//! Block counting behind the border: [`atc_kernel::block`], one block of a line.

use atc_kernel::block::{
    self, Block, BlockError, Fault, Hold, Input, Output, Parts, SectionSet, State, Status, TrainCount,
};
use atc_kernel::time::{Millis, Ticks};

use crate::memory::{Machine, Reader, Writer};
use crate::{atc_status, flag};

/// The size of a block in bytes.
pub const ATC_BLOCK_SIZE: usize = 40;
/// The alignment of a block in bytes.
pub const ATC_BLOCK_ALIGN: usize = 8;

/// Nobody has verified the count since the start, or a reset was refused.
pub const ATC_BLOCK_UNVERIFIED: u32 = 0;
/// The count is in force.
pub const ATC_BLOCK_COUNTING: u32 = 1;
/// A train checked out of a block that had none left. The count is not in force until a reset.
pub const ATC_BLOCK_CHECK_OUT_AT_ZERO: u32 = 2;
/// A train checked in to a block that had its most. The count is not in force until a reset.
pub const ATC_BLOCK_CHECK_IN_AT_MAXIMUM: u32 = 3;
/// The check-in stayed on for longer than a train takes to pass. The count is not in force until a reset.
pub const ATC_BLOCK_CHECK_IN_STAYS_ON: u32 = 4;

/// A block with its state. Its bytes are the library's; it may be moved and copied as a whole.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct atc_block {
    /// Not to be read or written.
    pub opaque: [u64; 5],
}

/// The parameters of a block.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct atc_block_config {
    /// The length of a logic cycle in ms, 1 or more.
    pub cycle_ms: u32,
    /// The longest that a passing train keeps the check-in on. Rounded down to cycles.
    pub pass_ms: u32,
    /// How many sections the block has: 1 to 16.
    pub sections: u8,
    /// The most trains that may be in it: 1 to that many.
    pub max_trains: u8,
    /// How many sections are held occupied behind every head: 0 to 16.
    pub tail_hold_sections: u8,
}

/// One logic cycle's input.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct atc_block_input {
    /// The sections in which a detector hears a head: bit `i` for section `i`, 0 at the entry end.
    pub present: u16,
    /// 1: the check at the entry end is on. 0: it is off.
    pub check_in: u8,
    /// 1: the check at the exit end is on. 0: it is off.
    pub check_out: u8,
    /// 1: staff reset the count in this cycle. 0: no reset.
    pub has_reset: u8,
    /// The number of trains that staff have verified. Not looked at if `has_reset` is 0.
    pub reset: u8,
    /// How many sections the block ahead asks to hold on this side of the border: 0 to 16.
    pub ahead_hold_sections: u8,
    /// 1: the block ahead has a train that is still pending here, or the line ends here. 0: neither.
    pub ahead_entered: u8,
}

/// One logic cycle's output. The safe one is everything occupied, 16 sections held, nothing counted.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct atc_block_output {
    /// Whether the count is in force, or what contradicted it: one of the `ATC_BLOCK_` constants.
    pub status: u32,
    /// The sections that are occupied, or not shown to be free: bit `i` for section `i`.
    pub occupied: u16,
    /// How many sections the block behind is asked to hold on its side of the border: 0 to 16.
    pub behind_hold_sections: u8,
    /// 1: the count is in force and equals the number of sections that detect.
    pub agree: u8,
    /// Trains, pending check-outs included.
    pub count: u8,
    /// 1: a check-in was counted in this cycle.
    pub counted_in: u8,
    /// 1: a check-out took effect in this cycle.
    pub counted_out: u8,
}

pub(crate) struct Counted;

/// The kernel's parameters of a configuration.
pub(crate) fn parameters(config: &atc_block_config) -> Result<Block, atc_status> {
    let hold = Hold::new(config.tail_hold_sections).ok_or(atc_status::HoldTooLong)?;
    let (cycle, pass) = (Millis(config.cycle_ms), Millis(config.pass_ms));
    Block::from_millis(config.sections, config.max_trains, hold, cycle, pass).map_err(|error| match error {
        BlockError::NoSections => atc_status::NoSections,
        BlockError::TooManySections => atc_status::TooManySections,
        BlockError::NoTrains => atc_status::NoTrains,
        BlockError::MoreTrainsThanSections => atc_status::MoreTrainsThanSections,
        BlockError::NoCycle => atc_status::NoCycle,
        BlockError::PassTooShort => atc_status::PassTooShort,
        BlockError::PassTooLong => atc_status::TimeTooLong,
    })
}

const fn number(status: Status) -> u32 {
    match status {
        Status::Unverified => ATC_BLOCK_UNVERIFIED,
        Status::Counting => ATC_BLOCK_COUNTING,
        Status::Fault(Fault::CheckOutAtZero) => ATC_BLOCK_CHECK_OUT_AT_ZERO,
        Status::Fault(Fault::CheckInAtMaximum) => ATC_BLOCK_CHECK_IN_AT_MAXIMUM,
        Status::Fault(Fault::CheckInStaysOn) => ATC_BLOCK_CHECK_IN_STAYS_ON,
    }
}

const fn status(number: u32) -> Option<Status> {
    match number {
        ATC_BLOCK_UNVERIFIED => Some(Status::Unverified),
        ATC_BLOCK_COUNTING => Some(Status::Counting),
        ATC_BLOCK_CHECK_OUT_AT_ZERO => Some(Status::Fault(Fault::CheckOutAtZero)),
        ATC_BLOCK_CHECK_IN_AT_MAXIMUM => Some(Status::Fault(Fault::CheckInAtMaximum)),
        ATC_BLOCK_CHECK_IN_STAYS_ON => Some(Status::Fault(Fault::CheckInStaysOn)),
        _ => None,
    }
}

const fn output(output: Output) -> atc_block_output {
    atc_block_output {
        status: number(output.status),
        occupied: output.occupied.bits(),
        behind_hold_sections: output.behind_hold.sections(),
        agree: output.agree as u8,
        count: output.count.0,
        counted_in: output.counted_in as u8,
        counted_out: output.counted_out as u8,
    }
}

impl Machine for Counted {
    const TAG: [u8; 4] = *b"BLCK";
    const PARAMETERS: usize = 8;
    type Parameters = Block;
    type State = State;
    type Input = atc_block_input;
    type Output = atc_block_output;
    const SAFE: Self::Output = output(<Block as atc_kernel::Machine>::SAFE);

    fn initial(_: &Block) -> State {
        State::INITIAL
    }

    fn put_parameters(block: &Block, to: &mut Writer<'_>) {
        to.u8(block.sections());
        to.u8(block.max_trains().0);
        to.u8(block.hold().sections());
        to.u16(block.pass().0);
    }

    fn take_parameters(from: &mut Reader<'_>) -> Option<Block> {
        Block::new(from.u8()?, from.u8()?, Hold::new(from.u8()?)?, Ticks(from.u16()?)).ok()
    }

    fn put_state(state: &State, to: &mut Writer<'_>) {
        let parts = state.parts();
        to.u8(parts.count);
        to.u8(parts.pending);
        to.u16(parts.check_in_for);
        to.flag(parts.check_out);
        // One of five.
        to.u8(u8::try_from(number(parts.status)).unwrap_or(u8::MAX));
    }

    fn take_state(block: &Block, from: &mut Reader<'_>) -> Option<State> {
        let parts = Parts {
            count: from.u8()?,
            pending: from.u8()?,
            check_in_for: from.u16()?,
            check_out: from.flag()?,
            status: status(from.u8()?.into())?,
        };
        let state = State::from_parts(parts);
        state.is_valid(*block).then_some(state)
    }

    fn step(block: &Block, state: State, input: &atc_block_input) -> Result<(State, atc_block_output), atc_status> {
        let present = SectionSet::from_bits(input.present);
        if !present.without(block.all()).is_empty() {
            return Err(atc_status::UnknownSection);
        }
        let input = Input {
            check_in: flag(input.check_in)?,
            check_out: flag(input.check_out)?,
            present,
            reset: flag(input.has_reset)?.then_some(TrainCount(input.reset)),
            ahead_hold: Hold::new(input.ahead_hold_sections).ok_or(atc_status::HoldTooLong)?,
            ahead_entered: flag(input.ahead_entered)?,
        };
        let (state, said) = block::step(*block, state, input);
        Ok((state, output(said)))
    }
}
