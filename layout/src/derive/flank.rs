//! Flank protection: what keeps vehicles off the legs that a path does not use.

use std::collections::BTreeSet;

use crate::form::{EndKind, Position};
use crate::graph::{Graph, Kind, Passed};
use crate::model::{Circuits, Guard, Positions};

/// Where the routes of a station start: the joint, the circuit in rear of it, and the signal there.
pub type Signals = Vec<(usize, usize, String)>;

/// A path: the points that it runs over, and its circuits.
pub struct Path {
    /// The points.
    pub points: Positions,
    /// The circuits.
    pub circuits: Circuits,
}

/// What is on the tracks that lead to an end of `track`, seen from `path`.
pub fn guards(graph: &Graph, signals: &Signals, path: &Path, track: usize, end: usize) -> Vec<Guard> {
    if let Some(reason) = graph.tracks[track].unprotected.get(end).and_then(Option::as_ref) {
        return vec![Guard::Declared(reason.clone())];
    }
    let mut walk = Walk { graph, signals, path, seen: BTreeSet::new(), guards: Vec::new() };
    walk.outward(track, graph.tracks[track].joints[end]);
    walk.guards
}

/// The ends of the tracks of a circuit from which a vehicle may come onto a path that runs over `run` there: the unused legs of its
/// points, and the ends of the tracks that cross it.
pub fn beside(graph: &Graph, circuit: usize, run: &[usize], passed: &[Passed]) -> Vec<(usize, usize)> {
    let legs = passed.iter().filter_map(|passed| {
        let track = graph.of_point(passed.point)?;
        Some((track, graph.tracks[track].joints.iter().position(|joint| *joint == passed.other_leg)?))
    });
    // A point that is joined to the path within the circuit leads to it or beside it; one that is not lies in a track across it.
    let joined = joined(graph, circuit, run);
    let crossing = (0..graph.tracks.len()).filter(|number| {
        let track = &graph.tracks[*number];
        let other = track.circuit == circuit && !run.contains(number);
        other && (track.kind == Kind::Plain || !joined.contains(number))
    });
    let ends = crossing.flat_map(|track| (0..graph.tracks[track].joints.len()).map(move |end| (track, end)));
    legs.chain(ends.filter(|(track, end)| !continues_a_leg(graph, run, *track, *end))).collect()
}

/// The tracks of a circuit that hang together, within it, with those of `run`.
fn joined(graph: &Graph, circuit: usize, run: &[usize]) -> BTreeSet<usize> {
    let mut found: BTreeSet<usize> = run.iter().copied().collect();
    let mut last = 0;
    while found.len() != last {
        last = found.len();
        let joints: BTreeSet<usize> = found.iter().flat_map(|track| &graph.tracks[*track].joints).copied().collect();
        let next = joints.iter().flat_map(|joint| &graph.joints[*joint].tracks);
        let within: Vec<usize> = next.copied().filter(|track| graph.tracks[*track].circuit == circuit).collect();
        found.extend(within);
    }
    found
}

/// Whether all that comes to the other end of `track` is the unused leg of a point that the path runs over: who comes in at `end` is asked
/// for there.
fn continues_a_leg(graph: &Graph, run: &[usize], track: usize, end: usize) -> bool {
    let [left, right] = graph.tracks[track].joints[..] else { return false };
    let (mut at, mut joint) = (track, if end == 0 { right } else { left });
    let mut seen = BTreeSet::from([track]);
    loop {
        let Some(next) = graph.joints[joint].tracks.iter().copied().find(|next| *next != at) else { return false };
        let within = graph.tracks[next].circuit == graph.tracks[track].circuit;
        if !within || graph.tracks[next].kind != Kind::Plain {
            return within && run.contains(&next) && graph.tracks[next].joints[0] != joint;
        }
        if !seen.insert(next) {
            return false;
        }
        let [one, other] = graph.tracks[next].joints[..] else { return false };
        (at, joint) = (next, if one == joint { other } else { one });
    }
}

struct Walk<'a> {
    graph: &'a Graph,
    signals: &'a Signals,
    path: &'a Path,
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
            let guard =
                if at.end == Some(EndKind::Buffer) { self.or_standing(track, Guard::Buffer) } else { Guard::Line };
            self.guards.push(guard);
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
        let [toe, normal, reverse] = self.graph.tracks[next].joints[..] else { return };
        if joint == toe {
            self.on(next, joint);
            return;
        }
        let (away, leg) = if joint == normal { (Position::Reverse, reverse) } else { (Position::Normal, normal) };
        if self.path.points.contains_key(&point) {
            // The path runs over it: either it leads away from here, or the path itself comes from here.
            let guard = self.or_standing(track, Guard::Own);
            self.guards.push(guard);
        } else if self.leads_onto_the_path(next, leg, &mut BTreeSet::new()) {
            // Over a scissors crossover both positions lead under the train: what keeps vehicles off is farther away.
            self.on(next, joint);
        } else {
            let guard = self.or_standing(track, Guard::Point(point, away));
            self.guards.push(guard);
        }
    }

    /// What keeps off where the way outward ends behind `track`: no signal was met, so whatever stands there may come.
    fn or_standing(&self, track: usize, guard: Guard) -> Guard {
        let circuit = self.graph.tracks[track].circuit;
        if self.path.circuits.contains(&circuit) { guard } else { Guard::Standing(circuit) }
    }

    /// Whether a vehicle that leaves `track` over `joint` comes onto a circuit of the path, over a crossing, before a signal stops it.
    fn leads_onto_the_path(&self, track: usize, joint: usize, seen: &mut BTreeSet<(usize, usize)>) -> bool {
        if !seen.insert((track, joint)) {
            return false;
        }
        let Some(next) = self.graph.joints[joint].tracks.iter().copied().find(|next| *next != track) else {
            return false;
        };
        let (here, there) = (self.graph.tracks[track].circuit, self.graph.tracks[next].circuit);
        let stopped = here != there && self.signals.iter().any(|(start, rear, _)| *start == joint && *rear == here);
        // A point that the path runs over has its own protection.
        let is_own =
            matches!(self.graph.tracks[next].kind, Kind::Point(point) if self.path.points.contains_key(&point));
        if stopped || is_own {
            return false;
        }
        self.path.circuits.contains(&there)
            || self.graph.moves(next, joint).iter().any(|(exit, _)| self.leads_onto_the_path(next, *exit, seen))
    }

    fn on(&mut self, track: usize, from: usize) {
        for (joint, _) in self.graph.moves(track, from) {
            self.outward(track, joint);
        }
    }
}
