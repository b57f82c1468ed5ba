//! Stateright models of the train control system, over the real kernel.
//!
//! A model is one short file: state, action, next state, claims. The machine in it is the kernel's own `step`; ghosts
//! that a claim needs live in the model. Every search is exhaustive or says that it is not. States are told apart by
//! fingerprints of 64 bits: two of a million states are taken for one with a probability of about 3 in 100 million.
//!
//! | module | model |
//! |---|---|
//! | [`comparison`] | any detections: the device, the conventional one and the machine as claimed |
//! | [`interruption`] | one aspect alone, interrupted for every length |
//! | [`reception`] | ground, channel and train: the exposure to a stale aspect |
//! | [`bursts`] | how few bursts keep a stale aspect displayed for ever |
//! | [`block`] | trains, tails, borders and faults of block counting |
//! | [`permitted`] | the permitted speed: two kinds of line, lost and old telegrams, distances |
//! | [`interlocking`] | stations with trains, points, dispatchers and staff; two stations and the line between them |
//! | [`whole`] | the whole line: both stations' and both trains' whole devices, on metres |
//! | [`spin`] | the second opinion: models in Promela, searched by SPIN |
//! | [`replay`] | what the models of aspect acceptance have in common, and their traces |
//! | [`claimed`] | the machine as claimed by the patent, to compare with |
//!
//! [`catalogue`] lists the models with their parameters, [`check`] searches one.
//!
//! # In the house
//!
//! Uses `atc-kernel`, `atc-layout`, `atc-protocol`. Used by `atc-evidence`. Begin with [`comparison`] and
//! [`catalogue`].
#![forbid(unsafe_code)]

pub mod bench;
pub mod block;
pub mod bursts;
mod catalogue;
mod check;
pub mod claimed;
pub mod comparison;
mod explorer;
pub mod interlocking;
pub mod interruption;
pub mod line;
mod outcome;
pub mod permitted;
mod pool;
pub mod reception;
pub mod replay;
mod search;
pub mod spin;
mod subject;
pub mod train;
mod twin;
pub mod whole;

/// What the tests look at. A test of the library itself would compile all models once more.
#[doc(hidden)]
pub mod inside {
    pub use crate::check::shown;
    pub use crate::explorer::{Shown, Thing};
    pub use crate::spin::{Counted, counted, difference, refuted};
}

pub use catalogue::catalogue;
pub use check::{About, Entry, check, check_within, explore};
pub use outcome::{CutSet, Expectation, FailureMode, Outcome, PropertyOutcome, Searched, Step, Trace, Verdict};
pub use pool::in_parallel;
pub use search::{Visit, visit};
pub use spin::{Agreement, SecondOpinion};
pub use subject::{Checked, Claim, Limits, Subject};
