//! Vehicles that come onto a path from aside, or against it.

use std::collections::BTreeSet;

use atc_kernel::interlocking::{Route, SegmentSet, Size};

use super::routes::Way;
use super::sides::{Sides, members};
use super::tracks::{Stand, Tracks, Vehicle};
use crate::form::Position;
use crate::problem::Problem;

/// What a search for vehicles looks at.
struct Path<'a> {
    way: &'a Way,
    circuits: BTreeSet<usize>,
    stand: Stand,
    /// Where signals stand: the joint, and the circuit in rear of it.
    signals: &'a BTreeSet<(usize, usize)>,
}

impl Path<'_> {
    /// Whether the train of the path runs over the stretch of a vehicle.
    fn runs_over(&self, vehicle: Vehicle) -> bool {
        self.way.run.iter().any(|train| train.piece == vehicle.piece)
    }

    /// Whether it runs over a track. A point is one, whichever leg the train uses.
    fn lies_on(&self, track: usize, tracks: &Tracks) -> bool {
        self.way.run.iter().any(|train| tracks.piece(*train).track == track)
    }
}

impl<const R: usize, const P: usize, const N: usize, const S: usize, Z: Size> Sides<'_, R, P, N, S, Z> {
    pub(super) fn flanks(&self, ways: &[Option<Way>], found: &mut Vec<Problem>) {
        let signals: BTreeSet<(usize, usize)> = ways
            .iter()
            .enumerate()
            .filter_map(|(route, way)| Some((way.as_ref()?.start, members(self.plan.routes[route].entry).next()?)))
            .collect();
        for (number, way) in ways.iter().enumerate() {
            let (Some(way), Some(circuits)) = (way, self.path(number)) else { continue };
            let path =
                Path { way, circuits: circuits.into_iter().collect(), stand: self.held(number), signals: &signals };
            // Onto plain line goes whoever has its direction: that is no matter of signals.
            let out = self.plan.routes[number].to != SegmentSet::EMPTY;
            for vehicle in self.intruders(&path, out) {
                // Beside the way, over a point that is held away, it is in nobody's way.
                if !self.tracks.onward(vehicle).any(|next| self.meets(&path, next, &mut BTreeSet::new())) {
                    continue;
                }
                let against = self.tracks.ahead(vehicle) == way.exit;
                if !against && self.stands(&path, vehicle) {
                    let at = &self.tracks.joints[self.tracks.ahead(vehicle)];
                    let circuit = self.circuit(self.tracks.piece(vehicle).circuit);
                    let what = format!("what is parked in {circuit} runs onto its path at {at}, and faces no signal");
                    found.push(self.differs(number, &what));
                }
                let comes = self.comes_from(&path, vehicle, &mut BTreeSet::new());
                // A line without a way in has no direction towards the station: whoever comes against the route comes by a route.
                if let Some(joint) = comes.filter(|joint| !against || self.has_way_in(*joint)) {
                    let (onto, from) =
                        (self.tracks.joints[self.tracks.ahead(vehicle)].as_str(), &self.tracks.joints[joint]);
                    let what = format!(
                        "a vehicle that comes in at {from} runs onto its path at {onto}, and nothing keeps it off"
                    );
                    found.push(self.differs(number, &what));
                }
            }
        }
    }

    /// Whether a route leads in from the line at a joint.
    fn has_way_in(&self, joint: usize) -> bool {
        let here = |circuit: usize| self.tracks.at_joint(circuit, joint, true).next().is_some();
        self.plan.segments.iter().enumerate().any(|(number, segment)| {
            let from = |route: &Route<P, Z>| route.from.meets(SegmentSet::nth(number));
            members(segment.all()).any(here) && self.plan.routes.iter().any(from)
        })
    }

    /// The vehicles outside the path that run onto it with their next step, but for those that the file gives a reason for.
    fn intruders(&self, path: &Path<'_>, out: bool) -> Vec<Vehicle> {
        let mut all = Vec::new();
        for piece in 0..self.tracks.pieces.len() {
            for toward in [0, 1] {
                let vehicle = Vehicle { piece, toward };
                let outside = !path.circuits.contains(&self.tracks.piece(vehicle).circuit);
                let at_end = out && self.tracks.ahead(vehicle) == path.way.exit;
                let onto = self
                    .tracks
                    .onward(vehicle)
                    .filter(|next| path.circuits.contains(&self.tracks.piece(*next).circuit));
                let dangerous = onto.into_iter().any(|next| !self.is_declared(path, next, &mut BTreeSet::new()));
                if outside && !at_end && dangerous {
                    all.push(vehicle);
                }
            }
        }
        all
    }

    /// Whether a vehicle that is parked there faces no signal, and no point leads it away.
    fn stands(&self, path: &Path<'_>, vehicle: Vehicle) -> bool {
        let circuit = self.tracks.piece(vehicle).circuit;
        !path.signals.contains(&(self.tracks.ahead(vehicle), circuit)) && !self.tracks.diverts(vehicle, &path.stand)
    }

    /// Whether a vehicle that runs in a circuit of the path comes onto the way of the train, or onto a track that crosses it.
    fn meets(&self, path: &Path<'_>, vehicle: Vehicle, seen: &mut BTreeSet<Vehicle>) -> bool {
        let piece = self.tracks.piece(vehicle);
        if !path.circuits.contains(&piece.circuit) || self.tracks.diverts(vehicle, &path.stand) || !seen.insert(vehicle)
        {
            return false;
        }
        path.lies_on(piece.track, &self.tracks)
            || self.crosses(path, vehicle)
            || self.tracks.onward(vehicle).any(|next| self.meets(path, next, seen))
    }

    /// Whether the track of a vehicle in a circuit of the path lies across the way: it is plain, or is not joined to the way within the circuit.
    fn crosses(&self, path: &Path<'_>, vehicle: Vehicle) -> bool {
        let piece = self.tracks.piece(vehicle);
        let within = |number: usize| self.tracks.pieces[number].circuit == piece.circuit;
        let mut joined: BTreeSet<usize> =
            path.way.run.iter().map(|train| train.piece).filter(|it| within(*it)).collect();
        loop {
            let meets = |number: &usize| {
                joined.iter().any(|other| {
                    let other = self.tracks.pieces[*other];
                    self.tracks.pieces[*number].ends.iter().any(|joint| other.ends.contains(joint))
                })
            };
            let more: Vec<usize> = (0..self.tracks.pieces.len())
                .filter(|number| within(*number) && !joined.contains(number))
                .filter(meets)
                .collect();
            if more.is_empty() {
                break;
            }
            joined.extend(more);
        }
        !path.runs_over(vehicle) && (piece.over.is_none() || !joined.contains(&vehicle.piece))
    }

    /// Whether the file gives a reason for the end of a plain track over which a vehicle has come onto it.
    fn is_reasoned(&self, vehicle: Vehicle) -> bool {
        let joint = &self.tracks.joints[self.tracks.behind(vehicle)];
        let circuit = &self.station.circuits[self.tracks.piece(vehicle).circuit];
        let crossing = circuit.crossings.iter().map(|track| {
            [(&track.left.value, &track.left_unprotected), (&track.right.value, &track.right_unprotected)]
        });
        let ends = circuit.left.iter().map(|at| (&at.value, &circuit.left_unprotected));
        let ends = ends.chain(circuit.right.iter().map(|at| (&at.value, &circuit.right_unprotected)));
        ends.chain(crossing.flatten()).any(|(at, reason)| at == joint && reason.is_some())
    }

    /// Whether all that a vehicle in a circuit of the path can do is to come to the way over a leg that the file gives a reason for.
    fn is_declared(&self, path: &Path<'_>, vehicle: Vehicle, seen: &mut BTreeSet<Vehicle>) -> bool {
        let piece = self.tracks.piece(vehicle);
        let passed = |point: usize| {
            path.way.run.iter().filter_map(|train| self.tracks.piece(*train).over).find(|(other, _)| *other == point)
        };
        let over = piece.over.and_then(|(point, position)| Some((point, position, passed(point)?.1)));
        if let Some((point, position, needs)) = over {
            let given = &self.station.points[point];
            let reason =
                if position == Position::Normal { &given.normal_unprotected } else { &given.reverse_unprotected };
            return vehicle.toward == 0 && needs != position && reason.is_some();
        }
        if piece.over.is_none() && !path.runs_over(vehicle) && self.is_reasoned(vehicle) {
            return true;
        }
        if !path.circuits.contains(&piece.circuit) || !seen.insert(vehicle) {
            return false;
        }
        // Onto a point across the way it has come over an end of it.
        if let Some((point, position)) = piece.over.filter(|_| self.crosses(path, vehicle)) {
            let given = &self.station.points[point];
            let reason = match (vehicle.toward, position) {
                (1, _) => &given.toe_unprotected,
                (_, Position::Normal) => &given.normal_unprotected,
                (_, Position::Reverse) => &given.reverse_unprotected,
            };
            if reason.is_some() {
                return true;
            }
        }
        let mut onward = self.tracks.onward(vehicle).peekable();
        onward.peek().is_some() && onward.all(|next| self.is_declared(path, next, seen))
    }

    /// The joint at which a vehicle comes in that can get to here, past no signal and over no point that keeps it off.
    fn comes_from(&self, path: &Path<'_>, vehicle: Vehicle, seen: &mut BTreeSet<Vehicle>) -> Option<usize> {
        let circuit = self.tracks.piece(vehicle).circuit;
        let stopped = path.signals.contains(&(self.tracks.ahead(vehicle), circuit));
        // What runs on the way is the train itself; who passes beside it, in a circuit of the path, may come back to it.
        if stopped
            || path.lies_on(self.tracks.piece(vehicle).track, &self.tracks)
            || self.tracks.diverts(vehicle, &path.stand)
            || !seen.insert(vehicle)
        {
            return None;
        }
        let behind = self.tracks.behind(vehicle);
        if self.tracks.is_line(behind) {
            return Some(behind);
        }
        self.tracks.before(vehicle).find_map(|before| self.comes_from(path, before, seen))
    }
}
