//! Faults of the line: what may fail, for how long it may, and when it does in one run.

use rand::{Rng, SeedableRng};
use rand_pcg::Pcg64Mcg;
use serde::{Deserialize, Serialize};

use crate::line::Line;

/// What may fail.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Kind {
    /// A train hears no code.
    Interruption,
    /// A train hears another code than the one that is sent.
    MisreadCode,
    /// A circuit is reported occupied.
    FalseOccupancy,
    /// A train is not reported in any circuit, or not in that of its rear.
    ShuntLoss,
    /// A train is not reported in the circuit of its front.
    MissedDetection,
    /// Points take longer for their stroke than they may.
    LatePoint,
    /// Telegrams to a station are lost.
    LostTelegram,
    /// Telegrams to a station come late.
    DelayedTelegram,
    /// The transmitter of a circuit repeats what it sent.
    RepeatedCode,
    /// The device of a station starts anew.
    RestartStation,
    /// The device of a train starts anew.
    RestartTrain,
    /// The detectors of a counted line do not hear the head of a train.
    MissedHead,
    /// A detector of a counted line hears a head that is not there.
    PhantomHead,
    /// A check-in misses trains.
    CheckInLost,
    /// A check-in is on without a train.
    CheckInStuckOn,
    /// A check-out misses trains.
    CheckOutLost,
    /// A check-out is on without a train.
    SpuriousCheckOut,
    /// Staff reset a block with a wrong number.
    WrongReset,
}

impl Kind {
    /// Those of every line.
    pub const ALL: [Self; 11] = [
        Self::Interruption,
        Self::MisreadCode,
        Self::FalseOccupancy,
        Self::ShuntLoss,
        Self::MissedDetection,
        Self::LatePoint,
        Self::LostTelegram,
        Self::DelayedTelegram,
        Self::RepeatedCode,
        Self::RestartStation,
        Self::RestartTrain,
    ];

    /// Those of a counted line; the models of block counting give the others of their names the same ones.
    pub const COUNTING: [Self; 7] = [
        Self::MissedHead,
        Self::PhantomHead,
        Self::CheckInLost,
        Self::CheckInStuckOn,
        Self::CheckOutLost,
        Self::SpuriousCheckOut,
        Self::WrongReset,
    ];

    /// Those that a line can have.
    pub fn of(line: &Line) -> Vec<Self> {
        let counting = if line.counted.is_empty() { &[][..] } else { &Self::COUNTING };
        [&Self::ALL, counting].concat()
    }

    /// Its name on the command line and in files.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Interruption => "interruption",
            Self::MisreadCode => "misread-code",
            Self::FalseOccupancy => "false-occupancy",
            Self::ShuntLoss => "shunt-loss",
            Self::MissedDetection => "missed-detection",
            Self::LatePoint => "late-point",
            Self::LostTelegram => "lost-telegram",
            Self::DelayedTelegram => "delayed-telegram",
            Self::RepeatedCode => "repeated-code",
            Self::RestartStation => "restart-station",
            Self::RestartTrain => "restart-train",
            Self::MissedHead => "missed-head",
            Self::PhantomHead => "phantom-head",
            Self::CheckInLost => "check-in-lost",
            Self::CheckInStuckOn => "check-in-stuck-on",
            Self::CheckOutLost => "check-out-lost",
            Self::SpuriousCheckOut => "spurious-check-out",
            Self::WrongReset => "wrong-reset",
        }
    }

    /// The kind of this name.
    pub fn named(name: &str) -> Option<Self> {
        Self::ALL.into_iter().chain(Self::COUNTING).find(|kind| kind.name() == name)
    }

    /// For how long it lasts, in ms: from, and up to. Without a limit where the line must stand any length.
    pub fn lasts_ms(self, line: &Line, extent: Extent) -> (u32, u32) {
        let within = match self {
            Self::Interruption => (50, 1_500),
            // Shorter than the operate time of 300 ms.
            Self::MisreadCode => (20, 290),
            Self::FalseOccupancy
            | Self::MissedHead
            | Self::PhantomHead
            | Self::CheckInLost
            | Self::CheckInStuckOn
            | Self::CheckOutLost
            | Self::SpuriousCheckOut => (100, 60_000),
            Self::ShuntLoss | Self::MissedDetection => (100, line.shunt_loss_ms.max(101)),
            Self::LatePoint => (5_000, 60_000),
            Self::LostTelegram => (200, 60_000),
            Self::DelayedTelegram => (200, 20_000),
            Self::RepeatedCode => (100, repeated_ms(line)),
            Self::RestartStation | Self::RestartTrain => (0, 1),
            Self::WrongReset => (60_000, 300_000),
        };
        match extent {
            Extent::Tolerated => within,
            Extent::Beyond => (within.1.max(20_000), within.1.max(20_000) * 4),
        }
    }
}

/// For how long a transmitter may repeat what it sent: what is left of the telegrams' age when the train has forgotten the
/// code (800 ms) and braked, and two cycles of the ground have passed.
fn repeated_ms(line: &Line) -> u32 {
    let spent = 800 + line.dynamics.brake_delay_ms + 2 * line.cycle_ms;
    line.telegram_age_ms.saturating_sub(spent).max(101)
}

/// Whether a fault is one that the line must stand.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Extent {
    /// It keeps to the conditions.
    Tolerated,
    /// It lasts far longer than the conditions allow.
    Beyond,
}

/// One fault of a run.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Fault {
    /// What fails.
    pub kind: Kind,
    /// When it begins, in ms; between two cycles as well.
    pub from_ms: f64,
    /// How long it lasts.
    pub lasts_ms: f64,
    /// Which train, circuit, point or station: counted on over all of them.
    pub which: usize,
    /// How much: of a late point the time in ms, of a late telegram the same, of a misread code its rank; a loss of
    /// shunt is of every circuit (even) or of the rear.
    pub much: u32,
}

impl Fault {
    /// Whether it is there at some time from `from_ms` on for `length_ms`.
    pub fn meets(&self, from_ms: f64, length_ms: f64) -> bool {
        self.from_ms < from_ms + length_ms && from_ms < self.from_ms + self.lasts_ms
    }

    /// As [`Fault::draw`], from a seed.
    pub fn drawn(kind: Kind, extent: Extent, line: &Line, window: (f64, f64), seed: u64) -> Self {
        Self::draw(kind, extent, line, window, &mut Pcg64Mcg::seed_from_u64(seed))
    }

    /// A fault of this kind at a random time between `from_ms` and `to_ms`; at `from_ms` if there is none between.
    pub fn draw(kind: Kind, extent: Extent, line: &Line, (from_ms, to_ms): (f64, f64), random: &mut impl Rng) -> Self {
        let (least, most) = kind.lasts_ms(line, extent);
        let lasts_ms = random.random_range(f64::from(least.min(most))..=f64::from(most));
        let much = match kind {
            Kind::LatePoint => random.random_range(2_000..30_000),
            Kind::DelayedTelegram if extent == Extent::Tolerated => {
                let longest = line.longest_delay_ms();
                random.random_range(longest.min(100)..=longest)
            }
            Kind::DelayedTelegram => random.random_range(20_000..60_000),
            Kind::MisreadCode if extent == Extent::Beyond => 7,
            _ => random.random_range(0..8),
        };
        Self {
            kind,
            from_ms: if from_ms < to_ms { random.random_range(from_ms..to_ms) } else { from_ms },
            lasts_ms,
            which: random.random_range(0..1 << 20),
            much,
        }
    }
}
