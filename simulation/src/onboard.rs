//! The device on board: the kernel's [`Train`], on a line of analog codes.
//!
//! On such a line the code is the signal, so that its interruption is what the train feels: on a digital line a fresh telegram
//! carries it on (PER-13), and nothing could be measured of aspect acceptance.

use atc_kernel::Machine as _;
use atc_kernel::aspect::{Acceptance, AspectId, AspectTable, Times, TimesMs};
use atc_kernel::code::{CodeFrequencies, CodeTable, MAX_CODES, Millihertz};
use atc_kernel::distance::Metres;
use atc_kernel::pattern::Deceleration;
use atc_kernel::permitted::{LineKind, Permitted, Settings};
use atc_kernel::position::Moved;
use atc_kernel::speed::{KmhTenths, RawKmhTenths};
use atc_kernel::supervision::Supervision;
use atc_kernel::telegram::{Gradient, Sequence};
use atc_kernel::time::{Cycle, Millis, Ticks};
use atc_kernel::train::{Antennas, Cab, Carrier, Parts, State, Train};

/// The ranks of a line: code 0 is stop, and there are up to 7 more.
const RANKS: usize = MAX_CODES;

/// Code frequencies of the main and the sub carrier. Rank `i` is the `i`-th of both: one code that is taken for another
/// names nothing.
const MAIN: [u32; RANKS] = [10_000, 12_500, 15_000, 18_500, 22_000, 29_000, 36_000, 41_500];
const SUB: [u32; RANKS] = [9_000, 12_000, 16_500, 21_000, 24_000, 27_000, 32_000, 38_500];

/// For how long telegrams would live. None is sent on a line of codes.
const LIFE_MS: u32 = 1_000;

/// Which device a train has.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Operate {
    /// With the shortened operate time.
    Shortened,
    /// The conventional one: T5 = T1.
    Conventional,
}

/// The trains' device: one for all of them.
#[derive(Clone, Copy, Debug)]
pub struct Device {
    train: Train<RANKS>,
    ranks: u8,
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
    /// The device for a line whose codes 1, 2, … name these speeds in km/h (0: no such code), in cycles of `cycle_ms`.
    ///
    /// # Errors
    /// What is wrong with the speeds or the cycle.
    pub fn new(speeds_kmh: &[u16], cycle_ms: u32, operate: Operate) -> Result<Self, String> {
        let used = speeds_kmh.iter().skip(1).take_while(|kmh| **kmh > 0);
        let speeds: Vec<KmhTenths> = std::iter::once(0).chain(used.copied()).map(|kmh| KmhTenths(kmh * 10)).collect();
        let table = AspectTable::new(&speeds).map_err(|error| format!("the speeds of the codes: {error:?}"))?;
        let times = Times::from_millis(Millis(cycle_ms), TimesMs::default())
            .map_err(|error| format!("a cycle of {cycle_ms} ms on board: {error:?}"))?;
        let times = if operate == Operate::Conventional { times.conventional() } else { times };
        let frequencies = |nominal: [u32; RANKS]| {
            let nominal = nominal.map(Millihertz);
            CodeFrequencies::new(&nominal[..speeds.len()], Millihertz(400)).map_err(|error| format!("codes: {error:?}"))
        };
        let mut named = [[None; MAX_CODES]; MAX_CODES];
        for (rank, speed) in speeds.iter().enumerate() {
            named[rank][rank] = Some(*speed);
        }
        let codes =
            CodeTable::new(frequencies(MAIN)?, frequencies(SUB)?, named).map_err(|error| format!("{error:?}"))?;
        let life = Cycle::new(Millis(cycle_ms)).and_then(|cycle| cycle.at_most(Millis(LIFE_MS))).unwrap_or(Ticks(1));
        let sequence = Sequence::new(4, 1, life).map_err(|error| format!("telegrams: {error:?}"))?;
        let settings = Settings {
            speeds: table,
            lowest: AspectId::new(0).ok_or("no rank 0")?,
            brake: Deceleration::brake(800).ok_or("no brake")?,
            worst: Gradient(0),
            margin: Metres(10),
            fresh: life,
            life,
            fixed_life: life,
            sequence,
        };
        let permitted = Permitted::new(settings).map_err(|error| format!("telegrams: {error:?}"))?;
        let parts = Parts {
            codes,
            acceptance: Acceptance { times },
            permitted,
            supervision: Supervision::default(),
            position: None,
        };
        let train = Train::new(parts).map_err(|error| format!("the device on board: {error:?}"))?;
        Ok(Self { train, ranks: u8::try_from(speeds.len()).unwrap_or(u8::MAX) })
    }

    /// The highest rank.
    pub const fn highest(&self) -> u8 {
        self.ranks - 1
    }

    /// One cycle: the rank whose code was heard throughout it, and the measured speed.
    pub fn step(&self, device: &mut OnBoard, heard: Option<u8>, speed: RawKmhTenths) -> Cab {
        let carrier = |nominal: [u32; RANKS]| Carrier {
            code: heard.and_then(|rank| nominal.get(usize::from(rank)).copied().map(Millihertz)),
            frame: None,
        };
        let antennas = Antennas {
            main: carrier(MAIN),
            sub: carrier(SUB),
            first: None,
            second: None,
            moved: Some(Moved::STANDING),
            speed: Some(speed),
            line: (!device.told).then_some(LineKind::Analog),
            // No telegram is sent on a line of codes.
            facing: None,
        };
        device.told = true;
        let (state, cab) = self.train.step(device.state, antennas);
        device.state = state;
        cab
    }
}
