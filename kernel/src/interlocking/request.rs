//! The conflict check: what a request asks for, and why it is refused.

use super::layout::{Layout, Route};
use super::route::RouteState;
use super::set::{CircuitSet, PointId, PointSet, Position, Positions, RouteId, RouteSet, SegmentId, SegmentSet};
use super::size::{Size, Small};
use super::unswept::{Unswept, Ways};
use super::{Travel, point, route};

/// What may be asked for; one thing a cycle. Nothing that is refused is remembered.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Request {
    /// Set a route.
    Set(RouteId),
    /// Withdraw a route.
    Withdraw(RouteId),
    /// Drive one point, in this cycle.
    Drive(PointId, Position),
    /// Give a segment a direction.
    Turn(SegmentId, Travel),
}

/// Why a request is refused.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Refusal {
    /// There is no route, point or segment of this number.
    Unknown,
    /// The device has just started: a train may still count on what was before.
    Starting,
    /// The route to be set is held already.
    AlreadyHeld,
    /// The route to be withdrawn is not held.
    NotHeld,
    /// A route that is declared to conflict is held.
    Conflict,
    /// A circuit of the path, or one beside path or overlap, or the point's detector, is held by another route, or is beside one.
    PathHeld,
    /// A circuit of the overlap is held by another route.
    OverlapHeld,
    /// A point is needed or locked in another position by a route.
    PointLocked,
    /// A circuit of path or overlap, or beside them, is occupied; a berth may be.
    Occupied,
    /// A train from before the start may still be on its way over a circuit of path or overlap, or beside them, or over the point.
    Unswept,
    /// A circuit of path or overlap, or beside them, the detector of a point that must move, or a circuit of the segment that the route leads to is blocked;
    /// or one of the approach, with a train behind the entry.
    Blocked,
    /// A point must move, and a train stands on it.
    PointUnderTrain,
    /// A segment does not have the direction that the route needs, or cannot turn because of a route or a train.
    Direction,
    /// The permission to the neighbour is withdrawn, and the segment cannot be turned away yet: the neighbour's permission is missing, this
    /// station's own may still be in the air, or a circuit of the segment is blocked.
    Waiting,
    /// A calling-on route without a train that waits at its signal, or without one in its berth.
    NotCalledFor,
}

/// What the conflict check looks at besides the routes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Sight<Z: Size = Small> {
    /// The circuits that count as occupied.
    pub occupied: CircuitSet<Z>,
    /// The circuits that are blocked.
    pub blocked: CircuitSet<Z>,
    /// The segments with a blocked circuit.
    pub closed: SegmentSet<Z>,
    /// The positions that are detected.
    pub detected: Positions<Z>,
    /// The points under a train.
    pub under: PointSet<Z>,
    /// The segments towards this station, and those away from it.
    pub directions: (SegmentSet<Z>, SegmentSet<Z>),
    /// What was unswept in the cycle before.
    pub from_before: Unswept<Z>,
    /// What trains from before the start still need.
    pub ways: Ways<Z>,
}

/// Why the route of number `asked` cannot be reserved; `None` if it can.
#[inline]
pub fn refuse_route<const R: usize, const P: usize, const N: usize, const S: usize, Z: Size>(
    layout: &Layout<R, P, N, S, Z>,
    routes: &[RouteState; R],
    asked: usize,
    sight: Sight<Z>,
) -> Option<Refusal> {
    //= spec/interlocking.md#ilk-1-request
    //# A route MUST be refused if a conflicting route is held, a circuit of its path or overlap is held, occupied (a berth may be) or blocked, a circuit of its approach is blocked while one of it behind the entry is occupied, a segment that it leads to is blocked, a segment has not the direction that it needs, a point is held in the other position, or a point must move under a train or in a blocked circuit.
    let route = &layout.plan().routes[asked];
    if !route.exists() {
        return Some(Refusal::Unknown);
    }
    if routes[asked].is_held() {
        return Some(Refusal::AlreadyHeld);
    }
    let (path, overlap) = (route.held_from(0), route.overlap);
    let mut refusal = None;
    for (number, (other, state)) in layout.plan().routes.iter().zip(routes).enumerate() {
        if number != asked && state.is_held() && refusal.is_none() {
            let numbers = (RouteSet::nth(asked), RouteSet::nth(number));
            refusal = against(route, numbers, other, *state);
        }
    }
    let beside = path.beside.or(overlap.beside);
    let ahead = path.circuits.or(overlap.circuits).or(beside);
    let clear = path.circuits.or(overlap.circuits.only_if(!route.calling_on)).or(beside);
    //= spec/interlocking.md#ilk-33-calling-on
    //# A calling-on route MUST be refused unless its entry and its berth are occupied.
    let called_for = route.entry.meets(sight.occupied) && overlap.circuits.meets(sight.occupied);
    let needed = path.positions.or(overlap.positions);
    let (toward, away) = sight.directions;
    let moves = needed.missing_in(sight.detected).points();
    let shut = point::meeting(layout, sight.blocked);
    //= spec/interlocking.md#ilk-29-route-ahead
    //# A route MUST be refused if it meets what a route keeps, other than as the way on of that route's train, if a point that is kept would have to move, or if it shares nothing with a route that keeps anything and is declared to conflict with it.
    if refusal.is_some() {
        refusal
    } else if clear.meets(sight.occupied) {
        Some(Refusal::Occupied)
    } else if route.calling_on && !called_for {
        Some(Refusal::NotCalledFor)
    } else if sight.from_before.is_in_the_way(layout, asked, sight.occupied) || moves.meets(sight.ways.points) {
        Some(Refusal::Unswept)
    } else if ahead.meets(sight.blocked)
        || route.is_approached_over(sight.blocked, sight.occupied)
        || route.to.meets(sight.closed)
        || moves.meets(shut)
    {
        Some(Refusal::Blocked)
    } else if !toward.contains(route.from) || !away.contains(route.to) {
        Some(Refusal::Direction)
    } else if !moves.meets(sight.under) {
        None
    } else {
        Some(Refusal::PointUnderTrain)
    }
}

/// Why a route that was withdrawn with a train in it cannot be in use again; `None` if it can.
#[inline]
pub fn refuse_again<const P: usize, Z: Size>(
    route: &Route<P, Z>,
    state: RouteState,
    sight: Sight<Z>,
) -> Option<Refusal> {
    let ahead = state.path(route).circuits.or(state.overlap(route).circuits.only_if(route.calling_on));
    let blocked = ahead.meets(sight.blocked) || route.to.meets(sight.closed);
    blocked.then_some(Refusal::Blocked)
}

/// Why `route` cannot be reserved while `other` holds what it holds. The numbers are those of the two.
#[inline]
fn against<const P: usize, Z: Size>(
    route: &Route<P, Z>,
    (asked, number): (RouteSet<Z>, RouteSet<Z>),
    other: &Route<P, Z>,
    state: RouteState,
) -> Option<Refusal> {
    let (path, overlap) = (route.held_from(0), route.overlap);
    let (held, kept) = (state.path(other), state.overlap(other));
    //= spec/interlocking.md#ilk-2-overlaps
    //# A path and a held overlap MUST be held together over a common circuit only if the route of the path is listed as continuing at the end of the route of the overlap, and two overlaps never.
    let path_under_kept = path.circuits.meets(kept.circuits) && !other.continuing.meets(asked);
    //= spec/interlocking.md#ilk-34-who-is-in-the-berth
    //# A berth MUST be held together with the path of another route over a common circuit only if that is the last one, and the overlap of that route was given up.
    let together = route.calling_on && state.stands(other) || route.continuing.meets(number);
    let held_over_mine = overlap.circuits.meets(held.circuits) && !together;
    //= spec/interlocking.md#ilk-36-beside
    //# A path or an overlap MUST be held together with what another route has beside its own only if it is a path, and its route is listed as continuing at the end of the other.
    let (mine, theirs) = (other.continuing.meets(asked), route.continuing.meets(number));
    let fouls = route::foul((path, overlap, mine), (held, kept, theirs));
    if route.conflicts.meets(number) {
        Some(Refusal::Conflict)
    } else if path.circuits.meets(held.circuits) || path_under_kept || fouls {
        Some(Refusal::PathHeld)
    } else if overlap.circuits.meets(kept.circuits) || held_over_mine {
        Some(Refusal::OverlapHeld)
    } else if path.positions.or(overlap.positions).opposes(held.positions.or(kept.positions)) {
        Some(Refusal::PointLocked)
    } else {
        None
    }
}

/// Why a point cannot be driven on its own; `None` if it can.
#[inline]
pub fn refuse_point<const R: usize, const P: usize, const N: usize, const S: usize, Z: Size>(
    layout: &Layout<R, P, N, S, Z>,
    routes: &[RouteState; R],
    asked: PointId,
    sight: Sight<Z>,
) -> Option<Refusal> {
    //= spec/interlocking.md#ilk-3-individual-point
    //# An individual point command MUST be refused if a route holds the point or a detector circuit of it, or such a circuit is occupied or blocked.
    let it = asked.alone();
    if !point::meeting(layout, CircuitSet::ALL).meets(it) {
        return Some(Refusal::Unknown);
    }
    let mut held = (PointSet::EMPTY, CircuitSet::EMPTY);
    for (route, state) in layout.plan().routes.iter().zip(routes) {
        held.0 = held.0.or(state.positions(route).points());
        held.1 = held.1.or(state.circuits(route));
    }
    if held.0.meets(it) {
        Some(Refusal::PointLocked)
    } else if point::meeting(layout, held.1).meets(it) {
        Some(Refusal::PathHeld)
    } else if sight.under.meets(it) {
        Some(Refusal::PointUnderTrain)
    } else if sight.ways.points.meets(it) {
        Some(Refusal::Unswept)
    } else if point::meeting(layout, sight.blocked).meets(it) {
        Some(Refusal::Blocked)
    } else {
        None
    }
}
