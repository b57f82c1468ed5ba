//! What stands in a step and in an output. Circuits, points, routes and segments go by their names in the layout.

use std::collections::{BTreeMap, BTreeSet};

use atc_kernel::block;
use atc_kernel::interlocking::Epoch;
use atc_kernel::wayside as kernel;
use schemars::JsonSchema;
use serde::{Deserialize, Deserializer, Serialize};

use atc_line::refusal::Refusal;

use super::config;
use crate::decimal::{Hertz, OrNull};
use crate::machine::block as counting;
use crate::machine::interlocking::{Answer, ByName, Orders, Phase, Request, Side};
use crate::names::{self, Named};
use crate::sections::Sections;
use crate::telegrams::{MainTelegram, SubTelegram};

/// One logic cycle's input.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(rename = "WaysideStep")]
pub struct Step {
    /// The circuits that are reported occupied by what they have of their own, each once.
    pub occupied: Vec<String>,
    /// The position in which each point is detected; null or absent: in none.
    pub detected: ByName<Option<Side>>,
    /// The blocks of the counted line, from its low end: as many as the configuration has.
    #[serde(default)]
    pub blocks: Vec<Detection>,
    /// At most one request; null or absent: none. What is refused is not remembered.
    #[serde(default)]
    pub request: Option<Request>,
    /// What staff command.
    #[serde(default)]
    pub orders: Orders,
    /// The messages of the neighbours that have come, by segment.
    #[serde(default)]
    pub messages: ByName<Message>,
    /// The transmitters that have taken the frames of the last cycle.
    #[serde(default)]
    pub framed: Framed,
    /// The device starts anew before this cycle, with this number of its start, 0 to 65535; null or absent: it does not.
    #[serde(default)]
    #[schemars(range(max = 65535))]
    pub restart: Option<u32>,
    /// Whether the output is to have what is sent in every circuit, and not only where a train may leave its circuit.
    #[serde(default)]
    pub all_telegrams: bool,
}

/// What the detectors and checks of one block say, from its low end.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(rename = "LineDetection")]
pub struct Detection {
    /// The check at the low end is on.
    pub low_check: bool,
    /// The check at the high end is on.
    pub high_check: bool,
    /// The sections in which a detector hears a head, section 0 at the low end.
    pub present: Sections,
    /// The number of trains that staff have verified, 0 to 255; null or absent: no reset.
    #[serde(default)]
    #[schemars(range(max = 255))]
    pub reset: Option<u32>,
}

/// Whether a station permits its neighbour to send trains into a segment.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Permission {
    /// It does not.
    Withheld,
    /// It does.
    Granted,
}

impl Named for Permission {
    const WHAT: &'static str = "permission";
    const EVERY: &'static [Self] = &[Self::Withheld, Self::Granted];

    fn name(self) -> &'static str {
        match self {
            Self::Withheld => "withheld",
            Self::Granted => "granted",
        }
    }
}

impl<'de> Deserialize<'de> for Permission {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        names::read(deserializer)
    }
}

/// A cycle of a device.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Stamp {
    /// The number of its start, 0 to 65535.
    #[schemars(range(max = 65535))]
    pub session: u32,
    /// The number of the cycle since.
    pub cycle: u32,
}

/// What one station tells the other of one segment.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(rename = "ConsentMessage")]
pub struct Message {
    /// Whether the sender permits the receiver to send trains.
    pub permission: Permission,
    /// The sender's cycle.
    pub sent: Stamp,
    /// The receiver's cycle that the sender has heard of last; null: it has heard nothing since its start.
    // It may be null, but it may not be missing.
    #[serde(deserialize_with = "Option::deserialize")]
    #[schemars(with = "OrNull<Stamp>")]
    pub echo: Option<Stamp>,
}

/// The circuits whose transmitters have taken the frames of the last cycle, by carrier; null or absent: all of them.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Framed {
    /// On the main carrier.
    pub main: Option<Vec<String>>,
    /// On the sub carrier.
    pub sub: Option<Vec<String>>,
}

/// One logic cycle's output: everything that leaves the device.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[schemars(rename = "WaysideOutput")]
pub struct Output {
    /// The phase of every route that is not idle.
    pub routes: BTreeMap<String, Phase>,
    /// The routes whose signals show proceed; all others show stop.
    pub proceed: BTreeSet<String>,
    /// The points that are driven, and whereto.
    pub drives: BTreeMap<String, Side>,
    /// The blocked circuits that staff may rely on.
    pub confirmed: BTreeSet<String>,
    /// What became of the request; null: there was none.
    #[serde(deserialize_with = "Option::deserialize")]
    #[schemars(with = "OrNull<Answer>")]
    pub answer: Option<Answer>,
    /// What is told to the neighbours, by segment.
    pub messages: BTreeMap<String, Message>,
    /// What the counted line reports; null: there is none.
    #[serde(deserialize_with = "Option::deserialize")]
    #[schemars(with = "OrNull<LineReport>")]
    pub line: Option<LineReport>,
    /// What is sent in the circuits in which a train may leave its circuit, and on request in all.
    pub transmissions: BTreeMap<String, Transmission>,
    /// The circuits in which nothing is sent; left out if there are none.
    #[serde(default, skip_serializing_if = "BTreeSet::is_empty")]
    pub silent: BTreeSet<String>,
}

/// What the counted line reports to staff.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct LineReport {
    /// The blocks, from the low end; their sections numbered from the low end too.
    pub blocks: Vec<counting::Output>,
    /// How many places before the line's entry are held.
    #[schemars(range(max = 16))]
    pub before_hold_sections: u8,
}

/// What a circuit's transmitter sends.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
pub struct Transmission {
    /// To trains that travel towards the left.
    pub left: Feed,
    /// To trains that travel towards the right.
    pub right: Feed,
}

/// What is sent to trains of one direction of travel: the telegrams of the frames, and the code frequencies.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
pub struct Feed {
    /// The telegram on the main carrier.
    pub main: MainTelegram,
    /// The telegram on the sub carrier.
    pub sub: SubTelegram,
    /// The code on the main carrier.
    pub main_hz: Hertz,
    /// The code on the sub carrier.
    pub sub_hz: Hertz,
}

impl Stamp {
    fn kernel(self, field: &str) -> Result<kernel::Stamp, Refusal> {
        let session = config::session(&format!("{field}.session"), self.session)?;
        Ok(kernel::Stamp { session, cycle: Epoch(self.cycle) })
    }
}

impl From<kernel::Stamp> for Stamp {
    fn from(stamp: kernel::Stamp) -> Self {
        Self { session: stamp.session.0.into(), cycle: stamp.cycle.0 }
    }
}

impl Message {
    /// The message in the kernel's form; `field` is that of its place.
    pub(super) fn kernel(self, field: &str) -> Result<kernel::Message, Refusal> {
        let permission = match self.permission {
            Permission::Withheld => kernel::Permission::Withheld,
            Permission::Granted => kernel::Permission::Granted,
        };
        let echo = self.echo.map(|echo| echo.kernel(&format!("{field}.echo"))).transpose()?;
        Ok(kernel::Message { permission, sent: self.sent.kernel(&format!("{field}.sent"))?, echo })
    }
}

impl From<kernel::Message> for Message {
    fn from(message: kernel::Message) -> Self {
        let permission = match message.permission {
            kernel::Permission::Withheld => Permission::Withheld,
            kernel::Permission::Granted => Permission::Granted,
        };
        Self { permission, sent: message.sent.into(), echo: message.echo.map(Into::into) }
    }
}

impl Detection {
    /// The detection in the kernel's form, of this block.
    pub(super) fn kernel(self, field: &str, block: block::Block) -> Result<block::Detection, String> {
        let strange = self.present.0.without(block.all());
        if !strange.is_empty() {
            return Err(format!(
                "{field}.present names section {}; the sections of this block are 0 to {}",
                strange.nearest_to_entry(),
                block.sections().saturating_sub(1)
            ));
        }
        let reset = self.reset.map(|verified| {
            let number = u8::try_from(verified).map(block::TrainCount);
            number.map_err(|_| format!("{field}.reset is {verified}; a verified number of trains is 0 to 255, or null"))
        });
        let Self { low_check, high_check, present, .. } = self;
        Ok(block::Detection { low_check, high_check, present: present.0, reset: reset.transpose()? })
    }
}
