//! Calibration: from a line between a wet and a dry limit to the table that the kernel's position machine reads.
//!
//! The level difference is written D = L₁ − L₂, where "first" and "second" are chosen so that D rises with the distance x to
//! the transmitter ahead:
//!
//! | arrangement | first | second | D less the difference at the transmitters |
//! |---|---|---|---|
//! | (a) one transmitter ahead | lower frequency | higher frequency | (α₂ − α₁)·x |
//! | (b) two transmitters ahead, s apart | nearer, lower frequency | farther, higher frequency | (α₂ − α₁)·x + α₂·s |
//! | (c) one ahead, one behind, S apart, train of length ℓ | behind, heard at the tail | ahead, heard at the head | α₂·x − α₁·(S − ℓ − x) |
//!
//! (Arrangements: JP4045174B2, claims 1 to 3.)
//!
//! # What the bounds rest on
//!
//! *Every leakage.* α(G) is computed for [`STEPS`] + 1 values of G = 1/leakage, evenly in ln G, and the extremes of D are taken
//! over all of them; nothing is assumed about the sign of dD/dG. Between two values a margin covers the rest: with
//! γ² = Z(G + jωC) the derivative is dγ/d ln G = G·Z/2γ, whose magnitude is |γ|·G/(2|G + jωC|) ≤ |γ|/2, and |γ| is largest at the wet
//! limit. No value of G is farther from a computed one than half a step, so α is off by at most (step/2)·|γ(wet)|/2.
//!
//! *Between knots.* For one leakage D is a straight line over x in all three arrangements. The least of straight lines is concave
//! and lies on or above its chords, the greatest is convex and lies on or below them. So what holds at the knots holds between
//! them, and rounding (outward, to 0.01 dB) at the knots keeps it.
//!
//! *Ballast that differs along the track* ([`Ground::Varying`]). Every metre then has a leakage of its own between the limits. For the
//! stretch that both signals cross, α₂ − α₁ is bounded for each metre; what only one crosses is bounded by itself, and the
//! sum of the bounds bounds the sum. In (a) that is the same as for uniform ballast. In (c) it is much wider: the two signals cross
//! different ground, and wet ahead with dry behind is a difference no uniform line has. Reflections are not covered: see
//! [`crate::rail::chain`].
//!
//! *The train's length* in (c) is part of the plan, so that one leakage acts on the track before, behind and under the train. A train
//! of another length needs a correction of the level difference, −α₁·(ℓ − planned length), an interval over every leakage
//! ([`Calibration::correction`]); it widens the answer, by much if the weather may be anything, and is meant for the metres by
//! which a length is uncertain.

use crate::rail::{DECIBELS_PER_NEPER, Decibels, Hertz, Line, Metres, OhmKilometres, RailError, Rails};
use atc_kernel::position::{Correction, KNOTS, Millibels, Spacing, Table, TableError};
use serde::{Deserialize, Serialize};
use std::fmt;

pub mod measured;
mod text;

pub use text::TextError;

/// Steps of the search over the leakage.
pub const STEPS: u32 = 20_000;

/// Where the transmitters stand.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(tag = "kind", rename_all = "kebab-case", deny_unknown_fields)]
pub enum Arrangement {
    /// (a) One transmitter ahead of the train sends both frequencies.
    OneTransmitter,
    /// (b) Two ahead; the second stands `apart_m` metres beyond the first.
    TwoAhead {
        /// Distance between the transmitters, metres, more than 0.
        apart_m: Metres,
    },
    /// (c) One ahead, heard at the head, and one behind, heard at the tail.
    AheadAndBehind {
        /// Distance between the transmitters, metres, more than 0.
        apart_m: Metres,
        /// Length of the train from the receiver at its head to the one at its tail, metres, less than `apart_m`.
        train_m: Metres,
    },
}

/// How the ballast's insulation may differ along one section at one time.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Ground {
    /// The same everywhere in the section, anywhere between the limits.
    Uniform,
    /// Different from metre to metre, everywhere between the limits.
    Varying,
}

/// The limits of the ballast's insulation over all weather.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Weather {
    /// The least insulation.
    pub wet_ohm_km: OhmKilometres,
    /// The most.
    pub dry_ohm_km: OhmKilometres,
    /// Whether it is the same along the section.
    pub ground: Ground,
}

/// What a calibration is made of.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Plan {
    /// The frequency of the first signal.
    pub first_hz: Hertz,
    /// The frequency of the second.
    pub second_hz: Hertz,
    /// Level of the first less that of the second at their transmitters, as the receiver measures it at distance 0.
    pub transmitted_db: Decibels,
    /// Distance between two knots in decimetres: a power of two, 16 to 2048. The table covers 16 times as much.
    pub spacing_dm: u16,
    /// Where the transmitters stand.
    pub arrangement: Arrangement,
    /// The limits of the weather.
    pub weather: Weather,
    /// The rails.
    pub rails: Rails,
}

/// A plan that makes no calibration.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum PlanError {
    /// A property of the track that no track has.
    Rail(RailError),
    /// Wet is not under dry.
    Weather(OhmKilometres, OhmKilometres),
    /// A frequency that is not within 10 Hz to 100 kHz.
    Frequency(Hertz),
    /// In arrangements (a) and (b) the first frequency must be the lower.
    Order(Hertz, Hertz),
    /// A spacing that is not a power of two of decimetres, 16 to 2048.
    Spacing(u16),
    /// A distance between transmitters that is not within 1 m to 10 km.
    Apart(Metres),
    /// A train that is not at least 0 m and less than the distance between the transmitters, which comes second.
    Train(Metres, Metres),
    /// A shortest length of a train, first, that is not within 0 m to the longest, which comes second.
    Shortest(Metres, Metres),
    /// Lengths of a train, shortest and longest, over which the level difference changes by more than 300 dB.
    Lengths(Metres, Metres),
    /// A difference at the transmitters that is not within ±100 dB.
    Transmitted(Decibels),
    /// A difference at a knot that is not within ±300 dB.
    TooLarge {
        /// The knot, 0 to 16.
        knot: usize,
        /// The difference.
        difference: Decibels,
    },
    /// The kernel refuses the table.
    Table(TableError),
}

impl fmt::Display for PlanError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Rail(error) => error.fmt(f),
            Self::Weather(wet, dry) => {
                write!(f, "wet_ohm_km is {} and dry_ohm_km {}; wet must be less than dry", wet.0, dry.0)
            }
            Self::Frequency(hz) => write!(f, "a frequency of {} Hz; 10 to 100000 Hz are supported", hz.0),
            Self::Order(first, second) => {
                write!(
                    f,
                    "first_hz is {} and second_hz {}; with transmitters ahead only, the first must be lower",
                    first.0, second.0
                )
            }
            Self::Spacing(dm) => write!(f, "spacing_dm is {dm}; it must be a power of two, 16 to 2048"),
            Self::Apart(m) => write!(f, "apart_m is {}; it must be 1 to 10000", m.0),
            Self::Train(train, apart) => {
                write!(f, "a train of {} m; it must be at least 0 and less than {} m, apart_m", train.0, apart.0)
            }
            Self::Shortest(shortest, longest) => {
                write!(f, "the shortest train is {} m; it must be 0 to {} m, the longest", shortest.0, longest.0)
            }
            Self::Lengths(shortest, longest) => write!(
                f,
                "trains of {} to {} m change the level difference by more than 300 dB: choose lengths nearer to train_m",
                shortest.0, longest.0
            ),
            Self::Transmitted(db) => write!(f, "transmitted_db is {}; it must be -100 to 100", db.0),
            Self::TooLarge { knot, difference } => {
                write!(
                    f,
                    "the level difference at knot {knot} is {:.0} dB; a table holds -300 to 300: choose a smaller spacing_dm",
                    difference.0
                )
            }
            Self::Table(TableError::Crossed(knot)) => {
                write!(f, "at knot {knot} the lowest difference is above the highest")
            }
            Self::Table(TableError::NowhereRising) => {
                write!(
                    f,
                    "the level difference rises by less than 0.01 dB from knot to knot: choose a greater spacing_dm or frequencies farther apart"
                )
            }
        }
    }
}

impl std::error::Error for PlanError {}

impl From<RailError> for PlanError {
    fn from(error: RailError) -> Self {
        Self::Rail(error)
    }
}

/// Two values that bound a third.
#[derive(Clone, Copy)]
struct Bounds {
    /// Never more than the value.
    least: f64,
    /// Never less than the value.
    most: f64,
}

impl Bounds {
    fn plus(self, other: Self) -> Self {
        Self { least: self.least + other.least, most: self.most + other.most }
    }
}

/// A checked plan, its bounds at the knots computed.
#[derive(Clone, Debug, PartialEq)]
pub struct Calibration {
    plan: Plan,
    table: Table,
}

impl Calibration {
    /// Computes the bounds of the level difference for `plan`.
    ///
    /// # Errors
    /// See [`PlanError`].
    pub fn new(plan: Plan) -> Result<Self, PlanError> {
        check(&plan)?;
        let search = Search::new(&plan);
        let (mut lowest, mut highest) = ([Millibels(0); KNOTS], [Millibels(0); KNOTS]);
        for (knot, (low, high)) in lowest.iter_mut().zip(&mut highest).enumerate() {
            let bounds = search.difference(&plan, knot_distance(&plan, knot));
            let decibels = if bounds.most.abs() > bounds.least.abs() { bounds.most } else { bounds.least };
            let too_large = PlanError::TooLarge { knot, difference: Decibels(decibels) };
            *low = millibels((bounds.least * 100.0 - ROUNDING).floor()).ok_or(too_large)?;
            *high = millibels((bounds.most * 100.0 + ROUNDING).ceil()).ok_or(too_large)?;
        }
        let table = Table::new(spacing(&plan)?, lowest, highest).map_err(PlanError::Table)?;
        Ok(Self { plan, table })
    }

    /// The plan.
    pub fn plan(&self) -> &Plan {
        &self.plan
    }

    /// The least and the greatest level difference at each knot over every leakage, rounded outward.
    pub fn table(&self) -> &Table {
        &self.table
    }

    /// The distance that the table covers.
    pub fn range(&self) -> Metres {
        knot_distance(&self.plan, KNOTS - 1)
    }

    /// What is to be added to the level difference for a train of a length between `shortest` and `longest`: nothing unless one
    /// signal is heard at the tail.
    ///
    /// # Errors
    /// [`PlanError::Train`], [`PlanError::Shortest`] or [`PlanError::Lengths`].
    pub fn correction(&self, shortest: Metres, longest: Metres) -> Result<Correction, PlanError> {
        let Arrangement::AheadAndBehind { apart_m, train_m } = self.plan.arrangement else {
            return Ok(Correction::NONE);
        };
        if !(0.0..apart_m.0).contains(&longest.0) {
            return Err(PlanError::Train(longest, apart_m));
        }
        if !(0.0..=longest.0).contains(&shortest.0) {
            return Err(PlanError::Shortest(shortest, longest));
        }
        // Straight in the length for every leakage: the extremes are at the shortest and the longest.
        let search = Search::new(&self.plan);
        let [one, other] = [shortest, longest].map(|length| search.extremes(train_m.0 - length.0, 0.0));
        let (least, most) = (one.least.min(other.least) * 100.0, one.most.max(other.most) * 100.0);
        let bound = |level: f64| millibels(level).ok_or(PlanError::Lengths(shortest, longest));
        let correction = Correction::new(bound((least - ROUNDING).floor())?, bound((most + ROUNDING).ceil())?);
        correction.ok_or(PlanError::Lengths(shortest, longest))
    }
}

/// Floating-point error that rounding outward must not lose, in 0.01 dB.
const ROUNDING: f64 = 1e-6;

/// A whole number of 0.01 dB, if a table can hold it.
fn millibels(level: f64) -> Option<Millibels> {
    #[allow(clippy::cast_possible_truncation, reason = "within 16 bits after this check")]
    (level.abs() <= 30_000.0).then_some(Millibels(level as i16))
}

fn spacing(plan: &Plan) -> Result<Spacing, PlanError> {
    let exponent = u8::try_from(plan.spacing_dm.trailing_zeros()).ok().filter(|_| plan.spacing_dm.is_power_of_two());
    exponent.and_then(Spacing::new).ok_or(PlanError::Spacing(plan.spacing_dm))
}

#[allow(clippy::cast_precision_loss, reason = "a knot is 0 to 16")]
fn knot_distance(plan: &Plan, knot: usize) -> Metres {
    Metres(f64::from(plan.spacing_dm) * knot as f64 / 10.0)
}

fn check(plan: &Plan) -> Result<(), PlanError> {
    let weather = plan.weather;
    Line::new(plan.rails, weather.wet_ohm_km)?;
    Line::new(plan.rails, weather.dry_ohm_km)?;
    if weather.wet_ohm_km.0 >= weather.dry_ohm_km.0 {
        return Err(PlanError::Weather(weather.wet_ohm_km, weather.dry_ohm_km));
    }
    for frequency in [plan.first_hz, plan.second_hz] {
        if !(10.0..=100_000.0).contains(&frequency.0) {
            return Err(PlanError::Frequency(frequency));
        }
    }
    match plan.arrangement {
        Arrangement::TwoAhead { apart_m } | Arrangement::AheadAndBehind { apart_m, .. }
            if !(1.0..=10_000.0).contains(&apart_m.0) =>
        {
            return Err(PlanError::Apart(apart_m));
        }
        Arrangement::OneTransmitter | Arrangement::TwoAhead { .. } if plan.first_hz.0 >= plan.second_hz.0 => {
            return Err(PlanError::Order(plan.first_hz, plan.second_hz));
        }
        Arrangement::AheadAndBehind { apart_m, train_m } if !(0.0..apart_m.0).contains(&train_m.0) => {
            return Err(PlanError::Train(train_m, apart_m));
        }
        _ => {}
    }
    spacing(plan)?;
    if !(-100.0..=100.0).contains(&plan.transmitted_db.0) {
        return Err(PlanError::Transmitted(plan.transmitted_db));
    }
    Ok(())
}

/// The attenuations of both signals, dB for a metre, over the leakage, and how far they may be off between two values.
struct Search {
    /// First and second signal.
    alphas: Vec<[f64; 2]>,
    margin: [f64; 2],
}

impl Search {
    fn new(plan: &Plan) -> Self {
        let (wet, dry) = (plan.weather.wet_ohm_km.0, plan.weather.dry_ohm_km.0);
        let step = (dry / wet).ln() / f64::from(STEPS);
        let line =
            |leakage| Line::new(plan.rails, OhmKilometres(leakage)).expect("between two leakages that were checked");
        let both = |leakage| [plan.first_hz, plan.second_hz].map(|f| line(leakage).attenuation(f, Metres(1.0)).0);
        let leakages = (0..=STEPS).map(|n| (wet * (step * f64::from(n)).exp()).clamp(wet, dry));
        let nepers = [plan.first_hz, plan.second_hz].map(|f| line(wet).propagation(f).norm() / 1000.0);
        let margin = nepers.map(|gamma| step / 2.0 * gamma / 2.0 * DECIBELS_PER_NEPER);
        Self { alphas: leakages.map(both).collect(), margin }
    }

    /// The extremes of `first`·α₁ + `second`·α₂ over every leakage.
    fn extremes(&self, first: f64, second: f64) -> Bounds {
        let margin = first.abs() * self.margin[0] + second.abs() * self.margin[1];
        let sums = self.alphas.iter().map(|alpha| first * alpha[0] + second * alpha[1]);
        let (least, most) = sums.fold((f64::INFINITY, f64::NEG_INFINITY), |(l, m), sum| (l.min(sum), m.max(sum)));
        Bounds { least: least - margin, most: most + margin }
    }

    /// The extremes of the level difference of the planned train at `distance`.
    fn difference(&self, plan: &Plan, distance: Metres) -> Bounds {
        let x = distance.0;
        // Stretches of ground, each with its weight on the first and on the second attenuation.
        let parts = match (plan.arrangement, plan.weather.ground) {
            (Arrangement::OneTransmitter, _) => [(-x, x), (0.0, 0.0)],
            (Arrangement::TwoAhead { apart_m }, Ground::Uniform) => [(-x, x + apart_m.0), (0.0, 0.0)],
            (Arrangement::TwoAhead { apart_m }, Ground::Varying) => [(-x, x), (0.0, apart_m.0)],
            (Arrangement::AheadAndBehind { apart_m, train_m }, Ground::Uniform) => {
                [(x + train_m.0 - apart_m.0, x), (0.0, 0.0)]
            }
            (Arrangement::AheadAndBehind { apart_m, train_m }, Ground::Varying) => {
                [(x + train_m.0 - apart_m.0, 0.0), (0.0, x)]
            }
        };
        let [one, other] = parts.map(|(first, second)| self.extremes(first, second));
        let sum = one.plus(other);
        Bounds { least: sum.least + plan.transmitted_db.0, most: sum.most + plan.transmitted_db.0 }
    }
}

#[cfg(test)]
mod tests;
