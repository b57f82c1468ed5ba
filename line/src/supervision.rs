//! The parameters of speed supervision.

use atc_kernel::supervision::{Supervision, SupervisionError};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::kmh::Kmh;
use crate::kmh::tenths;
use crate::refusal::Refusal;
use crate::rule::Rule;

/// The configuration; both fields have defaults.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
#[schemars(rename = "SupervisionConfig")]
pub struct Config {
    /// The highest plausible speed, above 0 and at most 6553.5 km/h. Above it a measured speed is implausible.
    pub maximum_km_h: Kmh,
    /// How far below the permitted speed the train must be before a brake that is on is released: 0 to the maximum.
    pub release_margin_km_h: Kmh,
}

impl Default for Config {
    fn default() -> Self {
        Self::of(Supervision::default())
    }
}

impl Config {
    /// These parameters of the kernel.
    pub fn of(kernel: Supervision) -> Self {
        Self { maximum_km_h: kernel.maximum().into(), release_margin_km_h: kernel.margin().into() }
    }

    /// The parameters in the kernel's form.
    ///
    /// # Errors
    /// The rule of SUP-3 that they break.
    pub fn supervision(&self) -> Result<Supervision, Refusal> {
        let maximum = tenths("maximum_km_h", self.maximum_km_h)?;
        let margin = tenths("release_margin_km_h", self.release_margin_km_h)?;
        Supervision::new(maximum, margin).map_err(|error| match error {
            SupervisionError::NoMaximum => {
                Refusal::new(Rule::Sup3, "maximum_km_h", "maximum_km_h is 0; it must be above 0")
            }
            SupervisionError::MarginAboveMaximum => Refusal::new(
                Rule::Sup3,
                "release_margin_km_h",
                format!(
                    "release_margin_km_h is {} km/h, above maximum_km_h, {} km/h; it must not be",
                    self.release_margin_km_h, self.maximum_km_h
                ),
            ),
        })
    }
}
