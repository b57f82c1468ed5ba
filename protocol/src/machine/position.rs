//! `train-position`: [`atc_kernel::position`] behind the protocol.

use atc_kernel::Machine as _;
use atc_kernel::position::{Interval, Measured, Moved, Position};
use atc_line::position::level;
pub use atc_line::position::{Config, TableConfig};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::contract::Machine;
use crate::decimal::{Decibels, Metres, OrNull};

/// One cycle's measurement.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(rename = "PositionStep")]
pub struct Step {
    /// The level of the signal that the rail attenuates less; null: it is not heard.
    #[serde(deserialize_with = "Option::deserialize")]
    #[schemars(with = "OrNull<Decibels>")]
    pub first_db: Option<Decibels>,
    /// The level of the signal that the rail attenuates more; null: it is not heard.
    #[serde(deserialize_with = "Option::deserialize")]
    #[schemars(with = "OrNull<Decibels>")]
    pub second_db: Option<Decibels>,
    /// The least and the most that the train moved towards the transmitter since the last cycle: -32.768 to 32.767 m, negative if it
    /// moved away.
    pub moved_m: [Metres; 2],
    /// The true distance to the transmitter at the end of the cycle, if it is known. Only the chart reads it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub truth_m: Option<Metres>,
}

/// One cycle's output.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[schemars(rename = "PositionOutput")]
pub struct Output {
    /// The least and the greatest distance of the train's front to the transmitter ahead; null: it is not known.
    // It may be null, but it may not be missing.
    #[serde(deserialize_with = "Option::deserialize")]
    #[schemars(with = "OrNull<[Metres; 2]>")]
    pub interval_m: Option<[Metres; 2]>,
}

/// The machine with its state.
#[derive(Clone, Debug)]
pub struct Positioned {
    position: Position,
    interval: Option<Interval>,
}

/// The ends of an interval.
pub(super) fn ends(interval: Interval) -> [Metres; 2] {
    [interval.nearest(), interval.farthest()].map(|end| Metres(end.0.into()))
}

impl Step {
    /// The step in the kernel's form.
    ///
    /// # Errors
    /// The first field that does not fit, in a sentence.
    pub fn measured(&self) -> Result<Measured, String> {
        let one = |field: &str, level_db: Option<Decibels>| level_db.map(|level_db| level(field, level_db)).transpose();
        let [least, most] = self.moved_m;
        let fit = |moved: Metres| {
            i16::try_from(moved.0)
                .map_err(|_| format!("moved_m has {moved} m; in one cycle a train moves by -32.768 to 32.767 m"))
        };
        let moved = Moved::new(fit(least)?, fit(most)?)
            .ok_or_else(|| format!("moved_m is [{least}, {most}]; the least must stand before the most"))?;
        Ok(Measured { first: one("first_db", self.first_db)?, second: one("second_db", self.second_db)?, moved })
    }
}

impl Machine for Positioned {
    const NAME: &'static str = "train-position";
    const STEP: &'static str = r#"{"first_db":-21.5,"second_db":-24.25,"moved_m":[1.4,1.6]}"#;
    const CONFIG: &'static str = r#"{"table":{"spacing_m":25.6,"lowest_db":[0,0.5,1,1.5,2,2.5,3,3.5,4,4.5,5,5.5,6,6.5,7,7.5,8],"highest_db":[0,1,2,3,4,5,6,7,8,9,10,11,12,13,14,15,16]},"tolerance_db":0.1,"floor_db":-60,"correction_db":[0,0]}"#;

    type Config = Config;
    type Step = Step;
    type Output = Output;

    fn open(config: &Config) -> Result<Self, String> {
        let position = config.position()?;
        Ok(Self { position, interval: position.initial() })
    }

    fn step(&mut self, step: &Step) -> Result<Output, String> {
        let (state, interval) = self.position.step(self.interval, step.measured()?);
        self.interval = state;
        Ok(Output { interval_m: interval.map(ends) })
    }
}
