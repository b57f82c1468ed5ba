//! A model as this crate writes it, and as Stateright is given it: every state that it expands is counted.

use crate::outcome::{CutSet, Expectation, FailureMode, Trace};
use crate::twin::Twin;
use stateright::{Model, Property};
use std::fmt::Debug;
use std::hash::Hash;
use std::ops::Deref;
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
    pub(crate) searching: AtomicBool,
    pub(crate) expanded: AtomicUsize,
}

impl<S: Subject> Checked<S> {
    pub(crate) fn new(subject: S, only: Option<&'static str>, limits: Limits) -> Self {
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
