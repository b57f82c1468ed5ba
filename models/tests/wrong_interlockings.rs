//! Wrong devices in the models of the interlocking: each must turn a claim red that the kernel keeps in the same model.

mod common;
mod meeting;

use atc_kernel::distance::Metres;
use atc_kernel::interlocking::{
    CircuitId, Grant, Input, Output, Phase, Positions, Request, RouteSet, RouteState, SpeedLimits, State, Table,
    Travel, Works,
};
use atc_models::interlocking::device::{Device, Real};
use atc_models::interlocking::environment::{Environment, Obey, Start};
use atc_models::interlocking::ground::{Heading, Station};
use atc_models::interlocking::stations::{
    Overlaps, ROUTES, SEGMENTS, Small, loop_route, passing, passing_loop, rest, siding,
};
use atc_models::interlocking::yard::{RESTRICTED, Yard};
use atc_models::interlocking::{Purpose, Sight};
use atc_models::{Outcome, Verdict};
use common::outcome;
use meeting::{UP, dispatch, meeting, turn};

/// The kernel's device with a defect.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Wrong {
    /// A route from a segment needs its direction until it is idle.
    DirectionUntilIdle,
    /// Every circuit counts as clear one cycle too early.
    ClearEarly,
    /// A withdrawn route is released at once.
    NoReleaseTime,
    /// Overlaps are not held.
    NoOverlap,
    /// A route in use still shows proceed.
    ProceedInUse,
    /// Every circuit counts as clear as soon as it is reported clear.
    NoFilter,
    /// Points are taken to be where they are wanted.
    DetectionIgnored,
    /// A block is confirmed whatever is held or occupied.
    ConfirmedAtOnce,
    /// Restrictions are not in the table.
    Unrestricted,
    /// Withdrawn routes grant their path.
    GrantsWhenWithdrawn,
    /// Routes grant their path, and no signal shows proceed.
    GrantsWithoutProceed,
}

type Kernel = State<ROUTES, SEGMENTS>;

/// The output with other contents of the table.
fn rewritten(
    output: &Output<ROUTES>,
    state: &Kernel,
    change: impl FnOnce(&mut [Grant; ROUTES], &mut SpeedLimits),
) -> Output<ROUTES> {
    let mut contents = output.table.read(state.epoch).expect("the table of this cycle");
    change(&mut contents.grants, &mut contents.standing.limits);
    Output { table: Table::write(state.epoch, contents), ..*output }
}

impl Device for Wrong {
    fn step(&self, layout: &Small, state: Kernel, mut input: Input) -> (Kernel, Output<ROUTES>) {
        let plan = layout.plan();
        let mut before = state;
        match self {
            Self::DirectionUntilIdle => {
                if let Some(Request::Turn(segment, Travel::Away)) = input.request {
                    let needs = |(route, held): (&atc_kernel::interlocking::Route<3>, &RouteState)| {
                        held.is_held() && route.from.has(segment)
                    };
                    if plan.routes.iter().zip(&state.routes).any(needs) {
                        input.request = None;
                    }
                }
            }
            Self::NoFilter => {
                let clear = |circuit: u8| !input.occupied.has(CircuitId::new(circuit).expect("a circuit"));
                let counts = atc_kernel::interlocking::PerCircuit::from_fn(|circuit| {
                    let circuit = u8::try_from(circuit).expect("a circuit");
                    if clear(circuit) { plan.clear } else { 0 }
                });
                before.track = atc_kernel::interlocking::Track::from_parts(counts);
            }
            Self::DetectionIgnored => {
                let wanted = |all: Positions, (route, held): (&atc_kernel::interlocking::Route<3>, &RouteState)| {
                    let positions = held.positions(route);
                    all.without(positions.points()).or(positions)
                };
                input.detected = plan.routes.iter().zip(&state.routes).fold(input.detected, wanted);
            }
            Self::NoOverlap => before.routes.iter_mut().for_each(|route| {
                route.overlap &= route.phase == Phase::Provisional || route.phase == Phase::Idle;
            }),
            _ => {}
        }
        let early = layout.plan().clear - u8::from(*self == Self::ClearEarly);
        let plan_of_device = atc_kernel::interlocking::Plan { clear: early, ..*plan };
        let device = Small::with_what_proofs_need(plan_of_device).expect("a layout");
        let (mut after, output) = device.cycle(before, input);
        let output = match self {
            Self::Unrestricted => rewritten(&output, &after, |_, limits| *limits = SpeedLimits::NONE),
            Self::GrantsWithoutProceed => Output { proceed: RouteSet::EMPTY, ..output },
            Self::GrantsWhenWithdrawn => rewritten(&output, &after, |grants, _| {
                for (grant, (route, held)) in grants.iter_mut().zip(plan.routes.iter().zip(&after.routes)) {
                    if held.phase == Phase::Releasing && held.head == 0 {
                        let circuits = held.path(route).circuits;
                        let (train, last) = (route.entry, route.last());
                        *grant =
                            Grant { train, circuits, last, complete: true, heading: route.heading, speed: route.speed };
                    }
                }
            }),
            Self::NoReleaseTime => {
                for route in after.routes.iter_mut().filter(|route| route.phase == Phase::Releasing) {
                    *route = RouteState::IDLE;
                }
                output
            }
            Self::ProceedInUse => {
                let mut proceed = output.proceed;
                for (number, route) in after.routes.iter().enumerate() {
                    let it = RouteSet::nth(number);
                    proceed = proceed.or(it.only_if(route.phase == Phase::InUse));
                }
                Output { proceed, ..output }
            }
            Self::ConfirmedAtOnce => {
                after.works = Works { confirmed: after.works.blocked, ..after.works };
                Output { confirmed: after.works.blocked, ..output }
            }
            _ => output,
        };
        (after, output)
    }
}

/// Each of these devices breaks its property, and the kernel breaks none in the same model.
#[track_caller]
fn red(station: &Station, environment: &Environment, devices: &[(Wrong, &str)]) {
    let purpose = Purpose::Finishes(&[]);
    let sound = outcome(Yard::new(Real, station.clone(), environment.clone(), purpose));
    assert!(sound.ok(), "{devices:?}: the kernel in the same model");
    for (device, property) in devices {
        let outcome = outcome(Yard::new(*device, station.clone(), environment.clone(), purpose));
        let verdicts: Vec<_> = outcome.properties.iter().map(|p| (p.name.as_str(), p.verdict)).collect();
        let found = outcome.properties.iter().find(|p| p.name == *property).expect("a property of the model");
        assert!(outcome.complete && found.verdict == Verdict::Failed, "{device:?}, {property}: {verdicts:?}");
    }
}

/// Everything that a device does in a model is safe, and yet not every train can arrive.
#[track_caller]
fn only_progress(device: Wrong, station: &Station, environment: &Environment) {
    red(station, environment, &[(device, "all-can-arrive")]);
    let outcome =
        outcome(Yard::new(device, station.clone(), environment.clone(), Purpose::Finishes(&[Sight::Arrived])));
    let failed: Vec<_> = outcome.properties.iter().filter(|p| !p.ok()).map(|p| p.name.as_str()).collect();
    assert_eq!(failed, ["all-can-arrive"], "{device:?}");
}

#[test]
fn what_only_progress_catches() {
    only_progress(Wrong::DirectionUntilIdle, &passing_loop(Overlaps::Throat), &meeting());
    let train = Start { at: rest::L, heading: Heading::Up, segment: Some(0) };
    let lost = Environment {
        obey: Obey::Telegrams,
        residual: 0,
        unheard: 1,
        unheard_in: 1 << rest::THROAT | 1 << rest::FIRST,
        before: vec![turn(0, Travel::Toward)],
        requests: dispatch(&[0]),
        ..Environment::usual(vec![train])
    };
    only_progress(Wrong::ClearEarly, &siding().with(|plan| plan.clear = 3), &lost);
}

#[test]
fn wrong_devices_turn_red_where_two_trains_meet() {
    let station = passing_loop(Overlaps::Throat);
    let wrong = [
        (Wrong::NoReleaseTime, "no-derailment"),
        (Wrong::ProceedInUse, "proceed-over-clear"),
        (Wrong::DetectionIgnored, "proceed-over-clear"),
    ];
    red(&station, &meeting(), &wrong);
    let blocks = Environment { blocks: 1 << passing::ONE, ..meeting() };
    red(&station, &blocks, &[(Wrong::ConfirmedAtOnce, "no-staff-hit")]);
}

#[test]
fn wrong_devices_turn_red_where_trains_act_on_telegrams() {
    let station = passing_loop(Overlaps::Throat);
    let telegrams = Environment { obey: Obey::Telegrams, residual: 1, ..meeting() };
    let alone = Environment {
        before: vec![turn(0, Travel::Toward), turn(1, Travel::Away)],
        requests: dispatch(&FOLLOWING),
        trains: vec![UP],
        ..telegrams.clone()
    };
    let wrong = [(Wrong::GrantsWhenWithdrawn, "authority-asked-for"), (Wrong::GrantsWithoutProceed, "no-overrun")];
    red(&station, &alone, &wrong);
    let slow = station.with(|plan| {
        plan.routes[usize::from(loop_route::UP_IN_ONE)].speed = RESTRICTED;
        plan.braking[2] = Metres(100);
    });
    red(&slow, &alone, &[(Wrong::Unrestricted, "limit-under-train")]);
    let restricts = Environment { restricts: 1 << passing::ONE, ..telegrams };
    red(&station, &restricts, &[(Wrong::Unrestricted, "restricted")]);
}

#[test]
fn a_device_that_believes_a_flicker_turns_red() {
    let flicker = Environment {
        unheard: 1,
        residual: 0,
        before: vec![turn(0, Travel::Toward), turn(1, Travel::Away)],
        requests: dispatch(&FOLLOWING),
        ..Environment::usual(vec![UP, UP])
    };
    let station = passing_loop(Overlaps::Throat).with(|plan| plan.clear = 3);
    red(&station, &flicker, &[(Wrong::NoFilter, "proceed-over-clear")]);
}

/// Into the loop and out of it.
const FOLLOWING: [u8; 2] = [loop_route::UP_IN_ONE, loop_route::UP_OUT_ONE];

#[test]
fn an_overlap_that_is_not_held_turns_red() {
    let ends = [passing::ONE, passing::TWO];
    let station = passing_loop(Overlaps::Throat).sliding(&ends, Heading::Up, 1);
    let station = station.with(|plan| {
        plan.routes.iter_mut().for_each(|route| route.stay = atc_kernel::time::Ticks(2));
    });
    let routes = [loop_route::UP_IN_ONE, loop_route::UP_OUT_ONE, loop_route::UP_OUT_TWO];
    let environment = Environment {
        slides_for: 1,
        before: vec![turn(0, Travel::Toward), turn(1, Travel::Away)],
        requests: dispatch(&routes),
        ..Environment::usual(vec![UP])
    };
    let verdict =
        |outcome: Outcome| outcome.properties.iter().find(|p| p.name == "no-derailment").expect("a property").verdict;
    let safe = Purpose::Safe(&[Sight::Slides]);
    assert_eq!(verdict(outcome(Yard::new(Real, station.clone(), environment.clone(), safe))), Verdict::ModelChecked);
    assert_eq!(verdict(outcome(Yard::new(Wrong::NoOverlap, station, environment, safe))), Verdict::Failed);
}
