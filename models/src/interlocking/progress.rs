//! The states from which not every train can arrive any more, whatever is requested: by a search of the whole graph.

use super::device::Device;
use super::train::Place;
use super::yard::{State, Yard};
use crate::block::graph::Graph;
use crate::subject::{Limits, Subject};

impl<D: Device> Yard<D> {
    /// Whether every train of the timetable is where it ends.
    pub fn all_arrived(&self, state: &State) -> bool {
        state.trains.iter().all(|train| train.place == Place::Gone)
    }

    /// Whether every train can still arrive. False if the states are too many to know.
    pub fn can_finish(&self, state: &State) -> bool {
        let doomed = self.doomed.0.get_or_init(|| {
            let next = |state: &State| {
                let mut cycles = Vec::new();
                self.actions(state, &mut cycles);
                cycles.iter().filter_map(|cycle| Some(((), self.next(state, cycle)?))).collect()
            };
            let graph = Graph::explore(self.initial(), Limits::default(), next, |_| false)?;
            let can = graph.can_reach(|state| self.all_arrived(state));
            Some(graph.states.into_iter().zip(can).filter(|(_, can)| !can).map(|(state, _)| state).collect())
        });
        doomed.as_ref().is_some_and(|doomed| !doomed.contains(state))
    }
}
