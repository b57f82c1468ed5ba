//! A line as a case shows it: its figures, as data.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// One of the five times.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct LineTime {
    /// T1 to T5.
    pub symbol: String,
    /// What it is.
    pub name: String,
    /// What was asked for, in ms.
    pub asked_ms: u32,
    /// Logic cycles.
    pub ticks: u16,
    /// What is kept, in ms.
    pub kept_ms: u64,
    /// `up`, `down` or `exact`, and a limit that was applied.
    pub rounding: String,
}

/// One block of the line's train detection.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct LineBlock {
    /// The lengths of its sections in metres, from the low end.
    pub sections_m: Vec<u16>,
    /// The most trains that may be in it.
    pub max_trains: u8,
}

/// One section, as its sub telegrams describe it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct LineSection {
    /// Its number on the line.
    pub number: u16,
    /// Its length in metres.
    pub length_m: u16,
    /// Its gradient in thousandths, negative where the train descends.
    pub gradient_permille: i8,
    /// The lower of its limits in km/h.
    pub limit_km_h: f64,
}

/// A figure that follows from the parameters.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Derived {
    /// What it is.
    pub name: String,
    /// The value with its unit.
    pub value: String,
    /// How it is computed.
    pub formula: String,
    /// The theorem that says so.
    pub source: String,
}

impl Derived {
    /// A row of the table.
    pub fn row(name: &str, value: String, formula: &str, source: &str) -> Self {
        Self { name: name.to_owned(), value, formula: formula.to_owned(), source: source.to_owned() }
    }
}
