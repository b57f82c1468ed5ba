//! Tests across the folders. This library is what they share: charts drawn in ASCII, the devices that a chart
//! is checked against, sessions and drawn charts, trains under way, and the input of the
//! benchmarks; and a browser.
//!
//! # In the house
//!
//! Uses `atc-kernel`, `atc-layout`, `atc-oracle`, `atc-protocol`. Used by no other crate of the house. Begin with
//! `tests/tests/interlocking_situations.rs`.

pub mod approach;
pub mod block_chart;
pub mod browser;
pub mod busy_station;
pub mod device;
pub mod drawing;
pub mod ground;
pub mod passing_loop;
pub mod reception;
pub mod session;
pub mod sketch;
pub mod station_chart;
pub mod timing_chart;
pub mod traffic;
pub mod workload;

/// The examples of the READMEs, compiled and run.
#[doc = include_str!("../../README.md")]
#[doc = include_str!("../../kernel/README.md")]
#[cfg(doctest)]
pub struct Readme;
