//! The interlocking behind the border beside the kernel's, on the walks of `oracle conform` and on plans that break
//! a rule.

use std::sync::OnceLock;

use atc_c::atc_status;
use atc_c::border;
use atc_c::interlocking::{
    ATC_ANSWER_ACCEPTED, ATC_ANSWER_NONE, ATC_HEADING_NONE, ATC_PLACE_ROUTE, ATC_REQUEST_DRIVE_NORMAL,
    ATC_REQUEST_DRIVE_REVERSE, ATC_REQUEST_NONE, ATC_REQUEST_SET, ATC_REQUEST_TURN_AWAY, ATC_REQUEST_TURN_TOWARD,
    ATC_REQUEST_WITHDRAW, atc_interlocking, atc_interlocking_input, atc_large_interlocking, atc_place,
    interlocking_input_of, interlocking_output_of, movement_of,
};
use atc_kernel::Machine as _;
use atc_kernel::interlocking::{
    CircuitSet, Combined, Commands, Input, Large, LargeStation, Layout, Memory, Plan, PointSet, Position, Request,
    Station, Travel,
};
use atc_kernel::time::Ticks;
use atc_layout::Names;
use atc_protocol::machine::Machine;
use atc_protocol::machine::interlocking::{Config, Interlocked, Step};

use crate::arrays::{Arrays, InC, heading};
use crate::call;
use crate::walks::{body, walked};

/// C's input and output for a size of station.
pub type InputOf<Z> = interlocking_input_of<<Z as InC>::Circuits, <Z as InC>::Points, <Z as InC>::Segments>;
pub type OutputOf<const R: usize, Z> =
    interlocking_output_of<<Z as InC>::Circuits, <Z as InC>::Points, <Z as InC>::Segments, R>;

/// An input of the kernel as C gives it.
pub fn input<Z: InC>(input: &Input<Z>) -> InputOf<Z> {
    let (request, number) = match input.request {
        None => (ATC_REQUEST_NONE, 200),
        Some(Request::Set(route)) => (ATC_REQUEST_SET, route.number()),
        Some(Request::Withdraw(route)) => (ATC_REQUEST_WITHDRAW, route.number()),
        Some(Request::Drive(point, Position::Normal)) => (ATC_REQUEST_DRIVE_NORMAL, point.number()),
        Some(Request::Drive(point, Position::Reverse)) => (ATC_REQUEST_DRIVE_REVERSE, point.number()),
        Some(Request::Turn(segment, Travel::Toward)) => (ATC_REQUEST_TURN_TOWARD, segment.number()),
        Some(Request::Turn(segment, Travel::Away)) => (ATC_REQUEST_TURN_AWAY, segment.number()),
    };
    interlocking_input_of {
        occupied: Z::circuits(input.occupied),
        block: Z::circuits(input.orders.block),
        unblock: Z::circuits(input.orders.unblock),
        restrict_circuits: Z::circuits(input.orders.restrict),
        lift: Z::circuits(input.orders.lift),
        detected_normal: Z::points(input.detected.normal),
        detected_reverse: Z::points(input.detected.reverse),
        request,
        number,
        restrict_code: input.orders.speed.0,
        consent: Z::segments(input.consent),
    }
}

/// Holds what C puts out against what the kernel commands.
pub fn compare<const R: usize, const S: usize, Z: InC>(
    circuits: usize,
    said: &OutputOf<R, Z>,
    memory: &Memory<R, S, Z>,
    commands: &Commands<R, Z>,
) {
    let output = &commands.interlocking;
    let occupied = output.table.read(memory.cycle).expect("the table is of this cycle").occupied;
    assert_eq!(said.proceed, Z::routes(output.proceed));
    let there = (0..circuits).fold(CircuitSet::EMPTY, |all, number| all.or(CircuitSet::nth(number)));
    assert_eq!(said.confirmed, Z::circuits(output.confirmed.and(there)));
    assert_eq!(said.occupied, Z::circuits(occupied.and(there)));
    assert_eq!(said.drive_normal, Z::points(output.drives.normal));
    assert_eq!(said.drive_reverse, Z::points(output.drives.reverse));
    assert_eq!(said.permits, Z::segments(output.permits));
    let answer = match output.answer {
        None => ATC_ANSWER_NONE,
        Some(Ok(())) => ATC_ANSWER_ACCEPTED,
        // Both in the kernel's order.
        Some(Err(refusal)) => 2 + refusal as u32,
    };
    assert_eq!(said.answer, answer);
    assert_eq!(said.phases, memory.interlocking.routes.map(|route| route.phase as u8));
    for (number, (telegram, movement)) in said.telegrams.iter().zip(commands.telegrams).enumerate() {
        let movement = movement.filter(|_| number < circuits);
        let expected = movement.map_or(movement_of::default(), |movement| movement_of {
            hold: Z::circuits(movement.hold),
            sent: 1,
            stop: movement.stop.number(),
            heading: movement.heading.map_or(ATC_HEADING_NONE, heading),
            speed_code: movement.speed.0,
        });
        assert_eq!(*telegram, expected);
    }
}

pub fn start(arrays: &Arrays) -> Result<Box<atc_interlocking>, atc_status> {
    call::start(border::atc_interlocking_start, &arrays.config())
}

pub fn start_large(arrays: &Arrays<Large>) -> Result<Box<atc_large_interlocking>, atc_status> {
    call::start(border::atc_large_interlocking_start, &arrays.config())
}

fn place(arrays: &Arrays) -> (atc_status, atc_place) {
    call::ask(border::atc_interlocking_check_plan, &arrays.config())
}

#[test]
fn interlockings() {
    let mut unsafe_plans = 0;
    let (cases, rejected, steps) = walked(<Interlocked>::NAME, 140, |expected, refused| {
        if refused {
            // A layout that cannot be compiled has no arrays.
            return 0;
        }
        let config: Config = body(&expected.case.config);
        // A large station has none here either.
        let Ok(mut oracle) = Interlocked::open(&config) else { return 0 };
        let layout: &Station = oracle.layout();
        let arrays = Arrays::of(layout.plan(), oracle.names());
        let started = start(&arrays);
        // The oracle takes plans that break rules of engineering, for the traces of accidents; C does not.
        assert_eq!(started.is_ok(), Layout::new(*layout.plan()).is_ok());
        assert_eq!(place(&arrays).0, started.as_ref().err().copied().unwrap_or(atc_status::Ok));
        let Ok(mut state) = started else {
            unsafe_plans += 1;
            return 0;
        };
        let mut memory = Memory::INITIAL;
        for step in &expected.case.steps {
            let step: Step = body(step);
            let read = oracle.input(&step).expect("a walk has no other");
            let (next, commands) = Combined(oracle.layout()).step(memory, read);
            memory = next;
            Machine::step(&mut oracle, &step).expect("the oracle has stepped it");
            assert_eq!(oracle.state(), &memory.interlocking);
            let (status, said) = call::step(border::atc_interlocking_step, &mut *state, &input(&read));
            assert_eq!(status, atc_status::Ok);
            compare(arrays.lengths_m.len(), &said, &memory, &commands);
        }
        expected.case.steps.len()
    });
    println!("interlocking: {cases} cases, {rejected} rejected, {unsafe_plans} not for trains, {steps} steps");
    assert!(steps > 1000 && cases > rejected + 2 * unsafe_plans, "{steps} steps in {cases} cases");
}

/// The arrays of the passing loop, which keep every rule, and its layout.
pub fn passing_loop() -> (Arrays, Box<Station>) {
    let text = include_str!("../../../layouts/passing-loop.toml");
    let described = atc_layout::Description::from_toml("passing-loop.toml", text).expect("it is a layout");
    let compiled = described.compile().expect("it keeps every rule");
    (Arrays::of(&compiled.plan, &compiled.names), compiled.layout())
}

/// The plan of a large station, and its names.
type Hundred = (Box<Plan<256, 32, 128, 32, Large>>, Names);

/// The arrays of a large station, which keep every rule, and its layout. It has no time after a start.
pub fn hundred_routes() -> (Arrays<Large>, Box<LargeStation>) {
    // The file is read once for all tests.
    static HUNDRED: OnceLock<Hundred> = OnceLock::new();
    let (plan, names) = HUNDRED.get_or_init(|| {
        let text = include_str!("../../../layouts/station-100.toml");
        let described = atc_layout::Description::from_toml("station-100.toml", text).expect("it is a layout");
        let compiled = described.compile_to::<256, 32, 128, 32, Large>().expect("it keeps every rule");
        (Box::new(Plan { start: Ticks(0), ..*compiled.plan }), compiled.names)
    });
    (Arrays::of(plan, names), Box::new(Layout::new(**plan).expect("it keeps every rule")))
}

/// What a large station's plan breaks comes out as that of a small one does.
#[test]
fn broken_rules_of_a_large_station() {
    on_a_large_stack(|| {
        type Break = (fn(&mut Arrays<Large>), atc_status, (u32, u32));
        let (right, _) = hundred_routes();
        let place = |arrays: &Arrays<Large>| call::ask(border::atc_large_interlocking_check_plan, &arrays.config());
        assert_eq!(place(&right), (atc_status::Ok, atc_place::default()));
        let cases: [Break; 8] = [
            (|plan| plan.routes[99].drive_cycles = 0, atc_status::PlanNoTime, (ATC_PLACE_ROUTE, 99)),
            (|plan| plan.routes[70].path_length = 33, atc_status::PlanPathTooLong, (ATC_PLACE_ROUTE, 70)),
            (|plan| plan.routes[70].entry.words[3] = 1 << 63, atc_status::UnknownCircuit, (ATC_PLACE_ROUTE, 70)),
            (|plan| plan.routes[70].conflicts.words[2] = 1, atc_status::UnknownRoute, (ATC_PLACE_ROUTE, 70)),
            (|plan| plan.routes[70].from.words[3] = 128, atc_status::UnknownSegment, (ATC_PLACE_ROUTE, 70)),
            (|plan| plan.routes[70].overlap.normal.words[3] = 1 << 31, atc_status::UnknownPoint, (ATC_PLACE_ROUTE, 70)),
            (|plan| plan.routes.resize(257, plan.routes[0]), atc_status::TooManyEntries, (0, 0)),
            (|plan| plan.elements.resize(8193, plan.elements[0]), atc_status::TooManyEntries, (0, 0)),
        ];
        for (number, (break_it, status, at)) in cases.into_iter().enumerate() {
            let mut plan = right.clone();
            break_it(&mut plan);
            let (found, place) = place(&plan);
            assert_eq!((found, (place.kind, place.first)), (status, at), "case {number}");
            assert_eq!(start_large(&plan).err(), Some(status), "case {number}");
        }
    });
}

/// A state of the one size is none of the other.
#[test]
fn a_state_has_its_size() {
    on_a_large_stack(|| {
        let mut large = start_large(&hundred_routes().0).expect("it keeps every rule");
        // SAFETY: a large state has more bytes than a small one, and the alignment of both is the same.
        let small = unsafe { &mut *(&raw mut *large).cast::<atc_interlocking>() };
        let (status, said) = call::step(border::atc_interlocking_step, small, &atc_interlocking_input::default());
        assert_eq!((status, said.occupied), (atc_status::NotStarted, u64::MAX));
    });
}

/// A large plan has 0.9 MB, and is copied some times on its way through a build without optimisation.
pub fn on_a_large_stack(run: impl FnOnce() + Send) {
    std::thread::scope(|scope| {
        let thread = std::thread::Builder::new().stack_size(64 << 20).spawn_scoped(scope, run);
        thread.expect("a thread can be had").join().expect("it has said what was wrong");
    });
}

/// Every broken rule comes out under its own status, and at its place.
#[test]
fn broken_rules_have_a_status_and_a_place() {
    type Break = (fn(&mut Arrays), atc_status, Option<(u32, u32)>);
    let cases: [Break; 17] = [
        (|plan| plan.scalars.turn_cycles = 0, atc_status::PlanNoTime, Some((0, 0))),
        (|plan| plan.routes[2].drive_cycles = 0, atc_status::PlanNoTime, Some((ATC_PLACE_ROUTE, 2))),
        (|plan| plan.routes[1].speed_code = 0, atc_status::PlanCodeOutOfTable, Some((ATC_PLACE_ROUTE, 1))),
        (|plan| plan.routes[1].speed_code = 8, atc_status::UnknownCode, Some((ATC_PLACE_ROUTE, 1))),
        (|plan| plan.routes[1].heading = 0, atc_status::UnknownChoice, Some((ATC_PLACE_ROUTE, 1))),
        (|plan| plan.routes[1].cab_signalled = 2, atc_status::BadFlag, Some((ATC_PLACE_ROUTE, 1))),
        (|plan| plan.routes[3].entry = 1 << 63, atc_status::UnknownCircuit, Some((ATC_PLACE_ROUTE, 3))),
        (|plan| plan.routes[3].conflicts = 1 << 63, atc_status::UnknownRoute, Some((ATC_PLACE_ROUTE, 3))),
        (|plan| plan.routes[3].from = 1 << 7, atc_status::UnknownSegment, Some((ATC_PLACE_ROUTE, 3))),
        (|plan| plan.routes[3].overlap.normal = 1 << 31, atc_status::UnknownPoint, Some((ATC_PLACE_ROUTE, 3))),
        (|plan| plan.routes[0].path_length = 17, atc_status::PlanPathTooLong, Some((ATC_PLACE_ROUTE, 0))),
        (|plan| plan.routes[0].path_length = 0, atc_status::PlanNotThere, Some((ATC_PLACE_ROUTE, 0))),
        (|plan| plan.routes[0].path_first = u16::MAX, atc_status::BeyondArray, Some((ATC_PLACE_ROUTE, 0))),
        (|plan| plan.elements.truncate(1), atc_status::BeyondArray, None),
        (|plan| plan.routes.resize(65, plan.routes[0]), atc_status::TooManyEntries, Some((0, 0))),
        (|plan| plan.lengths_m.resize(65, 100), atc_status::TooManyEntries, Some((0, 0))),
        (|plan| plan.segment_circuits.clear(), atc_status::BeyondArray, None),
    ];
    assert_eq!(place(&passing_loop().0), (atc_status::Ok, atc_place::default()));
    for (number, (break_it, status, at)) in cases.into_iter().enumerate() {
        let mut plan = passing_loop().0;
        break_it(&mut plan);
        let (found, place) = place(&plan);
        assert_eq!(found, status, "case {number}");
        assert_eq!(start(&plan).err(), Some(status), "case {number}");
        if let Some(at) = at {
            assert_eq!((place.kind, place.first), at, "case {number}");
        }
    }
}

/// A set of points that is detected both ways, and everything at once, is an input like any other.
#[test]
fn what_is_not_plausible_is_an_input() {
    let (arrays, _) = passing_loop();
    let mut state = start(&arrays).expect("it keeps every rule");
    let points = PointSet::from_bits((1 << arrays.detectors.len()) - 1).bits();
    let read = atc_interlocking_input {
        occupied: u64::MAX >> (64 - arrays.lengths_m.len()),
        detected_normal: points,
        detected_reverse: points,
        ..atc_interlocking_input::default()
    };
    let (status, said) = call::step(border::atc_interlocking_step, &mut *state, &read);
    assert_eq!((status, said.proceed, said.drive_normal | said.drive_reverse), (atc_status::Ok, 0, 0));
}
