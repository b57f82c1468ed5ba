//! Tests across the folders. This library is what they share: timing charts drawn in ASCII, the devices that a chart
//! is checked against, and the input of the benchmarks.

pub mod device;
pub mod timing_chart;
pub mod workload;
