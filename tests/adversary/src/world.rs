//! Device, ground and people, a cycle at a time. Given the station and the moves, everything else follows: nothing here is chance.

mod border;

use super::conditions::Measured;
use super::device::{Ask, Device, Read, Said, all};
use super::driver::{ahead, decide, hear};
use super::ground::{Ground, Mask, bit, members};
use super::judge::{Accident, Family, Truth, judge};
use super::moves::Move;
use super::neighbour::{Manner, Neighbour};
use super::point::Points;
use super::train::{Driver, Train};

/// What is fixed for an episode.
#[derive(Clone, Copy, Debug)]
pub struct Setting {
    /// How the neighbours are.
    pub manner: Manner,
    /// The points that take a command a cycle late.
    pub slow: u32,
    /// The stroke of the points, in per cent of the longest.
    pub throw_percent: i64,
    /// Trains take a telegram for the other direction of travel as one to stop.
    pub faces: bool,
}

/// The world.
pub struct World<'a> {
    /// The ground.
    pub ground: &'a Ground,
    /// The trains.
    pub trains: Vec<Train>,
    /// The points.
    pub points: Points,
    /// The neighbours.
    pub neighbours: Vec<Neighbour>,
    /// What else is true.
    pub truth: Truth,
    /// What the device said last.
    pub said: Said,
    /// What was measured.
    pub measured: Measured,
    /// The reports of the last cycle.
    pub reported: Mask,
    setting: Setting,
    occupy: Vec<(Mask, i64)>,
    lose: Vec<i64>,
    lost: Vec<i64>,
    next: usize,
    read: Read,
}

impl<'a> World<'a> {
    /// The world before the first cycle: no train, every point normal, nothing agreed. In its first cycle staff unblock everything.
    pub fn new(ground: &'a Ground, setting: Setting) -> Self {
        let seen = ground.seen;
        Self {
            ground,
            trains: Vec::new(),
            points: Points::at_rest(ground, setting.slow, setting.throw_percent),
            neighbours: vec![Neighbour::START; ground.lines.len()],
            truth: Truth {
                now: 0,
                restricted: vec![(i64::MAX, 0); seen],
                workers: 0,
                asked: vec![(false, i64::MIN / 2); ground.routes.len()],
            },
            said: Said::default(),
            measured: Measured::default(),
            reported: 0,
            setting,
            occupy: Vec::new(),
            lose: vec![0; seen],
            lost: vec![0; seen],
            next: 1,
            read: Read::default(),
        }
    }

    /// One cycle: the moves, then the ground, the reports, the device, the drivers. The first accident of the families `sought`.
    pub fn cycle(&mut self, device: &mut dyn Device, moves: &[Move], sought: &[Family]) -> Option<Accident> {
        self.read.ask = None;
        self.read.commands = super::device::Commands::default();
        if self.truth.now == 0 {
            (self.read.commands.unblock, self.read.commands.lift) = (all(self.ground), all(self.ground));
        }
        for it in moves {
            self.obey(device, *it);
        }
        self.points.pass();
        self.run_trains();
        self.report();
        self.said = device.cycle(&self.read);
        self.follow_up();
        self.points.drive(self.said.drives);
        self.pass_neighbours();
        for number in 0..self.trains.len() {
            let neighbour = self.neighbour_says(number);
            let faces = self.setting.faces;
            hear(&mut self.trains[number], self.ground, (device, faces), neighbour);
            self.measured.age = self.measured.age.max(self.trains[number].heard.age);
        }
        self.authorities();
        let accident = judge(self.ground, &self.trains, &self.points, &self.truth, sought);
        self.truth.now += 1;
        accident
    }

    /// Whether a route was requested and accepted in the last cycle.
    pub const fn has_set(&self) -> bool {
        self.said.done && matches!(self.read.ask, Some(Ask::Set(_)))
    }

    /// What the device read in the last cycle.
    pub const fn read(&self) -> &Read {
        &self.read
    }

    /// How many trains there have been.
    pub const fn arrived(&self) -> usize {
        self.next - 1
    }

    /// Whether a move is legal now; if it is, it is done.
    fn obey(&mut self, device: &mut dyn Device, it: Move) {
        let ground = self.ground;
        match it {
            Move::Ask(ask) => self.read.ask = Some(ask),
            Move::Command(mut commands) => {
                // Staff unblock nothing with a worker on it.
                commands.unblock &= !self.truth.workers;
                for circuit in members(commands.lift).filter(|circuit| *circuit < ground.seen) {
                    self.truth.restricted[circuit] = (i64::MAX, self.truth.now);
                }
                for circuit in members(commands.restrict.0) {
                    let speed = ground.codes[usize::from(commands.restrict.1)];
                    let (lower, since) = self.truth.restricted[circuit];
                    self.truth.restricted[circuit] =
                        if lower <= speed { (lower, since) } else { (speed, self.truth.now) };
                }
                self.read.commands = commands;
            }
            Move::Occupy(mask, cycles) => self.occupy.push((mask, cycles)),
            Move::Lose(circuit, cycles) => self.lose[circuit] = cycles.min(ground.loss),
            Move::Deaf(train, cycles) => {
                if let Some(train) = self.train(train) {
                    train.deaf = cycles;
                }
            }
            Move::Blind(point, cycles) => self.points.blind(point, cycles),
            Move::Face(train) => {
                if let Some(train) = self.train(train).filter(|train| train.speed == 0)
                    && train.tail_to_joint() >= 0
                {
                    train.face_about();
                    train.settle(ground);
                }
            }
            Move::Pace(train, speed) => {
                if let Some(train) = self.train(train) {
                    train.pace = speed;
                }
            }
            Move::Work(circuit, true) if self.said.confirmed & all(ground) & bit(circuit) != 0 => {
                self.truth.workers |= bit(circuit);
            }
            Move::Work(_, true) => {}
            Move::Work(circuit, false) => self.truth.workers &= !bit(circuit),
            Move::Consent(line, true) => {
                self.neighbours[line].consent(ground);
            }
            Move::Consent(line, false) => self.neighbours[line].consents = false,
            Move::Send(line, arrival) => self.send(line, arrival),
            Move::NeighbourWork(line, on) => {
                let place = bit(Neighbour::workplace(ground, line, self.setting.manner));
                if !on {
                    self.neighbours[line].works = false;
                    self.truth.workers &= !place;
                } else if self.neighbours[line].work(ground) {
                    self.truth.workers |= place;
                }
            }
            Move::Restart => {
                device.restart();
                self.said = Said::default();
                for (asked, when) in &mut self.truth.asked {
                    if *asked {
                        (*asked, *when) = (false, self.truth.now);
                    }
                }
                for restricted in &mut self.truth.restricted {
                    *restricted = (0, self.truth.now);
                }
            }
            Move::Place(circuit, arrival) => self.place(circuit, arrival),
        }
    }

    fn train(&mut self, number: usize) -> Option<&mut Train> {
        self.trains.iter_mut().find(|train| train.number == number)
    }

    fn run_trains(&mut self) {
        let ground = self.ground;
        for train in &mut self.trains {
            let before = train.speed;
            let next = train.next;
            let passed = train.advance(ground, &self.points, next);
            self.measured.speed = self.measured.speed.max(train.speed);
            if train.driver == Driver::Signals {
                for (joint, circuit) in passed {
                    let here = |number: &usize| {
                        let route = &ground.routes[*number];
                        route.start == joint && route.entry == circuit
                    };
                    let mut signals = (0..ground.routes.len()).filter(here).peekable();
                    let stop = signals.peek().is_some() && signals.all(|number| self.said.proceed >> number & 1 == 0);
                    train.slid |= stop;
                    // He could not stop: he braked as hard as he could.
                    let change = ground.brake * ground.cycle_ms / 1000;
                    self.measured.disobeyed += i64::from(stop && next > (before - change).max(0));
                }
            }
        }
        let lines = &ground.lines;
        self.trains.retain(|train| {
            let away = lines.iter().any(|line| train.under == bit(line.outside) && train.front().exit == line.far);
            !away
        });
    }

    fn report(&mut self) {
        let ground = self.ground;
        let truth = self.trains.iter().fold(0, |all, train| all | train.under);
        let mut reported = truth;
        for circuit in 0..ground.seen {
            let loses = self.lose[circuit] > 0;
            self.lose[circuit] = (self.lose[circuit] - 1).max(0);
            if loses && truth & bit(circuit) != 0 && self.lost[circuit] < ground.loss {
                reported &= !bit(circuit);
            }
        }
        for (mask, left) in &mut self.occupy {
            reported |= *mask;
            *left -= 1;
        }
        self.occupy.retain(|(_, left)| *left > 0);
        for circuit in 0..ground.seen {
            let unseen = truth & bit(circuit) != 0 && reported & bit(circuit) == 0;
            self.lost[circuit] = if unseen { self.lost[circuit] + 1 } else { 0 };
            self.measured.loss = self.measured.loss.max(self.lost[circuit]);
        }
        self.reported = reported;
        self.read.occupied = reported & all(ground);
        self.read.detected = self.points.detected();
        for point in 0..ground.points.len() {
            for (reverse, detected) in [(false, self.read.detected[0]), (true, self.read.detected[1])] {
                let wrong = detected >> point & 1 == 1 && !self.points.rests(point, reverse);
                self.measured.misdetected += i64::from(wrong);
            }
        }
        self.measured.departure = self.measured.departure.max(self.points.latest);
        self.read.consent = 0;
        for (number, neighbour) in self.neighbours.iter().enumerate() {
            if ground.lines[number].ways[1] && neighbour.heard(self.setting.manner) {
                self.read.consent |= 1 << number;
            }
        }
    }

    /// What was asked for and carried out.
    fn follow_up(&mut self) {
        match self.read.ask {
            Some(Ask::Set(route)) if self.said.done => self.truth.asked[route].0 = true,
            Some(Ask::Withdraw(route)) if self.said.done && self.truth.asked[route].0 => {
                self.truth.asked[route] = (false, self.truth.now);
            }
            _ => {}
        }
    }

    fn pass_neighbours(&mut self) {
        for (number, neighbour) in self.neighbours.iter_mut().enumerate() {
            let permits = self.said.permits >> number & 1 == 1;
            neighbour.pass(self.ground, number, self.setting.manner, permits, self.reported);
            self.measured.neighbour += i64::from(neighbour.sends && neighbour.consents);
        }
    }

    /// Every driver decides.
    fn authorities(&mut self) {
        let under: Vec<Mask> = self.trains.iter().map(|train| train.under).collect();
        for (number, train) in self.trains.iter_mut().enumerate() {
            let others =
                under.iter().enumerate().filter(|(other, _)| *other != number).fold(0, |all, (_, it)| all | it);
            train.next = decide(train, self.ground, &self.points, (self.said.proceed, others));
            // What it may yet run over: what it has authority for, and where it runs if it brakes now.
            let braking = train.speed * train.speed / (2 * self.ground.brake);
            let to_joint = train.to_joint();
            train.first_ahead = train.authority & ahead(train, self.ground, &self.points, to_joint);
            train.claim = train.authority;
            if braking > to_joint {
                train.claim |= ahead(train, self.ground, &self.points, braking);
            }
        }
    }
}
