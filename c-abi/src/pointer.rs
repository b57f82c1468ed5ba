//! The pointers of C: what is checked of each, and the reading and writing through it.
//!
//! What can be told of a pointer is checked: null, alignment, the size that goes with it, overlap. That it leads to
//! memory of the caller's, which nobody else uses during the call, cannot be told from here: that is the caller's part
//! of each function.
#![allow(unsafe_code)]

use core::ffi::c_void;
use core::slice;

use crate::aspect::{atc_aspect_config, atc_aspect_input, atc_aspect_output};
use crate::atc_status;
use crate::block::{atc_block_config, atc_block_input, atc_block_output};
use crate::interlocking::{
    atc_element, atc_interlocking_config, atc_interlocking_input, atc_interlocking_output, atc_large_element,
    atc_large_interlocking_config, atc_large_interlocking_input, atc_large_interlocking_output, atc_large_route,
    atc_large_segment, atc_place, atc_route, atc_segment, atc_set256,
};
use crate::memory::{self, Machine};
use crate::pattern::{atc_pattern_input, atc_pattern_output};
use crate::permitted::{atc_permitted_config, atc_permitted_input, atc_permitted_output};
use crate::supervision::{atc_supervision_config, atc_supervision_input, atc_supervision_output};
use crate::telegram::{atc_deframer_input, atc_frame, atc_telegram};
use crate::train::{atc_train_config, atc_train_input, atc_train_output};

/// Plain data of C.
///
/// # Safety
/// Whatever bytes stand there are a value: numbers, and pointers that nobody follows unchecked.
pub unsafe trait Plain: Copy {}

macro_rules! plain {
    ($($data:ty)*) => {
        // SAFETY: a number, or a structure of C that has numbers, arrays of numbers and raw pointers only.
        $(unsafe impl Plain for $data {})*
    };
}

plain!(u8 u16 u64 atc_aspect_config atc_aspect_input atc_aspect_output);
plain!(atc_supervision_config atc_supervision_input atc_supervision_output);
plain!(atc_block_config atc_block_input atc_block_output atc_pattern_input atc_pattern_output);
plain!(atc_permitted_config atc_permitted_input atc_permitted_output atc_telegram atc_frame atc_deframer_input);
plain!(atc_train_config atc_train_input atc_train_output);
plain!(atc_element atc_route atc_segment atc_place);
plain!(atc_interlocking_config atc_interlocking_input atc_interlocking_output);
plain!(atc_set256 atc_large_element atc_large_route atc_large_segment);
plain!(atc_large_interlocking_config atc_large_interlocking_input atc_large_interlocking_output);

/// What can be told of a pointer.
pub fn usable<T>(pointer: *const T) -> Result<(), atc_status> {
    match (pointer.is_null(), pointer.is_aligned()) {
        (true, _) => Err(atc_status::Null),
        (false, false) => Err(atc_status::Misaligned),
        (false, true) => Ok(()),
    }
}

/// Whether two places have no byte in common.
pub fn apart<T, U>(one: *const T, other: *const U) -> Result<(), atc_status> {
    let (first, second) = (one.addr(), other.addr());
    let before = first.checked_add(size_of::<T>()).is_some_and(|end| end <= second);
    let after = second.checked_add(size_of::<U>()).is_some_and(|end| end <= first);
    if before || after { Ok(()) } else { Err(atc_status::Overlap) }
}

/// Reads what C gives.
///
/// # Safety
/// A pointer that is not null and is aligned leads to a `T` of the caller's.
pub unsafe fn read<T: Plain>(pointer: *const T) -> Result<T, atc_status> {
    usable(pointer)?;
    // SAFETY: not null, aligned, and by the contract of this function the caller's; any bytes are a `T`.
    Ok(unsafe { pointer.read() })
}

/// An array of C with `count` entries, at most `most`. It may be null if it has none.
///
/// # Safety
/// A pointer that is not null and is aligned leads to `count` entries of the caller's, which nobody writes during `'a`.
pub unsafe fn array<'a, T: Plain>(pointer: *const T, count: usize, most: usize) -> Result<&'a [T], atc_status> {
    if count > most {
        return Err(atc_status::TooManyEntries);
    }
    if count == 0 {
        return Ok(&[]);
    }
    usable(pointer)?;
    // SAFETY: not null, aligned, at most 8192 entries, by the contract of this function the caller's; any bytes are
    // a `T`.
    Ok(unsafe { slice::from_raw_parts(pointer, count) })
}

/// Writes what was put out, or the safe output, and says what became of the call.
///
/// # Safety
/// `output` was found usable, and leads to an `O` of the caller's.
pub unsafe fn put<O: Plain>(output: *mut O, safe: O, result: Result<O, atc_status>) -> atc_status {
    // SAFETY: by the contract of this function.
    unsafe { output.write(result.unwrap_or(safe)) };
    result.err().unwrap_or(atc_status::Ok)
}

/// A question and its answer, without a state.
///
/// # Safety
/// Pointers that are not null and are aligned lead to an `I` and an `O` of the caller's.
pub unsafe fn ask<I: Plain, O: Plain>(
    input: *const I,
    output: *mut O,
    safe: O,
    answer: impl Fn(&I) -> Result<O, atc_status>,
) -> atc_status {
    if let Err(status) = usable(output).and_then(|()| apart(output, input)) {
        return status;
    }
    // SAFETY: by the contract of this function.
    let result = unsafe { read(input) }.and_then(|input| answer(&input));
    // SAFETY: found usable above.
    unsafe { put(output, safe, result) }
}

/// Starts a machine of type `T` in the caller's memory. If that fails, what was there is no state any more.
///
/// # Safety
/// A pointer that is not null and is aligned leads to `size` bytes of the caller's, which nobody else uses during
/// the call.
pub unsafe fn start<M: Machine, T>(
    state: *mut c_void,
    size: usize,
    parameters: impl FnOnce() -> Result<M::Parameters, atc_status>,
) -> atc_status {
    if let Err(status) = usable(state.cast::<T>()) {
        return status;
    }
    if size < size_of::<T>() {
        // SAFETY: not null, and `size` bytes are by the contract of this function the caller's.
        memory::forget(unsafe { slice::from_raw_parts_mut(state.cast::<u8>(), size) });
        return atc_status::TooSmall;
    }
    // Before the state's bytes are borrowed: the arrays of a configuration may lie among them.
    let parameters = &parameters();
    // SAFETY: not null, long enough, by the contract of this function the caller's; C's memory has a value in every
    // byte.
    let bytes = unsafe { slice::from_raw_parts_mut(state.cast::<u8>(), size_of::<T>()) };
    match parameters {
        Ok(parameters) => {
            memory::start::<M>(bytes, parameters);
            atc_status::Ok
        }
        Err(status) => {
            memory::forget(bytes);
            *status
        }
    }
}

/// One logic cycle of the machine in the state.
///
/// # Safety
/// Pointers that are not null and are aligned lead to a `T`, an input and an output of the caller's, which nobody
/// else uses
/// during the call.
pub unsafe fn step<M: Machine, T>(state: *mut T, input: *const M::Input, output: *mut M::Output) -> atc_status
where
    M::Input: Plain,
    M::Output: Plain,
{
    let output_alone = usable(output).and_then(|()| apart(output, state)).and_then(|()| apart(output, input));
    if let Err(status) = output_alone {
        return status;
    }
    let stepped = usable(state).and_then(|()| usable(input)).and_then(|()| apart(state, input)).and_then(|()| {
        // SAFETY: not null, aligned, apart from the state, by the contract of this function the caller's.
        let input = unsafe { read(input)? };
        // SAFETY: not null, by the contract of this function the caller's; C's memory has a value in every byte.
        let bytes = unsafe { slice::from_raw_parts_mut(state.cast::<u8>(), size_of::<T>()) };
        memory::step::<M>(bytes, &input)
    });
    // SAFETY: found usable above.
    unsafe { put(output, M::SAFE, stepped) }
}
