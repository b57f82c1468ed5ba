//! How the adversary draws its moves from a seed, and when it hurts most.

use super::arsenal::Arsenal;
use super::device::{Ask, Commands, all};
use super::dice::Dice;
use super::dispatcher::{busy_lines, dispatch};
use super::ground::{Ground, Mask, bit, members, mm_s};
use super::moves::{Arrival, Move};
use super::neighbour::Manner;
use super::train::{Driver, Train};
use super::world::{Setting, World};

/// Draws the moves of an episode.
pub struct Attacker {
    dice: Dice,
    arsenal: Arsenal,
    driver: Option<Driver>,
    unblock: Option<i64>,
    interval: usize,
    /// For how long the stations agree on a direction.
    agreed: i64,
    later: Vec<(i64, Move)>,
}

impl Attacker {
    /// The attacker of a seed.
    pub fn new(seed: u64, arsenal: Arsenal) -> Self {
        let mut dice = Dice::new(seed);
        let interval = [3, 6, 12, 25][dice.below(4)];
        let driver = match arsenal.drivers {
            [true, false] => Some(Driver::Telegrams),
            [false, true] => Some(Driver::Signals),
            _ => dice.pick(&[None, Some(Driver::Telegrams), Some(Driver::Telegrams), Some(Driver::Signals)]).flatten(),
        };
        let agreed = dice.within(700, 2500);
        Self { dice, arsenal, driver, unblock: None, interval, agreed, later: Vec::new() }
    }

    /// What is fixed for the episode.
    pub fn setting(&mut self, ground: &Ground) -> Setting {
        let slow = u32::try_from(self.dice.next() & 0xFFFF_FFFF).unwrap_or(0);
        let late = self.dice.within(0, (ground.life - 1).max(0));
        Setting {
            manner: Manner { overlaps: self.dice.once_in(2), late, blind: self.arsenal.blind_neighbours },
            slow: if self.arsenal.slow_points { slow } else { 0 },
            throw_percent: self.dice.within(30, 100),
            faces: self.arsenal.faces,
        }
    }

    fn arrival(&mut self, ground: &Ground) -> Arrival {
        let length = self.dice.within(40_000, ground.longest.clamp(40_000, 200_000));
        let any = if self.dice.once_in(2) { Driver::Telegrams } else { Driver::Signals };
        let gap = if self.dice.once_in(2) { 0 } else { self.dice.within(0, 30_000) };
        let speed = self.dice.within(ground.fastest / 4, ground.fastest);
        Arrival { length, driver: self.driver.unwrap_or(any), speed, gap, about: self.dice.once_in(2) }
    }

    /// The moves of the next cycle.
    pub fn draw(&mut self, world: &World, moves: &mut Vec<Move>) {
        let ground = world.ground;
        let now = world.truth.now;
        if now == 0 {
            // After a start nobody knows which way a train on plain line was sent: it stays there for good.
            let line = ground.lines.iter().fold(0, |all, line| all | line.mask);
            let inside: Vec<usize> = members(all(ground) & !line).collect();
            for _ in 0..=self.dice.below(3) {
                let any = self.dice.below(ground.seen);
                let circuit = self.dice.pick(&inside).filter(|_| !self.dice.once_in(8)).unwrap_or(any);
                let arrival = self.arrival(ground);
                moves.push(Move::Place(circuit, arrival));
            }
            return;
        }
        if self.unblock.is_some_and(|when| when <= now) {
            self.unblock = None;
            moves.push(Move::Command(Commands { unblock: all(ground), lift: all(ground), ..Commands::default() }));
        }
        moves.extend(self.later.iter().filter(|(when, _)| *when == now).map(|(_, it)| *it));
        self.later.retain(|(when, _)| *when > now);
        if self.arsenal.one + self.arsenal.many + self.arsenal.lose > 0 {
            for train in &world.trains {
                if at_joint(ground, train) && self.dice.once_in(8) {
                    self.hurt(world, train, moves);
                }
            }
        }
        if self.dice.once_in(self.interval) {
            let weights = self.arsenal.weights();
            let mut drawn = self.dice.below(weights.iter().sum());
            let mut kind = 0;
            while drawn >= weights[kind] {
                drawn -= weights[kind];
                kind += 1;
            }
            self.kind(kind, world, moves);
        }
    }

    fn kind(&mut self, kind: usize, world: &World, moves: &mut Vec<Move>) {
        let ground = world.ground;
        let circuit = self.dice.below(ground.seen);
        let train = self.dice.below(world.trains.len());
        let train = world.trains.get(train);
        match kind {
            0 => {
                let (agreed, arsenal) = (self.agreed, self.arsenal);
                let sends = |line: usize| agree(world, line, agreed, arsenal) == Agreed::Out;
                dispatch(world, &mut self.dice, &sends, moves);
            }
            1 => {
                let asked: Vec<usize> = (0..ground.routes.len()).filter(|route| world.truth.asked[*route].0).collect();
                if let Some(route) = self.dice.pick(&asked) {
                    moves.push(Move::Ask(Ask::Withdraw(route)));
                }
            }
            2 if !ground.points.is_empty() => {
                let point = self.dice.below(ground.points.len());
                // Mostly away from where it lies.
                let reverse = world.points.lies(point) == self.dice.once_in(8);
                moves.push(Move::Ask(Ask::Drive(point, reverse)));
                if self.arsenal.slow_points && self.dice.once_in(2) {
                    self.leave_late(world, point);
                }
            }
            3 => self.on_line(world, moves),
            4 => {
                if let Some(line) = self.line(ground) {
                    moves.push(Move::NeighbourWork(line, !self.dice.once_in(3)));
                }
            }
            5 => {
                let mask = self.near(world, circuit);
                let lift = if self.dice.once_in(3) { all(ground) } else { 0 };
                let code = u8::try_from(self.dice.within(0, 4)).unwrap_or(0);
                let restrict = if lift == 0 { (mask, code) } else { (0, 0) };
                moves.push(Move::Command(Commands { restrict, lift, ..Commands::default() }));
            }
            6 => self.maintain(world, circuit, moves),
            7 => {
                let mask = self.near(world, circuit);
                self.occupy(world, mask, moves);
            }
            8 => {
                let mask = self.some(ground);
                self.occupy(world, mask, moves);
            }
            9 => {
                if let Some(train) = train {
                    let under: Vec<usize> = members(train.under & all(ground)).collect();
                    if let Some(circuit) = self.dice.pick(&under) {
                        moves.push(Move::Lose(circuit, self.dice.within(1, ground.loss.max(1))));
                    }
                }
            }
            10 => {
                if let Some(train) = train {
                    moves.push(Move::Deaf(train.number, self.dice.within(1, ground.life)));
                }
            }
            11 if !ground.points.is_empty() => {
                let point = self.dice.below(ground.points.len());
                moves.push(Move::Blind(point, self.lasting(ground)));
            }
            12 => {
                if let Some(train) = train.filter(|train| train.speed == 0) {
                    moves.push(Move::Face(train.number));
                    if self.arsenal.block > 0 && train.driver == Driver::Signals && self.dice.once_in(2) {
                        self.work_before(world, train);
                    }
                }
            }
            13 => {
                if let Some(train) = train {
                    let slow = self.dice.within(0, ground.fastest);
                    let pace = if self.dice.once_in(2) { mm_s(400) } else { slow };
                    moves.push(Move::Pace(train.number, pace));
                }
            }
            14 if self.dice.once_in(8) => {
                moves.push(Move::Restart);
                let unblock = world.truth.now + self.dice.within(1, 60);
                self.unblock = Some(unblock);
                self.turn_after(world, unblock, moves);
                self.dawdle(world, unblock, moves);
            }
            _ => {}
        }
    }

    /// A route over a point that was just driven, for a train that hears of it and then nothing more.
    fn leave_late(&mut self, world: &World, point: usize) {
        let ground = world.ground;
        let Some(train) = world.trains.get(self.dice.below(world.trains.len())) else { return };
        let here = bit(train.front_circuit(ground));
        let lies = world.points.lies(point);
        let over = |route: &usize| {
            ground.routes[*route].entry_mask() & here != 0 && ground.routes[*route].points.contains(&(point, lies))
        };
        let wanted: Vec<usize> = (0..ground.routes.len()).filter(over).collect();
        if let Some(route) = self.dice.pick(&wanted) {
            let now = world.truth.now;
            self.later.push((now + 1, Move::Ask(Ask::Set(route))));
            self.later.push((now + 2, Move::Deaf(train.number, ground.life)));
        }
    }

    /// A line with a train on it is turned as soon as the device that forgot the train obeys.
    fn turn_after(&mut self, world: &World, unblock: i64, moves: &mut Vec<Move>) {
        let ground = world.ground;
        if self.arsenal.line == 0 || self.dice.once_in(2) {
            return;
        }
        if let Some(line) = self.dice.pick(&busy_lines(world, ground)) {
            moves.push(Move::Consent(line, false));
            for obeys in [unblock, unblock.max(world.truth.now + ground.start)] {
                self.later.push((obeys + 1, Move::Ask(Ask::Turn(line, false))));
                for wait in [3, 10, ground.turn] {
                    let arrival = self.arrival(ground);
                    self.later.push((obeys + wait, Move::Send(line, arrival)));
                }
            }
        }
    }

    /// A driver who goes by signals takes his time: he goes on when the device that forgot him obeys, and staff have come where they may.
    fn dawdle(&mut self, world: &World, unblock: i64, moves: &mut Vec<Move>) {
        let ground = world.ground;
        if self.arsenal.block == 0 || !self.arsenal.drivers[1] {
            return;
        }
        let running = world.trains.iter().filter(|train| train.driver == Driver::Signals && train.speed > 0);
        let running: Vec<usize> = running.map(|train| train.number).collect();
        let Some(train) = self.dice.pick(&running) else { return };
        moves.push(Move::Pace(train, 0));
        let obeys = unblock.max(world.truth.now + ground.start) + 1;
        self.later.push((obeys, Move::Command(Commands { block: all(ground), ..Commands::default() })));
        for circuit in members(all(ground)) {
            self.later.push((obeys + 3, Move::Work(circuit, true)));
        }
        self.later.push((obeys + 6, Move::Pace(train, mm_s(400))));
    }

    /// Staff block what adjoins a train that changes ends, before or after its signal may show proceed, and come as soon as they may.
    fn work_before(&mut self, world: &World, train: &Train) {
        let ground = world.ground;
        let block = next_to(ground, train) & all(ground);
        let begin = world.truth.now + self.dice.pick(&[1, 6, 20, 60]).unwrap_or(1);
        self.later.push((begin, Move::Command(Commands { block, ..Commands::default() })));
        for circuit in members(block) {
            for wait in [1, 2, ground.clear + 2, 30] {
                self.later.push((begin + wait, Move::Work(circuit, true)));
            }
        }
        self.later.push((begin, Move::Pace(train.number, mm_s(400))));
    }

    fn line(&mut self, ground: &Ground) -> Option<usize> {
        (!ground.lines.is_empty()).then(|| self.dice.below(ground.lines.len()))
    }

    fn on_line(&mut self, world: &World, moves: &mut Vec<Move>) {
        let Some(line) = self.line(world.ground) else { return };
        let ways = world.ground.lines[line].ways;
        let drawn = if self.dice.once_in(4) { self.dice.below(7) } else { self.as_agreed(world, line) };
        match drawn {
            0 | 1 if ways[0] => moves.push(Move::Ask(Ask::Turn(line, false))),
            2 if ways[1] => moves.push(Move::Ask(Ask::Turn(line, true))),
            3 if ways[1] => moves.push(Move::Consent(line, true)),
            4 => moves.push(Move::Consent(line, false)),
            7 => moves.push(Move::NeighbourWork(line, true)),
            _ if ways[0] => {
                let arrival = self.arrival(world.ground);
                if world.trains.len() < 5 && world.neighbours[line].is_permitted(world.ground) {
                    moves.push(Move::Send(line, arrival));
                }
            }
            _ => {}
        }
    }

    /// What serves what the two stations have agreed on: turns that are taken back at once bring no train.
    fn as_agreed(&mut self, world: &World, line: usize) -> usize {
        let kinds: &[usize] = match agree(world, line, self.agreed, self.arsenal) {
            Agreed::In => &[0, 4, 5, 5],
            Agreed::Out => &[2, 3],
            Agreed::Work => &[4, 7],
        };
        self.dice.pick(kinds).unwrap_or(0)
    }

    fn occupy(&mut self, world: &World, mask: Mask, moves: &mut Vec<Move>) {
        let lasts = self.lasting(world.ground);
        moves.push(Move::Occupy(mask, lasts));
        self.drive_after(world, lasts);
    }

    /// Points are driven once a false occupancy is over: what a train has left need not be locked any more.
    fn drive_after(&mut self, world: &World, lasts: i64) {
        let asked: Vec<usize> = (0..world.ground.routes.len()).filter(|route| world.truth.asked[*route].0).collect();
        let Some(route) = self.dice.pick(&asked).filter(|_| self.arsenal.point > 0 && !self.dice.once_in(3)) else {
            return;
        };
        if let Some((point, reverse)) = self.dice.pick(&world.ground.routes[route].points) {
            for wait in [1, 4, 12] {
                let when = world.truth.now + lasts + world.ground.clear + wait;
                self.later.push((when, Move::Ask(Ask::Drive(point, !reverse))));
            }
        }
    }

    fn maintain(&mut self, world: &World, circuit: usize, moves: &mut Vec<Move>) {
        let ground = world.ground;
        let working: Vec<usize> = members(world.truth.workers & all(ground)).collect();
        let confirmed: Vec<usize> = members(world.said.confirmed & all(ground)).collect();
        match self.dice.below(4) {
            0 => {
                let mask = self.near(world, circuit);
                moves.push(Move::Command(Commands { block: mask, ..Commands::default() }));
            }
            1 => {
                for circuit in working {
                    moves.push(Move::Work(circuit, false));
                }
                moves.push(Move::Command(Commands { unblock: all(ground), ..Commands::default() }));
            }
            _ => {
                if let Some(circuit) = self.dice.pick(&confirmed) {
                    moves.push(Move::Work(circuit, true));
                }
            }
        }
    }

    /// A circuit: near a train more often than not.
    fn near(&mut self, world: &World, circuit: usize) -> Mask {
        let ground = world.ground;
        if let Some(train) = world.trains.get(self.dice.below(world.trains.len() + 1)) {
            let ahead: Vec<usize> = members((train.under | next_to(ground, train)) & all(ground)).collect();
            if let Some(circuit) = self.dice.pick(&ahead) {
                return bit(circuit);
            }
        }
        bit(circuit)
    }

    /// A set of circuits: all, a route's, or any.
    fn some(&mut self, ground: &Ground) -> Mask {
        let route = self.dice.below(ground.routes.len());
        let any = Mask::from(self.dice.next());
        match self.dice.below(4) {
            0 | 1 => all(ground),
            2 => ground.routes[route].mask | bit(ground.routes[route].entry),
            _ => any & all(ground),
        }
    }

    /// For how long: a cycle, about the clear time, or long.
    fn lasting(&mut self, ground: &Ground) -> i64 {
        let around = self.dice.within(ground.clear - 2, ground.clear + 2);
        let long = self.dice.within(1, 600);
        self.dice.pick(&[1, 1, 2, 3, around, long]).unwrap_or(1).max(1)
    }

    /// Something just when a front or a tail passes a joint.
    fn hurt(&mut self, world: &World, train: &Train, moves: &mut Vec<Move>) {
        let ground = world.ground;
        let (one, many, lose) = (self.arsenal.one, self.arsenal.many, self.arsenal.lose);
        let drawn = self.dice.below(one + many + lose);
        if drawn < one {
            let about = (next_to(ground, train) | train.under) & all(ground);
            let circuits: Vec<usize> = members(about).collect();
            if let Some(circuit) = self.dice.pick(&circuits) {
                self.occupy(world, bit(circuit), moves);
            }
        } else if drawn < one + many {
            let mask = self.some(ground);
            self.occupy(world, mask, moves);
        } else {
            let circuits: Vec<usize> = members((train.under | next_to(ground, train)) & all(ground)).collect();
            if let Some(circuit) = self.dice.pick(&circuits) {
                moves.push(Move::Lose(circuit, self.dice.within(1, ground.loss.max(1))));
            }
        }
    }
}

/// What two stations have agreed on for a line.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Agreed {
    /// The neighbour sends.
    In,
    /// This station sends.
    Out,
    /// Nobody sends: the neighbour's workers want the line, and this station is not told to turn it.
    Work,
}

/// What they have agreed on now; it changes every `lasts` cycles.
fn agree(world: &World, line: usize, lasts: i64, arsenal: Arsenal) -> Agreed {
    let begun = usize::try_from(world.truth.now / lasts).unwrap_or(0) + line;
    match world.ground.lines[line].ways {
        [_, true] if arsenal.neighbour_work > 0 && begun % 4 == 2 => Agreed::Work,
        [true, false] => Agreed::In,
        [true, true] if begun.is_multiple_of(2) => Agreed::In,
        _ => Agreed::Out,
    }
}

/// Whether the front or the tail passes a joint in this cycle, or in one of the two next.
fn at_joint(ground: &Ground, train: &Train) -> bool {
    let soon = train.speed * ground.cycle_ms * 3 / 1000;
    train.speed > 0 && (train.to_joint() <= soon || train.at <= soon || train.tail_to_joint() <= soon)
}

/// The circuits that adjoin those under a train.
fn next_to(ground: &Ground, train: &Train) -> Mask {
    let mut found = 0;
    for leg in &train.legs {
        for joint in &ground.pieces[leg.piece].joints {
            for piece in &ground.joints[*joint] {
                found |= bit(ground.pieces[*piece].circuit);
            }
        }
    }
    found & !train.under
}
