//! The verified kernel of an automatic train control (ATC) system.
//!
//! Every module is one part of the railway, written as a small *pure* state machine:
//! `step(state, input) -> (state, output)` by value, total, without heap, clock, floating point
//! or panic path. No dependency but the project's own [`atc_arithmetic`], whose functions have
//! contracts over all numbers. What is claimed of a machine stands as a sentence in `spec/`, above the
//! line that keeps it, and as a theorem in `proofs/`.
//!
//! | module | part | patent |
//! |---|---|---|
//! | [`aspect`] | on-board aspect acceptance with the shortened operate time | JP3886280B2 |
//! | [`supervision`] | speed against permitted speed: the brake | JP3886280B2 \[0009\] |
//! | [`block`] | train detection by block counting | JPS5937270B2 |
//! | [`telegram`] | frames, check and counters of the train control signal | JP4845985B2 |
//! | [`code`] | the speed that two analog code frequencies name | JP4845985B2 |
//! | [`pattern`] | the braking pattern | JP4845985B2 |
//! | [`permitted`] | the permitted speed from codes and telegrams | JP4845985B2 |
//! | [`position`] | the train's position from a level difference | JP4045174B2 |
//! | [`train`] | the on-board device: all of these in one step, from the antennas to the brake | JP4845985B2, JP3886280B2 |
//! | [`interlocking`] | routes, points, signals and the telegrams of every track circuit | JP4290933B2 |
//! | [`wayside`] | the ground's device as one machine: from detection to frames and codes | JP4290933B2, JP4845985B2 |
//! | [`duplex`] | two channels compared every cycle | JP3886280B2 \[0007\] |
//! | [`time`], [`speed`], [`distance`] | the units that all of them share | |
//!
//! Three principles:
//!
//! * **Parse, don't validate.** A parameter type has one constructor, which checks; `step` never meets an
//!   invalid one.
//! * **One invariant.** Every state has one `is_valid`; every proof assumes it before a step, and it is shown after, as a whole
//!   or (of pairs of routes) part by part. The initial state is valid and the most restrictive.
//! * **The fail-safe order is in the type.** Outputs are ordered, so that "safer" is a comparison:
//!   a lower [`aspect::Display`], a higher [`supervision::Brake`], more sections in [`block::Output::occupied`], a lower
//!   [`permitted::Permission`], a wider [`position::Interval`], fewer proceed aspects in [`interlocking::Output`].
//!
//! # In the house
//!
//! Uses `atc-arithmetic`. Used by `atc-adversary`, `atc-c`, `atc-commands`, `atc-evidence`, `atc-film-kernel`,
//! `atc-layout`, `atc-line`, `atc-models`, `atc-oracle`, `atc-proofs`, `atc-protocol`, `atc-prover`, `atc-python`,
//! `atc-simulation`, `atc-tests`, `atc-waveform`. Begin with [`aspect`], the smallest machine with a deadline.
#![no_std]
#![forbid(unsafe_code)]

pub mod aspect;
pub mod block;
pub mod code;
pub mod distance;
pub mod duplex;
pub mod heading;
pub mod interlocking;
pub mod pattern;
pub mod permitted;
pub mod position;
pub mod speed;
pub mod supervision;
pub mod telegram;
pub mod time;
pub mod train;
pub mod wayside;

/// A pure, total state machine. The machine itself is its (checked) parameters.
pub trait Machine {
    /// What the machine remembers from one logic cycle to the next.
    type State: Copy + Eq;
    /// What it reads in one logic cycle.
    type Input: Copy;
    /// What it commands in one logic cycle.
    type Output: Copy + Eq;

    /// The output that is safe whatever the circumstances.
    const SAFE: Self::Output;

    /// The valid and most restrictive state in which the machine starts.
    fn initial(&self) -> Self::State;

    /// One logic cycle.
    fn step(&self, state: Self::State, input: Self::Input) -> (Self::State, Self::Output);
}
