//! The arithmetic of the train control kernel: whole numbers, each function with a contract over all of them.
//!
//! It stands in a crate of its own so that the prover Creusot can take it whole. A contract is a `cfg_attr(creusot, …)` above its
//! function; where Kani checks it too, the same for Kani stands beside it. `tests/contracts.rs` says each contract once more and
//! tries it on numbers at the limits and on drawn ones.
//!
//! | function | what it is for |
//! |---|---|
//! | [`divide_up`], [`divide_down`] | times in whole logic cycles |
//! | [`energy`], [`root`] | the braking pattern |
//! | [`part`], [`Quotient::digit`] | the train's position between two knots of its table |
//! | [`lowest_member`] | the lowest aspect of a set of any size |
//!
//! # In the house
//!
//! Uses no other crate of the house. Used by `atc-kernel`, `atc-proofs`. Begin with [`divide_up`].
#![no_std]
#![forbid(unsafe_code)]

mod energy;
mod members;
mod quotient;
mod rounding;

pub use energy::{ENERGY_END, energy, root};
pub use members::lowest_member;
pub use quotient::{Quotient, part};
pub use rounding::{divide_down, divide_up};
