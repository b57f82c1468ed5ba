//! What a check says: verdicts, figures and traces, for people, for the safety case and for the oracle.

use atc_protocol::form::Line;
use atc_protocol::machine::Machine;
use serde::{Deserialize, Serialize};
use serde_json::Value;
use std::collections::BTreeMap;

/// What is expected of a property.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Expectation {
    /// It holds in every reachable state.
    AlwaysHolds,
    /// It is reached: the model is not empty of it.
    SometimesReached,
    /// A hazard that the search must find.
    HazardFound,
}

/// What the search says of a property.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Verdict {
    /// It holds in every reachable state, and every one was visited.
    ModelChecked,
    /// A reachable state contradicts it.
    Failed,
    /// A reachable state has it.
    Found,
    /// No reachable state has it, and every one was visited.
    NotFound,
    /// The search ended before it was decided.
    Incomplete,
}

/// One property and its verdict.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct PropertyOutcome {
    /// Its name, unique in the model.
    pub name: String,
    /// The property in a sentence.
    pub text: String,
    /// What is expected of it.
    pub expectation: Expectation,
    /// What the search says.
    pub verdict: Verdict,
    /// For a hazard: the assumptions (kebab-case) and requirements (ACC-n) of which each alone excludes it.
    pub excluded_by: Vec<String>,
    /// For what was found, wanted or not: the shortest way there.
    pub trace: Option<Trace>,
}

impl PropertyOutcome {
    /// Whether the expectation is met.
    pub fn ok(&self) -> bool {
        match self.expectation {
            Expectation::AlwaysHolds => self.verdict == Verdict::ModelChecked,
            Expectation::SometimesReached => self.verdict == Verdict::Found,
            Expectation::HazardFound => self.verdict == Verdict::Found && self.trace.is_some(),
        }
    }
}

/// The result of checking one model.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Outcome {
    /// The model's name in the catalogue.
    pub model: String,
    /// What it shows, in plain English.
    pub statement: String,
    /// The requirements and theorems that it checks.
    pub requirements: Vec<String>,
    /// Parameters and environment in words.
    pub parameters: String,
    /// The assumptions in force, by id.
    pub assumptions_in_force: Vec<String>,
    /// The assumptions that are deliberately lifted, by id.
    pub assumptions_lifted: Vec<String>,
    /// Whether every reachable state was visited.
    pub complete: bool,
    /// Different states.
    pub unique_states: usize,
    /// States generated, repeats included.
    pub generated_states: usize,
    /// Cycles from the start to the deepest state, plus one; exact for one thread.
    pub max_depth: usize,
    /// Time taken, traces included.
    pub seconds: f64,
    /// Every property, in the order of the model.
    pub properties: Vec<PropertyOutcome>,
    /// Every minimal set of faults that reaches the hazard, up to the size that was searched.
    #[serde(default)]
    pub cut_sets: Vec<CutSet>,
    /// What each single fault does.
    #[serde(default)]
    pub failure_modes: Vec<FailureMode>,
}

/// A set of faults that together reach the hazard, and no part of which does.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct CutSet {
    /// The kinds of fault, in kebab-case, sorted; one that stands twice happens twice.
    pub faults: Vec<String>,
    /// What happens, in a sentence.
    pub text: String,
    /// The assumptions of which each alone excludes it.
    pub excluded_by: Vec<String>,
    /// The shortest way there.
    pub trace: Trace,
}

/// What a single fault does, at worst.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct FailureMode {
    /// The kind of fault, in kebab-case.
    pub fault: String,
    /// What it is, in a sentence.
    pub text: String,
    /// Whether no section with a head or a tail is ever reported free.
    pub safe: bool,
    /// What is reported: "none", "all occupied while it lasts", "all occupied until a reset".
    pub effect: String,
    /// The states that were searched for it.
    pub states: usize,
}

impl Outcome {
    /// Whether the search was complete and every expectation is met. A model without properties is not.
    pub fn ok(&self) -> bool {
        self.complete && !self.properties.is_empty() && self.properties.iter().all(PropertyOutcome::ok)
    }
}

/// One cycle of a trace, in the words of the oracle's protocol.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Step {
    /// What the machine reads.
    pub input: Value,
    /// What the kernel's machine answers: always the kernel's.
    pub output: Value,
    /// What else the model knows of this cycle, by name; the machine's model says what.
    #[serde(skip_serializing_if = "BTreeMap::is_empty", default)]
    pub words: BTreeMap<String, Value>,
}

/// A cycle in the messages of the oracle's machine: what it reads, what the kernel answers, and what else the model knows, by name.
pub(crate) type Cycle<M, W> = (<M as Machine>::Step, <M as Machine>::Output, W);

/// A message as JSON.
fn written(message: &impl Serialize) -> Value {
    serde_json::to_value(message).expect("a message is plain data")
}

/// A run of a machine from its initial state.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Trace {
    /// The oracle's name of the machine.
    pub machine: String,
    /// Its configuration in the oracle's protocol 1.
    pub config: Value,
    /// The cycles in order.
    pub steps: Vec<Step>,
    /// The number of the step (from 0) from which the trace may repeat for ever.
    #[serde(skip_serializing_if = "Option::is_none", default)]
    pub loop_start: Option<usize>,
}

impl Trace {
    /// A run of the machine that the oracle calls `M`, in its messages.
    pub(crate) fn of<M: Machine, W: Serialize>(config: &M::Config, cycles: &[Cycle<M, W>]) -> Self {
        let step = |(input, output, words): &Cycle<M, W>| Step {
            input: written(input),
            output: written(output),
            words: serde_json::from_value(written(words)).expect("words have names"),
        };
        let steps = cycles.iter().map(step).collect();
        Self { machine: M::NAME.to_owned(), config: written(config), steps, loop_start: None }
    }

    /// The trace in the oracle's protocol 1: a start, then a step and the output it must get, in turn. One JSON value a line.
    pub fn trace_jsonl(&self) -> String {
        let steps = self.steps.iter().flat_map(|step| [Line::Step(&step.input), Line::Output(&step.output)]);
        let lines = std::iter::once(Line::start(&self.machine, &self.config)).chain(steps);
        lines.map(|line| line.text() + "\n").collect()
    }
}

/// Outcomes, and what they are of: for `safety-case run --outcomes`.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Searched {
    /// The commit whose sources, unchanged, were searched.
    pub commit: String,
    /// The outcomes, one a model.
    pub outcomes: Vec<Outcome>,
}
