//! Where the world of the station meets its neighbours: trains appear, and are told on the far side of the border how far they may run.

use super::super::device::all;
use super::super::ground::{Ground, NEIGHBOUR_SIGNAL_MM, OUTSIDE_MM, bit, members};
use super::super::moves::Arrival;
use super::super::train::{Heard, Train, leg};
use super::World;

/// How far before the border a train has the speed of a restriction behind it: it may hear nothing for the life of a telegram.
fn margin(ground: &Ground) -> i64 {
    5_000 + ground.fastest * ground.life * ground.cycle_ms / 1000
}

/// The highest speed at which the neighbour lets a train over the border: from it the train stops, once its telegram is as old as it may
/// be, within the outermost circuit, which is all that the neighbour has found clear (`neighbour-turns-alike`).
fn over_border(ground: &Ground, outermost: usize) -> i64 {
    let aged = ground.brake * ground.life * ground.cycle_ms / 1000;
    (aged * aged + 2 * ground.brake * ground.lengths[outermost]).isqrt() - aged
}

impl World<'_> {
    pub(super) fn send(&mut self, line: usize, arrival: Arrival) {
        let it = &self.ground.lines[line];
        let (piece, far) = (it.piece, it.far);
        if it.ways[0] && self.neighbours[line].take(self.ground, self.setting.manner) {
            let at = OUTSIDE_MM - NEIGHBOUR_SIGNAL_MM;
            // It passes the signal at a speed at which it can keep to a restriction behind the border.
            let slow = self.truth.restricted[it.outermost].0.min(self.ground.fastest);
            let slow = slow.min(over_border(self.ground, it.outermost));
            let room = (NEIGHBOUR_SIGNAL_MM - margin(self.ground) - 5_000).max(0);
            let most = (slow * slow + 2 * self.ground.brake * room).isqrt();
            let speed = arrival.speed.min(most).min(self.ground.fastest);
            self.appear(piece, far, at, Arrival { length: arrival.length.min(at), speed, ..arrival });
        }
    }

    pub(super) fn place(&mut self, circuit: usize, arrival: Arrival) {
        let ground = self.ground;
        let plain = |piece: &usize| ground.pieces[*piece].circuit == circuit && ground.pieces[*piece].point.is_none();
        let Some(piece) = (0..ground.pieces.len()).find(plain) else { return };
        let line = ground.lines.iter().position(|line| line.mask & bit(circuit) != 0);
        let whole = line.map_or(bit(circuit), |line| ground.lines[line].mask);
        let taken = self.trains.iter().any(|train| train.under & whole != 0);
        if self.truth.now == 0 && !taken {
            let length = ground.pieces[piece].length;
            let enter = ground.pieces[piece].joints[usize::from(arrival.about)];
            let at = length - arrival.gap.clamp(300, length / 4);
            if let Some(line) = line {
                // Either the neighbour has sent it, or the station with the neighbour's consent.
                let inward = !self.outward(line, leg(ground, &self.points, piece, enter, None).exit, piece);
                (self.neighbours[line].sends, self.neighbours[line].consents) = (inward, !inward);
            }
            let exit = leg(ground, &self.points, piece, enter, None).exit;
            let signal = ground.routes.iter().any(|route| route.start == exit && route.entry == circuit);
            self.appear(piece, enter, at, Arrival { length: arrival.length.min(at - 1000), speed: 0, ..arrival });
            // Where no signal stands ahead of it, it came the other way and its driver has changed ends.
            if let Some(train) = self.trains.last_mut() {
                train.about = line.is_none() && !signal;
            }
        }
    }

    /// Whether a train that leaves `piece` by `joint` runs towards the border of the line.
    fn outward(&self, line: usize, joint: usize, piece: usize) -> bool {
        let (ground, mut joint, mut piece) = (self.ground, joint, piece);
        while let Some(next) = ground.across(joint, piece) {
            let circuit = ground.pieces[next].circuit;
            if circuit == ground.lines[line].outside {
                return true;
            }
            if ground.lines[line].mask & bit(circuit) == 0 {
                return false;
            }
            (joint, piece) = (ground.leave(next, joint, false).0, next);
        }
        false
    }

    fn appear(&mut self, piece: usize, enter: usize, at: i64, arrival: Arrival) {
        let first = leg(self.ground, &self.points, piece, enter, None);
        let number = self.next;
        self.next += 1;
        let mut train = Train {
            number,
            length: arrival.length,
            driver: arrival.driver,
            speed: arrival.speed,
            next: arrival.speed,
            run: 0,
            at,
            legs: vec![first],
            pace: i64::MAX,
            gap: arrival.gap,
            deaf: 0,
            heard: Heard::STOP,
            route: None,
            about: false,
            slid: false,
            target: 0,
            authority: 0,
            first_ahead: 0,
            claim: 0,
            under: 0,
        };
        train.settle(self.ground);
        train.heard = if piece >= self.ground.pieces.len() - self.ground.lines.len() {
            Heard { limit: at, speed: arrival.speed, hold: 0, age: 0, neighbour: true }
        } else {
            Heard::STOP
        };
        self.trains.push(train);
    }

    /// What the neighbour's device tells a train on its side, or on the last circuit out.
    pub(super) fn neighbour_says(&self, number: usize) -> Option<Heard> {
        let (train, ground) = (&self.trains[number], self.ground);
        let here = train.front_circuit(ground);
        let at = ground.lines.iter().position(|line| line.outside == here || line.outermost == here)?;
        let (line, neighbour) = (&ground.lines[at], &self.neighbours[at]);
        let outward = train.front().exit == line.far || train.front().exit == line.border && here == line.outermost;
        if outward {
            // It takes the train in if its stretch is clear, and it sends nobody.
            let others =
                self.trains.iter().any(|other| other.number != train.number && other.under & bit(line.outside) != 0);
            let blocked = neighbour.works || neighbour.sends || others || !neighbour.consents;
            let inside = here == line.outside;
            let to_end = train.to_joint() + if inside { 0 } else { OUTSIDE_MM };
            let limit = if inside || !blocked { train.run + to_end - 1000 } else { return None };
            let limits = train.legs.iter().map(|leg| leg.limit).min().unwrap_or(i64::MAX);
            let restricted = members(train.under & all(ground)).map(|circuit| self.truth.restricted[circuit].0).min();
            let speed = limits.min(restricted.unwrap_or(i64::MAX)).min(ground.fastest);
            return Some(Heard { limit, speed, hold: bit(line.outside), age: 0, neighbour: true });
        }
        if here != line.outside {
            return None;
        }
        // Towards the station: as long as the permission lives, into the outermost circuit while it is clear.
        let clear = neighbour.outermost_clear > ground.clear;
        let open = neighbour.is_permitted(ground) && neighbour.sends && clear;
        let limit = train.run + train.to_joint() + ground.lengths[line.outermost];
        // The neighbour knows the restriction behind its border (`limits-reach-over-the-border`).
        let slow = self.truth.restricted[line.outermost].0.min(ground.fastest);
        let speed =
            (slow * slow + 2 * ground.brake * (train.to_joint() - margin(ground)).max(0)).isqrt().min(ground.fastest);
        let heard = Heard { limit, speed, hold: bit(line.outermost), age: 0, neighbour: true };
        Some(if open { heard } else { Heard { neighbour: true, ..Heard::STOP } })
    }
}
