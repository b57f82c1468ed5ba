//! The exhaustive search of a model by Stateright.
//!
//! Stateright stops early when every property is decided, and tells neither that from a finished search nor a time-out
//! from either. So nothing is taken from it on trust: every expanded state is counted here, and a search is complete
//! only if as many states were expanded as exist.

use crate::outcome::{CutSet, Expectation, FailureMode, PropertyOutcome, Trace, Verdict};
use crate::subject::{Checked, Claim, Limits, Subject};
use stateright::{Checker, Model};
use std::collections::HashMap;
use std::sync::atomic::Ordering;
use std::time::Instant;

/// What a search counted.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Search {
    pub complete: bool,
    pub unique: usize,
    pub generated: usize,
    pub depth: usize,
    pub seconds: f64,
    pub properties: Vec<PropertyOutcome>,
    pub cut_sets: Vec<CutSet>,
    pub failure_modes: Vec<FailureMode>,
}

/// What a bare visit of every state counted: no claim is judged, and no trace is made.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Visit {
    /// Whether every state was visited.
    pub complete: bool,
    /// Different states.
    pub unique: usize,
    /// States generated, repeats included.
    pub generated: usize,
    /// Time taken.
    pub seconds: f64,
}

/// Visits every state of a model with `threads` threads.
pub fn visit<S: Subject>(subject: &S, threads: usize) -> Visit {
    let start = Instant::now();
    let checked = Checked::new(subject.clone(), None, Limits::default());
    let checker = checked.checker().threads(threads.max(1)).spawn_bfs().join();
    let unique = checker.unique_state_count();
    let complete = unique > 0 && checker.model().expanded.load(Ordering::Relaxed) == unique;
    Visit { complete, unique, generated: checker.state_count(), seconds: start.elapsed().as_secs_f64() }
}

/// Searches the whole model with `threads` threads, then once more for the shortest trace to each state that a
/// property found.
pub(crate) fn search<S: Subject>(subject: &S, threads: usize, limits: Limits) -> Search {
    let start = Instant::now();
    let checker = Checked::new(subject.clone(), None, limits).checker().threads(threads.max(1)).spawn_bfs().join();
    let model = checker.model();
    model.searching.store(false, Ordering::Relaxed);
    let unique = checker.unique_state_count();
    let (cut_sets, failure_modes) = (subject.cut_sets(limits), subject.failure_modes(limits));
    let complete =
        unique > 0 && model.expanded.load(Ordering::Relaxed) == unique && cut_sets.is_some() && failure_modes.is_some();
    let decided = checker.discoveries();
    let properties = subject
        .claims()
        .into_iter()
        .map(|claim| {
            let found = decided.contains_key(claim.name);
            let verdict = verdict(claim.expectation, found, complete);
            let trace = if found { shortest(subject, &claim, limits) } else { None };
            PropertyOutcome {
                name: claim.name.to_owned(),
                text: claim.text,
                expectation: claim.expectation,
                verdict,
                excluded_by: claim.excluded_by.iter().map(ToString::to_string).collect(),
                trace,
            }
        })
        .collect();
    let seconds = start.elapsed().as_secs_f64();
    Search {
        complete,
        unique,
        generated: checker.state_count(),
        depth: checker.max_depth(),
        seconds,
        properties,
        cut_sets: cut_sets.unwrap_or_default(),
        failure_modes: failure_modes.unwrap_or_default(),
    }
}

fn verdict(expectation: Expectation, discovered: bool, complete: bool) -> Verdict {
    match (expectation, discovered) {
        (Expectation::AlwaysHolds, true) => Verdict::Failed,
        (Expectation::SometimesReached | Expectation::HazardFound, true) => Verdict::Found,
        _ if !complete => Verdict::Incomplete,
        (Expectation::AlwaysHolds, false) => Verdict::ModelChecked,
        (Expectation::SometimesReached | Expectation::HazardFound, false) => Verdict::NotFound,
    }
}

fn shortest<S: Subject>(subject: &S, claim: &Claim<S>, limits: Limits) -> Option<Trace> {
    // One thread: only then breadth-first means shortest.
    let checker = Checked::new(subject.clone(), Some(claim.name), limits).checker().spawn_bfs().join();
    checker.model().searching.store(false, Ordering::Relaxed);
    let mut paths: HashMap<_, _> = checker.discoveries();
    paths.remove(claim.name).map(|path| subject.trace(&path.into_vec()))
}
