//! What the models of the interlocking share: conditions, requests, trains, and who meets whom.

use crate::catalogue::about::{Conditions, all_but};
use crate::check::{About, Entry};
use crate::interlocking::Purpose;
use crate::interlocking::device::Real;
use crate::interlocking::environment::{Environment, Start};
use crate::interlocking::ground::{Heading, Station};
use crate::interlocking::stations::{SmallPlan, diamond, end, fork, loop_route, passing};
use crate::interlocking::yard::Yard;
use atc_kernel::interlocking::{PointId, Position, Request, RouteId, SegmentId, Travel};
use atc_kernel::time::Ticks;

/// What all models assume that do not lift it.
pub(super) const ALL: [&str; 13] = [
    "loss-of-shunt-within-clear",
    "approach-covers-braking",
    "release-covers-residual-running",
    "overlap-covers-sliding",
    "flank-complete",
    "fouling-declared",
    "path-complete",
    "points-detect-truly",
    "points-leave-while-driven",
    "trains-obey-signals",
    "neighbour-turns-alike",
    "turn-outlasts-telegrams",
    "views-of-a-line-meet",
];

/// All but the one at `place`.
pub(super) const fn without(place: usize) -> [&'static str; ALL.len() - 1] {
    all_but(ALL, place)
}

pub(super) const SOUND: Conditions = (&ALL, &[]);

pub(super) const ROUTES: &[&str] =
    &["ILK-1", "ILK-5", "ILK-6", "ILK-7", "ILK-8", "ILK-9", "ILK-10", "ILK-12", "ILK-13", "ILK-17", "ILK-18", "ATC-1"];

pub(super) const POINTS: &[&str] = &["ILK-1", "ILK-5", "ILK-6", "ILK-7", "ILK-8"];

/// A station with the kernel's device.
pub(super) fn yard(about: About, station: Station, environment: Environment, purpose: Purpose) -> Entry {
    Entry::new(about, Yard::new(Real, station, environment, purpose))
}

fn set(route: u8) -> Request {
    Request::Set(RouteId::new(route).expect("a route"))
}

fn withdraw(route: u8) -> Request {
    Request::Withdraw(RouteId::new(route).expect("a route"))
}

pub(super) fn turn(segment: u8, travel: Travel) -> Request {
    Request::Turn(SegmentId::new(segment).expect("a segment"), travel)
}

/// Requests to drive a point either way.
pub(super) fn drives(point: u8) -> Vec<Request> {
    let point = PointId::new(point).expect("a point");
    [Position::Normal, Position::Reverse].map(|position| Request::Drive(point, position)).into()
}

/// Requests to set these routes.
pub(super) fn sets(routes: &[u8]) -> Vec<Request> {
    routes.iter().map(|route| set(*route)).collect()
}

/// Requests to set and to withdraw these routes.
pub(super) fn dispatch(routes: &[u8]) -> Vec<Request> {
    routes.iter().flat_map(|route| [set(*route), withdraw(*route)]).collect()
}

/// Requests to turn each of these segments either way.
pub(super) fn turns(segments: &[u8]) -> Vec<Request> {
    segments.iter().flat_map(|segment| [turn(*segment, Travel::Toward), turn(*segment, Travel::Away)]).collect()
}

/// A change of a plan: this stay time for every route.
pub(super) fn stay(cycles: u16) -> impl Fn(&mut SmallPlan) {
    move |plan| plan.routes.iter_mut().filter(|route| route.exists()).for_each(|route| route.stay = Ticks(cycles))
}

/// A train from W in the passing loop.
pub(super) const UP: Start = Start { at: passing::W, heading: Heading::Up, segment: Some(0) };

/// A train from E in the passing loop.
pub(super) const DOWN: Start = Start { at: passing::E, heading: Heading::Down, segment: Some(1) };

/// A train of the terminus.
pub(super) const IN_AND_OUT: Start = Start { at: end::L, heading: Heading::Up, segment: Some(0) };

/// A train on the main way of the junction.
pub(super) const MAIN: Start = Start { at: fork::M, heading: Heading::Up, segment: None };

/// A train on the branch.
pub(super) const BRANCH: Start = Start { at: fork::B, heading: Heading::Up, segment: None };

/// A train over one track of the crossing.
pub(super) const OVER: Start = Start { at: diamond::A, heading: Heading::Up, segment: None };

/// A train over the other.
pub(super) const UNDER: Start = Start { at: diamond::B, heading: Heading::Up, segment: None };

/// The routes of a train from W over platform one and of a train from E over platform two.
pub(super) const PASSING: [u8; 4] =
    [loop_route::UP_IN_ONE, loop_route::UP_OUT_ONE, loop_route::DOWN_IN_TWO, loop_route::DOWN_OUT_TWO];

/// The routes of trains from W over both platforms.
const FOLLOWING: [u8; 4] =
    [loop_route::UP_IN_ONE, loop_route::UP_OUT_ONE, loop_route::UP_IN_TWO, loop_route::UP_OUT_TWO];

/// Two trains that meet in the passing loop, each with its own platform; both segments are turned.
pub(super) fn meeting() -> Environment {
    Environment { requests: [dispatch(&PASSING), turns(&[0, 1])].concat(), ..Environment::usual(vec![UP, DOWN]) }
}

/// Trains that follow each other from W to E.
pub(super) fn following(trains: usize) -> Environment {
    Environment {
        before: vec![turn(0, Travel::Toward), turn(1, Travel::Away)],
        requests: dispatch(&FOLLOWING),
        ..Environment::usual(vec![UP; trains])
    }
}
