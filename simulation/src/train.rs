//! A train: its body, its device, and what is kept of its run.

use atc_kernel::train::Cab;

use crate::motion::Body;
use crate::onboard::OnBoard;
use crate::track::Track;

/// The least distances of a run, in m.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Margins {
    /// From the front to the point where it must stop.
    pub stop_m: f64,
    /// The same, less the distance in which the train stops with the brake that the ground counts on.
    pub pattern_m: f64,
    /// From the front to the next train.
    pub train_m: f64,
}

impl Margins {
    /// Nothing was near yet.
    pub const FAR: Self = Self { stop_m: f64::INFINITY, pattern_m: f64::INFINITY, train_m: f64::INFINITY };

    /// The lesser of each.
    #[must_use]
    pub fn or_less(self, other: Self) -> Self {
        Self {
            stop_m: self.stop_m.min(other.stop_m),
            pattern_m: self.pattern_m.min(other.pattern_m),
            train_m: self.train_m.min(other.train_m),
        }
    }
}

/// A train with its device.
#[derive(Clone, Debug)]
pub struct Train {
    /// As a body.
    pub body: Body,
    /// What its device says.
    pub cab: Cab,
    /// The least distances so far.
    pub margins: Margins,
    /// How often its brake was commanded while it moved.
    pub applications: u32,
    /// How often a device that no interruption reached would not have braked.
    pub needless: u32,
    /// How many interruptions began while it moved and neither device braked.
    pub interrupted: u32,
    /// How often its brake was commanded, in motion, in a cycle in which the other kind of device, that heard the same,
    /// released it.
    pub alone: u32,
    /// How far it ran.
    pub ran_m: f64,
    /// When a circuit was last told to it as one that it may enter, in ms from the start, and one more.
    pub told_ms: Vec<u64>,
    pub(crate) onboard: OnBoard,
    pub(crate) beside: OnBoard,
    pub(crate) rival: OnBoard,
    /// The code in the rail at its front.
    pub(crate) sent: Option<u8>,
    /// Whether that has just changed: a code counts that was heard throughout a cycle.
    pub(crate) changed: bool,
    /// Since when nothing broke off what it hears, in ms.
    pub(crate) hears_ms: u64,
    /// How far it moved in the last cycle.
    pub(crate) moved_m: f64,
    pub(crate) braking_ms: Option<u64>,
    pub(crate) interruption: Option<usize>,
    pub(crate) counted: bool,
    /// Whether it is faster than it may be.
    pub(crate) too_fast: bool,
}

impl Train {
    /// A train at a stand whose device has just started.
    pub fn new(body: Body, circuits: usize) -> Self {
        Self {
            body,
            cab: Cab::STOP,
            margins: Margins::FAR,
            applications: 0,
            needless: 0,
            interrupted: 0,
            alone: 0,
            ran_m: 0.0,
            told_ms: vec![0; circuits],
            onboard: OnBoard::START,
            beside: OnBoard::START,
            rival: OnBoard::START,
            sent: None,
            changed: true,
            hears_ms: 0,
            moved_m: 0.0,
            braking_ms: None,
            interruption: None,
            counted: true,
            too_fast: false,
        }
    }

    /// Its device starts anew.
    pub fn restart(&mut self) {
        self.onboard = OnBoard::START;
    }

    /// The driver goes to the other end, where another device starts.
    pub fn turn(&mut self, track: &Track) {
        self.body.turn(track);
        (self.onboard, self.beside, self.rival) = (OnBoard::START, OnBoard::START, OnBoard::START);
        self.told_ms.fill(0);
    }
}
