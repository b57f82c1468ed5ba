//! The kernel's device on board of trains on metres: what it hears of the devices on the ground, and what is judged of what it permits.
//!
//! It hears codes and frames, those for the other direction of travel too; frames are lost, late by a cycle, and come from transmitters that have frozen;
//! levels are missing, the odometer is wide or silent, the direction of travel is unknown for a while, or changes.

use super::{BRAKE, Counts, Draft, Kind, LIFE, LOSS, SPEEDS, Train, World, finds_none, finds_one};
use atc_kernel::aspect::{Acceptance, AspectId, AspectTable, Times};
use atc_kernel::code::{CodeFrequencies, CodeTable, Millihertz};
use atc_kernel::distance::Metres;
use atc_kernel::interlocking::{CircuitId, CircuitSet, Heading, MAX_CIRCUITS};
use atc_kernel::pattern::Deceleration;
use atc_kernel::permitted::{Permitted, Settings};
use atc_kernel::position::{Correction, Millibels, Moved, Position, Spacing, Table};
use atc_kernel::speed::{KmhTenths, RawKmhTenths};
use atc_kernel::supervision::{Brake, Supervision};
use atc_kernel::telegram::{Frame, Gradient, Sequence};
use atc_kernel::time::Ticks;
use atc_kernel::train::{Antennas, Cab, Carrier, Parts, State, Train as Device};
use atc_kernel::wayside::{Framed, Transmission};
use std::collections::VecDeque;

/// For so many cycles a device on board acts on a telegram. With its way, and until the ground looks again, it is older.
const ON_BOARD: i64 = 4;
const AGE: i64 = 7;
/// The same, and to a stand from the highest speed.
const RESIDUAL: u16 = 29;
/// After so many cycles a limit that was lowered must be kept.
const IN_FORCE: i64 = 10;
/// The levels: mB a metre, and up to so many more.
const SLOPE: i64 = 2;
const WIDTH: i64 = 8;
const MARGIN_M: u16 = 45;

/// A frame of each carrier on its way to a train: when it comes, and of which circuit it is.
#[derive(Clone, Copy, Debug)]
struct Coming {
    at: i64,
    circuit: usize,
    main: Option<Frame>,
    sub: Option<Frame>,
}

/// The device of a train, and what it is about to hear.
#[derive(Clone, Debug)]
pub struct Board {
    state: State<4>,
    /// What it says.
    pub cab: Cab,
    way: VecDeque<Coming>,
    late: i64,
    /// Until when it does not know its direction of travel.
    pub unknown_until: i64,
    /// What the train ran in the last cycle.
    pub moved: i64,
}

impl Board {
    fn new(late: i64) -> Box<Self> {
        let (state, cab) = (State::INITIAL, Cab::STOP);
        Box::new(Self { state, cab, way: VecDeque::new(), late, unknown_until: 0, moved: 0 })
    }

    /// What the train runs in a cycle: no more than is permitted, and less under the brake.
    pub fn speed(&self, train: &Train) -> i64 {
        let least = (train.speed - BRAKE).max(0);
        let permitted = self.cab.permission.speed.map_or(0, |speed| i64::from(speed.0) * 1000 / 36);
        let goes = self.cab.brake == Brake::Release;
        if goes { (train.speed + BRAKE).min(permitted).min(train.pace).max(least) } else { least }
    }
}

/// A transmitter that repeats what it sent.
#[derive(Clone, Copy, Debug)]
struct Frozen {
    device: usize,
    circuit: usize,
    until: i64,
    sends: Transmission,
}

/// What all trains with a device have in common.
#[derive(Clone, Debug)]
pub struct Ride {
    device: Device<4>,
    frozen: Vec<Frozen>,
    /// The speed code that limits each circuit, and since when.
    limits: [(u8, i64); MAX_CIRCUITS],
    /// The circuits whose limits are judged: no train of another device is there.
    judged: Vec<usize>,
    /// The circuits over which routes have speed code 2.
    slow: Vec<usize>,
    /// After how many cycles a limit is judged.
    pub in_force: i64,
    late: i64,
}

impl Ride {
    /// Frames are late by so many cycles; limits are judged in these circuits; over those that are slow, routes have speed code 2.
    pub fn new(late: i64, judged: &[usize], slow: &[usize]) -> Box<Self> {
        let (device, judged, slow) = (device(), judged.to_vec(), slow.to_vec());
        let limits = [(7, 0); MAX_CIRCUITS];
        Box::new(Self { device, frozen: Vec::new(), limits, judged, slow, in_force: IN_FORCE, late })
    }
}

fn device() -> Device<4> {
    let nominal = |first: u32| {
        CodeFrequencies::new(&[0, 1, 2, 3].map(|place| Millihertz(first + 6000 * place)), Millihertz(1000)).unwrap()
    };
    let speeds = SPEEDS.map(|speed| KmhTenths(u16::try_from(speed * 36 / 1000).unwrap()));
    let mut named = [[None; 8]; 8];
    for (place, speed) in speeds.iter().enumerate() {
        named[place][place] = Some(*speed);
    }
    let life = Ticks(u16::try_from(ON_BOARD).unwrap());
    let settings = Settings {
        speeds: AspectTable::new(&speeds).unwrap(),
        lowest: AspectId::new(0).unwrap(),
        brake: Deceleration::brake(1000).unwrap(),
        worst: Gradient(0),
        margin: Metres(MARGIN_M),
        fresh: Ticks(3),
        life,
        fixed_life: Ticks(12),
        sequence: Sequence::new(3, 1, life).unwrap(),
    };
    // A knot is 51.2 m.
    let level = |knot: usize, more: i64| {
        Millibels(i16::try_from(i64::try_from(knot).unwrap() * 512 / 10 * SLOPE + more).unwrap())
    };
    let lowest = std::array::from_fn(|knot| level(knot, 0));
    let table = Table::new(Spacing::new(9).unwrap(), lowest, std::array::from_fn(|knot| level(knot, WIDTH))).unwrap();
    Device::new(Parts {
        codes: CodeTable::new(nominal(10_000), nominal(12_000), named).unwrap(),
        acceptance: Acceptance { times: Times::from_ticks(Ticks(2), Ticks(2), Ticks(2), Ticks(4), Ticks(1)).unwrap() },
        permitted: Permitted::new(settings).unwrap(),
        supervision: Supervision::new(KmhTenths(1500), KmhTenths(0)).unwrap(),
        position: Position::new(table, Millibels(2), Millibels(-3000), Correction::NONE),
    })
    .unwrap()
}

/// Gives a plan the times and distances that trains with such a device need.
pub fn reckon(plan: &mut Draft) {
    for (distance, speed) in plan.braking.iter_mut().zip(SPEEDS).skip(1) {
        let fastest = speed + BRAKE * AGE;
        *distance = Metres(u16::try_from((fastest * fastest / (2 * BRAKE)).div_euclid(1000) + 1).unwrap());
    }
    let turn = Ticks(LIFE + RESIDUAL + u16::from(LOSS));
    (plan.turn, plan.start, plan.residual) = (turn, turn, Ticks(RESIDUAL));
    for route in plan.routes.iter_mut().filter(|route| route.length > 0) {
        route.release = Ticks(RESIDUAL + u16::from(LOSS));
    }
}

impl World {
    /// Every train that goes by telegrams has a device from now on.
    pub fn ride(&mut self, ride: Box<Ride>) {
        self.ride = Some(ride);
        for train in std::mem::take(&mut self.trains) {
            self.enter(train);
        }
    }

    /// Another train; with a device, if those by telegrams have one.
    pub fn enter(&mut self, mut train: Train) {
        let late = self.ride.as_ref().map(|ride| ride.late);
        train.board = late.filter(|_| train.kind == Kind::Telegrams).map(Board::new);
        self.trains.push(train);
    }

    /// The transmitters of a device that have taken the frames of the last cycle.
    pub fn framed(&self, number: usize) -> Framed {
        let mut all = CircuitSet::ALL;
        let frozen = self.ride.iter().flat_map(|ride| &ride.frozen);
        for it in frozen.filter(|frozen| frozen.device == number) {
            all = all.without(CircuitSet::nth(it.circuit));
        }
        Framed { main: all, sub: all }
    }

    /// Transmitters freeze now and then under a train; and the limits of a cycle.
    pub(super) fn transmitters(&mut self) {
        let Some(mut ride) = self.ride.take() else { return };
        ride.frozen.retain(|frozen| frozen.until > self.cycle);
        let under: Vec<usize> = self.trains.iter().filter_map(|train| self.circuit_of(train)).collect();
        if !under.is_empty() && self.dice.one_in(60) {
            let (device, circuit) = (self.dice.below(self.devices.len()), self.dice.of(&under));
            let until = self.cycle + self.dice.of(&[3, 8, 30, 120]);
            let already = ride.frozen.iter().any(|frozen| (frozen.device, frozen.circuit) == (device, circuit));
            if let Some(sends) = self.devices[device].output.transmissions[circuit].filter(|_| !already) {
                ride.frozen.push(Frozen { device, circuit, until, sends });
            }
        }
        for (circuit, known) in ride.limits.iter_mut().enumerate() {
            let id = CircuitId::new(u8::try_from(circuit).unwrap()).unwrap();
            let of = self.devices.iter().filter(|device| device.circuits.contains(&circuit));
            let restricted = of.map(|device| device.state.device.interlocking.works.restrictions.on(id).0);
            let code = restricted.min().unwrap_or(7).min(if ride.slow.contains(&circuit) { 2 } else { 7 });
            // What is lowered counts from now on, and what is raised at once.
            *known = if code < known.0 { (code, self.cycle) } else { (code, known.1) };
        }
        self.ride = Some(ride);
    }

    /// What the device of a train hears in this cycle.
    fn heard(&mut self, train: &Train, board: &mut Board, ride: &Ride) -> Antennas {
        let (here, now) = (self.circuit_of(train), self.cycle);
        let mut speak = Vec::new();
        let mut codes = None;
        for (number, device) in self.devices.iter().enumerate() {
            let Some(circuit) = here.filter(|circuit| device.circuits.contains(circuit)) else { continue };
            let Some(sent) = device.output.transmissions[circuit] else { continue };
            codes = Some(sent.facing(train.heading).codes);
            let frozen = ride.frozen.iter().find(|frozen| (frozen.device, frozen.circuit) == (number, circuit));
            speak.push(frozen.map_or(sent, |frozen| frozen.sends));
        }
        if let (Some(circuit), false) = (here, speak.is_empty()) {
            let sent = self.dice.of(&speak);
            // The frames of both directions come in turn; now and then only those of the other one are heard.
            let heading = if self.dice.one_in(15) { train.heading.opposite() } else { train.heading };
            let feed = sent.facing(heading);
            let main = (!self.dice.one_in(10)).then_some(feed.main);
            let sub = (!self.dice.one_in(6)).then_some(feed.sub);
            board.way.push_back(Coming { at: now + board.late, circuit, main, sub });
        }
        let comes = board.way.front().copied().filter(|coming| coming.at <= now);
        if comes.is_some() {
            board.way.pop_front();
        }
        let codes = codes.filter(|_| !self.dice.one_in(10));
        let hertz = |first: u32, place: u8| Millihertz(first + 6000 * u32::from(place));
        let right = train.heading == Heading::Right;
        let to_exit = here.map(|circuit| {
            let it = &self.circuits[circuit];
            if right { it.high - train.nose } else { train.nose - it.low }
        });
        // Levels and frames of one cycle are of one circuit.
        let same = comes.is_none_or(|coming| Some(coming.circuit) == here);
        let level = to_exit.filter(|_| same && !self.dice.one_in(8));
        let level = level.map(|mm| mm * SLOPE / 1000 + self.dice.between(0, WIDTH));
        let unknown = now < board.unknown_until || self.dice.one_in(400);
        let (moved, slack) = (i16::try_from(board.moved).unwrap(), i16::try_from(self.dice.between(0, 100)).unwrap());
        let silent = self.dice.one_in(100);
        Antennas {
            main: Carrier {
                code: codes.map(|codes| hertz(10_000, codes.main.place())),
                frame: comes.and_then(|coming| coming.main),
            },
            sub: Carrier {
                code: codes.map(|codes| hertz(12_000, codes.sub.place())),
                frame: comes.and_then(|coming| coming.sub),
            },
            first: level.map(|level| Millibels(i16::try_from(level).unwrap())),
            second: level.map(|_| Millibels(0)),
            moved: if silent { None } else { Moved::new(moved - slack, moved + slack) },
            speed: Some(RawKmhTenths(i32::try_from(train.speed * 36 / 1000).unwrap())),
            line: None,
            facing: (!unknown).then_some(train.heading),
        }
    }

    /// A cycle of the device of a train; what it permits above a limit that is in force.
    pub(super) fn on_board(&mut self, number: usize) -> Option<String> {
        let ride = self.ride.take()?;
        let train = self.trains[number].clone();
        let mut found = None;
        if let Some(mut board) = train.board.clone() {
            if train.outside {
                board = Board::new(board.late);
            } else {
                let antennas = self.heard(&train, &mut board, &ride);
                let (state, cab) = atc_kernel::train::step(&ride.device, board.state, antennas);
                let turned = board.state.facing.is_some() && state.facing != board.state.facing;
                (board.state, board.cab) = (state, cab);
                let permitted = cab.permission.speed.map_or(0, |speed| i64::from(speed.0));
                self.counts.permitted += u64::from(permitted > 0);
                self.counts.turned += u64::from(turned);
                let above = |circuit: &&usize| {
                    let (code, since) = ride.limits[**circuit];
                    let limit = SPEEDS.get(usize::from(code)).map(|speed| speed * 36 / 1000);
                    let late = self.cycle - since >= ride.in_force;
                    late && limit.is_some_and(|limit| permitted > limit) && self.is_in(&train, **circuit)
                };
                found = ride.judged.iter().find(above).map(|circuit| {
                    format!("train {number} is permitted {permitted} (0.1 km/h) over the limit of circuit {circuit}")
                });
            }
            self.trains[number].board = Some(board);
        }
        self.ride = Some(ride);
        found
    }
}

/// Hunts with devices on board: no episode ends in an accident, trains may move and change ends, and one ends in one if a limit is judged at once.
pub fn finds_none_on_board(episode: fn(u64, i64, &mut Counts) -> Option<String>) {
    let counts = finds_none(40, |seed, counts| episode(seed, IN_FORCE, counts));
    assert!(counts.permitted > 40 * 20 && counts.turned > 40, "{counts:?}");
    finds_one("a limit at once", 1..400, |seed, counts| episode(seed, 0, counts));
}
