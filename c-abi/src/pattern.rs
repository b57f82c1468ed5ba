//! The braking pattern behind the border: [`atc_kernel::pattern`]. It remembers nothing.

use atc_kernel::distance::Metres;
use atc_kernel::pattern::{Deceleration, pattern};
use atc_kernel::telegram::Gradient;

use crate::atc_status;

/// One question to the braking pattern.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct atc_pattern_input {
    /// The train's deceleration by its service brake on the level, in mm/s²: 1 to 4095.
    pub brake_mm_s2: u16,
    /// The distance in which the train must stop, in metres.
    pub distance_m: u16,
    /// The gradient in thousandths, positive where the train climbs.
    pub gradient_permille: i8,
}

/// The answer of the braking pattern. The safe one is 0.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct atc_pattern_output {
    /// The highest speed from which the train stops within the distance, in tenths of km/h: 0 to 4095.
    pub speed: u16,
}

/// The safe answer: stop.
pub(crate) const SAFE: atc_pattern_output = atc_pattern_output { speed: 0 };

pub(crate) fn answer(input: &atc_pattern_input) -> Result<atc_pattern_output, atc_status> {
    let brake = Deceleration::brake(input.brake_mm_s2).ok_or(atc_status::BadBrake)?;
    let speed = pattern(brake.on(Gradient(input.gradient_permille)), Metres(input.distance_m));
    Ok(atc_pattern_output { speed: speed.0 })
}
