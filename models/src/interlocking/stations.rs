//! The stations of the models, drawn, and the layouts that the kernel is given of them.
//!
//! ```text
//! loop        W ──▷ west ═══ one ══▷═ east ◁── E       point 0 in west, point 1 in east; normal leads to one
//!                        ╲══ two ══▷╱
//! junction    M ──▷ join ─────── E                     point 0 in join, normal from M; point 1 in trap, normal to join
//!             B ──▷ trap ─╱ ╲ sand                     reverse to sand
//! crossing    A ──▷ over ── X      B ──▷ under ── Y    over and under cross on the level
//! terminus    L ──▷ throat ═══ one                     point 0 in throat; normal leads to one
//!                          ╲══ two
//! siding      L ──▷ throat ─── first ─── second
//! halt        L ──▷ throat ◁── platform
//! counted     far ─── near ──▷ throat ═══ one          point 0 in throat; normal leads to one
//!                                     ╲══ two
//! long track  L ──▷ throat ◁── near ─── far            trains turn round in far
//! berth       W ──▷ west ◁═ berth ═▷ east ◁── E        a train from W may be called on into the berth
//! ```
//!
//! W, E, M, B, A, X, Y and L are plain line of one circuit each.

mod others;

pub use others::{
    BRANCH, IN, MAIN, OUT, berth, berth_route, called, counted, counted_line, crossing, diamond, end, fork, halt,
    junction, long_track, rest, reversal, siding, stop, terminus,
};

pub use super::sizes::{CIRCUITS, PLACES, POINTS, ROUTES, SEGMENTS, SIGNALS, Small, SmallPlan, circuits};

use super::ground::{Edge, Ground, Heading, Signal, Station};
use atc_kernel::distance::Metres;
use atc_kernel::interlocking::{
    CircuitSet, Element, Layout, Point, PointSet, Position, Positions, Route, RouteSet, Segment, SegmentSet, SpeedCode,
};
use atc_kernel::time::Ticks;

use Heading::{Down, Up};
use Position::{Normal, Reverse};

const fn points(mask: u8) -> PointSet {
    PointSet::from_bits(mask as u32)
}

const fn routes(mask: u8) -> RouteSet {
    RouteSet::from_bits(mask as u64)
}

/// The positions of the points; `n`, `r`: masks.
const fn positions(n: u8, r: u8) -> Positions {
    Positions { normal: points(n), reverse: points(r) }
}

fn edge(from: u8, to: u8, heading: Heading) -> Edge {
    Edge { from, to, heading, over: [None; 2] }
}

fn over(from: u8, to: u8, heading: Heading, point: usize, position: Position) -> Edge {
    Edge { from, to, heading, over: [Some((point, position)), None] }
}

/// The edges of both ways.
fn both(edges: &[Edge]) -> Vec<Edge> {
    let back = edges.iter().map(|edge| Edge { from: edge.to, to: edge.from, heading: edge.heading.turned(), ..*edge });
    edges.iter().copied().chain(back).collect()
}

fn signal(at: u8, heading: Heading, routes: u8) -> Signal {
    Signal { at, heading, counted_on: 1 << at, routes, slide: 0 }
}

/// A route from `entry` over `path`: circuits with the points that they need. `beyond` is a mask.
fn route(entry: u8, path: &[(u8, Positions)], beyond: u8) -> Route<PLACES> {
    let mut route = Route {
        entry: circuits(1 << entry),
        approach: circuits(1 << entry),
        length: u8::try_from(path.len()).expect("a short path"),
        beyond: circuits(beyond),
        drive: Ticks(3),
        release: Ticks(2),
        stay: Ticks(1),
        speed: SpeedCode(2),
        overlap_speed: SpeedCode(2),
        ..Route::NONE
    };
    for (place, (circuit, positions)) in route.path.iter_mut().zip(path) {
        *place = Element { circuits: circuits(1 << circuit), positions: *positions, ..Element::NONE };
    }
    route
}

/// A plan with nothing but the times, lengths and speed codes that all models share.
fn plan(all: usize) -> SmallPlan {
    let mut plan = SmallPlan::EMPTY;
    plan.lengths[..all].fill(Metres(100));
    plan.braking[0] = Metres(0);
    plan.braking[1] = Metres(50);
    plan.braking[2] = Metres(150);
    plan.clear = 1;
    plan.turn = Ticks(1);
    plan
}

fn segment(circuit: u8, throat: u8) -> Segment<PLACES> {
    let mut segment = Segment { length: 1, throat: circuits(throat), ..Segment::NONE };
    segment.circuits[0] = circuits(1 << circuit);
    segment
}

fn alone(segment: usize) -> SegmentSet {
    SegmentSet::nth(segment)
}

/// A station whose layout keeps every rule.
///
/// # Panics
/// If it does not; a test builds every station.
fn checked(name: &'static str, ground: Ground, plan: &SmallPlan) -> Station {
    let plan = directed(&ground, *plan);
    Station { name, ground, layout: Layout::new(plan).expect("a layout that keeps every rule") }
}

/// The plan with the directions of travel as the tracks lie, and without opposing starts from one circuit.
fn directed(ground: &Ground, mut plan: SmallPlan) -> SmallPlan {
    let leads = |from: CircuitSet, to: CircuitSet| {
        let leads = |edge: &&Edge| from.meets(circuits(1 << edge.from)) && to.meets(circuits(1 << edge.to));
        ground.edges.iter().find(leads).map(|edge| edge.heading.of_layout())
    };
    for route in &mut plan.routes {
        route.heading = leads(route.entry, route.path[0].circuits).unwrap_or(route.heading);
    }
    let all = plan.routes;
    for (number, segment) in plan.segments.iter_mut().enumerate() {
        let out = all.iter().find(|route| route.to.meets(alone(number))).map(|route| route.heading);
        let within = all.iter().find(|route| route.from.meets(alone(number))).map(|route| route.heading.opposite());
        segment.outward = out.or(within).unwrap_or(segment.outward);
    }
    for (number, route) in plan.routes.iter_mut().enumerate() {
        for (number_of_other, other) in all.iter().enumerate() {
            let both = all[number].exists() && other.exists() && other.entry == route.entry;
            if both && other.heading != route.heading {
                route.conflicts = route.conflicts.or(RouteSet::nth(number_of_other));
            }
        }
    }
    plan
}

impl Station {
    /// The same tracks with another plan that keeps every rule.
    ///
    /// # Panics
    /// If it does not; a test builds every model.
    #[must_use]
    pub fn with(&self, change: impl FnOnce(&mut SmallPlan)) -> Self {
        let mut plan = *self.layout.plan();
        change(&mut plan);
        checked(self.name, self.ground.clone(), &plan)
    }

    /// The same tracks with a plan that is wrong on purpose, forced past the rules of engineering.
    ///
    /// # Panics
    /// If it breaks a rule that the theorems rest on; a test builds every model.
    #[must_use]
    pub fn forced(&self, change: impl FnOnce(&mut SmallPlan)) -> Self {
        let mut plan = *self.layout.plan();
        change(&mut plan);
        let layout = Layout::with_what_proofs_need(plan).expect("a layout that keeps what the theorems need");
        Self { layout, ..self.clone() }
    }

    /// The same station where trains slide past the signals for this way by so many circuits.
    #[must_use]
    pub fn sliding(&self, at: &[u8], heading: Heading, slide: u8) -> Self {
        let mut station = self.clone();
        for signal in &mut station.ground.signals {
            if at.contains(&signal.at) && signal.heading == heading {
                signal.slide = slide;
            }
        }
        station
    }
}

/// Which overlaps the routes into the passing loop have.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Overlaps {
    /// The throat beyond the platform.
    Throat,
    /// None: trains come in from both sides at the same time.
    None,
}

/// Circuits of the passing loop.
pub mod passing {
    /// Plain line in the west.
    pub const W: u8 = 0;
    /// The western throat, with point 0.
    pub const WEST: u8 = 1;
    /// The first platform.
    pub const ONE: u8 = 2;
    /// The second platform.
    pub const TWO: u8 = 3;
    /// The eastern throat, with point 1.
    pub const EAST: u8 = 4;
    /// Plain line in the east.
    pub const E: u8 = 5;
}

/// Numbers of the routes of the passing loop: up comes from W, down from E.
pub mod loop_route {
    /// W to platform one.
    pub const UP_IN_ONE: u8 = 0;
    /// Platform one to E.
    pub const UP_OUT_ONE: u8 = 1;
    /// E to platform two.
    pub const DOWN_IN_TWO: u8 = 2;
    /// Platform two to W.
    pub const DOWN_OUT_TWO: u8 = 3;
    /// W to platform two.
    pub const UP_IN_TWO: u8 = 4;
    /// Platform two to E.
    pub const UP_OUT_TWO: u8 = 5;
    /// E to platform one.
    pub const DOWN_IN_ONE: u8 = 6;
    /// Platform one to W.
    pub const DOWN_OUT_ONE: u8 = 7;
}

/// A passing loop: four routes in, four out, two segments.
pub fn passing_loop(overlaps: Overlaps) -> Station {
    use loop_route::{
        DOWN_IN_ONE, DOWN_IN_TWO, DOWN_OUT_ONE, DOWN_OUT_TWO, UP_IN_ONE, UP_IN_TWO, UP_OUT_ONE, UP_OUT_TWO,
    };
    use passing::{E, EAST, ONE, TWO, W, WEST};
    let edges = [
        edge(W, WEST, Up),
        over(WEST, ONE, Up, 0, Normal),
        over(WEST, TWO, Up, 0, Reverse),
        over(ONE, EAST, Up, 1, Normal),
        over(TWO, EAST, Up, 1, Reverse),
        edge(EAST, E, Up),
    ];
    let ground = Ground {
        circuits: &["W", "west", "one", "two", "east", "E"],
        edges: both(&edges),
        signals: vec![
            signal(W, Up, 1 << UP_IN_ONE | 1 << UP_IN_TWO),
            signal(ONE, Up, 1 << UP_OUT_ONE),
            signal(TWO, Up, 1 << UP_OUT_TWO),
            signal(E, Down, 1 << DOWN_IN_ONE | 1 << DOWN_IN_TWO),
            signal(ONE, Down, 1 << DOWN_OUT_ONE),
            signal(TWO, Down, 1 << DOWN_OUT_TWO),
        ],
        points_in: [WEST, EAST],
        fouls: Vec::new(),
        line: 1 << W | 1 << E,
        ends: vec![(E, Up), (W, Down)],
        turning: 0,
        waits: 0,
        catching: 0,
    };
    let mut plan = plan(6);
    let west = |platform: u8| if platform == ONE { positions(1, 0) } else { positions(0, 1) };
    let east = |platform: u8| if platform == ONE { positions(2, 0) } else { positions(0, 2) };
    let mut put = |number: u8, route: Route<PLACES>| plan.routes[usize::from(number)] = route;
    let ways = [
        (ONE, [UP_IN_ONE, UP_OUT_ONE, DOWN_IN_ONE, DOWN_OUT_ONE]),
        (TWO, [UP_IN_TWO, UP_OUT_TWO, DOWN_IN_TWO, DOWN_OUT_TWO]),
    ];
    for (platform, [up_in, up_out, down_in, down_out]) in ways {
        let overlap = |throat: u8, positions| match overlaps {
            Overlaps::Throat => Element { circuits: circuits(1 << throat), positions, ..Element::NONE },
            Overlaps::None => Element::NONE,
        };
        put(
            up_in,
            Route {
                overlap: overlap(EAST, east(platform)),
                continuing: routes(1 << up_out),
                from: alone(0),
                ..route(W, &[(WEST, west(platform)), (platform, Positions::NONE)], 1 << EAST)
            },
        );
        put(
            down_in,
            Route {
                overlap: overlap(WEST, west(platform)),
                continuing: routes(1 << down_out),
                from: alone(1),
                ..route(E, &[(EAST, east(platform)), (platform, Positions::NONE)], 1 << WEST)
            },
        );
        put(up_out, Route { to: alone(1), ..route(platform, &[(EAST, east(platform))], 1 << E) });
        put(down_out, Route { to: alone(0), ..route(platform, &[(WEST, west(platform))], 1 << W) });
    }
    plan.points = [Point { detectors: circuits(1 << WEST) }, Point { detectors: circuits(1 << EAST) }];
    plan.segments = [segment(W, 1 << WEST), segment(E, 1 << EAST)];
    checked("passing loop", ground, &plan)
}

/// The passing loop without overlaps, where a train in platform two also stands in the way of one in the western throat: the joint between them is
/// too near to the point. Whoever runs over one of the two proves the other clear.
pub fn short_joint() -> Station {
    use loop_route::{DOWN_IN_TWO, DOWN_OUT_ONE, UP_IN_ONE};
    use passing::{TWO, WEST};
    let loop_of_one = passing_loop(Overlaps::None);
    let mut ground = loop_of_one.ground;
    ground.fouls = vec![(WEST, TWO)];
    let mut plan = *loop_of_one.layout.plan();
    for (route, place, beside) in [(UP_IN_ONE, 0, TWO), (DOWN_OUT_ONE, 0, TWO), (DOWN_IN_TWO, 1, WEST)] {
        plan.routes[usize::from(route)].path[place].beside = circuits(1 << beside);
    }
    checked("passing loop with a short joint", ground, &plan)
}
