//! Calls that no program should make: whatever is wrong in memory that is really there, the call says so, and
//! nothing else
//! changes. The seed is fixed; `ATC_MALFORMED_CALLS` sets the number of calls.

use std::collections::BTreeMap;
use std::fmt::Debug;
use std::ptr;

use atc_c::aspect::{atc_aspect, atc_aspect_config, atc_aspect_input};
use atc_c::block::{atc_block, atc_block_config, atc_block_input};
use atc_c::interlocking::{
    atc_interlocking, atc_interlocking_config, atc_interlocking_input, atc_large_interlocking,
    atc_large_interlocking_config, atc_large_interlocking_input,
};
use atc_c::pattern::atc_pattern_input;
use atc_c::permitted::{atc_permitted, atc_permitted_config, atc_permitted_input};
use atc_c::supervision::{atc_supervision, atc_supervision_config, atc_supervision_input};
use atc_c::telegram::{atc_deframer, atc_deframer_input, atc_frame, atc_telegram};
use atc_c::train::atc_train;
use atc_c::{atc_status, border};
use atc_kernel::interlocking::{CircuitSet, RouteSet, SegmentSet};
use atc_oracle::conform::random::Random;

use crate::arrays::{Arrays, InC};
use crate::call::{self, Ask, Start, Step};
use crate::station;
use crate::wire;

/// Words of guard on either side of a place.
const GUARD: usize = 8;
const GUARDED: u64 = 0xC3C3_C3C3_C3C3_C3C3;

/// Memory for one thing, with guards around it.
struct Place {
    words: Vec<u64>,
    size: usize,
}

/// Where a pointer leads.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Leads {
    Right,
    Nowhere,
    Beside,
}

impl Leads {
    fn some(random: &mut Random) -> Self {
        match random.below(12) {
            0 => Self::Nowhere,
            1 => Self::Beside,
            _ => Self::Right,
        }
    }
}

impl Place {
    fn of<T>() -> Self {
        let room = size_of::<T>().div_ceil(8) + 1;
        Self { words: vec![GUARDED; room + 2 * GUARD], size: size_of::<T>() }
    }

    fn start(&mut self) -> *mut u8 {
        self.words[GUARD..].as_mut_ptr().cast()
    }

    fn pointer<T>(&mut self, leads: Leads) -> *mut T {
        assert_eq!(self.size, size_of::<T>());
        match leads {
            Leads::Right => self.start().cast(),
            Leads::Nowhere => ptr::null_mut(),
            Leads::Beside => self.start().wrapping_add(1).cast(),
        }
    }

    fn put<T: Copy>(&mut self, value: &T) {
        let place = self.pointer::<T>(Leads::Right);
        // SAFETY: room for a `T` in this place, which is aligned for every structure of the header.
        unsafe { place.write(*value) };
    }

    fn get<T: Copy>(&mut self) -> T {
        let place = self.pointer::<T>(Leads::Right);
        // SAFETY: as above; it holds numbers only.
        unsafe { place.read() }
    }

    fn byte(&mut self, at: usize) -> &mut u8 {
        assert!(at < self.size);
        // SAFETY: within the words of this place.
        unsafe { &mut *self.start().add(at) }
    }

    /// Overwrites some bytes by some that are likely to be wrong.
    fn spoil(&mut self, random: &mut Random) {
        for _ in 0..=random.below(3) {
            let at = random.below(self.size);
            let wild = [0, 1, 2, 3, 7, 8, 15, 16, 17, 63, 64, 127, 128, 254, 255];
            *self.byte(at) = *random.pick(&wild).unwrap_or(&0);
        }
    }

    fn randomise(&mut self, random: &mut Random) {
        for at in 0..self.size {
            *self.byte(at) = u8::try_from(random.below(256)).unwrap_or(0);
        }
    }

    fn guarded(&self) -> bool {
        let room = GUARD + self.size.div_ceil(8);
        let guards = self.words[..GUARD].iter().chain(&self.words[room + 1..]);
        guards.copied().all(|word| word == GUARDED)
    }
}

/// What came of calls: how many of each machine ended how.
#[derive(Default)]
struct Tally(BTreeMap<(&'static str, atc_status), u64>);

/// A machine behind the border, as it is called here.
struct Target<S, C, I, O> {
    name: &'static str,
    start: Start<C>,
    step: Step<S, I, O>,
    config: C,
    input: I,
}

impl<S: Copy, C: Copy, I: Copy, O: Copy + PartialEq + Debug> Target<S, C, I, O> {
    /// What a failing step puts out.
    fn safe(&self) -> O {
        let mut output = Place::of::<O>();
        // SAFETY: the output is there; the other two are null.
        let status = unsafe { (self.step)(ptr::null_mut(), ptr::null(), output.pointer(Leads::Right)) };
        assert_eq!(status, atc_status::Null);
        output.get()
    }

    /// A start with something wrong in it, or not, where a state may have been before; what it leaves is a new state
    /// or none.
    fn attack_start(
        &self,
        random: &mut Random,
        tally: &mut Tally,
        before: &S,
        wild: &mut impl FnMut(&mut Random, &mut Place),
    ) {
        let (mut state, mut config) = (Place::of::<S>(), Place::of::<C>());
        if random.one_in(2) {
            state.put(before);
        } else {
            state.randomise(random);
        }
        config.put(&self.config);
        wild(random, &mut config);
        let leads = [Leads::some(random), Leads::some(random)];
        let right = size_of::<S>();
        let size = *random.pick(&[right, right, right, right + 8, right - 1, 0, usize::MAX]).unwrap_or(&0);
        let place: *mut S = state.pointer(leads[0]);
        // SAFETY: null, not aligned, or there; a size that is larger than what is there is not made use of.
        let status = unsafe { (self.start)(place.cast(), size, config.pointer(leads[1])) };
        *tally.0.entry((self.name, status)).or_default() += 1;
        assert!(state.guarded() && config.guarded(), "{}: written beside a place", self.name);
        let wrong = leads.iter().any(|one| *one != Leads::Right) || size < right;
        assert!(!wrong || status != atc_status::Ok || align_of::<C>() == 1, "{}: {leads:?} {size}", self.name);
        if leads[0] == Leads::Right && size >= right {
            let mut output = Place::of::<O>();
            let mut input = Place::of::<I>();
            input.put(&self.input);
            // SAFETY: all three are there.
            let stepped = unsafe { (self.step)(place, input.pointer(Leads::Right), output.pointer(Leads::Right)) };
            // The input may be out of the range of a configuration that was spoiled.
            let refused = matches!(stepped, atc_status::NotStarted | atc_status::Damaged);
            assert_eq!(refused, status != atc_status::Ok, "{}: {stepped:?} after {status:?}", self.name);
        }
    }

    /// A step with something wrong in it, or not.
    fn attack_step(&self, random: &mut Random, tally: &mut Tally, started: &S, safe: &O, other: &[u64]) {
        let (mut state, mut input, mut output) = (Place::of::<S>(), Place::of::<I>(), Place::of::<O>());
        state.put(started);
        let sound = match random.below(8) {
            0 => {
                state.randomise(random);
                false
            }
            1 => {
                // One wrong bit, anywhere: it is found for certain.
                let at = random.below(state.size);
                *state.byte(at) ^= 1 << random.below(8);
                false
            }
            2 => {
                for at in 0..state.size {
                    *state.byte(at) = other.get(at / 8).map_or(0, |word| word.to_le_bytes()[at % 8]);
                }
                false
            }
            _ => true,
        };
        input.put(&self.input);
        match random.below(3) {
            0 => input.randomise(random),
            1 => input.spoil(random),
            _ => {}
        }
        let leads = [Leads::some(random), Leads::some(random), Leads::some(random)];
        let place: *mut S = state.pointer(leads[0]);
        let mut from: *const I = input.pointer(leads[1]);
        let mut to: *mut O = output.pointer(leads[2]);
        let overlapping = random.one_in(16) && size_of::<O>() <= size_of::<S>() && size_of::<I>() <= size_of::<S>();
        if overlapping {
            if random.one_in(2) { to = place.cast() } else { from = place.cast_const().cast() }
        }
        let before = state.words.clone();
        // SAFETY: null, not aligned, or there.
        let status = unsafe { (self.step)(place, from, to) };
        *tally.0.entry((self.name, status)).or_default() += 1;
        assert!(state.guarded() && input.guarded() && output.guarded(), "{}: written beside a place", self.name);
        let wrong = overlapping || !sound || leads.iter().any(|one| *one != Leads::Right);
        assert!(!wrong || status != atc_status::Ok, "{}: {leads:?}, sound {sound}", self.name);
        if status != atc_status::Ok {
            assert!(state.words == before, "{}: a step that is refused changes nothing", self.name);
            if leads[2] == Leads::Right && !overlapping {
                assert_eq!(output.get::<O>(), *safe, "{}: {status:?}", self.name);
            }
        }
    }
}

/// A question with something wrong in it, or not.
fn attack_ask<I: Copy, O: Copy + PartialEq + Debug>(
    (name, ask, right): (&'static str, Ask<I, O>, &I),
    random: &mut Random,
    tally: &mut Tally,
) {
    let (mut input, mut output) = (Place::of::<I>(), Place::of::<O>());
    // SAFETY: the output is there, the input is null.
    let status = unsafe { ask(ptr::null(), output.pointer(Leads::Right)) };
    assert_eq!(status, atc_status::Null);
    let safe: O = output.get();
    input.put(right);
    match random.below(3) {
        0 => input.randomise(random),
        1 => input.spoil(random),
        _ => {}
    }
    let leads = [Leads::some(random), Leads::some(random)];
    // SAFETY: null, not aligned, or there.
    let status = unsafe { ask(input.pointer(leads[0]), output.pointer(leads[1])) };
    *tally.0.entry((name, status)).or_default() += 1;
    assert!(input.guarded() && output.guarded(), "{name}: written beside a place");
    assert!(status != atc_status::Ok || !leads.contains(&Leads::Nowhere), "{name}: {leads:?}");
    if status != atc_status::Ok && leads[1] == Leads::Right {
        assert_eq!(output.get::<O>(), safe, "{name}: {status:?}");
    }
}

/// A plan whose arrays are cut, spoiled, missing or said to be longer than there is room for.
fn wild_plan<Z: InC>(random: &mut Random, config: &mut Place, arrays: &mut Arrays<Z>, right: &Arrays<Z>) {
    arrays.clone_from(right);
    if random.one_in(2) {
        let route = random.below(arrays.routes.len());
        let wild = *random.pick(&[0, 1, 2, 3, 7, 8, 15, 16, 17, 255]).unwrap_or(&0);
        let one = &mut arrays.routes[route];
        match random.below(8) {
            0 => one.path_first = u16::from(wild) << 8,
            1 => one.path_length = wild.into(),
            2 => one.heading = wild,
            3 => one.speed_code = wild,
            4 => one.cab_signalled = wild,
            5 => one.conflicts = Z::routes(RouteSet::nth(random.below(RouteSet::<Z>::MOST))),
            6 => one.from = Z::segments(SegmentSet::nth(random.below(SegmentSet::<Z>::MOST))),
            _ => one.entry = Z::circuits(CircuitSet::nth(random.below(CircuitSet::<Z>::MOST))),
        }
    } else {
        // Cut, and as long as it says.
        match random.below(6) {
            0 => arrays.elements.truncate(random.below(arrays.elements.len())),
            1 => arrays.routes.truncate(random.below(arrays.routes.len())),
            2 => arrays.segment_circuits.truncate(random.below(arrays.segment_circuits.len())),
            3 => arrays.lengths_m.truncate(random.below(arrays.lengths_m.len())),
            4 => arrays.detectors.truncate(random.below(arrays.detectors.len())),
            _ => arrays.braking_m.truncate(random.below(arrays.braking_m.len())),
        }
        arrays.line_codes.truncate(arrays.lengths_m.len());
    }
    let mut given = arrays.config();
    // More than there is room for is never read.
    let most = CircuitSet::<Z>::MOST;
    let wild = *random.pick(&[most + 1, 1025, 1 << 20, usize::MAX / 2, usize::MAX]).unwrap_or(&0);
    match random.below(16) {
        0 => given.circuit_count = wild,
        1 => given.point_count = wild,
        2 => given.segment_count = wild,
        3 => given.route_count = wild,
        4 => given.element_count = wild.max(8193),
        5 => given.code_count = wild,
        6 => given.segment_circuit_count = wild.max(1025),
        7 => given.routes = ptr::null(),
        8 => given.elements = given.elements.wrapping_byte_add(1),
        9 => given.lengths_m = given.lengths_m.wrapping_byte_add(1),
        10 => given.detectors = ptr::null(),
        11 => given.line_codes = ptr::null(),
        _ => {}
    }
    config.put(&given);
}

fn spoil_or_not(random: &mut Random, config: &mut Place) {
    match random.below(3) {
        0 => config.randomise(random),
        1 => config.spoil(random),
        _ => {}
    }
}

macro_rules! target {
    ($name:literal, $start:ident, $step:ident, $config:expr, $input:expr) => {
        Target { name: $name, start: border::$start, step: border::$step, config: $config, input: $input }
    };
}
macro_rules! attack {
    ($target:ident, $other:expr) => {{
        let started = *call::start($target.start, &$target.config).expect("it is right");
        let safe = $target.safe();
        move |random: &mut Random, tally: &mut Tally, wild: &mut dyn FnMut(&mut Random, &mut Place)| {
            if random.one_in(3) {
                $target.attack_start(random, tally, &started, &mut |random, place| wild(random, place));
            } else {
                $target.attack_step(random, tally, &started, &safe, $other);
            }
        }
    }};
}
/// One call after the other, on all machines.
#[test]
fn calls_that_no_program_should_make() {
    station::on_a_large_stack(make_calls);
}

fn make_calls() {
    let asked = std::env::var("ATC_MALFORMED_CALLS").ok().and_then(|number| number.parse().ok());
    let calls: u64 = asked.unwrap_or(20_000);
    let mut random = Random::of(20_261_125, "malformed calls", 0);
    let mut tally = Tally::default();
    let (right, _) = station::passing_loop();
    let mut arrays = right.clone();

    let aspect: Target<atc_aspect, _, _, _> =
        target!("aspect", atc_aspect_start, atc_aspect_step, aspect_config(), atc_aspect_input { detected: 5 });
    let supervision: Target<atc_supervision, _, _, _> = target!(
        "supervision",
        atc_supervision_start,
        atc_supervision_step,
        atc_supervision_config { maximum: 4000, margin: 5 },
        atc_supervision_input { measured: 400, permitted: 450, has_measured: 1, has_permitted: 1 }
    );
    let block: Target<atc_block, _, _, _> =
        target!("block", atc_block_start, atc_block_step, block_config(), atc_block_input::default());
    let permitted: Target<atc_permitted, _, _, _> = target!(
        "permitted",
        atc_permitted_start,
        atc_permitted_step,
        permitted_config(),
        atc_permitted_input { has_analog: 1, analog: 450, ..atc_permitted_input::default() }
    );
    let deframer: Target<atc_deframer, u8, _, _> = Target {
        name: "deframer",
        start: start_deframer,
        step: border::atc_deframer_step,
        config: 0,
        input: atc_deframer_input { reception: 1 },
    };
    let interlocking: Target<atc_interlocking, atc_interlocking_config, _, _> = target!(
        "interlocking",
        atc_interlocking_start,
        atc_interlocking_step,
        right.config(),
        atc_interlocking_input::default()
    );
    let (hundred, _) = station::hundred_routes();
    let mut cut = hundred.clone();
    let large: Target<atc_large_interlocking, atc_large_interlocking_config, _, _> = target!(
        "large",
        atc_large_interlocking_start,
        atc_large_interlocking_step,
        hundred.config(),
        atc_large_interlocking_input::default()
    );
    let train: Target<atc_train, _, _, _> = target!(
        "train",
        atc_train_start,
        atc_train_step,
        wire::train_config(&atc_protocol::machine::train::Config::default()).expect("it has room"),
        wire::antennas(&wire::NOTHING_HEARD)
    );
    let pattern = atc_pattern_input { brake_mm_s2: 800, distance_m: 300, gradient_permille: -10 };
    let telegram = atc_telegram { kind: 1, ..atc_telegram::default() };
    let frame: atc_frame = call::ask(border::atc_telegram_encode, &telegram).1;

    let other = call::start::<atc_block, _>(border::atc_block_start, &block_config()).expect("it is right").opaque;
    let another = call::start::<atc_aspect, _>(border::atc_aspect_start, &aspect_config()).expect("it is right").opaque;
    let aspect = attack!(aspect, &other);
    let supervision = attack!(supervision, &other);
    let block = attack!(block, &another);
    let permitted = attack!(permitted, &another);
    let deframer = attack!(deframer, &other);
    let train = attack!(train, &other);
    let interlocking = attack!(interlocking, &another);
    let large = attack!(large, &another);
    for _ in 0..calls {
        let (random, tally) = (&mut random, &mut tally);
        match random.below(40) {
            0..=7 => aspect(random, tally, &mut spoil_or_not),
            8..=13 => supervision(random, tally, &mut spoil_or_not),
            14..=20 => block(random, tally, &mut spoil_or_not),
            21..=24 => permitted(random, tally, &mut spoil_or_not),
            25..=27 => train(random, tally, &mut spoil_or_not),
            28..=31 => deframer(random, tally, &mut spoil_or_not),
            32..=33 => attack_ask(("pattern", border::atc_pattern, &pattern), random, tally),
            34..=35 => attack_ask(("encode", border::atc_telegram_encode, &telegram), random, tally),
            36..=37 => attack_ask(("decode", border::atc_telegram_decode, &frame), random, tally),
            // A call takes some milliseconds.
            38 if random.one_in(6) => {
                large(random, tally, &mut |random, place| wild_plan(random, place, &mut cut, &hundred));
            }
            38 => attack_ask(("text", status_text, &0), random, tally),
            _ => interlocking(random, tally, &mut |random, place| wild_plan(random, place, &mut arrays, &right)),
        }
    }
    ended(&tally, calls);
}

/// How the calls ended: every way that must be among them is.
fn ended(tally: &Tally, calls: u64) {
    let all: u64 = tally.0.values().sum();
    assert_eq!(all, calls);
    for ((name, status), count) in &tally.0 {
        println!("{name:12} {status:?}: {count}");
    }
    let refused: u64 =
        tally.0.iter().filter(|((_, status), _)| *status != atc_status::Ok).map(|(_, count)| count).sum();
    println!("{calls} calls, {refused} of them refused; everything stands");
    for status in [atc_status::Null, atc_status::Misaligned, atc_status::TooSmall, atc_status::Overlap] {
        assert!(tally.0.contains_key(&("aspect", status)), "no call of aspect ended in {status:?}");
    }
    for status in [atc_status::NotStarted, atc_status::Damaged, atc_status::BadFlag] {
        assert!(tally.0.contains_key(&("block", status)), "no call of block ended in {status:?}");
    }
    for status in [atc_status::TooManyEntries, atc_status::BeyondArray, atc_status::Damaged, atc_status::Ok] {
        assert!(tally.0.contains_key(&("interlocking", status)), "no call of interlocking ended in {status:?}");
    }
    for status in [atc_status::TooManyEntries, atc_status::Damaged, atc_status::Ok] {
        assert!(tally.0.contains_key(&("large", status)), "no call of a large station ended in {status:?}");
    }
}

/// A deframer has no configuration.
unsafe extern "C" fn start_deframer(state: *mut core::ffi::c_void, size: usize, _: *const u8) -> atc_status {
    // SAFETY: that of this function.
    unsafe { border::atc_deframer_start(state, size) }
}

/// Any number may be asked for, and the sentence is read to its end.
unsafe extern "C" fn status_text(number: *const i32, length: *mut usize) -> atc_status {
    if number.is_null() || !number.is_aligned() || length.is_null() || !length.is_aligned() {
        if !length.is_null() && length.is_aligned() {
            // SAFETY: not null and aligned: it is there.
            unsafe { length.write(0) };
        }
        return atc_status::Null;
    }
    // SAFETY: both are there; a text ends with a zero byte.
    unsafe {
        let text = std::ffi::CStr::from_ptr(border::atc_status_text(*number));
        length.write(text.count_bytes());
    }
    atc_status::Ok
}

fn aspect_config() -> atc_aspect_config {
    let mut speeds = [0; 16];
    speeds[..4].copy_from_slice(&[250, 450, 650, 900]);
    atc_aspect_config {
        cycle_ms: 10,
        operate_ms: 300,
        recovery_ms: 400,
        mask_ms: 400,
        interruption_ms: 800,
        shortened_operate_ms: 100,
        aspect_count: 4,
        speeds,
    }
}

fn block_config() -> atc_block_config {
    atc_block_config { cycle_ms: 10, pass_ms: 10_000, sections: 5, max_trains: 3, tail_hold_sections: 1 }
}

fn permitted_config() -> atc_permitted_config {
    let mut speeds = [0; 16];
    speeds[..4].copy_from_slice(&[0, 250, 450, 900]);
    atc_permitted_config {
        cycle_ms: 10,
        fresh_ms: 2200,
        life_ms: 5000,
        fixed_life_ms: 10_000,
        memory_ms: 2000,
        speed_count: 4,
        speeds,
        brake_mm_s2: 800,
        margin_m: 10,
        lowest_rank: 1,
        worst_gradient_permille: -35,
        window: 3,
        run: 1,
    }
}
