//! One train through the section: line, table and device, and what the kernel says on the way.

use super::results::{Odometry, Point, Run};
use crate::calibration::{Arrangement, Calibration, Ground, Plan, Weather};
use crate::position_run::{Odometer, device};
use crate::rail::{Decibels, Hertz, Line, Metres, OhmKilometres, Rails};
use atc_kernel::position::{Correction, Interval, Measured, Millibels, Position, step};

/// By how much a level may be off: 0.1 dB, which [`MeterPoint`] shows to be kept from 30 dB of signal over noise.
pub(super) const TOLERANCE: Millibels = Millibels(10);
/// The section's length, metres.
pub(super) const SECTION: f64 = 400.0;
/// Metres in one cycle: 20 m/s, ten cycles a second.
pub(super) const CYCLE: f64 = 2.0;
/// The odometer is known to 2 % and counts 1 % too much.
pub(super) const ODOMETER: Odometer = Odometer { scale: 1.01, bound: 0.02 };
pub(super) const SEED: u64 = 4_045_174;
/// The limits of "any weather": 2 to 50 Ω·km.
pub(super) const ANY_WEATHER: (f64, f64) = (2.0, 50.0);

pub(super) fn line(ohm_km: f64) -> Line {
    Line::new(Rails::default(), OhmKilometres(ohm_km)).expect("a usual track")
}

pub(super) fn calibration(arrangement: char, (wet, dry): (f64, f64)) -> Calibration {
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

pub(super) fn kernel(calibration: &Calibration) -> Position {
    device(calibration, TOLERANCE, Millibels(0), Correction::NONE).expect("a tolerance over 0")
}

fn metres(interval: Interval) -> [f64; 2] {
    [interval.nearest(), interval.farthest()].map(|end| f64::from(end.0) / 1000.0)
}

/// What the kernel says while a train runs from one end of the section to the other.
pub(super) fn drive(
    position: &Position,
    odometer: Odometry,
    mut read: impl FnMut(f64) -> [Option<Millibels>; 2],
) -> Points {
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

pub(super) struct Points(pub(super) Vec<Point>);

impl Points {
    /// Intervals that do not contain the train.
    pub(super) fn wrong(&self) -> usize {
        let missed =
            |p: &&Point| p.interval.is_some_and(|[nearest, farthest]| !(nearest..=farthest).contains(&p.truth));
        self.0.iter().filter(missed).count()
    }

    #[allow(clippy::cast_precision_loss, reason = "200 cycles")]
    pub(super) fn into_run(self, arrangement: char, ohm_km: f64, odometer: Odometry) -> Run {
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
