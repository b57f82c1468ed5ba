//! More occupancy and proceed. "More occupancy never gives more proceed" does not hold as it stands: occupation beyond the end of a
//! route is what releases it, and a request of the same cycle may then succeed. It holds for every reservation that is there already.

use std::cell::Cell;

use atc_kernel::interlocking::{
    CircuitSet, Input, Orders, Phase, PointId, Position, Positions, Request, RouteId, SegmentId, SegmentSet, State,
    Travel,
};
use atc_tests::passing_loop::{EASTWARD, loop_station};
use atc_tests::sketch;
use atc_tests::station_chart::{Small, check};
use proptest::prelude::*;
use proptest::test_runner::{Config, TestRunner};

/// A train has left f. While nothing is seen of it beyond, its route stays; seen in g, it does not, and may be set anew.
#[test]
fn occupation_beyond_releases_a_route_for_the_request_of_that_cycle() {
    check(
        &loop_station(),
        EASTWARD,
        "
        occ d    ##..
        occ f    .##.
        set 2    #..#
        answer   +..h
        phase 2  suuu
        signal 2 #...
        ",
    );
    check(
        &loop_station(),
        EASTWARD,
        "
        occ d    ##..
        occ f    .##.
        occ g    ...#
        set 2    #..#
        answer   +..+
        phase 2  suus
        signal 2 #..#
        ",
    );
}

/// One cycle of a session.
#[derive(Clone, Debug)]
struct Read {
    input: Input,
    /// What the other device has besides.
    more: CircuitSet,
}

/// Few circuits, or none.
fn few(weight: u32) -> impl Strategy<Value = CircuitSet> {
    let some = prop::collection::vec(0_usize..8, 1..3).prop_map(|circuits| sketch::circuits(&circuits));
    prop_oneof![weight => Just(CircuitSet::EMPTY), 1 => some]
}

fn position() -> impl Strategy<Value = Position> {
    prop_oneof![Just(Position::Normal), Just(Position::Reverse)]
}

/// A position of a point, mostly the one that the routes over d want.
fn detection(point: u8) -> impl Strategy<Value = Positions> {
    let point = PointId::new(point).expect("a point");
    prop_oneof![
        8 => Just(Positions::of(point, Position::Normal)),
        2 => Just(Positions::of(point, Position::Reverse)),
        1 => Just(Positions::NONE),
    ]
}

fn request() -> impl Strategy<Value = Option<Request>> {
    let route = || (0_u8..8).prop_map(|route| RouteId::new(route).expect("a route"));
    prop_oneof![
        2 => Just(None),
        4 => route().prop_map(|route| Some(Request::Set(route))),
        1 => route().prop_map(|route| Some(Request::Withdraw(route))),
        1 => (0_u8..2, position()).prop_map(|(point, to)| Some(Request::Drive(PointId::new(point).expect("a point"), to))),
    ]
}

fn read() -> impl Strategy<Value = Read> {
    let parts = (few(2), few(40), few(40), detection(0), detection(1), request(), few(1));
    parts.prop_map(|(occupied, block, unblock, p, q, request, more)| {
        let orders = Orders { block, unblock, ..Orders::default() };
        let input = Input { occupied, detected: p.or(q), request, orders, consent: SegmentSet::ALL };
        Read { input, more }
    })
}

/// The station in service, with trains from W to E.
fn in_service(layout: &Small) -> State<8, 2> {
    let detected = Positions::of(PointId::ZERO, Position::Normal);
    let quiet = Input {
        occupied: CircuitSet::EMPTY,
        detected,
        request: None,
        orders: Orders { unblock: CircuitSet::ALL, lift: CircuitSet::ALL, ..Orders::default() },
        consent: SegmentSet::ALL,
    };
    let mut state = State::INITIAL;
    for _ in 0..3 {
        state = layout.cycle(state, quiet).0;
    }
    for (segment, travel) in [(0, Travel::Toward), (1, Travel::Away)] {
        let request = SegmentId::new(segment).map(|segment| Request::Turn(segment, travel));
        state = layout.cycle(state, Input { request, ..quiet }).0;
    }
    state
}

/// In any cycle of any session: a route that was reserved before it, provisionally or for good, and that shows proceed, shows it with less
/// occupancy too.
#[test]
fn more_occupancy_gives_no_reservation_that_is_there_more_proceed() {
    let shown = Cell::new(0);
    let lost = Cell::new(0);
    let session = (1_u8..3, prop::collection::vec(read(), 1..40));
    let mut runner = TestRunner::new(Config { cases: 2_000, failure_persistence: None, ..Config::default() });
    let checked = runner.run(&session, |(clear, reads)| {
        let mut station = loop_station();
        station.clear = clear;
        let layout = Small::new(station.plan()).expect("a station");
        let mut state = in_service(&layout);
        for Read { input, more } in reads {
            let (after, less) = layout.cycle(state, input);
            let more = layout.cycle(state, Input { occupied: input.occupied.or(more), ..input }).1;
            for (number, before) in (0..).zip(&state.routes) {
                let route = RouteId::new(number).expect("a route");
                if matches!(before.phase, Phase::Provisional | Phase::Set) {
                    let (with_more, with_less) = (more.proceed.has(route), less.proceed.has(route));
                    prop_assert!(!with_more || with_less, "route {number}, {before:?}, {input:?}");
                    shown.set(shown.get() + u32::from(with_more));
                    lost.set(lost.get() + u32::from(with_less && !with_more));
                }
            }
            state = after;
        }
        Ok(())
    });
    checked.unwrap_or_else(|error| panic!("{error}"));
    println!("{} proceed aspects with more occupancy, {} lost by it", shown.get(), lost.get());
    assert!(shown.get() > 1_000 && lost.get() > 300, "{} shown, {} lost", shown.get(), lost.get());
}
