//! What the rail and its surroundings do to the signal: stages that change samples in place, one after the other.

mod crosstalk;
mod interruption;
mod noise;
mod traction;

pub use crosstalk::Crosstalk;
pub use interruption::{Interruption, Interruptions};
pub use noise::Noise;
pub use traction::{Harmonic, Traction};

/// One thing that happens to the signal on its way. Streaming: however the samples are cut into blocks, the result is
/// the same, and nothing is allocated. A closure over a block is a stage, so that a filter of any other origin fits in.
pub trait Stage {
    /// Changes the next samples in place.
    fn apply(&mut self, block: &mut [f32]);
}

impl<F: FnMut(&mut [f32])> Stage for F {
    fn apply(&mut self, block: &mut [f32]) {
        self(block);
    }
}

/// A constant gain, for a loss that is the same for all frequencies.
pub struct Gain(pub f32);

impl Stage for Gain {
    fn apply(&mut self, block: &mut [f32]) {
        for sample in block {
            *sample *= self.0;
        }
    }
}

/// Stages in the order in which they were added.
#[derive(Default)]
pub struct Channel {
    stages: Vec<Box<dyn Stage>>,
}

impl Channel {
    /// A channel that changes nothing yet.
    pub fn new() -> Self {
        Self::default()
    }

    /// The channel with one more stage behind the others.
    #[must_use]
    pub fn with(mut self, stage: impl Stage + 'static) -> Self {
        self.stages.push(Box::new(stage));
        self
    }
}

impl Stage for Channel {
    fn apply(&mut self, block: &mut [f32]) {
        for stage in &mut self.stages {
            stage.apply(block);
        }
    }
}
