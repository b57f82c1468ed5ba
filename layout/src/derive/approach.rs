//! The approach of a signal: back over neighbours until a braking train is covered.

use std::collections::{BTreeMap, BTreeSet};

use crate::form::EndKind;
use crate::graph::Graph;
use crate::model::{Circuit, Circuits};

/// What was found on the way back from a signal.
pub struct Back {
    /// The circuits on which a train may be that is too near to stop in rear of the signal.
    pub circuits: Circuits,
    /// The least distance covered where the way back leaves what may be used: the line ends unseen, or a circuit is not in `within`.
    pub short: Option<(u32, Shortfall)>,
}

/// Why the way back ends.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Shortfall {
    /// The line goes on unseen from this joint.
    Line(usize),
    /// This circuit is not in the approach.
    Circuit(usize),
}

/// Goes back from the joint `start` through `entry` until `needed` metres are covered. Stops without more at buffer stops and at the
/// circuits of `ahead`; uses no circuit that is not in `within`, if that is given.
pub fn back(
    graph: &Graph,
    circuits: &[Circuit],
    (start, entry): (usize, usize),
    needed: u32,
    ahead: &Circuits,
    within: Option<&Circuits>,
) -> Back {
    let mut found = Back { circuits: BTreeSet::new(), short: None };
    // The least distance from the signal at which a way back enters a circuit by a joint.
    let mut nearest: BTreeMap<(usize, usize), u32> = BTreeMap::new();
    let mut open = vec![(start, entry, 0_u32)];
    while let Some((joint, circuit, distance)) = open.pop() {
        if nearest.get(&(joint, circuit)).is_some_and(|known| *known <= distance) {
            continue;
        }
        nearest.insert((joint, circuit), distance);
        found.circuits.insert(circuit);
        let covered = distance.saturating_add(u32::from(circuits[circuit].length.0));
        if covered >= needed {
            continue;
        }
        let mut falls_short = |why| {
            if found.short.is_none_or(|(least, _)| covered < least) {
                found.short = Some((covered, why));
            }
        };
        for way in graph.ways(circuit, joint) {
            match graph.across(way.exit, circuit) {
                Some(next) if ahead.contains(&next) => {}
                Some(next) if within.is_none_or(|within| within.contains(&next)) => {
                    open.push((way.exit, next, covered));
                }
                Some(next) => falls_short(Shortfall::Circuit(next)),
                None if graph.joints[way.exit].end == Some(EndKind::Line) => falls_short(Shortfall::Line(way.exit)),
                None => {}
            }
        }
    }
    found
}
