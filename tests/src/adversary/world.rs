//! Device, ground and people, a cycle at a time. Given the station and the moves, everything else follows: nothing here is chance.

use super::conditions::Measured;
use super::device::{Ask, Device, Read, Said, all};
use super::driver::{ahead, decide, hear};
use super::ground::{Ground, Mask, NEIGHBOUR_SIGNAL_MM, OUTSIDE_MM, bit, members};
use super::judge::{Accident, Family, Truth, judge};
use super::moves::{Arrival, Move};
use super::neighbour::{Manner, Neighbour};
use super::point::Points;
use super::train::{Driver, Heard, Train, leg};

/// What is fixed for an episode.
#[derive(Clone, Copy, Debug)]
pub struct Setting {
    /// How the neighbours are.
    pub manner: Manner,
    /// The points that take a command a cycle late.
    pub slow: u32,
    /// The stroke of the points, in per cent of the longest.
    pub throw_percent: i64,
    /// A train hears no telegram that is for the other way.
    pub directed: bool,
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
            let directed = self.setting.directed;
            hear(&mut self.trains[number], (self.ground, &self.points), (device, directed), neighbour);
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
                    self.truth.restricted[circuit] = (speed, self.truth.now);
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
                if let Some(train) = self.train(train).filter(|train| train.speed == 0) {
                    if train.tail_to_joint() >= 0 {
                        train.face_about();
                        train.settle(ground);
                    }
                }
            }
            Move::Pace(train, speed) => {
                if let Some(train) = self.train(train) {
                    train.pace = speed;
                }
            }
            Move::Work(circuit, true) if self.said.confirmed & all(ground) & bit(circuit) != 0 => {
                self.truth.workers |= bit(circuit)
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

    fn send(&mut self, line: usize, arrival: Arrival) {
        let it = &self.ground.lines[line];
        let (piece, far) = (it.piece, it.far);
        if it.ways[0] && self.neighbours[line].take(self.ground) {
            let at = OUTSIDE_MM - NEIGHBOUR_SIGNAL_MM;
            // It passes the signal at a speed at which it can keep to a restriction behind the border.
            let slow = self.truth.restricted[it.outermost].0.min(self.ground.fastest);
            let most = (slow * slow + 2 * self.ground.brake * (NEIGHBOUR_SIGNAL_MM - 10_000)).isqrt();
            let speed = arrival.speed.min(most).min(self.ground.fastest);
            self.appear(piece, far, at, Arrival { length: arrival.length.min(at), speed, ..arrival });
        }
    }

    fn place(&mut self, circuit: usize, arrival: Arrival) {
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
            self.appear(piece, enter, at, Arrival { length: arrival.length.min(at - 1000), speed: 0, ..arrival });
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

    /// What the neighbour's device tells a train on its side, or on the last circuit out.
    fn neighbour_says(&self, number: usize) -> Option<Heard> {
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
        let speed = (slow * slow + 2 * ground.brake * (train.to_joint() - 5_000).max(0)).isqrt().min(ground.fastest);
        let heard = Heard { limit, speed, hold: bit(line.outermost), age: 0, neighbour: true };
        Some(if open { heard } else { Heard { neighbour: true, ..Heard::STOP } })
    }

    /// Every driver decides.
    fn authorities(&mut self) {
        for train in &mut self.trains {
            train.next = decide(train, self.ground, &self.points, self.said.proceed);
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
