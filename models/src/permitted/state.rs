//! What a model of the permitted speed remembers: train, ground, device, and what was seen for the claims.

use super::layout::POINTS;
use atc_kernel::permitted::{self, Basis, Heard, LineKind};
use atc_kernel::telegram::Stream;
use std::hash::{Hash, Hasher};

/// The train.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Train {
    /// Where its nose is, in cells.
    pub place: u8,
    /// By how many cells it moved in the last cycle.
    pub moved: u8,
    /// The kind of line that it was told last.
    pub told: Option<LineKind>,
    /// The position device, in millimetres from nearest to farthest.
    pub interval: Option<(u32, u32)>,
}

/// The ground.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Ground {
    /// The stopping point in force.
    pub point: u8,
    /// Per point: cycles since it was in force, counted to one more than the ground keeps it.
    pub point_age: [u16; POINTS],
    /// Whether the restriction is in force.
    pub restricted: bool,
    /// Cycles since it was not.
    pub free_age: u16,
    /// The stopping points of the last telegrams, the newest first, if the transmitter may loop.
    pub sent: [u8; POINTS],
    /// The telegram of its loop that the transmitter sent in this cycle, 1 the oldest; 0 if it is sound.
    pub repeats: u8,
}

/// The device's state, with a hash.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Kept(pub permitted::State);

impl Hash for Kept {
    fn hash<H: Hasher>(&self, hasher: &mut H) {
        let permitted::State { line, fix, target, behind, fixed, main_stream, sub_stream } = self.0;
        (line, fix).hash(hasher);
        for target in [target, behind] {
            target.map(|target| (target.section, target.beyond, target.limit, target.to_stop, target.age)).hash(hasher);
        }
        fixed.map(|fixed| fixed.map(|f| (f.section, f.gradient, f.limit, f.age))).hash(hasher);
        let stream =
            |stream: Stream| (stream.last.map(|last| (last.section, last.counter)), stream.in_order, stream.age);
        (stream(main_stream), stream(sub_stream)).hash(hasher);
    }
}

/// What the train is permitted.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Shown {
    /// The permitted speed in tenths of km/h.
    pub speed: Option<u16>,
    /// What it rests on.
    pub basis: Basis,
    /// Whether a code was heard.
    pub code: bool,
}

/// What was seen: for the claims.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Ghosts {
    /// Cycles since a main telegram arrived, or since the digital line began; counted to one more than anything asks for.
    pub silent: u16,
    /// Main telegrams that arrived from one section in as many cycles, counted to one more than the run.
    pub in_a_row: u8,
    /// On this digital line the device must know by now what telegrams say: enough came in a row, or it has lasted a life.
    pub informed: bool,
    /// The train was stopped on a digital line for want of telegrams.
    pub starved: bool,
    /// It was on an analog line, then on a digital one; and on an analog one again.
    pub crossed: u8,
    /// A main telegram of the section where the nose is has arrived since it came there, and no newer one has been sent since; nor has a late one
    /// arrived.
    pub current: bool,
}

/// Train, ground, device and what was seen.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct State {
    /// The train.
    pub train: Train,
    /// The ground.
    pub ground: Ground,
    /// The device.
    pub kept: Kept,
    /// What it permits.
    pub shown: Shown,
    /// For the claims.
    pub ghosts: Ghosts,
}

/// One logic cycle.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Cycle {
    /// The ground after it.
    pub ground: Ground,
    /// Whether the transmitter counted on.
    pub counted: bool,
    /// By how many cells the train moved.
    pub moved: u8,
    /// The position device after it.
    pub interval: Option<(u32, u32)>,
    /// What the device reads; counters are relative.
    pub heard: Heard,
}
