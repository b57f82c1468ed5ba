//! A model as this crate writes it, and the exhaustive search of it by Stateright.
//!
//! Stateright stops early when every property is decided, and tells neither that from a finished search nor a time-out
//! from either. So nothing is taken from it on trust: every expanded state is counted here, and a search is complete
//! only if as many states were expanded as exist.

use crate::explorer::{self, Explored};
use crate::outcome::{CutSet, Expectation, FailureMode, Found, Outcome, PropertyOutcome, Trace, Verdict};
use crate::spin::Twin;
use stateright::{Checker, Model, Property};
use std::collections::HashMap;
use std::fmt::Debug;
use std::hash::Hash;
use std::io;
use std::net::{SocketAddr, TcpListener};
use std::ops::Deref;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::time::{Duration, Instant};

/// A model: states, actions, the next state, and what is claimed.
pub trait Subject: Clone + Send + Sync + Sized + 'static {
    /// One state of the environment, the train and the ghosts.
    type State: Clone + Debug + Hash + PartialEq + Send + Sync;
    /// What happens in one logic cycle.
    type Action: Clone + Debug + PartialEq + Send + Sync;

    /// The states in which it may start.
    fn initial(&self) -> Vec<Self::State>;
    /// What may happen next.
    fn actions(&self, state: &Self::State, actions: &mut Vec<Self::Action>);
    /// The state after that; `None` if it is outside the model.
    fn next(&self, state: &Self::State, action: &Self::Action) -> Option<Self::State>;
    /// What is claimed of it.
    fn claims(&self) -> Vec<Claim<Self>>;
    /// Its parameters in words.
    fn parameters(&self) -> String;
    /// A path from an initial state, run through the kernel's own machine.
    fn trace(&self, path: &[(Self::State, Option<Self::Action>)]) -> Trace;
    /// The minimal sets of faults that reach its hazard. `None`: not every state was visited.
    fn cut_sets(&self, _limits: Limits) -> Option<Vec<CutSet>> {
        Some(Vec::new())
    }
    /// What each single fault does. `None`: not every state was visited.
    fn failure_modes(&self, _limits: Limits) -> Option<Vec<FailureMode>> {
        Some(Vec::new())
    }
    /// The same model in Promela, if it is written there too.
    fn twin(&self) -> Option<Twin> {
        None
    }
}

/// One claim about every state, or about some state.
#[derive(Clone)]
pub struct Claim<S: Subject> {
    /// Its name, unique in the model, in kebab-case.
    pub name: &'static str,
    /// The claim in a sentence.
    pub text: String,
    /// What is expected of it.
    pub expectation: Expectation,
    /// For a hazard: the assumptions and requirements of which each alone excludes it.
    pub excluded_by: &'static [&'static str],
    /// The predicate: to hold always, or to be reached.
    pub condition: fn(&Checked<S>, &S::State) -> bool,
}

impl<S: Subject> Claim<S> {
    /// `condition` holds in every state.
    pub fn always(name: &'static str, text: impl Into<String>, condition: fn(&Checked<S>, &S::State) -> bool) -> Self {
        Self { name, text: text.into(), expectation: Expectation::AlwaysHolds, excluded_by: &[], condition }
    }

    /// `condition` holds in some state: the model is not empty of it.
    pub fn sometimes(
        name: &'static str,
        text: impl Into<String>,
        condition: fn(&Checked<S>, &S::State) -> bool,
    ) -> Self {
        Self { name, text: text.into(), expectation: Expectation::SometimesReached, excluded_by: &[], condition }
    }

    /// `condition` is a hazard, and the search must find it.
    pub fn hazard(
        name: &'static str,
        text: impl Into<String>,
        excluded_by: &'static [&'static str],
        condition: fn(&Checked<S>, &S::State) -> bool,
    ) -> Self {
        Self { name, text: text.into(), expectation: Expectation::HazardFound, excluded_by, condition }
    }
}

/// How far a search may go. Beyond that it is incomplete, and nothing is model-checked.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Limits {
    /// States that may be expanded.
    pub states: usize,
    /// Time that it may take.
    pub time: Duration,
}

impl Default for Limits {
    /// Twenty million states, 500 seconds.
    fn default() -> Self {
        Self { states: 20_000_000, time: Duration::from_secs(500) }
    }
}

/// A model on its way through Stateright.
pub struct Checked<S: Subject> {
    subject: S,
    /// Look for this one only, and stop there.
    only: Option<&'static str>,
    limits: Limits,
    start: Instant,
    searching: AtomicBool,
    expanded: AtomicUsize,
}

impl<S: Subject> Checked<S> {
    fn new(subject: S, only: Option<&'static str>, limits: Limits) -> Self {
        Self {
            subject,
            only,
            limits,
            start: Instant::now(),
            searching: AtomicBool::new(true),
            expanded: AtomicUsize::new(0),
        }
    }

    /// Counts one expansion; false if the limits forbid it.
    fn may_expand(&self) -> bool {
        if !self.searching.load(Ordering::Relaxed) {
            return true;
        }
        let within =
            self.expanded.load(Ordering::Relaxed) < self.limits.states && self.start.elapsed() < self.limits.time;
        if within {
            self.expanded.fetch_add(1, Ordering::Relaxed);
        }
        within
    }
}

impl<S: Subject> Deref for Checked<S> {
    type Target = S;

    fn deref(&self) -> &S {
        &self.subject
    }
}

impl<S: Subject> Model for Checked<S> {
    type State = S::State;
    type Action = S::Action;

    fn init_states(&self) -> Vec<S::State> {
        self.subject.initial()
    }

    fn actions(&self, state: &S::State, actions: &mut Vec<S::Action>) {
        if self.may_expand() {
            self.subject.actions(state, actions);
        }
    }

    fn next_state(&self, state: &S::State, action: S::Action) -> Option<S::State> {
        self.subject.next(state, &action)
    }

    fn properties(&self) -> Vec<Property<Self>> {
        let claims = self.subject.claims().into_iter().filter(|claim| self.only.is_none_or(|only| only == claim.name));
        let mut properties: Vec<_> = claims
            .map(|claim| match claim.expectation {
                Expectation::AlwaysHolds => Property::always(claim.name, claim.condition),
                Expectation::SometimesReached | Expectation::HazardFound => {
                    Property::sometimes(claim.name, claim.condition)
                }
            })
            .collect();
        if self.only.is_none() {
            // Never decided, so that Stateright goes on to the last state.
            properties.push(Property::always("(every state is visited)", |_, _| true));
        }
        properties
    }
}

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

/// What a model is about: everything of an [`Entry`] but the model.
#[derive(Clone, Debug)]
pub struct About {
    /// Its name, unique in the catalogue, in kebab-case.
    pub name: &'static str,
    /// What it shows, in plain English.
    pub statement: String,
    /// The requirements and theorems that it checks, as in the specification.
    pub requirements: &'static [&'static str],
    /// The environment in words.
    pub environment: String,
    /// The assumptions in force, by id.
    pub in_force: &'static [&'static str],
    /// The assumptions that are deliberately lifted, by id.
    pub lifted: &'static [&'static str],
}

/// One model of the catalogue.
pub struct Entry {
    /// Its name, unique in the catalogue, in kebab-case.
    pub name: &'static str,
    /// What it shows, in plain English.
    pub statement: String,
    /// The requirements and theorems that it checks, as in the specification.
    pub requirements: &'static [&'static str],
    /// Parameters and environment in words.
    pub parameters: String,
    /// The assumptions in force, by id.
    pub in_force: &'static [&'static str],
    /// The assumptions that are deliberately lifted, by id.
    pub lifted: &'static [&'static str],
    /// The same model in Promela, if it is written there too.
    pub twin: Option<Twin>,
    search: Box<dyn Fn(usize, Limits) -> Search + Send + Sync>,
    pub(crate) explored: Arc<dyn Explored>,
}

impl Entry {
    /// The model `subject`, and what it is about.
    pub fn new<S: Subject>(about: About, subject: S) -> Self {
        let explored = Arc::new(Checked::new(subject.clone(), None, Limits::default()));
        let parameters = format!("{}; {}", subject.parameters(), about.environment);
        Self {
            name: about.name,
            statement: about.statement,
            requirements: about.requirements,
            parameters,
            in_force: about.in_force,
            lifted: about.lifted,
            twin: subject.twin(),
            search: Box::new(move |threads, limits| search(&subject, threads, limits)),
            explored,
        }
    }
}

/// Checks one model with `threads` threads (at least one). The number of threads changes nothing but the time and,
/// by a little, the depth that is reported.
pub fn check(entry: &Entry, threads: usize) -> Outcome {
    check_within(entry, threads, Limits::default())
}

/// Checks one model within `limits`.
pub fn check_within(entry: &Entry, threads: usize, limits: Limits) -> Outcome {
    let found = (entry.search)(threads, limits);
    let owned = |ids: &[&str]| ids.iter().map(ToString::to_string).collect();
    Outcome::from(Found {
        model: entry.name.to_owned(),
        statement: entry.statement.clone(),
        requirements: owned(entry.requirements),
        parameters: entry.parameters.clone(),
        in_force: owned(entry.in_force),
        lifted: owned(entry.lifted),
        search: found,
    })
}

/// Serves Stateright's Explorer for one model on `address`, until the process ends.
///
/// # Errors
/// If the address cannot be bound.
pub fn explore(entry: &Entry, address: SocketAddr) -> io::Result<()> {
    // The server itself panics on an address that is taken.
    drop(TcpListener::bind(address)?);
    explorer::serve(&entry.explored, address);
    Ok(())
}
