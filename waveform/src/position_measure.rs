//! Measurements of the train's position: error and width of the kernel's interval, by weather, arrangement and odometer.
//!
//! [`bench()`] runs trains through a section of 400 m on line theory's ground ([`crate::position_run`]), with measurement errors
//! spread evenly over the tolerance, and gives everything as numbers; [`plots`] draws them. The same run gives the same
//! numbers every time.

use crate::calibration::{Arrangement, Calibration};
use crate::position_run::{Ballast, Site, reading};
use crate::rail::chain::{Piece, loss};
use crate::rail::{Decibels, Hertz, Metres, OhmKilometres};
use drive::{ANY_WEATHER, Points, SECTION, SEED, TOLERANCE, calibration, drive, kernel, line};
use rand::{Rng, SeedableRng};
use rand_pcg::Pcg64Mcg;

mod drive;
mod reflections;
mod results;
mod samples;

pub use crate::measure::Extent;
pub use crate::position_plot::plots;
pub use results::{Limits, LineCurve, MeterPoint, Odometry, Outside, Point, PositionBench, Reflection, Run};

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
