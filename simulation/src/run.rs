//! A run of the whole line, a cycle at a time: the ground's devices every `cycle_ms`, the trains' every `train_cycle_ms`.

use crate::counting;
use crate::dispatcher::Seen;
use crate::event::What;
use crate::fault::{Fault, Kind};
use crate::ground::drive;
use crate::onboard::FRAME_MS;
use crate::sizes::{Circuits, Routes, Segments};
use crate::train::Train;
use crate::world::World;

impl World<'_> {
    /// Runs until `end_ms`, or until something unsafe happens.
    pub fn run(&mut self, end_ms: u64) {
        while self.now_ms < end_ms && !self.is_unsafe {
            self.tick();
        }
    }

    /// One cycle on board; and of the ground, where one begins.
    pub fn tick(&mut self) {
        self.begin_faults();
        if self.now_ms.is_multiple_of(u64::from(self.line.cycle_ms)) {
            self.cycle();
        }
        if self.now_ms.is_multiple_of(u64::from(2 * FRAME_MS)) {
            self.transmit();
        }
        for train in 0..self.trains.len() {
            self.roll(train);
        }
        self.judge();
        self.judge_speeds();
        self.now_ms += u64::from(self.line.train_cycle_ms);
    }

    /// Tells of faults that begin, and carries out those that are over at once.
    fn begin_faults(&mut self) {
        let until = self.now() + f64::from(self.line.train_cycle_ms);
        while let Some(fault) = self.setting.faults.get(self.begun).copied().filter(|fault| fault.from_ms < until) {
            self.begun += 1;
            let (trains, stations) = (self.trains.len(), self.stations.len());
            let train = |which: usize| format!("train {}", which % trains);
            let at = match fault.kind {
                Kind::Interruption | Kind::MisreadCode | Kind::ShuntLoss | Kind::MissedDetection | Kind::MissedHead => {
                    train(fault.which)
                }
                Kind::FalseOccupancy | Kind::RepeatedCode => {
                    self.line.track.circuits[fault.which % self.line.track.circuits.len()].name.clone()
                }
                Kind::PhantomHead => counting::section(self.line, fault.which),
                Kind::CheckInLost
                | Kind::CheckInStuckOn
                | Kind::CheckOutLost
                | Kind::SpuriousCheckOut
                | Kind::WrongReset => counting::block(self.line, fault.which),
                Kind::LatePoint => self.line.track.points[fault.which % self.line.track.points.len()].name.clone(),
                Kind::LostTelegram | Kind::DelayedTelegram => self.line.stations[fault.which % stations].name.clone(),
                Kind::RestartStation => {
                    self.stations[fault.which % stations].restart();
                    self.line.stations[fault.which % stations].name.clone()
                }
                Kind::RestartTrain => {
                    self.trains[fault.which % trains].restart();
                    train(fault.which)
                }
            };
            // Interruptions by the hundred would hide what they lead to.
            if fault.kind != Kind::Interruption || self.setting.faults.len() < 100 {
                self.tell(What::Fault { kind: fault.kind, at, lasts_ms: fault.lasts_ms });
            }
        }
    }

    /// What is reported occupied, on the whole line.
    fn report(&self) -> Vec<bool> {
        let own = |(circuit, trains): (usize, &u16)| *trains > 0 && !counting::is_counted(self.line, circuit);
        let mut reported: Vec<bool> = self.on_circuit.iter().enumerate().map(own).collect();
        let (track, length) = (&self.line.track, f64::from(self.line.cycle_ms));
        let mut hide = |fault: &Fault| {
            let train = &self.trains[fault.which % self.trains.len()];
            let circuit = |leg: &crate::motion::Leg| track.pieces[leg.piece].circuit;
            let (front, rear) = (circuit(&train.body.front()), circuit(&train.body.legs[0]));
            for leg in &train.body.legs {
                let here = circuit(leg);
                let lost = match (fault.kind, fault.much % 2) {
                    (Kind::MissedDetection, _) => here == front,
                    (_, 0) => true,
                    _ => here == rear,
                };
                let others = self.trains.iter().filter(|other| !std::ptr::eq(*other, train));
                if lost && !others.flat_map(|other| &other.body.legs).any(|leg| circuit(leg) == here) {
                    reported[here] = false;
                }
            }
        };
        for kind in [Kind::ShuntLoss, Kind::MissedDetection] {
            self.faults(kind, length).for_each(&mut hide);
        }
        for fault in self.faults(Kind::FalseOccupancy, length) {
            let circuit = fault.which % reported.len();
            reported[circuit] |= !counting::is_counted(self.line, circuit);
        }
        reported
    }

    /// One cycle of the ground.
    fn cycle(&mut self) {
        let line = self.line;
        let length = f64::from(line.cycle_ms);
        let mut reported = self.report();
        for (circuit, ms) in self.unheard_ms.iter_mut().enumerate() {
            let unheard = self.on_circuit[circuit] > 0 && !reported[circuit] && !counting::is_counted(line, circuit);
            *ms = if unheard { ms.saturating_add(line.cycle_ms) } else { 0 };
        }
        let track = &line.track;
        let seen: Vec<Seen> = self
            .trains
            .iter()
            .map(|train| Seen {
                front: track.pieces[train.body.front().piece].circuit,
                tail: track.pieces[train.body.legs[0].piece].circuit,
                stands: train.body.speed <= 0.0,
            })
            .collect();
        let mut told = Vec::new();
        let turned = self.dispatcher.look(self.now_ms, &seen, &self.proceed, &mut |what| told.push(what));
        for train in turned {
            self.trains[train].turn(track);
        }
        let requests = self.dispatcher.requests(self.now_ms);
        let late: Vec<(usize, u32)> =
            self.faults(Kind::LatePoint, length).map(|fault| (fault.which % track.points.len(), fault.much)).collect();
        let late = |point: usize| late.iter().filter(|(at, _)| *at == point).map(|(_, ms)| ms).sum();
        let stuck: Vec<usize> =
            self.faults(Kind::RepeatedCode, length).map(|fault| fault.which % track.circuits.len()).collect();
        let mut began = Vec::new();
        for (station, request) in requests.into_iter().enumerate() {
            let drives = self.stations[station].reply.drives;
            let cycle = (line.cycle_ms, &late as &dyn Fn(usize) -> u32);
            let detected = drive(track, station, &mut self.points, drives, cycle, &mut |point| began.push(point));
            let mut occupied = Circuits::EMPTY;
            let mut frozen = Circuits::EMPTY;
            for (number, circuit) in track.sites[station].circuits.iter().enumerate() {
                occupied = occupied.or(Circuits::nth(number).only_if(reported[*circuit]));
                frozen = frozen.or(Circuits::nth(number).only_if(stuck.contains(circuit)));
            }
            let times = (self.now_ms, u64::from(line.consent_life_ms()));
            let (agree, mut since) = (self.stations[station].reply.agree, self.stations[station].disagreeing);
            let blocks = counting::read(self, station, agree, &mut since);
            self.stations[station].disagreeing = since;
            self.stations[station].cycle(times, (occupied, detected, blocks), request, frozen);
            let answer = self.stations[station].reply.answer;
            if let Some(route) = self.dispatcher.answered(self.now_ms, station, answer) {
                let place = &line.stations[station];
                told.push(What::Set { station: place.name.clone(), route: place.sound.names.routes[route].clone() });
            }
            self.signals(station, &mut told);
        }
        for (station, site) in self.stations.iter().zip(&track.sites) {
            for (number, circuit) in site.circuits.iter().enumerate() {
                reported[*circuit] |= station.reply.counted.meets(Circuits::nth(number));
            }
        }
        self.reported = reported;
        self.exchange();
        for what in told {
            self.tell(what);
        }
        for point in began {
            self.moved(point);
        }
        for train in 0..self.trains.len() {
            self.listen(train);
        }
    }

    /// The transmitters take new frames, but for those that repeat what they sent.
    fn transmit(&mut self) {
        let circuits = self.line.track.circuits.len();
        let stuck: Vec<usize> =
            self.faults(Kind::RepeatedCode, f64::from(FRAME_MS)).map(|fault| fault.which % circuits).collect();
        for (station, site) in self.stations.iter_mut().zip(&self.line.track.sites) {
            let mut frozen = Circuits::EMPTY;
            for (number, circuit) in site.circuits.iter().enumerate() {
                frozen = frozen.or(Circuits::nth(number).only_if(stuck.contains(circuit)));
            }
            station.take(frozen);
        }
    }

    /// What changed at the signals of a station.
    fn signals(&mut self, station: usize, told: &mut Vec<What>) {
        let (before, now) = (self.proceed[station], self.stations[station].reply.proceed);
        if before == now {
            return;
        }
        let names = &self.line.stations[station].sound.names;
        for (number, route) in names.routes.iter().enumerate() {
            let it = Routes::nth(number);
            let at = || (self.line.stations[station].name.clone(), names.signals[number].clone(), route.clone());
            let (station, signal, route) = match (before.meets(it), now.meets(it)) {
                (true, true) | (false, false) => continue,
                _ => at(),
            };
            told.push(if now.meets(it) {
                What::Proceed { station, signal, route }
            } else {
                What::Stop { station, signal, route }
            });
        }
        self.proceed[station] = now;
    }

    /// The telegrams between the stations.
    fn exchange(&mut self) {
        let length = f64::from(self.line.cycle_ms);
        for joined in &self.line.links {
            for (from, to) in [(0, 1), (1, 0)] {
                let (sender, receiver) = (joined.west + from, joined.west + to);
                let stations = self.stations.len();
                let lost = self.faults(Kind::LostTelegram, length).any(|fault| fault.which % stations == receiver);
                let mut delays = self.faults(Kind::DelayedTelegram, length);
                let delay = delays.find(|fault| fault.which % stations == receiver).map(|fault| fault.much);
                drop(delays);
                let permits = self.stations[sender].reply.permits;
                let given = permits.meets(Segments::nth(joined.segments[from]));
                if !lost {
                    let now = self.now_ms;
                    let said = self.stations[sender].reply.messages.get(joined.segments[from]).copied().flatten();
                    let delay = u64::from(delay.unwrap_or(0));
                    self.stations[receiver].post(now, delay, joined.segments[to], (given, said));
                }
            }
        }
    }

    /// A point began to move: nothing may stand on it.
    fn moved(&mut self, point: usize) {
        let track = &self.line.track;
        let on = |train: &Train| train.body.legs.iter().any(|leg| track.pieces[leg.piece].point == Some(point));
        if let Some(train) = self.trains.iter().position(on) {
            self.tell(What::MovedUnder { train, point: track.points[point].name.clone() });
        }
    }
}
