//! Telegrams on the wire: the fields by name, in the units of the frame.

use atc_kernel::aspect::AspectId;
use atc_kernel::distance::Metres;
use atc_kernel::telegram::{self, Counter, Length, Main, Route, SectionId, Sub};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::decimal::OrNull;
use atc_line::refusal::{fit, gradient, metres};

/// A main telegram: what changes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct MainTelegram {
    /// The section that the telegram is for, 0 to 65535.
    #[schemars(range(max = 65535))]
    pub section: u32,
    /// The running number of the telegram among the main telegrams, modulo 256.
    #[schemars(range(max = 255))]
    pub counter: u32,
    /// How far beyond the section's exit the train may go, in whole metres, 0 to 65535; null: the route is closed.
    // It may be null, but it may not be missing.
    #[serde(deserialize_with = "Option::deserialize")]
    #[schemars(with = "OrNull<u16>")]
    pub beyond_exit_m: Option<u32>,
    /// The permitted speed as a rank, 0 to 15: its place among the line's speeds, the lowest first.
    #[schemars(range(max = 15))]
    pub speed_rank: u32,
}

/// A sub telegram: what is fixed.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct SubTelegram {
    /// The section that the telegram is for, 0 to 65535.
    #[schemars(range(max = 65535))]
    pub section: u32,
    /// The running number of the telegram among the sub telegrams, modulo 256.
    #[schemars(range(max = 255))]
    pub counter: u32,
    /// The section's length in whole metres, 1 to 65535.
    #[schemars(range(min = 1, max = 65535))]
    pub length_m: u32,
    /// The gradient in thousandths, positive where the train climbs: -128 to 127.
    #[schemars(range(min = -128, max = 127))]
    pub gradient_permille: i32,
    /// The limit by curves and points as a rank, 0 to 15.
    #[schemars(range(max = 15))]
    pub curve_rank: u32,
    /// The limit by a temporary restriction as a rank, 0 to 15.
    #[schemars(range(max = 15))]
    pub restriction_rank: u32,
}

/// A telegram of either kind.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Telegram {
    /// What changes.
    Main(MainTelegram),
    /// What is fixed.
    Sub(SubTelegram),
}

/// A rank of a speed.
fn rank(field: &str, number: u32) -> Result<AspectId, String> {
    let rank = u8::try_from(number).ok().and_then(AspectId::new);
    rank.ok_or_else(|| format!("{field} is {number}; a rank is 0 to 15"))
}

const SECTION: &str = "0 to 65535";
const COUNTER: &str = "0 to 255";

impl MainTelegram {
    /// The telegram in the kernel's form.
    ///
    /// # Errors
    /// The first field that does not fit, in a sentence.
    pub fn kernel(&self) -> Result<Main, String> {
        let route = match self.beyond_exit_m {
            None => Route::Closed,
            Some(distance) => Route::OpenFor(metres("main.beyond_exit_m", distance)?),
        };
        Ok(Main {
            section: SectionId(fit("main.section", self.section, SECTION)?),
            counter: Counter(fit("main.counter", self.counter, COUNTER)?),
            route,
            speed: rank("main.speed_rank", self.speed_rank)?,
        })
    }
}

impl SubTelegram {
    /// The telegram in the kernel's form.
    ///
    /// # Errors
    /// The first field that does not fit, in a sentence.
    pub fn kernel(&self) -> Result<Sub, String> {
        let length = u16::try_from(self.length_m).ok().and_then(|length| Length::new(Metres(length)));
        let length = length.ok_or_else(|| format!("sub.length_m is {}; it must be 1 to 65535 m", self.length_m))?;
        Ok(Sub {
            section: SectionId(fit("sub.section", self.section, SECTION)?),
            counter: Counter(fit("sub.counter", self.counter, COUNTER)?),
            length,
            gradient: gradient("sub.gradient_permille", self.gradient_permille)?,
            curve: rank("sub.curve_rank", self.curve_rank)?,
            restriction: rank("sub.restriction_rank", self.restriction_rank)?,
        })
    }
}

impl Telegram {
    /// The telegram in the kernel's form.
    ///
    /// # Errors
    /// The first field that does not fit, in a sentence.
    pub fn kernel(&self) -> Result<telegram::Telegram, String> {
        match self {
            Self::Main(main) => main.kernel().map(telegram::Telegram::Main),
            Self::Sub(sub) => sub.kernel().map(telegram::Telegram::Sub),
        }
    }
}

impl From<Main> for MainTelegram {
    fn from(main: Main) -> Self {
        Self {
            section: main.section.0.into(),
            counter: main.counter.0.into(),
            beyond_exit_m: match main.route {
                Route::Closed => None,
                Route::OpenFor(distance) => Some(distance.0.into()),
            },
            speed_rank: main.speed.rank().into(),
        }
    }
}

impl From<Sub> for SubTelegram {
    fn from(sub: Sub) -> Self {
        Self {
            section: sub.section.0.into(),
            counter: sub.counter.0.into(),
            length_m: sub.length.metres().0.into(),
            gradient_permille: sub.gradient.0.into(),
            curve_rank: sub.curve.rank().into(),
            restriction_rank: sub.restriction.rank().into(),
        }
    }
}

impl From<telegram::Telegram> for Telegram {
    fn from(telegram: telegram::Telegram) -> Self {
        match telegram {
            telegram::Telegram::Main(main) => Self::Main(main.into()),
            telegram::Telegram::Sub(sub) => Self::Sub(sub.into()),
        }
    }
}
