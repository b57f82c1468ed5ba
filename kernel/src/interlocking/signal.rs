//! Signals and grants: which routes show proceed, and which circuits each route grants to which train.

use super::code::SpeedCode;
use super::layout::{Layout, Route};
use super::route::{Phase, RouteState};
use super::set::{CircuitSet, Positions, RouteSet, SegmentSet};
use super::size::{Size, Small};
use crate::heading::Heading;

/// What the signals look at, at the end of the interlocking's part of the cycle.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct View<Z: Size = Small> {
    /// The circuits that count as occupied.
    pub occupied: CircuitSet<Z>,
    /// The circuits that are blocked.
    pub blocked: CircuitSet<Z>,
    /// The segments into which nobody may be sent: one with a blocked circuit, or where the neighbour does not permit it.
    pub closed: SegmentSet<Z>,
    /// The positions that count as detected: none of a point that is driven, or has not stood since.
    pub firm: Positions<Z>,
}

/// The circuits of a route that one train may run over.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Grant<Z: Size = Small> {
    /// The circuit of the train's front, or the one from which the route is entered. None: nothing is granted.
    pub train: CircuitSet<Z>,
    /// The circuits that are granted, in the path's order. None of them, to a train whose front is in the last circuit of a route out: it may
    /// go on to the line that the route leads to, as far as that is free.
    pub circuits: CircuitSet<Z>,
    /// The last of them; without any, the train's.
    pub last: CircuitSet<Z>,
    /// Whether the last one is the end of the route.
    pub complete: bool,
    /// The direction of travel that it is for.
    pub heading: Heading,
    /// The highest speed code on the route.
    pub speed: SpeedCode,
}

impl<Z: Size> Grant<Z> {
    /// Nothing is granted.
    pub const NONE: Self = Self {
        train: CircuitSet::EMPTY,
        circuits: CircuitSet::EMPTY,
        last: CircuitSet::EMPTY,
        complete: false,
        heading: Heading::Right,
        speed: SpeedCode::STOP,
    };
}

/// Whether the signal of a route shows proceed.
#[inline]
pub fn shows_proceed<const P: usize, Z: Size>(route: &Route<P, Z>, state: RouteState, view: View<Z>) -> bool {
    //= spec/interlocking.md#ilk-7-aspect
    //# A signal MUST show proceed only while its route is set, every point that the route holds is detected in position, locked and undriven, path and overlap are clear (a berth need not be) and unblocked, no circuit of its approach is blocked while one of it behind the entry is occupied, and no circuit of a segment that it leads to is blocked.
    state.phase == Phase::Set && ready(route, state, view)
}

/// Whether all that the route holds is detected, clear and unblocked.
#[inline]
pub fn ready<const P: usize, Z: Size>(route: &Route<P, Z>, state: RouteState, view: View<Z>) -> bool {
    let circuits = state.circuits(route);
    let clear = if route.calling_on { state.path(route).circuits } else { circuits };
    //= spec/interlocking.md#ilk-37-proved-clear
    //# While a circuit beside what a route needs is occupied or blocked, the route MUST be refused, its signal show stop, and no place beside it be granted; and no block there be confirmed.
    let beside = state.beside(route);
    !clear.or(beside).meets(view.occupied)
        && !circuits.or(beside).meets(view.blocked)
        && !route.is_approached_over(view.blocked, view.occupied)
        && !route.to.meets(view.closed)
        && state.positions(route).missing_in(view.firm).is_empty()
}

/// What a route grants.
#[inline]
pub fn grant<const P: usize, Z: Size>(route: &Route<P, Z>, state: RouteState, view: View<Z>) -> Grant<Z> {
    //= spec/interlocking.md#atc-1-grant
    //# A route MUST grant its path to the train at its entry circuit while its signal shows proceed, and after that the sound circuits beyond the last occupied one to the train there, if it has entered that one in order and its points are sound too; and nothing otherwise.
    granted(route, state, view, shows_proceed(route, state, view))
}

/// What a route grants whose signal shows proceed, or not.
#[inline]
fn granted<const P: usize, Z: Size>(route: &Route<P, Z>, state: RouteState, view: View<Z>, proceed: bool) -> Grant<Z> {
    if !state.is_held() {
        return Grant::NONE;
    }
    let entered = state.phase == Phase::InUse && state.head > 0;
    let mut train = route.entry.only_if(proceed);
    let mut circuits = CircuitSet::EMPTY;
    let mut last = CircuitSet::EMPTY;
    // Whether every circuit since the train's front is sound.
    let mut open = proceed;
    for (place, element) in (0_u8..).zip(Z::used(&route.path, route.length)) {
        if place < route.length && place >= state.tail {
            let sound = element.positions.missing_in(view.firm).is_empty()
                && !element.beside.meets(view.occupied.or(view.blocked));
            if entered && element.circuits.meets(view.occupied) {
                train = element.circuits;
                circuits = CircuitSet::EMPTY;
                // The front may stand before a point of its own circuit.
                open = sound && place < state.head;
            } else {
                open &= sound && !element.circuits.meets(view.blocked);
                circuits = circuits.or(element.circuits.only_if(open));
                last = if open { element.circuits } else { last };
            }
        }
    }
    let granted = Grant { train, circuits, last, complete: open, heading: route.heading, speed: route.speed };
    if circuits.is_empty() {
        // The front is in the last circuit, or may go no farther in the path.
        return if open && !route.to.is_empty() { Grant { last: train, ..granted } } else { Grant::NONE };
    }
    granted
}

/// What all routes show and grant.
#[inline]
pub(super) fn all<const R: usize, const P: usize, const N: usize, const S: usize, Z: Size>(
    layout: &Layout<R, P, N, S, Z>,
    routes: &[RouteState; R],
    view: View<Z>,
) -> (RouteSet<Z>, [Grant<Z>; R]) {
    let mut proceed = RouteSet::EMPTY;
    let mut grants = [Grant::NONE; R];
    for (number, (route, state)) in layout.plan().routes.iter().zip(routes).enumerate() {
        let shows = shows_proceed(route, *state, view);
        proceed = proceed.or(RouteSet::nth(number).only_if(shows));
        grants[number] = granted(route, *state, view, shows);
    }
    (proceed, grants)
}
