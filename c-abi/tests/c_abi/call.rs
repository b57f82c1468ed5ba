//! The functions of the header, called as a C program calls them, with states that are really there.

use std::mem::MaybeUninit;

use atc_c::atc_status;

/// A function that starts a machine.
pub type Start<C> = unsafe extern "C" fn(*mut core::ffi::c_void, usize, *const C) -> atc_status;

/// A function that steps it.
pub type Step<S, I, O> = unsafe extern "C" fn(*mut S, *const I, *mut O) -> atc_status;

/// A function without a state.
pub type Ask<I, O> = unsafe extern "C" fn(*const I, *mut O) -> atc_status;

/// A state in memory that held something else before.
pub fn start<S, C>(start: Start<C>, config: &C) -> Result<Box<S>, atc_status> {
    let mut state = Box::<S>::new_uninit();
    // SAFETY: memory of the size of an `S`, every byte of which is written; all states are arrays of numbers.
    let mut state = unsafe {
        state.as_mut_ptr().cast::<u8>().write_bytes(0xA5, size_of::<S>());
        state.assume_init()
    };
    // SAFETY: a state of this size and a configuration, both of this function's.
    match unsafe { start((&raw mut *state).cast(), size_of::<S>(), config) } {
        atc_status::Ok => Ok(state),
        status => Err(status),
    }
}

/// A step; the output is there whatever becomes of it.
pub fn step<S, I, O>(step: Step<S, I, O>, state: &mut S, input: &I) -> (atc_status, O) {
    let mut output = MaybeUninit::<O>::zeroed();
    // SAFETY: a state, an input and room for an output, all of this function's.
    let status = unsafe { step(state, input, output.as_mut_ptr()) };
    // SAFETY: all bytes were written; outputs are structures of numbers.
    (status, unsafe { output.assume_init() })
}

/// A question.
pub fn ask<I, O>(ask: Ask<I, O>, input: &I) -> (atc_status, O) {
    let mut output = MaybeUninit::<O>::zeroed();
    // SAFETY: an input and room for an output, both of this function's.
    let status = unsafe { ask(input, output.as_mut_ptr()) };
    // SAFETY: all bytes were written; outputs are structures of numbers.
    (status, unsafe { output.assume_init() })
}
