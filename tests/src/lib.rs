//! Tests across the folders. This library is what they share: timing charts drawn in ASCII, the devices that a chart
//! is checked against, and the input of the benchmarks.

pub mod device;
pub mod timing_chart;
pub mod workload;

/// The examples of the README, compiled and run.
#[doc = include_str!("../../README.md")]
#[cfg(doctest)]
pub struct Readme;
