//! What a device can make of a cycle, worked out once: a matter of time only.

use super::ends::{Device, Read};
use super::faults::Faults;
use ahash::AHashMap;
use atc_kernel::interlocking::Input;
use std::hash::Hash;
use std::sync::Arc;

/// A device's state: its number among those that the model has met.
pub type Number = u32;

/// What a device makes of one cycle. What it has read first to come there stands for all.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Outcome {
    /// Its state.
    pub device: Number,
    /// It permits the other station to send.
    pub permits: bool,
    /// The places from which the next place is granted, by its signal or by a telegram: a mask.
    pub granted: u8,
    /// The circuits that count as occupied: a mask.
    pub occupied: u8,
    /// It permits, and has not verified the count since its start.
    pub unverified: bool,
    /// It has started again in this cycle.
    pub started: bool,
    /// What has failed to bring it there, of what is its own.
    pub failed: Faults,
    /// What it has read: the place among the inputs of the model.
    pub(super) read: u32,
}

/// What both devices read alike in a cycle, and how many heads each block has.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(super) struct Common<const B: usize> {
    /// Each block's check at the low end.
    pub low: [bool; B],
    /// Each block's check at the high end.
    pub high: [bool; B],
    /// The sections in which a head is heard.
    pub present: u16,
    /// How many heads are in each block.
    pub inside: [u8; B],
    /// What staff reset at both devices in this cycle, if they do that together.
    pub reset: [Option<u8>; B],
}

/// What a device may read in a cycle.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(super) struct Key<const B: usize> {
    pub station: usize,
    pub device: Number,
    pub common: Common<B>,
    /// The circuits that report a train: a mask.
    pub reported: u8,
    /// The circuits that may be reported without one: a mask.
    pub falsely: u8,
    /// Whether a permission may be missing, and may be read; and whether the newest message is one.
    pub consents: [bool; 2],
    pub newest: bool,
    pub may_start: bool,
    /// Blocks for which staff may take a wrong number.
    pub wrong_reset: [bool; B],
    pub together: bool,
}

/// What a device has read, for a trace.
#[derive(Clone, Copy, Debug)]
pub(super) struct Taken<const B: usize> {
    pub read: Read<B>,
    pub told: Input,
    pub agree: [bool; B],
}

/// What was worked out before: a device's states, and what it makes of a cycle.
#[derive(Debug)]
pub(super) struct Known<const B: usize> {
    pub devices: Vec<Device<B>>,
    numbers: AHashMap<Device<B>, Number>,
    pub taken: Vec<Taken<B>>,
    pub outcomes: AHashMap<Key<B>, Arc<[Outcome]>>,
    /// By the station, its device and what both read: which blocks agree.
    pub agreeing: AHashMap<(usize, Number, Common<B>), [bool; B]>,
}

impl<const B: usize> Default for Known<B> {
    fn default() -> Self {
        Self {
            devices: Vec::new(),
            numbers: AHashMap::new(),
            taken: Vec::new(),
            outcomes: AHashMap::new(),
            agreeing: AHashMap::new(),
        }
    }
}

/// A number of these.
fn small(count: usize) -> u32 {
    u32::try_from(count).expect("a model of fewer than 2^32 devices' states")
}

impl<const B: usize> Known<B> {
    /// The number of a device's state.
    pub fn number(&mut self, device: Device<B>) -> Number {
        let Self { devices, numbers, .. } = self;
        *numbers.entry(device).or_insert_with(|| {
            devices.push(device);
            small(devices.len() - 1)
        })
    }

    /// The state with this number.
    pub fn device(&self, number: Number) -> Device<B> {
        self.devices[number as usize]
    }

    /// Takes down what was read.
    pub fn take(&mut self, taken: Taken<B>) -> u32 {
        self.taken.push(taken);
        small(self.taken.len() - 1)
    }
}
