//! A model without its types, for Stateright's Explorer: the server in it is compiled once, and not once a model.

use crate::outcome::Expectation;
use crate::subject::{Checked, Subject};
use stateright::{Model, Property};
use std::any::Any;
use std::fmt;
use std::hash::{DefaultHasher, Hash, Hasher};
use std::net::SocketAddr;
use std::sync::Arc;

/// A state or an action of any model.
#[derive(Clone)]
pub struct Thing {
    value: Arc<dyn Any + Send + Sync>,
    show: fn(&dyn Any, &mut fmt::Formatter) -> fmt::Result,
    /// Equal for equal things.
    pub hash: u64,
}

impl Thing {
    fn new<T: fmt::Debug + Send + Sync + 'static>(value: T, hash: u64) -> Self {
        fn show<T: fmt::Debug + 'static>(value: &dyn Any, out: &mut fmt::Formatter) -> fmt::Result {
            value.downcast_ref::<T>().map_or(Ok(()), |value| value.fmt(out))
        }
        Self { value: Arc::new(value), show: show::<T>, hash }
    }

    fn state<T: fmt::Debug + Hash + Send + Sync + 'static>(state: T) -> Self {
        let mut hasher = DefaultHasher::new();
        state.hash(&mut hasher);
        Self::new(state, hasher.finish())
    }

    fn get<T: 'static>(&self) -> Option<&T> {
        self.value.downcast_ref()
    }
}

impl fmt::Debug for Thing {
    fn fmt(&self, out: &mut fmt::Formatter) -> fmt::Result {
        (self.show)(&*self.value, out)
    }
}

impl Hash for Thing {
    fn hash<H: Hasher>(&self, hasher: &mut H) {
        hasher.write_u64(self.hash);
    }
}

impl PartialEq for Thing {
    fn eq(&self, other: &Self) -> bool {
        self.hash == other.hash && format!("{self:?}") == format!("{other:?}")
    }
}

/// A [`Subject`] of any type. What belongs to another subject has no actions, no next state, and no claim holds of it.
pub trait Explored: Send + Sync {
    fn initial(&self) -> Vec<Thing>;
    fn actions(&self, state: &Thing) -> Vec<Thing>;
    fn next(&self, state: &Thing, action: &Thing) -> Option<Thing>;
    fn claims(&self) -> Vec<(&'static str, Expectation)>;
    fn holds(&self, claim: usize, state: &Thing) -> bool;
}

impl<S: Subject> Explored for Checked<S> {
    fn initial(&self) -> Vec<Thing> {
        Subject::initial(&**self).into_iter().map(Thing::state).collect()
    }

    fn actions(&self, state: &Thing) -> Vec<Thing> {
        let mut actions = Vec::new();
        if let Some(state) = state.get() {
            Subject::actions(&**self, state, &mut actions);
        }
        actions.into_iter().map(|action| Thing::new(action, 0)).collect()
    }

    fn next(&self, state: &Thing, action: &Thing) -> Option<Thing> {
        Subject::next(&**self, state.get()?, action.get()?).map(Thing::state)
    }

    fn claims(&self) -> Vec<(&'static str, Expectation)> {
        Subject::claims(&**self).into_iter().map(|claim| (claim.name, claim.expectation)).collect()
    }

    fn holds(&self, claim: usize, state: &Thing) -> bool {
        let claims = Subject::claims(&**self);
        claims.get(claim).zip(state.get()).is_some_and(|(claim, state)| (claim.condition)(self, state))
    }
}

/// What Stateright is given.
pub struct Shown(pub Arc<dyn Explored>);

/// Stateright takes a bare function for each property: one for each number that a claim can have.
macro_rules! numbered {
    ($($number:literal)*) => { [$(|shown, state| shown.0.holds($number, state)),*] };
}

type Condition = fn(&Shown, &Thing) -> bool;
const CONDITIONS: [Condition; 32] = numbered!(
    0 1 2 3 4 5 6 7 8 9 10 11 12 13 14 15 16 17 18 19 20 21 22 23 24 25 26 27 28 29 30 31
);

impl Model for Shown {
    type State = Thing;
    type Action = Thing;

    fn init_states(&self) -> Vec<Thing> {
        self.0.initial()
    }

    fn actions(&self, state: &Thing, actions: &mut Vec<Thing>) {
        actions.extend(self.0.actions(state));
    }

    fn next_state(&self, state: &Thing, action: Thing) -> Option<Thing> {
        self.0.next(state, &action)
    }

    fn properties(&self) -> Vec<Property<Self>> {
        let named = self.0.claims().into_iter().zip(CONDITIONS);
        let property = |((name, expectation), condition): ((&'static str, Expectation), Condition)| match expectation {
            Expectation::AlwaysHolds => Property::always(name, condition),
            Expectation::SometimesReached | Expectation::HazardFound => Property::sometimes(name, condition),
        };
        named.map(property).collect()
    }
}

/// Serves the Explorer for one model, until the process ends.
pub(crate) fn serve(model: &Arc<dyn Explored>, address: SocketAddr) {
    let _ = Shown(Arc::clone(model)).checker().serve(address);
}
