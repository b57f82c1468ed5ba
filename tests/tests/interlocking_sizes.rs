//! A large station does what a small one does. Everything is numbered anew, so that it lies in all the words of a set: circuit `n`
//! becomes `4n + 3`, and so on; the device is stepped beside that of the small station, on the same random input, and says the same.

use atc_kernel::Machine;
use atc_kernel::interlocking::{
    CircuitId, CircuitSet, Combined, Element, Input, LargeStation, Memory, Movement, Orders, Plan, PointId, PointSet,
    Position, Positions, Request, RouteId, RouteSet, SegmentId, SegmentSet, SpeedCode, SpeedLimits, Station, Travel,
};
use atc_kernel::interlocking::{Large, Route};
use atc_tests::busy_station;
use proptest::prelude::*;
use proptest::test_runner::{Config, TestRunner};

const fn circuit(small: usize) -> usize {
    4 * small + 3
}

const fn point(small: usize) -> usize {
    4 * small + 1
}

const fn route(small: usize) -> usize {
    4 * small + 2
}

const fn segment(small: usize) -> usize {
    4 * small + 3
}

fn circuits(set: CircuitSet) -> CircuitSet<Large> {
    let members = (0..64).filter(|number| set.meets(CircuitSet::nth(*number)));
    members.fold(CircuitSet::EMPTY, |all, number| all.or(CircuitSet::nth(circuit(number))))
}

fn points(set: PointSet) -> PointSet<Large> {
    let members = (0..32).filter(|number| set.meets(PointSet::nth(*number)));
    members.fold(PointSet::EMPTY, |all, number| all.or(PointSet::nth(point(number))))
}

fn routes(set: RouteSet) -> RouteSet<Large> {
    let members = (0..64).filter(|number| set.meets(RouteSet::nth(*number)));
    members.fold(RouteSet::EMPTY, |all, number| all.or(RouteSet::nth(route(number))))
}

fn segments(set: SegmentSet) -> SegmentSet<Large> {
    let members = (0..8).filter(|number| set.meets(SegmentSet::nth(*number)));
    members.fold(SegmentSet::EMPTY, |all, number| all.or(SegmentSet::nth(segment(number))))
}

fn positions(of: Positions) -> Positions<Large> {
    Positions { normal: points(of.normal), reverse: points(of.reverse) }
}

fn element(of: Element) -> Element<Large> {
    Element { circuits: circuits(of.circuits), positions: positions(of.positions), ..Element::NONE }
}

fn id(number: usize) -> u8 {
    u8::try_from(number).expect("at most 255")
}

/// The same station with other numbers.
fn renumbered(small: &Plan<64, 16, 32, 8>) -> LargeStation {
    let mut plan = Plan::<256, 32, 128, 32, Large>::EMPTY;
    for (number, given) in small.routes.iter().enumerate() {
        let mut made = Route {
            heading: given.heading,
            entry: circuits(given.entry),
            approach: circuits(given.approach),
            length: given.length,
            overlap: element(given.overlap),
            beyond: circuits(given.beyond),
            continuing: routes(given.continuing),
            conflicts: routes(given.conflicts),
            from: segments(given.from),
            to: segments(given.to),
            drive: given.drive,
            release: given.release,
            stay: given.stay,
            speed: given.speed,
            overlap_speed: given.overlap_speed,
            cab_signalled: given.cab_signalled,
            calling_on: given.calling_on,
            ..Route::NONE
        };
        for (place, given) in made.path.iter_mut().zip(given.path) {
            *place = element(given);
        }
        plan.routes[route(number)] = made;
    }
    for (number, given) in small.points.iter().enumerate() {
        plan.points[point(number)].detectors = circuits(given.detectors);
    }
    for (number, given) in small.segments.iter().enumerate() {
        let made = &mut plan.segments[segment(number)];
        (made.length, made.outward, made.shared) = (given.length, given.outward, given.shared);
        made.throat = circuits(given.throat);
        for (place, given) in made.circuits.iter_mut().zip(given.circuits) {
            *place = circuits(given);
        }
    }
    for (number, length) in small.lengths.iter().enumerate() {
        plan.lengths[circuit(number)] = *length;
    }
    plan.line = limits(small.line);
    (plan.braking, plan.clear, plan.turn, plan.start) = (small.braking, small.clear, small.turn, small.start);
    (plan.settle, plan.loss, plan.residual, plan.standstill) =
        (small.settle, small.loss, small.residual, small.standstill);
    LargeStation::new(plan).expect("it keeps the rules that the small one keeps")
}

fn limits(of: SpeedLimits) -> SpeedLimits<Large> {
    SpeedLimits::from_parts(of.parts().map(circuits))
}

fn request(of: Request) -> Request {
    let its_route = |it: RouteId| RouteId::new(id(route(it.number().into()))).expect("a route");
    let its_segment = |it: SegmentId| SegmentId::new(id(segment(it.number().into()))).expect("a segment");
    match of {
        Request::Set(it) => Request::Set(its_route(it)),
        Request::Withdraw(it) => Request::Withdraw(its_route(it)),
        Request::Drive(it, to) => Request::Drive(PointId::new(id(point(it.number().into()))).expect("a point"), to),
        Request::Turn(it, travel) => Request::Turn(its_segment(it), travel),
    }
}

fn input(of: Input) -> Input<Large> {
    let orders = Orders {
        block: circuits(of.orders.block),
        unblock: circuits(of.orders.unblock),
        restrict: circuits(of.orders.restrict),
        speed: of.orders.speed,
        lift: circuits(of.orders.lift),
    };
    Input {
        occupied: circuits(of.occupied),
        detected: positions(of.detected),
        request: of.request.map(request),
        orders,
        consent: segments(of.consent),
    }
}

fn movement(of: Movement) -> Movement<Large> {
    let stop = CircuitId::new(id(circuit(of.stop.number().into()))).expect("a circuit");
    Movement { stop, heading: of.heading, speed: of.speed, hold: circuits(of.hold) }
}

/// Circuits, none in most draws.
fn few() -> impl Strategy<Value = CircuitSet> {
    prop_oneof![
        6 => Just(CircuitSet::EMPTY),
        2 => (0..64_usize).prop_map(CircuitSet::nth),
        1 => any::<u64>().prop_map(CircuitSet::from_bits),
    ]
}

/// A request, for the most part for what there is.
fn asked() -> impl Strategy<Value = Request> {
    let set = || (0..64_u8).prop_map(|number| Request::Set(RouteId::new(number).expect("a route")));
    prop_oneof![
        6 => set(),
        1 => (0..64_u8).prop_map(|number| Request::Withdraw(RouteId::new(number).expect("a route"))),
        1 => (0..32_u8, any::<bool>()).prop_map(|(number, reverse)| {
            let to = if reverse { Position::Reverse } else { Position::Normal };
            Request::Drive(PointId::new(number).expect("a point"), to)
        }),
        1 => (0..8_u8, any::<bool>()).prop_map(|(number, away)| {
            let travel = if away { Travel::Away } else { Travel::Toward };
            Request::Turn(SegmentId::new(number).expect("a segment"), travel)
        }),
    ]
}

/// What is drawn on top of a cycle of the busy station.
fn drawn() -> impl Strategy<Value = (CircuitSet, CircuitSet, Option<Request>, Orders, u8)> {
    let orders = (few(), few(), few(), 0..8_u8, few()).prop_map(|(block, unblock, restrict, speed, lift)| Orders {
        block,
        unblock: unblock.or(block),
        restrict,
        speed: SpeedCode(speed),
        lift: lift.or(restrict),
    });
    let quiet = Just(Orders::default());
    let orders = prop_oneof![5 => quiet, 1 => orders];
    (few(), few(), proptest::option::of(asked()), orders, prop_oneof![4 => Just(0xFF_u8), 1 => any::<u8>()])
}

/// How often something happened.
#[derive(Debug, Default)]
struct Seen {
    set: u32,
    refused: u32,
    open: u32,
    driven: u32,
}

/// One session on both.
fn session(
    small: &Station,
    large: &LargeStation,
    draws: &[(CircuitSet, CircuitSet, Option<Request>, Orders, u8)],
) -> Seen {
    let mut memory: (Memory<64, 8>, Memory<256, 32, Large>) = (Memory::INITIAL, Memory::INITIAL);
    let mut seen = Seen::default();
    let traffic = busy_station::traffic(busy_station::SMALL);
    let service = busy_station::service(busy_station::SMALL);
    let drawn = draws.iter().zip(traffic.iter().cycle()).map(|((more, lost, asked, orders, consent), quiet)| Input {
        occupied: quiet.occupied.or(*more).without(*lost),
        request: asked.or(quiet.request),
        orders: *orders,
        consent: SegmentSet::from_bits(*consent),
        ..*quiet
    });
    for it in service.into_iter().chain(drawn) {
        let (next, said) = Combined(small).step(memory.0, it);
        let (next_large, said_large) = Combined(large).step(memory.1, input(it));
        memory = (next, next_large);
        let (one, other) = (said.interlocking, said_large.interlocking);
        assert_eq!(one.answer, other.answer, "{it:?}");
        assert_eq!(routes(one.proceed), other.proceed);
        assert_eq!(positions(one.drives), other.drives);
        assert_eq!(segments(one.permits), other.permits);
        assert_eq!(circuits(one.confirmed), other.confirmed.and(circuits(CircuitSet::ALL)));
        for (number, telegram) in said.telegrams.iter().enumerate() {
            assert_eq!(telegram.map(movement), said_large.telegrams[circuit(number)], "circuit {number}");
            seen.open += u32::from(telegram.is_some_and(|telegram| telegram.is_open()));
        }
        for number in (0..256).filter(|number| number % 4 != 3) {
            let own = CircuitSet::<Large>::nth(number).first().expect("a circuit");
            assert_eq!(said_large.telegrams[number], Some(Movement::stop_in(own)), "nothing is there");
        }
        assert!(memory.0.is_valid(small) && memory.1.is_valid(large));
        seen.set += u32::from(one.answer == Some(Ok(())));
        seen.refused += u32::from(matches!(one.answer, Some(Err(_))));
        seen.driven += u32::from(!one.drives.is_empty());
    }
    seen
}

#[test]
fn a_large_station_does_what_a_small_one_does() {
    // A large layout has half a megabyte, and is moved on the stack some times.
    let test = || {
        let small = busy_station::station();
        let large = Box::new(renumbered(small.plan()));
        let mut seen = Seen::default();
        let mut runner = TestRunner::new(Config { cases: 24, ..Config::default() });
        let draws = proptest::collection::vec(drawn(), 100..200);
        let result = runner.run(&draws, |draws| {
            session(&small, &large, &draws);
            Ok(())
        });
        result.unwrap_or_else(|error| panic!("{error}"));
        let quiet = vec![(CircuitSet::EMPTY, CircuitSet::EMPTY, None, Orders::default(), 0xFF); 300];
        let one = session(&small, &large, &quiet);
        (seen.set, seen.open) = (one.set, one.open);
        assert!(seen.set > 16 && seen.open > 100, "the trains run: {seen:?}");
    };
    let thread = std::thread::Builder::new().stack_size(64 << 20).spawn(test).expect("a thread");
    if let Err(panic) = thread.join() {
        std::panic::resume_unwind(panic);
    }
}
