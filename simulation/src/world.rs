//! Everything together, a cycle at a time: the ground's devices every `cycle_ms`, the trains' every `train_cycle_ms`.

use atc_kernel::interlocking::{CircuitSet, Positions, RouteSet, SegmentSet};
use rand::{Rng, SeedableRng};
use rand_pcg::Pcg64Mcg;

use crate::counting;
use crate::defect::Defect;
use crate::dispatcher::{Dispatcher, Seen};
use crate::driver::Drivers;
use crate::event::{Event, What};
use crate::fault::{Fault, Kind, consent_life_ms};
use crate::ground::{PointState, Station, drive};
use crate::line::{Bound, Line};
use crate::motion::Body;
use crate::onboard::{Device, FRAME_MS, Operate, Signal};
use crate::rolling::Train;

/// What a run is made of, besides the line.
#[derive(Clone, Debug)]
pub struct Setting {
    /// Which device the trains have.
    pub operate: Operate,
    /// How many trains there are.
    pub trains: usize,
    /// What the strokes of the points and the first departures depend on.
    pub seed: u64,
    /// The faults.
    pub faults: Vec<Fault>,
    /// Whether each train has a second device beside it that no interruption reaches, to tell a needless brake.
    pub compared: bool,
    /// What trains run on.
    pub signal: Signal,
    /// What drivers do with the cab signal.
    pub drivers: Drivers,
    /// What is wrong all the time.
    pub defects: Vec<Defect>,
}

impl Default for Setting {
    fn default() -> Self {
        Self {
            operate: Operate::Shortened,
            trains: 1,
            seed: 1,
            faults: Vec::new(),
            compared: false,
            signal: Signal::Codes,
            drivers: Drivers::Careful,
            defects: Vec::new(),
        }
    }
}

/// A line at work.
#[derive(Clone)]
pub struct World<'a> {
    /// The line.
    pub line: &'a Line,
    /// The time since the start.
    pub now_ms: u64,
    /// The trains.
    pub trains: Vec<Train>,
    /// What happened.
    pub events: Vec<Event>,
    /// Whether something unsafe has happened: the run is over.
    pub is_unsafe: bool,
    /// The stations at work.
    pub stations: Vec<Station>,
    /// The points as they lie.
    pub points: Vec<PointState>,
    /// How many pieces of each circuit are under trains.
    pub on_circuit: Vec<u16>,
    /// How many trains are on each piece.
    pub on_piece: Vec<u16>,
    /// The number that each station gives a circuit.
    pub local: Vec<Vec<Option<u8>>>,
    /// The dispatcher.
    pub dispatcher: Dispatcher<'a>,
    pub(crate) device: Device,
    /// The other kind of device.
    pub(crate) rival: Device,
    /// What was reported occupied in the last cycle of the ground.
    pub reported: Vec<bool>,
    /// For how long each circuit with a train has not been reported, in ms.
    pub unheard_ms: Vec<u32>,
    pub(crate) setting: Setting,
    proceed: Vec<RouteSet>,
    /// The kinds of its faults.
    pub(crate) kinds: Vec<Kind>,
    /// The longest of its faults, in ms.
    pub(crate) longest_ms: f64,
    begun: usize,
}

impl<'a> World<'a> {
    /// A line with its trains at a stand at the tracks of its stations, and every device just started.
    ///
    /// # Errors
    /// More trains than there is room for, or what the kernel says of a parameter.
    pub fn new(line: &'a Line, mut setting: Setting) -> Result<Self, String> {
        if setting.trains == 0 || setting.trains >= line.room() {
            let room = line.room() - 1;
            return Err(format!("{} trains: 1 to {room} are possible, as one track must stay free", setting.trains));
        }
        setting.faults.sort_by(|one, other| one.from_ms.total_cmp(&other.from_ms));
        let mut random = Pcg64Mcg::seed_from_u64(setting.seed);
        let kind = setting.signal.line();
        let of = |operate| Device::new(&line.speeds_kmh, line.train_cycle_ms, (operate, kind), &setting.defects);
        let device = of(setting.operate)?;
        let rival = match setting.operate {
            Operate::Shortened => Operate::Conventional,
            Operate::Conventional => Operate::Shortened,
        };
        let rival = of(rival)?;
        let points = line.track.points.iter().map(|point| {
            let least = (point.throw_ms * 5 / 7).max(1);
            PointState { reverse: false, moves_ms: None, stroke_ms: random.random_range(least..=point.throw_ms) }
        });
        let points = points.collect();
        let mut stations = Vec::new();
        for (number, place) in line.stations.iter().enumerate() {
            stations.push(Station::new(
                line.device(number, setting.signal != Signal::Codes, &setting.defects)?,
                place.compiled.model.segments.len(),
            ));
        }
        let local = line.track.sites.iter().map(|site| {
            let mut local = vec![None; line.track.circuits.len()];
            for (number, circuit) in site.circuits.iter().enumerate() {
                local[*circuit] = u8::try_from(number).ok();
            }
            local
        });
        let places = places(line, setting.trains);
        let mut world = Self {
            line,
            now_ms: 0,
            trains: Vec::new(),
            events: Vec::new(),
            is_unsafe: false,
            local: local.collect(),
            on_circuit: vec![0; line.track.circuits.len()],
            on_piece: vec![0; line.track.pieces.len()],
            dispatcher: Dispatcher::new(line, &places),
            proceed: vec![RouteSet::EMPTY; stations.len()],
            stations,
            points,
            device,
            rival,
            reported: vec![false; line.track.circuits.len()],
            unheard_ms: vec![0; line.track.circuits.len()],
            kinds: Kind::of(line).into_iter().filter(|kind| setting.faults.iter().any(|it| it.kind == *kind)).collect(),
            longest_ms: setting.faults.iter().map(|it| it.lasts_ms).fold(0.0, f64::max),
            setting,
            begun: 0,
        };
        for ((station, track), bound) in places {
            let platform = &line.stations[station].platforms[track];
            let last = platform.legs[platform.legs.len() - 1];
            let all: f64 = platform.legs.iter().map(|leg| line.track.pieces[leg.piece].length_m).sum();
            let spare = ((all - line.dynamics.length_m) / 2.0).max(1.0);
            let front_m = line.track.pieces[last.piece].length_m - spare;
            let mut body = Body::standing(&line.track, &platform.legs, front_m, line.dynamics.length_m);
            if bound == Bound::West {
                body.turn(&line.track);
            }
            for leg in &body.legs {
                world.on_piece[leg.piece] += 1;
                world.on_circuit[line.track.pieces[leg.piece].circuit] += 1;
            }
            world.trains.push(Train::new(body, line.track.circuits.len()));
        }
        Ok(world)
    }

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

    pub(crate) fn tell(&mut self, what: What) {
        self.is_unsafe |= what.is_unsafe();
        self.events.push(Event { at_ms: self.now_ms, what });
    }

    /// A fault that nobody planned: it begins now, or later than all the others.
    pub fn fail(&mut self, fault: Fault) {
        let now = self.now();
        self.setting.faults.retain(|old| old.from_ms + old.lasts_ms >= now);
        self.begun = self.setting.faults.len();
        self.setting.faults.push(fault);
        self.longest_ms = self.longest_ms.max(fault.lasts_ms);
        if !self.kinds.contains(&fault.kind) {
            self.kinds.push(fault.kind);
        }
    }

    /// How near the run is to harm by trains that are not reported, for [`crate::rare`]: up to 0.6 the longest share of the time after
    /// which the circuit of such a train counts as clear; 0.8 if another train is told to go there; 1 for harm.
    pub fn nearness(&self) -> f64 {
        if self.is_unsafe {
            return 1.0;
        }
        let clear_ms = self.line.clear_ms;
        let longest = self.unheard_ms.iter().copied().max().unwrap_or(0).min(clear_ms);
        let circuit = |leg: &crate::motion::Leg| self.line.track.pieces[leg.piece].circuit;
        let forgotten = |circuit: usize| self.unheard_ms[circuit] >= clear_ms;
        let meets = |train: &Train| {
            let told = train.told_ms.iter().enumerate().filter(|(_, told)| **told > 0 && **told + 200 > self.now_ms);
            let on = |place: usize| train.body.legs.iter().any(|leg| circuit(leg) == place);
            told.map(|(place, _)| place).any(|place| forgotten(place) && !on(place))
        };
        if longest == clear_ms && self.trains.iter().any(meets) {
            return 0.8;
        }
        0.6 * f64::from(longest) / f64::from(clear_ms.max(1))
    }

    /// The faults of a kind that are there now, for `length_ms`.
    pub(crate) fn faults(&self, kind: Kind, length_ms: f64) -> impl Iterator<Item = &Fault> {
        let now = self.now();
        // Most runs have faults of one kind or two, and are asked for each in every cycle.
        let all = if self.kinds.contains(&kind) { self.setting.faults.as_slice() } else { &[] };
        all.iter().filter(move |fault| fault.kind == kind && fault.meets(now, length_ms))
    }

    #[allow(clippy::cast_precision_loss, reason = "a run is shorter than 2^53 ms")]
    pub(crate) const fn now(&self) -> f64 {
        self.now_ms as f64
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
            let detected: Positions =
                drive(track, station, &mut self.points, drives, cycle, &mut |point| began.push(point));
            let mut occupied = CircuitSet::EMPTY;
            let mut frozen = CircuitSet::EMPTY;
            for (number, circuit) in track.sites[station].circuits.iter().enumerate() {
                occupied = occupied.or(CircuitSet::nth(number).only_if(reported[*circuit]));
                frozen = frozen.or(CircuitSet::nth(number).only_if(stuck.contains(circuit)));
            }
            let times = (self.now_ms, u64::from(consent_life_ms(line)));
            let (agree, mut since) = (self.stations[station].reply.agree, self.stations[station].disagreeing);
            let blocks = counting::read(self, station, agree, &mut since);
            self.stations[station].disagreeing = since;
            self.stations[station].cycle(times, (occupied, detected, blocks), request, frozen);
            let answer = self.stations[station].reply.answer;
            if let Some(route) = self.dispatcher.answered(self.now_ms, station, answer) {
                let place = &line.stations[station];
                told.push(What::Set { station: place.name.clone(), route: place.compiled.names.routes[route].clone() });
            }
            self.signals(station, &mut told);
        }
        for (station, site) in self.stations.iter().zip(&track.sites) {
            for (number, circuit) in site.circuits.iter().enumerate() {
                reported[*circuit] |= station.reply.counted.meets(CircuitSet::nth(number));
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
            let mut frozen = CircuitSet::EMPTY;
            for (number, circuit) in site.circuits.iter().enumerate() {
                frozen = frozen.or(CircuitSet::nth(number).only_if(stuck.contains(circuit)));
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
        let names = &self.line.stations[station].compiled.names;
        for (number, route) in names.routes.iter().enumerate() {
            let it = RouteSet::nth(number);
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
                let given = permits.meets(SegmentSet::nth(joined.segments[from]));
                if !lost {
                    let now = self.now_ms;
                    let said = self.stations[sender].reply.messages[joined.segments[from]];
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

/// Where the trains stand first: spread over the stations, each on a track of its direction.
fn places(line: &Line, trains: usize) -> Vec<((usize, usize), Bound)> {
    let mut places = Vec::new();
    let most = line.stations.iter().map(|station| station.platforms.len()).max().unwrap_or(0);
    for track in 0..most {
        for (number, station) in line.stations.iter().enumerate() {
            if track >= station.platforms.len() || places.len() >= trains {
                continue;
            }
            let bound = if number == 0 {
                Bound::East
            } else if number + 1 == line.stations.len() || track % 2 == 0 {
                Bound::West
            } else {
                Bound::East
            };
            places.push(((number, track), bound));
        }
    }
    places
}
