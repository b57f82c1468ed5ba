//! The border: every function of the header. Pointers of C are followed here and in `pointer`, and nowhere else.
#![allow(unsafe_code)]

use core::ffi::{c_char, c_void};

use atc_kernel::interlocking::{Large, Small};

use crate::aspect::{self, Aspect, atc_aspect, atc_aspect_config, atc_aspect_input, atc_aspect_output};
use crate::atc_status;
use crate::block::{self, Counted, atc_block, atc_block_config, atc_block_input, atc_block_output};
use crate::interlocking::{
    self as ilk, Arrays, ConfigOf, ElementOf, Fault, InC, LargeStation, RouteOf, SegmentOf, SmallStation,
    atc_interlocking, atc_interlocking_config, atc_interlocking_input, atc_interlocking_output, atc_large_interlocking,
    atc_large_interlocking_config, atc_large_interlocking_input, atc_large_interlocking_output, atc_place,
};
use crate::memory::ATC_VERSION;
use crate::pattern::{self, atc_pattern_input, atc_pattern_output};
use crate::permitted::{
    self, Permitting, atc_permitted, atc_permitted_config, atc_permitted_input, atc_permitted_output,
};
use crate::pointer::{Plain, apart, array, ask, read, start, step, usable};
use crate::supervision::{
    self, Supervised, atc_supervision, atc_supervision_config, atc_supervision_input, atc_supervision_output,
};
use crate::telegram::{self, Deframing, atc_deframer, atc_deframer_input, atc_frame, atc_telegram};
use crate::train::{self, OnBoard, atc_train, atc_train_config, atc_train_input, atc_train_output};

/// The plan of an interlocking.
///
/// # Safety
/// Pointers that are not null and are aligned lead to a configuration and to its arrays, as long as it says.
unsafe fn plan<const R: usize, const P: usize, const N: usize, const S: usize, Z: InC>(
    config: *const ConfigOf<Z>,
) -> Result<ilk::Plan<R, P, N, S, Z>, Fault>
where
    ConfigOf<Z>: Plain,
    Z::Circuits: Plain,
    SegmentOf<Z>: Plain,
    RouteOf<Z>: Plain,
    ElementOf<Z>: Plain,
{
    let gather = || {
        // SAFETY: by the contract of this function, which is that of each of these too.
        unsafe {
            let given = read(config)?;
            // A station has room for as many circuits as routes, and each circuit of a segment and each place of a path once.
            let codes = if given.line_codes.is_null() { 0 } else { given.circuit_count };
            let arrays = Arrays {
                lengths_m: array(given.lengths_m, given.circuit_count, R)?,
                line_codes: array(given.line_codes, codes, R)?,
                detectors: array(given.detectors, given.point_count, N)?,
                segments: array(given.segments, given.segment_count, S)?,
                segment_circuits: array(given.segment_circuits, given.segment_circuit_count, S * P)?,
                routes: array(given.routes, given.route_count, R)?,
                elements: array(given.elements, given.element_count, R * P)?,
                braking_m: array(given.braking_m, given.code_count, ilk::ATC_MAX_CODES)?,
            };
            Ok((given, arrays))
        }
    };
    let (given, arrays) = gather().map_err(|status| (status, atc_place::default()))?;
    ilk::layout(&given, &arrays)
}

/// Where a plan is wrong.
///
/// # Safety
/// Pointers that are not null and are aligned lead to a configuration and its arrays, as long as it says, and to a place.
unsafe fn check<const R: usize, const P: usize, const N: usize, const S: usize, Z: InC>(
    config: *const ConfigOf<Z>,
    place: *mut atc_place,
) -> atc_status
where
    ConfigOf<Z>: Plain,
    Z::Circuits: Plain,
    SegmentOf<Z>: Plain,
    RouteOf<Z>: Plain,
    ElementOf<Z>: Plain,
{
    if let Err(status) = usable(place).and_then(|()| apart(place, config)) {
        return status;
    }
    // SAFETY: by the contract of this function.
    let plan = unsafe { plan::<R, P, N, S, Z>(config) };
    let (status, found) = plan.err().unwrap_or((atc_status::Ok, atc_place::default()));
    // SAFETY: found usable above; by the contract of this function.
    unsafe { place.write(found) };
    status
}

/// The version of this library's border: `ATC_VERSION` of its header. A program compares the two once.
#[unsafe(no_mangle)]
pub extern "C" fn atc_version() -> u32 {
    ATC_VERSION
}

/// What a status means, as a sentence in ASCII that ends with a zero byte. Any number may be asked for. The text is
/// never
/// freed.
#[unsafe(no_mangle)]
pub extern "C" fn atc_status_text(status: i32) -> *const c_char {
    atc_status::text(status).as_ptr()
}

/// The size of an aspect acceptance in bytes: `ATC_ASPECT_SIZE`.
#[unsafe(no_mangle)]
pub extern "C" fn atc_aspect_size() -> usize {
    size_of::<atc_aspect>()
}

/// The alignment of an aspect acceptance in bytes: `ATC_ASPECT_ALIGN`.
#[unsafe(no_mangle)]
pub extern "C" fn atc_aspect_align() -> usize {
    align_of::<atc_aspect>()
}

/// Starts an aspect acceptance in the `size` bytes at `state`, which must be aligned: in its most restrictive state,
/// with these parameters.
///
/// If anything is wrong, the memory holds no state afterwards, and a step refuses it.
///
/// # Safety
/// `state` leads to `size` bytes of the caller's, `config` to a configuration. Nobody else uses them during the call.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn atc_aspect_start(
    state: *mut c_void,
    size: usize,
    config: *const atc_aspect_config,
) -> atc_status {
    // SAFETY: the caller keeps the contract.
    unsafe { start::<Aspect, atc_aspect>(state, size, || aspect::parameters(&read(config)?)) }
}

/// One logic cycle of an aspect acceptance: reads the aspects that were heard, and puts out the aspect that is
/// displayed.
///
/// If anything is wrong, the state is as before and the output is the safe one.
///
/// # Safety
/// The pointers lead to what they say, of the caller's. Nobody else uses it during the call.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn atc_aspect_step(
    state: *mut atc_aspect,
    input: *const atc_aspect_input,
    output: *mut atc_aspect_output,
) -> atc_status {
    // SAFETY: the caller keeps the contract.
    unsafe { step::<Aspect, _>(state, input, output) }
}

/// The size of a speed supervision in bytes: `ATC_SUPERVISION_SIZE`.
#[unsafe(no_mangle)]
pub extern "C" fn atc_supervision_size() -> usize {
    size_of::<atc_supervision>()
}

/// The alignment of a speed supervision in bytes: `ATC_SUPERVISION_ALIGN`.
#[unsafe(no_mangle)]
pub extern "C" fn atc_supervision_align() -> usize {
    align_of::<atc_supervision>()
}

/// Starts a speed supervision in the `size` bytes at `state`, which must be aligned: in its most restrictive state,
/// with these parameters.
///
/// If anything is wrong, the memory holds no state afterwards, and a step refuses it.
///
/// # Safety
/// `state` leads to `size` bytes of the caller's, `config` to a configuration. Nobody else uses them during the call.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn atc_supervision_start(
    state: *mut c_void,
    size: usize,
    config: *const atc_supervision_config,
) -> atc_status {
    // SAFETY: the caller keeps the contract.
    unsafe { start::<Supervised, atc_supervision>(state, size, || supervision::parameters(&read(config)?)) }
}

/// One logic cycle of a speed supervision: reads the measured and the permitted speed, and puts out the brake command.
///
/// If anything is wrong, the state is as before and the output is the safe one.
///
/// # Safety
/// The pointers lead to what they say, of the caller's. Nobody else uses it during the call.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn atc_supervision_step(
    state: *mut atc_supervision,
    input: *const atc_supervision_input,
    output: *mut atc_supervision_output,
) -> atc_status {
    // SAFETY: the caller keeps the contract.
    unsafe { step::<Supervised, _>(state, input, output) }
}

/// The size of a block in bytes: `ATC_BLOCK_SIZE`.
#[unsafe(no_mangle)]
pub extern "C" fn atc_block_size() -> usize {
    size_of::<atc_block>()
}

/// The alignment of a block in bytes: `ATC_BLOCK_ALIGN`.
#[unsafe(no_mangle)]
pub extern "C" fn atc_block_align() -> usize {
    align_of::<atc_block>()
}

/// Starts a block in the `size` bytes at `state`, which must be aligned: in its most restrictive state, with these
/// parameters.
///
/// If anything is wrong, the memory holds no state afterwards, and a step refuses it.
///
/// # Safety
/// `state` leads to `size` bytes of the caller's, `config` to a configuration. Nobody else uses them during the call.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn atc_block_start(
    state: *mut c_void,
    size: usize,
    config: *const atc_block_config,
) -> atc_status {
    // SAFETY: the caller keeps the contract.
    unsafe { start::<Counted, atc_block>(state, size, || block::parameters(&read(config)?)) }
}

/// One logic cycle of a block: reads what its checks and detectors say, and puts out what is occupied.
///
/// If anything is wrong, the state is as before and the output is the safe one.
///
/// # Safety
/// The pointers lead to what they say, of the caller's. Nobody else uses it during the call.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn atc_block_step(
    state: *mut atc_block,
    input: *const atc_block_input,
    output: *mut atc_block_output,
) -> atc_status {
    // SAFETY: the caller keeps the contract.
    unsafe { step::<Counted, _>(state, input, output) }
}

/// The size of a permitted speed in bytes: `ATC_PERMITTED_SIZE`.
#[unsafe(no_mangle)]
pub extern "C" fn atc_permitted_size() -> usize {
    size_of::<atc_permitted>()
}

/// The alignment of a permitted speed in bytes: `ATC_PERMITTED_ALIGN`.
#[unsafe(no_mangle)]
pub extern "C" fn atc_permitted_align() -> usize {
    align_of::<atc_permitted>()
}

/// Starts a permitted speed in the `size` bytes at `state`, which must be aligned: in its most restrictive state,
/// with these parameters.
///
/// If anything is wrong, the memory holds no state afterwards, and a step refuses it.
///
/// # Safety
/// `state` leads to `size` bytes of the caller's, `config` to a configuration. Nobody else uses them during the call.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn atc_permitted_start(
    state: *mut c_void,
    size: usize,
    config: *const atc_permitted_config,
) -> atc_status {
    // SAFETY: the caller keeps the contract.
    unsafe { start::<Permitting, atc_permitted>(state, size, || permitted::parameters(&read(config)?)) }
}

/// One logic cycle of a permitted speed: reads what is heard and measured, and puts out the permitted speed.
///
/// If anything is wrong, the state is as before and the output is the safe one.
///
/// # Safety
/// The pointers lead to what they say, of the caller's. Nobody else uses it during the call.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn atc_permitted_step(
    state: *mut atc_permitted,
    input: *const atc_permitted_input,
    output: *mut atc_permitted_output,
) -> atc_status {
    // SAFETY: the caller keeps the contract.
    unsafe { step::<Permitting, _>(state, input, output) }
}

/// The braking pattern: the highest speed from which a train stops in a distance. It needs no state. If anything is
/// wrong, the
/// output is 0.
///
/// # Safety
/// The pointers lead to what they say, of the caller's. Nobody else uses it during the call.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn atc_pattern(input: *const atc_pattern_input, output: *mut atc_pattern_output) -> atc_status {
    // SAFETY: the caller keeps the contract.
    unsafe { ask(input, output, pattern::SAFE, pattern::answer) }
}

/// The frame of a telegram. It needs no state. If anything is wrong, the frame is 106 zeros, which are no frame.
///
/// # Safety
/// The pointers lead to what they say, of the caller's. Nobody else uses it during the call.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn atc_telegram_encode(telegram: *const atc_telegram, frame: *mut atc_frame) -> atc_status {
    // SAFETY: the caller keeps the contract.
    unsafe { ask(telegram, frame, telegram::NO_FRAME, telegram::encode) }
}

/// The telegram of a frame. It needs no state. If the bits are no frame, the status says why, and the telegram is none.
///
/// # Safety
/// The pointers lead to what they say, of the caller's. Nobody else uses it during the call.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn atc_telegram_decode(frame: *const atc_frame, telegram: *mut atc_telegram) -> atc_status {
    // SAFETY: the caller keeps the contract.
    unsafe { ask(frame, telegram, telegram::NONE, telegram::decode) }
}

/// The size of a deframer in bytes: `ATC_DEFRAMER_SIZE`.
#[unsafe(no_mangle)]
pub extern "C" fn atc_deframer_size() -> usize {
    size_of::<atc_deframer>()
}

/// The alignment of a deframer in bytes: `ATC_DEFRAMER_ALIGN`.
#[unsafe(no_mangle)]
pub extern "C" fn atc_deframer_align() -> usize {
    align_of::<atc_deframer>()
}

/// Starts a deframer in the `size` bytes at `state`, which must be aligned: with no bit heard. It has no parameters.
///
/// # Safety
/// `state` leads to `size` bytes of the caller's. Nobody else uses them during the call.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn atc_deframer_start(state: *mut c_void, size: usize) -> atc_status {
    // SAFETY: the caller keeps the contract.
    unsafe { start::<Deframing, atc_deframer>(state, size, || Ok(())) }
}

/// One bit time of a deframer: reads what the receiver decided, and puts out the telegram whose last bit this one
/// is, or none.
///
/// If anything is wrong, the state is as before and the telegram is none.
///
/// # Safety
/// The pointers lead to what they say, of the caller's. Nobody else uses it during the call.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn atc_deframer_step(
    state: *mut atc_deframer,
    input: *const atc_deframer_input,
    telegram: *mut atc_telegram,
) -> atc_status {
    // SAFETY: the caller keeps the contract.
    unsafe { step::<Deframing, _>(state, input, telegram) }
}

/// The size of an on-board device in bytes: `ATC_TRAIN_SIZE`.
#[unsafe(no_mangle)]
pub extern "C" fn atc_train_size() -> usize {
    size_of::<atc_train>()
}

/// The alignment of an on-board device in bytes: `ATC_TRAIN_ALIGN`.
#[unsafe(no_mangle)]
pub extern "C" fn atc_train_align() -> usize {
    align_of::<atc_train>()
}

/// Starts an on-board device in the `size` bytes at `state`, which must be aligned: nothing is heard or known, and the emergency
/// brake is on.
///
/// If anything is wrong, the memory holds no state afterwards, and a step refuses it.
///
/// # Safety
/// `state` leads to `size` bytes of the caller's, `config` to a configuration. Nobody else uses them during the call.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn atc_train_start(
    state: *mut c_void,
    size: usize,
    config: *const atc_train_config,
) -> atc_status {
    // SAFETY: the caller keeps the contract.
    unsafe { start::<OnBoard, atc_train>(state, size, || train::parameters(&read(config)?)) }
}

/// One logic cycle of an on-board device: reads what the antennas give, and puts out the display, the permitted speed, the position
/// and the brake.
///
/// If anything is wrong, the state is as before and the output is the safe one.
///
/// # Safety
/// The pointers lead to what they say, of the caller's. Nobody else uses it during the call.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn atc_train_step(
    state: *mut atc_train,
    input: *const atc_train_input,
    output: *mut atc_train_output,
) -> atc_status {
    // SAFETY: the caller keeps the contract.
    unsafe { step::<OnBoard, _>(state, input, output) }
}

/// The size of an interlocking in bytes: `ATC_INTERLOCKING_SIZE`.
#[unsafe(no_mangle)]
pub extern "C" fn atc_interlocking_size() -> usize {
    size_of::<atc_interlocking>()
}

/// The alignment of an interlocking in bytes: `ATC_INTERLOCKING_ALIGN`.
#[unsafe(no_mangle)]
pub extern "C" fn atc_interlocking_align() -> usize {
    align_of::<atc_interlocking>()
}

/// Checks a plan without starting anything, and says where it breaks a rule. If it breaks none, the place is all zeros.
///
/// # Safety
/// The pointers lead to what they say, and each array of the configuration has as many entries as it says.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn atc_interlocking_check_plan(
    config: *const atc_interlocking_config,
    place: *mut atc_place,
) -> atc_status {
    // SAFETY: the caller keeps the contract.
    unsafe { check::<64, 16, 32, 8, Small>(config, place) }
}

/// Starts an interlocking in the `size` bytes at `state`, which must be aligned: in its most restrictive state, on
/// this plan.
///
/// If anything is wrong, the memory holds no state afterwards, and a step refuses it. `atc_interlocking_check_plan`
/// says where
/// a plan is wrong.
///
/// # Safety
/// `state` leads to `size` bytes of the caller's, `config` to a configuration, each array of which has as many
/// entries as it
/// says. Nobody else uses them during the call.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn atc_interlocking_start(
    state: *mut c_void,
    size: usize,
    config: *const atc_interlocking_config,
) -> atc_status {
    // SAFETY: the caller keeps the contract.
    unsafe { start::<SmallStation, atc_interlocking>(state, size, || plan(config).map_err(|(status, _)| status)) }
}

/// One logic cycle of an interlocking: reads detection, requests, orders and consent, and puts out signals, points
/// and telegrams.
///
/// If anything is wrong, the state is as before and the output is the safe one.
///
/// # Safety
/// The pointers lead to what they say, of the caller's. Nobody else uses it during the call.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn atc_interlocking_step(
    state: *mut atc_interlocking,
    input: *const atc_interlocking_input,
    output: *mut atc_interlocking_output,
) -> atc_status {
    // SAFETY: the caller keeps the contract.
    unsafe { step::<SmallStation, _>(state, input, output) }
}

/// The size of an interlocking of a large station in bytes: `ATC_LARGE_INTERLOCKING_SIZE`.
#[unsafe(no_mangle)]
pub extern "C" fn atc_large_interlocking_size() -> usize {
    size_of::<atc_large_interlocking>()
}

/// The alignment of an interlocking of a large station in bytes: `ATC_LARGE_INTERLOCKING_ALIGN`.
#[unsafe(no_mangle)]
pub extern "C" fn atc_large_interlocking_align() -> usize {
    align_of::<atc_large_interlocking>()
}

/// Checks the plan of a large station without starting anything, and says where it breaks a rule. If it breaks none, the place is all zeros.
///
/// # Safety
/// The pointers lead to what they say, and each array of the configuration has as many entries as it says.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn atc_large_interlocking_check_plan(
    config: *const atc_large_interlocking_config,
    place: *mut atc_place,
) -> atc_status {
    // SAFETY: the caller keeps the contract.
    unsafe { check::<256, 32, 128, 32, Large>(config, place) }
}

/// Starts an interlocking of a large station in the `size` bytes at `state`, which must be aligned: in its most restrictive state, on
/// this plan.
///
/// If anything is wrong, the memory holds no state afterwards, and a step refuses it. `atc_large_interlocking_check_plan`
/// says where
/// a plan is wrong.
///
/// # Safety
/// `state` leads to `size` bytes of the caller's, `config` to a configuration, each array of which has as many
/// entries as it
/// says. Nobody else uses them during the call.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn atc_large_interlocking_start(
    state: *mut c_void,
    size: usize,
    config: *const atc_large_interlocking_config,
) -> atc_status {
    // SAFETY: the caller keeps the contract.
    unsafe { start::<LargeStation, atc_large_interlocking>(state, size, || plan(config).map_err(|(status, _)| status)) }
}

/// One logic cycle of an interlocking of a large station: reads detection, requests, orders and consent, and puts out signals, points
/// and telegrams.
///
/// If anything is wrong, the state is as before and the output is the safe one.
///
/// # Safety
/// The pointers lead to what they say, of the caller's. Nobody else uses it during the call.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn atc_large_interlocking_step(
    state: *mut atc_large_interlocking,
    input: *const atc_large_interlocking_input,
    output: *mut atc_large_interlocking_output,
) -> atc_status {
    // SAFETY: the caller keeps the contract.
    unsafe { step::<LargeStation, _>(state, input, output) }
}
