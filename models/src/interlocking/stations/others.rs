//! The junction, the crossing, the terminus, the siding, and the stations with a counted line and with a berth.

use super::{PLACES, alone, both, checked, circuits, edge, over, plan, positions, route, routes, segment, signal};
use crate::interlocking::ground::{Edge, Ground, Heading, Signal, Station};
use Heading::{Down, Up};
use Position::{Normal, Reverse};
use atc_kernel::interlocking::{Element, Point, Position, Positions, Route, SpeedCode};
use atc_kernel::time::Ticks;

/// Circuits of the junction.
pub mod fork {
    /// Plain line, the main way in.
    pub const M: u8 = 0;
    /// Where both ways join, with point 0.
    pub const JOIN: u8 = 1;
    /// Plain line out.
    pub const E: u8 = 2;
    /// Plain line, the branch.
    pub const B: u8 = 3;
    /// The circuit of point 1, which catches what slides past the branch's signal.
    pub const TRAP: u8 = 4;
    /// The sand behind point 1.
    pub const SAND: u8 = 5;
}

/// The main route of the junction.
pub const MAIN: u8 = 0;
/// The branch's route.
pub const BRANCH: u8 = 1;

/// A junction: a main way and a branch, each into the same line; the main route asks for the trap as its flank.
pub fn junction() -> Station {
    use fork::{B, E, JOIN, M, SAND, TRAP};
    let ground = Ground {
        circuits: &["M", "join", "E", "B", "trap", "sand"],
        edges: vec![
            over(M, JOIN, Up, 0, Normal),
            edge(JOIN, E, Up),
            edge(B, TRAP, Up),
            Edge { over: [Some((1, Normal)), Some((0, Reverse))], ..edge(TRAP, JOIN, Up) },
            over(TRAP, SAND, Up, 1, Reverse),
        ],
        signals: vec![signal(M, Up, 1 << MAIN), Signal { slide: 2, ..signal(B, Up, 1 << BRANCH) }],
        points_in: [JOIN, TRAP],
        fouls: Vec::new(),
        line: 1 << M | 1 << B | 1 << E,
        ends: vec![(E, Up)],
        turning: 0,
        waits: 0,
        catching: 1 << TRAP | 1 << SAND | 1 << JOIN,
    };
    let mut plan = plan(6);
    let (main, branch) = (positions(1, 2), positions(0, 1));
    plan.routes[usize::from(MAIN)] = Route { to: alone(0), ..route(M, &[(JOIN, main)], 1 << E) };
    plan.routes[usize::from(BRANCH)] =
        Route { to: alone(0), ..route(B, &[(TRAP, positions(2, 0)), (JOIN, branch)], 1 << E) };
    plan.points = [Point { detectors: circuits(1 << JOIN) }, Point { detectors: circuits(1 << TRAP) }];
    plan.segments[0] = segment(E, 1 << JOIN);
    checked("junction", ground, &plan)
}

/// Circuits of the crossing.
pub mod diamond {
    /// Plain line to `OVER`.
    pub const A: u8 = 0;
    /// One track of the crossing.
    pub const OVER: u8 = 1;
    /// Plain line from `OVER`.
    pub const X: u8 = 2;
    /// Plain line to `UNDER`.
    pub const B: u8 = 3;
    /// The other track of the crossing.
    pub const UNDER: u8 = 4;
    /// Plain line from `UNDER`.
    pub const Y: u8 = 5;
}

/// Two lines that cross on the level, each with a circuit of its own over the crossing.
pub fn crossing() -> Station {
    use diamond::{A, B, OVER, UNDER, X, Y};
    let ground = Ground {
        circuits: &["A", "over", "X", "B", "under", "Y"],
        edges: vec![edge(A, OVER, Up), edge(OVER, X, Up), edge(B, UNDER, Up), edge(UNDER, Y, Up)],
        signals: vec![signal(A, Up, 1), signal(B, Up, 2)],
        points_in: [OVER, UNDER],
        fouls: vec![(OVER, UNDER)],
        line: 1 << A | 1 << B | 1 << X | 1 << Y,
        ends: vec![(X, Up), (Y, Up)],
        turning: 0,
        waits: 0,
        catching: 0,
    };
    let mut plan = plan(6);
    plan.routes[0] = Route { to: alone(0), conflicts: routes(2), ..route(A, &[(OVER, Positions::NONE)], 1 << X) };
    plan.routes[1] = Route { to: alone(1), conflicts: routes(1), ..route(B, &[(UNDER, Positions::NONE)], 1 << Y) };
    plan.segments = [segment(X, 1 << OVER), segment(Y, 1 << UNDER)];
    checked("crossing", ground, &plan)
}

/// Circuits of the terminus.
pub mod end {
    /// Plain line.
    pub const L: u8 = 0;
    /// The throat, with point 0.
    pub const THROAT: u8 = 1;
    /// The first platform.
    pub const ONE: u8 = 2;
    /// The second platform.
    pub const TWO: u8 = 3;
}

/// A terminus: one line, two platforms. Routes 0 and 1 lead into platforms one and two, routes 2 and 3 out of them.
pub fn terminus() -> Station {
    use end::{L, ONE, THROAT, TWO};
    let edges = [edge(L, THROAT, Up), over(THROAT, ONE, Up, 0, Normal), over(THROAT, TWO, Up, 0, Reverse)];
    let ground = Ground {
        circuits: &["L", "throat", "one", "two"],
        edges: both(&edges),
        signals: vec![signal(L, Up, 0b11), signal(ONE, Down, 0b100), signal(TWO, Down, 0b1000)],
        points_in: [THROAT, THROAT],
        fouls: Vec::new(),
        line: 1 << L,
        ends: vec![(L, Down)],
        turning: 1 << ONE | 1 << TWO,
        waits: 0,
        catching: 0,
    };
    let mut plan = plan(4);
    for (number, platform, way) in [(0, ONE, positions(1, 0)), (1, TWO, positions(0, 1))] {
        let path = [(THROAT, way), (platform, Positions::NONE)];
        plan.routes[number] = Route { from: alone(0), ..route(L, &path, 1 << THROAT) };
        plan.routes[number + 2] = Route { to: alone(0), ..route(platform, &[(THROAT, way)], 1 << L) };
    }
    plan.points[0] = Point { detectors: circuits(1 << THROAT) };
    plan.segments[0] = segment(L, 1 << THROAT);
    checked("terminus", ground, &plan)
}

/// Circuits of the siding.
pub mod rest {
    /// Plain line.
    pub const L: u8 = 0;
    /// The way in.
    pub const THROAT: u8 = 1;
    /// The first half.
    pub const FIRST: u8 = 2;
    /// The second half, where trains end.
    pub const SECOND: u8 = 3;
}

/// A siding of two circuits, with one route of three places into it and no point.
pub fn siding() -> Station {
    use rest::{FIRST, L, SECOND, THROAT};
    let ground = Ground {
        circuits: &["L", "throat", "first", "second"],
        edges: vec![edge(L, THROAT, Up), edge(THROAT, FIRST, Up), edge(FIRST, SECOND, Up)],
        signals: vec![signal(L, Up, 1)],
        points_in: [THROAT, THROAT],
        fouls: Vec::new(),
        line: 1 << L,
        ends: vec![(SECOND, Up)],
        turning: 0,
        waits: 0,
        catching: 0,
    };
    let mut plan = plan(4);
    let path = [THROAT, FIRST, SECOND].map(|circuit| (circuit, Positions::NONE));
    plan.routes[0] = Route { from: alone(0), ..route(L, &path, 1 << FIRST) };
    plan.segments[0] = segment(L, 1 << THROAT);
    checked("siding", ground, &plan)
}

/// Circuits of the station with a long track.
pub mod reversal {
    /// Plain line.
    pub const L: u8 = 0;
    /// The throat.
    pub const THROAT: u8 = 1;
    /// The half of the track before the signal out.
    pub const NEAR: u8 = 2;
    /// The other half, where trains turn round.
    pub const FAR: u8 = 3;
}

/// A track of two circuits, where trains turn round behind the one with the signal. The routes are [`IN`] and [`OUT`].
pub fn long_track() -> Station {
    use reversal::{FAR, L, NEAR, THROAT};
    let ground = Ground {
        circuits: &["L", "throat", "near", "far"],
        edges: both(&[edge(L, THROAT, Up), edge(THROAT, NEAR, Up), edge(NEAR, FAR, Up)]),
        signals: vec![
            signal(L, Up, 1 << IN),
            Signal { counted_on: 1 << NEAR | 1 << FAR, ..signal(NEAR, Down, 1 << OUT) },
        ],
        points_in: [THROAT, THROAT],
        fouls: Vec::new(),
        line: 1 << L,
        ends: vec![(L, Down)],
        turning: 1 << FAR,
        waits: 1 << FAR,
        catching: 0,
    };
    let mut plan = plan(4);
    let path = [THROAT, NEAR, FAR].map(|circuit| (circuit, Positions::NONE));
    plan.routes[usize::from(IN)] = Route { from: alone(0), ..route(L, &path, 1 << NEAR) };
    let out = route(NEAR, &[(THROAT, Positions::NONE)], 1 << L);
    plan.routes[usize::from(OUT)] = Route { to: alone(0), approach: circuits(1 << NEAR | 1 << FAR), ..out };
    plan.segments[0] = segment(L, 1 << THROAT);
    checked("long track", ground, &plan)
}

/// Circuits of the station with a counted line. The first two are the sections of the line.
pub mod counted {
    /// The section where trains come in.
    pub const FAR: u8 = 0;
    /// The section at the station.
    pub const NEAR: u8 = 1;
    /// The throat, with point 0.
    pub const THROAT: u8 = 2;
    /// The first platform, where trains end.
    pub const ONE: u8 = 3;
    /// The second platform, where trains end.
    pub const TWO: u8 = 4;
}

/// A line of two sections, and two platforms where trains end. Routes 0 and 1 lead into platforms one and two.
pub fn counted_line() -> Station {
    use counted::{FAR, NEAR, ONE, THROAT, TWO};
    let ground = Ground {
        circuits: &["far", "near", "throat", "one", "two"],
        edges: vec![
            edge(FAR, NEAR, Up),
            edge(NEAR, THROAT, Up),
            over(THROAT, ONE, Up, 0, Normal),
            over(THROAT, TWO, Up, 0, Reverse),
        ],
        signals: vec![signal(NEAR, Up, 0b11)],
        points_in: [THROAT, THROAT],
        fouls: Vec::new(),
        line: 1 << FAR | 1 << NEAR,
        ends: vec![(ONE, Up), (TWO, Up)],
        turning: 0,
        waits: 0,
        catching: 0,
    };
    let mut plan = plan(5);
    for (number, platform, way) in [(0, ONE, positions(1, 0)), (1, TWO, positions(0, 1))] {
        let path = [(THROAT, way), (platform, Positions::NONE)];
        plan.routes[number] = Route { from: alone(0), ..route(NEAR, &path, 1 << THROAT) };
    }
    plan.points[0] = Point { detectors: circuits(1 << THROAT) };
    let mut line = segment(NEAR, 1 << THROAT);
    (line.circuits[1], line.length) = (circuits(1 << FAR), 2);
    plan.segments[0] = line;
    checked("counted line", ground, &plan)
}

/// Circuits of the halt.
pub mod stop {
    /// Plain line, as far as the halt sees it.
    pub const L: u8 = 0;
    /// The throat, where trains end that come in.
    pub const THROAT: u8 = 1;
    /// The platform, where trains begin.
    pub const PLATFORM: u8 = 2;
}

/// The halt's route from the line.
pub const IN: u8 = 0;
/// Its route out to the line.
pub const OUT: u8 = 1;

/// One end of a line: a way in over the throat, and a way out from a platform over the same throat.
pub fn halt() -> Station {
    use stop::{L, PLATFORM, THROAT};
    let ground = Ground {
        circuits: &["line", "throat", "platform"],
        edges: vec![edge(L, THROAT, Up), edge(PLATFORM, THROAT, Down), edge(THROAT, L, Down)],
        signals: vec![signal(L, Up, 1 << IN), signal(PLATFORM, Down, 1 << OUT)],
        points_in: [THROAT, THROAT],
        fouls: Vec::new(),
        line: 1 << L,
        ends: vec![(THROAT, Up), (L, Down)],
        turning: 0,
        waits: 0,
        catching: 0,
    };
    let mut plan = plan(3);
    let throat = [(THROAT, Positions::NONE)];
    plan.routes[usize::from(IN)] = Route { from: alone(0), ..route(L, &throat, 1 << PLATFORM) };
    plan.routes[usize::from(OUT)] = Route { to: alone(0), ..route(PLATFORM, &throat, 1 << L) };
    plan.segments[0] = segment(L, 1 << THROAT);
    checked("halt", ground, &plan)
}

/// Circuits of the station with a berth.
pub mod called {
    /// Plain line in the west.
    pub const W: u8 = 0;
    /// The western throat.
    pub const WEST: u8 = 1;
    /// The berth.
    pub const BERTH: u8 = 2;
    /// The eastern throat.
    pub const EAST: u8 = 3;
    /// Plain line in the east.
    pub const E: u8 = 4;
}

/// Numbers of the routes of the station with a berth.
pub mod berth_route {
    /// W into the berth, which must be clear.
    pub const UP_IN: u8 = 0;
    /// W to the berth, where a train stands: the calling-on route.
    pub const CALL: u8 = 1;
    /// The berth to E.
    pub const UP_OUT: u8 = 2;
    /// E into the berth.
    pub const DOWN_IN: u8 = 3;
    /// The berth to W.
    pub const DOWN_OUT: u8 = 4;
}

/// A track between two signals, in which a train may be called on to another one. Who slides past either signal is caught by an overlap.
pub fn berth() -> Station {
    use berth_route::{CALL, DOWN_IN, DOWN_OUT, UP_IN, UP_OUT};
    use called::{BERTH, E, EAST, W, WEST};
    let ground = Ground {
        circuits: &["W", "west", "berth", "east", "E"],
        edges: both(&[edge(W, WEST, Up), edge(WEST, BERTH, Up), edge(BERTH, EAST, Up), edge(EAST, E, Up)]),
        signals: vec![
            signal(W, Up, 1 << UP_IN | 1 << CALL),
            Signal { slide: 1, ..signal(BERTH, Up, 1 << UP_OUT) },
            signal(E, Down, 1 << DOWN_IN),
            Signal { slide: 1, ..signal(BERTH, Down, 1 << DOWN_OUT) },
        ],
        points_in: [WEST, WEST],
        fouls: Vec::new(),
        line: 1 << W | 1 << E,
        ends: vec![(E, Up), (W, Down)],
        turning: 0,
        waits: 0,
        catching: 0,
    };
    let only = |circuit: u8| Element { circuits: circuits(1 << circuit), ..Element::NONE };
    let at = |circuit: u8| (circuit, Positions::NONE);
    let mut plan = plan(5);
    let mut put = |number: u8, route: Route<PLACES>| {
        plan.routes[usize::from(number)] = Route { stay: Ticks(2), ..route };
    };
    let (up, down) = (routes(1 << UP_OUT), routes(1 << DOWN_OUT));
    let beside = 1 << WEST | 1 << EAST;
    let up_in = route(W, &[at(WEST), at(BERTH)], beside);
    put(UP_IN, Route { overlap: only(EAST), continuing: up, from: alone(0), ..up_in });
    let call =
        Route { overlap: only(BERTH), calling_on: true, speed: SpeedCode(1), ..route(W, &[at(WEST)], 1 << BERTH) };
    put(CALL, Route { from: alone(0), ..call });
    put(UP_OUT, Route { to: alone(1), ..route(BERTH, &[at(EAST)], 1 << E) });
    let down_in = route(E, &[at(EAST), at(BERTH)], beside);
    put(DOWN_IN, Route { overlap: only(WEST), continuing: down, from: alone(1), ..down_in });
    put(DOWN_OUT, Route { to: alone(0), ..route(BERTH, &[at(WEST)], 1 << W) });
    plan.segments = [segment(W, 1 << WEST), segment(E, 1 << EAST)];
    checked("station with a berth", ground, &plan)
}
