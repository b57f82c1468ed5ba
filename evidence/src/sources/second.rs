//! Second opinions: another checker on the same models. It counts as an engine; where it differs, the model has failed.

use super::models::{id, thousands};
use crate::case::{Engine, EngineResult, Evidence, Kind, Model, SecondOpinion};
use crate::error::Fault;
use crate::judge::verdict::Verdict;
use serde::{Deserialize, Serialize};

/// The other checker, as an engine.
pub const ENGINE: &str = "spin";
const WHAT: &str = "the models of block counting, written a second time in Promela";
const COMMAND: &str = "ci/install-provers && cargo run --release -p atc-models -- spin";

/// What the other checker says of a model.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Opinion {
    /// The model in the catalogue.
    pub model: String,
    /// The other checker.
    pub tool: String,
    /// Its version; empty if it did not run.
    pub version: String,
    /// How many states it found; nothing if it did not run.
    pub states: Option<u64>,
    /// Whether it agrees.
    pub verdict: Agreement,
    /// Why it does not.
    pub reason: Option<String>,
    /// Seconds.
    pub seconds: f64,
}

/// Whether it agrees.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Agreement {
    /// As many states, and the same verdicts.
    Agrees,
    /// Other states, or another verdict.
    Differs,
    /// It is not here, or ended without a result.
    NotRun,
}

impl From<atc_models::SecondOpinion> for Opinion {
    fn from(one: atc_models::SecondOpinion) -> Self {
        let verdict = match one.verdict {
            atc_models::Agreement::Agrees => Agreement::Agrees,
            // A checker that is here and has no result is no reason to believe the model.
            atc_models::Agreement::NotRun if one.is_wrong() => Agreement::Differs,
            atc_models::Agreement::Differs => Agreement::Differs,
            atc_models::Agreement::NotRun => Agreement::NotRun,
        };
        let atc_models::SecondOpinion { model, tool, version, states, reason, seconds, .. } = one;
        Self { model, tool, version, states, verdict, reason, seconds }
    }
}

/// Every opinion is of a model that there is, and no model has two of one tool.
///
/// # Errors
/// All that are not.
pub fn check(opinions: &[Opinion], models: &[String]) -> Result<(), Vec<Fault>> {
    let mut faults = Vec::new();
    for (place, one) in opinions.iter().enumerate() {
        let mut fault = |text: &str| faults.push(Fault::new(&id(&one.model), format!("{}: {text}", one.tool)));
        if !models.contains(&one.model) {
            fault("a second opinion on a model that is not in the catalogue");
        }
        if opinions.iter().take(place).any(|other| (&other.model, &other.tool) == (&one.model, &one.tool)) {
            fault("two second opinions on one model");
        }
    }
    if faults.is_empty() { Ok(()) } else { Err(faults) }
}

/// What the opinions amount to beside the first checker's figures.
pub fn opinions(opinions: &[Opinion], models: &[Model]) -> Vec<SecondOpinion> {
    let judged = opinions.iter().map(|one| {
        let first_states = models.iter().find(|model| model.id == id(&one.model)).and_then(|model| model.unique_states);
        let (verdict, reason) = match one.verdict {
            Agreement::NotRun => (Verdict::NotRun, one.reason.clone()),
            Agreement::Differs => (Verdict::Failed, one.reason.clone().or_else(|| Some("it differs".to_owned()))),
            Agreement::Agrees if first_states.is_none() => {
                (Verdict::Undecided, Some("there is no first opinion to agree with".to_owned()))
            }
            // It must have looked at the same states, whatever it says of itself.
            Agreement::Agrees if one.states != first_states => {
                (Verdict::Undecided, Some("it says that it agrees, and its number of states does not".to_owned()))
            }
            Agreement::Agrees => (Verdict::ModelChecked, None),
        };
        SecondOpinion {
            model: id(&one.model),
            tool: one.tool.clone(),
            version: Some(one.version.clone()).filter(|version| !version.is_empty()),
            first_states,
            states: one.states,
            verdict,
            reason,
            seconds: one.seconds,
        }
    });
    judged.collect()
}

/// Enters the opinions with the evidence of their models. One that differs refutes the model; one that is not run changes
/// nothing.
pub fn enter(opinions: &[SecondOpinion], evidence: &mut [Evidence]) {
    for one in evidence.iter_mut().filter(|one| one.kind == Kind::Model) {
        for opinion in opinions.iter().filter(|opinion| opinion.model == one.id) {
            let note = opinion.reason.clone().unwrap_or_default();
            if opinion.verdict.is_defect() {
                one.verdict = one.verdict.max(opinion.verdict);
                one.reason = Some(format!("{}: {note}", opinion.tool));
            }
            one.engines.push(EngineResult {
                engine: opinion.tool.clone(),
                verdict: opinion.verdict,
                note,
                seconds: opinion.seconds,
            });
        }
    }
}

/// The other checker among the engines. Without any opinion it is not run.
pub fn engine(opinions: &[SecondOpinion]) -> Engine {
    let mine: Vec<_> = opinions.iter().filter(|one| one.tool == ENGINE).collect();
    let agree = mine.iter().filter(|one| one.verdict == Verdict::ModelChecked).count();
    let states: u64 = mine.iter().filter_map(|one| one.states).sum();
    let states = usize::try_from(states).map_or_else(|_| states.to_string(), thousands);
    Engine {
        name: ENGINE.to_owned(),
        what: WHAT.to_owned(),
        verdict: Verdict::worst(mine.iter().map(|one| one.verdict)).unwrap_or(Verdict::NotRun),
        summary: if mine.is_empty() {
            "no result".to_owned()
        } else {
            format!("{agree} of {} models with the same verdicts; {states} states", mine.len())
        },
        command: COMMAND.to_owned(),
    }
}

#[cfg(test)]
#[path = "second_tests.rs"]
mod tests;
