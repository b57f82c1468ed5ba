//! What happens between two stations and to one of them alone: directions, restarts, traffic, staff, false reports.

use super::device::{Ask, Commands, all};
use super::dice::Dice;
use super::dispatcher::wanted as wanted_routes;
use super::ground::{Ground, Mask, bit, members, mm_s};
use super::joined::Place;
use super::moves::{Arrival, Move};
use super::pair::Pair;
use super::train::Driver;
use super::world::World;

/// What happens on the line between the stations, and to one station alone.
pub struct Between {
    /// Its chances.
    pub dice: Dice,
    agreed: i64,
    duel: bool,
    /// Every third of these times is disturbed, in cycles.
    pub period: i64,
    restarts: usize,
    /// Whether trains slide.
    pub slides: bool,
    /// How often staff restrict and block: once in so many cycles, or never.
    orders: [usize; 2],
    recall: [Option<i64>; 2],
    extra: [i64; 2],
    route: Mask,
    crossed: Vec<Option<bool>>,
}

impl Between {
    /// From the seed of an episode.
    pub fn new(seed: u64) -> Self {
        let mut dice = Dice::new(seed ^ 0x1234_5678_9ABC_DEF0);
        let agreed = dice.within(600, 4_000);
        let duel = dice.once_in(4);
        let restarts = [0, 1_500, 6_000, 20_000][dice.below(4)];
        let slides = dice.once_in(2);
        let period = dice.within(100, 900);
        let orders = [[0, 300, 1_500][dice.below(3)], [0, 0, 400][dice.below(3)]];
        Self {
            dice,
            agreed,
            duel,
            period,
            restarts,
            slides,
            orders,
            recall: [None; 2],
            extra: [0; 2],
            route: 0,
            crossed: Vec::new(),
        }
    }

    /// The two stations ask for directions as they have agreed, or against each other.
    pub fn turns(&mut self, places: &[Place; 2], now: i64, pair: &mut Pair) {
        if !self.dice.once_in(5) {
            return;
        }
        let right = (now / self.agreed) % 2 == 0;
        for (at, place) in places.iter().enumerate() {
            let sends = right == (at == 0);
            let away = if self.duel && self.dice.once_in(3) { self.dice.once_in(2) } else { sends };
            if self.dice.once_in(2) {
                pair.asks[at] = Some(Ask::Turn(place.lines + place.inner, away));
            }
        }
    }

    /// One device restarts; later its staff command what their record has.
    pub fn restart(&mut self, world: &mut World, places: &[Place; 2], pair: &mut Pair) -> bool {
        let now = world.truth.now;
        for at in 0..2 {
            if self.recall[at].is_some_and(|when| when <= now) {
                self.recall[at] = None;
                pair.recall(at);
            }
        }
        if self.restarts == 0 || !self.dice.once_in(self.restarts) {
            return false;
        }
        let at = self.dice.below(2);
        let off = [0, 1, 3, 40][self.dice.below(4)];
        pair.restart_one(at, off);
        self.recall[at] = Some(now + off + self.dice.within(1, 60));
        let place = &places[at];
        for route in place.routes..place.routes + place.route_count {
            if world.truth.asked[route].0 {
                world.truth.asked[route] = (false, now);
            }
            world.said.proceed &= !(1 << route);
        }
        world.said.confirmed &= !pair.sees(at) | pair.sees(1 - at);
        true
    }

    /// Trains are let run: routes for those that stand at signals, new ones from beyond, and drivers who change ends.
    pub fn traffic(&mut self, (world, places): (&World, &[Place; 2]), pair: &Pair, moves: &mut Vec<Move>) {
        if !self.dice.once_in(6) {
            return;
        }
        let ground = world.ground;
        if world.trains.len() < 3 && self.dice.once_in(12) {
            let outer: Vec<usize> = (0..ground.lines.len()).filter(|line| ground.lines[*line].ways[0]).collect();
            let Some(line) = self.dice.pick(&outer) else { return };
            moves.push(Move::Consent(line, false));
            moves.push(Move::Ask(Ask::Turn(line, false)));
            let driver = if self.dice.once_in(3) { Driver::Signals } else { Driver::Telegrams };
            let (length, speed) =
                (self.dice.within(40_000, ground.longest), self.dice.within(ground.fastest / 2, ground.fastest));
            moves.push(Move::Send(
                line,
                Arrival { length, driver, speed, gap: self.dice.within(0, 5_000), about: false },
            ));
            return;
        }
        let Some(train) = world.trains.get(self.dice.below(world.trains.len())) else { return };
        if train.speed == 0 && train.authority == 0 && self.dice.once_in(25) {
            moves.push(Move::Face(train.number));
        }
        let routes = wanted_routes(world, train);
        if train.speed == 0 && self.dice.once_in(12) {
            moves.push(Move::Pace(train.number, mm_s(400)));
        }
        if train.speed == 0 && train.authority == 0 {
            // What a false occupancy has closed is withdrawn, and asked for anew; so is what was withdrawn under the train.
            let asked: Vec<usize> = routes.iter().copied().filter(|route| world.truth.asked[*route].0).collect();
            if let Some(route) = self.dice.pick(&asked).filter(|_| self.dice.once_in(8)) {
                moves.push(Move::Ask(Ask::Withdraw(route)));
                return;
            }
            if let Some(route) = train.route.filter(|_| routes.is_empty()) {
                moves.push(Move::Ask(Ask::Set(route)));
                return;
            }
        }
        let Some(route) = self.dice.pick(&routes) else { return };
        let inner = places.iter().position(|place| ground.routes[route].lines[1] == Some(place.lines + place.inner));
        match ground.routes[route].lines[1] {
            Some(_) if inner.is_some_and(|at| !pair.consented(at)) => {}
            Some(line) if inner.is_none() && self.dice.once_in(2) => {
                moves.push(Move::Consent(line, true));
                moves.push(Move::Ask(Ask::Turn(line, true)));
            }
            _ => moves.push(Move::Ask(Ask::Set(route))),
        }
    }

    /// Where trains slide others are let through, if the device lets them.
    pub fn beside(&mut self, world: &World, over: Mask, moves: &mut Vec<Move>) {
        self.route |= over;
        if self.dice.once_in(300) {
            self.route = 0;
        }
        if self.route == 0 || !self.dice.once_in(3) {
            return;
        }
        let ground = world.ground;
        let over: Vec<usize> =
            (0..ground.routes.len()).filter(|at| ground.routes[*at].mask & self.route != 0).collect();
        let points: Vec<usize> =
            ground.pieces.iter().filter(|it| bit(it.circuit) & self.route != 0).filter_map(|it| it.point).collect();
        if self.dice.once_in(3) {
            if let Some(point) = self.dice.pick(&points) {
                moves.push(Move::Ask(Ask::Drive(point, !world.points.lies(point))));
            }
        } else if let Some(route) = self.dice.pick(&over) {
            moves.push(Move::Ask(Ask::Set(route)));
        }
    }

    /// Restrictions near the line, set, lowered, raised; blocks on it, with staff as soon as one may step on.
    pub fn staff(&mut self, world: &World, line: Mask, moves: &mut Vec<Move>) -> bool {
        let circuits: Vec<usize> = members(line).collect();
        let Some(circuit) = self.dice.pick(&circuits) else { return false };
        let mut restricted = false;
        let [restricts, blocks] = self.orders;
        if restricts > 0 && self.dice.once_in(restricts) {
            let code =
                u8::try_from(self.dice.below(world.ground.codes.len().min(6)).max(usize::from(!self.dice.once_in(3))))
                    .unwrap_or(0);
            let lift = [0, bit(circuit), line][self.dice.below(3)];
            let restrict = if self.dice.once_in(3) { (0, 0) } else { (bit(circuit), code) };
            moves.push(Move::Command(Commands { restrict, lift, ..Commands::default() }));
            restricted = true;
        } else if blocks > 0 && self.dice.once_in(blocks) {
            moves.push(Move::Command(Commands { block: bit(circuit), ..Commands::default() }));
        } else if self.dice.once_in(500) {
            let here: Vec<usize> = members(world.truth.workers & all(world.ground)).collect();
            moves.extend(here.into_iter().map(|circuit| Move::Work(circuit, false)));
            moves.push(Move::Command(Commands {
                unblock: all(world.ground),
                lift: if restricts > 0 && !self.dice.once_in(4) { 0 } else { all(world.ground) },
                ..Commands::default()
            }));
        }
        for circuit in members(world.said.confirmed & line) {
            if self.dice.once_in(8) {
                moves.push(Move::Work(circuit, true));
            }
        }
        restricted
    }

    /// Only one station is falsely told of a train; messages stay out for a while.
    pub fn disturb(&mut self, pair: &mut Pair, ground: &Ground, line: Mask) {
        for at in 0..2 {
            self.extra[at] -= 1;
            if self.extra[at] <= 0 {
                pair.extra[at] = 0;
                if self.dice.once_in(300) {
                    let circuits: Vec<usize> = members(pair.sees(at) & line).collect();
                    pair.extra[at] = self.dice.pick(&circuits).map_or(0, bit);
                    self.extra[at] = [1, 2, 5, ground.clear, 60][self.dice.below(5)];
                }
            }
        }
        if self.dice.once_in(900) {
            pair.silence(self.dice.within(1, 2 * ground.turn));
        }
    }

    /// How many trains have come over the border since the last cycle: onto another side's line circuits.
    pub fn crossings(&mut self, world: &World, sides: [Mask; 2]) -> u64 {
        let mut count = 0;
        for train in &world.trains {
            self.crossed.resize(self.crossed.len().max(train.number + 1), None);
            let here = bit(train.front_circuit(world.ground));
            let side = if sides[0] & here != 0 {
                Some(false)
            } else if sides[1] & here != 0 {
                Some(true)
            } else {
                None
            };
            let before = &mut self.crossed[train.number];
            if side.is_some() && *before != side {
                count += u64::from(before.is_some());
                *before = side;
            }
        }
        count
    }
}
