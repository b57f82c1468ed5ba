//! Train detection by block counting: theorems T-BLK-1 to T-BLK-6, over blocks of any size and lines of two of them.
//!
//! Every harness is one inductive step from any valid state, with any parameters and any input. Trains, heads and what
//! has gone wrong are ghosts.

mod count;
mod geometry;
mod line;
mod report;
mod reset;

use crate::{Engine, Harness, any_byte, any_flag};
use atc_kernel::block::{
    Block, Fault, Hold, Input, MAX_SECTIONS, Output, Parts, SectionSet, State, Status, TrainCount, step,
};
use atc_kernel::time::Ticks;

pub use count::{blk_8, blk_machine, blk_set, blk_total, t_blk_2, t_blk_3};
pub use geometry::{blk_9, blk_9_size, t_blk_4_geometry};
pub(crate) use line::any_detection;
pub use line::{blk_11, t_blk_3_border, t_blk_4_line, t_blk_5_line, t_blk_5_three};
pub use report::{t_blk_1, t_blk_4, t_blk_5_report, t_blk_6};
pub use reset::{t_blk_2_reset, t_blk_5};

/// The harnesses of this module.
#[cfg(not(chosen))]
pub const ALL: &[Harness] = &[
    t_blk_1::HARNESS,
    t_blk_2::HARNESS,
    t_blk_2_reset::HARNESS,
    t_blk_3::HARNESS,
    t_blk_3_border::HARNESS,
    t_blk_4::HARNESS,
    t_blk_4_line::HARNESS,
    t_blk_4_geometry::HARNESS,
    t_blk_5::HARNESS,
    t_blk_5_line::HARNESS,
    t_blk_5_three::HARNESS,
    t_blk_5_report::HARNESS,
    t_blk_6::HARNESS,
    blk_8::HARNESS,
    blk_9::HARNESS,
    blk_9_size::HARNESS,
    blk_11::HARNESS,
    blk_set::HARNESS,
    blk_total::HARNESS,
    blk_machine::HARNESS,
];

/// The longest loop: over the holds of 0 to 16 sections.
pub(crate) const LONGEST: usize = MAX_SECTIONS as usize + 1;

/// An arbitrary hold.
pub(crate) fn any_hold<E: Engine + ?Sized>(e: &mut E, what: &'static str, likely: u16) -> Option<Hold> {
    let hold = Hold::new(any_byte(e, what, 0..=likely));
    e.assume(hold.is_some());
    hold
}

/// An arbitrary valid block.
fn any_block<E: Engine + ?Sized>(e: &mut E) -> Option<Block> {
    let sections = any_byte(e, "sections", 1..=6);
    let max_trains = any_byte(e, "highest number of trains", 1..=u16::from(sections).max(1));
    let hold = any_hold(e, "tail hold (sections)", 3)?;
    let pass = e.word("pass time (cycles)", 1..=3);
    let block = Block::new(sections, max_trains, hold, Ticks(pass)).ok();
    e.assume(block.is_some());
    block
}

/// An arbitrary state, valid or not. The status that counts is the likely one.
pub(crate) fn any_parts<E: Engine + ?Sized>(e: &mut E, block: Block) -> Parts {
    let count = any_byte(e, "count (trains)", 0..=u16::from(block.max_trains().0));
    let pending = any_byte(e, "pending check-outs (trains)", 0..=u16::from(count));
    let check_in_for = e.word("check-in on for (cycles)", 0..=block.pass().0.saturating_add(1));
    let check_out = any_flag(e, "check-out was on (odd: yes)");
    let status = match e.word("status (0 unverified, 1 to 3 a fault, else counting)", 0..=7) {
        0 => Status::Unverified,
        1 => Status::Fault(Fault::CheckOutAtZero),
        2 => Status::Fault(Fault::CheckInAtMaximum),
        3 => Status::Fault(Fault::CheckInStaysOn),
        _ => Status::Counting,
    };
    Parts { count, pending, check_in_for, check_out, status }
}

/// An arbitrary input without a reset.
fn any_input<E: Engine + ?Sized>(e: &mut E, block: Block) -> Option<Input> {
    Some(Input {
        check_in: any_flag(e, "check-in (odd: on)"),
        check_out: any_flag(e, "check-out (odd: on)"),
        present: SectionSet::from_bits(e.word("detections (bits)", 0..=block.all().bits())),
        reset: None,
        ahead_hold: any_hold(e, "asked by the block ahead (sections)", 3)?,
        ahead_entered: any_flag(e, "the block ahead has the train (odd: yes)"),
    })
}

/// An arbitrary verified number, in one of two cases.
fn any_reset<E: Engine + ?Sized>(e: &mut E) -> Option<TrainCount> {
    let number = any_byte(e, "verified number (trains)", 0..=3);
    if any_flag(e, "a reset (odd: yes)") { Some(TrainCount(number)) } else { None }
}

/// One cycle of a block from an arbitrary valid state.
#[derive(Clone, Copy)]
struct Cycle {
    block: Block,
    before: Parts,
    input: Input,
    after: Parts,
    next: State,
    output: Output,
}

impl Cycle {
    /// The sections that detect and exist.
    fn detected(&self) -> u16 {
        self.input.present.bits() & all(self.block.sections())
    }

    /// The number of sections.
    fn sections(&self) -> u8 {
        self.block.sections()
    }

    fn counts(&self) -> bool {
        self.after.status == Status::Counting
    }
}

/// One cycle of a block from an arbitrary valid state, with or without a reset.
fn any_cycle<E: Engine + ?Sized>(e: &mut E) -> Option<Cycle> {
    let block = any_block(e)?;
    let before = any_parts(e, block);
    let state = State::from_parts(before);
    e.assume(state.is_valid(block));
    let input = Input { reset: any_reset(e), ..any_input(e, block)? };
    let (next, output) = step(block, state, input);
    Some(Cycle { block, before, input, after: next.parts(), next, output })
}

/// One cycle of a block from any state, valid or not, with or without a reset: for the contract of the step, which requires nothing.
#[cfg(kani)]
pub(crate) fn any_step(e: &mut crate::engine::model::Kani) -> Option<()> {
    let block = any_block(e)?;
    let state = State::from_parts(any_parts(e, block));
    let input = Input { reset: any_reset(e), ..any_input(e, block)? };
    let _ = step(block, state, input);
    Some(())
}

/// The heads of all trains in the block, by section, and how many trains there are: at least one for each head.
#[derive(Clone, Copy)]
struct Trains {
    heads: u16,
    number: u32,
}

fn any_trains<E: Engine + ?Sized>(e: &mut E, block: Block) -> Trains {
    let heads = e.word("sections with a head (bits)", 0..=block.all().bits()) & all(block.sections());
    let more = e.word("trains in a section with another", 0..=1);
    Trains { heads, number: ones(heads) + u32::from(more) }
}

/// Nothing is detected where no head is: no detector hears what is not there, none hears a head that its neighbour hears too, and none at a border
/// hears one that its block has not counted yet, or has let go.
pub(crate) fn suppose_no_phantom<E: Engine + ?Sized>(e: &mut E, detected: u16, heads: u16) {
    let only_heads = detected & !heads == 0;
    e.suppose("no-phantom", only_heads);
    e.suppose("heard-by-one", only_heads);
    e.suppose("loops-overlap", only_heads);
}

/// The count is not under the trains, if it is in force: by T-BLK-3, and so by all that it supposes.
pub(crate) fn suppose_count<E: Engine + ?Sized>(e: &mut E, not_under: bool) {
    e.suppose("entries-apart", not_under);
    e.suppose("check-in-fail-safe", not_under);
    e.suppose("live-transmitter", not_under);
    e.suppose("check-out-not-spurious", not_under);
    e.suppose("verified-reset", not_under);
    e.suppose("no-reversing-over-exit", not_under);
}

/// A bit for each of the first `count` sections, found the slow way.
fn all(count: u8) -> u16 {
    let mut bits = 0;
    for section in 0..16 {
        bits |= u16::from(section < count) << section;
    }
    bits
}

/// The number of bits that are set, found the slow way.
fn ones(bits: u16) -> u32 {
    let mut number = 0;
    for section in 0..16 {
        number += u32::from(bits >> section & 1);
    }
    number
}

/// Whether section `section` is in the set; not from 16 on.
fn has(bits: u16, section: u8) -> bool {
    section < 16 && bits >> (section & 15) & 1 == 1
}
