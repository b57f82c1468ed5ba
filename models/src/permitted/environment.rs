//! What may happen in a model of the permitted speed, and the small parameters of the kernel in it.

use super::layout::{BRAKE_MM_S2, CELL_M, SPEEDS};
use atc_kernel::aspect::{AspectId, AspectTable};
use atc_kernel::code::{CodeFrequencies, CodeTable, MAX_CODES, Millihertz};
use atc_kernel::distance::Metres;
use atc_kernel::pattern::Deceleration;
use atc_kernel::permitted::{Permitted, Settings};
use atc_kernel::position::{Correction, KNOTS, Millibels, Position, Spacing, Table};
use atc_kernel::speed::KmhTenths;
use atc_kernel::telegram::{Gradient, Sequence};
use atc_kernel::time::Ticks;

/// The kernel's parameters, small. Times in cycles.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Small {
    /// The rank of the lowest limit.
    pub lowest: u8,
    /// The worst gradient, in thousandths.
    pub worst: i8,
    /// The margin in cells.
    pub margin: u8,
    /// For how long a main telegram is fresh.
    pub fresh: u16,
    /// For how long its pattern runs down.
    pub life: u16,
    /// For how long a sub telegram is used.
    pub fixed_life: u16,
    /// The most by which a counter may advance.
    pub window: u8,
    /// How many advances are evidence.
    pub run: u8,
    /// For how long a stream is remembered.
    pub memory: u16,
}

impl Small {
    /// Fresh for 2 cycles, used for 3; sub telegrams for 4; window 2, run 1, memory 3; no margin, nothing worse than the level.
    pub const USUAL: Self =
        Self { lowest: 0, worst: 0, margin: 0, fresh: 2, life: 3, fixed_life: 4, window: 2, run: 1, memory: 3 };

    /// The kernel's parameters.
    ///
    /// # Panics
    /// If the kernel rejects them; a test builds every model of the catalogue.
    pub fn permitted(&self) -> Permitted {
        let settings = Settings {
            speeds: AspectTable::new(&SPEEDS.map(KmhTenths)).expect("the speeds of the models"),
            lowest: AspectId::new(self.lowest).expect("a rank of the models"),
            brake: Deceleration::brake(BRAKE_MM_S2).expect("the brake of the models"),
            worst: Gradient(self.worst),
            margin: Metres(u16::from(self.margin) * CELL_M),
            fresh: Ticks(self.fresh),
            life: Ticks(self.life),
            fixed_life: Ticks(self.fixed_life),
            sequence: Sequence::new(self.window, self.run, Ticks(self.memory)).expect("a sequence of the models"),
        };
        Permitted::new(settings).expect("parameters of the models")
    }
}

/// Whether what is sent arrives.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Delivery {
    /// In every cycle.
    Always,
    /// It may be lost in any cycle.
    Any,
    /// Never.
    Never,
}

/// How the distance to the exit is measured.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Fix {
    /// Not at all.
    Never,
    /// In any cycle or not: the true distance, or a cell less.
    Any,
    /// By the kernel's position device, from the levels of two frequencies, in wet and dry and with every error within the
    /// tolerance, or not at all.
    Levels,
}

/// Until when the telegrams of a section are heard, of which the nose has passed the exit.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Border {
    /// They are not.
    Sharp,
    /// One may be completed, and used, in the cycle in which the nose passes.
    Crossing,
    /// One may be completed in the cycle in which the nose passes, and used in the next one. No distance is measured in the cycle
    /// in which the nose passes.
    Delayed,
    /// They may come in any order with those of the section ahead, as long as the nose is fewer cells into it.
    Mixed {
        /// The cells.
        cells: u8,
        /// What is measured in these cells is the distance to the exit of the section ahead; otherwise nothing is.
        fix_ahead: bool,
    },
}

/// What the odometer says that the train has moved.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Odometer {
    /// What it has moved.
    Exact,
    /// That, or a cell more.
    Bounded,
    /// That, or a cell less.
    Short,
}

/// What may go wrong with the transmitter: from any cycle on it repeats what it sent last.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Transmitter {
    /// Nothing.
    Sound,
    /// It repeats the last 1 to 3 telegrams, the oldest of them first.
    Loops(u8),
    /// It repeats the last one; this begins only after more than a window of telegrams was lost.
    FreezesUnheard,
    /// It repeats the last one, and the one before that is late: it may arrive again and again, but not twice in a row.
    FreezesAndLate,
}

/// Whether the train is told of the kind of line.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Told {
    /// In the cycle in which its nose passes the border.
    AtBorder,
    /// The same, but perhaps late or never that the digital line has begun.
    PerhapsNotOfDigital,
}

/// How the train moves.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Motion {
    /// By a cell a cycle faster or slower, and no faster than permitted if it can.
    Free,
    /// Not at all.
    Standing,
}

/// What the ground does.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Route {
    /// The farthest stopping point is in force for ever.
    Fixed,
    /// It is drawn back to a nearer one, or advanced again, in any cycle.
    Any,
    /// It is drawn back once, to the nearest.
    Withdrawn,
}

/// What may happen.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Environment {
    /// Main telegrams.
    pub main: Delivery,
    /// Sub telegrams.
    pub sub: Delivery,
    /// Analog codes.
    pub code: Delivery,
    /// The distance to the exit.
    pub fix: Fix,
    /// Telegrams at a border.
    pub border: Border,
    /// The kind of line.
    pub told: Told,
    /// The odometer.
    pub odometer: Odometer,
    /// The transmitter.
    pub transmitter: Transmitter,
    /// How many telegrams it sends in a cycle, of which the last one may be heard: with many the counter goes round sooner.
    pub in_a_cycle: u8,
    /// The train.
    pub motion: Motion,
    /// The stopping point.
    pub route: Route,
    /// Whether the restriction may be imposed in any cycle.
    pub restriction: bool,
    /// For how many cycles the ground keeps a stretch free that it has withdrawn.
    pub keeps: u16,
    /// For how many cycles a restriction is not yet relied on.
    pub keeps_limit: u16,
}

impl Environment {
    /// Main telegrams are lost in any cycle, all else is as it should be; there are no codes and no distances. What the ground
    /// withdraws it keeps for the life of a telegram.
    pub const USUAL: Self = Self {
        main: Delivery::Any,
        sub: Delivery::Always,
        code: Delivery::Never,
        fix: Fix::Never,
        border: Border::Sharp,
        told: Told::AtBorder,
        odometer: Odometer::Exact,
        transmitter: Transmitter::Sound,
        in_a_cycle: 1,
        motion: Motion::Free,
        route: Route::Fixed,
        restriction: false,
        keeps: Small::USUAL.life,
        keeps_limit: Small::USUAL.fixed_life,
    };
}

/// The code frequencies of a carrier, their tolerance, and one that is in no band; in mHz.
const MAIN_MHZ: [u32; 2] = [10_000, 15_000];
const SUB_MHZ: [u32; 2] = [12_000, 16_500];
const TOLERANCE_MHZ: u32 = 500;

/// The code table of the models: the n-th code of both carriers names the n-th speed.
pub(super) fn codes() -> CodeTable {
    let carrier = |mhz: [u32; 2]| CodeFrequencies::new(&mhz.map(Millihertz), Millihertz(TOLERANCE_MHZ));
    let mut speeds = [[None; MAX_CODES]; MAX_CODES];
    for (place, speed) in SPEEDS.into_iter().enumerate() {
        speeds[place][place] = Some(KmhTenths(speed));
    }
    let (main, sub) = (carrier(MAIN_MHZ).expect("main codes"), carrier(SUB_MHZ).expect("sub codes"));
    CodeTable::new(main, sub, speeds).expect("the codes of the models")
}

/// What the receiver measures of the code of a rank: the frequencies of both carriers.
pub(super) fn measured(delivery: Delivery, rank: u8) -> Vec<[Option<Millihertz>; 2]> {
    let [main, sub] = [MAIN_MHZ[usize::from(rank)], SUB_MHZ[usize::from(rank)]];
    let other = MAIN_MHZ[usize::from(1 - rank)];
    let pair = |main: u32, sub: u32| [Some(Millihertz(main)), Some(Millihertz(sub))];
    let right = vec![pair(main - TOLERANCE_MHZ, sub + TOLERANCE_MHZ)];
    match delivery {
        Delivery::Always => right,
        Delivery::Any => {
            let wrong = [pair(main, sub + TOLERANCE_MHZ + 1), pair(other, sub), [Some(Millihertz(main)), None]];
            right.into_iter().chain(wrong).collect()
        }
        Delivery::Never => vec![[None, None]],
    }
}

/// The position device of the models. The level difference rises by at least 25 and at most 30 mB a cell.
pub(super) fn position() -> Position {
    let spacing = Spacing::new(5).expect("3.2 m");
    let knots = |slope: i16| -> [Millibels; KNOTS] {
        std::array::from_fn(|knot| Millibels(slope * i16::try_from(knot).unwrap_or(i16::MAX)))
    };
    let table = Table::new(spacing, knots(20), knots(24)).expect("the table of the models");
    Position::new(table, Millibels(LEVEL_TOLERANCE_MB), Millibels(-2000), Correction::NONE).expect("a tolerance")
}

const LEVEL_TOLERANCE_MB: i16 = 2;

/// The levels that may be measured so many cells from the transmitter: wet or dry, each off by the tolerance either way.
pub(super) fn levels(cells: u8) -> Vec<[Millibels; 2]> {
    let off = LEVEL_TOLERANCE_MB;
    let pair = |slope: i16, first: i16, second: i16| {
        [Millibels(-300 + first), Millibels(-300 - slope * i16::from(cells) + second)]
    };
    [25, 30].into_iter().flat_map(|slope| [pair(slope, off, -off), pair(slope, -off, off)]).collect()
}
