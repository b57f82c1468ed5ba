//! What faults do, as data: minimal cut sets, failure modes, and what a second model checker says.

use super::Chart;
use crate::judge::verdict::Verdict;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A set of faults that together reach a hazard, and no part of which does.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct CutSet {
    /// CS-1, CS-2, …: the smallest sets first.
    pub number: String,
    /// The kinds of fault; one that stands twice happens twice.
    pub faults: Vec<String>,
    /// What happens, in a sentence.
    pub text: String,
    /// The hazards that it reaches: those of its conditions.
    pub hazards: Vec<String>,
    /// The conditions of which each alone excludes it; never empty.
    pub excluded_by: Vec<Excluded>,
    /// The models that found it: evidence ids.
    pub found_by: Vec<String>,
    /// The shortest way there.
    pub chart: Chart,
}

/// A condition that excludes a cut set, and who answers for it.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Excluded {
    /// SRAC-1, …
    pub condition: String,
    /// The assumption's id.
    pub assumption: String,
    /// Who answers for it.
    pub owner: String,
}

/// What one fault does, at worst.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct FailureMode {
    /// The kind of fault.
    pub fault: String,
    /// What it is, in a sentence.
    pub text: String,
    /// Whether no section with a head or a tail is ever reported free.
    pub safe: bool,
    /// What is reported, and for how long.
    pub effect: String,
    /// How many states were searched for it.
    pub states: u64,
    /// The model: its evidence id.
    pub model: String,
}

/// What another checker says of a model that is written a second time for it.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct SecondOpinion {
    /// The model: its evidence id.
    pub model: String,
    /// The other checker.
    pub tool: String,
    /// Its version; nothing if it did not run.
    pub version: Option<String>,
    /// How many states the first checker found; nothing if it did not run.
    pub first_states: Option<u64>,
    /// How many states the other one found; nothing if it did not run.
    pub states: Option<u64>,
    /// `model-checked`: it agrees; `failed`: it differs; `undecided`: it says that it agrees, and its figures do not.
    pub verdict: Verdict,
    /// Why it is not better.
    pub reason: Option<String>,
    /// Seconds.
    pub seconds: f64,
}
