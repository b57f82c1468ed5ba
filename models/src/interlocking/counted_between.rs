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
mod known;

pub use ends::Wiring;
pub use faults::{Around, Failure, Faults, Often};
pub use known::{Number, Outcome};

use super::between::Lives;
use super::trace::Run;
use crate::block::fault::{self, Kind};
use crate::check::{Claim, Limits, Subject};
use crate::outcome::{CutSet, Trace};
use atc_kernel::block::{Detection, SectionSet, TrainCount};
use atc_kernel::interlocking::{Phase, Request, Travel};
use ends::{Device, End, FIRST, PLATFORM, Read, THROAT, circuits, ends, route, start_orders, the_line, turn};
use known::{Common, Key, Known, Taken};
use serde_json::{Value, json};
use std::collections::BTreeMap;
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

/// What passes in a cycle.
#[derive(Clone, Copy, Debug)]
struct Passing<const B: usize> {
    /// A head passes the entry of each block, and last the exit of the line: a mask.
    enters: u8,
    /// The sections with a head: a mask.
    heard: u8,
    /// How many heads are in each block.
    inside: [u8; B],
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

    /// Where a train may be a cycle later. `None`: it has ended.
    fn moves(&self, train: Train, may_come: bool) -> Vec<Option<Train>> {
        let mut ways = vec![Some(train)];
        if train.front == COMING {
            if may_come {
                ways.push(Some(Train { front: PLATFORM, rear: PLATFORM, since: self.none(), lost: 0 }));
            }
        } else if train.front != train.rear {
            let lost = if train.lost & 1 == 1 { 3 } else { 0 };
            ways.push(Some(Train { rear: train.front, lost, ..train }));
        } else if train.front == self.end() {
            ways.push(None);
        } else if train.front == self.beyond() || train.since <= self.lives.residual || self.heedless {
            // Its rear stays where the whole train was.
            let lost = train.lost & 2;
            ways.push(Some(Train { front: train.front + 1, since: self.none(), lost, ..train }));
        }
        ways
    }

    /// Which ends of a train its circuits may lose in this cycle. `after` has what they lost in the cycle before.
    fn losses(&self, before: Train, after: Train, may: bool) -> Vec<u8> {
        let own = self.own(SENDER) | self.own(RECEIVER);
        if !may || after.front == COMING || before.front == COMING {
            return vec![0];
        }
        let mut ways = Vec::new();
        for lost in 0..4_u8 {
            let again = lost & after.lost != 0;
            let of_a_circuit = [(1, after.front), (2, after.rear)]
                .into_iter()
                .all(|(end, place)| lost & end == 0 || own >> place & 1 == 1);
            let alike = after.front != after.rear || lost == 0 || lost == 3;
            if !again && of_a_circuit && alike {
                ways.push(lost);
            }
        }
        ways
    }

    /// All ways in which the trains may move, what passes, and what their circuits lose.
    fn ways(&self, state: &State) -> Vec<[Train; TRAINS]> {
        let platform_free = state.trains.iter().all(|train| train.on() & 1 << PLATFORM == 0);
        let first_coming = state.trains.iter().position(|train| train.front == COMING);
        let may_lose = state.faults.has(Around::Lost);
        let mut ways = vec![state.trains];
        for (number, train) in state.trains.iter().enumerate().take(self.trains.into()) {
            let mut next = Vec::new();
            for after in self.moves(*train, platform_free && first_coming == Some(number)) {
                match after {
                    None => next.push(Train::coming(self.none())),
                    Some(after) => {
                        let losses = self.losses(*train, after, may_lose);
                        next.extend(losses.into_iter().map(|lost| Train { lost, ..after }));
                    }
                }
            }
            ways = ways
                .iter()
                .flat_map(|way| {
                    next.iter().map(move |train| {
                        let mut way = *way;
                        way[number] = *train;
                        way
                    })
                })
                .collect();
        }
        ways
    }

    /// What passes when the trains have moved.
    fn passing(&self, state: &State, trains: &[Train; TRAINS]) -> Passing<B> {
        let mut passing = Passing { enters: 0, heard: 0, inside: [0; B] };
        for (before, after) in state.trains.iter().zip(trains) {
            if after.front == COMING || after.front < FIRST || after.front > self.beyond() {
                continue;
            }
            let section = after.front - FIRST;
            if before.front + 1 == after.front && section.is_multiple_of(self.sections) {
                passing.enters |= 1 << (section / self.sections);
            }
            if section < self.all_sections() {
                passing.heard |= 1 << section;
                passing.inside[usize::from(section / self.sections)] += 1;
            }
        }
        passing
    }

    /// What checks and detectors may say of it, with the faults of the run.
    fn commons(&self, state: &State, Passing { enters, heard, inside }: Passing<B>) -> Vec<Common<B>> {
        let counting = state.faults.counting;
        let mut ways: Vec<Common<B>> = counting
            .present(SectionSet::from_bits(heard.into()))
            .into_iter()
            .map(|present| Common {
                low: [false; B],
                high: [false; B],
                present: present.bits(),
                inside,
                reset: [None; B],
            })
            .collect();
        for block in 0..B {
            let lows: Vec<_> = counting.check_in(enters >> block & 1 == 1, block).collect();
            let highs: Vec<_> = counting.check_out(enters >> (block + 1) & 1 == 1, block).collect();
            ways = ways
                .iter()
                .flat_map(|way| lows.iter().map(move |low| (*way, *low)))
                .flat_map(|(way, low)| highs.iter().map(move |high| (way, low, *high)))
                .map(|(mut way, low, high)| {
                    (way.low[block], way.high[block]) = (low, high);
                    way
                })
                .collect();
        }
        if self.resets_together {
            for (block, right) in inside.into_iter().enumerate() {
                let resets = |way: &Common<B>| {
                    let agree = [SENDER, RECEIVER]
                        .into_iter()
                        .all(|station| self.agrees(station, state.devices[station], way)[block]);
                    let wrong = counting.has(Kind::WrongReset, block);
                    let numbers =
                        (0..=self.ends[SENDER].most()).filter(move |number| !agree && (*number == right || wrong));
                    std::iter::once(None).chain(numbers.map(Some)).collect::<Vec<_>>()
                };
                ways = ways
                    .iter()
                    .flat_map(|way| {
                        resets(way).into_iter().map(move |reset| {
                            let mut way = *way;
                            way.reset[block] = reset;
                            way
                        })
                    })
                    .collect();
            }
        }
        ways
    }

    /// Which blocks agree at a device that reads this, before staff do anything.
    fn agrees(&self, station: usize, device: Number, common: &Common<B>) -> [bool; B] {
        let mut known = self.known();
        let read = Common { reset: [None; B], ..*common };
        if let Some(found) = known.agreeing.get(&(station, device, read)) {
            return *found;
        }
        let before = known.device(device).line;
        let (_, report, _) = self.ends[station].counted.count(before, self.detections(&read), circuits(0));
        let agree = report.blocks.map(|block| block.agree);
        known.agreeing.insert((station, device, read), agree);
        agree
    }

    /// What is commanded: requests that would change nothing are left out.
    fn commands(&self, station: usize, device: &Device<B>) -> Vec<Option<Request>> {
        let (held, travel) = (device.interlocking.routes[0], self.ends[station].travel);
        let directions = device.interlocking.directions;
        let mut commands = vec![None];
        if !held.is_held() || held.may_resume() {
            commands.push(Some(Request::Set(route())));
        }
        if held.is_held() && (self.withdraws == Withdraws::AtWill || held.phase == Phase::InUse) {
            commands.push(Some(Request::Withdraw(route())));
        }
        let set = if travel == Travel::Away { directions.away } else { directions.toward };
        if !set.meets(the_line()) {
            commands.push(Some(turn(travel)));
        }
        commands
    }

    /// The blocks' detections, without resets.
    fn detections(&self, common: &Common<B>) -> [Detection; B] {
        std::array::from_fn(|block| {
            let shift = usize::from(self.sections) * block;
            let present = SectionSet::from_bits(common.present >> shift).and(SectionSet::first(self.sections));
            Detection {
                low_check: common.low[block],
                high_check: common.high[block],
                present,
                reset: common.reset[block].map(TrainCount),
            }
        })
    }

    /// All that a device can make of a cycle.
    fn outcomes(&self, key: Key<B>) -> Arc<[Outcome]> {
        let mut known = self.known();
        if let Some(found) = known.outcomes.get(&key) {
            return Arc::clone(found);
        }
        let end = &self.ends[key.station];
        let device = known.device(key.device);
        let mut all: Vec<Outcome> = Vec::new();
        let signal = 1 << self.before_signal(key.station);
        let mut add = |before: Device<B>, read: Read<B>, started: bool| {
            let failed = self.failed(&key, &read, started);
            let made = end.step(before, read, self.wiring);
            let clear = end.layout.plan().clear;
            let counts = made.device.interlocking.track.clear_for();
            let occupied = (0..8).filter(|place| counts[*place] < clear).fold(0, |all, place| all | 1 << place);
            let granted = made.granted & !signal | if made.proceed { signal } else { 0 };
            let outcome = Outcome {
                device: known.number(made.device),
                permits: made.permits,
                granted,
                occupied,
                unverified: made.permits && !made.device.verified,
                started,
                failed,
                read: 0,
            };
            let less = |one: &Outcome| {
                Outcome { read: 0, failed: Faults::NONE, ..*one } == Outcome { failed: Faults::NONE, ..outcome }
            };
            let known_already = |one: &Outcome| one.failed == failed || self.often == Often::AtWill;
            if !all.iter().any(|one| less(one) && known_already(one)) {
                let read = known.take(Taken { read, told: made.told, agree: made.agree });
                all.push(Outcome { read, ..outcome });
            }
        };
        let begins = [(device, false), (end.initial(), true)].into_iter().take(1 + usize::from(key.may_start));
        for (before, started) in begins {
            for (blocks, reported) in self.readings(end, &before, &key) {
                let orders = if started { start_orders() } else { Read::<B>::quiet().orders };
                let read = Read { blocks, reported: circuits(reported), request: None, orders, consent: false };
                let requests = if started { vec![None] } else { self.commands(key.station, &before) };
                for request in requests {
                    for consent in [true, false].into_iter().filter(|consent| key.consents[usize::from(*consent)]) {
                        add(before, Read { request, consent, ..read }, started);
                    }
                }
            }
        }
        let all: Arc<[Outcome]> = all.into();
        known.outcomes.insert(key, Arc::clone(&all));
        all
    }

    /// What the blocks and the circuits of a device may read: resets where a block disagrees, and circuits falsely occupied.
    fn readings(&self, end: &End<B>, before: &Device<B>, key: &Key<B>) -> Vec<([Detection; B], u8)> {
        let falsely = (0..=key.falsely).filter(|set| set & !key.falsely == 0 && set & key.reported == 0);
        let mut ways = Vec::new();
        for reported in falsely.map(|set| set | key.reported) {
            let plain = self.detections(&key.common);
            let (_, report, _) = end.counted.count(before.line, plain, circuits(reported));
            let mut resets = vec![plain];
            for block in 0..B {
                if key.together || report.blocks[block].agree {
                    continue;
                }
                let right = key.common.inside[block];
                let numbers: Vec<_> =
                    (0..=end.most()).filter(|number| *number == right || key.wrong_reset[block]).collect();
                resets = resets
                    .iter()
                    .flat_map(|way| {
                        let reset = numbers.iter().map(move |number| {
                            let mut way = *way;
                            way[block].reset = Some(TrainCount(*number));
                            way
                        });
                        std::iter::once(*way).chain(reset)
                    })
                    .collect();
            }
            ways.extend(resets.into_iter().map(|blocks| (blocks, reported)));
        }
        ways
    }

    /// What of a device's own has failed if it reads this.
    fn failed(&self, key: &Key<B>, read: &Read<B>, started: bool) -> Faults {
        if self.often == Often::AtWill {
            return Faults::NONE;
        }
        let sends = key.station == SENDER;
        let falsely = read.reported.bits().to_le_bytes()[0] & !key.reported;
        let starts = if sends { Around::SenderStarts } else { Around::ReceiverStarts };
        let mut failed = Faults::around(starts, started)
            .and(Faults::around(Around::SenderThroat, falsely >> THROAT & 1 == 1))
            .and(Faults::around(Around::Consent, sends && !started && read.consent != key.newest));
        for block in 0..B {
            if read.blocks[block].reset.is_some_and(|number| number.0 != key.common.inside[block]) {
                failed = failed.and(Faults::counting(fault::Faults::of_block(Kind::WrongReset, block)));
            }
        }
        failed
    }

    /// What has failed in a cycle of what both devices read alike, and what could have failed without being told from what is right.
    fn failing(&self, trains: &[Train; TRAINS], passing: Passing<B>, common: &Common<B>) -> (Faults, Faults) {
        if self.often == Often::AtWill {
            return (Faults::NONE, Faults::NONE);
        }
        let Passing { enters, heard, .. } = passing;
        let present = common.present.to_le_bytes()[0];
        let mut failed = fault::Faults::of_detectors(heard & !present, present & !heard);
        let mut hidden = fault::Faults::of_detectors(!heard, heard);
        for block in 0..B {
            let (low, high) = (enters >> block & 1 == 1, enters >> (block + 1) & 1 == 1);
            let of = |kind, there: bool| if there { fault::Faults::of_block(kind, block) } else { fault::Faults::NONE };
            failed = failed
                .and(of(Kind::CheckInLost, low && !common.low[block]))
                .and(of(Kind::CheckInStuckOn, !low && common.low[block]))
                .and(of(Kind::CheckOutLost, high && !common.high[block]))
                .and(of(Kind::SpuriousCheckOut, !high && common.high[block]));
            hidden = hidden.and(of(Kind::CheckInStuckOn, low));
        }
        let reported = Self::reported(trains);
        let lost = trains.iter().any(|train| train.lost != 0);
        let hidden = Faults::counting(hidden)
            .and(Faults::around(Around::SenderThroat, reported >> THROAT & 1 == 1))
            .and(Faults::around(Around::ReceiverThroat, reported >> self.beyond() & 1 == 1));
        (Faults::counting(failed).and(Faults::around(Around::Lost, lost)), hidden)
    }

    /// What may fail after this cycle, and what of it has begun to.
    fn left(&self, state: &State, cycle: &Cycle) -> (Faults, Faults) {
        if self.often == Often::AtWill {
            return (state.faults, Faults::NONE);
        }
        let [sender, receiver] = cycle.outcomes;
        let failed = cycle.failed.and(sender.failed).and(receiver.failed);
        let over = failed.without(self.levels).and(state.begun.without(failed).without(cycle.hidden));
        let begun = state.begun.and(failed.among(self.levels)).without(over);
        (state.faults.without(over), begun)
    }

    /// The circuits that may be reported without a train.
    fn falsely(&self, station: usize, faults: Faults) -> u8 {
        let throat = faults.has(Around::SenderThroat) && station == SENDER;
        let beyond = faults.has(Around::ReceiverThroat) && self.often == Often::AtWill;
        u8::from(throat) << THROAT | u8::from(beyond) << self.beyond()
    }

    /// Whether a permission may be read, and may be missing: of this cycle's permissions, and of those that live.
    fn consents(&self, state: &State) -> [bool; 2] {
        let (newest, lives) = (state.sent & 1 == 1, state.sent != 0);
        if self.wiring == Wiring::BelievesForEver {
            return [false, true];
        }
        if state.faults.has(Around::Consent) { [true, lives] } else { [!newest, newest] }
    }

    /// The circuits that report a train of these.
    fn reported(trains: &[Train; TRAINS]) -> u8 {
        let ends =
            |train: &Train| [(1, train.front), (2, train.rear)].map(|(end, place)| (train.lost & end == 0, place));
        let heard = trains.iter().filter(|train| train.front != COMING).flat_map(ends);
        heard.fold(0, |all, (heard, place)| all | u8::from(heard) << place)
    }

    /// The place in front of the signal of a station.
    fn before_signal(&self, station: usize) -> u8 {
        if station == SENDER { PLATFORM } else { self.beyond() - 1 }
    }

    /// Whether the signal of a station shows proceed.
    fn proceeds(&self, station: usize, outcome: &Outcome) -> bool {
        outcome.granted >> self.before_signal(station) & 1 == 1
    }

    /// Whether the next place is granted to a train whose front is there: by the sender as far as its throat, beyond that by the receiver.
    fn grants(&self, place: u8, [sender, receiver]: &[Outcome; 2]) -> bool {
        let speaks = if place < FIRST { sender } else { receiver };
        place < self.beyond() && speaks.granted >> place & 1 == 1
    }

    /// What is wrong after this cycle.
    fn wrong(&self, state: &State, trains: &[Train; TRAINS], outcomes: &[Outcome; 2]) -> u8 {
        let [sender, receiver] = outcomes;
        let there = || trains.iter().filter(|train| train.front != COMING);
        let mut all = 0;
        let mut met = false;
        for train in there() {
            met |= all & train.on() != 0;
            all |= train.on();
        }
        let under = all & self.line();
        let unreported = under & !(sender.occupied & receiver.occupied) != 0;
        // A train that is still passing the signal is the one for which it showed proceed.
        let past = |place: u8| there().any(|train| train.rear >= place && train.rear <= self.end());
        let within = |place: u8| there().any(|train| train.rear == place);
        let mut proceed =
            self.proceeds(SENDER, sender) && within(THROAT) || self.proceeds(RECEIVER, receiver) && past(self.beyond());
        for train in there() {
            let next = train.front + 1;
            let granted = train.front < self.beyond() && self.grants(train.front, outcomes);
            proceed |= granted && there().any(|other| other != train && other.on() >> next & 1 == 1);
        }
        let lets = self.proceeds(SENDER, sender)
            || there().any(|train| train.front == THROAT) && sender.granted >> THROAT & 1 == 1;
        let flags = [
            (met, wrong::MET),
            (unreported, wrong::UNREPORTED),
            (proceed, wrong::PROCEED),
            (lets && state.sent == 0, wrong::NO_CONSENT),
            (receiver.unverified, wrong::UNVERIFIED),
        ];
        flags.into_iter().filter(|(there, _)| *there).fold(0, |all, (_, flag)| all | flag)
    }

    /// The state in which a train is sent anew after a start: the route is held, which no device remembers.
    fn sent_again(&self, state: &State) -> bool {
        let held = || self.device(state.devices[SENDER]).interlocking.routes[0].is_held();
        let on_its_way = |train: &Train| train.front == FIRST && train.rear == THROAT;
        state.restarted && state.trains.iter().any(on_its_way) && held()
    }

    /// A train is wholly in the receiver's platform, no other on the line, and all of it counts as occupied.
    fn arrived_in_disagreement(&self, state: &State) -> bool {
        let on = state.trains.iter().fold(0, |all, train| all | train.on());
        if on & (self.line() | 1 << self.beyond()) != 0 || on >> self.end() & 1 == 0 {
            return false;
        }
        let counts = self.device(state.devices[RECEIVER]).interlocking.track.clear_for();
        (FIRST..self.beyond()).all(|place| counts[usize::from(place)] == 0)
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

    /// The run of the sender's interlocking since its last start. The further words of a step: where the trains are, what both devices count, and
    /// what the receiver does.
    fn trace(&self, path: &[(State, Option<Cycle>)]) -> Trace {
        let names = ["platform", "throat", "s1", "s2", "s3", "s4", "s5", "s6"];
        let mut names: Vec<_> = names[..usize::from(self.beyond())].to_vec();
        names.push("beyond");
        let end = &self.ends[SENDER];
        let mut run = Run::begin("sender", &names, &end.layout);
        let started = path.iter().rposition(|(_, cycle)| cycle.is_some_and(|cycle| cycle.outcomes[SENDER].started));
        if started.is_none() {
            let mut device = end.initial();
            for read in end.prelude() {
                let made = end.step(device, read, self.wiring);
                device = made.device;
                run.step(&made.told, BTreeMap::from([("hazard".to_owned(), json!(false))]));
            }
        }
        for (place, (before, cycle)) in path.iter().enumerate().skip(started.unwrap_or(0)) {
            let (Some(cycle), Some((after, _))) = (cycle, path.get(place + 1)) else { break };
            let taken = self.known().taken[cycle.outcomes[SENDER].read as usize];
            let train = |train: &Train| match train.front {
                COMING => json!("coming"),
                _ => json!({"front": train.front, "rear": train.rear, "lost": train.lost}),
            };
            let trains: Vec<_> = cycle.trains[..usize::from(self.trains)].iter().map(train).collect();
            let words = BTreeMap::from([
                ("trains".to_owned(), json!(trains)),
                ("faults".to_owned(), json!(before.faults.words())),
                ("counted_by_the_sender".to_owned(), self.counted(&cycle.outcomes[SENDER])),
                ("counted_by_the_receiver".to_owned(), self.counted(&cycle.outcomes[RECEIVER])),
                ("receiver_proceed".to_owned(), json!(self.proceeds(RECEIVER, &cycle.outcomes[RECEIVER]))),
                ("receiver_permits".to_owned(), json!(cycle.outcomes[RECEIVER].permits)),
                ("receiver_starts".to_owned(), json!(cycle.outcomes[RECEIVER].started)),
                ("hazard".to_owned(), json!(after.wrong & wrong::MET != 0)),
            ]);
            run.step(&taken.told, words);
        }
        run.trace()
    }

    fn cut_sets(&self, limits: Limits) -> Option<Vec<CutSet>> {
        match self.purpose {
            Purpose::Pairs(_) => cut_sets::enumerate(self, limits),
            Purpose::Safe | Purpose::Hazard(_) => Some(Vec::new()),
        }
    }
}

impl<const B: usize> CountedBetween<B> {
    /// What a device read of the line, and how it counts after that.
    fn counted(&self, outcome: &Outcome) -> Value {
        let known = self.known();
        let taken = known.taken[outcome.read as usize];
        let after = known.device(outcome.device);
        let block = |block: usize| {
            let Detection { low_check, high_check, present, reset } = taken.read.blocks[block];
            let sections: Vec<_> = (0..self.sections).filter(|section| present.contains(*section)).collect();
            json!({
                "check_in": low_check,
                "check_out": high_check,
                "present": sections,
                "reset": reset.map(|number| number.0),
                "count": after.line.blocks[block].parts().count,
                "agree": taken.agree[block],
            })
        };
        (0..B).map(block).collect()
    }
}
