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
//! | [`claimed`] | the machine as claimed by the patent, to compare with |
//!
//! [`catalogue`] lists the models with their parameters, [`check`] searches one.
#![forbid(unsafe_code)]

pub mod assumptions;
pub mod bursts;
mod catalogue;
mod check;
pub mod claimed;
pub mod comparison;
pub mod interruption;
pub mod line;
mod outcome;
pub mod reception;
pub mod train;

pub use catalogue::catalogue;
pub use check::{About, Checked, Claim, Entry, Limits, Subject, check, check_within, explore};
pub use outcome::{Config, Expectation, Outcome, PropertyOutcome, Trace, TraceStep, Verdict};
