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
    /// The circuit that it comes from there, if it is known.
    pub last: Option<usize>,
    /// The circuits it runs over, if they are known: it leaves none out.
    pub within: Option<&'a BTreeSet<usize>>,
    /// Positions of points.
    pub positions: &'a BTreeMap<usize, Position>,
}

/// A way that was found.
pub struct Found {
    /// The shortest way: circuits and the ways through them.
    pub way: Vec<(usize, Way)>,
    /// Whether nothing else that was looked at fits.
    pub alone: bool,
}

/// The longest way that is looked for, in circuits.
const LONGEST: usize = 40;

/// How many steps are looked at before a search is given up.
const PATIENCE: usize = 20_000;

/// The shortest way that ends at `exit`, runs over the circuits of `within`, and keeps the positions: what is known of these.
pub fn search(graph: &Graph, sought: &Sought<'_>) -> Option<Found> {
    let mut looking = Looking { graph, sought, so_far: Vec::new(), best: None, found: 0, patience: PATIENCE };
    looking.go(sought.start, sought.first);
    let alone = looking.found == 1 && looking.patience > 0;
    looking.best.map(|way| Found { way, alone })
}

struct Looking<'a> {
    graph: &'a Graph,
    sought: &'a Sought<'a>,
    so_far: Vec<(usize, Way)>,
    best: Option<Vec<(usize, Way)>>,
    found: usize,
    patience: usize,
}

impl Looking<'_> {
    fn go(&mut self, joint: usize, circuit: usize) {
        let Sought { exit: wanted, last, within, positions, .. } = self.sought;
        let apart = within.is_some_and(|within| !within.contains(&circuit));
        let long = self.so_far.len() >= LONGEST;
        if apart || long || self.patience == 0 || self.so_far.iter().any(|(used, _)| *used == circuit) {
            return;
        }
        self.patience -= 1;
        for way in self.graph.ways(circuit, joint) {
            let opposed = |point: usize, position| positions.get(&point).is_some_and(|given| *given != position);
            if way.passed.iter().any(|passed| opposed(passed.point, passed.position)) {
                continue;
            }
            let exit = way.exit;
            self.so_far.push((circuit, way));
            let whole = within.is_none_or(|within| self.so_far.len() == within.len());
            let ends = wanted.is_none_or(|wanted| wanted == exit) && last.is_none_or(|last| last == circuit);
            if whole && ends {
                self.found += 1;
                if self.best.as_ref().is_none_or(|best| self.so_far.len() < best.len()) {
                    self.best = Some(self.so_far.clone());
                }
            } else if let Some(next) = self.graph.across(exit, circuit) {
                self.go(exit, next);
            }
            self.so_far.pop();
        }
    }
}
