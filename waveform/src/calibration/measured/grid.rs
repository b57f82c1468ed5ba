//! The knots that are measured: the line through a pass, and the table of all lines.

use super::error::FitError;
use super::pass::{DEVIATIONS, Measurement, PassFit};
use super::solve::Normal;
use crate::calibration::{KNOTS, ROUNDING, millibels};
use crate::rail::{Decibels, Metres};
use atc_kernel::position::{Millibels, Spacing, Table};

/// The least standard deviation of a difference, dB: both levels are rounded to 0.01 dB.
const LEAST_SPREAD: f64 = 0.0041;
/// Measurements that each pass must have for each knot of its line.
const FOR_EACH_KNOT: usize = 2;

/// The knots that are measured.
#[derive(Clone, Copy)]
pub(super) struct Grid {
    pub(super) spacing: Spacing,
    pub(super) first: usize,
    pub(super) last: usize,
}

impl Grid {
    pub(super) fn count(self) -> usize {
        self.last - self.first + 1
    }

    /// The distance between two, metres.
    fn span(self) -> f64 {
        at_knot(self.spacing, 1)
    }

    pub(super) fn distance(self, knot: usize) -> f64 {
        at_knot(self.spacing, knot)
    }

    /// The span of a distance, counted from the first knot, and the part of it that is gone by.
    #[allow(clippy::cast_precision_loss, clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "0 to 15")]
    pub(super) fn place(self, distance: f64) -> (usize, f64) {
        let spans = (distance - self.distance(self.first)) / self.span();
        let k = (spans.max(0.0) as usize).min(self.count() - 2);
        (k, spans - k as f64)
    }

    /// The line through one pass, and one standard deviation of each of its knots.
    pub(super) fn line(self, number: usize, pass: &[Measurement]) -> Result<(PassFit, Vec<f64>), FitError> {
        let (near, far) = (self.distance(self.first), self.distance(self.last));
        let used: Vec<(usize, f64, f64)> = pass
            .iter()
            .enumerate()
            .map(|(place, measurement)| (place, measurement.distance.0, measurement.difference.0))
            .filter(|(_, distance, _)| (near..=far).contains(distance))
            .collect();
        self.no_gap(number, &used)?;
        let needed = FOR_EACH_KNOT * self.count();
        if used.len() < needed {
            return Err(FitError::Few { pass: number, found: used.len(), needed, spacing: Metres(self.span()) });
        }
        let rows = used.iter().map(|&(_, distance, difference)| {
            let (k, part) = self.place(distance);
            (k, part, difference)
        });
        let normal = Normal::new(self.count(), rows);
        let (Some(free), Some(inverse)) = (normal.solve(), normal.inverse()) else {
            return Err(FitError::Few { pass: number, found: used.len(), needed, spacing: Metres(self.span()) });
        };
        let at = |knots: &[f64], distance: f64| {
            let (k, part) = self.place(distance);
            knots[k] * (1.0 - part) + knots[k + 1] * part
        };
        let squares: f64 = used.iter().map(|&(_, x, y)| (y - at(&free, x)).powi(2)).sum();
        #[allow(clippy::cast_precision_loss, reason = "measurements of one section")]
        let deviation = (squares / (used.len() - self.count()) as f64).sqrt().max(LEAST_SPREAD);
        let rising = normal.rising().ok_or(FitError::Nothing)?;
        for from in 0..self.count() {
            for to in from + 1..self.count() {
                let fall = free[from] - free[to];
                let variance = inverse[from][from] + inverse[to][to] - 2.0 * inverse[from][to];
                let explained = DEVIATIONS * deviation * variance.max(0.0).sqrt();
                if fall > explained {
                    let (start, end) = (self.distance(self.first + from), self.distance(self.first + to));
                    let worst = used
                        .iter()
                        .filter(|(_, distance, _)| (start - self.span()..=end + self.span()).contains(distance))
                        .max_by(|a, b| (a.2 - at(&rising, a.1)).abs().total_cmp(&(b.2 - at(&rising, b.1)).abs()));
                    return Err(FitError::Falls {
                        pass: number,
                        measurement: worst.map_or(0, |(place, _, _)| *place),
                        from: Metres(start),
                        to: Metres(end),
                        fall: Decibels(fall),
                        explained: Decibels(explained),
                    });
                }
            }
        }
        let end = self.count() - 1;
        let variance = inverse[0][0] + inverse[end][end] - 2.0 * inverse[0][end];
        let (rise, explained) = (free[end] - free[0], DEVIATIONS * deviation * variance.max(0.0).sqrt());
        if rise <= explained {
            return Err(FitError::Flat { pass: number, rise: Decibels(rise), explained: Decibels(explained) });
        }
        let spreads = (0..self.count()).map(|k| deviation * inverse[k][k].max(0.0).sqrt()).collect();
        let residuals = used.iter().map(|&(place, x, y)| (place, y - at(&rising, x))).collect();
        let levelled = free.windows(2).any(|pair| pair[0] > pair[1]);
        Ok((PassFit { knots: rising, residuals, deviation, levelled }, spreads))
    }

    /// Every span must have been measured at two distances at least.
    fn no_gap(self, number: usize, used: &[(usize, f64, f64)]) -> Result<(), FitError> {
        for k in self.first..self.last {
            let (from, to) = (self.distance(k), self.distance(k + 1));
            let mut inside: Vec<f64> =
                used.iter().map(|(_, distance, _)| *distance).filter(|x| (from..=to).contains(x)).collect();
            inside.sort_by(f64::total_cmp);
            inside.dedup_by(|a, b| (*a - *b).abs() < self.span() * 1e-3);
            if inside.len() >= 2 {
                continue;
            }
            let middle = f64::midpoint(from, to);
            let nearest = |after: bool| {
                used.iter()
                    .filter(|(_, distance, _)| (*distance > middle) == after)
                    .min_by(|a, b| (a.1 - middle).abs().total_cmp(&(b.1 - middle).abs()))
                    .map(|(place, _, _)| *place)
            };
            return Err(FitError::Gap {
                pass: number,
                before: nearest(false),
                after: nearest(true),
                from: Metres(from),
                to: Metres(to),
                found: inside.len(),
            });
        }
        Ok(())
    }

    /// The kernel's table; `bounded` is the tolerance where no train is beyond the last knot.
    pub(super) fn table(self, lowest: &[f64], highest: &[f64], bounded: Option<Millibels>) -> Result<Table, FitError> {
        let (mut low, mut high) = ([Millibels(0); KNOTS], [Millibels(0); KNOTS]);
        for ((k, least), most) in (self.first..).zip(lowest).zip(highest) {
            let wide = FitError::TooWide { knot: k };
            low[k] = millibels((least * 100.0 - ROUNDING).floor()).ok_or_else(|| wide.clone())?;
            high[k] = millibels((most * 100.0 + ROUNDING).ceil()).ok_or(wide)?;
        }
        // The kernel finds distances only where both curves rise. What is uncertain at one knot must not make a curve
        // fall behind it: so it is wider there, never narrower.
        for k in (self.first..self.last).rev() {
            low[k].0 = low[k].0.min(low[k + 1].0.saturating_sub(1));
        }
        for k in self.first..self.last {
            high[k + 1].0 = high[k + 1].0.max(high[k].0.saturating_add(1));
        }
        // Outside the measured knots they are flat, or out of the way.
        let top = high[self.last].0;
        for k in 0..KNOTS {
            if k < self.first {
                (low[k], high[k]) = (low[self.first], high[self.first]);
            } else if let (true, Some(tolerance)) = (k > self.last, bounded) {
                // Above all that a train in the section can measure: its difference, and twice what both levels may be
                // off.
                let above = i16::try_from(k - self.last).unwrap_or(0);
                low[k].0 = top.saturating_add(tolerance.0.saturating_mul(4)).saturating_add(above);
                high[k] = low[k];
            } else if k > self.last {
                (low[k], high[k]) = (low[self.last], high[self.last]);
            }
        }
        Table::new(self.spacing, low, high).map_err(FitError::Table)
    }
}

/// The distance of a knot, metres: whole decimetres, so that it is written as it is.
pub(super) fn at_knot(spacing: Spacing, knot: usize) -> f64 {
    f64::from(spacing.decimetres().saturating_mul(u32::try_from(knot).unwrap_or(u32::MAX))) / 10.0
}
