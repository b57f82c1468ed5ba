//! `block-count`: [`atc_kernel::block`] behind the protocol, one block of a line.

use std::borrow::Cow;

use atc_kernel::block::{self, Block, Hold, Input, State, Status, TrainCount};
pub use atc_line::block::Config;
use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::de::{Deserializer, Error as _};
use serde::{Deserialize, Serialize};

use super::contract::Machine;
use crate::sections::Sections;

fn default_entered() -> bool {
    true
}

/// One logic cycle's input.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(rename = "BlockStep")]
pub struct Step {
    /// The check at the entry end is on.
    pub check_in: bool,
    /// The check at the exit end is on.
    pub check_out: bool,
    /// The sections in which a detector hears a head.
    pub present: Sections,
    /// The number of trains that staff have verified, 0 to 255; null or absent: no reset.
    #[serde(default)]
    #[schemars(range(max = 255))]
    pub reset: Option<u32>,
    /// How many sections the block ahead asks to hold on this side of the border: 0 to 16.
    #[serde(default)]
    #[schemars(range(max = 16))]
    pub ahead_hold_sections: u32,
    /// The block ahead has a train that is still pending here (its check-in rose for it), or the line ends here.
    #[serde(default = "default_entered")]
    pub ahead_entered: bool,
}

impl Step {
    /// The input of a block as a step; [`Counted::input`] reads it again. Sections that the block does not have are left out.
    pub fn of(block: Block, input: Input) -> Self {
        Self {
            check_in: input.check_in,
            check_out: input.check_out,
            present: Sections(input.present.and(block.all())),
            reset: input.reset.map(|number| number.0.into()),
            ahead_hold_sections: input.ahead_hold.sections().into(),
            ahead_entered: input.ahead_entered,
        }
    }
}

/// What contradicted the count.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
#[schemars(rename = "BlockFault")]
pub enum Fault {
    /// A train checked out of a block that had none left.
    CheckOutAtZero,
    /// A train checked in to a block that had its most.
    CheckInAtMaximum,
    /// The check-in stayed on for longer than a train takes to pass.
    CheckInStaysOn,
}

impl Fault {
    /// Every fault.
    pub const ALL: [Self; 3] = [Self::CheckOutAtZero, Self::CheckInAtMaximum, Self::CheckInStaysOn];

    /// Its name on the wire.
    pub const fn name(self) -> &'static str {
        match self {
            Self::CheckOutAtZero => "check-out-at-zero",
            Self::CheckInAtMaximum => "check-in-at-maximum",
            Self::CheckInStaysOn => "check-in-stays-on",
        }
    }
}

// Not derived: serde would take `{"check-out-at-zero":null}` for the name as well.
impl<'de> Deserialize<'de> for Fault {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let name = String::deserialize(deserializer)?;
        Self::ALL.into_iter().find(|fault| fault.name() == name).ok_or_else(|| {
            let names = Self::ALL.map(|fault| format!("{:?}", fault.name())).join(", ");
            D::Error::custom(format_args!("unknown fault {name:?}, expected one of {names}, or null"))
        })
    }
}

/// For the schema only: a fault or null, not to be left out.
enum FaultOrNull {}

impl JsonSchema for FaultOrNull {
    fn schema_name() -> Cow<'static, str> {
        "FaultOrNull".into()
    }

    fn inline_schema() -> bool {
        true
    }

    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        json_schema!({ "anyOf": [generator.subschema_for::<Fault>(), { "type": "null" }] })
    }
}

impl From<block::Fault> for Fault {
    fn from(fault: block::Fault) -> Self {
        match fault {
            block::Fault::CheckOutAtZero => Self::CheckOutAtZero,
            block::Fault::CheckInAtMaximum => Self::CheckInAtMaximum,
            block::Fault::CheckInStaysOn => Self::CheckInStaysOn,
        }
    }
}

/// One logic cycle's output.
#[derive(Clone, Copy, Debug, Eq, Serialize, Deserialize, JsonSchema)]
#[schemars(rename = "BlockOutput")]
pub struct Output {
    /// The sections that are occupied, or not shown to be free, in rising order.
    pub occupied: Sections,
    /// How many sections the block behind is asked to hold on its side of the border.
    #[schemars(range(max = 16))]
    pub behind_hold_sections: u8,
    /// The count is in force and equals the number of sections that detect.
    pub agree: bool,
    /// C2: trains, pending check-outs included.
    #[schemars(range(max = 16))]
    pub count: u8,
    /// What contradicted the count; null: nothing has, since the last reset.
    // It may be null, but it may not be missing.
    #[serde(deserialize_with = "Option::deserialize")]
    #[schemars(with = "FaultOrNull")]
    pub fault: Option<Fault>,
    /// The count is in force. False with no fault: unverified, until a reset is accepted. An implementation may leave it out.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(with = "bool")]
    pub counting: Option<bool>,
}

/// What is left out is not compared.
impl PartialEq for Output {
    fn eq(&self, other: &Self) -> bool {
        let said = |one: &Self| (one.occupied, one.behind_hold_sections, one.agree, one.count, one.fault);
        let counting = self.counting.is_none() || other.counting.is_none() || self.counting == other.counting;
        said(self) == said(other) && counting
    }
}

impl From<block::Output> for Output {
    fn from(output: block::Output) -> Self {
        Self {
            occupied: Sections(output.occupied),
            behind_hold_sections: output.behind_hold.sections(),
            agree: output.agree,
            count: output.count.0,
            fault: match output.status {
                Status::Fault(fault) => Some(fault.into()),
                Status::Unverified | Status::Counting => None,
            },
            counting: Some(output.status == Status::Counting),
        }
    }
}

/// The machine with its state.
#[derive(Clone, Debug)]
pub struct Counted {
    block: Block,
    state: State,
}

impl Counted {
    /// The parameters.
    pub fn block(&self) -> Block {
        self.block
    }

    /// The kernel's state.
    pub fn state(&self) -> &State {
        &self.state
    }

    /// A step in the kernel's form.
    ///
    /// # Errors
    /// If it names a section that the block does not have, or a number that is out of its range.
    pub fn input(&self, step: &Step) -> Result<Input, String> {
        let strange = step.present.0.without(self.block.all());
        if !strange.is_empty() {
            return Err(format!(
                "present names section {}; the sections of this block are 0 to {}",
                strange.nearest_to_entry(),
                self.block.sections() - 1
            ));
        }
        let reset = step.reset.map(|verified| {
            u8::try_from(verified)
                .map(TrainCount)
                .map_err(|_| format!("reset is {verified}; a verified number of trains is 0 to 255, or null"))
        });
        let asked = step.ahead_hold_sections;
        let hold = u8::try_from(asked).ok().and_then(Hold::new);
        Ok(Input {
            check_in: step.check_in,
            check_out: step.check_out,
            present: step.present.0,
            reset: reset.transpose()?,
            ahead_hold: hold.ok_or_else(|| format!("ahead_hold_sections is {asked}; it must be 0 to 16 sections"))?,
            ahead_entered: step.ahead_entered,
        })
    }
}

impl Machine for Counted {
    const NAME: &'static str = "block-count";
    const STEP: &'static str = r#"{"check_in":false,"check_out":false,"present":[0,2],"reset":null,"ahead_hold_sections":0,"ahead_entered":true}"#;
    const CONFIG: &'static str =
        r#"{"sections":3,"max_trains":3,"tail_hold_sections":0,"cycle_ms":10,"pass_ms":10000}"#;

    type Config = Config;
    type Step = Step;
    type Output = Output;

    fn open(config: &Config) -> Result<Self, String> {
        Ok(Self { block: config.block()?, state: State::INITIAL })
    }

    fn step(&mut self, step: &Step) -> Result<Output, String> {
        let input = self.input(step)?;
        let (state, output) = block::step(self.block, self.state, input);
        self.state = state;
        Ok(output.into())
    }

    fn cycles(&self) -> Vec<(&'static str, u16)> {
        vec![("pass", self.block.pass().0)]
    }
}
