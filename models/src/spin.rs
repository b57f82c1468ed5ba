//! A second opinion: models that are written once more, by hand, in Promela, and searched by SPIN.
//!
//! Nothing is shared with the Stateright model but the specification: not the kernel's code, not the environment's, not the search.
//! The two agree only if they count the same states *and* the same steps, and say the same of every property.

use crate::check::{Entry, check};
use crate::outcome::{Expectation, Outcome, PropertyOutcome, Verdict};
use crate::pool::in_parallel;
use serde::{Deserialize, Serialize};
use std::time::Instant;

mod tool;

pub use crate::twin::Twin;
use tool::CHECKER;
pub use tool::Spin;
pub(crate) use tool::{COUNTER, Folder};
pub use tool::{Counted, counted, refuted};

/// Whether two checkers agree on a model.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Agreement {
    /// As many states, as many steps, and the same of every property.
    Agrees,
    /// Not so.
    Differs,
    /// The other checker is not here, or ended without a result.
    NotRun,
}

/// What another checker says of a model of the catalogue.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct SecondOpinion {
    /// The model's name in the catalogue.
    pub model: String,
    /// The other checker.
    pub tool: String,
    /// Its version; empty if it is not here.
    pub version: String,
    /// The states that it stored; nothing if it ended without a result.
    pub states: Option<u64>,
    /// Whether it agrees.
    pub verdict: Agreement,
    /// Why it does not.
    pub reason: Option<String>,
    /// Time that it took, compilation included.
    pub seconds: f64,
}

impl SecondOpinion {
    /// Whether the tool is here and does not agree: it differs, or had no result.
    pub fn is_wrong(&self) -> bool {
        match self.verdict {
            Agreement::Agrees => false,
            Agreement::Differs => true,
            Agreement::NotRun => !self.version.is_empty(),
        }
    }
}

/// SPIN's opinion on each of these models that has a twin in Promela, in their order; `threads` models at the same time. It is compared with the
/// `known` outcome of the model; where there is none, the model is searched. `done` sees each as soon as it is there, with our own outcome.
pub fn opinions_on(
    entries: &[Entry],
    known: &[Outcome],
    threads: usize,
    done: impl Fn(&(Outcome, SecondOpinion)) + Sync,
) -> Vec<SecondOpinion> {
    let twins: Vec<_> = entries.iter().filter_map(|entry| entry.twin.as_ref().map(|twin| (entry, twin))).collect();
    let spin = Spin::find();
    let judge = |(entry, twin): &(&Entry, &Twin)| {
        let found = known.iter().find(|outcome| outcome.model == entry.name && outcome.complete).cloned();
        let outcome = found.unwrap_or_else(|| check(entry, 1));
        let second = opinion(&spin, twin, &outcome);
        (outcome, second)
    };
    in_parallel(&twins, threads, judge, done).into_iter().map(|(_, second)| second).collect()
}

/// SPIN's opinion on `twin`, where ours is `outcome`. Without SPIN it is not run.
pub fn opinion(spin: &Result<Spin, String>, twin: &Twin, outcome: &Outcome) -> SecondOpinion {
    let start = Instant::now();
    let version = spin.as_ref().map_or("", |spin| spin.version()).to_owned();
    let found = spin.as_ref().map_err(Clone::clone).and_then(|spin| look(spin, twin, outcome));
    let (states, verdict, reason) = match found {
        Err(reason) => (None, Agreement::NotRun, Some(reason)),
        Ok((counted, refuted)) => {
            let reason = difference(twin, outcome, counted, &refuted);
            let verdict = if reason.is_none() { Agreement::Agrees } else { Agreement::Differs };
            (Some(counted.states), verdict, reason)
        }
    };
    let seconds = start.elapsed().as_secs_f64();
    SecondOpinion { model: outcome.model.clone(), tool: "spin".to_owned(), version, states, verdict, reason, seconds }
}

/// What SPIN counts, and for each property of `outcome` whether it refutes the twin's.
fn look(spin: &Spin, twin: &Twin, outcome: &Outcome) -> Result<(Counted, Vec<bool>), String> {
    let folder = Folder::new(&outcome.model)?;
    spin.generate(&folder, twin)?;
    // Compiling takes longer than every search: nothing is optimised.
    let counted = folder.compile("count", COUNTER)?.count()?;
    let claims = folder.compile("claims", CHECKER)?;
    let refuted = outcome.properties.iter().map(|property| claims.refutes(&formula(property)));
    Ok((counted, refuted.collect::<Result<_, _>>()?))
}

/// The name of a property in Promela.
fn formula(property: &PropertyOutcome) -> String {
    let name = property.name.replace('-', "_");
    if property.expectation == Expectation::AlwaysHolds { name } else { format!("never_{name}") }
}

/// In what the two differ, if they do.
pub fn difference(twin: &Twin, outcome: &Outcome, counted: Counted, refuted: &[bool]) -> Option<String> {
    let mut differences = Vec::new();
    let count = |number: usize| u64::try_from(number).unwrap_or(u64::MAX);
    let (states, steps) = (count(outcome.unique_states), count(outcome.generated_states) + u64::from(twin.chooses));
    if !outcome.complete {
        differences.push("not every state was visited here".to_owned());
    }
    if counted.states != states {
        differences.push(format!("{} states, {states} here", counted.states));
    }
    if counted.steps != steps {
        differences.push(format!("{} steps, {steps} here", counted.steps));
    }
    if refuted.len() != outcome.properties.len() || refuted.is_empty() {
        differences.push("not the same properties".to_owned());
    }
    for (property, refuted) in outcome.properties.iter().zip(refuted) {
        let reached = match property.verdict {
            Verdict::Failed | Verdict::Found => true,
            Verdict::ModelChecked | Verdict::NotFound => false,
            Verdict::Incomplete => !refuted,
        };
        if *refuted != reached {
            let word = |reached| if reached { "reached" } else { "not reached" };
            let target = if property.expectation == Expectation::AlwaysHolds { "a breach of " } else { "" };
            differences.push(format!("{target}{} is {}, {} here", property.name, word(*refuted), word(reached)));
        }
    }
    if differences.is_empty() { None } else { Some(differences.join("; ")) }
}
