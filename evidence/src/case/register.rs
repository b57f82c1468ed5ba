//! The registers of the case: conditions, hazards, requirements, techniques, tools.

use crate::judge::verdict::Verdict;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A safety-related application condition.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Condition {
    /// SRAC-1, SRAC-2, …
    pub number: String,
    /// The assumption's id.
    pub id: String,
    /// What must be so.
    pub statement: String,
    /// Why the proof or model needs it.
    pub why: String,
    /// What may happen if it is not so: hazard ids.
    pub hazards: Vec<String>,
    /// Who must see to it.
    pub addressee: String,
    /// How it can be checked.
    pub check: String,
    /// Who answers for it.
    pub owner: String,
    /// Who uses it: evidence, argument nodes and cut sets.
    pub used_by: Vec<String>,
}

/// A hazard of the log.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Hazard {
    /// H-1, H-2, …
    pub id: String,
    /// What it is called.
    pub title: String,
    /// What may come of it.
    pub severity: String,
    /// What leads to it.
    pub causes: Vec<String>,
    /// Evidence ids that mitigate it.
    pub mitigated_by: Vec<String>,
    /// Requirement ids.
    pub requirements: Vec<String>,
    /// The worst verdict of what mitigates it.
    pub verdict: Verdict,
    /// The conditions that are left to the user: SRAC numbers.
    pub residual: Vec<String>,
    /// The minimal cut sets that reach it: CS numbers.
    pub cut_sets: Vec<String>,
    /// What remains in words.
    pub remains: String,
}

/// An accident that was found with legal input, and what excludes it now.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Accident {
    /// The session in which it was found.
    pub name: String,
    /// The hazards that it was: ids.
    pub hazards: Vec<String>,
    /// What happened.
    pub happened: String,
    /// The rules against it: requirement ids.
    pub rules: Vec<String>,
    /// Evidence ids: theorems, models and tests.
    pub excluded_by: Vec<String>,
    /// The worst verdict of these.
    pub verdict: Verdict,
    /// The conditions that it rests on besides: SRAC numbers.
    pub conditions: Vec<String>,
}

/// A requirement and what it is connected with.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Requirement {
    /// ACC-1, …
    pub id: String,
    /// The heading.
    pub title: String,
    /// The sentence with MUST.
    pub sentence: String,
    /// `spec/….md:line`.
    pub at: String,
    /// Where the code quotes it: `file:line`.
    pub code: Vec<String>,
    /// Harness ids.
    pub harnesses: Vec<String>,
    /// Model ids.
    pub models: Vec<String>,
    /// Mutant ids.
    pub mutants: Vec<String>,
    /// Where a test names it: `file:line`.
    pub tests: Vec<String>,
    /// The worst verdict of its harnesses; `not-run` if it has none.
    pub verdict: Verdict,
}

/// A technique of EN 50716 Annex A.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Technique {
    /// Its name.
    pub name: String,
    /// What is claimed.
    pub claimed: String,
    /// The evidence ids behind the claim, and engines (`engine:…`); empty if it is a matter of construction.
    pub evidence: Vec<String>,
    /// The worst verdict of that evidence; nothing if it is a matter of construction.
    pub verdict: Option<Verdict>,
}

/// A tool and its class.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Tool {
    /// Its name.
    pub name: String,
    /// T1, T2 or T3.
    pub class: String,
    /// The version that was found; nothing if it was not used.
    pub version: Option<String>,
    /// What it does here, and what would detect its faults.
    pub justification: String,
}
