//! The ground, the train on it, and what reaches the antennas.

use crate::{BEYOND_MM, BRAKE_MM_S2, CYCLE_S, EXPIRY, FRAME, SLOPE, WIDTH, WORST};
use atc_kernel::aspect::AspectId;
use atc_kernel::code::Millihertz;
use atc_kernel::distance::Metres;
use atc_kernel::heading::Heading;
use atc_kernel::permitted::LineKind;
use atc_kernel::position::{Millibels, Moved};
use atc_kernel::speed::{KmhTenths, RawKmhTenths};
use atc_kernel::supervision::Brake;
use atc_kernel::telegram::{Counter, Frame, Gradient, Length, Main, Route, SectionId, Sub, Telegram, encode};
use atc_kernel::train::{Antennas, Carrier};
use std::collections::VecDeque;

/// Numbers that look random, always the same ones.
pub struct Dice(u64);

impl Dice {
    fn below(&mut self, end: i64) -> i64 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        i64::try_from((self.0 >> 11) % u64::try_from(end).unwrap()).unwrap()
    }

    fn one_in(&mut self, number: i64) -> bool {
        self.below(number) == 0
    }

    fn of<const N: usize, T: Copy>(&mut self, choice: [T; N]) -> T {
        choice[usize::try_from(self.below(i64::try_from(N).unwrap())).unwrap()]
    }
}

/// A condition of the case that is broken.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Broken {
    /// `odometer-bound`: the odometer says half of what the train moved.
    Odometer,
    /// `fix-of-the-section-heard`: levels of the section ahead are measured where telegrams of the one behind are heard.
    OtherSection,
    /// `stop-point-life`: the ground relies on what it has withdrawn after half of the life.
    EarlyGround,
    /// `counter-reach`: a recording is heard after a silence.
    Recording,
    /// `gravity`: the brake is weaker than the device was told.
    Brake,
    /// `line-is-told`: the train is told of an analog line on a digital one.
    FalseLine,
    /// `margin-covers-the-crossing`: telegrams are heard 60 m beyond the exit.
    FarBeyond,
}

pub const BROKEN: [Broken; 7] = [
    Broken::Odometer,
    Broken::OtherSection,
    Broken::EarlyGround,
    Broken::Recording,
    Broken::Brake,
    Broken::FalseLine,
    Broken::FarBeyond,
];

/// A section of the line: where it begins, and what is true of it.
#[derive(Clone, Copy, Debug)]
pub struct Section {
    pub begin: i64,
    pub exit: i64,
    pub gradient: i8,
    /// A rank.
    pub limit: u8,
    pub digital: bool,
}

/// What the ground has said, and when: where the train must stop, and a rank.
#[derive(Clone, Copy, Debug)]
pub struct Promise {
    pub at: i64,
    pub stop: i64,
    pub rank: u8,
}

/// A frame that is being sent.
#[derive(Clone, Copy, Debug)]
pub struct Sending {
    telegram: Option<Telegram>,
    begin: i64,
    section: usize,
}

pub struct World {
    pub dice: Dice,
    pub broken: Option<Broken>,
    pub line: Vec<Section>,
    pub cycle: i64,
    pub front: i64,
    /// In mm/s.
    pub speed: f64,
    pub brake: Brake,
    /// A driver who wants no more than this, in tenths of km/h.
    pub wants: i64,
    pub stop: i64,
    /// The stopping point changes in one of so many cycles.
    pub restless: i64,
    pub rank: u8,
    pub codes: VecDeque<u8>,
    /// Temporary restriction: section, rank, and when it changed.
    pub restriction: (usize, u8),
    pub limits: VecDeque<(i64, usize, u8)>,
    pub promises: VecDeque<Promise>,
    pub sending: [Sending; 2],
    pub counters: [u8; 2],
    pub frozen: [Option<(i64, Telegram)>; 2],
    pub recorded: Vec<Frame>,
    pub silent: [i64; 4],
    pub permitted: Option<KmhTenths>,
    /// It had no telegram yet with which it could stop in time: on an analog line the codes must see to that.
    pub came_too_fast: bool,
}

fn kmh_tenths(mm_s: f64) -> f64 {
    mm_s * 0.036
}

impl World {
    pub fn new(seed: u64, broken: Option<Broken>) -> Self {
        let mut dice = Dice(seed.wrapping_mul(0x9E37_79B9_7F4A_7C15) | 1);
        let analog = if dice.one_in(3) { 3 } else { 0 };
        let mut line: Vec<Section> = Vec::new();
        let mut begin = 0;
        for number in 0..14 {
            let exit = begin + 1000 * (60 + dice.below(900));
            let gradient = dice.of([WORST, -9, -3, 0, 4, 12]);
            line.push(Section { begin, exit, gradient, limit: dice.of([1, 2, 3, 4, 4, 4]), digital: number >= analog });
            begin = exit;
        }
        let front = line[0].begin + dice.below(line[0].exit / 2);
        let nothing = Sending { telegram: None, begin: 0, section: 0 };
        Self {
            stop: line[1].exit,
            restless: dice.of([60, 600]),
            dice,
            broken,
            line,
            cycle: 0,
            front,
            speed: 0.0,
            brake: Brake::Emergency,
            wants: 2000,
            rank: 4,
            codes: VecDeque::new(),
            restriction: (0, 4),
            limits: VecDeque::new(),
            promises: VecDeque::new(),
            sending: [nothing; 2],
            counters: [0; 2],
            frozen: [None; 2],
            recorded: Vec::new(),
            silent: [0; 4],
            permitted: None,
            came_too_fast: true,
        }
    }

    pub fn is(&self, broken: Broken) -> bool {
        self.broken == Some(broken)
    }

    pub fn section(&self) -> usize {
        self.line.iter().position(|section| self.front < section.exit).unwrap_or(self.line.len() - 1)
    }

    /// The limit that is in force in a section now.
    fn limit(&self, number: usize) -> u8 {
        let own = self.line[number].limit;
        if self.restriction.0 == number { own.min(self.restriction.1) } else { own }
    }

    /// The ground: where the train must stop, how fast it may be, which code is shown, which restriction is in force.
    fn ground(&mut self) {
        let here = self.section();
        let dice = &mut self.dice;
        if dice.one_in(self.restless) || self.stop <= self.front {
            // It is taken back at most to the exit of the train's own section.
            let last = (here + usize::try_from(dice.below(4)).unwrap()).min(self.line.len() - 1);
            let room = if last + 1 < self.line.len() { self.line[last + 1].exit - self.line[last].exit } else { 1 };
            let within = if dice.one_in(2) { 0 } else { dice.below(room.max(1)) / 1000 * 1000 };
            self.stop = self.line[last].exit + within;
        }
        if dice.one_in(150) {
            self.rank = dice.of([0, 1, 2, 3, 4, 4, 4]);
        }
        if dice.one_in(200) {
            let number = (here + usize::try_from(dice.below(3)).unwrap()).min(self.line.len() - 1);
            self.restriction = (number, dice.of([1, 2, 4]));
        }
        let code = match self.codes.front() {
            Some(code) if !dice.one_in(80) => *code,
            _ => dice.of([0, 1, 2, 3, 4, 4]),
        };
        self.codes.push_front(code);
        self.codes.truncate(usize::try_from(EXPIRY).unwrap() + 3);
        for number in 0..self.line.len() {
            let limit = self.limit(number);
            let cycle = self.cycle;
            match self.limits.iter_mut().find(|(_, of, rank)| *of == number && *rank == limit) {
                Some(known) => known.0 = cycle,
                None => self.limits.push_back((cycle, number, limit)),
            }
        }
    }

    /// What a telegram of this section says now.
    fn telegram(&mut self, stream: usize, number: usize) -> Telegram {
        // They all travel to the left.
        let section = SectionId(2 * u16::try_from(number).unwrap() + 1);
        let counter = Counter(self.counters[stream]);
        let rank = |rank: u8| AspectId::new(rank).unwrap();
        let Section { begin, exit, .. } = self.line[number];
        if stream == 0 {
            let beyond = (self.stop - exit) / 1000;
            let open = beyond > 0;
            let stop = if open { exit + beyond * 1000 } else { exit };
            self.promises.push_back(Promise { at: self.cycle, stop, rank: self.rank });
            let route = if open { Route::OpenFor(Metres(u16::try_from(beyond).unwrap())) } else { Route::Closed };
            return Telegram::Main(Main { section, counter, route, speed: rank(self.rank) });
        }
        // Wherever its main telegrams may stop a train, and where the last of them dies.
        let reach = (number + 6).min(self.line.len());
        let gradient = self.line[number..reach].iter().map(|section| section.gradient).min().unwrap();
        let next = (number + 1).min(self.line.len() - 1);
        let curve = self.line[number].limit.min(self.line[next].limit);
        let restriction = if [number, next].contains(&self.restriction.0) { self.restriction.1 } else { 4 };
        let length = Length::new(Metres(u16::try_from((exit - begin) / 1000).unwrap())).unwrap();
        Telegram::Sub(Sub {
            section,
            counter,
            length,
            gradient: Gradient(gradient),
            curve: rank(curve),
            restriction: rank(restriction),
        })
    }

    /// The frame of this carrier whose last bit comes in this cycle, if it was heard as a whole.
    fn frame(&mut self, stream: usize) -> Option<Frame> {
        let heard = self.heard();
        let Sending { telegram, begin, section } = self.sending[stream];
        let mut done = None;
        if telegram.is_none() || self.cycle - begin >= FRAME[stream] || heard != section {
            if heard == section && telegram.is_some() {
                done = telegram;
            }
            if !self.line[heard].digital {
                self.sending[stream] = Sending { telegram: None, begin: self.cycle, section: heard };
                return None;
            }
            // A transmitter that has frozen sends the same again.
            let next = match self.frozen[stream] {
                Some((until, frozen)) if self.cycle < until && heard == section => frozen,
                _ => {
                    self.counters[stream] = self.counters[stream].wrapping_add(1);
                    let fresh = self.telegram(stream, heard);
                    self.frozen[stream] = self.dice.one_in(40).then(|| (self.cycle + self.dice.below(120), fresh));
                    fresh
                }
            };
            self.sending[stream] = Sending { telegram: Some(next), begin: self.cycle, section: heard };
        }
        let frame = encode(done?);
        if self.cycle < self.silent[stream] || self.dice.one_in(12) {
            return None;
        }
        if stream == 0 && self.dice.one_in(30) {
            self.recorded.push(frame);
        }
        // Damaged: up to three wrong bits.
        let wrong = if self.dice.one_in(20) { 1 + self.dice.below(3) } else { 0 };
        let bits = (0..wrong).fold(frame.bits(), |bits, _| bits ^ 1 << self.dice.below(106));
        Some(Frame::from_bits(bits))
    }

    /// The section whose telegrams are heard.
    fn heard(&self) -> usize {
        let here = self.section();
        let beyond = if self.is(Broken::FarBeyond) { 60_000 } else { BEYOND_MM };
        let past = self.front - self.line[here].begin;
        if here > 0 && past < beyond { here - 1 } else { here }
    }

    /// One cycle: the train moves, and what its antennas give then.
    pub fn next(&mut self) -> Antennas {
        self.cycle += 1;
        let moved = self.run();
        self.ground();
        for place in 0..4 {
            if self.dice.one_in([400, 400, 300, 250][place]) {
                self.silent[place] = self.cycle + self.dice.below([60, 200, 30, 40][place]);
            }
        }
        let mut frames = [self.frame(0), self.frame(1)];
        if self.is(Broken::Recording) && self.cycle < self.silent[0] && self.cycle % 5 == 0 {
            frames[0] =
                self.recorded.get(usize::try_from(self.cycle / 5).unwrap() % self.recorded.len().max(1)).copied();
        }
        let here = self.section();
        // The code of the cycle, for a moment another one; both carriers off the band, or one missing.
        let shown = if self.dice.one_in(30) { self.dice.below(5) } else { i64::from(self.codes[0]) };
        let there = self.cycle >= self.silent[2];
        let code = |first: u32| there.then(|| Millihertz(first + 6000 * u32::try_from(shown).unwrap()));
        let codes = [code(10_000), code(12_000).filter(|_| shown == i64::from(self.codes[0]))];

        // Levels of the section in which the train is, but where telegrams of the one behind are heard.
        let to_exit = self.line[here].exit - self.front;
        let measurable = self.heard() == here || self.is(Broken::OtherSection) && self.dice.one_in(2);
        let heard = measurable && self.cycle >= self.silent[3] && !self.dice.one_in(15);
        let difference = to_exit * SLOPE / 1000 + self.dice.below(WIDTH);
        let off = [self.dice.below(9) - 4, self.dice.below(9) - 4];
        let attenuation = -self.dice.below(800);
        let level = |mb: i64| Some(Millibels(i16::try_from(mb).unwrap())).filter(|_| heard);
        let first = i16::try_from(attenuation + difference + off[0]).ok().and_then(|mb| level(mb.into()));

        let told = if self.is(Broken::Odometer) { moved / 2 } else { moved };
        let slack = [self.dice.below(80), self.dice.below(80)];
        let odometer = Moved::new(i16::try_from(told - slack[0]).unwrap(), i16::try_from(told + slack[1]).unwrap());
        let measured = kmh_tenths(self.speed.abs()).ceil();
        #[allow(clippy::cast_possible_truncation)] // A few hundred.
        let speed = RawKmhTenths(measured as i32 + i32::try_from(self.dice.below(4)).unwrap());

        let kind =
            if self.line[here].digital && !self.is(Broken::FalseLine) { LineKind::Digital } else { LineKind::Analog };
        let passes = self.line[here].begin > self.front - moved;
        Antennas {
            main: Carrier { code: codes[0], frame: frames[0] },
            sub: Carrier { code: codes[1], frame: frames[1] },
            first,
            second: level(attenuation + off[1]),
            moved: if self.dice.one_in(60) { None } else { odometer },
            speed: if self.dice.one_in(300) { None } else { Some(speed) },
            line: (passes || self.cycle == 1 || self.dice.one_in(70)).then_some(kind),
            facing: Some(Heading::Left),
        }
    }

    /// The train in one cycle: what it moves, in mm.
    #[allow(clippy::cast_possible_truncation, clippy::cast_precision_loss)] // A few metres.
    fn run(&mut self) -> i64 {
        if self.dice.one_in(200) {
            self.wants = self.dice.of([0, 300, 2000, 2000, 2000]);
        }
        let gradient = f64::from(self.line[self.section()].gradient) * 9.8;
        let weak = if self.is(Broken::Brake) { 0.6 } else { 1.0 };
        let want = self.wants.min(self.permitted.map_or(0, |speed| i64::from(speed.0))) as f64 / 0.036;
        let braked = -(f64::from(BRAKE_MM_S2) * weak + gradient);
        let change = match self.brake {
            Brake::Release if self.speed < want => (want - self.speed).min(1200.0 * CYCLE_S),
            Brake::Release => (want - self.speed).max(braked * CYCLE_S),
            Brake::Service | Brake::Emergency => braked * CYCLE_S,
        };
        let before = self.speed;
        self.speed = (self.speed + change).max(0.0);
        let mut moved = (f64::midpoint(before, self.speed) * CYCLE_S).round() as i64;
        if self.speed == 0.0 && before == 0.0 && self.dice.one_in(30) {
            moved = -self.dice.below(120);
        }
        self.front += moved;
        moved
    }
}
