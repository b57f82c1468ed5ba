//! The specific application on the ground as data: one station's layout.

use super::Derived;
use crate::judge::verdict::Verdict;
pub use atc_line::{Asked, DataCheck, Finding, Outcome};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A rule of layouts that a theorem rests on, and what showed that it is needed.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct NeededRule {
    /// Its name, as in messages.
    pub rule: String,
    /// What it demands.
    pub text: String,
    /// The wrong kernels whose validator leaves it out, by evidence id.
    pub mutants: Vec<String>,
    /// The theorems that fail then, by evidence id.
    pub theorems: Vec<String>,
    /// The worst verdict of those wrong kernels; nothing if there are none.
    pub verdict: Option<Verdict>,
}

/// A station's layout: what was checked, what is to be confirmed, and what it instantiates.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Station {
    /// Its name.
    pub name: String,
    /// The file.
    pub source: String,
    /// SHA-256 of the file (hexadecimal).
    pub sha256: String,
    /// Name, value, how it was made of the file's, and where it stands.
    pub parameters: Vec<Derived>,
    /// Every rule, in the order in which they are checked.
    pub checks: Vec<DataCheck>,
    /// What somebody must confirm.
    pub confirm: Vec<Confirm>,
    /// The conditions on the ground, with this station's figures.
    pub conditions: Vec<StationCondition>,
    /// The generic theorems that hold for this layout, with their verdicts; none if a rule is broken.
    pub theorems: Vec<(String, Verdict)>,
    /// The track plan, an `svg` element; empty if the tracks are wrong.
    pub drawing: String,
    /// The heads of the control table.
    pub columns: Vec<String>,
    /// The control table, a row for each route; empty if a rule of tracks, routes or times is broken.
    pub table: Vec<Vec<String>>,
    /// The control table with its matrices, an HTML document; empty as above.
    pub table_page: String,
    /// The layout in TOML, as it was checked.
    pub layout: String,
}

/// Where something comes from that is to be confirmed.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Origin {
    /// The file gives a reason instead of a protection.
    Reason,
    /// The file says nothing, and a default stands.
    Default,
    /// The imported file says nothing, and a value was assumed.
    Import,
    /// The imported file lacks it, and nothing stands for it.
    Lacking,
    /// The imported file has it, and it was not used.
    NotUsed,
    /// It follows from the tracks.
    Derived,
}

/// Something that somebody must confirm.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Confirm {
    /// Where it comes from.
    pub origin: Origin,
    /// What it is about: `route W-1`.
    pub about: String,
    /// What was taken.
    pub text: String,
    /// File, line and column, where it stands in the file; else empty.
    pub at: String,
}

/// A condition, and what it means at this station.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct StationCondition {
    /// SRAC-1, …
    pub number: String,
    /// Its assumption.
    pub id: String,
    /// The figures of this station; empty if it has none.
    pub here: String,
}

impl Station {
    /// The rules that are broken.
    pub fn broken(&self) -> impl Iterator<Item = &DataCheck> {
        self.checks.iter().filter(|one| !one.findings().is_empty())
    }

    /// Whether every rule is kept.
    pub fn is_sound(&self) -> bool {
        self.checks.iter().all(|one| one.outcome.holds())
    }
}
