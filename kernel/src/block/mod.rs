//! Train detection by block counting: which sections are reported occupied (JPS5937270B2).
//!
//! A *block* is a chain of sections with a check of passing trains at either end and, in each section, a cheap detector
//! that may fail either way. The trains are counted twice: C2 by the checks at the ends, C1 by the detectors. While the
//! two agree, the sections where a detector hears a train are reported occupied; while they do not, all of them are.
//! A detector hears the *head* of a train, so the sections that its tail may still be in are held occupied behind it, across
//! the borders of blocks; and at a border a train leaves one count only once the next one has it.
//!
//! Requirements: `spec/block.md`, BLK-1 to BLK-11. Read in this order: [`Block`] (parameters), [`Input`] and [`Output`],
//! [`State`] with its `is_valid`, [`step`]; then [`Line`], which chains blocks.

pub use crate::distance::Metres;

mod count;
mod line;
mod section;

pub use count::{Block, BlockError, Fault, Input, Output, Parts, State, Status, step};
pub use line::{
    Beyond, Border, Detection, Direction, Line, LineError, LineInput, LineOutput, LineState, MAX_LINE_SECTIONS,
    hold_for,
};
pub use section::{Hold, MAX_SECTIONS, SectionSet, TrainCount};
