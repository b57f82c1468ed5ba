//! Flank protection: what keeps vehicles off the legs that a path does not use.

use std::collections::BTreeSet;

use crate::form::{EndKind, Position};
use crate::graph::{Graph, Kind, Passed};
use crate::model::{Guard, Positions};

/// Where the routes of a station start: the joint, the circuit in rear of it, and the signal there.
pub type Signals = Vec<(usize, usize, String)>;

/// What is on the tracks that lead to the unused leg of `passed`, on a path that runs over the points `own`.
pub fn guards(graph: &Graph, signals: &Signals, own: &Positions, passed: Passed) -> Vec<Guard> {
    let mut walk = Walk { graph, signals, own, seen: BTreeSet::new(), guards: Vec::new() };
    let point = graph.tracks.iter().position(|track| track.kind == Kind::Point(passed.point));
    if let Some(point) = point {
        walk.outward(point, passed.other_leg);
    }
    walk.guards
}

struct Walk<'a> {
    graph: &'a Graph,
    signals: &'a Signals,
    own: &'a Positions,
    seen: BTreeSet<(usize, usize)>,
    guards: Vec<Guard>,
}

impl Walk<'_> {
    /// Looks on from `track` over `joint`, away from the path.
    fn outward(&mut self, track: usize, joint: usize) {
        if !self.seen.insert((track, joint)) {
            return;
        }
        let at = &self.graph.joints[joint];
        let Some(next) = at.tracks.iter().copied().find(|next| *next != track) else {
            self.guards.push(if at.end == Some(EndKind::Buffer) { Guard::Buffer } else { Guard::Line });
            return;
        };
        let circuit = self.graph.tracks[next].circuit;
        if circuit != self.graph.tracks[track].circuit {
            let signal = self.signals.iter().find(|(start, rear, _)| *start == joint && *rear == circuit);
            if let Some((_, _, name)) = signal {
                self.guards.push(Guard::Signal(name.clone()));
                return;
            }
        }
        let Kind::Point(point) = self.graph.tracks[next].kind else {
            self.on(next, joint);
            return;
        };
        let [toe, normal, _] = self.graph.tracks[next].joints[..] else { return };
        if joint == toe {
            self.on(next, joint);
            return;
        }
        let away = if joint == normal { Position::Reverse } else { Position::Normal };
        match self.own.get(&point) {
            // The path runs over it: either it leads away from here, or the path itself comes from here.
            Some(_) => self.guards.push(Guard::Own),
            None => self.guards.push(Guard::Point(point, away)),
        }
    }

    fn on(&mut self, track: usize, from: usize) {
        for (joint, _) in self.graph.moves(track, from) {
            self.outward(track, joint);
        }
    }
}
