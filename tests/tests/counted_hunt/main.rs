//! A hunt for an accident at the joint between block counting and interlocking, in a closed loop: trains with antennas at their noses on a counted line,
//! checks and detectors that fail one at a time in a block, staff who reset, a station of two tracks with its circuits, and a line out of it. One of the
//! two lines is counted. Devices restart in any cycle, trains follow one another as close as their telegrams let them. Nothing that judges is taken from
//! the kernel; the world is that of `line_hunt`, too.
//!
//! The accidents: two trains meet; a point moves under a train, or lies wrong when its nose comes; a train runs where staff rely on a block.

#[path = "../common/world.rs"]
mod world;

use atc_kernel::block::{Block, Detection, Direction, Hold, SectionSet, Status, TrainCount};
use atc_kernel::distance::Metres;
use atc_kernel::interlocking::{
    CircuitId, CircuitSet, Epoch, Heading, PointId, Position, Positions, Request, Segment, SegmentId, SegmentSet,
    Travel,
};
use atc_kernel::time::Ticks;
use atc_kernel::wayside::{Equipment, Join, Message, Permission, Session, Stamp, Wayside, WaysideError};
use world::board::{Ride, finds_none_on_board, reckon};
use world::{
    Channel, Counts, Device, Dice, Draft, Kind, LIFE, M, Piece, Signal, Train, World, Zone, at, draft, finds_none,
    finds_one, input, pieces, point, route, set, signals, stopping, withdraw,
};

const PASS: u16 = 12;
/// A line of six circuits, the nearest first; a throat, two tracks, a throat; a line of four circuits; in metres.
const CIRCUITS: [Piece; 14] = [
    (-100, 0, None),
    (-200, -100, None),
    (-300, -200, None),
    (-400, -300, None),
    (-500, -400, None),
    (-600, -500, None),
    (0, 60, None),
    (60, 300, Some((0, 0))),
    (60, 300, Some((0, 1))),
    (300, 360, None),
    (360, 460, None),
    (460, 560, None),
    (560, 660, None),
    (660, 760, None),
];

/// A condition of the case that is broken.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
enum Broken {
    /// `loops-overlap`, at the end of the line: the check-out lies before the place where the last detector ends.
    CheckOutBefore,
    /// `verified-reset`: a block is reset while a head stands between its check-in and the block.
    HeadAtReset,
    /// `independent-detectors`: a train is missed, and a phantom heard.
    Errors,
    /// `hold-covers-train`: trains are longer than the hold.
    Long,
    /// `loss-of-shunt-within-clear`: the first clear report is believed.
    Clear,
    /// `release-covers-residual-running`: the release time is a cycle.
    Release,
}

/// Each with the episode from which it is looked for: near one that finds it.
const BROKEN: [(Broken, u64); 6] = [
    (Broken::CheckOutBefore, 1),
    (Broken::HeadAtReset, 1),
    (Broken::Errors, 1),
    (Broken::Long, 1),
    (Broken::Clear, 1),
    (Broken::Release, 1000),
];

/// What is wrong in a block: one thing at a time, as `independent-detectors` has it.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
enum Error {
    None,
    /// No detector hears the train that was born then, until then.
    Miss(i64, i64),
    /// A section hears what is not there, until then.
    Phantom(u8, i64),
    /// The check-in stays on until then.
    StuckIn(i64),
    /// The next check-out is not made.
    NoOut,
    /// The count is wrong until a reset.
    Wrong,
    /// A miss and a phantom.
    Both(i64, u8, i64),
}

/// One block: its sections in the order of travel, and where its checks are.
struct Counted {
    sections: Vec<(i64, i64)>,
    check_in: (i64, i64),
    check_out: (i64, i64),
    error: Error,
    /// The levels of the checks in the last cycle.
    level: [bool; 2],
}

impl Counted {
    fn low(&self) -> i64 {
        self.sections[0].0
    }

    fn high(&self) -> i64 {
        self.sections[self.sections.len() - 1].1
    }

    fn has(&self, nose: i64) -> bool {
        self.low() < nose && nose <= self.high()
    }
}

/// The blocks of an episode, and what else is different from one to the next.
struct Line {
    blocks: Vec<Counted>,
    direction: Direction,
    longest: i64,
    /// An error comes once in so many cycles; never with 0.
    errors: usize,
    /// When each train of the world was born.
    births: Vec<i64>,
    /// The last birth.
    born_at: i64,
    /// When the neighbour was last permitted to send.
    granted_at: i64,
    /// Until when the neighbour beyond withholds its permission, and what it has heard.
    withheld: i64,
    heard: Option<Stamp>,
}

fn plan(broken: Option<Broken>, on_board: bool) -> Draft {
    let approach: &[usize] = if on_board { &[0, 1, 2, 3, 4, 5] } else { &[0, 1, 2] };
    let mut plan = draft(&pieces(&CIRCUITS));
    plan.points = [point(6), point(9)];
    for track in 0..2 {
        let path = [(6, at(0, track)), (7 + track, Positions::NONE)];
        plan.routes[track] = route(Heading::Right, 0, approach, &path, 9);
        plan.routes[track].from = SegmentSet::nth(0);
        plan.routes[2 + track] = route(Heading::Right, 7 + track, &[7 + track], &[(9, at(1, track))], 10);
        plan.routes[2 + track].to = SegmentSet::nth(1);
    }
    let segment = |circuits: &[usize], throat: CircuitSet, outward| {
        let mut segment = Segment::NONE;
        (segment.throat, segment.outward) = (throat, outward);
        segment.length = u8::try_from(circuits.len()).unwrap();
        for (place, circuit) in segment.circuits.iter_mut().zip(circuits) {
            *place = CircuitSet::nth(*circuit);
        }
        segment
    };
    plan.segments[0] = segment(&[0, 1, 2, 3, 4, 5], CircuitSet::EMPTY, Heading::Left);
    plan.segments[1] = segment(&[10, 11, 12, 13], CircuitSet::nth(9), Heading::Right);
    if on_board {
        reckon(&mut plan);
    }
    match broken {
        Some(Broken::Clear) => (plan.clear, plan.loss) = (1, 0),
        Some(Broken::Release) => {
            (plan.residual, plan.loss) = (Ticks(0), 0);
            plan.routes.iter_mut().for_each(|route| route.release = Ticks(1));
        }
        _ => {}
    }
    plan
}

/// A block of these circuits, in the order of travel. A head passes the check-in, the change of detectors and the check-out in this order.
fn block(circuits: &[u8]) -> Counted {
    let of = |circuit: &u8| (CIRCUITS[usize::from(*circuit)].0 * M, CIRCUITS[usize::from(*circuit)].1 * M);
    let sections: Vec<_> = circuits.iter().map(of).collect();
    let (low, high) = (sections[0].0, sections[sections.len() - 1].1);
    Counted {
        sections,
        check_in: (low - 40 * M, low - 20 * M),
        check_out: (high + 20 * M, high + 40 * M),
        error: Error::None,
        level: [false; 2],
    }
}

fn build(seed: u64, broken: Option<Broken>, on_board: bool) -> (World, Line) {
    let mut dice = Dice::new(seed);
    // The sections in the order of travel, block by block.
    let (blocks, segment, travel): ([&[u8]; 2], SegmentId, Travel) = match dice.below(4) {
        0 => ([&[5, 4, 3], &[2, 1, 0]], SegmentId::ZERO, Travel::Toward),
        1 => ([&[4, 3], &[2, 1]], SegmentId::ZERO, Travel::Toward),
        2 => ([&[5], &[4, 3, 2, 1, 0]], SegmentId::ZERO, Travel::Toward),
        _ => ([&[10, 11], &[12]], SegmentId::new(1).unwrap(), Travel::Away),
    };
    let direction = dice.of(&[Direction::Up, Direction::Down]);
    // Out of the throat, which is short, two places are held.
    let (hold, mut longest) = match (dice.of(&[1, 2]), travel) {
        (_, Travel::Away) => (2, 120),
        (1, _) => (1, 60),
        _ => (2, 160),
    };
    // With what it moves in a cycle.
    let train = Metres(u16::try_from(longest + 20).unwrap());
    longest += if broken == Some(Broken::Long) { 140 } else { 0 };
    let its = |circuits: &[u8]| {
        let sections = u8::try_from(circuits.len()).unwrap();
        Block::new(sections, sections, Hold::new(hold).unwrap(), Ticks(PASS)).unwrap()
    };
    let mut join =
        Join { blocks: [its(blocks[0]), its(blocks[1])], direction, train, segment, travel, circuits: [[None; 16]; 2] };
    for (place, circuits) in blocks.iter().enumerate() {
        let up = direction == Direction::Up;
        let number = if up { place } else { 1 - place };
        join.blocks[number] = its(circuits);
        for (section, circuit) in circuits.iter().enumerate() {
            let from_low = if up { section } else { circuits.len() - 1 - section };
            join.circuits[number][from_low] = CircuitId::new(*circuit);
        }
    }
    let mut counted: Vec<Counted> = blocks.iter().map(|circuits| block(circuits)).collect();
    if broken == Some(Broken::CheckOutBefore) {
        let high = counted[1].high();
        counted[1].check_out = (high - 25 * M, high - 5 * M);
    }
    let equipment =
        Equipment { counted: Some(join), signals: signals(CIRCUITS.len()), life: Ticks(LIFE), session: Session(9) };
    let zones = vec![Zone { low: 20 * M, high: 340 * M, points: [Some(0), Some(1)], fouling: 40 * M }];
    let ends = vec![(0, 300 * M), (1, 300 * M)];
    let mut all = vec![Signal { at: 0, heading: Heading::Right, track: None, device: 0, routes: ends }];
    for track in 0..2 {
        let routes = vec![(2 + track, 360 * M)];
        all.push(Signal { at: 300 * M, heading: Heading::Right, track: Some((0, track)), device: 0, routes });
    }
    let device = Device::new(&plan(broken, on_board), &equipment, vec![0, 1]);
    let mut world = World::new(seed, (zones, pieces(&CIRCUITS), all), vec![device], &[20 * M, 340 * M]);
    world.margin = dice.of(&[1, 50, 50, 50]) * M;
    let errors = dice.of(&[0, 40, 100, 300]);
    if on_board {
        let all: Vec<usize> = (0..CIRCUITS.len()).collect();
        world.ride(Ride::new(0, &all, &[6, 7, 8, 9]));
    }
    let line = Line {
        blocks: counted,
        direction,
        longest,
        errors,
        births: Vec::new(),
        born_at: -100,
        granted_at: -100,
        withheld: 0,
        heard: None,
    };
    (world, line)
}

impl Line {
    /// The neighbour sends a train if it may, and trains that leave are taken over.
    fn trains(&mut self, world: &mut World, broken: Option<Broken>) {
        let cycle = world.cycle;
        let room = world.trains.iter().map(|train| train.span().0).min().unwrap_or(0) + 600 * M;
        // What it has found clear are whole circuits; its signal stands 50 m before them.
        let room = room.clamp(-100 * M, 600 * M).div_euclid(100 * M) * 100 * M + 50 * M;
        let apart = cycle - self.born_at > 2 * i64::from(PASS);
        let permitted = cycle - self.granted_at <= i64::from(LIFE);
        if permitted && apart && room > 150 * M && world.dice.one_in(6) {
            let speed = [20_000, 10_000].into_iter().find(|it| it + stopping(*it) <= room).unwrap_or(5_000);
            let length = world.dice.of(&[40, 60, 100, 160]).min(self.longest);
            let length = if broken == Some(Broken::Long) { self.longest } else { length };
            let kind = world.dice.of(&[Kind::Telegrams, Kind::Signals]);
            let mut train = Train::new(-650 * M, length * M, Heading::Right, kind, [0, 0]);
            (train.outside, train.speed) = (true, speed);
            world.enter(train);
            self.births.push(cycle);
            self.born_at = cycle;
        }
        for train in &mut world.trains {
            train.outside &= !(-600 * M..0).contains(&train.nose);
            if train.nose >= 700 * M && !train.outside && world.dice.one_in(10) {
                (train.outside, train.speed) = (true, train.speed.max(5_000));
            }
        }
        if let Some(gone) = world.trains.iter().position(|train| train.span().0 > 800 * M) {
            world.trains.remove(gone);
            self.births.remove(gone);
            world.counts.arrived += 1;
        }
    }

    /// What the detectors and checks of a block say, in the order of travel.
    fn hear(&mut self, world: &World, place: usize) -> ([bool; 2], u16) {
        let block = &mut self.blocks[place];
        let (mut checks, mut present) = ([false; 2], 0_u16);
        for (train, birth) in world.trains.iter().zip(&self.births) {
            // The antenna stands on a check, or has passed it in this cycle.
            let passes = |(from, to): (i64, i64)| train.nose >= from && train.before < to;
            checks[0] |= passes(block.check_in);
            checks[1] |= passes(block.check_out);
            let missed = matches!(block.error, Error::Miss(it, _) | Error::Both(it, ..) if it == *birth);
            for (number, (low, high)) in block.sections.iter().enumerate() {
                let there = *low < train.nose && train.nose <= *high && !missed;
                present |= u16::from(there) << number;
            }
        }
        let leaves = checks[1] && !block.level[1];
        block.level = checks;
        match block.error {
            Error::Phantom(section, _) | Error::Both(_, section, _) => present |= 1 << section,
            Error::StuckIn(_) => checks[0] = true,
            Error::NoOut if leaves => {
                block.error = Error::Wrong;
                checks[1] = false;
            }
            _ => {}
        }
        block.error = match block.error {
            Error::Miss(_, until) | Error::Phantom(_, until) | Error::Both(.., until) if until <= world.cycle => {
                Error::None
            }
            Error::StuckIn(until) if until <= world.cycle => Error::Wrong,
            other => other,
        };
        (checks, present)
    }

    /// Now and then something is wrong in a block where nothing else is.
    fn err(&mut self, world: &mut World, place: usize, broken: Option<Broken>) {
        let block = &mut self.blocks[place];
        if block.error != Error::None || self.errors == 0 || !world.dice.one_in(self.errors) {
            return;
        }
        let until = world.cycle + world.dice.of(&[1, 3, 10, 40, 100]);
        let near = |(train, _): &(&Train, &i64)| block.check_in.0 <= train.nose && train.nose < block.high();
        let inside: Vec<i64> = world.trains.iter().zip(&self.births).filter(near).map(|(_, birth)| *birth).collect();
        let section = u8::try_from(world.dice.below(block.sections.len())).unwrap();
        block.error = match world.dice.below(8) {
            0..=4 if inside.is_empty() => Error::None,
            0..=4 if broken == Some(Broken::Errors) => Error::Both(world.dice.of(&inside), section, until),
            0..=4 => Error::Miss(world.dice.of(&inside), until),
            5 => Error::Phantom(section, until),
            6 => Error::StuckIn(until),
            _ => Error::NoOut,
        };
    }

    /// The reset of a block: the right number, if nothing stands across its borders; or a slip that the detectors contradict.
    fn reset(
        &mut self,
        world: &mut World,
        (place, heard): (usize, u8),
        off: bool,
        broken: Option<Broken>,
    ) -> Option<TrainCount> {
        let device = &world.devices[0];
        let (state, down) = (device.state.line.blocks[place].parts(), device.down > 0);
        let block = &mut self.blocks[place];
        let needed = state.status != Status::Counting || block.error == Error::Wrong;
        if !world.dice.one_in(if needed { 8 } else { 400 }) {
            return None;
        }
        let (low, high) = (block.low(), block.high());
        // No head either between the check-in and the block.
        let from = if broken == Some(Broken::HeadAtReset) { low } else { block.check_in.0.min(low) };
        let across = world.trains.iter().any(|train| {
            let span = train.span();
            let over = |border: i64| span.0 < border && border < span.1;
            over(low) || over(high) || from <= train.nose && train.nose <= low
        });
        let inside = world.trains.iter().filter(|train| block.has(train.nose)).count();
        let inside = u8::try_from(inside).unwrap();
        if !across && matches!(block.error, Error::None | Error::Wrong) {
            if off && state.pending == 0 && !down && heard == inside {
                block.error = Error::None;
            }
            return Some(TrainCount(inside));
        }
        (heard != inside + 1).then_some(TrainCount(inside + 1))
    }

    /// What the device is told of its blocks, from their low end.
    fn detections(&mut self, world: &mut World, broken: Option<Broken>) -> [Detection; 2] {
        let nothing = Detection { low_check: false, high_check: false, present: SectionSet::EMPTY, reset: None };
        let mut detections = [nothing; 2];
        let up = self.direction == Direction::Up;
        for place in 0..self.blocks.len() {
            self.err(world, place, broken);
            let (checks, present) = self.hear(world, place);
            let present = SectionSet::from_bits(present);
            let reset = self.reset(world, (place, present.len()), checks == [false; 2], broken);
            let sections = u8::try_from(self.blocks[place].sections.len()).unwrap();
            detections[if up { place } else { 1 - place }] = Detection {
                low_check: checks[usize::from(!up)],
                high_check: checks[usize::from(up)],
                present: if up { present } else { present.reversed(sections) },
                reset,
            };
        }
        detections
    }

    /// What circuits report of their own: on the counted line nothing but false occupancy.
    fn own(&self, world: &World, occupied: CircuitSet) -> CircuitSet {
        let mut own = occupied;
        for (number, (low, ..)) in CIRCUITS.iter().enumerate() {
            let counted = self.blocks.iter().any(|block| block.sections.iter().any(|(its, _)| *its == low * M));
            let falsely = world.falsely.iter().any(|(it, _)| *it == number);
            own = own.without(CircuitSet::nth(number).only_if(counted && !falsely));
        }
        own
    }

    /// The neighbours hear, and the one beyond permits trains, or does not.
    fn neighbours(&mut self, world: &mut World, channels: &mut [Channel; 2]) {
        let (cycle, messages) = (world.cycle, world.devices[0].output.messages);
        if messages[0].is_some_and(|message| message.permission == Permission::Granted) {
            self.granted_at = cycle;
        }
        channels[1].send(&mut world.dice, cycle, messages[1]);
        if let Some(message) = channels[1].receive(&mut world.dice, cycle) {
            self.heard = Some(message.sent);
        }
        if world.dice.one_in(300) {
            self.withheld = cycle + world.dice.between(1, 80);
        }
        let permission = if self.withheld > cycle { Permission::Withheld } else { Permission::Granted };
        let sent = Stamp { session: Session(3), cycle: Epoch(u32::try_from(cycle).unwrap()) };
        channels[0].send(&mut world.dice, cycle, Some(Message { permission, sent, echo: self.heard }));
    }
}

/// What a dispatcher asks.
fn request(world: &mut World) -> Option<Request> {
    let directions = world.devices[0].state.device.interlocking.directions;
    let (west, east) = (SegmentId::ZERO, SegmentId::new(1).unwrap());
    let track = world.dice.below(2);
    match world.dice.below(16) {
        0..=2 => world.trains.iter().any(|train| train.nose < 0).then(|| set(track)),
        3..=5 => world.trains.iter().any(|train| world.is_in(train, 7 + track)).then(|| set(2 + track)),
        6 => (directions.toward.is_empty() || world.dice.one_in(9)).then_some(Request::Turn(west, Travel::Toward)),
        7 => (directions.away.is_empty() || world.dice.one_in(9)).then_some(Request::Turn(east, Travel::Away)),
        8 if world.dice.one_in(4) => Some(withdraw(world.dice.below(4))),
        9 if world.dice.one_in(4) => {
            let point = if track == 0 { PointId::ZERO } else { PointId::new(1).unwrap() };
            Some(Request::Drive(point, world.dice.of(&[Position::Normal, Position::Reverse])))
        }
        // Refused where that line is counted.
        10 if world.dice.one_in(10) => Some(Request::Turn(west, Travel::Away)),
        _ => None,
    }
}

/// An episode: its accident, if there is one.
fn episode(seed: u64, broken: Option<Broken>, counts: &mut Counts) -> Option<String> {
    run(build(seed, broken, false), (seed, broken), counts)
}

/// The same with the kernel's device in the trains that go by telegrams; a limit is judged so many cycles after it was set.
fn on_board(seed: u64, in_force: i64, counts: &mut Counts) -> Option<String> {
    let (mut world, line) = build(seed, None, true);
    if let Some(ride) = &mut world.ride {
        ride.in_force = in_force;
    }
    run((world, line), (seed, None), counts)
}

fn run(
    (mut world, mut line): (World, Line),
    (seed, broken): (u64, Option<Broken>),
    counts: &mut Counts,
) -> Option<String> {
    let mut channels = [Channel::default(), Channel::default()];
    let restarts = world.dice.of(&[0, 0, 0, 1500, 300]);
    let (mut still, mut found) = (0, None);
    while world.cycle < 1500 && still < 300 && found.is_none() {
        found = world.advance().map(|accident| format!("seed {seed}, cycle {}: {accident}", world.cycle));
        if world.trouble(&[0, 1, 2, 3, 4, 5, 6, 9, 10, 11, 12, 13]) && world.dice.one_in(2) {
            channels[0].fall_silent(world.cycle + 150);
        }
        line.trains(&mut world, broken);
        let blocks = line.detections(&mut world, broken);
        let (occupied, detected) = world.detect(0);
        let mut given = input(line.own(&world, occupied), detected, blocks);
        given.orders = world.orders(0);
        given.request = request(&mut world);
        given.framed = world.framed(0);
        given.messages[1] = channels[0].receive(&mut world.dice, world.cycle);
        let proceeds = world.devices[0].step(given);
        world.counts.proceed += proceeds;
        line.neighbours(&mut world, &mut channels);
        world.restart(0, restarts);
        let moving = world.trains.iter().any(|train| train.speed > 0);
        still = if moving || world.trains.is_empty() { 0 } else { still + 1 };
    }
    counts.add(world.counts);
    found
}

#[test]
fn no_accident_on_a_counted_line() {
    finds_none(100, |seed, counts| episode(seed, None, counts));
}

#[test]
fn no_accident_with_devices_on_board() {
    finds_none_on_board(on_board);
}

#[test]
fn each_broken_condition_ends_in_one() {
    for (broken, first) in BROKEN {
        finds_one(&format!("{broken:?}"), first..first + 4000, |seed, counts| episode(seed, Some(broken), counts));
    }
}

/// A double track whose two tracks join in the throat: the track that leads out is counted from the throat on. A train that comes in on the other one is
/// heard in the throat, makes up for a train that is missed, and the next one is sent into that: found in the tenth attack.
#[test]
fn a_throat_that_another_line_uses_is_no_section() {
    const THROAT: usize = 0;
    const OUT: [usize; 4] = [1, 2, 3, 7];
    const PLATFORM: usize = 4;
    const IN: [usize; 2] = [5, 6];
    let piece = |from: i64, to: i64| -> Piece { (from, to, None) };
    let out = [piece(-100, 0), piece(-200, -100), piece(-300, -200)];
    let before = [piece(0, 60), out[0], out[1], out[2], piece(60, 360), out[0], out[1], piece(-400, -300)];
    let mut plan = draft(&pieces(&before));
    plan.points = [point(THROAT), point(63)];
    plan.routes[0] = route(Heading::Left, PLATFORM, &[PLATFORM], &[(THROAT, at(0, 0))], OUT[0]);
    plan.routes[0].to = SegmentSet::nth(0);
    plan.routes[1] = route(Heading::Right, IN[0], &IN, &[(THROAT, at(0, 1)), (PLATFORM, Positions::NONE)], 8);
    plan.routes[1].from = SegmentSet::nth(1);
    for (segment, its) in plan.segments.iter_mut().zip([&OUT[..], &IN[..]]) {
        *segment = Segment { outward: Heading::Left, ..Segment::NONE };
        segment.length = u8::try_from(its.len()).expect("few circuits");
        for (place, circuit) in segment.circuits.iter_mut().zip(its) {
            *place = CircuitSet::nth(*circuit);
        }
    }
    plan.segments[0].throat = CircuitSet::nth(THROAT);
    let layout = world::Station::with_what_proofs_need(plan).expect("a layout");
    let counted = |sections: &[usize]| {
        let block = |count: usize| {
            let sections = u8::try_from(count).expect("few sections");
            Block::new(sections, sections, Hold::new(1).expect("one section"), Ticks(PASS)).expect("a block")
        };
        let mut join = Join {
            blocks: [block(sections.len() - 1), block(1)],
            direction: Direction::Up,
            train: Metres(60),
            segment: SegmentId::ZERO,
            travel: Travel::Away,
            circuits: [[None; 16]; 2],
        };
        let (last, first) = sections.split_last().expect("sections");
        let id = |circuit: &usize| CircuitId::new(u8::try_from(*circuit).expect("few circuits"));
        for (section, circuit) in first.iter().enumerate() {
            join.circuits[0][section] = id(circuit);
        }
        join.circuits[1][0] = id(last);
        let signals = signals(before.len());
        let equipment = Equipment { counted: Some(join), signals, life: Ticks(LIFE), session: Session(9) };
        Wayside::new(&layout, &equipment).err()
    };
    assert_eq!(counted(&[THROAT, OUT[0], OUT[1], OUT[2]]), Some(WaysideError::RouteOfAnotherLine(1)));
    assert_eq!(counted(&OUT[..3]), None, "from behind the throat on");
}
