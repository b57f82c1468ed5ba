//! A table fitted to passes, with its residuals.

use super::error::{FitError, LEAST_SPANS};
use super::grid::{Grid, at_knot};
use super::pass::{DEVIATIONS, Measurement, PassFit};
use crate::calibration::{KNOTS, ROUNDING, millibels};
use crate::rail::{Decibels, Metres};
use atc_kernel::position::{Millibels, Spacing, Table};

/// A measurement is remarkable if it is off by so many times the median residual, and by [`REMARKABLE_DB`].
const REMARKABLE: f64 = 8.0;
/// By how much, dB.
const REMARKABLE_DB: f64 = 0.1;

/// What is wished of a table.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Wanted {
    /// The distance between two knots; without it the least one with which the table reaches the end.
    pub spacing: Option<Spacing>,
    /// The length of the section, metres, if no train beyond its far end can hear the transmitter.
    pub section: Option<Metres>,
}

/// A table that was measured.
#[derive(Clone, Debug, PartialEq)]
pub struct Fit {
    /// What the kernel reads.
    pub table: Table,
    /// By how much a level may be off.
    pub tolerance: Millibels,
    /// The first knot that measurements reach.
    pub first: usize,
    /// The last one; in a section the first one at or beyond its end.
    pub last: usize,
    /// The nearest distance that every pass has.
    pub from: Metres,
    /// The farthest distance at which the table says something that was measured.
    pub to: Metres,
    /// Whether trains beyond `to` are excluded, as [`Wanted::section`] says.
    pub bounded: bool,
    /// One for each pass.
    pub passes: Vec<PassFit>,
}

/// Root mean square and largest of residuals.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Residuals {
    /// Root mean square, dB.
    pub rms: Decibels,
    /// The largest, with its sign, dB.
    pub largest: Decibels,
    /// Whose it is: the place of its pass, and of the measurement in it.
    pub at: (usize, usize),
    /// How many there are.
    pub count: usize,
}

impl Fit {
    /// Fits a table to one or more passes.
    ///
    /// # Errors
    /// See [`FitError`]. Distances or differences that are not in their ranges are not looked for: what is no number
    /// gives no table.
    pub fn new(passes: &[Vec<Measurement>], wanted: Wanted) -> Result<Self, FitError> {
        let (from, measured) = common(passes)?;
        if let Some(section) = wanted.section {
            within_section(passes, section)?;
        }
        let to = wanted.section.map_or(measured, |section| section.0.min(measured));
        let spacing = match wanted.spacing {
            Some(spacing) => spacing,
            None => least_spacing(to, wanted.section.is_some())?,
        };
        let span = f64::from(spacing.decimetres()) / 10.0;
        // Up to half a span before the first measurement the straight line of the first span goes on.
        let first = if from <= span / 2.0 { 0 } else { knot(from / span, f64::ceil) };
        let last = match wanted.section {
            None => knot(to / span, f64::floor).min(KNOTS - 1),
            Some(_) => knot(to / span, f64::ceil),
        };
        if last >= KNOTS - usize::from(wanted.section.is_some()) {
            return Err(FitError::Reach { spacing: Metres(span), needed: Metres(to) });
        }
        if last < first + LEAST_SPANS {
            return Err(FitError::Short { from: Metres(from), to: Metres(to), spacing: Metres(span) });
        }
        let grid = Grid { spacing, first, last };
        let mut lines = Vec::new();
        let (mut lowest, mut highest) = (vec![f64::INFINITY; grid.count()], vec![f64::NEG_INFINITY; grid.count()]);
        for (number, pass) in passes.iter().enumerate() {
            let (line, spreads) = grid.line(number, pass)?;
            for (k, (value, spread)) in line.knots.iter().zip(spreads).enumerate() {
                lowest[k] = lowest[k].min(value - DEVIATIONS * spread);
                highest[k] = highest[k].max(value + DEVIATIONS * spread);
            }
            lines.push(line);
        }
        let residuals = summary(&lines).ok_or(FitError::Nothing)?;
        let off = residuals.largest.0.abs().max(DEVIATIONS * residuals.rms.0);
        let tolerance =
            millibels((off * 100.0 / 2.0 - ROUNDING).ceil().max(1.0)).ok_or(FitError::TooWide { knot: first })?;
        let table = grid.table(&lowest, &highest, wanted.section.map(|_| tolerance))?;
        let to = wanted.section.map_or(Metres(grid.distance(last)), |_| Metres(to));
        let bounded = wanted.section.is_some();
        Ok(Self { table, tolerance, first, last, from: Metres(from), to, bounded, passes: lines })
    }

    /// The distance of a knot.
    pub fn distance(&self, knot: usize) -> Metres {
        Metres(at_knot(self.table.spacing(), knot))
    }

    /// Where the table begins to tell a position.
    pub fn nearest(&self) -> Metres {
        self.distance(self.first)
    }

    /// The line of a pass at a distance between [`Self::first`] and [`Self::last`], dB.
    pub fn line(&self, pass: usize, distance: Metres) -> Option<Decibels> {
        let knots = &self.passes.get(pass)?.knots;
        let grid = Grid { spacing: self.table.spacing(), first: self.first, last: self.last };
        let (k, part) = grid.place(distance.0);
        Some(Decibels(knots.get(k)? * (1.0 - part) + knots.get(k + 1)? * part))
    }

    /// All residuals.
    pub fn residuals(&self) -> Residuals {
        let none = Residuals { rms: Decibels(0.0), largest: Decibels(0.0), at: (0, 0), count: 0 };
        summary(&self.passes).unwrap_or(none)
    }

    /// Those of one pass.
    pub fn residuals_of(&self, pass: usize) -> Option<Residuals> {
        let one = summary(self.passes.get(pass..=pass)?)?;
        Some(Residuals { at: (pass, one.at.1), ..one })
    }

    /// Measurements that stand out from all others of their pass: the pass, the measurement and its residual.
    pub fn remarkable(&self) -> Vec<(usize, usize, Decibels)> {
        let mut all = Vec::new();
        for (number, pass) in self.passes.iter().enumerate() {
            let mut sizes: Vec<f64> = pass.residuals.iter().map(|(_, residual)| residual.abs()).collect();
            sizes.sort_by(f64::total_cmp);
            let median = sizes.get(sizes.len() / 2).copied().unwrap_or(0.0);
            let bound = (REMARKABLE * median).max(REMARKABLE_DB);
            let standing = pass.residuals.iter().filter(|(_, residual)| residual.abs() > bound);
            all.extend(standing.map(|&(place, residual)| (number, place, Decibels(residual))));
        }
        all
    }
}

/// Root mean square over the degrees of freedom that the lines leave, and the largest.
#[allow(clippy::cast_precision_loss, reason = "measurements of one section")]
fn summary(lines: &[PassFit]) -> Option<Residuals> {
    let all = || {
        let of = |(pass, line): (usize, &'_ PassFit)| {
            line.residuals.iter().map(move |&(place, residual)| (pass, place, residual)).collect::<Vec<_>>()
        };
        lines.iter().enumerate().flat_map(of)
    };
    let count = all().count();
    let parameters: usize = lines.iter().map(|line| line.knots.len()).sum();
    let squares: f64 = all().map(|(_, _, residual)| residual * residual).sum();
    let (pass, place, largest) = all().max_by(|a, b| a.2.abs().total_cmp(&b.2.abs()))?;
    let rms = Decibels((squares / count.saturating_sub(parameters).max(1) as f64).sqrt());
    Some(Residuals { rms, largest: Decibels(largest), at: (pass, place), count })
}

/// A knot's number from its distance in spans; beyond the table it is one that no table has.
#[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a cast from float saturates")]
fn knot(spans: f64, round: fn(f64) -> f64) -> usize {
    // A survey knows no distance to a millionth of a span.
    let nearest = spans.round();
    (if (spans - nearest).abs() < 1e-6 { nearest } else { round(spans) }) as usize
}

/// The distances that every pass has.
fn common(passes: &[Vec<Measurement>]) -> Result<(f64, f64), FitError> {
    let (mut from, mut to) = (0.0_f64, f64::INFINITY);
    for pass in passes {
        let distances = || pass.iter().map(|measurement| measurement.distance.0);
        from = from.max(distances().fold(f64::INFINITY, f64::min));
        to = to.min(distances().fold(f64::NEG_INFINITY, f64::max));
    }
    if from.is_finite() && to.is_finite() { Ok((from, to)) } else { Err(FitError::Nothing) }
}

/// Every pass must reach the section's far end.
fn within_section(passes: &[Vec<Measurement>], section: Metres) -> Result<(), FitError> {
    for (number, pass) in passes.iter().enumerate() {
        let farthest = pass.iter().enumerate().max_by(|a, b| a.1.distance.0.total_cmp(&b.1.distance.0));
        if let Some((place, measurement)) = farthest.filter(|(_, measurement)| measurement.distance.0 < section.0) {
            let reached = measurement.distance;
            return Err(FitError::Section { pass: number, measurement: place, reached, section });
        }
    }
    Ok(())
}

/// The least spacing with which a table reaches a distance; in a section one more knot is needed.
fn least_spacing(to: f64, section: bool) -> Result<Spacing, FitError> {
    let spans = if section { 15.0 } else { 16.0 };
    let mut all = (4..=11).filter_map(Spacing::new);
    let reaches = |spacing: &Spacing| spans * f64::from(spacing.decimetres()) / 10.0 >= to;
    let far = FitError::Reach { spacing: Metres(204.8), needed: Metres(to) };
    match all.find(reaches) {
        Some(spacing) => Ok(spacing),
        // Without a section, what lies beyond is left out.
        None if !section => Spacing::new(11).ok_or(far),
        None => Err(far),
    }
}
