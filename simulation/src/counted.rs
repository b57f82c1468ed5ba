//! Lines on which trains are counted: which they are, and what a device reads of them.

use atc_kernel::block::{Detection, SectionSet};
use serde::{Deserialize, Serialize};

use crate::bound::Bound;

/// The most blocks of a counted line here.
pub const MAX_BLOCKS: usize = 2;
/// A counted line as a line file has it.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct CountedFile {
    /// The name that both stations give the line.
    pub line: String,
    /// The circuits of each block, one a section, in the direction of travel: one or two blocks.
    pub blocks: Vec<Vec<String>>,
}

/// A counted line.
#[derive(Clone, Debug)]
pub struct Counted {
    /// Which of the lines.
    pub link: usize,
    /// The direction of its trains.
    pub bound: Bound,
    /// The circuits of each block, in the direction of travel.
    pub blocks: Vec<Vec<usize>>,
}

/// What one station's device reads of its counted line in a cycle.
pub type Detections = [Detection; MAX_BLOCKS];

/// Nothing is heard.
pub const SILENT: Detections =
    [Detection { low_check: false, high_check: false, present: SectionSet::EMPTY, reset: None }; MAX_BLOCKS];

/// Since when a block disagrees at a station, in ms.
pub type Disagreeing = [Option<u64>; MAX_BLOCKS];
