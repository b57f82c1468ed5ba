//! The on-board device as one machine: theorems T-TRN-1 to T-TRN-8.
//!
//! Every harness is one cycle from any valid state of all parts together, with any parameters and anything received, but
//! for what its bound says. Where the train, the exits and the stopping points really are, and for how long nothing was
//! received, are ghosts.

mod brake;
mod distance;
mod facing;
mod machine;
mod reception;
mod silence;
mod stop;

use crate::aspect::any_machine_state;
use crate::permitted::{Line, any_distance, any_heard, any_state, knows_main, knows_sub};
use crate::position::signed;
use crate::supervision::any_speed;
use crate::{Engine, Harness, any_flag};
use atc_kernel::Machine;
use atc_kernel::aspect::{self, Acceptance, AspectSet, Times};
use atc_kernel::code::{CodeFrequencies, CodeTable, MAX_CODES, Millihertz};
use atc_kernel::permitted::Heard;
use atc_kernel::position::{Interval, Measured, Millibels, Moved, Position};
use atc_kernel::speed::{KmhTenths, RawKmhTenths};
use atc_kernel::supervision::{Brake, Supervision};
use atc_kernel::telegram::{Judgement, Main};
use atc_kernel::time::Ticks;
use atc_kernel::train::{Cab, Parts, Received, State, Train};

pub use brake::{t_trn_2, t_trn_2_only, t_trn_5};
pub use distance::{t_trn_6, t_trn_6_inside, t_trn_6_moved};
pub use facing::{t_trn_8, t_trn_8_held};
pub use machine::{trn_8, trn_machine, trn_valid};
pub use reception::{t_trn_4, t_trn_4_code};
pub use silence::{t_trn_3, trn_10};
pub use stop::{t_trn_1, t_trn_1_distance};

/// The harnesses of this module.
#[cfg(not(chosen))]
pub const ALL: &[Harness] = &[
    t_trn_1::HARNESS,
    t_trn_1_distance::HARNESS,
    t_trn_2::HARNESS,
    t_trn_2_only::HARNESS,
    t_trn_3::HARNESS,
    trn_10::HARNESS,
    t_trn_4::HARNESS,
    t_trn_4_code::HARNESS,
    t_trn_5::HARNESS,
    t_trn_6::HARNESS,
    t_trn_6_inside::HARNESS,
    t_trn_6_moved::HARNESS,
    t_trn_8::HARNESS,
    t_trn_8_held::HARNESS,
    trn_8::HARNESS,
    trn_machine::HARNESS,
    trn_valid::HARNESS,
];

/// The ranks of the device in these harnesses, and the speeds of its table.
const RANKS: usize = crate::permitted::SPEEDS;

/// What these harnesses say of their bound.
const BOUND: &str = "4 aspects, tables of 4 speeds";

/// The same where acceptance plays no part.
const STEADY: &str = "tables of 4 speeds, one accepted aspect or none";

/// A device, and the line that it was made for.
struct Device {
    train: Train<RANKS>,
    line: Line,
}

/// The code frequencies of both carriers.
fn carriers() -> Option<[CodeFrequencies; 2]> {
    let carrier = |nominal: [u32; RANKS]| CodeFrequencies::new(&nominal.map(Millihertz), Millihertz(2)).ok();
    Some([carrier([10, 20, 30, 40])?, carrier([15, 25, 35, 45])?])
}

/// A code table in which the codes of a place, on both carriers, name this speed.
fn codes<const PAIRS: usize>(pairs: [KmhTenths; PAIRS]) -> Option<CodeTable> {
    let mut named = [[None; MAX_CODES]; MAX_CODES];
    for (place, speed) in pairs.into_iter().enumerate() {
        named[place][place] = Some(speed);
    }
    let [main, sub] = carriers()?;
    CodeTable::new(main, sub, named).ok()
}

/// A device for `line` with these times and this position, and any supervision.
fn any_device<E: Engine + ?Sized>(
    e: &mut E,
    line: Line,
    acceptance: Acceptance<RANKS>,
    position: Option<Position>,
) -> Option<Device> {
    let maximum = KmhTenths(e.word("highest plausible speed (0.1 km/h)", 1500..=4000));
    let margin = KmhTenths(e.word("release margin (0.1 km/h)", 0..=5));
    let supervision = Supervision::new(maximum, margin);
    e.assume(supervision.is_ok());
    // What codes name is `t_trn_4_code`'s: here one pair is enough.
    let (codes, permitted) = (codes([line.speeds[RANKS - 1]])?, line.permitted);
    let train = Train::new(Parts { codes, acceptance, permitted, supervision: supervision.ok()?, position });
    e.assume(train.is_ok());
    Some(Device { train: train.ok()?, line })
}

/// An arbitrary interval, or none.
fn any_interval<E: Engine + ?Sized>(e: &mut E) -> Option<Interval> {
    let near = any_distance(e, "interval: nearest (65 536 mm, mm)");
    let wide = any_distance(e, "interval: width (65 536 mm, mm)");
    if any_flag(e, "an interval (odd: yes)") { Interval::new(near, near.and(wide)) } else { None }
}

/// An arbitrary brake command.
fn any_brake<E: Engine + ?Sized>(e: &mut E) -> Brake {
    match e.word("previous brake (0 release, 1 service, else emergency)", 0..=2) {
        0 => Brake::Release,
        1 => Brake::Service,
        _ => Brake::Emergency,
    }
}

/// An arbitrary movement.
fn any_moved<E: Engine + ?Sized>(e: &mut E) -> Option<Moved> {
    let [least, most] = [0..=300, 300..=3000].map(|likely| signed(e.word("least, most movement (mm)", likely)));
    let away = e.word("the other way (7 mod 8: yes)", 0..=7) & 7 == 7;
    let moved = if away { Moved::new(most.wrapping_neg(), least.wrapping_neg()) } else { Moved::new(least, most) };
    e.assume(moved.is_some());
    moved
}

/// Anything that can be received in a cycle: what [`Train::receive`] makes of anything (T-TRN-4).
fn any_received<E: Engine + ?Sized>(e: &mut E) -> Option<Received> {
    let Heard { line, main, sub, .. } = any_heard(e)?;
    let [first, second] = [0..=255, 0..=0].map(|likely| {
        let level = Millibels(signed(e.word("level (mB)", likely)));
        any_flag(e, "that level is heard (odd: yes)").then_some(level)
    });
    Some(Received {
        detected: AspectSet::from_bits(e.word("detected (bits)", 0..=15)),
        main: main.filter(|main| knows_main(*main)),
        sub: sub.filter(|sub| knows_sub(*sub)),
        measured: Measured { first, second, moved: any_moved(e)? },
        speed: any_speed(e, "measured speed (0.1 km/h, two's complement)").map(RawKmhTenths),
        line,
    })
}

/// A device in an arbitrary valid state of all but acceptance, and what is detected: the highest aspect is displayed before and after a cycle, or
/// none. That another one matters by what is displayed alone is proved without telegrams (`t_trn_2_only`), and with them tested.
fn any_steady_state<E: Engine + ?Sized>(
    e: &mut E,
    line: Line,
    position: Option<Position>,
) -> Option<(Device, State<RANKS>, AspectSet)> {
    let times = Times::from_ticks(Ticks(3), Ticks(4), Ticks(4), Ticks(7), Ticks(1)).ok()?;
    let (acceptance, detected) = if any_flag(e, "a code is displayed (odd: yes)") {
        let parts = aspect::Parts { run: [0, 0, 0, 3], age: [0; RANKS], accepted: 8, dropped: 0, credited: 0, last: 8 };
        (aspect::State::from_parts(parts), AspectSet::from_bits(8))
    } else {
        (aspect::State::INITIAL, AspectSet::EMPTY)
    };
    let permitted = any_state(e, &line);
    let interval = any_interval(e).filter(|_| position.is_some());
    let device = any_device(e, line, Acceptance { times }, position)?;
    let state = State { acceptance, permitted, position: interval, brake: any_brake(e), facing: None };
    Some((device, state, detected))
}

/// One cycle from such a state.
fn any_steady_cycle<E: Engine + ?Sized>(e: &mut E, line: Line, position: Option<Position>) -> Option<Cycle> {
    let (device, before, detected) = any_steady_state(e, line, position)?;
    let received = Received { detected, ..any_received(e)? };
    let (after, cab) = device.train.act(before, received);
    let used_main = used_main(&device, &before, &received);
    Some(Cycle { device, before, received, after, cab, used_main })
}

/// A device in an arbitrary valid state.
fn any_device_state<E: Engine + ?Sized>(
    e: &mut E,
    line: Line,
    position: Option<Position>,
) -> Option<(Device, State<RANKS>)> {
    let (machine, acceptance) = any_machine_state::<RANKS, E>(e)?;
    let permitted = any_state(e, &line);
    let interval = any_interval(e);
    let device = any_device(e, line, machine, position)?;
    let position = interval.filter(|_| position.is_some());
    let state = State { acceptance, permitted, position, brake: any_brake(e), facing: None };
    Some((device, state))
}

/// The main telegram that is used in a cycle, if one is. T-TEL-6 says what the counters do.
fn used_main(device: &Device, before: &State<RANKS>, received: &Received) -> Option<Main> {
    let header = received.main.map(|main| main.header());
    let (_, judgement) = device.line.settings.sequence.step(before.permitted.main_stream, header);
    received.main.filter(|_| judgement == Judgement::Accepted)
}

/// One cycle from an arbitrary valid state.
struct Cycle {
    device: Device,
    before: State<RANKS>,
    received: Received,
    after: State<RANKS>,
    cab: Cab,
    /// The main telegram, if its counter is in order.
    used_main: Option<Main>,
}

fn any_cycle<E: Engine + ?Sized>(e: &mut E, line: Line, position: Option<Position>) -> Option<Cycle> {
    let (device, before) = any_device_state(e, line, position)?;
    let received = any_received(e)?;
    let (after, cab) = device.train.act(before, received);
    let used_main = used_main(&device, &before, &received);
    Some(Cycle { device, before, received, after, cab, used_main })
}
