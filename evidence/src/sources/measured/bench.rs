//! `bench.json`, as far as it is read here, and what makes it worthless.

use serde::{Deserialize, Serialize};

/// How far a rate may be from its errors over its bits: by less than one error in a million bits.
pub(super) const AN_ERROR_RATE: f64 = 1e-7;

/// A part of a whole.
#[allow(clippy::cast_precision_loss)]
pub(super) fn from_ratio(part: u64, whole: u64) -> f64 {
    part as f64 / whole.max(1) as f64
}

/// A run of `waveform bench`.
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize)]
pub struct Bench {
    /// Carriers, codes and telegrams.
    pub signal: Signal,
    /// The train's position.
    pub position: Position,
}

/// Carriers, codes and telegrams.
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize)]
pub struct Signal {
    /// How much was measured.
    pub extent: String,
    /// The seed.
    pub seed: u64,
    /// What kind of receiver the bit errors are of.
    pub receiver: String,
    /// Bit error curves.
    pub bit_errors: Vec<Curve>,
    /// Detection of codes and telegrams, by ratio.
    pub detection: Vec<Detection>,
    /// What was heard in noise alone.
    pub false_codes: FalseCodes,
    /// Times real time on one core.
    pub throughput: Throughput,
}

/// A bit error curve.
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize)]
pub struct Curve {
    /// What was sent.
    pub name: String,
    /// Code frequencies, if there were any.
    pub codes_hz: Option<(f64, f64)>,
    /// Error of the carriers.
    pub offset_hz: f64,
    /// The points.
    pub points: Vec<Point>,
}

impl Curve {
    /// The points that have enough errors for a loss.
    pub fn judged(&self) -> impl Iterator<Item = &Point> {
        self.points.iter().filter(|point| point.loss_db.is_some())
    }

    /// The target that it belongs to.
    pub fn target(&self) -> &'static str {
        if self.codes_hz.is_some() {
            "ber-under-code"
        } else if self.offset_hz == 0.0 {
            "ber-coherent"
        } else {
            "ber-offset"
        }
    }

    /// The same theory at a ratio that is one decibel lower, where there is such a point.
    fn theory_a_decibel_lower(&self, point: &Point) -> Option<f64> {
        self.points.iter().find(|one| (one.eb_n0_db + 1.0 - point.eb_n0_db).abs() < 1e-6).map(|one| one.theory)
    }
}

/// One point of a curve.
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize)]
pub struct Point {
    /// Energy of a bit over noise density.
    pub eb_n0_db: f64,
    /// Bits compared.
    pub bits: u64,
    /// Bits that were wrong.
    pub errors: u64,
    /// Their ratio.
    pub rate: f64,
    /// What theory gives.
    pub theory: f64,
    /// How many decibels more than theory are needed for this rate.
    pub loss_db: Option<f64>,
}

/// A distribution of times.
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize)]
pub struct Times {
    /// Part of the trials in which anything was heard.
    pub heard: f64,
    /// Half of them were at most as long.
    pub median: Option<f64>,
}

/// Detection at one ratio.
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize)]
pub struct Detection {
    /// Signal over noise.
    pub snr_db: f64,
    /// Trials.
    pub trials: u64,
    /// The right speed.
    pub code: Times,
    /// The right main telegram.
    pub main_telegram: Times,
    /// Wrong speeds.
    pub wrong_speeds: u64,
    /// Telegrams that were never sent.
    pub wrong_telegrams: u64,
}

/// What was heard in noise alone.
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize)]
pub struct FalseCodes {
    /// Windows.
    pub windows: u64,
    /// As many would not overlap.
    pub disjoint_windows: u64,
    /// Windows with a code.
    pub codes: u64,
    /// Speeds.
    pub speeds: u64,
    /// Codes for each window, or what it is below.
    pub code_rate: f64,
}

/// Times real time on one core.
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize)]
pub struct Throughput {
    /// Conventional receiver.
    pub conventional: f64,
    /// Receiver of codes and telegrams.
    pub on_board: f64,
    /// Track circuit receiver.
    pub track_circuit: f64,
}

/// The train's position.
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize)]
pub struct Position {
    /// In words: what was run.
    pub conditions: String,
    /// Trains through a section.
    pub runs: Vec<Run>,
    /// Trains on ballast that the table is not for.
    pub outside: Vec<Outside>,
    /// What reflections change.
    pub reflections: Vec<Reflection>,
    /// The level meter.
    pub meter: Vec<Meter>,
    /// Trains whose levels were measured from samples.
    pub from_samples: Vec<Run>,
}

/// A train through a section.
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize)]
pub struct Run {
    /// `a`, `b` or `c`.
    pub arrangement: char,
    /// Insulation of the ballast.
    pub ohm_km: f64,
    /// `with` or `without`.
    pub odometer: String,
    /// Part of the cycles with an interval.
    pub answered: f64,
    /// Part of the cycles with an interval without the train.
    pub wrong: f64,
    /// Mean width, metres.
    pub mean_width: f64,
    /// Cycle by cycle.
    pub points: Vec<Moment>,
}

/// One cycle.
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize)]
pub struct Moment {
    /// The true distance, metres.
    pub truth: f64,
    /// Nearest and farthest, metres.
    pub interval: Option<(f64, f64)>,
}

impl Run {
    /// Whether the train is outside its interval in some cycle.
    fn misses(&self) -> bool {
        let outside = |one: &Moment| one.interval.is_some_and(|(near, far)| one.truth < near || one.truth > far);
        self.points.iter().any(outside)
    }
}

/// A train on ballast that the table is not for.
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize)]
pub struct Outside {
    /// `a`, `b` or `c`.
    pub arrangement: char,
    /// Insulation of the ballast.
    pub ohm_km: f64,
    /// Part of the cycles with an interval without the train.
    pub wrong: f64,
}

/// What a reflection changes.
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize)]
pub struct Reflection {
    /// The line.
    pub line: String,
    /// The greatest change of the difference.
    pub greatest_db: f64,
}

/// The level meter at one ratio.
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize)]
pub struct Meter {
    /// Signal over noise.
    pub signal_to_noise_db: f64,
    /// Windows.
    pub windows: u64,
    /// Standard deviation.
    pub deviation_db: f64,
    /// The same by theory.
    pub expected_db: f64,
    /// Greatest error.
    pub greatest_db: f64,
}

/// The ratio from which the meter must keep its tolerance, in decibels.
pub const METER_FROM_DB: f64 = 30.0;
/// The fewest points of a curve that count as a curve.
const FEWEST_POINTS: usize = 5;

impl Bench {
    /// The meter's points that the tolerance is for.
    pub fn metered(&self) -> impl Iterator<Item = &Meter> {
        self.position.meter.iter().filter(|one| one.signal_to_noise_db >= METER_FROM_DB)
    }

    /// Why the run shows nothing about a target; nothing if it does.
    pub fn vacuous(&self, target: &str) -> Option<String> {
        let (signal, position) = (&self.signal, &self.position);
        let curves = || signal.bit_errors.iter().filter(|curve| curve.target() == target);
        let heard =
            |of: fn(&Detection) -> &Times| signal.detection.iter().any(|one| one.trials > 0 && of(one).heard > 0.99);
        let answered =
            |runs: &[Run]| !runs.is_empty() && runs.iter().all(|run| run.answered > 0.5 && !run.points.is_empty());
        match target {
            _ if curves().any(|curve| curve.judged().count() < FEWEST_POINTS) => {
                Some(format!("a curve has fewer than {FEWEST_POINTS} points with enough errors"))
            }
            "wrong-telegrams" if !heard(|one| &one.main_telegram) => {
                Some("at no ratio all the right telegrams were heard: nothing wrong could be".to_owned())
            }
            "wrong-speeds" if !heard(|one| &one.code) => {
                Some("at no ratio all the right speeds were heard: nothing wrong could be".to_owned())
            }
            "false-codes" if signal.false_codes.windows == 0 => Some("no window of noise was looked at".to_owned()),
            "level-tolerance" if self.metered().all(|one| one.windows == 0) => {
                Some(format!("no window at {METER_FROM_DB} dB or more"))
            }
            "position-inside" if !answered(&position.runs) => Some("a train got no interval in most cycles".to_owned()),
            "position-samples" if !answered(&position.from_samples) => {
                Some("a train got no interval in most cycles".to_owned())
            }
            _ => None,
        }
    }

    /// Where the raw figures say otherwise than what was made of them; nothing if they agree.
    pub fn contradiction(&self, target: &str) -> Option<String> {
        for curve in self.signal.bit_errors.iter().filter(|curve| curve.target() == target) {
            for point in curve.judged() {
                let counted = from_ratio(point.errors, point.bits);
                if (counted - point.rate).abs() > AN_ERROR_RATE {
                    return Some(format!("{}: its rate is not that of its errors", curve.name));
                }
                // A loss of at most 1 dB means: no worse than theory at a ratio that is 1 dB lower.
                let lower = curve.theory_a_decibel_lower(point);
                if point.loss_db.is_some_and(|loss| loss <= 1.0)
                    && lower.is_some_and(|theory| point.rate > theory * 1.001)
                {
                    return Some(format!("{}: its loss is not that of its rate", curve.name));
                }
            }
        }
        let runs = match target {
            "position-inside" => &self.position.runs,
            "position-samples" => &self.position.from_samples,
            _ => return None,
        };
        let hidden = runs.iter().find(|run| run.misses() != (run.wrong > 0.0));
        hidden.map(|run| format!("arrangement {}, {} Ω·km: its cycles say otherwise", run.arrangement, run.ohm_km))
    }
}
