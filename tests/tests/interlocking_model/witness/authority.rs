//! What trains are told: the grants of routes and plain line, linked up to the stop circuit.

use atc_kernel::interlocking::Travel;
use atc_tests::sketch::{Need, Sketch, Way};

use super::{Leave, Place, Set, Stage, Telegram, Witness};

/// How many routes or segments a train learns ahead.
const LINKS: usize = 4;

impl Witness {
    pub(super) fn telegrams(&self, sketch: &Sketch, occupied: &Set, proceed: &Set, firm: &[Need]) -> Vec<Telegram> {
        let mut leaves = Vec::new();
        for route in 0..self.routes.len() {
            leaves.extend(self.by_route(sketch, route, occupied, proceed, firm));
        }
        for segment in 0..self.stretches.len() {
            leaves.extend(self.by_line(sketch, segment, occupied));
        }
        // What gives nothing is of use only where it leads on to the line.
        leaves.retain(|leave| !leave.circuits.is_empty() || leave.whole && leave.out.is_some());
        (0..64)
            .map(|circuit| {
                let stop = Telegram { stop: circuit, leftward: None, speed: 0, hold: Set::new() };
                if occupied.contains(&circuit) {
                    self.linked(sketch, circuit, occupied, &leaves).unwrap_or(stop)
                } else {
                    stop
                }
            })
            .collect()
    }

    /// A route with proceed is given to the train at its entry; one in use to the train on its last occupied circuit, if it has been
    /// entered in order as far as there and the points under it are right, as far as points are right and nothing is blocked.
    fn by_route(&self, sketch: &Sketch, route: usize, occupied: &Set, proceed: &Set, firm: &[Need]) -> Option<Leave> {
        let (held, way) = (&self.routes[route], &sketch.routes[route]);
        if proceed.contains(&route) {
            let (circuits, speed, leftward) = (way.circuits(), way.speed, way.leftward);
            return Some(Leave { train: way.entry, circuits, whole: true, speed, leftward, out: way.to, behind: None });
        }
        if !matches!(held.stage, Stage::InUse(_)) {
            return None;
        }
        let kept: Vec<_> = held.kept(way).collect();
        let front = kept.iter().rposition(|(circuit, _)| occupied.contains(circuit))?;
        let entered = held.places[way.path.len() - kept.len() + front] == Place::Entered;
        let right = |needs: &[Need]| needs.iter().all(|need| firm.contains(need));
        if !entered || !right(&kept[front].1) {
            return None;
        }
        let ahead = &kept[front + 1..];
        let sound = ahead.iter().take_while(|(circuit, needs)| !self.blocked.contains(circuit) && right(needs));
        let circuits: Vec<_> = sound.map(|(circuit, _)| *circuit).collect();
        let whole = circuits.len() == ahead.len();
        let (train, speed, leftward) = (kept[front].0, way.speed, way.leftward);
        Some(Leave { train, whole, circuits, speed, leftward, out: way.to, behind: None })
    }

    /// On plain line every train is given the free circuits ahead of it; outwards also one that a route to the line lets into the throat.
    fn by_line(&self, sketch: &Sketch, segment: usize, occupied: &Set) -> Vec<Leave> {
        let line = &sketch.segments[segment];
        let order: Vec<usize> = match self.stretches[segment].travel {
            None => return Vec::new(),
            Some(Travel::Away) if !self.sends.contains(&segment) => return Vec::new(),
            Some(Travel::Toward) => line.circuits.iter().rev().copied().collect(),
            Some(Travel::Away) => line.throat.iter().chain(&line.circuits).copied().collect(),
        };
        let mut leaves = Vec::new();
        for (place, train) in order.iter().enumerate() {
            let ahead = &order[place + 1..];
            let free = ahead.iter().take_while(|it| !occupied.contains(it) && !self.blocked.contains(it));
            let circuits: Vec<_> = free.copied().collect();
            let leftward = line.leftward == (self.stretches[segment].travel == Some(Travel::Away));
            let whole = circuits.len() == ahead.len();
            let behind = (line.throat == Some(*train)).then_some(segment);
            leaves.push(Leave { train: *train, whole, circuits, speed: 7, leftward, out: None, behind });
        }
        leaves
    }

    /// The telegram of a train in `circuit`, if it may leave it.
    fn linked(&self, sketch: &Sketch, circuit: usize, occupied: &Set, leaves: &[Leave]) -> Option<Telegram> {
        let (mut here, mut speed, mut granted, mut leftward) = (circuit, 7, Vec::new(), None);
        // The line that begins at the end of the route that the train is on.
        let mut out = None;
        for _ in 0..LINKS {
            let mut mine = leaves.iter().filter(|leave| leave.train == here && leave.behind == out);
            // What might be meant for two is for nobody.
            let (Some(leave), None) = (mine.next(), mine.next()) else { break };
            // What is for a train that faces the other way is not for this one.
            if leftward.is_some_and(|leftward| leftward != leave.leftward) {
                break;
            }
            leftward = Some(leave.leftward);
            granted.extend(&leave.circuits);
            speed = speed.min(leave.speed);
            here = leave.circuits.last().copied().unwrap_or(here);
            out = leave.out;
            if !leave.whole {
                break;
            }
        }
        let hold: Set = granted.into_iter().collect();
        if hold.is_empty() {
            return None;
        }
        let train = self.train(sketch, circuit, occupied);
        let limit = hold.iter().chain(&train).map(|it| self.limit(sketch, *it)).min().unwrap_or(0);
        let distance: u32 = hold.iter().map(|it| u32::from(sketch.lengths[*it])).sum();
        let stops = sketch.braking.iter().rposition(|it| *it != u16::MAX && u32::from(*it) <= distance).unwrap_or(0);
        let speed = speed.min(limit).min(u8::try_from(stops).unwrap_or(0));
        Some(Telegram { stop: here, leftward, speed, hold })
    }

    /// The limit of a circuit: that of staff, and that of the route that holds it or, if none does, the lowest of all routes and overlaps over it.
    fn limit(&self, sketch: &Sketch, circuit: usize) -> u8 {
        let routes = || self.routes.iter().zip(&sketch.routes);
        let holding = routes().filter(|(held, way)| held.path(way).contains(&circuit)).map(|(_, way)| way.speed).min();
        let over = sketch.routes.iter().filter(|way| way.circuits().contains(&circuit)).map(|way| way.speed).min();
        let slid = |way: &&Way| way.overlap.0.contains(&circuit);
        let over = over.into_iter().chain(sketch.routes.iter().filter(slid).map(|way| way.overlap_speed)).min();
        let shared = routes().filter(|(held, way)| way.calling_on && held.overlap(way).contains(&circuit));
        let shared = shared.map(|(_, way)| way.speed).min();
        holding.or(over).into_iter().chain(shared).chain([self.limits[circuit]]).min().unwrap_or(7)
    }

    /// Where the train may stand whose front is in a circuit: on all that it may reach from there over what trains stand on together.
    fn train(&self, sketch: &Sketch, front: usize, occupied: &Set) -> Set {
        let mut together: Vec<Set> = Vec::new();
        let mut known = Set::new();
        for (held, way) in self.routes.iter().zip(&sketch.routes) {
            let path = held.path(way);
            known.extend(&path);
            let mut body: Set = path.iter().filter(|it| occupied.contains(it)).copied().collect();
            let whole = held.places.iter().all(|place| *place != Place::Released);
            if whole && !body.is_empty() && occupied.contains(&way.entry) {
                body.insert(way.entry);
            }
            if path.last().is_some_and(|last| occupied.contains(last)) {
                body.extend(held.overlap(way).iter().filter(|it| occupied.contains(it)));
            }
            together.push(body);
        }
        for line in &sketch.segments {
            known.extend(&line.circuits);
            let order: Vec<_> = line.throat.iter().chain(&line.circuits).copied().collect();
            let runs = order.split(|it| !occupied.contains(it)).map(|run| run.iter().copied().collect());
            together.extend(runs);
        }
        let mut train = Set::from([front]);
        for longest in [false, false, false, false, false, true] {
            let mut more = train.clone();
            more.extend(together.iter().filter(|part| !part.is_disjoint(&train)).flatten());
            if longest && more != train || train.iter().any(|it| occupied.contains(it) && !known.contains(it)) {
                return occupied.clone();
            }
            train = more;
        }
        train
    }
}
