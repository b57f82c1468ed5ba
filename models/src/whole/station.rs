//! A station's device, which makes the same of the same: what it made of a cycle is looked up where it is known.

use super::devices::{CIRCUITS, Ground, GroundState};
use super::faults::request;
use ahash::AHashMap;
use atc_kernel::Machine as _;
use atc_kernel::interlocking::{CircuitSet, Orders, Positions, RouteSet};
use atc_kernel::wayside::{Framed, Input, Message, Transmission};
use std::sync::{Arc, Mutex, PoisonError};

/// What a station reads in a cycle.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Read {
    /// The circuits that are reported occupied: a mask.
    pub occupied: u8,
    /// The position in which the point is detected.
    pub detected: Positions,
    /// What it is asked for, by number.
    pub asked: Option<u8>,
    /// Whether it has just started: staff unblock everything.
    pub starts: bool,
    /// The neighbour's message.
    pub message: Option<Message>,
    /// The circuits whose transmitters take no new frames: a mask.
    pub stuck: u8,
}

impl Read {
    /// As the kernel reads it.
    pub fn input(&self) -> Input<0, 1> {
        let all = Orders { unblock: CircuitSet::ALL, lift: CircuitSet::ALL, ..Orders::default() };
        let taken = CircuitSet::ALL.without(CircuitSet::from_bits(u64::from(self.stuck)));
        Input {
            blocks: [],
            occupied: CircuitSet::from_bits(u64::from(self.occupied)),
            detected: self.detected,
            request: self.asked.and_then(request::of),
            orders: if self.starts { all } else { Orders::default() },
            messages: [self.message],
            framed: Framed { main: taken, sub: taken },
        }
    }
}

/// What a station makes of a cycle.
#[derive(Clone, Debug)]
pub struct Put {
    /// Its device after it.
    pub after: GroundState,
    /// The signals at proceed.
    pub proceed: RouteSet,
    /// How the point is driven.
    pub drives: Positions,
    /// What the neighbour is told.
    pub message: Option<Message>,
    /// What is sent in each circuit.
    pub air: [Option<Transmission>; CIRCUITS.len()],
}

/// What is known of a device: what it made of what it read.
type Known = AHashMap<(GroundState, Read), Arc<Put>>;

/// A station's device.
#[derive(Clone, Debug)]
pub struct Station {
    device: Ground,
    known: Arc<Mutex<Known>>,
}

impl Station {
    /// The station of a device.
    pub fn new(device: Ground) -> Self {
        Self { device, known: Arc::default() }
    }

    /// The device.
    pub const fn device(&self) -> &Ground {
        &self.device
    }

    /// One cycle.
    pub fn cycle(&self, before: &GroundState, read: &Read) -> Arc<Put> {
        let mut known = self.known.lock().unwrap_or_else(PoisonError::into_inner);
        let made = || {
            let (after, output) = self.device.step(*before, read.input());
            Arc::new(Put {
                after,
                proceed: output.proceed,
                drives: output.drives,
                message: output.messages[0],
                air: std::array::from_fn(|circuit| output.transmissions[circuit]),
            })
        };
        Arc::clone(known.entry((*before, *read)).or_insert_with(made))
    }
}
