//! The safety case, generated from the proofs, models, tests and wrong kernels of this repository.
//!
//! | folder | part |
//! |---|---|
//! | [`sources`] | what the case is made of: what engines, tests and files say, read and judged piece by piece |
//! | [`judge`] | what it amounts to: verdicts, the plan of what is to be shown, the argument, what is open |
//! | [`case`], [`station`] | the case as data; the part that is about one station |
//! | [`render`] | the same for its readers: HTML, GSN, JUnit, SARIF, CSV |
//! | [`cli`] | the commands, and the engines that they start |
//!
//! Reading order: [`judge::verdict`] (what a result is worth, and that a parent takes its worst child), [`judge::plan`]
//! (what is to be shown, and the checks before anything runs), [`sources`], [`judge::argument`] (goals bound to
//! evidence), [`judge::build`] (the case).
//!
//! The case is one value, [`case::Case`]; every output is a function of it. Nothing here decides what is true: it
//! reads what engines report, credits nothing that a report does not show, and never says more than its weakest part.
//!
//! # In the house
//!
//! Uses `atc-kernel`, `atc-layout`, `atc-line`, `atc-models`, `atc-oracle`, `atc-proofs`, `atc-protocol`,
//! `atc-prover`, `atc-simulation`. Used by no other crate of the house. Begin with [`case::Case`].
#![forbid(unsafe_code)]

pub mod case;
pub mod cli;
pub mod error;
#[cfg(test)]
mod front_pages;
pub mod judge;
pub mod render;
pub mod sources;
pub mod station;
