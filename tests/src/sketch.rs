//! The plan of a station in plain lists, for tests: circuits, points, routes and segments are numbered from 0 and named by their
//! numbers. [`Sketch::plan`] puts it in the kernel's form.

use atc_kernel::distance::Metres;
use atc_kernel::interlocking::{
    CircuitSet, Element, Heading, MAX_CODES, Plan, Point, PointId, Position, Positions, Route, RouteSet, Segment,
    SegmentSet, Size, SpeedCode,
};
use atc_kernel::time::Ticks;

/// A position that a point must have.
pub type Need = (usize, Position);

/// A station.
#[derive(Clone, Debug, Default)]
pub struct Sketch {
    /// The lengths of the circuits, in metres.
    pub lengths: Vec<u16>,
    /// The detector circuits of each point.
    pub points: Vec<Vec<usize>>,
    /// The routes.
    pub routes: Vec<Way>,
    /// The segments of plain line.
    pub segments: Vec<Line>,
    /// Stopping distances in metres from the speed of code 0, 1, …; there are no higher codes.
    pub braking: Vec<u16>,
    /// For how many cycles a circuit must be reported clear.
    pub clear: u8,
    /// For how many cycles after a start nothing moves.
    pub start: u16,
    /// For how many cycles a point must be detected, undriven, before it counts as detected.
    pub settle: u8,
    /// For how many cycles a permission must have been withdrawn before a segment turns.
    pub turn: u16,
}

/// A route.
#[derive(Clone, Debug, Default)]
pub struct Way {
    /// Whether it leads to the left.
    pub leftward: bool,
    /// The circuit that it is entered from.
    pub entry: usize,
    /// The circuits of the approach, the entry among them.
    pub approach: Vec<usize>,
    /// The circuits of the path in order, each with the points that it needs.
    pub path: Vec<(usize, Vec<Need>)>,
    /// The circuits of the overlap, and the points that it needs.
    pub overlap: (Vec<usize>, Vec<Need>),
    /// The circuits beyond the end.
    pub beyond: Vec<usize>,
    /// The routes that continue.
    pub continuing: Vec<usize>,
    /// The routes that conflict by declaration.
    pub conflicts: Vec<usize>,
    /// The segment that its train comes from.
    pub from: Option<usize>,
    /// The segment that its train goes out to.
    pub to: Option<usize>,
    /// The time for the points, in cycles.
    pub drive: u16,
    /// The release time, in cycles.
    pub release: u16,
    /// The stay time, in cycles.
    pub stay: u16,
    /// The speed code.
    pub speed: u8,
    /// That of the overlap.
    pub overlap_speed: u8,
    /// Whether its trains act on telegrams alone.
    pub cab: bool,
    /// Whether it is a calling-on route: its overlap is the berth.
    pub calling_on: bool,
}

/// A segment of plain line.
#[derive(Clone, Debug, Default)]
pub struct Line {
    /// Its circuits, the one next to the station first.
    pub circuits: Vec<usize>,
    /// The last circuit of the routes that go out to it.
    pub throat: Option<usize>,
    /// Whether trains go out to it to the left.
    pub leftward: bool,
}

impl Way {
    /// The circuits of the path.
    pub fn circuits(&self) -> Vec<usize> {
        self.path.iter().map(|place| place.0).collect()
    }

    /// The last circuit of the path.
    pub fn last(&self) -> usize {
        self.path.last().map_or(0, |place| place.0)
    }

    /// Every position that it needs.
    pub fn needs(&self) -> Vec<Need> {
        self.path.iter().flat_map(|place| &place.1).chain(&self.overlap.1).copied().collect()
    }
}

/// The set of these circuits.
pub fn circuits<Z: Size>(numbers: &[usize]) -> CircuitSet<Z> {
    numbers.iter().fold(CircuitSet::EMPTY, |set, number| set.or(CircuitSet::nth(*number)))
}

/// The set of these segments.
pub fn segments(numbers: &[usize]) -> SegmentSet {
    numbers.iter().fold(SegmentSet::EMPTY, |set, number| set.or(SegmentSet::nth(*number)))
}

/// These positions.
///
/// # Panics
/// If there cannot be a point of such a number.
pub fn positions<Z: Size>(needs: &[Need]) -> Positions<Z> {
    let id = |point: usize| u8::try_from(point).ok().and_then(PointId::new).expect("a point's number");
    needs.iter().fold(Positions::NONE, |all, (point, position)| all.or(Positions::of(id(*point), *position)))
}

fn routes<Z: Size>(numbers: &[usize]) -> RouteSet<Z> {
    numbers.iter().fold(RouteSet::EMPTY, |set, number| set.or(RouteSet::nth(*number)))
}

fn place<Z: Size>(circuits_of: &[usize], needs: &[Need]) -> Element<Z> {
    Element { circuits: circuits(circuits_of), positions: positions(needs), ..Element::NONE }
}

impl Sketch {
    /// The same with routes in conflict that start from one circuit in opposite directions.
    #[must_use]
    pub fn apart(mut self) -> Self {
        for one in 0..self.routes.len() {
            for other in 0..self.routes.len() {
                let (way, against) = (&self.routes[one], &self.routes[other]);
                let opposed = way.entry == against.entry && way.leftward != against.leftward;
                if opposed && !way.conflicts.contains(&other) {
                    self.routes[one].conflicts.push(other);
                }
                let (way, against) = (&self.routes[one], &self.routes[other]);
                let berth =
                    way.calling_on && way.leftward != against.leftward && way.overlap.0.contains(&against.entry);
                let meets = against.path.iter().any(|place| place.0 == way.last());
                let within = against.path.iter().any(|place| way.overlap.0.contains(&place.0));
                let starts = way.overlap.0.contains(&against.entry);
                let throat = self.segments.iter().any(|line| line.throat.is_some_and(|it| way.overlap.0.contains(&it)));
                // One that runs into the berth and out of it: the next signal is farther on.
                let behind = against.path.iter().skip_while(|place| place.0 != way.last()).skip(1);
                let outside = behind.filter(|place| !way.overlap.0.contains(&place.0)).count() > 0;
                let through = way.leftward == against.leftward && within && outside;
                if berth && !meets || starts && within || throat || through {
                    self.routes[one].calling_on = false;
                }
            }
        }
        self
    }

    /// The same in the kernel's form.
    ///
    /// # Panics
    /// If there is no room for it.
    pub fn plan<const R: usize, const P: usize, const N: usize, const S: usize, Z: Size>(&self) -> Plan<R, P, N, S, Z> {
        let mut plan = Plan::EMPTY;
        assert!(self.lengths.len() <= CircuitSet::<Z>::MOST && self.braking.len() <= MAX_CODES);
        for (length, metres) in plan.lengths.iter_mut().zip(&self.lengths) {
            *length = Metres(*metres);
        }
        for (distance, metres) in plan.braking.iter_mut().zip(&self.braking) {
            *distance = Metres(*metres);
        }
        for (number, detectors) in self.points.iter().enumerate() {
            plan.points[number] = Point { detectors: circuits(detectors) };
        }
        for (number, line) in self.segments.iter().enumerate() {
            plan.segments[number] = segment(line);
        }
        for (number, way) in self.routes.iter().enumerate() {
            plan.routes[number] = route(way);
        }
        Plan { clear: self.clear, start: Ticks(self.start), settle: self.settle, turn: Ticks(self.turn), ..plan }
    }
}

fn segment<const P: usize, Z: Size>(line: &Line) -> Segment<P, Z> {
    let mut segment = Segment::NONE;
    for (place, circuit) in line.circuits.iter().enumerate() {
        segment.circuits[place] = CircuitSet::nth(*circuit);
    }
    let length = u8::try_from(line.circuits.len()).expect("a short segment");
    let outward = heading(line.leftward);
    Segment { length, outward, throat: line.throat.map_or(CircuitSet::EMPTY, CircuitSet::nth), ..segment }
}

const fn heading(leftward: bool) -> Heading {
    if leftward { Heading::Left } else { Heading::Right }
}

fn route<const P: usize, Z: Size>(way: &Way) -> Route<P, Z> {
    let mut path = Route::<P, Z>::NONE.path;
    for (number, (circuit, needs)) in way.path.iter().enumerate() {
        path[number] = place(&[*circuit], needs);
    }
    let one = |segment: Option<usize>| segment.map_or(SegmentSet::EMPTY, SegmentSet::nth);
    Route {
        heading: heading(way.leftward),
        entry: CircuitSet::nth(way.entry),
        approach: circuits(&way.approach),
        path,
        length: u8::try_from(way.path.len()).expect("a short path"),
        overlap: place(&way.overlap.0, &way.overlap.1),
        beyond: circuits(&way.beyond),
        continuing: routes(&way.continuing),
        conflicts: routes(&way.conflicts),
        from: one(way.from),
        to: one(way.to),
        drive: Ticks(way.drive),
        release: Ticks(way.release),
        stay: Ticks(way.stay),
        speed: SpeedCode(way.speed),
        overlap_speed: SpeedCode(way.overlap_speed),
        cab_signalled: way.cab,
        calling_on: way.calling_on,
    }
}
