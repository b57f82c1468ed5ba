//! The theorems of the kernel, each as one harness that every engine runs.
//!
//! A harness draws arbitrary values, assumes what the theorem assumes, runs **one** step of the real kernel and
//! claims what the theorem says. What "arbitrary" means is the [`Engine`]'s business: all values at once (CBMC on
//! compiled code, Kani on MIR), or many chosen ones (the native tests, which also replay counterexamples).
//!
//! A theorem is stated on the fields of the state ([`atc_kernel::aspect::Parts`]) and on ghosts, never with the
//! kernel's own helpers: those may be wrong.
//!
//! # In the house
//!
//! Uses `atc-arithmetic`, `atc-kernel`. Used by `atc-evidence`, `atc-prover`. Begin with [`aspect`] and
//! [`Harness`].
#![no_std]
#![cfg_attr(not(engine = "cbmc"), forbid(unsafe_code))]

#[cfg(kani)]
#[macro_use]
mod kani_proofs;
#[macro_use]
mod harness;
mod engine;

pub mod aspect;
pub mod block;
pub mod code;
pub mod duplex;
pub mod interlocking;
pub mod pattern;
pub mod permitted;
pub mod position;
pub mod supervision;
pub mod telegram;
pub mod time;
pub mod train;
pub mod wayside;

#[cfg(kani)]
mod contracts;

pub use engine::{Engine, any_byte, any_flag, any_u32};
pub use harness::{Harness, Point};

/// The ranks of the aspect machine in the harnesses whose size is a parameter; 4 unless the environment variable
/// `ATC_ASPECTS` says otherwise (1 to 16) when this crate is compiled.
pub const ASPECTS: usize = match option_env!("ATC_ASPECTS") {
    Some(number) => harness::decimal(number),
    None => 4,
};

/// What the harnesses whose size is a parameter say of their bound at this size: nothing at 16, which is all there is.
pub const fn bound(aspects: usize) -> &'static str {
    match aspects {
        16 => "",
        4 => "4 aspects",
        _ => "another number of aspects than the 16 of the machine",
    }
}

/// All harnesses, module by module. Not there where some are chosen (`--cfg chosen`), or for the prover: then only those are compiled that are
/// called. A static, so that they are compiled here, optimised, and not again in each crate that runs them.
#[cfg(not(any(chosen, engine = "cbmc")))]
pub static HARNESSES: &[&[Harness]] = &[
    time::ALL,
    aspect::ALL,
    supervision::ALL,
    block::ALL,
    telegram::ALL,
    code::ALL,
    pattern::ALL,
    permitted::ALL,
    position::ALL,
    train::ALL,
    interlocking::ALL,
    wayside::ALL,
    duplex::ALL,
];
