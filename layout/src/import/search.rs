//! The way of a route that a file describes by its ends, its circuits and its switches.

use std::collections::{BTreeMap, BTreeSet};

use crate::form::Position;
use crate::graph::{Graph, Way};

/// What is known of a route's way.
pub struct Sought<'a> {
    /// The joint where it starts.
    pub start: usize,
    /// The first circuit.
    pub first: usize,
    /// The joint where it ends, if it is known.
    pub exit: Option<usize>,
    /// The circuits it runs over, if they are known.
    pub within: Option<&'a BTreeSet<usize>>,
    /// Positions of points.
    pub positions: &'a BTreeMap<usize, Position>,
}

/// The longest way that is looked for, in circuits.
const LONGEST: usize = 40;

/// How many steps are looked at before a search is given up.
const PATIENCE: usize = 20_000;

/// The first way found: circuits and the ways through them. A way that covers all circuits of `within`, or ends at `exit`.
pub fn search(graph: &Graph, sought: &Sought<'_>) -> Option<Vec<(usize, Way)>> {
    let mut so_far = Vec::new();
    let mut best: Option<Vec<(usize, Way)>> = None;
    let mut patience = PATIENCE;
    go(graph, sought, sought.start, sought.first, &mut so_far, &mut best, &mut patience);
    best
}

fn go(
    graph: &Graph,
    sought: &Sought<'_>,
    joint: usize,
    circuit: usize,
    so_far: &mut Vec<(usize, Way)>,
    best: &mut Option<Vec<(usize, Way)>>,
    patience: &mut usize,
) {
    let apart = sought.within.is_some_and(|within| !within.contains(&circuit));
    if apart || so_far.len() >= LONGEST || *patience == 0 || so_far.iter().any(|(used, _)| *used == circuit) {
        return;
    }
    *patience -= 1;
    for way in graph.ways(circuit, joint) {
        let opposed = |point: usize, position| sought.positions.get(&point).is_some_and(|given| *given != position);
        if way.passed.iter().any(|passed| opposed(passed.point, passed.position)) {
            continue;
        }
        let exit = way.exit;
        so_far.push((circuit, way));
        let ends = match (sought.exit, sought.within) {
            (Some(wanted), _) => wanted == exit,
            (None, Some(within)) => so_far.len() == within.len(),
            (None, None) => true,
        };
        if ends {
            if best.as_ref().is_none_or(|best| so_far.len() < best.len()) {
                *best = Some(so_far.clone());
            }
        } else if let Some(next) = graph.across(exit, circuit) {
            go(graph, sought, exit, next, so_far, best, patience);
        }
        so_far.pop();
    }
}
