//! The train of a route: what it runs over, where it slides, and what comes after.

use std::collections::BTreeSet;

use atc_kernel::interlocking::{CircuitSet, Heading, RouteSet, SegmentSet, Size};

use super::sides::{Sides, members, stand};
use super::tracks::{Stand, Vehicle};
use crate::problem::Problem;

/// A way of a route's train.
#[derive(Clone, Debug)]
pub struct Way {
    /// The train at each stretch of it, in order of travel.
    pub run: Vec<Vehicle>,
    /// The joint at which it begins.
    pub start: usize,
    /// The joint at which it ends.
    pub exit: usize,
}

impl<const R: usize, const P: usize, const N: usize, const S: usize, Z: Size> Sides<'_, R, P, N, S, Z> {
    /// The circuits of a path, in order of travel; none if a place has not exactly one.
    pub(super) fn path(&self, route: usize) -> Option<Vec<usize>> {
        let route = &self.plan.routes[route];
        let circuit = |place: &atc_kernel::interlocking::Element<Z>| {
            let mut all = members(place.circuits);
            all.next().filter(|_| all.next().is_none())
        };
        route.path.iter().take(route.length.into()).map(circuit).collect()
    }

    /// Where the points stand for a route while it is held as a whole.
    pub(super) fn held(&self, route: usize) -> Stand {
        stand(self.plan.routes[route].held_from(0).positions)
    }

    /// Holds a route against what its train meets; the way that it runs.
    pub(super) fn route(&self, number: usize, found: &mut Vec<Problem>) -> Option<Way> {
        let ways = self.ways(number);
        // Where more than one is possible, the plan must be right for one of them: the derivation asks that the file says which.
        let told: Vec<Vec<String>> = ways.iter().map(|way| self.of_way(number, way)).collect();
        let best = told.iter().position(Vec::is_empty).unwrap_or(0);
        match told.get(best) {
            None => found.push(self.differs(number, "no train runs over its path with the points as it holds them")),
            Some(told) => found.extend(told.iter().map(|what| self.differs(number, what))),
        }
        ways.into_iter().nth(best)
    }

    /// Every way from the entry over the circuits of the path, in order, over points that are held there.
    fn ways(&self, number: usize) -> Vec<Way> {
        let route = &self.plan.routes[number];
        let (Some(path), Some(entry)) = (self.path(number), members(route.entry).next()) else { return Vec::new() };
        let Some(first) = path.first() else { return Vec::new() };
        let mut ways = Vec::new();
        for start in 0..self.tracks.joints.len() {
            if self.tracks.at_joint(entry, start, true).next().is_some() {
                for train in self.tracks.at_joint(*first, start, false) {
                    self.run(number, &path, (0, train), &mut Vec::new(), start, &mut ways);
                }
            }
        }
        ways
    }

    fn run(
        &self,
        number: usize,
        path: &[usize],
        (place, train): (usize, Vehicle),
        run: &mut Vec<Vehicle>,
        start: usize,
        ways: &mut Vec<Way>,
    ) {
        let stands = stand(self.plan.routes[number].path[place].positions);
        let held = |(point, position)| stands.get(&point) == Some(&position);
        if !self.tracks.piece(train).over.is_none_or(held) || run.contains(&train) {
            return;
        }
        run.push(train);
        let exit = self.tracks.ahead(train);
        let mut leaves = place + 1 == path.len();
        for next in self.tracks.onward(train) {
            let circuit = self.tracks.piece(next).circuit;
            if circuit == path[place] {
                leaves = false;
                self.run(number, path, (place, next), run, start, ways);
            } else if path.get(place + 1) == Some(&circuit) {
                self.run(number, path, (place + 1, next), run, start, ways);
            }
        }
        if leaves {
            ways.push(Way { run: run.clone(), start, exit });
        }
        run.pop();
    }

    fn of_way(&self, number: usize, way: &Way) -> Vec<String> {
        let route = &self.plan.routes[number];
        let mut told = Vec::new();
        // Left and right are said of plain tracks.
        let against = |train: &&Vehicle| {
            let right = Heading::Right == route.heading;
            self.tracks.piece(**train).over.is_none() && (train.toward == 1) != right
        };
        if let Some(train) = way.run.iter().find(against) {
            let circuit = self.circuit(self.tracks.piece(*train).circuit);
            told.push(format!("its train runs through {circuit} to the other side than {:?}", route.heading));
        }
        let Some(last) = way.run.last() else { return told };
        let beyond: BTreeSet<usize> = self.tracks.onward(*last).map(|next| self.tracks.piece(next).circuit).collect();
        for circuit in &beyond {
            if !route.beyond.meets(CircuitSet::nth(*circuit)) {
                told.push(format!("its train comes to {}, which is not beyond its end", self.circuit(*circuit)));
            }
        }
        self.of_segments(number, &beyond, &mut told);
        let overlap: BTreeSet<usize> = members(route.overlap.circuits).collect();
        let mut stands = stand(route.overlap.positions);
        stands.extend(self.held(number));
        if !overlap.is_empty() && !self.slides(*last, &overlap, &stands, &mut BTreeSet::new()) {
            told.push(
                "a train that slides beyond its end does not run over its overlap with the points as it holds them"
                    .to_owned(),
            );
        }
        told
    }

    /// The segment that it comes from is that of its entry, and the one that it goes out to begins beyond its end.
    fn of_segments(&self, number: usize, beyond: &BTreeSet<usize>, told: &mut Vec<String>) {
        let route = &self.plan.routes[number];
        for (segment, it) in self.plan.segments.iter().enumerate().filter(|(_, segment)| segment.length > 0) {
            let name = &self.station.segments[segment].name;
            let first = members(it.circuits[0]).next();
            let (from, to) = (route.from.meets(SegmentSet::nth(segment)), route.to.meets(SegmentSet::nth(segment)));
            if from != (members(route.entry).next() == first) {
                told.push(format!(
                    "that it comes from segment {name} is said, and its entry is elsewhere; or not said"
                ));
            }
            if to != first.is_some_and(|first| beyond.contains(&first)) {
                told.push(format!("that it goes out to segment {name} is said, and its end is elsewhere; or not said"));
            }
        }
    }

    /// Whether a train that goes on runs over all circuits of the overlap, and over no point that does not stand for it.
    fn slides(&self, train: Vehicle, overlap: &BTreeSet<usize>, stands: &Stand, seen: &mut BTreeSet<usize>) -> bool {
        if overlap.is_subset(seen) {
            return true;
        }
        self.tracks.onward(train).any(|next| {
            let piece = self.tracks.piece(next);
            let right = piece.over.is_none_or(|(point, position)| stands.get(&point) == Some(&position));
            // Back into a circuit that it has left, it would run for ever.
            let again = seen.contains(&piece.circuit) && piece.circuit != self.tracks.piece(train).circuit;
            if !right || again || !overlap.contains(&piece.circuit) {
                return false;
            }
            let new = seen.insert(piece.circuit);
            let all = self.slides(next, overlap, stands, seen);
            if new && !all {
                seen.remove(&piece.circuit);
            }
            all
        })
    }

    /// A route that continues another one begins where that ends; and what the file says of two routes, or of two circuits, is kept.
    pub(super) fn ends(&self, ways: &[Option<Way>], found: &mut Vec<Problem>) {
        for (number, way) in ways.iter().enumerate() {
            self.excluded(number, found);
            let Some(way) = way else { continue };
            let route = &self.plan.routes[number];
            for (other, its) in ways.iter().enumerate() {
                let continues = route.continuing.meets(RouteSet::nth(other));
                if continues && its.as_ref().is_none_or(|its| its.start != way.exit) {
                    let what = format!("route {} goes on elsewhere than it ends", self.station.routes[other].name);
                    found.push(self.differs(number, &what));
                }
            }
        }
    }

    fn excluded(&self, number: usize, found: &mut Vec<Problem>) {
        let (given, route) = (&self.station.routes[number], &self.plan.routes[number]);
        for name in &given.conflicts {
            let other = self.station.routes.iter().position(|other| other.name.value == name.value);
            let Some(other) = other.filter(|other| *other < R) else { continue };
            let both = route.conflicts.meets(RouteSet::nth(other))
                && self.plan.routes[other].conflicts.meets(RouteSet::nth(number));
            if !both {
                found.push(
                    self.differs(number, &format!("the file excludes it and route {name}, and the plan does not")),
                );
            }
        }
        self.beside(number, found);
    }

    /// Of two circuits that foul each other a route over the one holds the other, or proves it clear, for as long.
    fn beside(&self, number: usize, found: &mut Vec<Problem>) {
        let (given, route) = (&self.station.routes[number], &self.plan.routes[number]);
        let Some(path) = self.path(number) else { return };
        let places = path.iter().zip(&route.path).map(|(circuit, place)| (CircuitSet::nth(*circuit), place.beside));
        let overlap = (route.overlap.circuits, route.overlap.beside);
        let own = path.iter().fold(route.entry.or(overlap.0), |own, circuit| own.or(CircuitSet::nth(*circuit)));
        let all: Vec<(CircuitSet<Z>, CircuitSet<Z>)> = places.chain([overlap]).collect();
        let set = |name: &str| self.place_of(name).map_or(CircuitSet::EMPTY, CircuitSet::nth);
        let mut pairs: Vec<(&str, &str)> = Vec::new();
        for fouling in &self.station.fouling {
            let [one, other] = &fouling.between;
            pairs.push((one, other));
        }
        for point in &self.station.points {
            let others = point.fouled_in.iter().chain(point.detectors.iter().flatten());
            pairs.extend(others.map(|other| (point.circuit.value.as_str(), other.value.as_str())));
        }
        for (one, other) in pairs.into_iter().flat_map(|(one, other)| [(one, other), (other, one)]) {
            let needed = set(other).without(own);
            if all.iter().any(|(over, beside)| over.meets(set(one)) && !beside.contains(needed)) {
                let what =
                    format!("{one} and {other} foul each other, and it holds {one} without proving {other} clear");
                found.push(self.differs(number, &what));
            }
        }
        for name in &given.proved_clear {
            if all[..path.len()].iter().any(|(_, beside)| !beside.contains(set(name))) {
                found.push(self.differs(number, &format!("the file has {name} proved clear, and the plan has not")));
            }
        }
    }
}
