//! `braking-pattern`: [`atc_kernel::pattern`] behind the protocol. It remembers nothing.

use atc_kernel::pattern::{Deceleration, pattern};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::contract::Machine;
use crate::kmh::Kmh;
use atc_line::refusal::{brake, gradient, metres};

/// The configuration.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
#[schemars(rename = "PatternConfig")]
pub struct Config {
    /// The train's deceleration by its service brake on the level, in mm/s²: 1 to 4095.
    #[schemars(range(min = 1, max = 4095))]
    pub brake_mm_s2: u32,
}

impl Default for Config {
    fn default() -> Self {
        Self { brake_mm_s2: 800 }
    }
}

/// One question.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(rename = "PatternStep")]
pub struct Step {
    /// The distance in which the train must stop, in whole metres: 0 to 65535.
    #[schemars(range(max = 65535))]
    pub distance_m: u32,
    /// The gradient in thousandths, positive where the train climbs: -128 to 127; absent: level.
    #[serde(default)]
    #[schemars(range(min = -128, max = 127))]
    pub gradient_permille: i32,
}

/// One answer.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[schemars(rename = "PatternOutput")]
pub struct Output {
    /// The highest speed from which the train stops within the distance, at most 409.5 km/h.
    pub speed_km_h: Kmh,
}

/// The machine.
#[derive(Clone, Copy, Debug)]
pub struct Braking {
    brake: Deceleration,
}

impl Machine for Braking {
    const NAME: &'static str = "braking-pattern";
    const STEP: &'static str = r#"{"distance_m":250,"gradient_permille":-12}"#;
    const CONFIG: &'static str = r#"{"brake_mm_s2":800}"#;

    type Config = Config;
    type Step = Step;
    type Output = Output;

    fn open(config: &Config) -> Result<Self, String> {
        Ok(Self { brake: brake("brake_mm_s2", config.brake_mm_s2)? })
    }

    fn step(&mut self, step: &Step) -> Result<Output, String> {
        let distance = metres("distance_m", step.distance_m)?;
        let gradient = gradient("gradient_permille", step.gradient_permille)?;
        Ok(Output { speed_km_h: Kmh(pattern(self.brake.on(gradient), distance).0.into()) })
    }
}
