//! Trains on metres, points, track circuits, drivers, staff, and messages between stations: what `line_hunt` and `counted_hunt` share. Nothing that
//! decides here is taken from the kernel: what a train makes of a telegram is decoded from the frame that was sent.
//!
//! A cycle has a second. Lengths are millimetres along one line, from left to right; between two points, or beyond one, there are two tracks.

#[path = "board.rs"]
pub mod board;

use atc_kernel::Machine as _;
use atc_kernel::aspect::AspectTable;
use atc_kernel::code::{CodeFrequencies, CodeTable, Millihertz};
use atc_kernel::distance::Metres;
use atc_kernel::interlocking::{
    CircuitSet, Element, Heading, Layout, MAX_CIRCUITS, Orders, Plan, Point as PointPlan, PointId, Position, Positions,
    Request, Route as RoutePlan, RouteId, SpeedCode,
};
use atc_kernel::speed::KmhTenths;
use atc_kernel::telegram::{Gradient, Main, Route, SectionId, Telegram, decode};
use atc_kernel::time::Ticks;
use atc_kernel::wayside::{
    Equipment, Facing, Fixed, Framed, Input, Message, Output, Session, SignalPlan, State, Wayside,
};

/// A metre, in mm.
pub const M: i64 = 1_000;
pub const BLOCKS: usize = 2;
const ROUTES: usize = 4;
const PATH: usize = 8;
const POINTS: usize = 2;
pub const SEGMENTS: usize = 2;
pub type Station = Layout<ROUTES, PATH, POINTS, SEGMENTS>;
pub type Draft = Plan<ROUTES, PATH, POINTS, SEGMENTS>;
type Ground = Wayside<'static, BLOCKS, ROUTES, PATH, POINTS, SEGMENTS>;

/// What a train runs in a cycle by each code, in mm.
pub const SPEEDS: [i64; 4] = [0, 5_000, 10_000, 20_000];
/// Every train brakes by at least so much in a cycle.
const BRAKE: i64 = 1_000;
/// For so many cycles a train acts on a telegram.
const AGE: i64 = 2;
pub const LOSS: u8 = 2;
pub const CLEAR: u8 = 4;
pub const LIFE: u16 = 16;
/// The age of a telegram, and to a stand from the highest speed.
const RESIDUAL: u16 = 22;
pub const TURN: u16 = LIFE + RESIDUAL + LOSS as u16;
const SIGHT: i64 = 250_000;

/// Numbers that look random, always the same ones.
#[derive(Clone)]
pub struct Dice(u64);

impl Dice {
    pub fn new(seed: u64) -> Self {
        let mut dice = Self(seed.wrapping_mul(0x9E37_79B9_7F4A_7C15) | 1);
        for _ in 0..8 {
            dice.below(2);
        }
        dice
    }

    pub fn below(&mut self, end: usize) -> usize {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        usize::try_from((self.0 >> 11) % u64::try_from(end.max(1)).unwrap()).unwrap()
    }

    pub fn one_in(&mut self, number: usize) -> bool {
        self.below(number) == 0
    }

    pub fn between(&mut self, low: i64, high: i64) -> i64 {
        low + i64::try_from(self.below(usize::try_from(high - low + 1).unwrap())).unwrap()
    }

    pub fn of<T: Copy>(&mut self, choice: &[T]) -> T {
        choice[self.below(choice.len())]
    }
}

/// Where there are two tracks: from a point to a point, or to the end.
#[derive(Clone, Copy)]
pub struct Zone {
    pub low: i64,
    pub high: i64,
    /// The points at its low and at its high end.
    pub points: [Option<usize>; 2],
    /// So far from a point the two tracks foul each other.
    pub fouling: i64,
}

/// A circuit from here to there, in metres, and its track where there are two.
pub type Piece = (i64, i64, Option<(usize, usize)>);

/// The same in millimetres.
pub fn pieces(pieces: &[Piece]) -> Vec<Circuit> {
    pieces.iter().map(|(low, high, track)| Circuit { low: low * M, high: high * M, track: *track }).collect()
}

#[derive(Clone, Copy)]
pub struct Circuit {
    pub low: i64,
    pub high: i64,
    /// The zone and the track.
    pub track: Option<(usize, usize)>,
}

/// A signal, and where its routes end: `(route, end, leads to the line)`.
#[derive(Clone)]
pub struct Signal {
    pub at: i64,
    pub heading: Heading,
    pub track: Option<(usize, usize)>,
    pub device: usize,
    pub routes: Vec<(usize, i64)>,
}

#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Kind {
    /// Goes by its telegrams.
    Telegrams,
    /// Goes by signals, and on the line by telegrams.
    Signals,
}

#[derive(Clone, Debug)]
pub struct Train {
    pub nose: i64,
    pub before: i64,
    pub length: i64,
    pub heading: Heading,
    pub speed: i64,
    pub pace: i64,
    pub kind: Kind,
    /// The track in each zone.
    pub tracks: [usize; 2],
    /// Where it must stop, how fast, and when that was heard.
    pub heard: Option<(i64, i64, i64)>,
    /// A signal that it goes by: where that is, and the end of its route.
    pub way: Option<(i64, i64)>,
    /// A neighbour that is not in this world speaks to it.
    pub outside: bool,
    /// Its device, if it goes by that.
    pub board: Option<Box<board::Board>>,
}

impl Train {
    pub fn new(nose: i64, length: i64, heading: Heading, kind: Kind, tracks: [usize; 2]) -> Self {
        Self {
            nose,
            before: nose,
            length,
            heading,
            speed: 0,
            pace: SPEEDS[3],
            kind,
            tracks,
            heard: None,
            way: None,
            outside: false,
            board: None,
        }
    }

    pub fn span(&self) -> (i64, i64) {
        match self.heading {
            Heading::Right => (self.nose - self.length, self.nose),
            Heading::Left => (self.nose, self.nose + self.length),
        }
    }

    /// Metres in the direction of travel.
    fn sign(&self) -> i64 {
        if self.heading == Heading::Right { 1 } else { -1 }
    }
}

/// What a train runs from `speed` to a stand, after the cycle that it is in.
pub fn stopping(speed: i64) -> i64 {
    let steps = speed / BRAKE;
    steps * speed - BRAKE * steps * (steps + 1) / 2
}

#[derive(Clone, Copy)]
struct Motor {
    at: Option<Position>,
    moving: i64,
    target: Position,
    begins: i64,
}

/// One device, as it stands in the world.
pub struct Device {
    layout: &'static Station,
    equipment: Equipment<BLOCKS>,
    machine: Ground,
    pub state: State<BLOCKS, ROUTES, SEGMENTS>,
    pub output: Output<BLOCKS, SEGMENTS>,
    pub circuits: Vec<usize>,
    pub points: Vec<usize>,
    pub down: usize,
    lost: [u8; MAX_CIRCUITS],
    seen: [bool; MAX_CIRCUITS],
    sessions: u16,
}

impl Device {
    pub fn new(plan: &Draft, equipment: &Equipment<BLOCKS>, points: Vec<usize>) -> Self {
        let layout: &'static Station = Box::leak(Box::new(Layout::new(*plan).expect("a layout")));
        let machine = Wayside::new(layout, equipment).expect("a device");
        let mut all = CircuitSet::EMPTY;
        for route in &layout.plan().routes {
            all =
                all.or(route.held_from(0).circuits).or(route.entry.only_if(route.exists())).or(route.overlap.circuits);
        }
        for segment in &layout.plan().segments {
            all = all.or(segment.all());
        }
        let circuits = (0..MAX_CIRCUITS).filter(|it| all.meets(CircuitSet::nth(*it))).collect();
        Self {
            state: machine.initial(),
            layout,
            equipment: *equipment,
            machine,
            output: Ground::SAFE,
            circuits,
            points,
            down: 0,
            lost: [0; MAX_CIRCUITS],
            seen: [false; MAX_CIRCUITS],
            sessions: equipment.session.0,
        }
    }

    /// The device loses its memory, and is silent for so many cycles.
    pub fn restart(&mut self, down: usize) {
        self.sessions = self.sessions.wrapping_add(1);
        self.equipment.session = Session(self.sessions);
        self.machine = Wayside::new(self.layout, &self.equipment).expect("a device");
        self.state = self.machine.initial();
        self.output = Ground::SAFE;
        self.down = down;
    }

    /// One cycle; how many signals have come to proceed in it.
    pub fn step(&mut self, input: Input<BLOCKS, SEGMENTS>) -> u64 {
        if self.down > 0 {
            self.down -= 1;
            return 0;
        }
        let before = self.output.proceed;
        (self.state, self.output) = self.machine.step(self.state, input);
        self.output.proceed.without(before).bits().count_ones().into()
    }
}

/// What is said of the circuits: the same in every station, with a number for each direction of travel.
pub fn signals(circuits: usize) -> SignalPlan {
    let speeds: Vec<u16> = SPEEDS.iter().map(|speed| u16::try_from(speed * 36 / 1000).unwrap()).collect();
    let aspects = AspectTable::new(&[speeds[0], speeds[1], speeds[2], speeds[3]].map(KmhTenths)).unwrap();
    let nominal = |first: u32| {
        CodeFrequencies::new(&[0, 1, 2, 3].map(|place| Millihertz(first + 6000 * place)), Millihertz(1000)).unwrap()
    };
    let mut pairs = [[None; 8]; 8];
    let mut told = [None; 8];
    for (place, speed) in speeds.iter().enumerate() {
        pairs[place][place] = Some(KmhTenths(*speed));
        told[place] = Some(KmhTenths(*speed));
    }
    let curve = aspects.aspect(KmhTenths(speeds[3])).unwrap();
    let facing =
        |section: usize| Facing { section: SectionId(u16::try_from(section).unwrap()), gradient: Gradient(0), curve };
    let mut all = [None; MAX_CIRCUITS];
    for (number, circuit) in all.iter_mut().enumerate().take(circuits) {
        *circuit = Some(Fixed { left: facing(2 * number + 1), right: facing(2 * number) });
    }
    let codes = CodeTable::new(nominal(10_000), nominal(12_000), pairs).unwrap();
    SignalPlan { circuits: all.into(), speeds: told, aspects, codes }
}

/// A plan with the times and distances of this world.
pub fn draft(circuits: &[Circuit]) -> Draft {
    let mut plan = Draft::EMPTY;
    for (length, circuit) in plan.lengths.iter_mut().zip(circuits) {
        *length = Metres(u16::try_from((circuit.high - circuit.low) / 1000).unwrap());
    }
    plan.braking[0] = Metres(0);
    for (distance, speed) in plan.braking.iter_mut().zip(SPEEDS).skip(1) {
        let metres = (speed * speed / (2 * BRAKE) + speed * AGE).div_euclid(1000) + 1;
        *distance = Metres(u16::try_from(metres).unwrap());
    }
    (plan.clear, plan.loss, plan.settle) = (CLEAR, LOSS, 3);
    (plan.turn, plan.start) = (Ticks(TURN), Ticks(TURN));
    (plan.residual, plan.standstill) = (Ticks(RESIDUAL), Ticks(40));
    plan
}

/// A route with the times of this world.
pub fn route(
    heading: Heading,
    entry: usize,
    approach: &[usize],
    path: &[(usize, Positions)],
    beyond: usize,
) -> RoutePlan<PATH> {
    let mut made = RoutePlan::NONE;
    (made.heading, made.entry, made.beyond) = (heading, CircuitSet::nth(entry), CircuitSet::nth(beyond));
    for circuit in approach {
        made.approach = made.approach.or(CircuitSet::nth(*circuit));
    }
    for (element, (circuit, positions)) in made.path.iter_mut().zip(path) {
        *element = Element { circuits: CircuitSet::nth(*circuit), positions: *positions, ..Element::NONE };
    }
    made.length = u8::try_from(path.len()).unwrap();
    (made.drive, made.release, made.stay) = (Ticks(12), Ticks(RESIDUAL + u16::from(LOSS)), Ticks(44));
    made.speed = SpeedCode(2);
    made
}

pub fn point(detector: usize) -> PointPlan {
    PointPlan { detectors: CircuitSet::nth(detector) }
}

pub fn at(number: u8, track: usize) -> Positions {
    let position = if track == 0 { Position::Normal } else { Position::Reverse };
    Positions::of(PointId::new(number).unwrap(), position)
}

/// A circuit that staff want: each device is told to block it from a cycle on.
#[derive(Clone, Copy, Debug)]
pub struct Works {
    pub circuit: usize,
    /// They are on it.
    pub on: bool,
    pub until: i64,
    told: [i64; 2],
}

/// What has happened in the episodes.
#[derive(Default, Clone, Copy, Debug)]
pub struct Counts {
    pub cycles: u64,
    pub restarts: u64,
    /// Signals that came to proceed, and those that trains have passed.
    pub proceed: u64,
    pub passed: u64,
    /// Blocks that were confirmed to staff.
    pub confirmed: u64,
    /// Trains that came to the end of their way.
    pub arrived: u64,
    /// Cycles in which a circuit did not report its train.
    pub lost: u64,
    /// Cycles in which the device of a train permitted it to move.
    pub permitted: u64,
    /// Cycles in which the direction of travel on board changed, or was lost.
    pub turned: u64,
}

impl Counts {
    pub fn add(&mut self, other: Self) {
        self.cycles += other.cycles;
        self.restarts += other.restarts;
        self.proceed += other.proceed;
        self.passed += other.passed;
        self.confirmed += other.confirmed;
        self.arrived += other.arrived;
        self.lost += other.lost;
        self.permitted += other.permitted;
        self.turned += other.turned;
    }
}

pub struct World {
    pub dice: Dice,
    pub cycle: i64,
    pub zones: Vec<Zone>,
    pub circuits: Vec<Circuit>,
    pub signals: Vec<Signal>,
    pub devices: Vec<Device>,
    pub trains: Vec<Train>,
    machines: Vec<(i64, Motor)>,
    /// Falsely occupied circuits, and until when.
    pub falsely: Vec<(usize, i64)>,
    /// Circuits that staff want, and whether they are on them.
    pub staff: Vec<Works>,
    pub counts: Counts,
    pub margin: i64,
    /// What the trains with a device have in common.
    pub ride: Option<Box<board::Ride>>,
}

impl World {
    pub fn new(
        seed: u64,
        (zones, circuits, signals): (Vec<Zone>, Vec<Circuit>, Vec<Signal>),
        devices: Vec<Device>,
        points: &[i64],
    ) -> Self {
        let still = Motor { at: Some(Position::Normal), moving: 0, target: Position::Normal, begins: 0 };
        Self {
            dice: Dice::new(seed),
            cycle: 0,
            zones,
            circuits,
            signals,
            devices,
            trains: Vec::new(),
            machines: points.iter().map(|at| (*at, still)).collect(),
            falsely: Vec::new(),
            staff: Vec::new(),
            counts: Counts::default(),
            margin: 0,
            ride: None,
        }
    }

    /// Whether a train is in a circuit with any part.
    pub fn is_in(&self, train: &Train, circuit: usize) -> bool {
        let it = &self.circuits[circuit];
        let (low, high) = train.span();
        let (low, high) = (low.max(it.low), high.min(it.high));
        low < high && it.track.is_none_or(|(zone, track)| train.tracks[zone] == track)
    }

    /// The circuit of a nose.
    fn circuit_of(&self, train: &Train) -> Option<usize> {
        // A head at a joint is not beyond it.
        let inside = train.nose - train.sign();
        let here = |it: &Circuit| it.low <= inside && inside < it.high;
        (0..self.circuits.len()).find(|number| {
            let it = &self.circuits[*number];
            here(it) && it.track.is_none_or(|(zone, track)| train.tracks[zone] == track)
        })
    }

    fn listen(&mut self, number: usize) {
        let train = &self.trains[number];
        let Some(circuit) = self.circuit_of(train) else { return };
        let mut said = Vec::new();
        // A device has transmitters in its own circuits only.
        for device in self.devices.iter().filter(|device| device.circuits.contains(&circuit)) {
            let Some(transmission) = &device.output.transmissions[circuit] else { continue };
            if let Ok(Telegram::Main(main)) = decode(transmission.facing(train.heading).main) {
                said.push(main);
            }
        }
        if said.is_empty() || self.dice.one_in(12) {
            return;
        }
        let main: Main = self.dice.of(&said);
        let number_of = 2 * circuit + usize::from(train.heading == Heading::Left);
        assert_eq!(usize::from(main.section.0), number_of, "a telegram of another circuit");
        let it = &self.circuits[circuit];
        let (exit, sign) = if train.heading == Heading::Right { (it.high, 1) } else { (it.low, -1) };
        let (stop, speed) = match main.route {
            Route::Closed => (exit, SPEEDS[0]),
            Route::OpenFor(metres) => {
                (exit + sign * i64::from(metres.0) * 1000, SPEEDS[usize::from(main.speed.rank())])
            }
        };
        self.trains[number].heard = Some((stop, speed, self.cycle));
    }

    /// The next signal in front of a train, and the end of its way if it shows proceed.
    fn next_signal(&self, train: &Train) -> Option<(i64, Option<i64>)> {
        let ahead = |signal: &&Signal| {
            signal.heading == train.heading
                && (signal.at - train.nose) * train.sign() >= 0
                && signal.track.is_none_or(|(zone, track)| train.tracks[zone] == track)
        };
        let signal = self.signals.iter().filter(ahead).min_by_key(|signal| (signal.at - train.nose) * train.sign())?;
        let shows = |(route, _): &&(usize, i64)| {
            let it = RouteId::new(u8::try_from(*route).unwrap()).unwrap();
            self.devices[signal.device].output.proceed.has(it)
        };
        Some((signal.at, signal.routes.iter().find(shows).map(|(_, end)| *end)))
    }

    /// Whether another train is between a train and the next place of its way at `at`.
    fn is_behind_another(&self, train: &Train, at: i64) -> bool {
        let way_to = |place: i64| (place - train.nose) * train.sign();
        self.trains.iter().any(|other| {
            let (low, high) = other.span();
            let rear = if train.heading == Heading::Right { low } else { high };
            let beside = self
                .zones
                .iter()
                .enumerate()
                .any(|(zone, it)| it.low <= low && high <= it.high && other.tracks[zone] != train.tracks[zone]);
            !beside && (0..=way_to(at)).contains(&way_to(rear))
        })
    }

    /// Where a train must stop, none if it must as soon as it can, and how fast it may run.
    fn authority(&self, train: &mut Train) -> (Option<i64>, i64) {
        let (nose, sign) = (train.nose, train.sign());
        let way_to = |place: i64| (place - nose) * sign;
        let heard = train.heard.filter(|(.., since)| self.cycle - since < AGE);
        let (stop, most) = heard.map_or((None, 0), |(stop, speed, _)| (Some(stop), speed));
        if train.kind == Kind::Telegrams {
            // A closed telegram is obeyed like a point at the exit.
            return (stop, if most == 0 { SPEEDS[1] } else { most });
        }
        let signal = self.next_signal(train);
        // Whoever sees the signal over another one's head keeps to his telegrams.
        let seen = signal.filter(|(at, _)| way_to(*at) <= SIGHT && !self.is_behind_another(train, *at));
        if let Some((at, shows)) = seen {
            let passes = train.way.is_some_and(|(signal, _)| signal == at);
            match shows {
                Some(end) => train.way = Some((at, end)),
                // It goes on only if it cannot stop any more.
                None if passes && stopping(train.speed) <= way_to(at) => train.way = None,
                None => {}
            }
        }
        train.way = train.way.filter(|(_, end)| way_to(*end) >= 0);
        if let Some((_, end)) = train.way {
            // Beyond the end of a route out the line begins, with telegrams.
            let farther = stop.filter(|stop| most > 0 && way_to(*stop) > way_to(end));
            let most = if farther.is_some() { most.min(SPEEDS[2]) } else { SPEEDS[2] };
            return (farther.or(Some(end)), most);
        }
        let most = if most == 0 { SPEEDS[2] } else { most };
        let Some((at, _)) = signal else { return (stop, most) };
        let near = if way_to(at) < SIGHT + 50_000 { most.min(SPEEDS[2]) } else { most };
        (stop.map(|stop| if way_to(at) < way_to(stop) { at } else { stop }), near)
    }

    /// The speed of a train in this cycle.
    fn speed(&self, train: &mut Train) -> i64 {
        if train.outside {
            return train.speed;
        }
        if let Some(board) = &train.board {
            return board.speed(train);
        }
        let least = (train.speed - BRAKE).max(0);
        let (Some(stop), most) = self.authority(train) else { return least };
        let way = (stop - train.nose) * train.sign() - self.margin;
        let mut speed = (train.speed + BRAKE).min(most).min(train.pace).max(least);
        while speed > least && speed + stopping(speed) > way {
            speed = (speed - BRAKE / 2).max(least);
        }
        // The last step is as short as need be.
        if least == 0 { speed.min(way.max(0)) } else { speed }
    }

    /// One cycle of a train; what it runs into with its points.
    fn run(&mut self, number: usize) -> Option<String> {
        self.listen(number);
        if let Some(above) = self.on_board(number) {
            return Some(above);
        }
        let mut train = self.trains[number].clone();
        if self.dice.one_in(30) {
            train.pace = self.dice.of(&[1_000, 3_000, 10_000, 20_000, 20_000, 20_000]);
        }
        train.speed = self.speed(&mut train);
        train.before = train.nose;
        train.nose += train.sign() * train.speed;
        if let Some(board) = &mut train.board {
            board.moved = train.speed;
        }
        let accident = self.cross(&mut train).map(|what| format!("train {number} runs over {what}"));
        let passes = |signal: &&Signal| {
            let (from, to) = (signal.at - train.before, signal.at - train.nose);
            signal.heading == train.heading && from * train.sign() >= 0 && to * train.sign() < 0
        };
        let passed = self.signals.iter().filter(passes).count();
        self.counts.passed += u64::try_from(passed).unwrap();
        self.trains[number] = train;
        accident
    }

    /// The points under the nose of a train.
    fn cross(&self, train: &mut Train) -> Option<String> {
        let right = train.heading == Heading::Right;
        let (low, high) = (train.before.min(train.nose), train.before.max(train.nose));
        for (zone, it) in self.zones.iter().enumerate() {
            for (end, edge) in [(0, it.low), (1, it.high)] {
                let crosses = if right { low <= edge && edge < high } else { low < edge && edge <= high };
                let Some(point) = it.points[end].filter(|_| crosses) else { continue };
                let position = self.machines[point].1.at.map(|at| usize::from(at == Position::Reverse));
                let facing = (end == 0) == right;
                match position {
                    Some(track) if facing => train.tracks[zone] = track,
                    Some(track) if track == train.tracks[zone] => {}
                    _ => return Some(format!("point {point}, which is in {position:?}")),
                }
            }
        }
        None
    }

    /// Whereto a point is driven.
    fn driven(&self, number: usize) -> Option<Position> {
        self.devices.iter().find_map(|device| {
            let own = device.points.iter().position(|point| *point == number)?;
            let it = PointId::new(u8::try_from(own).unwrap()).unwrap().alone();
            let drives = device.output.drives;
            let normal = drives.normal.meets(it);
            drives.points().meets(it).then_some(if normal { Position::Normal } else { Position::Reverse })
        })
    }

    /// All points move on.
    fn strokes(&mut self) -> Option<String> {
        for number in 0..self.machines.len() {
            let (place, mut motor) = self.machines[number];
            if let Some(target) = self.driven(number) {
                if motor.at.is_some_and(|at| at != target) && motor.begins == 0 {
                    // A stroke begins at once or a cycle or two later, or never.
                    (motor.begins, motor.target) = (self.dice.of(&[0, 1, 1, 2, 2]), target);
                } else if motor.at.is_none() {
                    motor.target = target;
                }
            }
            if motor.begins > 0 {
                motor.begins -= 1;
                if motor.begins == 0 && motor.at.is_some() {
                    (motor.at, motor.moving) = (None, self.dice.between(1, 5));
                }
            } else if motor.at.is_none() {
                motor.moving -= 1;
                motor.at = (motor.moving <= 0).then_some(motor.target);
            }
            self.machines[number].1 = motor;
            let on = |train: &Train| train.span().0 < place && place < train.span().1;
            if motor.at.is_none() && self.trains.iter().any(on) {
                return Some(format!("point {number} moves under a train"));
            }
        }
        None
    }

    fn judge(&self) -> Option<String> {
        for (number, one) in self.trains.iter().enumerate() {
            for (second, other) in self.trains[..number].iter().enumerate() {
                let (low, high) = (one.span().0.max(other.span().0), one.span().1.min(other.span().1));
                if low >= high {
                    continue;
                }
                let apart = self.zones.iter().enumerate().any(|(zone, it)| {
                    let fouls = |end: usize| if it.points[end].is_some() { it.fouling } else { 0 };
                    it.low + fouls(0) <= low && high <= it.high - fouls(1) && one.tracks[zone] != other.tracks[zone]
                });
                if !apart {
                    return Some(format!("trains {second} and {number} meet"));
                }
            }
            for Works { circuit, on, .. } in &self.staff {
                if *on && one.speed > 0 && self.is_in(one, *circuit) {
                    return Some(format!("train {number} runs over staff in circuit {circuit}"));
                }
            }
        }
        None
    }

    /// Trains and points move on for a cycle.
    pub fn advance(&mut self) -> Option<String> {
        self.cycle += 1;
        self.counts.cycles += 1;
        // What staff rely on from this cycle on.
        let mut wanted = std::mem::take(&mut self.staff);
        for works in &mut wanted {
            // Whoever has ordered the block of a station waits for its confirmation.
            let confirmed = |(device, told): (&Device, &i64)| {
                *told < self.cycle
                    && device.circuits.contains(&works.circuit)
                    && device.output.confirmed.meets(CircuitSet::nth(works.circuit))
            };
            if !works.on && self.devices.iter().zip(&works.told).any(confirmed) {
                works.on = true;
                self.counts.confirmed += 1;
            }
        }
        self.staff = wanted;
        self.transmitters();
        for number in 0..self.trains.len() {
            if let Some(accident) = self.run(number) {
                return Some(accident);
            }
        }
        self.strokes().or_else(|| self.judge())
    }

    /// What a device is told of circuits and points.
    pub fn detect(&mut self, number: usize) -> (CircuitSet, Positions) {
        let mut occupied = CircuitSet::EMPTY;
        self.falsely.retain(|(_, until)| *until > self.cycle);
        for circuit in self.devices[number].circuits.clone() {
            if circuit >= self.circuits.len() {
                continue;
            }
            let there = self.trains.iter().any(|train| self.is_in(train, circuit));
            let falsely = self.falsely.iter().any(|(it, _)| *it == circuit);
            let eager = if self.devices[number].seen[circuit] { 25 } else { 2 };
            let lost = self.devices[number].lost[circuit];
            let loses = there && lost < LOSS && (lost > 0 && self.dice.one_in(2) || self.dice.one_in(eager));
            let device = &mut self.devices[number];
            device.lost[circuit] = if loses { lost + 1 } else { 0 };
            device.seen[circuit] = there;
            self.counts.lost += u64::from(loses);
            if there && !loses || falsely {
                occupied = occupied.or(CircuitSet::nth(circuit));
            }
        }
        let mut detected = Positions::NONE;
        for (own, point) in (0_u8..).zip(&self.devices[number].points) {
            if let Some(position) = self.machines[*point].1.at {
                detected = detected.or(Positions::of(PointId::new(own).unwrap(), position));
            }
        }
        (occupied, detected)
    }

    /// What staff order a device.
    pub fn orders(&mut self, number: usize) -> Orders {
        let mut orders = Orders::default();
        let mut kept = CircuitSet::EMPTY;
        for works in &self.staff {
            // The station that has confirmed the block keeps it; the other one is told sooner or later.
            kept = kept.or(CircuitSet::nth(works.circuit).only_if(works.told[number] <= self.cycle));
        }
        orders.block = kept;
        if self.dice.one_in(3) {
            orders.unblock = CircuitSet::ALL.without(kept);
            orders.lift = CircuitSet::ALL;
        }
        if self.dice.one_in(40) {
            let circuits = self.devices[number].circuits.clone();
            orders.restrict = CircuitSet::nth(self.dice.of(&circuits));
            orders.speed = SpeedCode(1);
        }
        orders
    }

    /// Staff come and go, circuits are falsely occupied. Whether staff have come of whom one station hears later.
    pub fn trouble(&mut self, workable: &[usize]) -> bool {
        let cycle = self.cycle;
        if self.dice.one_in(80) {
            let circuit = self.dice.below(self.circuits.len());
            let until = cycle + self.dice.of(&[1, 2, 5, 30]);
            self.falsely.push((circuit, until));
        }
        self.staff.retain(|works| works.until > cycle);
        let moving: Vec<usize> = (0..self.trains.len()).filter(|it| self.trains[*it].speed > 0).collect();
        if !self.staff.is_empty() || !self.dice.one_in(if moving.is_empty() { 600 } else { 120 }) {
            return false;
        }
        // They like to come in front of a train.
        let ahead: Vec<usize> = if moving.is_empty() || self.dice.one_in(3) {
            workable.to_vec()
        } else {
            let train = &self.trains[self.dice.of(&moving)];
            let near = |it: &&usize| {
                let its = &self.circuits[**it];
                let way = if train.heading == Heading::Right { its.low - train.nose } else { train.nose - its.high };
                (0..400_000).contains(&way)
            };
            workable.iter().filter(near).copied().collect()
        };
        if ahead.is_empty() {
            return false;
        }
        let circuit = self.dice.of(&ahead);
        let until = cycle + self.dice.between(20, 150);
        let told =
            self.dice.of(&[[0, 0], [0, 150], [150, 0], [0, 150], [150, 0], [0, 40], [40, 0]]).map(|late| cycle + late);
        self.staff.push(Works { circuit, on: false, until, told });
        told[0] != told[1]
    }

    /// A device is restarted once in so many cycles; never with 0.
    pub fn restart(&mut self, number: usize, one_in: usize) {
        if one_in > 0 && self.dice.one_in(one_in) {
            let down = self.dice.of(&[0, 0, 1, 5, 40]);
            self.devices[number].restart(down);
            self.counts.restarts += 1;
        }
    }
}

/// Messages on their way from one device to another: late, lost, repeated, in another order.
#[derive(Default)]
pub struct Channel {
    under_way: Vec<(i64, Message)>,
    recorded: Vec<Message>,
    silent_until: i64,
    late: i64,
}

impl Channel {
    pub fn fall_silent(&mut self, until: i64) {
        self.silent_until = until;
    }

    pub fn send(&mut self, dice: &mut Dice, cycle: i64, message: Option<Message>) {
        if dice.one_in(250) {
            self.silent_until = cycle + dice.of(&[2, 10, 60, 200]);
        }
        if dice.one_in(100) {
            self.late = dice.of(&[0, 0, 0, 1, 2, 8]);
        }
        let Some(message) = message else { return };
        if self.recorded.len() < 64 {
            self.recorded.push(message);
        } else {
            let place = dice.below(64);
            self.recorded[place] = message;
        }
        if cycle >= self.silent_until && !dice.one_in(10) {
            let late = if dice.one_in(6) { dice.between(0, 12) } else { self.late };
            self.under_way.push((cycle + late, message));
        }
        if dice.one_in(10) {
            let again = dice.of(&self.recorded);
            self.under_way.push((cycle + dice.between(0, 5), again));
        }
    }

    pub fn receive(&mut self, dice: &mut Dice, cycle: i64) -> Option<Message> {
        let ready: Vec<usize> = (0..self.under_way.len()).filter(|it| self.under_way[*it].0 <= cycle).collect();
        if ready.is_empty() {
            return None;
        }
        let place = dice.of(&ready);
        let (_, message) = self.under_way.swap_remove(place);
        Some(message)
    }
}

/// Nothing but what circuits and points say.
pub fn input(
    occupied: CircuitSet,
    detected: Positions,
    blocks: [atc_kernel::block::Detection; BLOCKS],
) -> Input<BLOCKS, SEGMENTS> {
    Input {
        blocks,
        occupied,
        detected,
        request: None,
        orders: Orders::default(),
        messages: [None; SEGMENTS],
        framed: Framed { main: CircuitSet::ALL, sub: CircuitSet::ALL },
    }
}

pub fn set(number: usize) -> Request {
    Request::Set(RouteId::new(u8::try_from(number).unwrap()).unwrap())
}

pub fn withdraw(number: usize) -> Request {
    Request::Withdraw(RouteId::new(u8::try_from(number).unwrap()).unwrap())
}

/// Hunts through so many episodes, or as many as `ATC_EPISODES` says, each of up to 1,500 cycles: none ends in an accident. It is no empty
/// hunt: trains run and arrive, staff come, devices restart, circuits do not report.
pub fn finds_none(episodes: u64, episode: impl Fn(u64, &mut Counts) -> Option<String>) -> Counts {
    let mut counts = Counts::default();
    let episodes = std::env::var("ATC_EPISODES").ok().and_then(|number| number.parse().ok()).unwrap_or(episodes);
    for seed in 1..=episodes {
        let accident = episode(seed, &mut counts);
        assert_eq!(accident, None, "{}", accident.as_deref().unwrap_or_default());
    }
    println!("{counts:?}");
    assert!(counts.cycles > 300 * episodes && counts.lost > counts.cycles / 20, "{counts:?}");
    let all = [counts.proceed, counts.passed, counts.arrived, counts.confirmed, counts.restarts];
    assert!(all.iter().all(|number| number * 6 > episodes), "{counts:?}");
    counts
}

/// Hunts with a broken condition through these episodes: one ends in an accident.
pub fn finds_one(broken: &str, seeds: std::ops::Range<u64>, episode: impl Fn(u64, &mut Counts) -> Option<String>) {
    let mut counts = Counts::default();
    let found = seeds.into_iter().find_map(|seed| episode(seed, &mut counts));
    println!("{broken}: {found:?}, {} cycles", counts.cycles);
    assert!(found.is_some(), "{broken}: no accident, {counts:?}");
}
