//! One piece of evidence as data: a theorem, a model, a wrong kernel, a measured target or a suite of tests.

use crate::judge::verdict::Verdict;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// What kind of evidence.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Kind {
    /// A theorem's harness.
    Harness,
    /// A state-space model.
    Model,
    /// A named wrong kernel: `tested` means killed.
    Mutant,
    /// A target that measured figures must meet.
    Measured,
    /// A suite of tests.
    Test,
}

impl Kind {
    /// The word before the colon of an id.
    pub fn word(self) -> &'static str {
        match self {
            Self::Harness => "harness",
            Self::Model => "model",
            Self::Mutant => "mutant",
            Self::Measured => "measured",
            Self::Test => "test",
        }
    }
}

/// One piece of evidence.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Evidence {
    /// `harness:…`, `model:…`, `mutant:…`, `measured:…` or `test:…`.
    pub id: String,
    /// What kind it is.
    pub kind: Kind,
    /// A short title: the theorem's name, the model's, the mutant's, the suite's.
    pub title: String,
    /// What it shows, in plain English.
    pub statement: String,
    /// Where it stands, from the checkout: a harness's `file:line`, or that of the text which a wrong kernel changes.
    pub at: Option<String>,
    /// What it amounts to.
    pub verdict: Verdict,
    /// Bound, states and parameters, or numbers: what belongs with the verdict.
    pub detail: String,
    /// The run was not to look at it: another part of the railway, or another shard.
    #[serde(default)]
    pub left_out: bool,
    /// Why the verdict is not better.
    pub reason: Option<String>,
    /// Requirement ids.
    pub requirements: Vec<String>,
    /// Assumption ids.
    pub assumptions: Vec<String>,
    /// Claims (harness) or properties (model), each with its own verdict.
    pub claims: Vec<Claim>,
    /// Cover points.
    pub covers: Vec<Cover>,
    /// What each engine says of it.
    pub engines: Vec<EngineResult>,
    /// For a mutant: the harnesses that reject it, with the claims that turn red.
    pub killed_by: Vec<String>,
    /// Seconds of the engine that the verdict comes from.
    pub seconds: f64,
    /// The arbitrary values of a counterexample, in the order in which the harness draws them.
    pub counterexample: Option<Vec<u16>>,
}

impl Evidence {
    /// Why the verdict is not better, in words.
    pub(crate) fn why(&self) -> &str {
        self.reason.as_deref().unwrap_or("no reason given")
    }

    /// A verdict with nothing that belongs to it. `name` stands behind the kind in the id, and is the title.
    pub(crate) fn bare(kind: Kind, name: &str, verdict: Verdict) -> Self {
        Self {
            id: format!("{}:{name}", kind.word()),
            kind,
            title: name.to_owned(),
            statement: String::new(),
            at: None,
            verdict,
            detail: String::new(),
            left_out: false,
            reason: None,
            requirements: Vec::new(),
            assumptions: Vec::new(),
            claims: Vec::new(),
            covers: Vec::new(),
            engines: Vec::new(),
            killed_by: Vec::new(),
            seconds: 0.0,
            counterexample: None,
        }
    }
}

/// A claim or a model's property.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Claim {
    /// Its name.
    pub name: String,
    /// What it says.
    pub text: String,
    /// Its own verdict.
    pub verdict: Verdict,
}

/// A cover point.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Cover {
    /// Its name.
    pub name: String,
    /// What is reached.
    pub text: String,
    /// Whether it was; nothing while no prover has run.
    pub hit: Option<bool>,
}

/// One engine's word on one harness.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct EngineResult {
    /// `cbmc`, `kani`, `creusot`, `native`; for a model `spin`.
    pub engine: String,
    /// What it says.
    pub verdict: Verdict,
    /// Why, or how to run it.
    pub note: String,
    /// Seconds.
    pub seconds: f64,
}
