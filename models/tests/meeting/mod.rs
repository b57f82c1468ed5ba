//! Two trains that meet in the passing loop: what the tests of the interlocking's models share.

use atc_kernel::interlocking::{Request, RouteId, SegmentId, Travel};
use atc_models::interlocking::environment::{Environment, Start};
use atc_models::interlocking::ground::Heading;
use atc_models::interlocking::stations::{loop_route, passing};

/// A train from the west.
pub const UP: Start = Start { at: passing::W, heading: Heading::Up, segment: Some(0) };
/// A train from the east.
const DOWN: Start = Start { at: passing::E, heading: Heading::Down, segment: Some(1) };

/// Sets and withdraws these routes.
pub fn dispatch(routes: &[u8]) -> Vec<Request> {
    let id = |route: &u8| RouteId::new(*route).expect("a route");
    routes.iter().flat_map(|route| [Request::Set(id(route)), Request::Withdraw(id(route))]).collect()
}

/// Turns a segment.
pub fn turn(segment: u8, travel: Travel) -> Request {
    Request::Turn(SegmentId::new(segment).expect("a segment"), travel)
}

/// Two trains that meet in the passing loop.
pub fn meeting() -> Environment {
    let routes = [loop_route::UP_IN_ONE, loop_route::UP_OUT_ONE, loop_route::DOWN_IN_TWO, loop_route::DOWN_OUT_TWO];
    let turns = [0, 1].into_iter().flat_map(|segment| [turn(segment, Travel::Toward), turn(segment, Travel::Away)]);
    Environment { requests: dispatch(&routes).into_iter().chain(turns).collect(), ..Environment::usual(vec![UP, DOWN]) }
}
