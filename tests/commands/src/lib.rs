//! Tests of the commands and of what they write: protocol, charts, pages and the conformance kit.
//!
//! Most of their time is that of the programs that they call, so that they are optimised little and compiled fast. What searches for long is
//! in `tests/tests/`, `models/` and `tests/adversary/`.
//!
//! # In the house
//!
//! Uses `atc-kernel`, `atc-oracle`, `atc-protocol`. Used by no other crate of the house. Begin with
//! `tests/commands/tests/protocol`.

pub mod faulty;
