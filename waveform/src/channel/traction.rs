//! Harmonics of the traction current.

use std::f64::consts::TAU;

use super::Stage;
use crate::units::{Hertz, Level};

/// One harmonic: its number (1 is the mains itself) and its amplitude.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Harmonic {
    /// The multiple of the mains frequency, from 1.
    pub number: u32,
    /// The amplitude.
    pub level: Level,
}

/// Sine waves at multiples of the mains frequency, added to the samples.
pub struct Traction {
    /// Cycles gone by, cycles for each sample, amplitude.
    waves: Vec<(f64, f64, f64)>,
}

impl Traction {
    /// Harmonics of a mains frequency. Each starts at another phase, so that their peaks do not fall together.
    pub fn new(sample_rate: Hertz, mains: Hertz, harmonics: &[Harmonic]) -> Self {
        let wave = |harmonic: &Harmonic| {
            let number = f64::from(harmonic.number);
            // Multiples of the golden ratio spread evenly over a cycle.
            ((number * 0.618_034).fract(), number * mains.0 / sample_rate.0, harmonic.level.0)
        };
        Self { waves: harmonics.iter().map(wave).collect() }
    }
}

impl Stage for Traction {
    #[allow(clippy::cast_possible_truncation)]
    fn apply(&mut self, block: &mut [f32]) {
        for sample in block {
            let mut sum = 0.0;
            for (phase, step, amplitude) in &mut self.waves {
                sum += *amplitude * (TAU * *phase).sin();
                *phase = (*phase + *step).fract();
            }
            *sample += sum as f32;
        }
    }
}
