//! A layout with numbers for names and everything derived that the file leaves out; of any size.

use std::collections::{BTreeMap, BTreeSet};
use std::ops::Range;

use atc_kernel::distance::Metres;
use atc_kernel::interlocking::{Heading, MAX_CODES, SpeedCode};
use atc_kernel::time::Ticks;

use crate::At;
use crate::form::Position;
use crate::graph::{Graph, Kind, Passed};

/// Numbers of circuits.
pub type Circuits = BTreeSet<usize>;

/// Positions of points, by number.
pub type Positions = BTreeMap<usize, Position>;

/// A layout: names are numbered in the order of the file.
#[derive(Clone, Debug, Default)]
pub struct Model {
    /// The tracks.
    pub graph: Graph,
    /// The circuits.
    pub circuits: Vec<Circuit>,
    /// The points.
    pub points: Vec<Point>,
    /// The segments.
    pub segments: Vec<Segment>,
    /// Pairs of circuits that foul each other.
    pub fouling: Vec<(usize, usize)>,
    /// The routes.
    pub routes: Vec<Route>,
    /// The values for the whole station.
    pub values: Values,
    /// What was derived or defaulted.
    pub notes: Vec<Note>,
}

impl Model {
    /// For how long at most a train may count on what was before: the longest release time, or the turn time.
    pub fn longest_authority(&self) -> Ticks {
        self.routes.iter().map(|route| route.release).max().unwrap_or_default().max(self.values.turn)
    }

    /// In how many ms a train can stand at the end of a route at the soonest, once it has come into the last circuit: it runs at the speed of the route
    /// as far as it may, and brakes. One that runs slower takes longer. None where nothing is held beyond the end, a berth is, or no train may run.
    pub fn least_standstill_ms(&self, route: &Route) -> Option<u32> {
        let last = route.last().filter(|_| !route.overlap.is_empty() && !route.calling_on)?;
        let last = self.circuits.get(last)?;
        let way = u64::from(last.length.0) * 1000;
        let brake = u64::from(self.values.brake_mm_s2).max(1);
        // km/h in mm/s is 1e6 / 3600; and no faster than a train that brakes from the first metre on.
        let speed = u64::from(self.values.speeds_kmh[usize::from(route.speed.0)]) * 1_000_000 / 3600;
        let speed = speed.min((2 * brake * way).isqrt());
        if speed == 0 {
            return None;
        }
        u32::try_from((way * 1000).div_ceil(speed) + (speed * 1000).div_ceil(2 * brake)).ok()
    }

    /// The circuit, and those that a train in it, travelling so, may be granted: of the routes over it and of those that go on, and of plain line.
    pub fn ahead(&self, circuit: usize, heading: Heading) -> Circuits {
        let mut found = Circuits::from([circuit]);
        let line = self.segments.iter().filter(|segment| segment.circuits.contains(&circuit));
        found.extend(line.flat_map(|segment| segment.circuits.iter().copied()));
        let mut routes: Vec<usize> = Vec::new();
        loop {
            let next = self.routes.iter().enumerate().position(|(number, route)| {
                let goes_on = routes.iter().any(|before| self.routes[*before].continuing.contains(&number));
                let here = found.contains(&route.entry) || route.circuits().any(|at| at == circuit);
                route.is_sound() && route.heading == heading && (goes_on || here) && !routes.contains(&number)
            });
            let Some(number) = next else { return found };
            let route = &self.routes[number];
            found.extend(route.circuits());
            found.extend(route.to.iter().flat_map(|segment| self.segments[*segment].circuits.iter().copied()));
            routes.push(number);
        }
    }

    /// The highest speed that a train in a circuit, travelling so, may be told, in km/h: of the routes over it and of those that begin there, and of plain
    /// line; 0 where none does.
    pub fn fastest_kmh(&self, circuit: usize, heading: Heading) -> u16 {
        let routes = self.routes.iter().filter(|route| route.is_sound() && route.heading == heading);
        let here = |route: &&Route| route.entry == circuit || route.circuits().any(|at| at == circuit);
        let over = routes.filter(here).map(|route| route.speed);
        let line = self.segments.iter().filter(|segment| segment.circuits.contains(&circuit));
        let codes = over.chain(line.map(|segment| segment.speed));
        codes.map(|code| self.values.speeds_kmh[usize::from(code.0)]).max().unwrap_or(0)
    }

    /// The longest of these times.
    pub fn longest_standstill_ms(&self) -> u32 {
        self.routes.iter().filter_map(|route| self.least_standstill_ms(route)).max().unwrap_or(0)
    }
}

/// A circuit.
#[derive(Clone, Debug, Default)]
pub struct Circuit {
    /// Its name.
    pub name: String,
    /// Its length.
    pub length: Metres,
    /// Where it is named.
    pub span: Range<usize>,
}

/// A point.
#[derive(Clone, Debug, Default)]
pub struct Point {
    /// Its name.
    pub name: String,
    /// The circuit it lies in; none if the file names none that exists.
    pub circuit: Option<usize>,
    /// Its detectors.
    pub detectors: Circuits,
    /// The other circuits in which it is fouled.
    pub fouled_in: Circuits,
    /// Its stroke, in ms.
    pub throw_ms: u32,
    /// Where it is named.
    pub span: Range<usize>,
}

/// A segment of plain line.
#[derive(Clone, Debug)]
pub struct Segment {
    /// Its name.
    pub name: String,
    /// Its circuits, outward from the station.
    pub circuits: Vec<usize>,
    /// The direction of travel away from the station.
    pub outward: Heading,
    /// The name of the line, which the neighbour gives it too.
    pub line: Option<String>,
    /// How many of the circuits, the outermost ones, the neighbour's device sees too.
    pub shared: usize,
    /// The last circuit of the routes out to it.
    pub throat: Option<usize>,
    /// The speed code.
    pub speed: SpeedCode,
    /// The protection where other tracks cross it.
    pub flanks: Vec<Flank>,
    /// Where it is named.
    pub span: Range<usize>,
}

/// What keeps vehicles off a track beside a path.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Guard {
    /// Another point in this position.
    Point(usize, Position),
    /// The signal of a route, at stop.
    Signal(String),
    /// A buffer stop, and no circuit of its own before it: no vehicle can stand there.
    Buffer,
    /// Nothing: in this circuit, between the path and what would keep off others, a vehicle may stand that faces no signal.
    Standing(usize),
    /// The route itself holds what is there.
    Own,
    /// Nothing: the line goes on.
    Line,
    /// The file says why nothing is needed.
    Declared(String),
}

/// The protection at an end of a track that a path does not run over: the unused leg of a point, or a track that it crosses.
#[derive(Clone, Debug)]
pub struct Flank {
    /// The track.
    pub track: usize,
    /// Which of its joints.
    pub end: usize,
    /// What is there, for each track that leads to it.
    pub guards: Vec<Guard>,
}

impl Flank {
    /// What it protects, in words.
    pub fn of(&self, model: &Model) -> String {
        let track = &model.graph.tracks[self.track];
        let joint = |end: usize| &model.graph.joints[track.joints[end]].name;
        match track.kind {
            Kind::Point(point) if self.end == 0 => format!("the toe of point {}", model.points[point].name),
            Kind::Point(point) => format!("the {} leg of point {}", self.word(model), model.points[point].name),
            Kind::Plain => format!("the track from {} to {}", joint(0), joint(1)),
        }
    }

    /// The word for its end.
    pub fn word(&self, model: &Model) -> &'static str {
        match (model.graph.tracks[self.track].kind, self.end) {
            (Kind::Point(_), 0) => "toe",
            (Kind::Point(_), 1) => "normal",
            (Kind::Point(_), _) => "reverse",
            (Kind::Plain, 0) => "left",
            (Kind::Plain, _) => "right",
        }
    }
}

/// One place of a path.
#[derive(Clone, Debug)]
pub struct Place {
    /// The circuit.
    pub circuit: usize,
    /// The points that the path runs over there.
    pub passed: Vec<Passed>,
    /// The tracks that it runs over, points among them.
    pub tracks: Vec<usize>,
    /// Every position that is needed there, flank included.
    pub positions: Positions,
    /// The circuits beside it, which are proved clear and not run over.
    pub beside: Circuits,
    /// Where the place is named.
    pub span: Range<usize>,
}

/// A route.
#[derive(Clone, Debug)]
pub struct Route {
    /// Its name.
    pub name: String,
    /// Its signal.
    pub signal: String,
    /// The direction of travel.
    pub heading: Heading,
    /// The entry circuit.
    pub entry: usize,
    /// The joint of its signal.
    pub start: usize,
    /// The path; empty if the file gives none that a train can run.
    pub path: Vec<Place>,
    /// The joint at its end.
    pub exit: usize,
    /// Whether it is a calling-on route: then its overlap is the berth.
    pub calling_on: bool,
    /// The joint at the end of its berth, or overlap; at the end of the path without one.
    pub berth_end: usize,
    /// The circuits of the overlap, in order of travel.
    pub overlap: Vec<usize>,
    /// The positions of points in the overlap.
    pub overlap_positions: Positions,
    /// The circuits beside the overlap.
    pub overlap_beside: Circuits,
    /// The points that the overlap runs over.
    pub overlap_passed: Vec<Passed>,
    /// Why the overlap may be short or missing.
    pub short_overlap: Option<String>,
    /// Why no train changes ends where it ends.
    pub no_reversal: Option<String>,
    /// The approach.
    pub approach: Circuits,
    /// The highest speed at which a train comes up to the signal, in km/h.
    pub approach_kmh: u16,
    /// How far the approach must reach back from the signal, in metres.
    pub approach_m: u32,
    /// The circuits beyond the end.
    pub beyond: Circuits,
    /// The routes that continue this one.
    pub continuing: BTreeSet<usize>,
    /// The routes that it is declared in conflict with.
    pub conflicts: BTreeSet<usize>,
    /// The segment it comes from.
    pub from: Option<usize>,
    /// The segment it goes out to.
    pub to: Option<usize>,
    /// The time for points to arrive.
    pub drive: Ticks,
    /// The time of the approach lock.
    pub release: Ticks,
    /// The time after which the overlap is given up.
    pub stay: Ticks,
    /// The speed code.
    pub speed: SpeedCode,
    /// The speed code of the overlap: for a train that has slid there and goes back.
    pub overlap_speed: SpeedCode,
    /// The protection of the legs that the path does not use, and of the tracks that it crosses.
    pub flanks: Vec<Flank>,
    /// Where it is named.
    pub span: Range<usize>,
}

impl Default for Route {
    fn default() -> Self {
        Self {
            name: String::new(),
            signal: String::new(),
            heading: Heading::Right,
            entry: 0,
            start: 0,
            path: Vec::new(),
            exit: 0,
            calling_on: false,
            berth_end: 0,
            overlap: Vec::new(),
            overlap_positions: Positions::new(),
            overlap_beside: Circuits::new(),
            overlap_passed: Vec::new(),
            short_overlap: None,
            no_reversal: None,
            approach: Circuits::new(),
            approach_kmh: 0,
            approach_m: 0,
            beyond: Circuits::new(),
            continuing: BTreeSet::new(),
            conflicts: BTreeSet::new(),
            from: None,
            to: None,
            drive: Ticks(0),
            release: Ticks(0),
            stay: Ticks(0),
            speed: SpeedCode::STOP,
            overlap_speed: SpeedCode::STOP,
            flanks: Vec::new(),
            span: 0..0,
        }
    }
}

impl Route {
    /// Whether its path is one that a train can run.
    pub fn is_sound(&self) -> bool {
        !self.path.is_empty()
    }

    /// Whether it starts from the circuit of `other` in the opposite direction of travel.
    pub fn opposes_the_start_of(&self, other: &Self) -> bool {
        self.entry == other.entry && self.heading != other.heading
    }

    /// The circuits of its path, in order of travel.
    pub fn circuits(&self) -> impl Iterator<Item = usize> + '_ {
        self.path.iter().map(|place| place.circuit)
    }

    /// The circuits that it holds: path and overlap.
    pub fn held(&self) -> Circuits {
        self.circuits().chain(self.overlap.iter().copied()).collect()
    }

    /// The circuits beside path and overlap.
    pub fn beside(&self) -> Circuits {
        self.path.iter().flat_map(|place| &place.beside).chain(&self.overlap_beside).copied().collect()
    }

    /// The last circuit of the path.
    pub fn last(&self) -> Option<usize> {
        self.path.last().map(|place| place.circuit)
    }

    /// Every position that it needs, over path, flank and overlap.
    pub fn positions(&self) -> impl Iterator<Item = (usize, Position)> + '_ {
        let path = self.path.iter().flat_map(|place| &place.positions);
        path.chain(&self.overlap_positions).map(|(point, position)| (*point, *position))
    }
}

/// Values for the whole station.
#[derive(Clone, Debug)]
pub struct Values {
    /// The length of a logic cycle, in ms.
    pub cycle_ms: u32,
    /// T_clear, in cycles.
    pub clear: u8,
    /// The time after a start.
    pub start: Ticks,
    /// The same in ms, as the file gives it or as it is derived.
    pub start_ms: At<u32>,
    /// The settling time of points, in cycles.
    pub settle: u8,
    /// The longest loss of shunt, in cycles.
    pub loss: u8,
    /// The longest residual running.
    pub residual: Ticks,
    /// The same in ms, as the file gives it or as it is derived.
    pub residual_ms: At<u32>,
    /// The least that it can be, in ms: the age of a telegram, and the time to a stand from the highest speed.
    pub least_residual_ms: u32,
    /// The longest time to a stand.
    pub standstill: Ticks,
    /// The same as the file has it, or derived.
    pub standstill_ms: At<u32>,
    /// How long a train must have stood before the overlap is given up, where a route says nothing: as the file has it, or derived.
    pub stay_ms: At<u32>,
    /// What every train has of its brake on the worst gradient, in mm/s².
    pub brake_mm_s2: u16,
    /// Whether every train acts on telegrams alone.
    pub cab_signalled: bool,
    /// The time for which a permission must have been withdrawn before a segment turns.
    pub turn: Ticks,
    /// The same in ms, as the file gives it or as it is derived.
    pub turn_ms: At<u32>,
    /// The least that it can be where there is plain line, in ms; 0 where there is none.
    pub least_turn_ms: u32,
    /// The age of a telegram, in ms.
    pub telegram_age_ms: u32,
    /// The speed of each code, in km/h; 0 where there is no such code, and for code 0.
    pub speeds_kmh: [u16; MAX_CODES],
    /// How far beyond its circuit a train may hear a code.
    pub heard_beyond: Metres,
    /// How far a train runs from the speed of each code when a lower one goes out: where it still hears the code, while its telegram ages, and braking.
    /// The longest length where there is no such code.
    pub braking: [Metres; MAX_CODES],
    /// The least length of an overlap.
    pub least_overlap: Metres,
    /// The length of the longest train, if the file gives it.
    pub longest_train: Option<Metres>,
    /// That of the shortest one.
    pub shortest_train: Option<Metres>,
    /// The strongest brake on the level by which trains come from telegrams, in mm/s².
    pub strongest_mm_s2: u16,
}

impl Values {
    /// A time in ms. No cycle is longer than a minute, so that it fits.
    pub fn ms(&self, ticks: Ticks) -> u32 {
        u32::from(ticks.0).saturating_mul(self.cycle_ms)
    }
}

impl Default for Values {
    fn default() -> Self {
        Self {
            cycle_ms: 0,
            clear: 0,
            start: Ticks(0),
            start_ms: At::derived(0),
            settle: 0,
            loss: 0,
            residual_ms: At::derived(0),
            residual: Ticks(0),
            least_residual_ms: 0,
            standstill: Ticks(0),
            standstill_ms: At::derived(0),
            stay_ms: At::derived(0),
            brake_mm_s2: 0,
            cab_signalled: false,
            turn: Ticks(0),
            turn_ms: At::derived(0),
            least_turn_ms: 0,
            telegram_age_ms: 0,
            speeds_kmh: [0; MAX_CODES],
            heard_beyond: Metres(0),
            braking: [Metres(u16::MAX); MAX_CODES],
            least_overlap: Metres(0),
            longest_train: None,
            shortest_train: None,
            strongest_mm_s2: 0,
        }
    }
}

/// Something that the file does not say.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Note {
    /// What it is about: `route W1-1`, `point 2`.
    pub about: String,
    /// What was derived or assumed.
    pub text: String,
}
