//! The signal of a neighbouring circuit.

use super::Stage;
use crate::generator::Generator;
use crate::units::Decibels;

/// Another generator, added to the samples at a level below (or above) its own.
pub struct Crosstalk<M, S> {
    generator: Generator<M, S>,
    gain: f32,
}

impl<M, S> Crosstalk<M, S> {
    /// The neighbour, and its level here against its level of transmission (negative: weaker).
    #[allow(clippy::cast_possible_truncation)]
    pub fn new(generator: Generator<M, S>, level: Decibels) -> Self {
        Self { generator, gain: level.amplitude() as f32 }
    }
}

impl<M: Iterator<Item = bool>, S: Iterator<Item = bool>> Stage for Crosstalk<M, S> {
    fn apply(&mut self, block: &mut [f32]) {
        for sample in block {
            *sample += self.gain * self.generator.next_sample();
        }
    }
}
