//! Sessions that look like running: trains that move, points that arrive, staff that ask; and what goes wrong with each.

use atc_kernel::interlocking::{Position, Travel};

use crate::stations::{Dice, Station};
use crate::witness::{Ask, Commands, Read, Said, Set, Stage, Witness};

/// The number of a point that no station here has room for.
const NO_POINT: usize = 24;

/// A train: the circuits that it is on, its front last.
struct Train {
    on: Vec<usize>,
    rightward: bool,
}

/// The world around the device.
pub struct World {
    trains: Vec<Train>,
    /// The position that each point is in, none while it moves; and for how long its detection is lost.
    points: Vec<(Option<Position>, usize)>,
    moving: Vec<Option<(Position, usize)>>,
    begun: bool,
}

impl World {
    pub fn new(station: &Station, dice: &mut Dice) -> Self {
        let points = station.forks.iter().map(|_| (Some(dice.side()), 0)).collect();
        Self { trains: Vec::new(), points, moving: vec![None; station.forks.len()], begun: false }
    }

    /// What the device reads in the next cycle, after it said `said`.
    pub fn read(&mut self, station: &Station, device: &Witness, said: Option<&Said>, dice: &mut Dice) -> Read {
        self.move_points(said, dice);
        self.move_trains(station, said, dice);
        let mut occupied: Set = self.trains.iter().flat_map(|train| train.on.iter().copied()).collect();
        if dice.one_in(40) {
            let circuit = dice.below(station.left.len());
            if !occupied.remove(&circuit) {
                occupied.insert(circuit);
            }
        }
        let mut detected = Vec::new();
        for (number, (position, lost)) in self.points.iter_mut().enumerate() {
            *lost = if dice.one_in(150) { 1 + dice.below(4) } else { lost.saturating_sub(1) };
            if *lost == 0 {
                detected.extend(position.map(|position| (number, position)));
            }
            if dice.one_in(300) {
                detected.extend([(number, Position::Normal), (number, Position::Reverse)]);
                detected.sort_unstable_by_key(|need| (need.0, need.1 == Position::Reverse));
                detected.dedup();
            }
        }
        let consent = (0..2).filter(|_| !dice.one_in(8)).collect();
        Read {
            occupied,
            detected,
            ask: self.ask(station, device, dice),
            commands: self.commands(station, dice),
            consent,
        }
    }

    fn move_points(&mut self, said: Option<&Said>, dice: &mut Dice) {
        for (point, normal) in said.iter().flat_map(|said| &said.drives) {
            let position = if *normal { Position::Normal } else { Position::Reverse };
            if self.moving[*point].is_none_or(|moving| moving.0 != position) && !dice.one_in(30) {
                self.moving[*point] = Some((position, dice.below(5)));
            }
        }
        for (point, moving) in self.points.iter_mut().zip(&mut self.moving) {
            match moving {
                Some((position, 0)) => (point.0, *moving) = (Some(*position), None),
                Some((_, time)) => (point.0, *time) = (None, *time - 1),
                None => {}
            }
        }
    }

    fn move_trains(&mut self, station: &Station, said: Option<&Said>, dice: &mut Dice) {
        if self.trains.len() < 3 && dice.one_in(25) {
            let side = dice.below(2);
            let train = Train { on: vec![station.ends[side]], rightward: side == 0 };
            if dice.one_in(10) {
                let anywhere = dice.below(station.left.len());
                self.trains.push(Train { on: vec![anywhere], ..train });
            } else if !self.trains.iter().any(|other| other.on.contains(&train.on[0])) {
                self.trains.push(train);
            }
        }
        for train in &mut self.trains {
            if train.on.len() > 1 && dice.one_in(3) {
                train.on.remove(0);
                continue;
            }
            let Some(front) = train.on.last().copied() else { continue };
            if station.ahead(front, train.rightward).is_empty() {
                // Out of sight.
                train.on.remove(0);
                continue;
            }
            let open = said.is_some_and(|said| said.telegrams[front].leftward == Some(!train.rightward));
            if train.on.len() < 3 && (open && dice.one_in(2) || dice.one_in(120)) {
                let fork =
                    station.forks.iter().position(|fork| fork.circuit == front && fork.rightward == train.rightward);
                let ahead = station.ahead(front, train.rightward);
                let way = match fork.and_then(|fork| self.points[fork].0) {
                    Some(Position::Normal) => ahead[0],
                    _ => *dice.pick(ahead),
                };
                train.on.push(way);
            } else if dice.one_in(200) {
                train.rightward ^= true;
                train.on.reverse();
            }
        }
        self.trains.retain(|train| !train.on.is_empty());
    }

    fn ask(&self, station: &Station, device: &Witness, dice: &mut Dice) -> Option<Ask> {
        let routes = &station.sketch.routes;
        let held: Vec<usize> = (0..routes.len()).filter(|route| device.routes[*route].is_held()).collect();
        Some(match dice.below(16) {
            0..5 => {
                let wanted = |route: &usize| {
                    let fits = |train: &Train| train.on.last() == Some(&routes[*route].entry);
                    !device.routes[*route].is_held() && self.trains.iter().any(fits)
                };
                let wanted: Vec<usize> = (0..routes.len()).filter(wanted).collect();
                Ask::Set(*wanted.get(dice.below(wanted.len().max(1)))?)
            }
            5 => Ask::Set(dice.below(routes.len() + 1)),
            6 if dice.one_in(4) => Ask::Withdraw(dice.below(routes.len())),
            6 | 7 if !held.is_empty() => {
                let early = held.iter().find(|route| matches!(device.routes[**route].stage, Stage::Provisional(_)));
                let route = *early.filter(|_| dice.one_in(2)).unwrap_or(dice.pick(&held));
                if matches!(device.routes[route].stage, Stage::Set | Stage::InUse(_) | Stage::Releasing(_))
                    && !dice.one_in(6)
                {
                    return None;
                }
                Ask::Withdraw(route)
            }
            8 => {
                let there = station.forks.len();
                Ask::Drive(if there == 0 || dice.one_in(20) { NO_POINT } else { dice.below(there) }, dice.side())
            }
            9 | 10 => {
                let travel = if dice.one_in(2) { Travel::Toward } else { Travel::Away };
                let segments = if dice.one_in(20) { 3 } else { 2 };
                Ask::Turn(dice.below(segments), travel)
            }
            _ => return None,
        })
    }

    fn commands(&mut self, station: &Station, dice: &mut Dice) -> Commands {
        let count = station.left.len();
        let some = |dice: &mut Dice, many: usize| -> Set {
            if dice.one_in(many) { (0..=dice.below(2)).map(|_| dice.below(count)).collect() } else { Set::new() }
        };
        let mut commands = Commands {
            block: some(dice, 100),
            unblock: some(dice, 25),
            restrict: some(dice, 80),
            lift: some(dice, 40),
            speed: u8::try_from(dice.below(9)).unwrap_or(0),
        };
        if !self.begun && !dice.one_in(4) {
            self.begun = true;
            commands.unblock = (0..count).collect();
            commands.lift = (0..count).collect();
        }
        commands
    }
}
