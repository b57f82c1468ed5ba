//! Every reason to refuse a request.

use atc_kernel::interlocking::{Refusal, Travel};
use atc_tests::sketch::{Need, Sketch};

use super::{Ask, Set, Stage, Witness, common, meets, oppose};

impl Witness {
    pub(super) fn refuse(
        &self,
        sketch: &Sketch,
        ask: Ask,
        occupied: &Set,
        seen: &[Need],
        consent: &Set,
    ) -> Vec<Refusal> {
        if self.age < sketch.start && !matches!(ask, Ask::Withdraw(_)) {
            return vec![Refusal::Starting];
        }
        let known = match ask {
            Ask::Set(route) | Ask::Withdraw(route) => route < self.routes.len(),
            Ask::Drive(point, _) => point < sketch.points.len(),
            Ask::Turn(segment, _) => segment < self.stretches.len(),
        };
        if !known {
            return vec![Refusal::Unknown];
        }
        match ask {
            Ask::Set(route) => self.refuse_set(sketch, route, occupied, seen),
            Ask::Withdraw(route) => listed(&[(!self.routes[route].is_held(), Refusal::NotHeld)]),
            Ask::Drive(point, _) => self.refuse_drive(sketch, point, occupied),
            Ask::Turn(segment, travel) => self.refuse_turn(sketch, segment, travel, occupied, consent),
        }
    }

    fn refuse_set(&self, sketch: &Sketch, asked: usize, occupied: &Set, seen: &[Need]) -> Vec<Refusal> {
        let way = &sketch.routes[asked];
        let mine = &self.routes[asked];
        if mine.may_go_on() {
            let closed = way.to.is_some_and(|segment| self.closed(sketch, segment));
            let berth = way.calling_on && meets(mine.overlap(way), &self.blocked);
            return listed(&[(closed || berth || meets(&mine.path(way), &self.blocked), Refusal::Blocked)]);
        }
        if mine.is_held() {
            return vec![Refusal::AlreadyHeld];
        }
        let (path, overlap, needs) = (way.circuits(), &way.overlap.0, way.needs());
        let mut reasons = Vec::new();
        for (number, (held, other)) in self.routes.iter().zip(&sketch.routes).enumerate().filter(|it| it.1.0.is_held())
        {
            let (its_path, its_overlap) = (held.path(other), held.overlap(other));
            let i_continue = other.continuing.contains(&asked);
            // In a berth one may stand whose own route has nothing left but that circuit.
            let it_stands = way.calling_on && !held.overlap && its_path == [other.last()];
            let it_continues = way.continuing.contains(&number) || it_stands;
            reasons.extend(listed(&[
                (way.conflicts.contains(&number), Refusal::Conflict),
                (common(&path, &its_path) || common(&path, its_overlap) && !i_continue, Refusal::PathHeld),
                (common(overlap, its_overlap) || common(overlap, &its_path) && !it_continues, Refusal::OverlapHeld),
                (oppose(&needs, &held.needs(other)), Refusal::PointLocked),
            ]));
        }
        let has = |segment: Option<usize>, travel| segment.is_none_or(|it| self.stretches[it].travel == Some(travel));
        let stuck = |need: &Need| !seen.contains(need) && meets(&sketch.points[need.0], occupied);
        let shut = |need: &Need| !seen.contains(need) && meets(&sketch.points[need.0], &self.blocked);
        reasons.extend(listed(&[
            (meets(&path, occupied) || meets(overlap, occupied) && !way.calling_on, Refusal::Occupied),
            (way.calling_on && !meets(overlap, occupied), Refusal::NotCalledFor),
            (way.calling_on && !occupied.contains(&way.entry), Refusal::NotCalledFor),
            (self.unswept.is_in_the_way(sketch, asked, occupied), Refusal::Unswept),
            (needs.iter().any(|need| !seen.contains(need) && self.unswept.needs(need.0)), Refusal::Unswept),
            (meets(&path, &self.blocked) || meets(overlap, &self.blocked), Refusal::Blocked),
            (self.is_cut_off(way, occupied), Refusal::Blocked),
            (way.to.is_some_and(|segment| self.closed(sketch, segment)), Refusal::Blocked),
            (needs.iter().any(shut), Refusal::Blocked),
            (!has(way.from, Travel::Toward) || !has(way.to, Travel::Away), Refusal::Direction),
            (way.to.is_some_and(|segment| !self.sends.contains(&segment)), Refusal::Direction),
            (needs.iter().any(stuck), Refusal::PointUnderTrain),
        ]));
        reasons
    }

    fn refuse_drive(&self, sketch: &Sketch, point: usize, occupied: &Set) -> Vec<Refusal> {
        let detectors = &sketch.points[point];
        let routes = || self.routes.iter().zip(&sketch.routes);
        let locked = routes().any(|(held, way)| held.needs(way).iter().any(|need| need.0 == point));
        let held = routes().any(|(held, way)| common(detectors, &held.circuits(way)));
        listed(&[
            (locked, Refusal::PointLocked),
            (held, Refusal::PathHeld),
            (meets(detectors, occupied), Refusal::PointUnderTrain),
            (self.unswept.needs(point), Refusal::Unswept),
            (meets(detectors, &self.blocked), Refusal::Blocked),
        ])
    }

    fn refuse_turn(
        &self,
        sketch: &Sketch,
        segment: usize,
        travel: Travel,
        occupied: &Set,
        consent: &Set,
    ) -> Vec<Refusal> {
        let stretch = self.stretches[segment];
        if travel == Travel::Away && stretch.travel == Some(Travel::Away) {
            return Vec::new();
        }
        let needs_other = self.routes.iter().zip(&sketch.routes).any(|(held, way)| match travel {
            Travel::Toward => way.to == Some(segment) && held.is_held(),
            Travel::Away => way.from == Some(segment) && held.is_held() && held.places[0] != super::Place::Released,
        });
        let line = &sketch.segments[segment];
        let taken = meets(&line.circuits, occupied) || line.throat.is_some_and(|throat| occupied.contains(&throat));
        // A train on the line that the neighbour sent is let in, as every train is where this station sends none; of any other nobody knows where it goes.
        let one_way = stretch.travel.is_none() && sketch.routes.iter().all(|way| way.to != Some(segment));
        let loses = travel == Travel::Away || !(stretch.came || one_way);
        let no_way_in = travel == Travel::Toward && sketch.routes.iter().all(|way| way.from != Some(segment));
        let needs_other = needs_other || travel == Travel::Toward && self.unswept.goes_out_to(sketch, segment);
        let in_the_way = needs_other || taken && loses || no_way_in;
        let early = stretch.withdrawn < sketch.turn || stretch.travel == Some(Travel::Toward);
        let blocked = self.closed(sketch, segment);
        match travel {
            Travel::Toward => listed(&[(in_the_way, Refusal::Direction), (blocked, Refusal::Blocked)]),
            Travel::Away if in_the_way => vec![Refusal::Direction],
            Travel::Away => listed(&[(early || blocked || !consent.contains(&segment), Refusal::Waiting)]),
        }
    }

    /// How many routes are past their reservation, for those who count what a session reaches.
    pub fn locked(&self) -> usize {
        self.routes.iter().filter(|held| !matches!(held.stage, Stage::Idle | Stage::Provisional(_))).count()
    }
}

/// The reasons that apply.
fn listed(reasons: &[(bool, Refusal)]) -> Vec<Refusal> {
    reasons.iter().filter(|reason| reason.0).map(|reason| reason.1).collect()
}
