//! A counted line between two stations, each with the kernel's device, and trains that follow each other from one to the other.
//!
//! Both devices read the same checks and detectors, and each counts by itself: block counting, the joint and the interlocking are the kernel's
//! ([`mod@ends`]). In every cycle each station is commanded anything or nothing. The sender sends while the receiver's permission lives. Trains go by
//! signals and, on the line, by telegrams; they pass a signal for some cycles after it fell. What may fail is [`Faults`].
//!
//! A train is where it is on the ground, never where a device has it.

pub mod cut_sets;
pub mod ends;
mod faults;
mod judge;
mod known;
mod readings;
mod subject;
mod trace;
mod trains;

pub use ends::Wiring;
pub use faults::{Around, Failure, Faults, Often};
pub use known::{Number, Outcome};

use super::between::Lives;
use ends::{Device, End, FIRST, PLATFORM, THROAT, ends};
use known::Known;
use std::hash::{Hash, Hasher};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

/// The most trains.
pub const TRAINS: usize = 3;
/// For how many cycles in a row a circuit may lose a train.
const LOSS: u8 = 1;
/// A train that is not in the model yet.
const COMING: u8 = u8::MAX;
/// The place in the array of each station.
const SENDER: usize = 0;
const RECEIVER: usize = 1;

/// A train. Its places count from the platform where it begins: 0 the platform, 1 the throat, then the sections, the throat of the receiver
/// and its platform, where it ends. It begins again when the platform is free.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Train {
    /// The place of its front.
    pub front: u8,
    /// The place of its rear: the same, or the one before.
    pub rear: u8,
    /// Cycles since the next place was granted to it, by the signal or the telegram; one more than the residual running if it was not.
    pub since: u8,
    /// The ends whose circuits have just lost it: 1 the front, 2 the rear.
    pub lost: u8,
}

impl Train {
    const fn coming(none: u8) -> Self {
        Self { front: COMING, rear: COMING, since: none, lost: 0 }
    }

    /// The places that it is in: a mask.
    const fn on(self) -> u8 {
        if self.front == COMING { 0 } else { 1 << self.front | 1 << self.rear }
    }
}

/// What was wrong in a cycle, a bit each. Nothing in a system that is right.
pub mod wrong {
    /// Two trains are in one place.
    pub const MET: u8 = 1;
    /// A section with a part of a train counts as clear at one of the devices.
    pub const UNREPORTED: u8 = 2;
    /// A signal shows proceed over a place with a train, or a telegram grants one to a train.
    pub const PROCEED: u8 = 4;
    /// The sender lets a train go without a permission that lives.
    pub const NO_CONSENT: u8 = 8;
    /// The receiver permits, and its count was never verified since its start.
    pub const UNVERIFIED: u8 = 16;
}

/// Two devices, the permissions between them, and the trains.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct State {
    /// The trains, the foremost first.
    pub trains: [Train; TRAINS],
    /// The sender's device and the receiver's.
    pub devices: [Number; 2],
    /// The permissions that the receiver has sent, the newest first: a bit for each cycle.
    pub sent: u8,
    /// What may fail.
    pub faults: Faults,
    /// What of it has begun to, where everything fails once.
    pub begun: Faults,
    /// A device has started again.
    pub restarted: bool,
    /// What was wrong in this cycle.
    pub wrong: u8,
}

impl Hash for State {
    /// In few numbers, which is quicker than field by field.
    fn hash<H: Hasher>(&self, hasher: &mut H) {
        let Self { trains, devices: [sender, receiver], sent, faults, begun, restarted, wrong } = *self;
        let mut all = [0; 16];
        for (bytes, train) in all.chunks_exact_mut(4).zip(trains) {
            bytes.copy_from_slice(&[train.front, train.rear, train.since, train.lost]);
        }
        all[12..15].copy_from_slice(&[sent, restarted.into(), wrong]);
        hasher.write_u128(u128::from_le_bytes(all));
        hasher.write_u64(u64::from(sender) << 32 | u64::from(receiver));
        hasher.write_u128(u128::from(faults.bits()) << 64 | u128::from(begun.bits()));
    }
}

/// One cycle: the trains after their moves, and what each device makes of it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Cycle {
    /// The trains.
    pub trains: [Train; TRAINS],
    /// What has failed in it of what both devices read alike.
    pub failed: Faults,
    /// What could have failed without being told from what is right.
    pub hidden: Faults,
    /// The devices.
    pub outcomes: [Outcome; 2],
}

/// What a model is there to show.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Purpose {
    /// Nothing goes wrong.
    Safe,
    /// Trains meet, and each of these assumptions excludes it.
    Hazard(&'static [&'static str]),
    /// Trains meet; which pairs of faults lead there, and which assumption excludes each.
    Pairs(&'static [&'static str]),
}

/// Which routes are withdrawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Withdraws {
    /// Any that is held, in any cycle.
    AtWill,
    /// Any that is in use, in any cycle: what has not let its train go.
    InUse,
}

/// The model: `B` blocks.
#[derive(Clone, Debug)]
pub struct CountedBetween<const B: usize> {
    /// Sections of each block.
    pub sections: u8,
    /// How many trains there are.
    pub trains: u8,
    /// For how long permissions and signals count.
    pub lives: Lives,
    /// What may fail in a run: each set is a run of its own.
    pub faults: Vec<Faults>,
    /// How often it does.
    pub often: Often,
    /// Which routes are withdrawn.
    pub withdraws: Withdraws,
    /// Whether trains go on along the line without a telegram: a wrong ground, on purpose.
    pub heedless: bool,
    /// How the devices are put together.
    pub wiring: Wiring,
    /// What the model is there to show.
    pub purpose: Purpose,
    /// Whether staff reset both devices in one cycle, or each when they like.
    pub resets_together: bool,
    levels: Faults,
    ends: [End<B>; 2],
    known: Arc<Mutex<Known<B>>>,
}

impl<const B: usize> CountedBetween<B> {
    /// A model.
    ///
    /// # Panics
    /// If the kernel rejects the stations; a test builds every model.
    pub fn new(sections: u8, trains: u8, lives: Lives, faults: Vec<Faults>, purpose: Purpose) -> Self {
        let ends = ends(sections, trains, lives, LOSS);
        Self {
            sections,
            trains,
            lives,
            faults,
            often: Often::AtWill,
            withdraws: Withdraws::AtWill,
            heedless: false,
            wiring: Wiring::Right,
            purpose,
            resets_together: false,
            levels: Faults::levels(sections, Self::blocks()),
            ends,
            known: Arc::default(),
        }
    }

    /// The same with these devices.
    #[must_use]
    pub fn wired(self, wiring: Wiring) -> Self {
        Self { wiring, known: Arc::default(), ..self }
    }

    /// The same where everything fails once.
    #[must_use]
    pub fn once(self) -> Self {
        Self { often: Often::Once, known: Arc::default(), ..self }
    }

    /// The same where only routes in use are withdrawn, and staff reset both devices together.
    #[must_use]
    pub fn orderly(self) -> Self {
        Self { withdraws: Withdraws::InUse, resets_together: true, known: Arc::default(), ..self }
    }

    /// The same with these sets of faults.
    #[must_use]
    pub fn with(&self, faults: Vec<Faults>) -> Self {
        Self { faults, ..self.clone() }
    }

    /// How many blocks.
    pub const fn blocks() -> u8 {
        B.to_le_bytes()[0]
    }

    fn all_sections(&self) -> u8 {
        self.sections * Self::blocks()
    }

    /// The throat of the receiver.
    fn beyond(&self) -> u8 {
        FIRST + self.all_sections()
    }

    /// Where a train ends: the receiver's platform.
    fn end(&self) -> u8 {
        self.beyond() + 1
    }

    /// The sections: a mask of places.
    fn line(&self) -> u8 {
        ((1 << self.all_sections()) - 1) << FIRST
    }

    /// The circuits that report by themselves, at each station.
    fn own(&self, station: usize) -> u8 {
        if station == SENDER {
            1 << PLATFORM | 1 << THROAT | 1 << self.beyond()
        } else {
            1 << self.beyond() | 1 << self.end()
        }
    }

    fn none(&self) -> u8 {
        self.lives.residual + 1
    }

    fn known(&self) -> MutexGuard<'_, Known<B>> {
        self.known.lock().unwrap_or_else(PoisonError::into_inner)
    }

    fn device(&self, number: Number) -> Device<B> {
        self.known().device(number)
    }
}
