//! On which side an interval is wrong where the rails are not those that were measured: the kernel itself, on the table
//! that was fitted, with errors that are the measurements' own residuals.

use super::fit::Fit;
use crate::calibration::millibels;
use crate::rail::Metres;
use atc_kernel::position::{Correction, Measured, Millibels, Moved, Position, step};
use rand::{Rng, SeedableRng};
use rand_pcg::Pcg64Mcg;

/// By how many per cent more steeply the difference rises than it was measured.
pub const CHANGES: [f64; 13] = [-50.0, -20.0, -10.0, -5.0, -2.0, -1.0, 0.0, 1.0, 2.0, 5.0, 10.0, 20.0, 50.0];
/// Places at which a train stands, evenly over the measured distances, and how often at each.
const PLACES: u32 = 200;
const DRAWS: u32 = 5;
const SEED: u64 = 4_045_174;

/// Intervals that do not contain the train.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Without {
    /// How many.
    pub count: u32,
    /// By how much at most, metres.
    pub most_m: f64,
}

impl Without {
    fn note(&mut self, metres: f64) {
        if metres > 0.0 {
            self.count += 1;
            self.most_m = self.most_m.max(metres);
        }
    }
}

/// What the kernel says where the rails are otherwise.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Side {
    /// How much more steeply the difference rises, in per cent, against the steepest pass; where it is negative,
    /// against the flattest one.
    pub change_percent: f64,
    /// How often the kernel was asked.
    pub asked: u32,
    /// How often it gave an interval.
    pub answered: u32,
    /// The whole interval is farther from the transmitter than the train: the train is nearer to its stopping point
    /// than it thinks.
    pub beyond: Without,
    /// The whole interval is nearer than the train: it brakes too early.
    pub before: Without,
    /// The mean width of an interval, metres.
    pub mean_width_m: f64,
}

/// Asks the kernel for each of [`CHANGES`]. `floor`: the lowest level that is no noise. Each cycle counts for itself,
/// without an odometer.
pub fn sides(fit: &Fit, floor: Millibels) -> Vec<Side> {
    let Some(position) = Position::new(fit.table, fit.tolerance, floor, Correction::NONE) else { return Vec::new() };
    let residuals: Vec<f64> =
        fit.passes.iter().flat_map(|pass| pass.residuals.iter().map(|(_, residual)| *residual)).collect();
    if residuals.is_empty() {
        return Vec::new();
    }
    CHANGES.map(|change| side(fit, &position, &residuals, change)).to_vec()
}

fn side(fit: &Fit, position: &Position, residuals: &[f64], change: f64) -> Side {
    let mut random = Pcg64Mcg::seed_from_u64(SEED);
    let none = Without::default();
    let mut side =
        Side { change_percent: change, asked: 0, answered: 0, beyond: none, before: none, mean_width_m: 0.0 };
    let (near, far) = (fit.nearest().0.max(fit.from.0), fit.to.0);
    for place in 0..PLACES {
        let truth = near + (far - near) * (f64::from(place) + 0.5) / f64::from(PLACES);
        for _ in 0..DRAWS {
            let Some(difference) = changed(fit, Metres(truth), change) else { continue };
            let error = residuals[random.random_range(0..residuals.len())];
            side.asked += 1;
            let Some(measured) = levels(position.floor(), difference + error) else { continue };
            let Some(interval) = step(position, None, measured) else { continue };
            let [nearest, farthest] = [interval.nearest(), interval.farthest()].map(|end| f64::from(end.0) / 1000.0);
            side.answered += 1;
            side.mean_width_m += farthest - nearest;
            side.beyond.note(nearest - truth);
            side.before.note(truth - farthest);
        }
    }
    side.mean_width_m /= f64::from(side.answered.max(1));
    side
}

/// The difference of the steepest or the flattest pass at a distance, rising by so many per cent more from the
/// transmitter on.
fn changed(fit: &Fit, distance: Metres, change: f64) -> Option<f64> {
    let lines = (0..fit.passes.len()).filter_map(|pass| {
        let knots = &fit.passes[pass].knots;
        let [start, next, ..] = knots[..] else { return None };
        let spans = fit.distance(fit.first).0 / fit.distance(1).0;
        let at_transmitter = start - (next - start) * spans;
        let here = fit.line(pass, distance)?.0;
        Some(at_transmitter + (here - at_transmitter) * (1.0 + change / 100.0))
    });
    if change < 0.0 { lines.reduce(f64::min) } else { lines.reduce(f64::max) }
}

/// Two levels with this difference, the lower one at the floor.
fn levels(floor: Millibels, difference: f64) -> Option<Measured> {
    let difference = millibels((difference * 100.0).round())?.0;
    let (first, second) = if difference >= 0 {
        (floor.0.checked_add(difference)?, floor.0)
    } else {
        (floor.0, floor.0.checked_sub(difference)?)
    };
    Some(Measured { first: Some(Millibels(first)), second: Some(Millibels(second)), moved: Moved::STANDING })
}
