//! The results as numbers.

use serde::Serialize;

/// Everything that is measured.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct PositionBench {
    /// In words: what was run.
    pub conditions: String,
    /// Attenuation and level difference over distance.
    pub curves: Vec<LineCurve>,
    /// A train through the section, for each arrangement, ballast, with and without the odometer.
    pub runs: Vec<Run>,
    /// The same for narrower limits of the weather, ballast of 10 Ω·km, with the odometer.
    pub limits: Vec<Limits>,
    /// A table for 5 to 20 Ω·km on ballast that is outside these limits.
    pub outside: Vec<Outside>,
    /// What reflections change in the level difference.
    pub reflections: Vec<Reflection>,
    /// Errors of a level meter in noise.
    pub meter: Vec<MeterPoint>,
    /// A train whose levels are measured from samples.
    pub from_samples: Vec<Run>,
}

/// Attenuation at both frequencies over distance, on one ballast.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct LineCurve {
    /// Insulation of the ballast, Ω·km.
    pub ohm_km: f64,
    /// Distance in metres, attenuation at 1 kHz and at 3 kHz in dB, and their difference if the transmitter's impedance is fixed
    /// (matched to 10 Ω·km, short circuit at the train).
    pub points: Vec<[f64; 4]>,
}

/// One cycle of a run.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Point {
    /// Since the start, seconds.
    pub seconds: f64,
    /// The true distance to the transmitter, metres.
    pub truth: f64,
    /// The interval in metres, nearest and farthest; none if it is unknown.
    pub interval: Option<[f64; 2]>,
}

/// A train that runs through the section.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Run {
    /// `a`, `b` or `c`.
    pub arrangement: char,
    /// Insulation of the ballast, Ω·km.
    pub ohm_km: f64,
    /// Whether the odometer was used.
    pub odometer: Odometry,
    /// Part of the cycles with an interval.
    pub answered: f64,
    /// Part of the cycles with an interval that does not contain the train.
    pub wrong: f64,
    /// Mean width of the intervals, metres.
    pub mean_width: f64,
    /// Greatest width, metres.
    pub greatest_width: f64,
    /// Mean distance of the train from the middle of the interval, metres.
    pub mean_error: f64,
    /// Greatest distance of the train from the middle of the interval, metres.
    pub greatest_error: f64,
    /// Cycle by cycle.
    pub points: Vec<Point>,
}

/// Whether intervals are carried on by the odometer (POS-4) or each stands for itself.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Odometry {
    /// Every cycle for itself.
    Without,
    /// Intersected with the last interval.
    With,
}

/// Mean width by the limits of the weather.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Limits {
    /// `a`, `b` or `c`.
    pub arrangement: char,
    /// The table's wet limit, Ω·km.
    pub wet_ohm_km: f64,
    /// The table's dry limit, Ω·km.
    pub dry_ohm_km: f64,
    /// Mean width, metres.
    pub mean_width: f64,
}

/// A table that is wrong for the ballast.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Outside {
    /// `a`, `b` or `c`.
    pub arrangement: char,
    /// The true insulation, Ω·km; the table is for 5 to 20.
    pub ohm_km: f64,
    /// Part of the cycles with an interval.
    pub answered: f64,
    /// Part of the cycles with an interval that does not contain the train.
    pub wrong: f64,
    /// The same if a device gave no more answers in this section after the first one that contradicted the odometer.
    pub wrong_if_kept: f64,
}

/// What a reflection changes.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Reflection {
    /// In words: the line.
    pub line: &'static str,
    /// The greatest change of the level difference over 0 to 400 m, dB.
    pub greatest_db: f64,
}

/// Errors of the level meter at one ratio of signal to noise.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct MeterPoint {
    /// Power of each tone over the noise in half the sample rate, dB.
    pub signal_to_noise_db: f64,
    /// Windows measured.
    pub windows: u32,
    /// Standard deviation, dB.
    pub deviation_db: f64,
    /// Standard deviation by theory, dB.
    pub expected_db: f64,
    /// Greatest error, dB.
    pub greatest_db: f64,
}
