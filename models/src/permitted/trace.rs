//! A path of a ride as a run of the kernel's machine.

use super::device::Device;
use super::layout::CELL_M;
use super::ride::{Cycle, Ride, State};
use crate::outcome::{self, Trace};
use atc_kernel::Machine;
use atc_kernel::permitted::step;
use atc_kernel::speed::KmhTenths;
use atc_kernel::telegram::Counter;
use atc_kernel::time::Millis;
use atc_protocol::Kmh;
use atc_protocol::machine::permitted::{Config, Permitting};
use serde::Serialize;

/// The length of a cycle.
const CYCLE: Millis = Millis(1000);

/// The true number of the first telegram, so near to the wrap that most traces pass it.
const FIRST: u8 = 253;

/// What the model knows of a cycle besides.
#[derive(Serialize)]
struct Words {
    /// Where the train is.
    nose_m: u16,
    /// Where the ground lets its way end.
    ground_stop_m: u16,
    /// Whether the ground restricts it.
    restricted: bool,
    /// What the device of the model permits.
    permitted_by_the_model_km_h: Option<Kmh>,
    hazard: bool,
}

/// The run of the kernel, with true counters.
pub(super) fn run_of<D: Device>(ride: &Ride<D>, path: &[(State, Option<Cycle>)]) -> Trace {
    let permitted = ride.permitted();
    let mut state = permitted.initial();
    let mut number = FIRST;
    let mut cycles: Vec<outcome::Cycle<Permitting, _>> = Vec::new();
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
        let words = Words {
            nose_m: u16::from(after.train.place) * CELL_M,
            ground_stop_m: u16::from(ride.layout.points[usize::from(cycle.ground.point)]) * CELL_M,
            restricted: cycle.ground.restricted,
            permitted_by_the_model_km_h: after.shown.speed.map(|speed| KmhTenths(speed).into()),
            hazard: ride.above_ground(after),
        };
        cycles.push((heard.into(), permission.into(), words));
    }
    Trace::of::<Permitting, _>(&Config::of(permitted, CYCLE), &cycles)
}
