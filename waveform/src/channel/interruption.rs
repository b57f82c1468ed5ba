//! Times without a signal.

use super::Stage;
use crate::units::{Hertz, Seconds};

/// A time in which nothing arrives.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Interruption {
    /// When it begins, from the start of the stream.
    pub start: Seconds,
    /// How long it lasts.
    pub length: Seconds,
}

/// Silences the samples during the interruptions. What should go on meanwhile, such as noise, comes behind it in the channel.
pub struct Interruptions {
    /// First sample without, and first sample with the signal again.
    gaps: Vec<(u64, u64)>,
    at: u64,
}

impl Interruptions {
    /// Interruptions in any order; they may overlap.
    pub fn new(sample_rate: Hertz, interruptions: &[Interruption]) -> Self {
        let gap = |interruption: &Interruption| {
            let start = interruption.start.samples(sample_rate);
            (start, start.saturating_add(interruption.length.samples(sample_rate)))
        };
        Self { gaps: interruptions.iter().map(gap).collect(), at: 0 }
    }
}

impl Stage for Interruptions {
    fn apply(&mut self, block: &mut [f32]) {
        for sample in block {
            if self.gaps.iter().any(|&(start, end)| (start..end).contains(&self.at)) {
                *sample = 0.0;
            }
            self.at += 1;
        }
    }
}
