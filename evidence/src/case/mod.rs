//! The safety case as data. Everything that is rendered is rendered from this, and this is what `case.json` holds.

mod evidence;
mod faults;
mod line;
mod measured;
mod register;
mod run;
mod station;

use crate::judge::verdict::Verdict;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

pub use evidence::{Claim, Cover, EngineResult, Evidence, Kind};
pub use faults::{CutSet, Excluded, FailureMode, SecondOpinion};
pub use line::{Derived, Line, LineBlock, LineSection, LineTime};
pub use measured::{Figure, Film, Measurements, Plot};
pub use register::{Accident, Condition, Hazard, Requirement, Technique, Tool};
pub use run::{Phase, Run};
pub use station::{Asked, Confirm, DataCheck, Finding, NeededRule, Origin, Outcome, Station, StationCondition};

/// The version of this shape.
pub const SCHEMA: u32 = 8;

/// A whole safety case.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Case {
    /// The version of this shape: 7.
    pub schema: u32,
    /// What the case is about.
    pub title: String,
    /// What it is bound to.
    pub provenance: Provenance,
    /// What the run looked at, and where its time went.
    pub run: Run,
    /// How the run ended.
    pub status: Status,
    /// One for each root of the argument.
    pub conclusions: Vec<Conclusion>,
    /// What is not as it should be, the worst first.
    pub open_items: Vec<OpenItem>,
    /// The theorems, models, mutants, measured targets and tests.
    pub evidence: Vec<Evidence>,
    /// The engines: which ran, and how to run the others.
    pub engines: Vec<Engine>,
    /// The argument, with the verdict of every node.
    pub argument: Vec<Node>,
    /// The safety-related application conditions: what the user must guarantee.
    pub conditions: Vec<Condition>,
    /// The hazard log.
    pub hazards: Vec<Hazard>,
    /// The accidents that were found with legal input, and what excludes each.
    pub accidents: Vec<Accident>,
    /// The requirements, and what each one is connected with.
    pub requirements: Vec<Requirement>,
    /// The models' parameters, properties and traces.
    pub models: Vec<Model>,
    /// The minimal sets of faults that reach a hazard in the models.
    pub cut_sets: Vec<CutSet>,
    /// What each single fault does in the models.
    pub failure_modes: Vec<FailureMode>,
    /// What another checker says of the models.
    pub second_opinions: Vec<SecondOpinion>,
    /// What was measured of the signal, the receivers and the position.
    pub measurements: Measurements,
    /// Techniques of EN 50716 Annex A and what is claimed of each.
    pub techniques: Vec<Technique>,
    /// Tools by class.
    pub tools: Vec<Tool>,
    /// The specific application: one line's parameters.
    pub line: Line,
    /// The rules of layouts that theorems rest on.
    pub needed_rules: Vec<NeededRule>,
    /// The specific application on the ground: one station's layout.
    pub station: Option<Station>,
}

/// What the results belong to.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Provenance {
    /// The commit, if this is a checkout.
    pub commit: Option<String>,
    /// Whether the checkout differs from the commit.
    pub dirty: Option<bool>,
    /// SHA-256 of `Cargo.lock` (hexadecimal).
    pub cargo_lock_sha256: String,
    /// SHA-256 of what the provers see: the sources of kernel and proofs (hexadecimal).
    pub sources_sha256: String,
    /// SHA-256 of each folder, for `render` and `verify` (hexadecimal).
    pub folders: BTreeMap<String, String>,
    /// Name to version of every tool that was used.
    pub tools: BTreeMap<String, String>,
    /// The provers' flags.
    pub flags: Vec<String>,
    /// The number of aspects in the harnesses whose size is a parameter.
    pub aspects: usize,
    /// When the case was made, in seconds since 1970-01-01 UTC.
    pub generated_unix: u64,
    /// How long everything took, in seconds.
    pub seconds: f64,
}

/// How the run ended.
#[derive(Clone, Debug, Default, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Status {
    /// Whether every entry of the manifest has a result for these sources.
    pub complete: bool,
    /// The entries without one.
    pub missing: Vec<String>,
    /// What was required: `proved`, or nothing.
    pub required: Option<String>,
    /// The exit code: 0 or 1.
    pub exit_code: u8,
    /// Why it is not 0.
    pub reasons: Vec<String>,
    /// Each evidence kind: how many of each verdict.
    pub counts: BTreeMap<String, BTreeMap<Verdict, usize>>,
}

/// What one root of the argument amounts to.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Conclusion {
    /// The root's id.
    pub node: String,
    /// The worst verdict under it.
    pub verdict: Verdict,
    /// The sentence, never stronger than the verdict.
    pub sentence: String,
}

/// How bad an open item is. The worst comes first.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Severity {
    /// Something failed, or showed nothing. The run never ends well with one of these.
    Stop,
    /// Something is not shown.
    Open,
    /// Something to know.
    Note,
}

/// What an open item is about.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Matter {
    /// Results of evidence that are not good, with one reason.
    Result,
    /// A rule that the line's data break.
    LineData,
    /// A rule that the station's data break.
    StationData,
    /// A requirement without a theorem, a line of code or a mutant; or with one that survives.
    Requirement,
    /// A doubt about the argument.
    Defeater,
    /// An engine without a result, or with fewer than another one.
    Engine,
    /// A citation that does not say what its requirement says.
    Citation,
    /// An assumption that nothing uses.
    Assumption,
    /// A rule of layouts that nothing has shown to be needed.
    NeededRule,
    /// Pinned numbers that have grown.
    Ratchet,
    /// Which sources it is about.
    Provenance,
    /// Faults that were not searched, or that a condition alone excludes.
    Faults,
    /// What the tests of this run leave out.
    Tests,
    /// Models that this run did not search, since the tests did.
    Searched,
    /// A trace that cannot be drawn.
    Chart,
    /// Figures that are not of these sources.
    Figures,
    /// What a run with a limit of time left out.
    Limit,
    /// A shard that is missing.
    Shard,
    /// Shards that contradict each other.
    Contradiction,
    /// A folder that has changed since.
    Stale,
}

/// Something that is not as it should be.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct OpenItem {
    /// How bad it is.
    pub severity: Severity,
    /// What kind of thing it is about. What an item counts for goes by this, and never by its words.
    pub matter: Matter,
    /// The evidence, requirement or node that it is about.
    pub about: String,
    /// What is open.
    pub text: String,
}

/// An engine and how far it went.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Engine {
    /// `cbmc`, `kani`, `creusot`, `native`, `spin`, `waveform`.
    pub name: String,
    /// What it looks at.
    pub what: String,
    /// The worst verdict of its results; `not-run` if there is none.
    pub verdict: Verdict,
    /// What was run or imported, in numbers.
    pub summary: String,
    /// The command that runs it.
    pub command: String,
}

/// What kind of node.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum NodeKind {
    /// A claim.
    Goal,
    /// How a claim is divided.
    Strategy,
    /// Evidence.
    Solution,
    /// What the words mean, or where it applies.
    Context,
    /// Why a strategy is sound.
    Justification,
    /// A safety-related application condition.
    Assumption,
}

/// One node of the argument, in the manner of the Goal Structuring Notation.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Node {
    /// Its id: G1, S1, Sn1, C1, J1, A1.
    pub id: String,
    /// What kind it is.
    pub kind: NodeKind,
    /// What it says.
    pub text: String,
    /// The nodes that support it.
    pub supported_by: Vec<String>,
    /// Contexts, justifications and assumptions.
    pub in_context_of: Vec<String>,
    /// For a solution: the evidence.
    pub evidence: Option<String>,
    /// The worst verdict under it; nothing for contexts and the like.
    pub verdict: Option<Verdict>,
    /// What would make it wrong.
    pub defeaters: Vec<Defeater>,
    /// Whether it is a root.
    pub root: bool,
}

/// What would make a claim wrong.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Defeater {
    /// The doubt.
    pub text: String,
    /// The answer; nothing if there is none yet.
    pub answer: Option<String>,
    /// The evidence that the answer rests on.
    pub evidence: Vec<String>,
    /// Whether it is open: no answer, or an answer whose evidence does not hold.
    pub open: bool,
    /// Why it is open.
    pub reason: Option<String>,
}

/// A model's outcome.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Model {
    /// The evidence id.
    pub id: String,
    /// Name and value of each parameter.
    pub parameters: Vec<(String, String)>,
    /// How many states there are.
    pub unique_states: Option<u64>,
    /// The properties: name, what is expected, what was found.
    pub properties: Vec<Property>,
    /// The timing charts of what was found: caption and SVG.
    pub charts: Vec<Chart>,
}

/// A model's property.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Property {
    /// Its name.
    pub name: String,
    /// What it says.
    pub text: String,
    /// What is expected.
    pub expected: String,
    /// What was found.
    pub found: String,
    /// For a hazard: the assumptions and requirements of which each alone excludes it.
    pub excluded_by: Vec<String>,
    /// Whether the expectation is met.
    pub verdict: Verdict,
}

/// A drawing.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Chart {
    /// The property that it belongs to.
    pub name: String,
    /// What it shows.
    pub caption: String,
    /// The drawing, an `svg` element.
    pub svg: String,
    /// The trace that it was drawn from, one JSON object a line.
    pub trace: String,
}
