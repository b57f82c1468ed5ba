//! Two routes, and three: what may be held together (T-ILK-1).

use super::any::{
    PATH, any_circuits, any_layout, any_positions, any_route_state, any_routes_layout, any_segments, any_unswept, bit,
    held, kept,
};
use crate::Engine;
use atc_kernel::interlocking::{CircuitSet, Layout, Phase, PointSet, Route, RouteState, Sight, Ways, refuse_route};

pub const BOUND: &str = match PATH {
    4 => "2 routes of up to 4 circuits, 32 circuits, 16 points",
    8 => "2 routes of up to 8 circuits, 32 circuits, 16 points",
    _ => "2 routes of another number of circuits than the 16 of the machine",
};

/// The places of a path where Kani has no answer for all of them in its time.
const FEWER: usize = if cfg!(kani) && PATH > 2 { 2 } else { PATH };

/// What the conflict check sees besides the routes: anything.
fn any_sight<E: Engine + ?Sized>(e: &mut E) -> Sight {
    Sight {
        occupied: any_circuits(e, "occupied (bits)", 0..=0),
        blocked: any_circuits(e, "blocked (bits)", 0..=0),
        closed: any_segments(e, "segments with a blocked circuit (bits)"),
        detected: any_positions(e),
        under: PointSet::from_bits(u32::from(e.word("points under a train (bits)", 0..=1))),
        directions: (
            any_segments(e, "segments towards the station (bits)"),
            any_segments(e, "segments away from it (bits)"),
        ),
        from_before: any_unswept(e),
        ways: Ways {
            points: PointSet::from_bits(u32::from(e.word("points of trains from before the start (bits)", 0..=0))),
            ..Ways::default()
        },
    }
}

/// One of two routes is asked for, while the other is in any state.
pub(super) struct TwoRoutes<const P: usize, const N: usize> {
    pub layout: Layout<2, P, N, 0>,
    pub asked: usize,
    pub other: usize,
    /// The state of the other one.
    pub state: RouteState,
    pub sight: Sight,
    pub reserved: bool,
    /// A circuit that stands for all.
    pub circuit: u64,
}

/// Any two routes of any layout, and any request for one.
pub(super) fn any_two<E: Engine + ?Sized, const P: usize, const N: usize>(e: &mut E) -> Option<TwoRoutes<P, N>> {
    let layout = any_layout::<E, 2, P, N, 0>(e)?;
    let asked = e.choose("the route that is asked for", 2);
    let other = 1 - asked;
    let state = any_route_state(e);
    let valid = state.is_valid(&layout.plan().routes[other]);
    e.assume(valid);
    let mut states = [RouteState::IDLE; 2];
    states[other] = state;
    let sight = any_sight(e);
    let reserved = refuse_route(&layout, &states, asked, sight).is_none();
    let circuit = bit(e.word("a circuit that stands for all (number)", 0..=15));
    Some(TwoRoutes { layout, asked, other, state, sight, reserved, circuit })
}

/// Whether two routes may hold what they hold, for one circuit and one point that stand for all. The reserved one holds everything.
#[allow(clippy::struct_excessive_bools, reason = "one for each claim")]
struct Together {
    paths: bool,
    overlaps: bool,
    continuing: bool,
    points: bool,
    conflicts: bool,
}

fn together<const P: usize>(
    (reserved, number): (&Route<P>, u64),
    (other, state, number_of_other): (&Route<P>, RouteState, u64),
    (circuit, point): (u64, u64),
) -> Together {
    let mine = (held(reserved, RouteState::RESERVED), kept(reserved, RouteState::RESERVED));
    let its = (held(other, state), kept(other, state));
    let is_in = |set: CircuitSet| set.bits() & circuit != 0;
    let needs = |one: PointSet, other: PointSet| (u64::from(one.bits()) | u64::from(other.bits())) & point != 0;
    let normal = (
        needs(mine.0.positions.normal, mine.1.positions.normal),
        needs(its.0.positions.normal, its.1.positions.normal),
    );
    let reverse = (
        needs(mine.0.positions.reverse, mine.1.positions.reverse),
        needs(its.0.positions.reverse, its.1.positions.reverse),
    );
    let held = state.phase != Phase::Idle;
    let stands = held && !state.overlap && other.length.checked_sub(1) == Some(state.tail);
    Together {
        paths: !(is_in(mine.0.circuits) && is_in(its.0.circuits)),
        overlaps: !(is_in(mine.1.circuits) && is_in(its.1.circuits)),
        continuing: (!(is_in(mine.0.circuits) && is_in(its.1.circuits)) || other.continuing.bits() & number != 0)
            && (!(is_in(mine.1.circuits) && is_in(its.0.circuits))
                || reserved.continuing.bits() & number_of_other != 0
                || reserved.calling_on && stands),
        points: !(normal.0 && reverse.1 || reverse.0 && normal.1),
        conflicts: !held || reserved.conflicts.bits() & number_of_other == 0 && other.conflicts.bits() & number == 0,
    }
}

harness! {
    /// A route is reserved only if it can be held together with what another route holds, whatever that has released already; if all
    /// of it is clear, unblocked and has its direction; and if no point of it would have to move under a train or in a
    /// blocked circuit.
    t_ilk_1(e)
    theorem "T-ILK-1";
    requirements ["ILK-1", "ILK-2", "ILK-33", "ILK-34", "ATC-10"];
    assumptions [];
    bound BOUND;
    cases 2;
    unwind 65 = 1 + crate::interlocking::LONGEST;
    apart [0 1];
    under_kani "2 routes of up to 2 circuits, 32 circuits, 16 points";
    claims {
        Paths: "no circuit is in the held paths of both",
        Overlaps: "no circuit is in the held overlaps of both",
        Continuing: "a circuit is in the path of one and the overlap of the other only where the first continues the second, or has nothing left but its last circuit, with its overlap given up, and the second is a calling-on route that is asked for",
        Points: "no point is needed in normal position by one and in reverse by the other",
        Conflicts: "neither is declared to conflict with the other while both are held, and if they start from one circuit they lead the same way",
        Clear: "no circuit of path or overlap is occupied or blocked, no segment that the route leads to is blocked, and no circuit of the approach with a train behind the entry; but the berth of a calling-on route is occupied, and its entry",
        Direction: "every segment that the route needs has the direction that it needs",
        Moves: "a point that is not detected in position has no train on it, and is in no blocked circuit",
    }
    covers {
        Both: "a route is reserved while the other is held",
        Under: "a route is reserved over the overlap that another holds",
        Berth: "a calling-on route is reserved into a circuit that another still holds",
    }
    {
        // One point has detectors; the others are positions only.
        let Some(TwoRoutes { layout, asked, other, state, sight, reserved, circuit }) = any_two::<E, FEWER, 1>(e) else { return };
        let routes = &layout.plan().routes;
        let numbers = if asked == 0 { (1, 2) } else { (2, 1) };
        let point = bit(e.word("a point that stands for all (number)", 0..=1));
        let pair = together((&routes[asked], numbers.0), (&routes[other], state, numbers.1), (circuit, point));
        e.claim(Claim::Paths as u32, !reserved || pair.paths);
        e.claim(Claim::Overlaps as u32, !reserved || pair.overlaps);
        e.claim(Claim::Continuing as u32, !reserved || pair.continuing);
        e.claim(Claim::Points as u32, !reserved || pair.points);
        let starts = state.phase != Phase::Idle && routes[asked].entry.bits() & routes[other].entry.bits() & circuit != 0;
        let same = !starts || routes[asked].heading == routes[other].heading;
        e.claim(Claim::Conflicts as u32, !reserved || pair.conflicts && same);
        let route = &routes[asked];
        let mine = (held(route, RouteState::RESERVED), kept(route, RouteState::RESERVED));
        let ahead = (mine.0.circuits.bits() | mine.1.circuits.bits()) & circuit;
        let behind = route.approach.bits() & !route.entry.bits() & sight.occupied.bits() != 0;
        let cut_off = behind && route.approach.bits() & sight.blocked.bits() != 0;
        let blocked = ahead & sight.blocked.bits() != 0 || route.to.bits() & sight.closed.bits() != 0 || cut_off;
        let clear = if route.calling_on { mine.0.circuits.bits() & circuit } else { ahead };
        let called = route.entry.bits() & sight.occupied.bits() != 0 && mine.1.circuits.bits() & sight.occupied.bits() != 0;
        let may = clear & sight.occupied.bits() == 0 && !blocked && (called || !route.calling_on);
        e.claim(Claim::Clear as u32, !reserved || may);
        let missing = route.from.bits() & !sight.directions.0.bits() | route.to.bits() & !sight.directions.1.bits();
        e.claim(Claim::Direction as u32, !reserved || missing == 0);
        let normal = mine.0.positions.normal.bits() | mine.1.positions.normal.bits();
        let reverse = mine.0.positions.reverse.bits() | mine.1.positions.reverse.bits();
        let moves = normal & !sight.detected.normal.bits() | reverse & !sight.detected.reverse.bits();
        let mut shut = 0;
        for (number, point) in layout.plan().points.iter().enumerate() {
            shut |= u32::from(point.detectors.bits() & sight.blocked.bits() != 0) << number;
        }
        e.claim(Claim::Moves as u32, !reserved || u64::from(moves & (sight.under.bits() | shut)) & point == 0);
        let both = reserved && state.phase != Phase::Idle;
        e.cover(Cover::Both as u32, both);
        e.cover(Cover::Under as u32, both && mine.0.circuits.bits() & kept(&routes[other], state).circuits.bits() & circuit != 0);
        let shared = mine.1.circuits.bits() & held(&routes[other], state).circuits.bits() & circuit != 0;
        e.cover(Cover::Berth as u32, both && route.calling_on && shared);
    }
}

harness! {
    /// A third route hides nothing, and adds nothing: a route is reserved beside two others exactly if it would be reserved beside either.
    t_ilk_1_three(e)
    theorem "T-ILK-1";
    requirements ["ILK-1", "ILK-2"];
    assumptions [];
    bound "3 routes of 1 circuit, 32 circuits, 16 points";
    cases 3;
    unwind 65 = 1 + crate::interlocking::LONGEST;
    apart [0 1 2];
    claims {
        Neither: "a route is reserved beside two others only if it would be beside either of them",
        Both: "and it is if it would be beside either of them",
    }
    covers {
        All: "a route is reserved while both others are held",
    }
    {
        let Some(layout) = any_routes_layout::<E, 3, 1>(e) else { return };
        let asked = e.choose("the route that is asked for", 3);
        let others = match asked { 0 => [1, 2], 1 => [0, 2], _ => [0, 1] };
        let routes = &layout.plan().routes;
        let mut states = [RouteState::IDLE; 3];
        let mut valid = true;
        for other in others {
            states[other] = any_route_state(e);
            valid &= states[other].is_valid(&routes[other]);
        }
        e.assume(valid);
        let sight = any_sight(e);
        let reserved = refuse_route(&layout, &states, asked, sight).is_none();
        let without = |other: usize| {
            let mut fewer = states;
            fewer[other] = RouteState::IDLE;
            refuse_route(&layout, &fewer, asked, sight).is_none()
        };
        let either = without(others[0]) && without(others[1]);
        e.claim(Claim::Neither as u32, !reserved || either);
        e.claim(Claim::Both as u32, reserved || !either);
        let held = states[others[0]].phase != Phase::Idle && states[others[1]].phase != Phase::Idle;
        e.cover(Cover::All as u32, reserved && held);
    }
}
