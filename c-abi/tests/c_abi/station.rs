//! The interlocking behind the border beside the kernel's, on the walks of `oracle conform` and on plans that break
//! a rule.

use atc_c::atc_status;
use atc_c::border;
use atc_c::interlocking::{
    ATC_ANSWER_ACCEPTED, ATC_ANSWER_NONE, ATC_HEADING_NONE, ATC_PLACE_ROUTE, ATC_REQUEST_DRIVE_NORMAL,
    ATC_REQUEST_DRIVE_REVERSE, ATC_REQUEST_NONE, ATC_REQUEST_SET, ATC_REQUEST_TURN_AWAY, ATC_REQUEST_TURN_TOWARD,
    ATC_REQUEST_WITHDRAW, atc_interlocking, atc_interlocking_input, atc_interlocking_output, atc_movement, atc_place,
};
use atc_kernel::Machine as _;
use atc_kernel::interlocking::{
    Combined, Commands, Input, Layout, Memory, PointSet, Position, Request, Station, Travel,
};
use atc_protocol::machine::Machine;
use atc_protocol::machine::interlocking::{Config, Interlocked, Step};

use crate::arrays::{Arrays, heading};
use crate::call;
use crate::walks::{body, walked};

/// An input of the kernel as C gives it.
pub fn input(input: &Input) -> atc_interlocking_input {
    let (request, number) = match input.request {
        None => (ATC_REQUEST_NONE, 200),
        Some(Request::Set(route)) => (ATC_REQUEST_SET, route.number()),
        Some(Request::Withdraw(route)) => (ATC_REQUEST_WITHDRAW, route.number()),
        Some(Request::Drive(point, Position::Normal)) => (ATC_REQUEST_DRIVE_NORMAL, point.number()),
        Some(Request::Drive(point, Position::Reverse)) => (ATC_REQUEST_DRIVE_REVERSE, point.number()),
        Some(Request::Turn(segment, Travel::Toward)) => (ATC_REQUEST_TURN_TOWARD, segment.number()),
        Some(Request::Turn(segment, Travel::Away)) => (ATC_REQUEST_TURN_AWAY, segment.number()),
    };
    atc_interlocking_input {
        occupied: input.occupied.bits(),
        block: input.orders.block.bits(),
        unblock: input.orders.unblock.bits(),
        restrict_circuits: input.orders.restrict.bits(),
        lift: input.orders.lift.bits(),
        detected_normal: input.detected.normal.bits(),
        detected_reverse: input.detected.reverse.bits(),
        request,
        number,
        restrict_code: input.orders.speed.0,
        consent: input.consent.bits(),
    }
}

/// Holds what C puts out against what the kernel commands.
pub fn compare(said: &atc_interlocking_output, memory: &Memory<64, 8>, commands: &Commands<64>) {
    let output = &commands.interlocking;
    assert_eq!(said.proceed, output.proceed.bits());
    assert_eq!(said.confirmed, output.confirmed.bits());
    assert_eq!((said.drive_normal, said.drive_reverse), (output.drives.normal.bits(), output.drives.reverse.bits()));
    assert_eq!(said.permits, output.permits.bits());
    assert_eq!(said.occupied, output.table.read(memory.cycle).expect("the table is of this cycle").occupied.bits());
    let answer = match output.answer {
        None => ATC_ANSWER_NONE,
        Some(Ok(())) => ATC_ANSWER_ACCEPTED,
        // Both in the kernel's order.
        Some(Err(refusal)) => 2 + refusal as u32,
    };
    assert_eq!(said.answer, answer);
    assert_eq!(said.phases, memory.interlocking.routes.map(|route| route.phase as u8));
    for (telegram, movement) in said.telegrams.iter().zip(commands.telegrams) {
        let expected = movement.map_or(atc_movement::default(), |movement| atc_movement {
            hold: movement.hold.bits(),
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
            compare(&said, &memory, &commands);
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
