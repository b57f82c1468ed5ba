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
mod trace;
mod trains;

pub use ends::Wiring;
pub use faults::{Around, Failure, Faults, Often};
pub use known::{Number, Outcome};

use super::between::Lives;
use crate::block::fault::{self, Kind};
use crate::outcome::{CutSet, Trace};
use crate::subject::{Claim, Limits, Subject};
use ends::{Device, End, FIRST, PLATFORM, THROAT, ends};
use known::{Key, Known};
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

impl<const B: usize> Subject for CountedBetween<B> {
    type State = State;
    type Action = Cycle;

    fn initial(&self) -> Vec<State> {
        let devices = [SENDER, RECEIVER].map(|station| {
            let end = &self.ends[station];
            let begin = end.initial();
            let made = end.prelude().into_iter().fold(begin, |device, read| end.step(device, read, self.wiring).device);
            self.known().number(made)
        });
        let trains = [Train::coming(self.none()); TRAINS];
        let state =
            State { trains, devices, sent: 1, faults: Faults::NONE, begun: Faults::NONE, restarted: false, wrong: 0 };
        let with = |faults: &Faults| {
            let mut state: State = state;
            state.faults = *faults;
            state
        };
        self.faults.iter().map(with).collect()
    }

    fn actions(&self, state: &State, cycles: &mut Vec<Cycle>) {
        if state.wrong & wrong::MET != 0 {
            return;
        }
        let faults = state.faults;
        let wrong_reset = std::array::from_fn(|block| faults.counting.has(Kind::WrongReset, block));
        let consents = [self.consents(state), [true, false]];
        let starts = [faults.has(Around::SenderStarts), faults.has(Around::ReceiverStarts)];
        // The circuit beyond the exit is one: where everything fails once, both devices read the same of it.
        let beyond = 1 << self.beyond();
        let alike = self.often == Often::Once && faults.has(Around::ReceiverThroat);
        let may_be = [0, beyond].into_iter().take(1 + usize::from(alike));
        for (trains, falsely) in self.ways(state).into_iter().flat_map(|way| may_be.clone().map(move |set| (way, set)))
        {
            let heard = Self::reported(&trains);
            if falsely & heard != 0 {
                continue;
            }
            let reported = heard | falsely;
            let passing = self.passing(state, &trains);
            for common in self.commons(state, passing) {
                let (failed, hidden) = self.failing(&trains, passing, &common);
                let failed = failed.and(Faults::around(Around::ReceiverThroat, falsely != 0));
                let [one, other] = [SENDER, RECEIVER].map(|station| {
                    self.outcomes(Key {
                        station,
                        device: state.devices[station],
                        common,
                        reported: reported & self.own(station),
                        falsely: self.falsely(station, faults),
                        consents: consents[station],
                        newest: state.sent & 1 == 1,
                        may_start: starts[station],
                        wrong_reset,
                        together: self.resets_together,
                    })
                });
                let pairs = one.iter().flat_map(|one| other.iter().map(move |other| [*one, *other]));
                cycles.extend(pairs.map(|outcomes| Cycle { trains, failed, hidden, outcomes }));
            }
        }
    }

    fn next(&self, state: &State, cycle: &Cycle) -> Option<State> {
        let living = u8::MAX >> (7 - self.lives.permission);
        let mut trains = cycle.trains;
        let wrong = self.wrong(state, &trains, &cycle.outcomes);
        for train in &mut trains {
            if train.front == COMING || train.front >= self.beyond() {
                train.since = self.none();
            } else {
                let since = (train.since + 1).min(self.none());
                train.since = if self.grants(train.front, &cycle.outcomes) { 0 } else { since };
            }
        }
        // The one that has ended is the last to come again.
        if trains[0].front == COMING && state.trains[0].front != COMING {
            trains[..usize::from(self.trains)].rotate_left(1);
            trains[usize::from(self.trains) - 1] = Train::coming(self.none());
        }
        let [sender, receiver] = cycle.outcomes;
        let (faults, begun) = self.left(state, cycle);
        Some(State {
            trains,
            devices: [sender.device, receiver.device],
            sent: (state.sent << 1 | u8::from(receiver.permits)) & living,
            faults,
            begun,
            restarted: state.restarted || self.purpose == Purpose::Safe && (sender.started || receiver.started),
            wrong,
        })
    }

    fn claims(&self) -> Vec<Claim<Self>> {
        let mut claims = vec![
            Claim::<Self>::always("valid", "both devices' states keep their invariant", |m, s| {
                [SENDER, RECEIVER].iter().all(|end| m.ends[*end].is_valid(&m.device(s.devices[*end])))
            }),
            Claim::<Self>::sometimes("two-on-the-line", "two trains are on the line", |m, s| {
                s.trains.iter().filter(|train| m.line() & train.on() != 0).count() > 1
            }),
        ];
        let met = |_: &_, s: &State| s.wrong & wrong::MET != 0;
        match self.purpose {
            Purpose::Hazard(excluded_by) | Purpose::Pairs(excluded_by) => {
                claims.push(Claim::<Self>::hazard("met", "two trains are in one place", excluded_by, met));
                return claims;
            }
            Purpose::Safe => {}
        }
        claims.extend([
            Claim::<Self>::always("never-met", "never are two trains in one place", |_, s| s.wrong & wrong::MET == 0),
            Claim::<Self>::always(
                "sections-occupied",
                "every section with any part of a train counts as occupied at both devices",
                |_, s| s.wrong & wrong::UNREPORTED == 0,
            ),
            Claim::<Self>::always(
                "proceed-over-clear",
                "no signal shows proceed over a place with a train, and no train is granted a place with another one",
                |_, s| s.wrong & wrong::PROCEED == 0,
            ),
            Claim::<Self>::always(
                "sent-by-permission",
                "the sender lets a train go only while a permission of the receiver lives",
                |_, s| s.wrong & wrong::NO_CONSENT == 0,
            ),
            Claim::<Self>::always(
                "permits-what-is-counted",
                "the receiver permits only if its count was verified since its start",
                |_, s| s.wrong & wrong::UNVERIFIED == 0,
            ),
            Claim::<Self>::sometimes("arrives", "a train is wholly in the receiver's platform", |m, s| {
                s.trains.iter().any(|train| train.rear == m.end())
            }),
            Claim::<Self>::sometimes("joint-held", "a tail is in the last section, its head in the throat", |m, s| {
                s.trains.iter().any(|train| train.front == m.beyond() && train.rear + 1 == m.beyond())
            }),
        ]);
        if self.faults.iter().any(|faults| faults.counting != fault::Faults::NONE) {
            claims.push(Claim::<Self>::sometimes(
                "arrives-after-a-fault",
                "a train has arrived, and the line behind it is all reported occupied by disagreement",
                |m, s| m.arrived_in_disagreement(s),
            ));
        }
        if self.faults.iter().any(|f| f.has(Around::SenderStarts) || f.has(Around::ReceiverStarts)) {
            claims.push(Claim::<Self>::sometimes(
                "sent-after-a-start",
                "a train is sent by a route that was set after a device started again",
                |m, s| m.sent_again(s),
            ));
        }
        claims
    }

    fn parameters(&self) -> String {
        let plan = self.ends[SENDER].layout.plan();
        format!(
            "two stations, between them a counted line of {B} block{} of {} sections, up to {} trains; turn time {} cycles, start {}, clear {}; \
             permissions live for {} cycles, a signal is passed up to {} after it fell; {} sets of faults",
            if B == 1 { "" } else { "s" },
            self.sections,
            self.trains,
            plan.turn.0,
            plan.start.0,
            plan.clear,
            self.lives.permission,
            self.lives.residual,
            self.faults.len(),
        )
    }

    fn trace(&self, path: &[(State, Option<Cycle>)]) -> Trace {
        self.run(path)
    }

    fn cut_sets(&self, limits: Limits) -> Option<Vec<CutSet>> {
        match self.purpose {
            Purpose::Pairs(_) => cut_sets::enumerate(self, limits),
            Purpose::Safe | Purpose::Hazard(_) => Some(Vec::new()),
        }
    }
}
