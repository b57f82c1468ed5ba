//! A train: where it is, to the mm, and how it moves.

use super::ground::{Ground, Mask, bit};
use super::point::Points;

/// What a driver acts on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Driver {
    /// On telegrams alone.
    Telegrams,
    /// On optical signals; where there are none, on plain line, on telegrams.
    Signals,
}

/// A piece of track under a train.
#[derive(Clone, Copy, Debug)]
pub struct Leg {
    /// The piece.
    pub piece: usize,
    /// The joint where the train came in.
    pub enter: usize,
    /// The joint where it leaves.
    pub exit: usize,
    /// The length of the piece.
    pub length: i64,
    /// The limit there for this train.
    pub limit: i64,
    /// The point, and whether it must be reverse.
    pub over: Option<(usize, bool)>,
}

/// What a train was last told, and by whom.
#[derive(Clone, Copy, Debug)]
pub struct Heard {
    /// How far it may run, on its own odometer.
    pub limit: i64,
    /// How fast.
    pub speed: i64,
    /// The circuits that it may enter.
    pub hold: Mask,
    /// The cycles since it was told.
    pub age: i64,
    /// Whether the neighbour's device said so.
    pub neighbour: bool,
}

impl Heard {
    /// Stop.
    pub const STOP: Self = Self { limit: 0, speed: 0, hold: 0, age: 0, neighbour: false };
}

/// A train.
#[derive(Clone, Debug)]
pub struct Train {
    /// Its number, in the order of arrival.
    pub number: usize,
    /// Its length.
    pub length: i64,
    /// What its driver acts on.
    pub driver: Driver,
    /// Its speed.
    pub speed: i64,
    /// Its speed at the end of the next cycle, as its driver has decided.
    pub next: i64,
    /// What its front has run.
    pub run: i64,
    /// Where its front is on the last leg.
    pub at: i64,
    /// The pieces under it, the front last.
    pub legs: Vec<Leg>,
    /// The highest speed that its driver chooses.
    pub pace: i64,
    /// How far before a limit its driver stops.
    pub gap: i64,
    /// For how many cycles yet it receives nothing.
    pub deaf: i64,
    /// What it was told last.
    pub heard: Heard,
    /// The route that it runs on, as it lay when the front passed its signal.
    pub route: Option<usize>,
    /// Its driver has changed ends, and it has passed no signal since.
    pub about: bool,
    /// It has passed a signal at stop and stands, or will.
    pub slid: bool,
    /// How far it may run as its driver sees it, on its own odometer.
    pub target: i64,
    /// The circuits ahead that it has authority for.
    pub authority: Mask,
    /// The circuit that comes next, if it has authority to enter it.
    pub first_ahead: Mask,
    /// The same as the authority, and those that it runs over if it brakes now.
    pub claim: Mask,
    /// The circuits under it.
    pub under: Mask,
}

impl Train {
    /// The piece with the front.
    pub fn front(&self) -> Leg {
        self.legs[self.legs.len() - 1]
    }

    /// The circuit with the front.
    pub fn front_circuit(&self, ground: &Ground) -> usize {
        ground.pieces[self.front().piece].circuit
    }

    /// What is left of the front's piece.
    pub fn to_joint(&self) -> i64 {
        self.front().length - self.at
    }

    /// How far the tail is from leaving its piece.
    pub fn tail_to_joint(&self) -> i64 {
        let whole: i64 = self.legs.iter().map(|leg| leg.length).sum();
        let behind = whole - self.front().length + self.at - self.length;
        self.legs[0].length - behind
    }

    /// The pieces under it, each with the part that it stands on, from the joint where it came in.
    pub fn parts(&self) -> impl Iterator<Item = (&Leg, i64, i64)> {
        let mut left = self.length;
        self.legs.iter().rev().enumerate().map_while(move |(number, leg)| {
            let end = if number == 0 { self.at } else { leg.length };
            let begin = (end - left).max(0);
            let any = left > 0;
            left -= end - begin;
            any.then_some((leg, begin, end))
        })
    }

    /// Forgets what the tail has left, and notes what is under the train.
    pub fn settle(&mut self, ground: &Ground) {
        let mut covered = self.at;
        let mut first = self.legs.len() - 1;
        while first > 0 && covered < self.length {
            first -= 1;
            covered += self.legs[first].length;
        }
        self.legs.drain(..first);
        self.under = self.legs.iter().fold(0, |all, leg| all | bit(ground.pieces[leg.piece].circuit));
    }

    /// Runs for a cycle at a speed that changes to `next`. The joints that the front passes are told to `passed`; a track that ends stops it.
    pub fn advance(&mut self, ground: &Ground, points: &Points, next: i64) -> Vec<(usize, usize)> {
        let moved = (self.speed + next) * ground.cycle_ms / 2000;
        self.speed = next;
        self.run += moved;
        self.at += moved;
        let mut passed = Vec::new();
        while self.at >= self.front().length {
            let front = self.front();
            let Some(piece) = ground.across(front.exit, front.piece) else {
                self.at = front.length;
                self.speed = 0;
                break;
            };
            self.at -= front.length;
            passed.push((front.exit, ground.pieces[front.piece].circuit));
            self.enter(ground, points, piece, front);
        }
        self.settle(ground);
        passed
    }

    fn enter(&mut self, ground: &Ground, points: &Points, piece: usize, from: Leg) {
        let came = ground.pieces[from.piece].circuit;
        let circuit = ground.pieces[piece].circuit;
        let lies =
            |route: &super::ground::Route| route.points.iter().all(|(point, reverse)| points.lies(*point) == *reverse);
        let begins = |route: &super::ground::Route| route.start == from.exit && route.entry == came;
        if let Some(route) = ground.routes.iter().position(|route| begins(route) && lies(route)) {
            self.route = Some(route);
        } else if self.route.is_some_and(|route| ground.routes[route].mask & bit(circuit) == 0) {
            self.route = None;
        }
        self.about &= !ground.routes.iter().any(begins);
        self.legs.push(leg(ground, points, piece, from.exit, self.route));
    }

    /// The driver changes ends.
    pub fn face_about(&mut self) {
        let tail = self.tail_to_joint();
        self.legs.reverse();
        for leg in &mut self.legs {
            (leg.enter, leg.exit) = (leg.exit, leg.enter);
        }
        self.at = tail;
        self.heard = Heard::STOP;
        self.target = self.run;
        self.slid = false;
        self.about = true;
        self.route = None;
        self.next = 0;
    }
}

/// The leg over `piece` from `joint`, as its point lies.
pub fn leg(ground: &Ground, points: &Points, piece: usize, joint: usize, route: Option<usize>) -> Leg {
    let reverse = ground.pieces[piece].point.is_some_and(|point| points.lies(point));
    let (exit, over) = ground.leave(piece, joint, reverse);
    let mut limit = route.map_or(i64::MAX, |route| ground.routes[route].limit);
    if let Some((point, true)) = over {
        limit = limit.min(ground.reverse[point]);
    }
    Leg { piece, enter: joint, exit, length: ground.pieces[piece].length, limit, over }
}

/// The highest speed a cycle later: not over `wanted`, and such that the train still stops within `distance` with `brake`.
pub fn next_speed(speed: i64, wanted: i64, distance: i64, brake: i64, cycle_ms: i64) -> i64 {
    let change = brake * cycle_ms / 1000;
    let fits = |next: i64| {
        let moved = (speed + next) * cycle_ms / 2000;
        next >= 0 && next * next <= 2 * brake * (distance - moved).max(0)
    };
    let slower = (speed - change).max(0);
    let fast = (speed + change).min(wanted.max(slower));
    if fits(fast) {
        return fast;
    }
    // Between: keep, or go up by a part.
    for part in [3, 2, 1, 0] {
        let some = slower + (fast - slower) * part / 4;
        if fits(some) && some <= wanted.max(slower) {
            return some;
        }
    }
    slower
}
