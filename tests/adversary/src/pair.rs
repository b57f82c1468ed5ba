//! Two devices and the messages between them, as one device of the joined ground: each sees and is told its own part.

use std::cell::Cell;

use atc_kernel::interlocking::Epoch;
use atc_kernel::time::Ticks;
use atc_kernel::wayside::{Consent, Message, Permission, Session, Stamp};

use super::device::{Ask, Commands, Device, Phase, Read, Said, Telegram};
use super::dice::Dice;
use super::ground::{Mask, bit};
use super::joined::{Joined, Place, mask};

/// What is wrong on purpose, to see whether it is found.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Wrong {
    /// Nothing.
    #[default]
    Nothing,
    /// The neighbour is taken to consent always.
    ConsentAlways,
    /// A permission counts for so many times its life.
    ConsentOld(u16),
    /// A restriction of what both see, or of what is near, is told to the first station only.
    ToldOnce,
    /// Staff take a block for confirmed when it is commanded.
    Unconfirmed,
    /// After a start staff unblock and lift without the record.
    WithoutRecord,
}

/// A station's device and what it has of the other one.
struct Side {
    device: Box<dyn Device>,
    place: Place,
    consent: Consent,
    session: u16,
    cycle: u32,
    /// For how many cycles yet it is off.
    off: i64,
    /// What staff have yet to command after a start: of each speed code in turn.
    recall: Vec<Option<u8>>,
}

/// Both.
pub struct Pair {
    sides: [Side; 2],
    life: u16,
    shared: Mask,
    /// Messages on their way: when they come, to whom.
    mail: Vec<(u64, usize, Message)>,
    now: u64,
    dice: Dice,
    /// The most cycles that a message takes.
    pub late: i64,
    /// Until when no message comes through.
    cut: u64,
    /// The requests of each station's own signaller, where none comes from elsewhere.
    pub asks: [Option<Ask>; 2],
    /// What only one of the two is falsely told of.
    pub extra: [Mask; 2],
    /// The record of blocks.
    blocked: Mask,
    /// The record of restrictions: the lowest code of each circuit.
    record: Vec<u8>,
    /// Which station hears of blocks later, and by how many cycles.
    pub lag: (usize, u64),
    /// The blocks that it has yet to hear of.
    blocks: Vec<(u64, Mask)>,
    /// What is wrong on purpose.
    pub wrong: Wrong,
    /// In how many cycles one circuit had two telegrams.
    pub twice: Cell<u64>,
}

const NONE: u8 = u8::MAX;

impl Pair {
    /// The devices of two stations, both just started. The places stay with the caller too.
    pub fn new(joined: Joined, seed: u64, wrong: Wrong) -> Self {
        let life = u16::try_from(joined.life.max(1)).unwrap_or(1)
            * if let Wrong::ConsentOld(times) = wrong { times } else { 1 };
        let [one, two] = joined.devices;
        let [first, second] = joined.places;
        let side = |device, place| Side {
            device,
            place,
            consent: Consent::none(Ticks(life)),
            session: 0,
            cycle: 0,
            off: 0,
            recall: Vec::new(),
        };
        Self {
            sides: [side(one, first), side(two, second)],
            life,
            shared: joined.shared,
            mail: Vec::new(),
            now: 0,
            dice: Dice::new(seed),
            late: 0,
            cut: 0,
            asks: [None; 2],
            extra: [0; 2],
            blocked: 0,
            record: vec![NONE; joined.ground.seen],
            lag: (0, 0),
            blocks: Vec::new(),
            wrong,
            twice: Cell::new(0),
        }
    }

    /// An episode begins: both devices start, and chance begins anew.
    pub fn begin(&mut self, seed: u64) {
        self.restart();
        (self.now, self.dice) = (0, Dice::new(seed));
    }

    /// No message comes through for so many cycles.
    pub fn silence(&mut self, cycles: i64) {
        self.cut = self.now + u64::try_from(cycles).unwrap_or(0);
    }

    /// The circuits that a station sees.
    pub fn sees(&self, at: usize) -> Mask {
        mask(&self.sides[at].place, (bit(self.sides[at].place.circuits.len())) - 1)
    }

    /// Whether a station's device runs, and has been told all that its staff's record has.
    pub fn is_up(&self, at: usize) -> bool {
        self.sides[at].off == 0 && self.sides[at].recall.is_empty()
    }

    /// Whether the neighbour's permission counts for a station.
    pub fn consented(&self, at: usize) -> bool {
        self.sides[at].consent.counts(Ticks(self.life))
    }

    /// One station's device restarts, and is off for so many cycles.
    pub fn restart_one(&mut self, at: usize, off: i64) {
        let side = &mut self.sides[at];
        side.device.restart();
        (side.consent, side.cycle, side.off) = (Consent::none(Ticks(self.life)), 0, off);
        side.session = side.session.wrapping_add(1);
        side.recall.clear();
    }

    /// Its staff command from their record what it has forgotten, a speed in each of the next cycles.
    pub fn recall(&mut self, at: usize) {
        self.sides[at].recall = if self.wrong == Wrong::WithoutRecord {
            vec![None]
        } else {
            (0..8).map(Some).chain([None]).rev().collect()
        };
    }

    /// The lowest code that a station must have been told for its circuit.
    fn code(&self, at: usize, circuit: usize) -> u8 {
        let told = self.sides[at]
            .place
            .told
            .iter()
            .filter(|(_, nearest)| *nearest == circuit && self.wrong != Wrong::ToldOnce);
        told.map(|(other, _)| self.record[*other]).chain([self.record[circuit]]).min().unwrap_or(NONE)
    }

    /// What of the staff's commands a station is told, on its own circuits.
    fn orders(&mut self, at: usize, given: &Commands) -> Commands {
        let circuits = self.sides[at].place.circuits.clone();
        let told = self.sides[at].place.told.clone();
        let local = |global: Mask| {
            circuits
                .iter()
                .enumerate()
                .filter(|(_, circuit)| global & bit(**circuit) != 0)
                .fold(0, |all, (number, _)| all | bit(number))
        };
        if let Some(next) = self.sides[at].recall.pop() {
            // The staff of this station read their record; it has the commands of this cycle too.
            let with = |code: u8| {
                circuits
                    .iter()
                    .enumerate()
                    .filter(|(_, it)| self.code(at, **it) == code)
                    .fold(0, |all, (number, _)| all | bit(number))
            };
            let everything = bit(circuits.len()) - 1;
            return match next {
                _ if self.wrong == Wrong::WithoutRecord => {
                    Commands { unblock: everything, lift: everything, ..Commands::default() }
                }
                Some(code) => Commands {
                    lift: with(code),
                    restrict: (with(code), code),
                    block: local(self.blocked),
                    ..Commands::default()
                },
                None => Commands {
                    lift: with(NONE),
                    unblock: everything & !local(self.blocked),
                    block: local(self.blocked),
                    ..Commands::default()
                },
            };
        }
        let mut restrict = given.restrict.0;
        let mut spared = 0;
        for (other, nearest) in told.iter().filter(|_| self.wrong != Wrong::ToldOnce) {
            if given.restrict.0 & bit(*other) != 0 {
                restrict |= bit(*nearest);
            }
        }
        for circuit in &circuits {
            spared |= if self.code(at, *circuit) == NONE { 0 } else { bit(*circuit) };
        }
        // What is still in force for another reason is not lifted here; what is restricted anew in this cycle is.
        let anew = given.lift & given.restrict.0;
        let mut lift = given.lift & !spared | anew;
        for (other, nearest) in &told {
            let over = given.lift & bit(*other) != 0 && self.code(at, *nearest) == NONE;
            lift |= if over { bit(*nearest) } else { 0 };
            // Raised on one, in force on the other: the lower one stays.
            let lower = self.code(at, *nearest) < given.restrict.1;
            if lower {
                lift &= !bit(*nearest);
            }
        }
        if self.wrong == Wrong::ToldOnce && at == 1 {
            restrict &= !self.shared;
        }
        let restrict = (local(restrict), given.restrict.1);
        // One of the two hears of a block later.
        let mut block = given.block;
        if self.lag.0 == at && self.lag.1 > 0 {
            self.blocks.iter_mut().for_each(|(_, mask)| *mask &= !given.unblock);
            if block != 0 {
                self.blocks.push((self.now + self.lag.1, block));
            }
            block = self.blocks.iter().filter(|(when, _)| *when <= self.now).fold(0, |all, (_, mask)| all | mask);
            let now = self.now;
            self.blocks.retain(|(when, _)| *when > now);
        }
        Commands { block: local(block), unblock: local(given.unblock), restrict, lift: local(lift) }
    }

    /// The staff's record of what they have commanded.
    fn note(&mut self, given: &Commands) {
        self.blocked = self.blocked & !given.unblock | given.block;
        for (circuit, code) in self.record.iter_mut().enumerate() {
            if given.lift & bit(circuit) != 0 {
                *code = NONE;
            }
            if given.restrict.0 & bit(circuit) != 0 {
                *code = (*code).min(given.restrict.1);
            }
        }
    }

    /// One message at most of those that have come for a station; the others are lost.
    fn post(&mut self, at: usize) -> Option<Message> {
        let now = self.now;
        let due = |(when, to, _): &(u64, usize, Message)| *to == at && *when <= now;
        let come: Vec<Message> = self.mail.iter().filter(|it| due(it)).map(|it| it.2).collect();
        self.mail.retain(|it| !due(it));
        self.dice.pick(&come)
    }

    fn send(&mut self, at: usize, message: Message) {
        if self.now < self.cut || self.dice.once_in(12) {
            return;
        }
        for _ in 0..=usize::from(self.dice.once_in(16)) {
            let late = u64::try_from(self.dice.within(0, self.late)).unwrap_or(0);
            self.mail.push((self.now + 1 + late, 1 - at, message));
        }
    }

    fn one(&mut self, at: usize, read: &Read, said: &mut Said) -> Mask {
        let message = self.post(at);
        if self.sides[at].off > 0 {
            self.sides[at].off -= 1;
            return 0;
        }
        let commands = self.orders(at, &read.commands);
        let always = self.wrong == Wrong::ConsentAlways;
        let (life, extra, asked) = (Ticks(self.life), self.extra[at], self.asks[at].take());
        let side = &mut self.sides[at];
        let place = &side.place;
        let stamp = Stamp { session: Session(side.session), cycle: Epoch(side.cycle + 1) };
        side.consent = side.consent.hear(life, stamp, message);
        let inner = 1_u8 << place.inner;
        let lines = ((1_u16 << place.line_count) - 1).to_le_bytes()[0];
        let outer = read.consent >> place.lines & lines & !inner;
        let consent = outer | if always || side.consent.counts(life) { inner } else { 0 };
        let mine = read.ask.and_then(|ask| own(place, ask));
        let occupied = read.occupied | extra;
        let local = place
            .circuits
            .iter()
            .enumerate()
            .filter(|(_, it)| occupied & bit(**it) != 0)
            .fold(0, |all, (number, _)| all | bit(number));
        let points = (1_u64 << place.point_count) - 1;
        let detected = read.detected.map(|it| it >> place.points & points);
        let it =
            Read { occupied: local, detected, ask: mine.or(asked.and_then(|ask| own(place, ask))), commands, consent };
        let its = side.device.cycle(&it);
        side.cycle += 1;
        said.proceed |= its.proceed << place.routes;
        for (all, its) in said.drives.iter_mut().zip(its.drives) {
            *all |= its << place.points;
        }
        said.permits |= (its.permits & !inner) << place.lines;
        if mine.is_some() {
            (said.done, said.refused) = (its.done, its.refused);
        }
        let granted = its.permits & inner != 0;
        let message = side.consent.tell(stamp, if granted { Permission::Granted } else { Permission::Withheld });
        let confirmed = mask(place, its.confirmed);
        self.send(at, message);
        confirmed
    }

    /// The telegram of one device for a circuit of the joined ground.
    fn from(&self, at: usize, circuit: usize) -> Option<Telegram> {
        let side = &self.sides[at];
        let local = side.place.circuits.iter().position(|it| *it == circuit).filter(|_| side.off == 0)?;
        let telegram = side.device.telegram(local);
        let stop = side.place.circuits.get(telegram.stop).copied().unwrap_or(0);
        (telegram.hold != 0).then(|| Telegram { hold: mask(&side.place, telegram.hold), stop, ..telegram })
    }
}

/// What is asked of a station, in its own numbers.
fn own(place: &Place, ask: Ask) -> Option<Ask> {
    let within = |number: usize, first: usize, count: usize| number.checked_sub(first).filter(|it| *it < count);
    Some(match ask {
        Ask::Set(route) => Ask::Set(within(route, place.routes, place.route_count)?),
        Ask::Withdraw(route) => Ask::Withdraw(within(route, place.routes, place.route_count)?),
        Ask::Drive(point, reverse) => Ask::Drive(within(point, place.points, place.point_count)?, reverse),
        Ask::Turn(line, away) => Ask::Turn(within(line, place.lines, place.line_count)?, away),
    })
}

impl Device for Pair {
    fn cycle(&mut self, read: &Read) -> Said {
        self.now += 1;
        self.note(&read.commands);
        let mut said = Said::default();
        let confirmed = [0, 1].map(|at| self.one(at, read, &mut said));
        // A block on a shared circuit is commanded at both; one that confirms it is enough.
        let unheard = self.blocks.iter().fold(0, |all, (_, mask)| all | mask) & self.shared;
        said.confirmed = (confirmed[0] | confirmed[1]) & !unheard;
        if self.wrong == Wrong::Unconfirmed {
            said.confirmed |= self.blocked & self.shared;
        }
        said
    }

    fn telegram(&self, circuit: usize) -> Telegram {
        self.from(0, circuit).or(self.from(1, circuit)).unwrap_or_default()
    }

    fn heard(&self, circuit: usize, right: bool) -> Telegram {
        let both = [self.from(0, circuit), self.from(1, circuit)];
        let mine = |telegram: &Telegram| telegram.right == Some(right);
        if both[0].as_ref().is_some_and(mine) && both[1].as_ref().is_some_and(mine) {
            self.twice.set(self.twice.get() + 1);
        }
        let any = both.into_iter().flatten();
        any.clone().find(mine).or_else(|| any.clone().next()).unwrap_or_default()
    }

    fn phases(&self) -> Vec<(usize, Phase)> {
        let of = |side: &Side| {
            side.device
                .phases()
                .into_iter()
                .map(|(route, phase)| (route + side.place.routes, phase))
                .collect::<Vec<_>>()
        };
        self.sides.iter().flat_map(of).collect()
    }

    fn restart(&mut self) {
        self.restart_one(0, 0);
        self.restart_one(1, 0);
        self.mail.clear();
        self.blocks.clear();
        (self.blocked, self.cut, self.extra, self.asks) = (0, 0, [0; 2], [None; 2]);
        self.record.fill(NONE);
    }
}
