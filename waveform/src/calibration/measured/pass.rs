//! One pass: what was measured, and the line through it.

use crate::rail::{Decibels, Metres};

/// Standard deviations that are taken for certain: a normal error is beyond them once in 16 000 times.
pub const DEVIATIONS: f64 = 4.0;

/// One measurement: both levels at one place, as their difference.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Measurement {
    /// Distance of the antenna to the transmitter ahead, metres, 0 or more.
    pub distance: Metres,
    /// Level of the signal that the rail attenuates less, less the level of the other one, within ±300 dB.
    pub difference: Decibels,
}

/// The line through one pass.
#[derive(Clone, Debug, PartialEq)]
pub struct PassFit {
    /// The difference at the knots from [`first`](super::Fit::first) to [`last`](super::Fit::last), dB.
    pub knots: Vec<f64>,
    /// Measured less fitted, dB, for each measurement within the table, with its place in what was given.
    pub residuals: Vec<(usize, f64)>,
    /// One standard deviation of a measurement, dB.
    pub deviation: f64,
    /// Whether some knots had to be levelled.
    pub levelled: bool,
}
