//! Tests across the folders. This library is what they share: charts drawn in ASCII, the devices that a chart
//! is checked against, and the input of the benchmarks.

pub mod approach;
pub mod block_chart;
pub mod device;
pub mod ground;
pub mod reception;
pub mod timing_chart;
pub mod traffic;
pub mod workload;

/// The examples of the README, compiled and run.
#[doc = include_str!("../../README.md")]
#[cfg(doctest)]
pub struct Readme;
