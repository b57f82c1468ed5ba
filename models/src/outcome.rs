//! What a check says: verdicts, figures and traces, for people, for the safety case and for the oracle.

use crate::check::Search;
use crate::line::{self, ASPECTS_KM_H, Line};
use crate::train::{Displays, Train};
use atc_kernel::aspect::{Acceptance, AspectSet};
use serde::{Deserialize, Serialize};
use serde_json::json;

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
    /// Times, aspects and environment in words.
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
}

impl Outcome {
    /// Whether the search was complete and every expectation is met. A model without properties is not.
    pub fn ok(&self) -> bool {
        self.complete && !self.properties.is_empty() && self.properties.iter().all(PropertyOutcome::ok)
    }
}

pub(crate) struct Found {
    pub model: String,
    pub statement: String,
    pub requirements: Vec<String>,
    pub parameters: String,
    pub in_force: Vec<String>,
    pub lifted: Vec<String>,
    pub search: Search,
}

impl From<Found> for Outcome {
    fn from(found: Found) -> Self {
        Self {
            model: found.model,
            statement: found.statement,
            requirements: found.requirements,
            parameters: found.parameters,
            assumptions_in_force: found.in_force,
            assumptions_lifted: found.lifted,
            complete: found.search.complete,
            unique_states: found.search.unique,
            generated_states: found.search.generated,
            max_depth: found.search.depth,
            seconds: found.search.seconds,
            properties: found.search.properties,
        }
    }
}

/// The configuration of the oracle, protocol 1, that a trace belongs to.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Config {
    /// The length of a logic cycle.
    pub cycle_ms: u32,
    /// The permitted speeds, the lowest first.
    pub aspects_km_h: Vec<u16>,
    /// T1.
    pub operate_ms: u32,
    /// T2.
    pub recovery_ms: u32,
    /// T3.
    pub mask_ms: u32,
    /// T4.
    pub interruption_ms: u32,
    /// T5.
    pub shortened_operate_ms: u32,
}

/// One cycle of a trace. Speeds in km/h; no speed where nothing is displayed.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct TraceStep {
    /// What the ground sent; absent in a model without a ground.
    #[serde(skip_serializing_if = "Option::is_none", default)]
    pub sent_km_h: Option<Vec<u16>>,
    /// What the receiver detected throughout the cycle.
    pub detected_km_h: Vec<u16>,
    /// The display of the normative device: always the kernel's.
    pub normative_km_h: Option<u16>,
    /// The display of the conventional device.
    pub conventional_km_h: Option<u16>,
    /// The display of the machine as claimed.
    pub as_claimed_km_h: Option<u16>,
}

/// A run of the devices from their initial states.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Trace {
    /// The line.
    pub config: Config,
    /// The cycles in order.
    pub steps: Vec<TraceStep>,
    /// The number of the step (from 0) from which the trace may repeat for ever.
    #[serde(skip_serializing_if = "Option::is_none", default)]
    pub loop_start: Option<usize>,
}

impl Trace {
    /// Runs the real devices over `detections` (detected, sent); the last `loop_length` cycles may repeat.
    pub(crate) fn replay(
        line: Line,
        aspects: usize,
        detections: impl Iterator<Item = (AspectSet, Option<AspectSet>)>,
        loop_length: Option<usize>,
    ) -> Self {
        let device = Acceptance::<{ ASPECTS_KM_H.len() }> { times: line.ticks() };
        let mut train = Train::<_, { ASPECTS_KM_H.len() }>::initial(&device);
        let steps: Vec<_> = detections
            .map(|(detected, sent)| {
                train = train.step(&device, detected);
                let Displays { normative, conventional, as_claimed } = train.shown;
                TraceStep {
                    sent_km_h: sent.map(line::speeds),
                    detected_km_h: line::speeds(detected),
                    normative_km_h: line::speed(normative),
                    conventional_km_h: line::speed(conventional),
                    as_claimed_km_h: line::speed(as_claimed),
                }
            })
            .collect();
        let loop_start = loop_length.and_then(|length| steps.len().checked_sub(length));
        Self { config: Config::of(line, aspects), steps, loop_start }
    }

    /// The trace in the oracle's protocol 1: a start, then a step and the output it must get, in turn; with the display of
    /// the normative device. One JSON value a line.
    pub fn trace_jsonl(&self) -> String {
        let start = json!({"start": {"protocol": 1, "machine": "aspect-acceptance", "config": self.config}});
        let mut text = format!("{start}\n");
        for step in &self.steps {
            let input = json!({"step": {"detected_km_h": step.detected_km_h}});
            let output = json!({"output": {"display_km_h": step.normative_km_h}});
            text.extend([input, output].map(|line| format!("{line}\n")));
        }
        text
    }
}

impl Config {
    fn of(line: Line, aspects: usize) -> Self {
        Self {
            cycle_ms: line.cycle.0,
            aspects_km_h: ASPECTS_KM_H.iter().take(aspects).copied().collect(),
            operate_ms: line.times.operate.0,
            recovery_ms: line.times.recovery.0,
            mask_ms: line.times.mask.0,
            interruption_ms: line.times.interruption.0,
            shortened_operate_ms: line.times.shortened_operate.0,
        }
    }
}
