//! `telegram-codec`: [`atc_kernel::telegram`] behind the protocol: frames from telegrams, telegrams from frames, and telegrams
//! found in a stream of bits.

use atc_kernel::Machine as _;
use atc_kernel::telegram::{self as kernel, Deframer, FRAME_BITS, Frame, Reception, Window};
use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::de::Deserializer;
use serde::{Deserialize, Serialize};

use super::contract::Machine;
use crate::names::{self, Named};
use crate::telegrams::Telegram;

/// The configuration: nothing can be chosen.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(rename = "TelegramConfig")]
pub struct Config {}

/// One request to the codec.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
#[schemars(rename = "TelegramStep")]
pub enum Step {
    /// The frame of this telegram is asked for.
    Encode(Telegram),
    /// The telegram of this frame is asked for: 106 characters 0 or 1, in the order in which they are sent.
    Decode(#[schemars(regex(pattern = "^[01]{106}$"))] String),
    /// What the receiver hears from here on, one character for each bit time: 0, 1, or "." where it hears nothing. Bits are kept
    /// from step to step: a frame may begin in one and end in a later one.
    Bits(#[schemars(regex(pattern = "^[01.]*$"))] String),
}

/// Why bits are no frame of a telegram: the first that applies.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
#[schemars(rename = "TelegramFrameError")]
pub enum FrameError {
    /// The synchronisation word is not there.
    Synchronisation,
    /// A guard bit is 1.
    Guard,
    /// The check does not fit the information.
    Check,
    /// The check fits, and the information is of no telegram.
    Content,
}

impl Named for FrameError {
    const WHAT: &'static str = "error";
    const EVERY: &'static [Self] = &[Self::Synchronisation, Self::Guard, Self::Check, Self::Content];

    fn name(self) -> &'static str {
        match self {
            Self::Synchronisation => "synchronisation",
            Self::Guard => "guard",
            Self::Check => "check",
            Self::Content => "content",
        }
    }
}

impl<'de> Deserialize<'de> for FrameError {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        names::read(deserializer)
    }
}

impl From<kernel::FrameError> for FrameError {
    fn from(error: kernel::FrameError) -> Self {
        match error {
            kernel::FrameError::Synchronisation => Self::Synchronisation,
            kernel::FrameError::Guard => Self::Guard,
            kernel::FrameError::Check => Self::Check,
            kernel::FrameError::Content => Self::Content,
        }
    }
}

/// A telegram in a stream of bits.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[schemars(rename = "TelegramFound")]
pub struct Found {
    /// The bit time of its frame's last bit, counted from 0 over all bits of the case, those without a bit included.
    pub last_bit: u64,
    /// The telegram.
    pub telegram: Telegram,
}

/// The answer to a request.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(untagged)]
pub enum Output {
    /// To `encode`.
    Frame {
        /// The frame: 106 characters 0 or 1, in the order in which they are sent.
        frame: String,
    },
    /// To `decode`.
    Telegram {
        /// The telegram of the frame.
        telegram: Telegram,
    },
    /// To `decode`.
    Error {
        /// Why the bits are no frame of a telegram.
        error: FrameError,
    },
    /// To `bits`.
    Telegrams {
        /// The telegrams whose last bit is among these bits, in their order.
        telegrams: Vec<Found>,
    },
}

impl JsonSchema for Output {
    fn schema_name() -> std::borrow::Cow<'static, str> {
        "TelegramOutput".into()
    }

    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        let found = generator.subschema_for::<Vec<Found>>();
        let answer = |key: &str, schema: Schema, description: &str| json_schema!({ "type": "object", "properties": { key: schema }, "required": [key], "description": description });
        let frame = json_schema!({ "type": "string", "pattern": "^[01]{106}$" });
        let frame = answer("frame", frame, "To encode: the frame, in the order in which its bits are sent.");
        let telegram = generator.subschema_for::<Telegram>();
        let telegram = answer("telegram", telegram, "To decode: the telegram of the frame.");
        let error = generator.subschema_for::<FrameError>();
        let error = answer("error", error, "To decode: why the bits are no frame of a telegram.");
        let telegrams =
            answer("telegrams", found, "To bits: the telegrams whose last bit is among them, in their order.");
        json_schema!({ "anyOf": [frame, telegram, error, telegrams] })
    }
}

/// The codec with the bits that it has heard.
#[derive(Clone, Debug)]
pub struct Codec {
    window: Window,
    heard: u64,
}

/// Reads the characters of a frame, which stand in `field`.
pub(super) fn frame(field: &str, text: &str) -> Result<Frame, String> {
    let length = text.chars().count();
    if length != FRAME_BITS as usize {
        return Err(format!("{field} has {length} characters; a frame has {FRAME_BITS}, each 0 or 1"));
    }
    let mut bits = 0;
    for (place, letter) in text.chars().enumerate() {
        let bit = match letter {
            '0' => 0,
            '1' => 1,
            _ => return Err(format!("{field} has {letter:?} at place {place}; a bit of a frame is 0 or 1")),
        };
        bits = bits << 1 | bit;
    }
    Ok(Frame::from_bits(bits))
}

/// The characters of a frame.
pub fn text(frame: Frame) -> String {
    format!("{:0width$b}", frame.bits(), width = FRAME_BITS as usize)
}

/// Reads the characters of a stream.
fn receptions(text: &str) -> Result<Vec<Reception>, String> {
    let reception = |(place, letter)| match letter {
        '0' => Ok(Reception::Zero),
        '1' => Ok(Reception::One),
        '.' => Ok(Reception::Nothing),
        _ => Err(format!(r#"bits has {letter:?} at place {place}; a bit time is 0, 1, or "." where nothing is heard"#)),
    };
    text.chars().enumerate().map(reception).collect()
}

impl Machine for Codec {
    const NAME: &'static str = "telegram-codec";
    const STEP: &'static str = r#"{"encode":{"main":{"section":7,"counter":1,"beyond_exit_m":400,"speed_rank":4}}}, {"encode":{"sub":{"section":7,"counter":1,"length_m":250,"gradient_permille":-12,"curve_rank":6,"restriction_rank":7}}}, {"decode":"0111…"} with 106 bits, or {"bits":"01.…"}"#;
    const CONFIG: &'static str = "{}";

    type Config = Config;
    type Step = Step;
    type Output = Output;

    fn open(_: &Config) -> Result<Self, String> {
        Ok(Self { window: Deframer.initial(), heard: 0 })
    }

    fn step(&mut self, step: &Step) -> Result<Output, String> {
        match step {
            Step::Encode(telegram) => Ok(Output::Frame { frame: text(kernel::encode(telegram.kernel()?)) }),
            Step::Decode(bits) => Ok(match kernel::decode(frame("decode", bits)?) {
                Ok(telegram) => Output::Telegram { telegram: telegram.into() },
                Err(error) => Output::Error { error: error.into() },
            }),
            Step::Bits(bits) => {
                // All are read before the first is heard: a wrong one changes nothing.
                let receptions = receptions(bits)?;
                let mut telegrams = Vec::new();
                for reception in receptions {
                    let (window, telegram) = Deframer.step(self.window, reception);
                    self.window = window;
                    telegrams.extend(telegram.map(|found| Found { last_bit: self.heard, telegram: found.into() }));
                    self.heard = self.heard.saturating_add(1);
                }
                Ok(Output::Telegrams { telegrams })
            }
        }
    }
}
