//! Train detection of a line: its blocks, the longest train and the hold that follows. Tables `[detection]` and `[[block]]`.

use crate::case::{Derived, LineBlock};
use crate::error::Fault;
use atc_kernel::block::{Block, BlockError, Direction, Hold, Line, LineError, Metres, hold_for};
use atc_kernel::time::Millis;
use serde::Deserialize;
use std::ops::Range;
use toml::Spanned;

/// `[detection]`: what all blocks have in common.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct FileDetection {
    /// From the antenna to the last point that must be protected.
    longest_train_m: Spanned<u16>,
    /// The longest that a passing train keeps the check-in on.
    #[serde(default)]
    pass_ms: Option<Spanned<u32>>,
    /// The hold, if it is not to be the least one.
    #[serde(default)]
    hold_sections: Option<Spanned<u8>>,
}

/// `[[block]]`: one block, from the low end of the line.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct FileBlock {
    /// The most trains that may be in it.
    max_trains: Spanned<u8>,
    /// The lengths of its sections, from the low end.
    sections_m: Spanned<Vec<Spanned<u16>>>,
}

/// Where the pass time is not given.
const PASS: Millis = Millis(10_000);

/// The checked blocks of a line.
#[derive(Clone, Debug)]
pub struct Detection {
    train: Metres,
    pass: Millis,
    hold: Hold,
    least: Hold,
    cycle: Millis,
    blocks: Vec<(Block, Vec<Metres>)>,
}

/// Reads and checks the blocks; none if the line has no block counting.
///
/// # Errors
/// The first rule that is broken, with its place.
pub fn parse(
    source: &str,
    at: &dyn Fn(Range<usize>) -> String,
    cycle: Millis,
    common: Option<&FileDetection>,
    blocks: &[FileBlock],
) -> Result<Option<Detection>, Fault> {
    let common = match (common, blocks) {
        (None, []) => return Ok(None),
        (None, [first, ..]) => {
            let place = at(first.max_trains.span());
            return Err(Fault::new(&place, "there is a [[block]] and no [detection]: the longest train is needed"));
        }
        (Some(_), []) => {
            return Err(Fault::new(&source, "rule BLK-9 is broken: there is [detection] and no [[block]]"));
        }
        (Some(common), _) => common,
    };
    let train = Metres(*common.longest_train_m.get_ref());
    let pass = common.pass_ms.as_ref().map_or(PASS, |pass| Millis(*pass.get_ref()));
    let lengths: Vec<&Spanned<u16>> = blocks.iter().flat_map(|block| block.sections_m.get_ref()).collect();
    let metres: Vec<_> = lengths.iter().map(|length| Metres(*length.get_ref())).collect();
    let too_long = || {
        let text = "rule BLK-9 is broken: a train of this length needs more than 16 sections held";
        Fault::new(&at(common.longest_train_m.span()), format!("{text}; it is {} m", train.0))
    };
    let least = hold_for(&metres, train).map_err(|_| too_long())?;
    let hold = match &common.hold_sections {
        None => least,
        Some(asked) => Hold::new(*asked.get_ref()).ok_or_else(|| {
            let text = format!("rule BLK-9 is broken: at most 16 sections can be held; it is {}", asked.get_ref());
            Fault::new(&at(asked.span()), text)
        })?,
    };
    let checked = blocks
        .iter()
        .zip(1..)
        .map(|(block, number)| one(at, cycle, common, (block, number), (hold, pass)))
        .collect::<Result<Vec<_>, _>>()?;
    // The kernel's own constructor, so that nothing is checked by other words than its own.
    let kernel: Vec<_> = checked.iter().map(|(block, _)| *block).collect();
    line(&kernel, &metres, train).map_err(|error| {
        let last = blocks.last().map_or(0..0, |block| block.sections_m.span());
        let section = |place: usize| lengths.get(place).map_or_else(|| last.clone(), |length| length.span());
        let (span, rule) = match error {
            LineError::TooManySections => (last, format!("at most 64 sections; there are {}", metres.len())),
            LineError::NoLength(place) => (section(place), "a section must have a length".to_owned()),
            LineError::HoldTooShort(place) => {
                let held: u32 = metres.iter().skip(place).take(hold.sections().into()).map(|one| u32::from(one.0)).sum();
                let text = format!(
                    "what is held from here on ({} of the sections) is {held} m, and the longest train {} m; at least {} must be held",
                    hold.sections(),
                    train.0,
                    least.sections()
                );
                (section(place), text)
            }
            LineError::TrainTooLong => return too_long(),
            LineError::NoBlocks | LineError::LengthsDoNotMatch | LineError::HoldsDiffer(_) => {
                (last, format!("{error:?}"))
            }
        };
        Fault::new(&at(span), format!("rule BLK-9 is broken: {rule}"))
    })?;
    Ok(Some(Detection { train, pass, hold, least, cycle, blocks: checked }))
}

fn one(
    at: &dyn Fn(Range<usize>) -> String,
    cycle: Millis,
    common: &FileDetection,
    (block, number): (&FileBlock, usize),
    (hold, pass): (Hold, Millis),
) -> Result<(Block, Vec<Metres>), Fault> {
    let lengths: Vec<_> = block.sections_m.get_ref().iter().map(|length| Metres(*length.get_ref())).collect();
    let sections = u8::try_from(lengths.len()).unwrap_or(u8::MAX);
    let pass_span = || common.pass_ms.as_ref().map_or_else(|| common.longest_train_m.span(), Spanned::span);
    let checked = Block::from_millis(sections, *block.max_trains.get_ref(), hold, cycle, pass).map_err(|error| {
        let (span, rule) = match error {
            BlockError::NoSections => (block.sections_m.span(), "it has no section".to_owned()),
            BlockError::TooManySections => {
                (block.sections_m.span(), format!("at most 16 sections; there are {}", lengths.len()))
            }
            BlockError::NoTrains => (block.max_trains.span(), "at least one train must be allowed in it".to_owned()),
            BlockError::MoreTrainsThanSections => (
                block.max_trains.span(),
                format!("at most as many trains as sections ({}); it is {}", lengths.len(), block.max_trains.get_ref()),
            ),
            BlockError::NoCycle => (pass_span(), "the logic cycle must be 1 ms or more".to_owned()),
            BlockError::PassTooShort => (
                pass_span(),
                format!("the pass time must be one logic cycle or more (it rounds down); it is {} ms", pass.0),
            ),
            BlockError::PassTooLong => {
                (pass_span(), format!("the pass time must not exceed 60 000 logic cycles; it is {} ms", pass.0))
            }
        };
        Fault::new(&at(span), format!("rule BLK-8 is broken, block {number}: {rule}"))
    })?;
    Ok((checked, lengths))
}

/// The kernel's constructor of a line, for as many blocks as there are. More than 64 blocks have more than 64 sections.
fn line(blocks: &[Block], lengths: &[Metres], train: Metres) -> Result<(), LineError> {
    fn of<const B: usize>(blocks: &[Block], lengths: &[Metres], train: Metres) -> Option<Result<(), LineError>> {
        let blocks: [Block; B] = blocks.try_into().ok()?;
        Some(
            [Direction::Up, Direction::Down]
                .iter()
                .try_for_each(|way| Line::new(blocks, lengths, train, *way).map(|_| ())),
        )
    }
    macro_rules! any_of {
        ($($number:literal)*) => { None$(.or_else(|| of::<$number>(blocks, lengths, train)))* };
    }
    let found = any_of!(
        0 1 2 3 4 5 6 7 8 9 10 11 12 13 14 15 16 17 18 19 20 21 22 23 24 25 26 27 28 29 30 31 32 33 34 35 36 37 38 39 40
        41 42 43 44 45 46 47 48 49 50 51 52 53 54 55 56 57 58 59 60 61 62 63 64
    );
    found.unwrap_or(Err(LineError::TooManySections))
}

impl Detection {
    /// Its blocks, for the case.
    pub fn blocks(&self) -> Vec<LineBlock> {
        let block = |(block, lengths): &(Block, Vec<Metres>)| LineBlock {
            sections_m: lengths.iter().map(|length| length.0).collect(),
            max_trains: block.max_trains().0,
        };
        self.blocks.iter().map(block).collect()
    }

    /// What follows.
    pub fn derived(&self) -> Vec<Derived> {
        let row = Derived::row;
        let ticks = self.blocks.first().map_or(0, |(block, _)| block.pass().0);
        vec![
            row(
                "Sections held behind every head",
                format!("{} (for {} m)", self.hold.sections(), self.train.0),
                "least k so that any k consecutive sections are as long as the longest train",
                "T-BLK-4",
            ),
            row("Shortest held length", self.shortest(), "least sum of k consecutive sections", "T-BLK-4"),
            row(
                "Check-in may stay on for",
                format!("{} ms ({ticks} cycles)", u64::from(ticks) * u64::from(self.cycle.0)),
                "pass time, rounded down; trains must enter at least so far apart",
                "T-BLK-3",
            ),
        ]
    }

    /// The shortest stretch of as many sections as are held, and its margin to the longest train.
    fn shortest(&self) -> String {
        let lengths: Vec<_> = self.blocks.iter().flat_map(|(_, lengths)| lengths).map(|one| u32::from(one.0)).collect();
        let held = usize::from(self.hold.sections());
        if held == 0 {
            return "nothing is held".to_owned();
        }
        match lengths.windows(held).map(|some| some.iter().sum::<u32>()).min() {
            Some(metres) => format!("{metres} m, {} m more than the train", metres.saturating_sub(self.train.0.into())),
            None => "longer than the line: what lies before its entry must hold the rest".to_owned(),
        }
    }

    /// What the user should look at.
    pub fn notes(&self) -> Vec<String> {
        let mut notes = vec![
            "Sections before the line's entry are not in this file. The line asks for a number of sections there, not for a \
             length: see the condition line-end-asks."
                .to_owned(),
        ];
        if self.hold > self.least {
            notes.push(format!(
                "{} sections are held behind every head, and {} would be enough.",
                self.hold.sections(),
                self.least.sections()
            ));
        }
        if self.train.0 == 0 {
            notes.push("The longest train has no length: nothing is held for tails.".to_owned());
        }
        for ((block, lengths), number) in self.blocks.iter().zip(1..) {
            if lengths.len() == 1 {
                notes.push(format!("Block {number} has one section: its detector adds nothing but a second opinion."));
            }
            if block.hold().sections() >= block.sections() {
                notes.push(format!("A train holds the whole of block {number} until its head is far in the next one."));
            }
        }
        notes
    }

    /// The data checks that were made.
    pub fn checks(&self) -> Vec<String> {
        let sections: usize = self.blocks.iter().map(|(_, lengths)| lengths.len()).sum();
        vec![
            format!("BLK-8: {} blocks are accepted by the kernel's constructor", self.blocks.len()),
            format!(
                "BLK-9: the line of {sections} sections is accepted by the kernel's constructor, in both directions; any {} \
                 consecutive sections cover {} m",
                self.hold.sections(),
                self.train.0
            ),
            format!("BLK-3: the pass time of {} ms is rounded down, as its lapse restricts", self.pass.0),
        ]
    }
}

#[cfg(test)]
#[path = "detection_tests.rs"]
mod tests;
