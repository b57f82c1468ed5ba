//! The specific application as data.

use crate::judge::verdict::Verdict;
use atc_line::DataCheck;
pub use atc_line::figures::{Derived, LineBlock, LineSection, LineTime};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A line's parameters and what follows from them.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Line {
    /// Its name.
    pub name: String,
    /// Where the parameters come from.
    pub source: String,
    /// One logic cycle in ms.
    pub cycle_ms: u32,
    /// The aspects' permitted speeds in km/h.
    pub aspects_km_h: Vec<f64>,
    /// Each time: name, meaning, asked for in ms, cycles, kept in ms.
    pub times: Vec<LineTime>,
    /// The blocks of its train detection, from the low end; none if it has no block counting.
    pub blocks: Vec<LineBlock>,
    /// The sections that its sub telegrams describe; none if it sends no telegrams, or they are not given.
    pub sections: Vec<LineSection>,
    /// What follows: name, value, how it is computed.
    pub derived: Vec<Derived>,
    /// What the user should look at.
    pub notes: Vec<String>,
    /// The generic theorems that hold for this line, with their verdicts.
    pub theorems: Vec<(String, Verdict)>,
    /// The data checks that were made, each with its result.
    pub checks: Vec<DataCheck>,
}
