//! What a device can make of a cycle, worked out once: a matter of time only.

use crate::interlocking::yard::Kept;
use ahash::AHashMap;
use atc_kernel::interlocking::Input;
use std::sync::Arc;

/// A device's state: its number among those that the model has met. A state of two devices is short so, and quick to compare.
pub type Number = usize;

/// What a device makes of one cycle. What it has read first to come there stands for all.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Outcome {
    /// Its state.
    pub device: Number,
    /// The routes that show proceed: a mask.
    pub proceed: u8,
    /// Whether it permits the other station to send.
    pub permits: bool,
    /// Whether it has started again in this cycle.
    pub started: bool,
    /// What it has read: the place among the inputs of the model.
    pub(super) read: usize,
}

/// What was worked out before: a device's states, and what it makes of a cycle.
#[derive(Debug, Default)]
pub(super) struct Known {
    pub(super) devices: Vec<Kept>,
    numbers: AHashMap<Kept, Number>,
    pub(super) inputs: Vec<Input>,
    /// By its state, what is really occupied, and whether there is a permission that it may read.
    pub(super) outcomes: AHashMap<(Number, u8, bool), Arc<[Outcome]>>,
}

impl Known {
    /// The number of a device's state.
    pub(super) fn number(&mut self, device: Kept) -> Number {
        *self.numbers.entry(device).or_insert_with(|| {
            self.devices.push(device);
            self.devices.len() - 1
        })
    }
}
