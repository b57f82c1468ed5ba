//! A line: blocks chained in the direction of travel, with what passes over their borders.

use super::count::rises;
use super::{Block, Hold, Input, Output, SectionSet, State, Status, TrainCount, step};
use crate::Machine;
use crate::distance::Metres;

/// The most sections that a line may have.
pub const MAX_LINE_SECTIONS: usize = 64;

/// The direction of travel. Blocks and sections of a line are numbered from its low end; a block's own, and its state,
/// from the entry end.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Direction {
    /// From the low end to the high end.
    Up,
    /// From the high end to the low end.
    Down,
}

/// `B` blocks in a row from the low end, checked: together at most [`MAX_LINE_SECTIONS`] sections, all with the same hold,
/// which is long enough for the longest train wherever its head is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Line<const B: usize> {
    blocks: [Block; B],
    direction: Direction,
}

/// Which rule a line breaks. Source: `spec/block.md`, BLK-9.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LineError {
    /// The line has no block.
    NoBlocks,
    /// The line has more than [`MAX_LINE_SECTIONS`] sections.
    TooManySections,
    /// There are not as many lengths as sections.
    LengthsDoNotMatch,
    /// A section, numbered from 0 at the low end, has no length.
    NoLength(usize),
    /// A block, numbered from 0 at the low end, has another hold than the first.
    HoldsDiffer(usize),
    /// The sections that are held from this one on, numbered from 0 at the low end, are shorter than the longest train.
    HoldTooShort(usize),
    /// A train of this length would need more than 16 sections held.
    TrainTooLong,
}

/// The fewest sections that must be held behind a head so that no train of length `train` reaches beyond them, on a line of
/// sections of these `lengths`, whichever way it travels.
///
/// # Errors
/// [`LineError::TrainTooLong`] if 16 sections are too few.
pub fn hold_for(lengths: &[Metres], train: Metres) -> Result<Hold, LineError> {
    let mut sections = 0;
    while let Some(hold) = Hold::new(sections) {
        if short_window(lengths, hold, train).is_none() {
            return Ok(hold);
        }
        sections += 1;
    }
    Err(LineError::TrainTooLong)
}

/// The first section of the first `hold` consecutive ones that are together shorter than `train`.
fn short_window(lengths: &[Metres], hold: Hold, train: Metres) -> Option<usize> {
    let hold = usize::from(hold.sections());
    let mut first = 0;
    while first < lengths.len() && hold <= lengths.len() - first {
        let mut length: u32 = 0;
        let mut section = first;
        while section - first < hold {
            length = length.saturating_add(u32::from(lengths[section].0));
            section += 1;
        }
        if length < u32::from(train.0) {
            return Some(first);
        }
        first += 1;
    }
    None
}

impl<const B: usize> Line<B> {
    /// A line of `blocks`, with the `lengths` of all their sections and the length of the longest train (its nose to the last
    /// point that must be protected), all from the low end.
    ///
    /// # Errors
    /// A rule of BLK-9 that is broken.
    pub fn new(blocks: [Block; B], lengths: &[Metres], train: Metres, direction: Direction) -> Result<Self, LineError> {
        //= spec/block.md#blk-9-the-line
        //# The constructor MUST reject a line without blocks, with more than 64 sections, with a section without length, with blocks of different holds, or with k consecutive sections, across borders too, that are together shorter than the longest train.
        let Some(lowest) = blocks.first() else {
            return Err(LineError::NoBlocks);
        };
        let mut sections = 0;
        for (number, block) in blocks.iter().enumerate() {
            sections += usize::from(block.sections());
            if block.hold() != lowest.hold() {
                return Err(LineError::HoldsDiffer(number));
            }
        }
        if sections > MAX_LINE_SECTIONS {
            return Err(LineError::TooManySections);
        }
        if sections != lengths.len() {
            return Err(LineError::LengthsDoNotMatch);
        }
        for (number, length) in lengths.iter().enumerate() {
            if length.0 == 0 {
                return Err(LineError::NoLength(number));
            }
        }
        match short_window(lengths, lowest.hold(), train) {
            Some(first) => Err(LineError::HoldTooShort(first)),
            None => Ok(Self { blocks, direction }),
        }
    }

    /// The blocks, from the low end.
    pub const fn blocks(&self) -> &[Block; B] {
        &self.blocks
    }

    /// The direction of travel.
    pub const fn direction(&self) -> Direction {
        self.direction
    }
}

/// What the detectors and checks of one block say in one logic cycle, from the low end.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Detection {
    /// The check at the low end is on.
    pub low_check: bool,
    /// The check at the high end is on.
    pub high_check: bool,
    /// The sections in which a detector hears a head, section 0 at the low end.
    pub present: SectionSet,
    /// A reset by staff, with the number of trains that they have verified.
    pub reset: Option<TrainCount>,
}

/// What lies beyond the exit end of the line.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Beyond {
    /// How many sections at the exit end must be held for trains whose heads are beyond it.
    pub hold: Hold,
    /// A train that leaves is taken over at once, or has been in this cycle.
    pub entered: bool,
}

/// What a line reads in one logic cycle: its blocks from the low end, and what lies beyond its exit.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct LineInput<const B: usize> {
    /// The blocks, from the low end.
    pub blocks: [Detection; B],
    /// Beyond the exit.
    pub beyond: Beyond,
}

/// What a line reports in one logic cycle.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct LineOutput<const B: usize> {
    /// The blocks, from the low end; their sections numbered from the low end too.
    pub blocks: [Output; B],
    /// How many sections before the line's entry must be held.
    pub before_hold: Hold,
}

/// A border between two blocks: trains whose check-in ahead has risen and that the block behind has not let go yet, 0 to 16.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub struct Border(pub u8);

impl Border {
    /// No more is remembered: what is lost in excess only keeps a train in a count for longer.
    pub const MOST: Self = Self(super::MAX_SECTIONS);

    /// With one train more, unless 16 are remembered.
    const fn with_one(self) -> Self {
        if self.0 < Self::MOST.0 { Self(self.0.saturating_add(1)) } else { self }
    }

    /// Whether the block ahead takes over a train in this cycle.
    const fn takes_over(self) -> bool {
        //= spec/block.md#blk-10-take-over
        //# A block MUST take over one train from the block behind for each rising edge of its check-in, however long before and whether it was counted or not, and no others.
        self.0 > 0
    }

    /// Without what the block behind has let go in this cycle. A reset on either side, or a block behind that does not count,
    /// ends the account: what was checked in until then has been verified, or will be.
    const fn let_go(self, behind: Output, reset: bool) -> Self {
        match behind.status {
            Status::Counting if !reset => Self(self.0.saturating_sub(behind.counted_out as u8)),
            _ => Self(0),
        }
    }
}

/// What a line remembers: its blocks and borders from the entry, wherever that is. Any values are a state; the invariant is
/// [`LineState::is_valid`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct LineState<const B: usize> {
    /// The blocks, in the direction of travel.
    pub blocks: [State; B],
    /// The border behind each block, in the direction of travel. The first is the line's entry and is not used.
    pub borders: [Border; B],
}

impl<const B: usize> LineState<B> {
    /// Every block unverified.
    pub const INITIAL: Self = Self { blocks: [State::INITIAL; B], borders: [Border(0); B] };

    /// The invariant of `line`: every block's, and a border remembers nothing unless the block behind it counts.
    pub fn is_valid(&self, line: &Line<B>) -> bool {
        let counts = |place: usize| matches!(self.blocks[place].parts().status, Status::Counting);
        let mut valid = true;
        for place in 0..B {
            let border = self.borders[place];
            valid &= self.blocks[place].is_valid(line.blocks[line.at(place)]);
            valid &= border.0 <= Border::MOST.0;
            valid &= border.0 == 0 || place > 0 && counts(place - 1);
        }
        valid
    }
}

impl<const B: usize> Line<B> {
    /// The number from the low end of the block at `place` in the direction of travel.
    const fn at(&self, place: usize) -> usize {
        match self.direction {
            Direction::Up => place,
            Direction::Down => B - 1 - place,
        }
    }

    /// A detection as a block reads it: from the entry end.
    const fn orient(&self, block: Block, detection: Detection, ahead_hold: Hold, ahead_entered: bool) -> Input {
        //= spec/block.md#blk-11-direction
        //# On a line travelled downwards a block's check-in MUST be its check at the high end, and sections MUST be read and reported from that end.
        let (check_in, check_out, present) = match self.direction {
            Direction::Up => (detection.low_check, detection.high_check, detection.present),
            Direction::Down => {
                (detection.high_check, detection.low_check, detection.present.reversed(block.sections()))
            }
        };
        Input { check_in, check_out, present, reset: detection.reset, ahead_hold, ahead_entered }
    }
}

impl<const B: usize> Machine for Line<B> {
    type State = LineState<B>;
    type Input = LineInput<B>;
    type Output = LineOutput<B>;

    const SAFE: LineOutput<B> = LineOutput { blocks: [Block::SAFE; B], before_hold: Hold::MOST };

    fn initial(&self) -> LineState<B> {
        LineState::INITIAL
    }

    /// One logic cycle: the blocks from the exit to the entry, so that what is asked and taken over at a border belongs to
    /// this same cycle.
    fn step(&self, state: LineState<B>, input: LineInput<B>) -> (LineState<B>, LineOutput<B>) {
        let mut next = state;
        let mut output = Self::SAFE;
        let mut hold = input.beyond.hold;
        let mut entered = input.beyond.entered;
        let (mut border, mut reset) = (Border(0), false);
        for place in (0..B).rev() {
            let number = self.at(place);
            let (block, detection) = (self.blocks[number], input.blocks[number]);
            let (before, read) = (state.blocks[place], self.orient(block, detection, hold, entered));
            let (after, report) = step(block, before, read);
            next.blocks[place] = after;
            if place + 1 < B {
                next.borders[place + 1] = border.let_go(report, reset || detection.reset.is_some());
            }
            border = state.borders[place];
            if rises(before, read) {
                border = border.with_one();
            }
            reset = detection.reset.is_some();
            entered = border.takes_over();
            hold = report.behind_hold;
            output.blocks[number] = match self.direction {
                Direction::Up => report,
                Direction::Down => Output { occupied: report.occupied.reversed(block.sections()), ..report },
            };
        }
        // No block is behind the first one.
        if let Some(first) = next.borders.first_mut() {
            *first = Border(0);
        }
        output.before_hold = hold;
        (next, output)
    }
}
