//! Measurements of the train's position: error and width of the kernel's interval, by weather, arrangement and odometer.
//!
//! [`bench()`] runs trains through a section of 400 m on line theory's ground ([`crate::position_run`]), with measurement errors
//! spread evenly over the tolerance, and gives everything as numbers; [`plots`] draws them. The same run gives the same
//! numbers every time.

use crate::calibration::{Arrangement, Calibration, Ground, Plan, Weather};
use crate::position_run::{Ballast, Odometer, Site, device, reading};
use crate::rail::chain::{Piece, loss};
use crate::rail::{Decibels, Hertz, Line, Metres, OhmKilometres, Rails};
use atc_kernel::position::{Correction, Interval, Measured, Millibels, Position, step};
use rand::{Rng, SeedableRng};
use rand_pcg::Pcg64Mcg;

mod reflections;
mod results;
mod samples;

pub use crate::measure::Extent;
pub use crate::position_plot::plots;
pub use results::{Limits, LineCurve, MeterPoint, Odometry, Outside, Point, PositionBench, Reflection, Run};

/// By how much a level may be off: 0.1 dB, which [`MeterPoint`] shows to be kept from 30 dB of signal over noise.
const TOLERANCE: Millibels = Millibels(10);
/// The section's length, metres.
const SECTION: f64 = 400.0;
/// Metres in one cycle: 20 m/s, ten cycles a second.
const CYCLE: f64 = 2.0;
/// The odometer is known to 2 % and counts 1 % too much.
const ODOMETER: Odometer = Odometer { scale: 1.01, bound: 0.02 };
const SEED: u64 = 4_045_174;

/// The limits of "any weather": 2 to 50 Ω·km.
const ANY_WEATHER: (f64, f64) = (2.0, 50.0);

/// Runs everything. [`Extent::Quick`] takes fewer windows of noise.
///
/// # Panics
/// Never: all parameters are this module's own.
pub fn bench(extent: Extent) -> PositionBench {
    let mut runs = Vec::new();
    for arrangement in ['a', 'b', 'c'] {
        let calibration = calibration(arrangement, ANY_WEATHER);
        for ohm_km in [2.0, 10.0, 50.0] {
            for odometer in [Odometry::Without, Odometry::With] {
                runs.push(run(&calibration, arrangement, ohm_km, odometer));
            }
        }
    }
    let windows = if extent == Extent::Quick { 400 } else { 20_000 };
    PositionBench {
        conditions: format!(
            "Section {SECTION} m, 20 m/s, 10 cycles a second; 1 and 3 kHz (a, b), 3 kHz twice (c); transmitters 60 m apart (b), 600 m \
             with a train of 200 m (c); tables for {} to {} Ω·km; levels ±{} dB; odometer ±2 %, 1 % wrong",
            ANY_WEATHER.0,
            ANY_WEATHER.1,
            f64::from(TOLERANCE.0) / 100.0
        ),
        curves: curves(),
        runs,
        limits: limits(),
        outside: outside(),
        reflections: reflections::reflections(),
        meter: [10.0, 15.0, 20.0, 25.0, 30.0, 35.0, 40.0].map(|ratio| samples::meter(ratio, windows)).to_vec(),
        from_samples: [2.0, 10.0, 50.0].map(samples::from_samples).to_vec(),
    }
}

fn line(ohm_km: f64) -> Line {
    Line::new(Rails::default(), OhmKilometres(ohm_km)).expect("a usual track")
}

fn calibration(arrangement: char, (wet, dry): (f64, f64)) -> Calibration {
    let (first, arrangement) = match arrangement {
        'a' => (1000.0, Arrangement::OneTransmitter),
        'b' => (1000.0, Arrangement::TwoAhead { apart_m: Metres(60.0) }),
        _ => (3000.0, Arrangement::AheadAndBehind { apart_m: Metres(600.0), train_m: Metres(200.0) }),
    };
    let weather = Weather { wet_ohm_km: OhmKilometres(wet), dry_ohm_km: OhmKilometres(dry), ground: Ground::Uniform };
    // The table must reach as far as the weather may make a train in the section seem to be.
    let plan = Plan {
        first_hz: Hertz(first),
        second_hz: Hertz(3000.0),
        transmitted_db: Decibels(0.0),
        spacing_dm: 2048,
        arrangement,
        weather,
        rails: Rails::default(),
    };
    Calibration::new(plan).expect("a usual plan")
}

fn kernel(calibration: &Calibration) -> Position {
    device(calibration, TOLERANCE, Millibels(0), Correction::NONE).expect("a tolerance over 0")
}

fn metres(interval: Interval) -> [f64; 2] {
    [interval.nearest(), interval.farthest()].map(|end| f64::from(end.0) / 1000.0)
}

fn run(calibration: &Calibration, arrangement: char, ohm_km: f64, odometer: Odometry) -> Run {
    let position = kernel(calibration);
    let site = Site {
        plan: *calibration.plan(),
        ballast: Ballast::uniform(OhmKilometres(ohm_km)),
        transmitted: Decibels(60.0),
    };
    let train = match calibration.plan().arrangement {
        Arrangement::AheadAndBehind { train_m, .. } => train_m,
        _ => Metres(0.0),
    };
    let mut random = Pcg64Mcg::seed_from_u64(SEED);
    let read = |truth: f64| {
        let levels = site.levels(Metres(truth), train);
        levels.map(|level| {
            let error = Decibels(random.random_range(-1.0..=1.0) * f64::from(TOLERANCE.0) / 100.0);
            level.map(|level| reading(level, error, TOLERANCE))
        })
    };
    drive(&position, odometer, read).into_run(arrangement, ohm_km, odometer)
}

/// What the kernel says while a train runs from one end of the section to the other.
fn drive(position: &Position, odometer: Odometry, mut read: impl FnMut(f64) -> [Option<Millibels>; 2]) -> Points {
    let moved = ODOMETER.moved(Metres(CYCLE)).expect("two metres");
    let mut state = None;
    let points = (0..200_u32).map(|cycle| {
        let truth = SECTION - CYCLE * f64::from(cycle);
        let [first, second] = read(truth);
        let before = if odometer == Odometry::With { state } else { None };
        state = step(position, before, Measured { first, second, moved });
        Point { seconds: f64::from(cycle) / 10.0, truth, interval: state.map(metres) }
    });
    Points(points.collect())
}

struct Points(Vec<Point>);

impl Points {
    /// Intervals that do not contain the train.
    fn wrong(&self) -> usize {
        let missed =
            |p: &&Point| p.interval.is_some_and(|[nearest, farthest]| !(nearest..=farthest).contains(&p.truth));
        self.0.iter().filter(missed).count()
    }

    #[allow(clippy::cast_precision_loss, reason = "200 cycles")]
    fn into_run(self, arrangement: char, ohm_km: f64, odometer: Odometry) -> Run {
        let answers: Vec<(f64, [f64; 2])> = self.0.iter().filter_map(|p| Some((p.truth, p.interval?))).collect();
        let widths = || answers.iter().map(|(_, [nearest, farthest])| farthest - nearest);
        let errors =
            || answers.iter().map(|(truth, [nearest, farthest])| (f64::midpoint(*nearest, *farthest) - truth).abs());
        let (cycles, answered) = (self.0.len() as f64, answers.len() as f64);
        Run {
            arrangement,
            ohm_km,
            odometer,
            answered: answered / cycles,
            wrong: self.wrong() as f64 / cycles,
            mean_width: widths().sum::<f64>() / answered.max(1.0),
            greatest_width: widths().fold(0.0, f64::max),
            mean_error: errors().sum::<f64>() / answered.max(1.0),
            greatest_error: errors().fold(0.0, f64::max),
            points: self.0,
        }
    }
}

fn curves() -> Vec<LineCurve> {
    let curve = |ohm_km| {
        let lost = |frequency, distance| line(ohm_km).attenuation(Hertz(frequency), Metres(distance)).0;
        let fixed = |frequency, distance| {
            let track = [Piece { line: line(ohm_km), length: Metres(distance) }];
            loss(&track, Hertz(frequency), line(10.0).impedance(Hertz(frequency))).0
        };
        let point = |x| [x, lost(1000.0, x), lost(3000.0, x), fixed(3000.0, x) - fixed(1000.0, x)];
        let points = (0..=50).map(|n| point(f64::from(n) * 20.0));
        LineCurve { ohm_km, points: points.collect() }
    };
    [2.0, 10.0, 50.0].map(curve).to_vec()
}

fn limits() -> Vec<Limits> {
    let mut all = Vec::new();
    for arrangement in ['a', 'b', 'c'] {
        for (wet, dry) in [ANY_WEATHER, (5.0, 20.0), (8.0, 12.5)] {
            let run = run(&calibration(arrangement, (wet, dry)), arrangement, 10.0, Odometry::With);
            all.push(Limits { arrangement, wet_ohm_km: wet, dry_ohm_km: dry, mean_width: run.mean_width });
        }
    }
    all
}

fn outside() -> Vec<Outside> {
    let mut all = Vec::new();
    for arrangement in ['a', 'b', 'c'] {
        let calibration = calibration(arrangement, (5.0, 20.0));
        for ohm_km in [
            1.0, 1.5, 2.0, 2.5, 3.0, 3.5, 4.0, 4.5, 5.0, 7.0, 10.0, 14.0, 20.0, 22.0, 25.0, 30.0, 35.0, 40.0, 50.0,
            70.0, 100.0,
        ] {
            let run = run(&calibration, arrangement, ohm_km, Odometry::With);
            let kept = Points(run.points.iter().take_while(|point| point.interval.is_some()).copied().collect());
            #[allow(clippy::cast_precision_loss, reason = "200 cycles")]
            let wrong_if_kept = kept.wrong() as f64 / run.points.len() as f64;
            all.push(Outside { arrangement, ohm_km, answered: run.answered, wrong: run.wrong, wrong_if_kept });
        }
    }
    all
}

#[cfg(test)]
mod tests;
