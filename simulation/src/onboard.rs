//! The device on board: the kernel's [`Train`], on a line of analog codes, or of telegrams with codes beside them.
//!
//! On a line of codes the code is the signal, so that its interruption is what the train feels: on a digital line a fresh telegram
//! carries it on (PER-13), and nothing could be measured of aspect acceptance.

use atc_kernel::Machine as _;
use atc_kernel::aspect::{Acceptance, AspectId, AspectTable, Times, TimesMs};
use atc_kernel::code::{CodeFrequencies, CodeTable, MAX_CODES, Millihertz};
use atc_kernel::distance::Metres;
use atc_kernel::heading::Heading;
use atc_kernel::pattern::Deceleration;
use atc_kernel::permitted::{LineKind, Permitted, Settings};
use atc_kernel::position::{Correction, Millibels, Moved, Position, Spacing, Table};
use atc_kernel::speed::{KmhTenths, RawKmhTenths};
use atc_kernel::supervision::Supervision;
use atc_kernel::telegram::{Frame, Gradient, Sequence};
use atc_kernel::time::{Cycle, Millis, Ticks};
use atc_kernel::train::{Antennas, Cab, Carrier, Parts, State, Train};

use crate::defect::Defect;

/// The ranks of a line: code 0 is stop, and there are up to 7 more.
const RANKS: usize = MAX_CODES;

/// Code frequencies of the main and the sub carrier. Rank `i` is the `i`-th of both: one code that is taken for another
/// names nothing.
const MAIN: [u32; RANKS] = [10_000, 12_500, 15_000, 18_500, 22_000, 29_000, 36_000, 41_500];
const SUB: [u32; RANKS] = [9_000, 12_000, 16_500, 21_000, 24_000, 27_000, 32_000, 38_500];

/// For how long main telegrams live. With the life of consent between stations this is no more than the ground counts on.
const LIFE_MS: u32 = 700;

/// For how long they are fresh: two turns of a transmitter, and a little.
const FRESH_MS: u32 = 2 * 2 * FRAME_MS + 80;

/// For how long sub telegrams live.
const FIXED_LIFE_MS: u32 = 10_000;

/// How long a transmitter sends a frame. It sends those for both directions of travel in turn.
pub const FRAME_MS: u32 = 80;

/// What the odometer may be off, in thousandths.
const ODOMETER_PER_MILLE: f64 = 10.0;

/// The attenuation of the rails: so many mB a knot of 25.6 m, and up to so many more.
const SLOPE: i16 = 256;
const WIDTH: i16 = 20;

/// What the speeds of a line are called.
#[derive(Clone, Copy, Debug)]
pub struct Words {
    /// By rank.
    pub aspects: AspectTable,
    /// By code.
    pub codes: CodeTable,
}

/// The ranks and codes of a line whose codes 1, 2, … name these speeds in km/h (0: no such code). Code 0 is stop.
///
/// # Errors
/// What is wrong with the speeds.
pub fn words(speeds_kmh: &[u16]) -> Result<Words, String> {
    let used = speeds_kmh.iter().skip(1).take_while(|kmh| **kmh > 0);
    let speeds: Vec<KmhTenths> = std::iter::once(0).chain(used.copied()).map(|kmh| KmhTenths(kmh * 10)).collect();
    let aspects = AspectTable::new(&speeds).map_err(|error| format!("the speeds of the codes: {error:?}"))?;
    let frequencies = |nominal: [u32; RANKS]| {
        let nominal = nominal.map(Millihertz);
        CodeFrequencies::new(&nominal[..speeds.len()], Millihertz(400)).map_err(|error| format!("codes: {error:?}"))
    };
    let mut named = [[None; MAX_CODES]; MAX_CODES];
    for (rank, speed) in speeds.iter().enumerate() {
        named[rank][rank] = Some(*speed);
    }
    let codes = CodeTable::new(frequencies(MAIN)?, frequencies(SUB)?, named).map_err(|error| format!("{error:?}"))?;
    Ok(Words { aspects, codes })
}

/// What a train meets in one cycle, besides the code.
#[derive(Clone, Copy, Debug, Default)]
pub struct Met {
    /// The frames that were completed, of main and sub telegrams.
    pub frames: [Option<Frame>; 2],
    /// How far it moved, in m.
    pub moved_m: f64,
    /// The distance to the exit of its circuit, where levels tell it.
    pub to_exit_m: Option<f64>,
    /// Which way it faces.
    pub facing: Option<Heading>,
}

/// Which device a train has.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Operate {
    /// With the shortened operate time.
    Shortened,
    /// The conventional one: T5 = T1.
    Conventional,
}

/// What trains run on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Signal {
    /// Codes alone, on an analog line.
    Codes,
    /// Telegrams alone, on a digital line.
    Telegrams,
    /// Telegrams with codes beside them, on a digital line: the lower speed counts.
    Both,
}

impl Signal {
    /// The kind of line that trains are told of.
    pub const fn line(self) -> LineKind {
        match self {
            Self::Codes => LineKind::Analog,
            Self::Telegrams | Self::Both => LineKind::Digital,
        }
    }
}

/// The trains' device: one for all of them.
#[derive(Clone, Copy, Debug)]
pub struct Device {
    train: Train<RANKS>,
    ranks: u8,
    line: LineKind,
}

/// What a train's device remembers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct OnBoard {
    state: State<RANKS>,
    told: bool,
}

impl OnBoard {
    /// Just started.
    pub const START: Self = Self { state: State::INITIAL, told: false };
}

impl Device {
    /// The device for a line whose codes 1, 2, … name these speeds in km/h (0: no such code), in cycles of `cycle_ms`; with
    /// what is wrong in it.
    ///
    /// # Errors
    /// What is wrong with the speeds or the cycle.
    pub fn new(
        speeds_kmh: &[u16],
        cycle_ms: u32,
        (operate, line): (Operate, LineKind),
        defects: &[Defect],
    ) -> Result<Self, String> {
        let words = words(speeds_kmh)?;
        let cycle = Cycle::new(Millis(cycle_ms));
        let ticks = |ms: u32| cycle.and_then(|cycle| cycle.at_most(Millis(ms))).unwrap_or(Ticks(1));
        let life = ticks(LIFE_MS);
        let sequence = Sequence::new(4, 1, life).map_err(|error| format!("telegrams: {error:?}"))?;
        let ranks = u8::try_from(words.aspects.speeds().len()).map_err(|_| "more speeds than ranks")?;
        let mut settings = Settings {
            speeds: words.aspects,
            // The line is as fast everywhere: no section has a lower limit.
            lowest: AspectId::new(ranks - 1).ok_or("more speeds than ranks")?,
            brake: Deceleration::brake(800).ok_or("no brake")?,
            worst: Gradient(0),
            margin: Metres(10),
            fresh: ticks(FRESH_MS),
            life,
            fixed_life: ticks(FIXED_LIFE_MS),
            sequence,
        };
        let mut times = TimesMs::default();
        for defect in defects {
            defect.spoil_on_board(&mut times, &mut settings, cycle_ms);
        }
        let times = Times::from_millis(Millis(cycle_ms), times)
            .map_err(|error| format!("a cycle of {cycle_ms} ms on board: {error:?}"))?;
        let times = if operate == Operate::Conventional { times.conventional() } else { times };
        let permitted = Permitted::new(settings).map_err(|error| format!("telegrams: {error:?}"))?;
        let position = if line == LineKind::Digital { Some(position().ok_or("no table of levels")?) } else { None };
        let acceptance = Acceptance { times };
        let parts = Parts { codes: words.codes, acceptance, permitted, supervision: Supervision::default(), position };
        let train = Train::new(parts).map_err(|error| format!("the device on board: {error:?}"))?;
        Ok(Self { train, ranks, line })
    }

    /// The highest rank.
    pub const fn highest(&self) -> u8 {
        self.ranks - 1
    }

    /// One cycle: the rank whose code was heard throughout it, the measured speed, and what else the train meets.
    pub fn step(&self, device: &mut OnBoard, heard: Option<u8>, speed: RawKmhTenths, met: Met) -> Cab {
        let carrier = |nominal: [u32; RANKS], frame| Carrier {
            code: heard.and_then(|rank| nominal.get(usize::from(rank)).copied().map(Millihertz)),
            frame,
        };
        let level = met.to_exit_m.map(|metres| Millibels(WIDTH / 2 + whole(metres * f64::from(SLOPE) / 25.6)));
        let antennas = Antennas {
            main: carrier(MAIN, met.frames[0]),
            sub: carrier(SUB, met.frames[1]),
            first: level,
            second: level.map(|_| Millibels(0)),
            moved: odometer(met.moved_m),
            speed: Some(speed),
            line: (!device.told).then_some(self.line),
            facing: met.facing,
        };
        device.told = true;
        let (state, cab) = self.train.step(device.state, antennas);
        device.state = state;
        cab
    }
}

/// The position of a train on rails of this attenuation.
fn position() -> Option<Position> {
    let lowest = std::array::from_fn(|knot| Millibels(i16::try_from(knot).unwrap_or(i16::MAX).saturating_mul(SLOPE)));
    let highest = lowest.map(|level: Millibels| Millibels(level.0 + WIDTH));
    let table = Table::new(Spacing::new(8)?, lowest, highest).ok()?;
    Position::new(table, Millibels(5), Millibels(-6000), Correction::NONE)
}

/// What the odometer says of a movement: forwards, in whole mm, off by no more than it may be.
fn odometer(metres: f64) -> Option<Moved> {
    let off = metres * ODOMETER_PER_MILLE / 1000.0;
    let [least, most] = [(metres - off) * 1000.0, (metres + off) * 1000.0];
    Moved::new(whole(least.floor()), whole(most.ceil()))
}

#[allow(clippy::cast_possible_truncation, reason = "a cast from float saturates")]
fn whole(number: f64) -> i16 {
    number.round() as i16
}
