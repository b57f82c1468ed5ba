//! Train detection of a line: its blocks, the longest train and the hold that follows. Tables `[detection]` and `[[block]]`.

use atc_kernel::block::{Block, Direction, Hold, Line, LineError, Metres, hold_for};
use atc_kernel::time::Millis;

use crate::block;
use crate::check::{DataCheck, Outcome};
use crate::figures::{Derived, LineBlock};
use crate::form;
use crate::refusal::Refusal;
use crate::rule::Rule;

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

/// Checks the blocks; none if the line has no block counting. A refusal's field is a path in the file.
///
/// # Errors
/// The first rule that is broken.
pub(crate) fn checked(
    cycle_ms: u32,
    common: Option<&form::Detection>,
    blocks: &[form::Block],
) -> Result<Option<Detection>, Refusal> {
    let common = match (common, blocks) {
        (None, []) => return Ok(None),
        (None, _) => {
            let what = "there is a [[block]] and no [detection]: the longest train is needed";
            return Err(Refusal::new(Rule::Blk9, "block[0].max_trains", what));
        }
        (Some(_), []) => return Err(Refusal::new(Rule::Blk9, "detection", "there is [detection] and no [[block]]")),
        (Some(common), _) => common,
    };
    let train = Metres(common.longest_train_m);
    let pass_ms = common.pass_ms.unwrap_or(block::default_pass());
    let metres: Vec<_> = blocks.iter().flat_map(|block| &block.sections_m).map(|length| Metres(*length)).collect();
    let too_long = || {
        let what = format!("longest_train_m is {}; a train of this length needs more than 16 sections held", train.0);
        Refusal::new(Rule::Blk9, "detection.longest_train_m", what)
    };
    let least = hold_for(&metres, train).map_err(|_| too_long())?;
    let asked = common.hold_sections.map_or(Ok(least), |asked| block::hold("hold_sections", asked));
    let hold = asked.map_err(|refusal| Refusal { field: "detection.hold_sections".to_owned(), ..refusal })?;
    let one = |(number, given): (usize, &form::Block)| {
        let config = block::Config {
            sections: u32::try_from(given.sections_m.len()).unwrap_or(u32::MAX),
            max_trains: given.max_trains,
            tail_hold_sections: hold.sections().into(),
            cycle_ms,
            pass_ms,
        };
        let lengths = given.sections_m.iter().map(|length| Metres(*length)).collect();
        config.block().map(|block| (block, lengths)).map_err(|Refusal { rule, field, what }| {
            let field = match field.as_str() {
                "sections" => format!("block[{number}].sections_m"),
                "max_trains" => format!("block[{number}].max_trains"),
                "pass_ms" => "detection.pass_ms".to_owned(),
                _ => field,
            };
            Refusal { rule, field, what: format!("block {}: {what}", number + 1) }
        })
    };
    let checked = blocks.iter().enumerate().map(one).collect::<Result<Vec<_>, _>>()?;
    // The kernel's own constructor, so that nothing is checked by other words than its own.
    let kernel: Vec<_> = checked.iter().map(|(block, _)| *block).collect();
    line(&kernel, &metres, train).map_err(|error| {
        let last = format!("block[{}].sections_m", blocks.len().saturating_sub(1));
        let (field, what) = match error {
            LineError::TooManySections => (last, format!("at most 64 sections; there are {}", metres.len())),
            LineError::NoLength(place) => (section(blocks, place), "a section must have a length".to_owned()),
            LineError::HoldTooShort(place) => {
                let held: u32 =
                    metres.iter().skip(place).take(hold.sections().into()).map(|one| u32::from(one.0)).sum();
                let what = format!(
                    "what is held from here on ({} of the sections) is {held} m, and the longest train {} m; at least {} must be held",
                    hold.sections(),
                    train.0,
                    least.sections()
                );
                (section(blocks, place), what)
            }
            LineError::TrainTooLong => return too_long(),
            LineError::NoBlocks | LineError::LengthsDoNotMatch | LineError::HoldsDiffer(_) => {
                (last, format!("{error:?}"))
            }
        };
        Refusal::new(Rule::Blk9, field, what)
    })?;
    Ok(Some(Detection { train, pass: Millis(pass_ms), hold, least, cycle: Millis(cycle_ms), blocks: checked }))
}

/// The path in the file of a section of the line, by its number from the low end.
fn section(blocks: &[form::Block], mut place: usize) -> String {
    for (number, block) in blocks.iter().enumerate() {
        match place.checked_sub(block.sections_m.len()) {
            Some(rest) => place = rest,
            None => return format!("block[{number}].sections_m[{place}]"),
        }
    }
    "block".to_owned()
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
    /// The configuration of each block, from the low end of the line.
    pub fn configs(&self) -> Vec<block::Config> {
        self.blocks.iter().map(|(block, _)| block::Config::of(*block, self.cycle)).collect()
    }

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
    pub fn checks(&self) -> Vec<DataCheck> {
        let sections: usize = self.blocks.iter().map(|(_, lengths)| lengths.len()).sum();
        let met = |rule, scope: String| DataCheck::new(rule, scope, Outcome::Met);
        vec![
            met(Rule::Blk8, format!("{} blocks", self.blocks.len())),
            met(
                Rule::Blk9,
                format!("{sections} sections; any {} consecutive ones cover {} m", self.hold.sections(), self.train.0),
            ),
            met(Rule::Blk3, format!("{} ms", self.pass.0)),
        ]
    }

    /// The longest train that the hold covers.
    pub const fn longest_train(&self) -> Metres {
        self.train
    }

    /// How many sections are held behind every head.
    pub const fn hold(&self) -> Hold {
        self.hold
    }

    /// The blocks in the kernel's form, from the low end, each with the lengths of its sections.
    pub fn kernel(&self) -> &[(Block, Vec<Metres>)] {
        &self.blocks
    }
}
