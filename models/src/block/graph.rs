//! A plain breadth-first search that keeps its graph: for questions that are not about single states.

use crate::subject::Limits;
use ahash::AHashMap;
use std::collections::hash_map::Entry;
use std::hash::Hash;
use std::time::Instant;

/// Every reachable state, and the steps between them.
pub(crate) struct Graph<T, A> {
    /// The states, in the order in which they were found.
    pub states: Vec<T>,
    /// How each was found first: the state before, and the step.
    found_by: Vec<Option<(usize, A)>>,
    /// The states after each.
    after: Vec<Vec<usize>>,
}

impl<T: Copy + Eq + Hash, A: Clone> Graph<T, A> {
    /// Searches from `initial`; stops early at a state that is a `goal`, which is then the last one. `None`: the limits were
    /// reached first.
    pub(crate) fn explore(
        initial: impl IntoIterator<Item = T>,
        limits: Limits,
        next: impl Fn(&T) -> Vec<(A, T)>,
        goal: impl Fn(&T) -> bool,
    ) -> Option<Self> {
        let start = Instant::now();
        let mut graph = Self { states: Vec::new(), found_by: Vec::new(), after: Vec::new() };
        let mut numbers = AHashMap::new();
        for state in initial {
            if let Entry::Vacant(free) = numbers.entry(state) {
                free.insert(graph.states.len());
                graph.states.push(state);
                graph.found_by.push(None);
            }
        }
        while let Some(state) = graph.states.get(graph.after.len()).copied() {
            let number = graph.after.len();
            if number >= limits.states || number.is_multiple_of(1024) && start.elapsed() >= limits.time {
                return None;
            }
            let mut after = Vec::new();
            for (step, state) in next(&state) {
                match numbers.entry(state) {
                    Entry::Occupied(known) => after.push(*known.get()),
                    Entry::Vacant(free) => {
                        after.push(graph.states.len());
                        free.insert(graph.states.len());
                        graph.states.push(state);
                        graph.found_by.push(Some((number, step)));
                        if goal(&state) {
                            return Some(graph);
                        }
                    }
                }
            }
            after.sort_unstable();
            after.dedup();
            graph.after.push(after);
        }
        Some(graph)
    }

    /// The shortest way to the state found last.
    pub(crate) fn path_to_last(&self) -> Vec<(T, Option<A>)> {
        let mut path = Vec::new();
        let mut place = self.states.len().checked_sub(1).map(|last| (last, None));
        while let Some((number, step)) = place {
            path.push((self.states[number], step));
            place = self.found_by[number].clone().map(|(before, step)| (before, Some(step)));
        }
        path.reverse();
        path
    }

    /// For each state whether a state that is a `goal` can be reached from it.
    pub(crate) fn can_reach(&self, goal: impl Fn(&T) -> bool) -> Vec<bool> {
        let mut before = vec![Vec::new(); self.states.len()];
        for (number, after) in self.after.iter().enumerate() {
            for next in after {
                before[*next].push(number);
            }
        }
        let mut can: Vec<_> = self.states.iter().map(goal).collect();
        let mut pending: Vec<_> = (0..can.len()).filter(|number| can[*number]).collect();
        while let Some(number) = pending.pop() {
            for earlier in &before[number] {
                if !can[*earlier] {
                    can[*earlier] = true;
                    pending.push(*earlier);
                }
            }
        }
        can
    }
}
