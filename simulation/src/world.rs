//! A line at work: its stations, points and trains, what happened, and what has failed.

use rand::{Rng, SeedableRng};
use rand_pcg::Pcg64Mcg;

use crate::bound::Bound;
use crate::defect::Defect;
use crate::dispatcher::Dispatcher;
use crate::driver::Drivers;
use crate::event::{Event, What};
use crate::fault::{Fault, Kind};
use crate::ground::{PointState, Station};
use crate::line::Line;
use crate::motion::Body;
use crate::onboard::{Device, Operate, Signal};
use crate::sizes::Routes;
use crate::train::Train;

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
    pub(crate) proceed: Vec<Routes>,
    /// The kinds of its faults.
    pub(crate) kinds: Vec<Kind>,
    /// The longest of its faults, in ms.
    pub(crate) longest_ms: f64,
    pub(crate) begun: usize,
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
            let least = (point.throw_ms / 7 * 5).max(1).min(point.throw_ms);
            PointState { reverse: false, moves_ms: None, stroke_ms: random.random_range(least..=point.throw_ms) }
        });
        let points = points.collect();
        let mut stations = Vec::new();
        for (number, place) in line.stations.iter().enumerate() {
            stations.push(Station::new(
                line.device(number, setting.signal != Signal::Codes, &setting.defects)?,
                place.sound.names.circuits.len(),
                place.sound.model.segments.len(),
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
            proceed: vec![Routes::EMPTY; stations.len()],
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
