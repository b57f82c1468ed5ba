//! A station under its device: trains that follow their signals (and some that do not), points that follow their drives (and some that do
//! not), requests of every kind, blocks and restrictions, false occupancy and losses of shunt at the limits of the filter.

use std::collections::{BTreeSet, VecDeque};

use serde_json::{Map, Value, json};

use super::source::Walk;
use super::station::{Route, Segment, Station};
use crate::conform::random::Random;

/// A station of so many routes is asked twice as often as a small one, and one of twice as many three times.
const MANY: u64 = 40;

/// By how much rarer than on a small plan something is taken back or disturbed on a layout.
const PACE: u64 = 20;

/// A train: the circuits that it stands on, its front first, and those that it may go on to.
struct Train {
    on: VecDeque<usize>,
    next: VecDeque<usize>,
    /// The berth that it was called on to: it goes there though another one stands in it.
    berth: Option<usize>,
    /// Cycles until it moves.
    left: i64,
}

/// A point in the field.
#[derive(Clone, Copy)]
struct Point {
    at: &'static str,
    /// The position that it is driven to, and the cycles until it has arrived.
    driven: Option<(&'static str, i64)>,
}

pub(super) struct Ground {
    station: Station,
    /// The circuits in which no train begins.
    closed: BTreeSet<usize>,
    trains: Vec<Train>,
    points: Vec<Point>,
    /// A circuit that is reported otherwise than it is, for so many cycles.
    disturbed: Option<(usize, i64)>,
    consent: Vec<bool>,
    /// What is asked for first, a cycle each, the last one first: each line has its direction before a train comes.
    agenda: Vec<Value>,
    /// What was asked last of it, on a layout: once more, if that was too early.
    asked: Option<Value>,
    begun: bool,
    /// How often a request is made: once in so many cycles.
    requests: u64,
    /// How often something goes wrong: once in so many times; 0 for never.
    wrong: u64,
    /// How long a train stays in a circuit.
    stay: i64,
    /// The most trains at a time.
    most: usize,
    /// By how much rarer than on a small plan something is taken back or disturbed: a layout's own times are hundreds of cycles.
    pace: u64,
}

/// The station of a configuration, and its trains.
pub(super) fn ground(config: &Value, random: &mut Random) -> Ground {
    let station = Station::of(config);
    let plan = config.get("plan").is_some();
    let points =
        station.points.iter().map(|_| Point { at: if random.one_in(3) { "reverse" } else { "normal" }, driven: None });
    let points = points.collect();
    let agenda = if random.one_in(2) { directions(config, &station, random) } else { Vec::new() };
    let stay = if plan { random.between(1, 4) } else { random.between(5, 40) };
    let (routes, pace) = (station.routes.len(), if plan { 1 } else { PACE });
    Ground {
        closed: BTreeSet::new(),
        trains: if agenda.is_empty() { standing(&station, stay, random) } else { Vec::new() },
        points,
        disturbed: None,
        consent: station.segments.iter().map(|_| !agenda.is_empty() || !random.one_in(4)).collect(),
        agenda,
        asked: None,
        begun: random.one_in(10),
        requests: if plan { 2 } else { (12 / (1 + routes as u64 / MANY)).max(2) },
        wrong: pace * random.one_of(&[0, 20, 8]).unsigned_abs(),
        stay,
        most: 3.max(routes / 12),
        pace,
        station,
    }
}

/// Requests for a direction of each line, once the time after the start is over.
fn directions(config: &Value, station: &Station, random: &mut Random) -> Vec<Value> {
    let turn =
        |segment: &Segment| json!({"turn": segment.name, "to": if random.one_in(2) { "toward" } else { "away" }});
    let mut agenda: Vec<Value> = station.segments.iter().map(turn).collect();
    if !agenda.is_empty() {
        let start = config["plan"]["start_cycles"].as_u64().and_then(|start| usize::try_from(start).ok()).unwrap_or(0);
        agenda.extend(std::iter::repeat_n(Value::Null, start + 1));
    }
    agenda
}

/// Trains that stand in the station before the device begins, each somewhere in a path or its overlap: in half of the walks there are some.
fn standing(station: &Station, stay: i64, random: &mut Random) -> Vec<Train> {
    let mut trains: Vec<Train> = Vec::new();
    for _ in 0..random.one_of(&[0, 0, 1, 2]) {
        let Some(route) = random.pick(&station.routes) else { continue };
        // It may have slid into the overlap.
        let way = [&route.path[..], &route.overlap[..]].concat();
        let place = random.below(way.len());
        let rear = place.checked_sub(1).map_or_else(|| route.entry.first(), |place| way.get(place));
        let mut on: VecDeque<usize> = way.get(place).copied().into_iter().collect();
        on.extend(rear.copied().filter(|_| random.one_in(3)));
        if on.iter().all(|circuit| !trains.iter().any(|train| train.on.contains(circuit))) {
            let next = way.iter().skip(place + 1).copied().filter(|_| random.one_in(2)).collect();
            trains.push(Train { on, next, berth: None, left: random.between(0, 3 * stay) });
        }
    }
    trains
}

fn word(side: &Value) -> &'static str {
    if side == "reverse" { "reverse" } else { "normal" }
}

/// For a walk of another machine.
impl Ground {
    /// By how much rarer than on a small plan something is disturbed.
    pub(super) const fn pace(&self) -> u64 {
        self.pace
    }

    /// The names of the circuits.
    pub(super) fn circuits(&self) -> &[String] {
        &self.station.circuits
    }

    /// The names of the lines.
    pub(super) fn lines(&self) -> Vec<String> {
        self.station.segments.iter().map(|segment| segment.name.clone()).collect()
    }

    /// No train begins in one of these.
    pub(super) fn close(&mut self, circuits: impl IntoIterator<Item = usize>) {
        self.closed.extend(circuits);
    }

    /// The circuits with the head of a train, and those with any of it.
    pub(super) fn whereabouts(&self) -> [BTreeSet<usize>; 2] {
        let heads = self.trains.iter().filter_map(|train| train.on.front());
        [heads.copied().collect(), self.trains.iter().flat_map(|train| &train.on).copied().collect()]
    }

    /// The device begins anew: staff unblock once more, but for once in a while.
    pub(super) fn restart(&mut self, random: &mut Random) {
        self.begun = random.one_in(10);
    }

    pub(super) fn goes_wrong(&self, random: &mut Random) -> bool {
        self.wrong > 0 && random.one_in(self.wrong)
    }

    fn is_free(&self, circuit: usize) -> bool {
        !self.trains.iter().any(|train| train.on.contains(&circuit))
    }

    fn move_points(&mut self, random: &mut Random, last: Option<&Value>) {
        for (number, name) in self.station.points.iter().enumerate() {
            let wrong = self.wrong > 0 && random.one_in(4 * self.wrong);
            let point = &mut self.points[number];
            if let Some(to) = last.and_then(|last| last["drives"].get(name)) {
                let to = word(to);
                if point.driven.is_none_or(|driven| driven.0 != to) && !wrong {
                    point.driven = Some((to, random.between(0, 3)));
                }
            }
            if let Some((to, left)) = &mut point.driven {
                *left -= 1;
                if *left < 0 {
                    *point = Point { at: to, driven: None };
                }
            }
        }
    }

    /// Where a train at this circuit may go: the path of a route that shows proceed, and the line or the berth behind it; and that berth.
    fn way(&self, from: usize, last: Option<&Value>, ignores: bool) -> (VecDeque<usize>, Option<usize>) {
        let shows = |name: &str| {
            ignores
                || last.is_some_and(|last| last["proceed"].as_array().into_iter().flatten().any(|route| route == name))
        };
        let route = self.station.routes.iter().find(|route| route.entry.contains(&from) && shows(&route.name));
        let Some(route) = route else { return (VecDeque::new(), None) };
        let line = route.to.map(|segment| self.station.segments[segment].circuits.clone()).unwrap_or_default();
        let berth = route.overlap.first().copied().filter(|_| route.calling_on);
        (route.path.iter().copied().chain(line).chain(berth).collect(), berth)
    }

    fn move_trains(&mut self, random: &mut Random, last: Option<&Value>) {
        let outermost: Vec<_> =
            self.station.segments.iter().filter_map(|segment| segment.circuits.last().copied()).collect();
        let mut gone = Vec::new();
        for number in 0..self.trains.len() {
            self.trains[number].left -= 1;
            if self.trains[number].left >= 0 {
                continue;
            }
            if self.trains[number].on.len() > 1 && !random.one_in(4) {
                self.trains[number].on.pop_back();
            } else if let Some(next) = self.trains[number].next.pop_front() {
                if self.is_free(next) || self.trains[number].berth == Some(next) {
                    self.trains[number].on.push_front(next);
                } else {
                    self.trains[number].next.push_front(next);
                }
            } else if let Some(front) = self.trains[number].on.front().copied() {
                let ignores = self.goes_wrong(random) && random.one_in(4);
                let (mut way, berth) = self.way(front, last, ignores);
                if way.is_empty() && random.one_in(12) {
                    // It slides on over the end of its route.
                    let ends = self.station.routes.iter().filter(|route| route.path.last() == Some(&front));
                    way.extend(ends.filter_map(|route| route.overlap.first()).copied().take(1));
                }
                // Where no signal is, nothing would fetch it on a layout for hundreds of cycles.
                let lost = self.pace > 1 && !self.station.routes.iter().any(|route| route.entry.contains(&front));
                let stays = if lost { 3 } else { 30 };
                if way.is_empty() && outermost.contains(&front) || way.is_empty() && random.one_in(stays) {
                    gone.push(number);
                }
                (self.trains[number].next, self.trains[number].berth) = (way, berth);
            }
            self.trains[number].left = random.between(0, self.stay);
        }
        for number in gone.into_iter().rev() {
            self.trains.remove(number);
        }
        if self.trains.len() < self.most && random.one_in(6) {
            self.enter(random);
        }
    }

    /// A new train: on the line, coming in, or in rear of a signal.
    fn enter(&mut self, random: &mut Random) {
        let way: Vec<usize> = if random.one_in(2) {
            let segment = random.pick(&self.station.segments);
            segment.map(|segment| segment.circuits.iter().rev().copied().collect()).unwrap_or_default()
        } else {
            let route = random.pick(&self.station.routes);
            route.map(|route| route.entry.iter().take(1).copied().collect()).unwrap_or_default()
        };
        if let Some((first, rest)) = way.split_first()
            && self.is_free(*first)
            && !self.closed.contains(first)
        {
            let next = rest.iter().copied().collect();
            let left = random.between(0, self.stay);
            self.trains.push(Train { on: VecDeque::from([*first]), next, berth: None, left });
        }
    }

    fn occupied(&mut self, random: &mut Random) -> Vec<&str> {
        if let Some((_, left)) = &mut self.disturbed {
            *left -= 1;
        }
        if self.disturbed.is_some_and(|(_, left)| left < 0) {
            self.disturbed = None;
        }
        if self.disturbed.is_none() && self.goes_wrong(random) && !self.station.circuits.is_empty() {
            // For a loss of shunt: up to what the filter takes, and one cycle more.
            self.disturbed = Some((random.below(self.station.circuits.len()), random.between(0, 3)));
        }
        let wrong = self.disturbed.map(|(circuit, _)| circuit);
        let all = self.station.circuits.iter().enumerate();
        let reported = all.filter(|(number, _)| self.is_free(*number) == (wrong == Some(*number)));
        reported.map(|(_, name)| name.as_str()).collect()
    }

    fn request(&self, random: &mut Random, last: Option<&Value>) -> Option<Value> {
        let route = |random: &mut Random| random.pick(&self.station.routes).map(|route| route.name.clone());
        let rarely = self.pace > 1 && !random.one_in(self.pace);
        match random.below(10) {
            kind if kind <= 4 || rarely => {
                let stands = |all: &[usize]| all.iter().any(|at| !self.is_free(*at));
                let called = |route: &&Route| route.calling_on && stands(&route.entry) && stands(&route.overlap);
                let called: Vec<_> = self.station.routes.iter().filter(called).collect();
                if let Some(called) = random.pick(&called).filter(|_| random.one_in(8)) {
                    return Some(json!({"set": called.name}));
                }
                // Rather one that a train waits for.
                let waits: Vec<_> = self
                    .station
                    .routes
                    .iter()
                    .filter(|route| route.entry.iter().any(|at| !self.is_free(*at)))
                    .collect();
                let waited = random.pick(&waits).map(|route| route.name.clone()).filter(|_| random.one_in(2));
                Some(json!({"set": waited.or_else(|| route(random))?}))
            }
            5 | 6 => {
                let held: Vec<_> = last.and_then(|last| last["routes"].as_object()).into_iter().flatten().collect();
                let held = random.pick(&held).map(|(name, _)| (*name).clone());
                Some(json!({"withdraw": held.or_else(|| route(random))?}))
            }
            7 => {
                let point = random.pick(&self.station.points)?;
                Some(json!({"drive": point, "to": if random.one_in(2) { "normal" } else { "reverse" }}))
            }
            _ => {
                let segment = random.pick(&self.station.segments)?;
                Some(json!({"turn": segment.name, "to": if random.one_in(2) { "toward" } else { "away" }}))
            }
        }
    }

    fn orders(&mut self, random: &mut Random) -> Option<Value> {
        let all = &self.station.circuits;
        if !self.begun {
            self.begun = true;
            return Some(json!({"unblock": all, "lift": all}));
        }
        let one = random.pick(all)?.clone();
        match random.number() % (60 * self.pace) {
            0 => Some(json!({"block": [one]})),
            1 | 2 => Some(json!({"unblock": all})),
            3 => {
                let speed = random.one_of(&[0, 14, 15, 25, 26, 90, 65_535]);
                Some(json!({"restrict": {one: speed}}))
            }
            4 => Some(json!({"lift": all})),
            5 => Some(
                json!({"block": [one.clone()], "unblock": [one.clone()], "restrict": {one.clone(): 25}, "lift": [one]}),
            ),
            _ => None,
        }
    }
}

impl Walk for Ground {
    fn next(&mut self, random: &mut Random, last: Option<&Value>) -> Value {
        self.move_points(random, last);
        if self.agenda.is_empty() {
            self.move_trains(random, last);
        }
        let mut detected = Map::new();
        for (number, name) in self.station.points.iter().enumerate() {
            let point = self.points[number];
            if point.driven.is_none() && !self.goes_wrong(random) {
                detected.insert(name.clone(), point.at.into());
            }
        }
        for number in 0..self.consent.len() {
            if self.agenda.is_empty() && random.one_in(12 * self.pace) {
                self.consent[number] = !self.consent[number];
            }
        }
        if let Some(asked) =
            self.asked.take().filter(|_| last.is_some_and(|last| last["answer"]["refused"] == "starting"))
        {
            self.agenda.push(asked);
        }
        let request = match self.agenda.pop() {
            Some(asked) => {
                self.asked = Some(asked.clone()).filter(|_| self.pace > 1);
                Some(asked).filter(|asked| !asked.is_null())
            }
            None if random.one_in(self.requests) => self.request(random, last),
            None => None,
        };
        let orders = self.orders(random);
        let consent = self.station.segments.iter().zip(&self.consent).filter(|(_, consents)| **consents);
        let consent: Vec<_> = consent.map(|(segment, _)| segment.name.clone()).collect();
        let mut step = json!({"occupied": self.occupied(random), "detected": detected});
        if let Some(request) = request {
            step["request"] = request;
        }
        if let Some(orders) = orders {
            step["orders"] = orders;
        }
        if !consent.is_empty() {
            step["consent"] = consent.into();
        }
        if random.one_in(10) {
            step["all_telegrams"] = true.into();
        }
        step
    }
}
