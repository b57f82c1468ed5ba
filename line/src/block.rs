//! The parameters of one block of train detection.

use atc_kernel::block::{Block, BlockError, Hold};
use atc_kernel::time::{MAX_TICKS, Millis};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::refusal::{Refusal, no_cycle, short};
use crate::rule::Rule;

/// The configuration of a block.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(rename = "BlockConfig")]
pub struct Config {
    /// How many sections the block has: 1 to 16.
    pub sections: u32,
    /// The most trains that may be in it: 1 to that many.
    pub max_trains: u32,
    /// How many sections are held occupied behind every head: 0 to 16.
    pub tail_hold_sections: u32,
    /// The length of a logic cycle.
    #[serde(default = "default_cycle")]
    pub cycle_ms: u32,
    /// The longest that a passing train keeps the check-in on. Rounded down to cycles.
    #[serde(default = "default_pass")]
    pub pass_ms: u32,
}

const fn default_cycle() -> u32 {
    10
}

/// The pass time where none is given, in ms.
pub(crate) const fn default_pass() -> u32 {
    10_000
}

impl Config {
    /// The parameters of a block in cycles of this length.
    pub fn of(block: Block, cycle: Millis) -> Self {
        Self {
            sections: block.sections().into(),
            max_trains: block.max_trains().0.into(),
            tail_hold_sections: block.hold().sections().into(),
            cycle_ms: cycle.0,
            pass_ms: cycle.0.saturating_mul(block.pass().0.into()),
        }
    }

    /// The parameters in the kernel's form.
    ///
    /// # Errors
    /// The rule of BLK-8 that they break.
    pub fn block(&self) -> Result<Block, Refusal> {
        // What does not fit is over every limit.
        let narrow = |number: u32| u8::try_from(number).unwrap_or(u8::MAX);
        let hold = hold("tail_hold_sections", self.tail_hold_sections)?;
        let (cycle, pass) = (Millis(self.cycle_ms), Millis(self.pass_ms));
        Block::from_millis(narrow(self.sections), narrow(self.max_trains), hold, cycle, pass)
            .map_err(|error| self.explain(error))
    }

    fn explain(&self, error: BlockError) -> Refusal {
        let Self { sections, max_trains, cycle_ms: cycle, pass_ms: pass, .. } = self;
        let (field, what) = match error {
            BlockError::NoSections | BlockError::TooManySections => {
                ("sections", format!("sections is {sections}; a block has 1 to 16 sections"))
            }
            BlockError::NoTrains | BlockError::MoreTrainsThanSections => (
                "max_trains",
                format!("max_trains is {max_trains}; it must be 1 to the number of sections, {sections}"),
            ),
            BlockError::NoCycle => return no_cycle(Rule::Blk8),
            BlockError::PassTooShort => return short(Rule::Blk8, "pass_ms", *pass, *cycle),
            BlockError::PassTooLong => {
                let longest = u64::from(*cycle) * u64::from(MAX_TICKS);
                ("pass_ms", format!("pass_ms is {pass} ms; it must be at most {MAX_TICKS} cycles, {longest} ms"))
            }
        };
        Refusal::new(Rule::Blk8, field, what)
    }
}

/// A number of sections that are held behind a head.
///
/// # Errors
/// If it is over 16.
pub(crate) fn hold(field: &str, sections: u32) -> Result<Hold, Refusal> {
    let hold = u8::try_from(sections).ok().and_then(Hold::new);
    hold.ok_or_else(|| Refusal::new(Rule::Blk8, field, format!("{field} is {sections}; it must be 0 to 16 sections")))
}
