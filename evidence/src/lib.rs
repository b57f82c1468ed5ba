//! The safety case, generated from the proofs, models, tests and wrong kernels of this repository.
//!
//! Reading order: [`verdict`] (what a result is worth, and that a parent takes its worst child), [`plan`] (what is to
//! be shown, and the checks before anything runs), [`inputs`] (what the engines say, judged piece by piece),
//! [`argument`] (goals bound to evidence), [`build`] (the case), [`case`] (the case as data), and the renderings:
//! [`html`], [`gsn`], [`junit`], [`sarif`], [`tables`].
//!
//! The case is one value, [`case::Case`]; every output is a function of it. Nothing here decides what is true: it
//! reads what engines report, credits nothing that a report does not show, and never says more than its weakest part.
//!
//! # In the house
//!
//! Uses `atc-kernel`, `atc-layout`, `atc-line`, `atc-models`, `atc-oracle`, `atc-proofs`, `atc-protocol`,
//! `atc-prover`, `atc-simulation`. Used by no other crate of the house. Begin with [`case::Case`].
#![forbid(unsafe_code)]

pub mod again;
pub mod alike;
pub mod argument;
pub mod build;
pub mod case;
pub mod cli;
pub mod data;
pub mod error;
pub mod files;
pub mod gsn;
pub mod hazard;
pub mod html;
pub mod inputs;
pub mod junit;
pub mod line;
pub mod live;
pub mod merge;
pub mod open;
pub mod output;
pub mod plan;
pub mod progress;
pub mod prover;
pub mod results;
pub mod sarif;
pub mod scope;
pub mod srac;
pub mod stale;
pub mod station;
pub mod tables;
pub mod terminal;
pub mod times;
pub mod trace;
pub mod verdict;
