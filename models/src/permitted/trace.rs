//! A path of a ride as a run of the kernel's machine.

use super::device::Device;
use super::layout::{BRAKE_MM_S2, CELL_M, SPEEDS};
use super::ride::{Cycle, Ride, State};
use crate::outcome::{Step, Trace};
use atc_kernel::Machine;
use atc_kernel::permitted::{Basis, Heard, LineKind, Permission, step};
use atc_kernel::telegram::{Counter, Route};
use serde_json::{Value, json};
use std::collections::BTreeMap;

/// The length of a cycle in milliseconds.
const CYCLE_MS: u32 = 1000;

/// The true number of the first telegram, so near to the wrap that most traces pass it.
const FIRST: u8 = 253;

/// The run of the kernel, with true counters. The further words of a step: where the train is, what the ground allows, and
/// what the device of the model permits.
pub(super) fn run_of<D: Device>(ride: &Ride<D>, path: &[(State, Option<Cycle>)]) -> Trace {
    let permitted = ride.permitted();
    let mut state = permitted.initial();
    let mut number = FIRST;
    let mut steps = Vec::new();
    for (place, (before, cycle)) in path.iter().enumerate() {
        let Some(cycle) = cycle else { break };
        let absolute = |counter: &mut Counter| counter.0 = counter.0.wrapping_add(number);
        let mut heard = cycle.heard;
        heard.main.iter_mut().for_each(|main| absolute(&mut main.counter));
        heard.sub.iter_mut().for_each(|sub| absolute(&mut sub.counter));
        number = number.wrapping_add(ride.further(cycle.counted));
        let (next, permission) = step(permitted, state, heard);
        state = next;
        let after = path.get(place + 1).map_or(before, |(after, _)| after);
        let point = ride.layout.points[usize::from(cycle.ground.point)];
        let words = BTreeMap::from([
            ("nose_m".to_owned(), json!(u16::from(after.train.place) * CELL_M)),
            ("ground_stop_m".to_owned(), json!(u16::from(point) * CELL_M)),
            ("restricted".to_owned(), json!(cycle.ground.restricted)),
            ("permitted_by_the_model_km_h".to_owned(), json!(after.shown.speed.map(km_h))),
            ("hazard".to_owned(), json!(ride.above_ground(after))),
        ]);
        steps.push(Step { input: input(&heard), output: output(permission), words });
    }
    Trace { machine: "permitted-speed".to_owned(), config: config(ride), steps, loop_start: None }
}

fn km_h(tenths: u16) -> f64 {
    f64::from(tenths) / 10.0
}

fn config<D: Device>(ride: &Ride<D>) -> Value {
    let small = &ride.small;
    let ms = |cycles: u16| u32::from(cycles) * CYCLE_MS;
    json!({
        "cycle_ms": CYCLE_MS,
        "speeds_km_h": SPEEDS.map(km_h),
        "lowest_limit_km_h": km_h(SPEEDS[usize::from(small.lowest)]),
        "brake_mm_s2": BRAKE_MM_S2,
        "worst_gradient_permille": small.worst,
        "margin_m": u16::from(small.margin) * CELL_M,
        "fresh_ms": ms(small.fresh),
        "life_ms": ms(small.life),
        "fixed_life_ms": ms(small.fixed_life),
        "window": small.window,
        "run": small.run,
        "memory_ms": ms(small.memory),
    })
}

fn input(heard: &Heard) -> Value {
    let main = heard.main.map(|main| {
        let beyond_exit_m = match main.route {
            Route::Closed => None,
            Route::OpenFor(metres) => Some(metres.0),
        };
        json!({
            "section": main.section.0,
            "counter": main.counter.0,
            "beyond_exit_m": beyond_exit_m,
            "speed_rank": main.speed.rank(),
        })
    });
    let sub = heard.sub.map(|sub| {
        json!({
            "section": sub.section.0,
            "counter": sub.counter.0,
            "length_m": sub.length.metres().0,
            "gradient_permille": sub.gradient.0,
            "curve_rank": sub.curve.rank(),
            "restriction_rank": sub.restriction.rank(),
        })
    });
    json!({
        "line": heard.line.map(|line| match line {
            LineKind::Analog => "analog",
            LineKind::Digital => "digital",
        }),
        "analog_km_h": heard.analog.map(|speed| km_h(speed.0)),
        "main": main,
        "sub": sub,
        "to_exit_m": heard.to_exit.map(|distance| f64::from(distance.0) / 1000.0),
        "moved_m": f64::from(heard.moved.0) / 1000.0,
    })
}

fn output(permission: Permission) -> Value {
    let basis = match permission.basis {
        Basis::Nothing => "nothing",
        Basis::Analog => "analog",
        Basis::Pattern => "pattern",
        Basis::Both => "both",
        Basis::RunningDown => "running-down",
    };
    json!({"speed_km_h": permission.speed.map(|speed| km_h(speed.0)), "basis": basis})
}
