//! Steps per second of each machine through the C border, and of the kernel called from Rust, in one run:
//! `cargo run --release -p atc-c --bin throughput`. The border reads the state back and checks it in every step.
#![allow(unsafe_code, reason = "the border is called as C calls it")]

use std::ffi::c_void;
use std::hint::black_box;
use std::ptr;
use std::time::{Duration, Instant};

use atc_c::aspect::{atc_aspect, atc_aspect_config, atc_aspect_input, atc_aspect_output};
use atc_c::block::{atc_block, atc_block_config, atc_block_input, atc_block_output};
use atc_c::interlocking::{
    ATC_HEADING_RIGHT, ATC_REQUEST_SET, atc_interlocking, atc_large_interlocking, atc_set32, atc_set128, atc_set256,
    element_of, interlocking_config_of, interlocking_input_of, interlocking_output_of, route_of,
};
use atc_c::pattern::{atc_pattern_input, atc_pattern_output};
use atc_c::permitted::{atc_permitted, atc_permitted_config, atc_permitted_input, atc_permitted_output};
use atc_c::supervision::{atc_supervision, atc_supervision_config, atc_supervision_input, atc_supervision_output};
use atc_c::telegram::{atc_deframer, atc_deframer_input, atc_frame, atc_telegram};
use atc_c::train::{
    atc_code_pair, atc_position_config, atc_train, atc_train_config, atc_train_input, atc_train_output,
};
use atc_c::{atc_status, border};
use atc_kernel::Machine;
use atc_kernel::aspect::{Acceptance, AspectSet, AspectTable, Times, TimesMs};
use atc_kernel::block::{self, Block, Hold, SectionSet};
use atc_kernel::code::{CodeFrequencies, CodeTable, MAX_CODES, Millihertz};
use atc_kernel::distance::{Metres, Millimetres};
use atc_kernel::interlocking::{
    Broken, CircuitSet, Combined, Heading, Input, LargeStation, Layout, Orders, Plan, Positions, Request, Route,
    RouteId, SegmentSet, Size, SpeedCode, Station,
};
use atc_kernel::pattern::{Deceleration, pattern};
use atc_kernel::permitted::{Heard, LineKind, Permitted, Settings};
use atc_kernel::position::Moved;
use atc_kernel::speed::{KmhTenths, RawKmhTenths};
use atc_kernel::supervision::{Speeds, Supervision};
use atc_kernel::telegram::{self, Deframer, Gradient, Reception, Sequence};
use atc_kernel::time::{Millis, Ticks};
use atc_kernel::train::{Antennas, Carrier, Parts, Train};

/// How long each side is measured.
const TIME: Duration = Duration::from_millis(400);

/// Calls per second in the fastest of many short stretches: others on the machine take the slow ones.
fn rate(mut call: impl FnMut(u64)) -> f64 {
    let mut calls = 0_u64;
    let mut stretch = |length: u32| {
        let start = Instant::now();
        for _ in 0..length {
            call(calls);
            calls += 1;
        }
        start.elapsed()
    };
    // As many calls as make some 50 microseconds.
    let mut length = 1;
    while length < 4096 && stretch(length) < Duration::from_micros(50) {
        length *= 2;
    }
    let (start, mut best) = (Instant::now(), Duration::MAX);
    while start.elapsed() < TIME {
        best = best.min(stretch(length));
    }
    f64::from(length) / best.as_secs_f64()
}

fn row(name: &str, border: f64, kernel: f64) {
    println!("| {name} | {border:.2e} | {kernel:.2e} | {:.2} |", border / kernel);
}

/// Steps of the border; the states are new.
fn through<S, I, O>(
    start: impl Fn(*mut S) -> atc_status,
    step: unsafe extern "C" fn(*mut S, *const I, *mut O) -> atc_status,
    input: impl Fn(u64) -> I,
) -> f64 {
    let mut state = Box::<S>::new_uninit();
    let mut output = Box::<O>::new_uninit();
    assert_eq!(start(state.as_mut_ptr()), atc_status::Ok);
    let step = black_box(step);
    rate(|number| {
        let input = input(number);
        // SAFETY: a state that was started, an input and room for an output.
        let status = unsafe { step(state.as_mut_ptr(), black_box(&raw const input), output.as_mut_ptr()) };
        assert_eq!(status, atc_status::Ok);
        black_box(output.as_ptr());
    })
}

/// Steps of the kernel.
fn beside<M: Machine>(machine: &M, input: impl Fn(u64) -> M::Input) -> f64 {
    let machine = black_box(machine);
    let mut state = machine.initial();
    rate(|number| {
        let (next, output) = machine.step(state, black_box(input(number)));
        state = black_box(next);
        black_box(output);
    })
}

macro_rules! starts {
    ($function:ident, $state:ty, $config:expr) => {
        // SAFETY: room for a state, and a configuration that is there.
        |state: *mut $state| unsafe { border::$function(state.cast(), size_of::<$state>(), &raw const $config) }
    };
}

fn narrow(number: u64) -> u8 {
    number.to_le_bytes()[0]
}

fn main() {
    println!("| machine | steps per second through C | in the kernel | ratio |\n|---|---|---|---|");
    let mut speeds = [0; 16];
    speeds[..8].copy_from_slice(&[0, 150, 250, 450, 550, 650, 750, 900]);
    let table = AspectTable::new(&speeds[..8].iter().copied().map(KmhTenths).collect::<Vec<_>>()).expect("it rises");
    aspect(speeds);
    supervision();
    count();
    brake();
    permitted(speeds, table);
    on_board(speeds, table);
    let step = |number: u64| (number / 7 + number / 3) % 2;
    // SAFETY: room for a deframer.
    let start =
        |state: *mut atc_deframer| unsafe { border::atc_deframer_start(state.cast(), size_of::<atc_deframer>()) };
    let input = |number| atc_deframer_input { reception: narrow(step(number)).into() };
    let through = through::<_, _, atc_telegram>(start, border::atc_deframer_step, input);
    let bit = |number| if step(number) == 0 { Reception::Zero } else { Reception::One };
    row("deframer", through, beside(&Deframer, bit));
    for routes in [1, 8, 60] {
        station(routes, Station::new, &SMALL);
    }
    for routes in [60, 250] {
        station(routes, LargeStation::new, &LARGE);
    }
}

fn aspect(speeds: [u16; 16]) {
    let config = atc_aspect_config {
        cycle_ms: 10,
        operate_ms: 300,
        recovery_ms: 400,
        mask_ms: 400,
        interruption_ms: 800,
        shortened_operate_ms: 100,
        aspect_count: 8,
        speeds,
    };
    let heard = |number: u64| if number % 100 < 60 { 0x12 } else { 0 };
    let start = starts!(atc_aspect_start, atc_aspect, config);
    let input = |number| atc_aspect_input { detected: heard(number) };
    let c = through::<atc_aspect, _, atc_aspect_output>(start, border::atc_aspect_step, input);
    let times = Times::from_millis(Millis(10), TimesMs::default()).expect("the patent's times");
    row("aspect", c, beside(&Acceptance::<16> { times }, |number| AspectSet::from_bits(heard(number))));
}

fn supervision() {
    let config = atc_supervision_config { maximum: 4000, margin: 5 };
    let input = |number| atc_supervision_input {
        measured: narrow(number).into(),
        permitted: 120,
        has_measured: 1,
        has_permitted: 1,
    };
    let start = starts!(atc_supervision_start, atc_supervision, config);
    let c = through::<atc_supervision, _, atc_supervision_output>(start, border::atc_supervision_step, input);
    let machine = Supervision::new(KmhTenths(4000), KmhTenths(5)).expect("in range");
    let speed = |speed| Some(RawKmhTenths(speed));
    row(
        "supervision",
        c,
        beside(&machine, |number| Speeds { measured: speed(narrow(number).into()), permitted: speed(120) }),
    );
}

fn count() {
    let config = atc_block_config { cycle_ms: 10, pass_ms: 10_000, sections: 8, max_trains: 4, tail_hold_sections: 1 };
    let on = |number: u64, at: u64| number % 64 / 8 == at;
    let input = |number| atc_block_input {
        present: 1_u16 << (number % 64 / 8),
        check_in: on(number, 0).into(),
        check_out: on(number, 7).into(),
        ahead_entered: 1,
        ..atc_block_input::default()
    };
    let start = starts!(atc_block_start, atc_block, config);
    let c = through::<atc_block, _, atc_block_output>(start, border::atc_block_step, input);
    let machine = Block::new(8, 4, Hold::new(1).expect("at most 16"), Ticks(1000)).expect("in range");
    row(
        "block",
        c,
        beside(&machine, |number| block::Input {
            check_in: on(number, 0),
            check_out: on(number, 7),
            present: SectionSet::from_bits(1_u16 << (number % 64 / 8)),
            reset: None,
            ahead_hold: Hold::NONE,
            ahead_entered: true,
        }),
    );
}

fn brake() {
    let mut output = atc_pattern_output::default();
    let ask = black_box(border::atc_pattern as unsafe extern "C" fn(*const atc_pattern_input, *mut _) -> atc_status);
    let c = rate(|number| {
        let distance_m = u16::from(narrow(number)) * 100;
        let input = atc_pattern_input { brake_mm_s2: 800, distance_m, gradient_permille: -10 };
        // SAFETY: both are there.
        let status = unsafe { ask(black_box(&raw const input), &raw mut output) };
        assert_eq!(status, atc_status::Ok);
        black_box(&output);
    });
    let brake = Deceleration::brake(800).expect("in range");
    row(
        "pattern",
        c,
        rate(|number| {
            let distance = Metres(u16::from(narrow(number)) * 100);
            black_box(pattern(black_box(brake.on(Gradient(-10))), black_box(distance)));
        }),
    );
}

/// The parameters of the permitted speed, of C and of the kernel.
fn permitted_parameters(speeds: [u16; 16], table: AspectTable) -> (atc_permitted_config, Permitted) {
    let config = atc_permitted_config {
        cycle_ms: 10,
        fresh_ms: 2200,
        life_ms: 5000,
        fixed_life_ms: 10_000,
        memory_ms: 2000,
        speed_count: 8,
        speeds,
        brake_mm_s2: 800,
        margin_m: 10,
        lowest_rank: 2,
        worst_gradient_permille: -35,
        window: 3,
        run: 1,
    };
    let machine = Permitted::new(Settings {
        speeds: table,
        lowest: atc_kernel::aspect::AspectId::new(2).expect("at most 15"),
        brake: Deceleration::brake(800).expect("in range"),
        worst: Gradient(-35),
        margin: Metres(10),
        fresh: Ticks(220),
        life: Ticks(500),
        fixed_life: Ticks(1000),
        sequence: Sequence::new(3, 1, Ticks(200)).expect("in range"),
    });
    (config, machine.expect("in range"))
}

fn permitted(speeds: [u16; 16], table: AspectTable) {
    let (config, machine) = permitted_parameters(speeds, table);
    let main = |number: u64| atc_c::telegram::atc_main_telegram {
        section: 7,
        beyond_exit_m: 400,
        counter: narrow(number / 53),
        route_open: 1,
        speed_rank: 4,
    };
    let input = |number: u64| atc_permitted_input {
        moved_mm: 50,
        analog: 450,
        has_analog: 1,
        has_main: (number % 53 == 0).into(),
        main_data: main(number),
        ..atc_permitted_input::default()
    };
    let start = starts!(atc_permitted_start, atc_permitted, config);
    let c = through::<atc_permitted, _, atc_permitted_output>(start, border::atc_permitted_step, input);
    row(
        "permitted",
        c,
        beside(&machine, |number| Heard {
            line: None,
            analog: Some(KmhTenths(450)),
            main: (number % 53 == 0).then_some(atc_kernel::telegram::Main {
                section: atc_kernel::telegram::SectionId(7),
                counter: atc_kernel::telegram::Counter(narrow(number / 53)),
                route: atc_kernel::telegram::Route::OpenFor(Metres(400)),
                speed: atc_kernel::aspect::AspectId::new(4).expect("at most 15"),
            }),
            sub: None,
            to_exit: None,
            moved: Millimetres(50),
        }),
    );
}

/// A train that hears a pair of codes, and a frame each second.
fn on_board(speeds: [u16; 16], table: AspectTable) {
    let (permitted_config, permitted) = permitted_parameters(speeds, table);
    let mut codes = [atc_code_pair::default(); 64];
    codes[0] = atc_code_pair { main_millihertz: 22_000, sub_millihertz: 36_000, speed: 450 };
    let config = atc_train_config {
        permitted: permitted_config,
        operate_ms: 300,
        recovery_ms: 400,
        mask_ms: 400,
        interruption_ms: 800,
        shortened_operate_ms: 100,
        code_tolerance_millihertz: 500,
        code_count: 1,
        codes,
        supervision: atc_supervision_config { maximum: 4000, margin: 5 },
        position: atc_position_config::default(),
        has_position: 0,
    };
    let frequencies = |code| CodeFrequencies::new(&[Millihertz(code)], Millihertz(500)).expect("in range");
    let mut named = [[None; MAX_CODES]; MAX_CODES];
    named[0][0] = Some(KmhTenths(450));
    let times = TimesMs {
        operate: Millis(300),
        recovery: Millis(400),
        mask: Millis(400),
        interruption: Millis(800),
        shortened_operate: Millis(100),
    };
    let train = Train::<16>::new(Parts {
        codes: CodeTable::new(frequencies(22_000), frequencies(36_000), named).expect("it names a speed"),
        acceptance: Acceptance { times: Times::from_millis(Millis(10), times).expect("in range") },
        permitted,
        supervision: Supervision::new(KmhTenths(4000), KmhTenths(5)).expect("in range"),
        position: None,
    });
    let frame = |number: u64| {
        let main = telegram::Main {
            section: telegram::SectionId(8),
            counter: telegram::Counter(narrow(number / 100)),
            route: telegram::Route::OpenFor(Metres(400)),
            speed: atc_kernel::aspect::AspectId::new(4).expect("at most 15"),
        };
        telegram::encode(telegram::Telegram::Main(main))
    };
    let bits = |number: u64| {
        let bits = frame(number).bits();
        atc_frame { bits: std::array::from_fn(|place| narrow(u64::from(bits >> (105 - place) & 1 == 1))) }
    };
    let input = |number: u64| atc_train_input {
        main_code_millihertz: 22_100,
        sub_code_millihertz: 35_900,
        line: u32::from(number == 0) * 2,
        speed: 400,
        main_frame: bits(number),
        sub_frame: atc_frame { bits: [0; 106] },
        first: 0,
        second: 0,
        moved_least_mm: 110,
        moved_most_mm: 120,
        facing: ATC_HEADING_RIGHT,
        has_main_code: 1,
        has_sub_code: 1,
        has_main_frame: (number % 100 == 0).into(),
        has_sub_frame: 0,
        has_first: 0,
        has_second: 0,
        has_moved: 1,
        has_speed: 1,
    };
    let start = starts!(atc_train_start, atc_train, config);
    let c = through::<atc_train, _, atc_train_output>(start, border::atc_train_step, input);
    let antennas = |number: u64| Antennas {
        main: Carrier { code: Some(Millihertz(22_100)), frame: (number % 100 == 0).then(|| frame(number)) },
        sub: Carrier { code: Some(Millihertz(35_900)), frame: None },
        first: None,
        second: None,
        moved: Moved::new(110, 120),
        speed: Some(RawKmhTenths(400)),
        line: (number == 0).then_some(LineKind::Digital),
        facing: Some(Heading::Right),
    };
    row("on-board device", c, beside(&train.expect("the parts fit"), antennas));
}

/// How C starts and steps an interlocking of one size, and makes its sets of one number.
struct Called<D, C, P, S, const R: usize> {
    start: unsafe extern "C" fn(*mut c_void, usize, *const interlocking_config_of<C, P, S>) -> atc_status,
    step: unsafe extern "C" fn(
        *mut D,
        *const interlocking_input_of<C, P, S>,
        *mut interlocking_output_of<C, P, S, R>,
    ) -> atc_status,
    alone: fn(usize) -> C,
}

const SMALL: Called<atc_interlocking, u64, u32, u8, 64> =
    Called { start: border::atc_interlocking_start, step: border::atc_interlocking_step, alone: |number| 1 << number };

const LARGE: Called<atc_large_interlocking, atc_set256, atc_set128, atc_set32, 256> = Called {
    start: border::atc_large_interlocking_start,
    step: border::atc_large_interlocking_step,
    alone: |number| {
        let mut set = atc_set256::default();
        set.words[number / 64] |= 1 << (number % 64);
        set
    },
};

/// A line of circuits, with so many routes of one circuit each, one behind the other.
fn station<const R: usize, const P: usize, const N: usize, const S: usize, Z: Size, D, C, B, E>(
    count: usize,
    layout: fn(Plan<R, P, N, S, Z>) -> Result<Layout<R, P, N, S, Z>, Broken>,
    called: &Called<D, C, B, E, R>,
) where
    C: Copy + Default,
    B: Copy + Default,
    E: Copy + Default,
{
    let circuits = count + 2;
    let mut plan = Box::new(Plan { clear: 2, turn: Ticks(1), ..Plan::EMPTY });
    plan.braking[..2].copy_from_slice(&[Metres(0), Metres(100)]);
    plan.lengths[..circuits].fill(Metres(200));
    for (number, route) in plan.routes.iter_mut().take(count).enumerate() {
        *route = Route {
            entry: CircuitSet::nth(number),
            approach: CircuitSet::nth(number),
            beyond: CircuitSet::nth(number + 2),
            length: 1,
            drive: Ticks(20),
            release: Ticks(30),
            stay: Ticks(10),
            speed: SpeedCode(1),
            ..Route::NONE
        };
        for place in route.path.iter_mut().take(1) {
            place.circuits = CircuitSet::nth(number + 1);
        }
    }
    let layout = Box::new(layout(*plan).expect("it keeps every rule"));

    let (lengths, braking) = (vec![200; circuits], [0, 100]);
    let alone = called.alone;
    let elements: Vec<_> =
        (1..=count).map(|number| element_of::<C, B> { circuits: alone(number), ..element_of::default() }).collect();
    let one = |number: usize| route_of::<C, B, E> {
        entry: alone(number),
        approach: alone(number),
        beyond: alone(number + 2),
        path_first: u16::try_from(number).unwrap_or(u16::MAX),
        path_length: 1,
        drive_cycles: 20,
        release_cycles: 30,
        stay_cycles: 10,
        heading: ATC_HEADING_RIGHT,
        speed_code: 1,
        ..route_of::default()
    };
    let routes: Vec<_> = (0..count).map(one).collect();
    let config = interlocking_config_of {
        lengths_m: lengths.as_ptr(),
        line_codes: ptr::null(),
        detectors: ptr::null(),
        segments: ptr::null(),
        segment_circuits: ptr::null(),
        routes: routes.as_ptr(),
        elements: elements.as_ptr(),
        braking_m: braking.as_ptr(),
        circuit_count: circuits,
        point_count: 0,
        segment_count: 0,
        segment_circuit_count: 0,
        route_count: routes.len(),
        element_count: elements.len(),
        code_count: 2,
        turn_cycles: 1,
        start_cycles: 0,
        residual_cycles: 0,
        standstill_cycles: 0,
        clear_cycles: 2,
        settle_cycles: 0,
        loss_cycles: 0,
    };
    // Everything was unblocked and lifted before; every route is set in its turn, behind the train.
    let most = u64::try_from(count).unwrap_or(u64::MAX);
    let place = |number: u64| usize::try_from(number / 16 % most).unwrap_or(0);
    let asked = |number: u64| narrow(number % most);
    let freed = |number: u64| usize::try_from(number).unwrap_or(0) % circuits;
    let input = |number: u64| interlocking_input_of {
        occupied: alone(place(number)),
        unblock: alone(freed(number)),
        lift: alone(freed(number)),
        request: ATC_REQUEST_SET,
        number: asked(number),
        ..interlocking_input_of::default()
    };
    // SAFETY: room for a state, and a configuration that is there.
    let start = |state: *mut D| unsafe { (called.start)(state.cast(), size_of::<D>(), &raw const config) };
    let c = through(start, called.step, input);
    let read = |number: u64| Input {
        occupied: CircuitSet::nth(place(number)),
        detected: Positions::NONE,
        request: RouteId::new(asked(number)).map(Request::Set),
        orders: Orders {
            unblock: CircuitSet::nth(freed(number)),
            lift: CircuitSet::nth(freed(number)),
            ..Orders::default()
        },
        consent: SegmentSet::EMPTY,
    };
    let of = if R > 64 { " of a large station" } else { "" };
    row(&format!("interlocking, {count} routes{of}"), c, beside(&Combined(&layout), read));
}
