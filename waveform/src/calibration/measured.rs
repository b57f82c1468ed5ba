//! From measured level differences of a railway's own line to the table that the kernel reads.
//!
//! A *pass* is one run over the section in one weather. Through each pass goes a broken line with its corners at the
//! table's knots: least squares, rising. The table's curves are the lowest and the highest of these lines at each knot,
//! and as much wider as the lines themselves are uncertain there.
//!
//! *The spread of a line.* With hat functions as columns of A, the normal matrix AᵀA has its inverse C, and a knot of
//! the line is known to s·√C_kk (one standard deviation), s² being the residuals' sum of squares over their degrees of
//! freedom. The curves are [`DEVIATIONS`] of them wider. This supposes that the errors of two measurements have nothing
//! to do with each other.
//!
//! *Rising.* Where the line of a pass falls from one knot to a later one by more than [`DEVIATIONS`] of that fall, the
//! measurements contradict the principle and are refused. A fall within the spread is levelled: the knots become one
//! (pooling of adjacent violators), and the line is fitted again. The curves rise by 0.01 dB a knot at least, and are
//! wider for it where they must.
//!
//! *The tolerance.* A difference is two levels, and the kernel takes each to be off by the tolerance. So twice the
//! tolerance is the largest residual, or [`DEVIATIONS`] times their root mean square if that is more.
//!
//! *The ends.* A knot is a part of the table if the measurements reach it in every pass. What is nearer and what is
//! farther is made flat, and there the position is unknown (POS-6, POS-7). With [`Wanted::section`] no train that hears
//! the transmitter is beyond the section's far end: there the curves rise out of the way, so that in wet weather, too,
//! an interval ends with the section.

use super::{KNOTS, ROUNDING, millibels};
use crate::rail::{Decibels, Metres};
use atc_kernel::position::{Millibels, Spacing, Table, TableError};
use std::fmt;

mod picture;
mod sides;
mod solve;
#[cfg(test)]
mod tests;

pub use picture::picture;
pub use sides::{CHANGES, Side, Without, sides};

/// Standard deviations that are taken for certain: a normal error is beyond them once in 16 000 times.
pub const DEVIATIONS: f64 = 4.0;
/// The least standard deviation of a difference, dB: both levels are rounded to 0.01 dB.
const LEAST_SPREAD: f64 = 0.0041;
/// Measurements that each pass must have for each knot of its line.
const FOR_EACH_KNOT: usize = 2;
/// Spans that a table must have at least.
const LEAST_SPANS: usize = 2;
/// A measurement is remarkable if it is off by so many times the median residual, and by [`REMARKABLE_DB`].
const REMARKABLE: f64 = 8.0;
/// By how much, dB.
const REMARKABLE_DB: f64 = 0.1;

/// One measurement: both levels at one place, as their difference.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Measurement {
    /// Distance of the antenna to the transmitter ahead, metres, 0 or more.
    pub distance: Metres,
    /// Level of the signal that the rail attenuates less, less the level of the other one, within ±300 dB.
    pub difference: Decibels,
}

/// What is wished of a table.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Wanted {
    /// The distance between two knots; without it the least one with which the table reaches the end.
    pub spacing: Option<Spacing>,
    /// The length of the section, metres, if no train beyond its far end can hear the transmitter.
    pub section: Option<Metres>,
}

/// Measurements that make no table. Passes and measurements are told by their places in what was given.
#[derive(Clone, Debug, PartialEq)]
pub enum FitError {
    /// There is no measurement.
    Nothing,
    /// The section is not within the measurements of this pass, which end at the distance.
    Section {
        /// The pass.
        pass: usize,
        /// Its farthest measurement.
        measurement: usize,
        /// The distance of that.
        reached: Metres,
        /// The section's length.
        section: Metres,
    },
    /// With this spacing the table ends before the section does, or no spacing reaches that far.
    Reach {
        /// The spacing, metres.
        spacing: Metres,
        /// How far it must reach.
        needed: Metres,
    },
    /// The distances that all passes have in common are less than two spans.
    Short {
        /// The nearest common distance.
        from: Metres,
        /// The farthest one.
        to: Metres,
        /// The spacing, metres.
        spacing: Metres,
    },
    /// A pass has too few measurements for its line.
    Few {
        /// The pass.
        pass: usize,
        /// How many there are within the table.
        found: usize,
        /// How many are needed.
        needed: usize,
        /// The spacing, metres.
        spacing: Metres,
    },
    /// In a span of the table a pass was measured at fewer than two distances.
    Gap {
        /// The pass.
        pass: usize,
        /// The last measurement before the gap, if there is one.
        before: Option<usize>,
        /// The first one after it.
        after: Option<usize>,
        /// The span's ends.
        from: Metres,
        /// The farther one.
        to: Metres,
        /// At how many distances it was measured.
        found: usize,
    },
    /// The difference falls by more than the spread explains.
    Falls {
        /// The pass.
        pass: usize,
        /// The measurement that is farthest from any line that rises.
        measurement: usize,
        /// Where the fall begins.
        from: Metres,
        /// Where it ends.
        to: Metres,
        /// By how much it falls.
        fall: Decibels,
        /// How much of that the spread explains.
        explained: Decibels,
    },
    /// Over the whole table the difference of a pass rises by no more than the spread explains.
    Flat {
        /// The pass.
        pass: usize,
        /// By how much it rises.
        rise: Decibels,
        /// How much of that the spread explains.
        explained: Decibels,
    },
    /// A curve is not within ±300 dB.
    TooWide {
        /// The knot, 0 to 16.
        knot: usize,
    },
    /// The kernel refuses the table.
    Table(TableError),
}

impl fmt::Display for FitError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Nothing => write!(f, "there is no measurement; a table needs {LEAST_SPANS} spans or more"),
            Self::Section { reached, section, .. } => write!(
                f,
                "the measurements end at {} m, and the section at {} m; they must reach its far end",
                reached.0, section.0
            ),
            Self::Reach { spacing, needed } => write!(
                f,
                "with {} m between its knots a table ends before {} m; a spacing of up to 204.8 m reaches 3072 m",
                spacing.0, needed.0
            ),
            Self::Short { from, to, spacing } => write!(
                f,
                "what every pass covers, {} to {} m, is less than {LEAST_SPANS} spans of {} m: \
                 measure farther, or choose a smaller spacing",
                from.0, to.0, spacing.0
            ),
            Self::Few { found, needed, spacing, .. } => write!(
                f,
                "{found} measurements within the table; with {} m between its knots {needed} are needed: \
                 measure at more places, or choose a greater spacing",
                spacing.0
            ),
            Self::Gap { from, to, found, .. } => write!(
                f,
                "a gap: from {} to {} m there {} measured; every span needs two: measure there, or choose a greater \
                 spacing",
                from.0,
                to.0,
                match found {
                    0 => "is nothing".to_owned(),
                    1 => "is one distance".to_owned(),
                    _ => format!("are {found} distances"),
                }
            ),
            Self::Falls { from, to, fall, explained, .. } => write!(
                f,
                "from {} to {} m the difference falls by {:.2} dB, and the spread of the measurements explains {:.2} dB; it \
                 must rise with the distance: check this measurement, and that the first signal is the one that the \
                 rail attenuates less",
                from.0, to.0, fall.0, explained.0
            ),
            Self::Flat { rise, explained, .. } => write!(
                f,
                "over the whole table the difference rises by {:.2} dB, and the spread of the measurements explains {:.2} dB: no \
                 distance can be told; frequencies farther apart, or levels measured more closely, are needed",
                rise.0, explained.0
            ),
            Self::TooWide { knot } => write!(
                f,
                "at knot {knot} a curve is beyond 300 dB: the measurements near it do not agree with each other"
            ),
            Self::Table(TableError::Crossed(knot)) => {
                write!(f, "at knot {knot} the lowest difference is above the highest")
            }
            Self::Table(TableError::NowhereRising) => write!(
                f,
                "nowhere does the difference rise by 0.01 dB from knot to knot: frequencies farther apart or a greater \
                 spacing are needed"
            ),
        }
    }
}

impl std::error::Error for FitError {}

/// The line through one pass.
#[derive(Clone, Debug, PartialEq)]
pub struct PassFit {
    /// The difference at the knots from [`Fit::first`] to [`Fit::last`], dB.
    pub knots: Vec<f64>,
    /// Measured less fitted, dB, for each measurement within the table, with its place in what was given.
    pub residuals: Vec<(usize, f64)>,
    /// One standard deviation of a measurement, dB.
    pub deviation: f64,
    /// Whether some knots had to be levelled.
    pub levelled: bool,
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

/// The distance of a knot, metres: whole decimetres, so that it is written as it is.
fn at_knot(spacing: Spacing, knot: usize) -> f64 {
    f64::from(spacing.decimetres().saturating_mul(u32::try_from(knot).unwrap_or(u32::MAX))) / 10.0
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

/// The knots that are measured.
#[derive(Clone, Copy)]
struct Grid {
    spacing: Spacing,
    first: usize,
    last: usize,
}

impl Grid {
    fn count(self) -> usize {
        self.last - self.first + 1
    }

    /// The distance between two, metres.
    fn span(self) -> f64 {
        at_knot(self.spacing, 1)
    }

    fn distance(self, knot: usize) -> f64 {
        at_knot(self.spacing, knot)
    }

    /// The span of a distance, counted from the first knot, and the part of it that is gone by.
    #[allow(clippy::cast_precision_loss, clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "0 to 15")]
    fn place(self, distance: f64) -> (usize, f64) {
        let spans = (distance - self.distance(self.first)) / self.span();
        let k = (spans.max(0.0) as usize).min(self.count() - 2);
        (k, spans - k as f64)
    }

    /// The line through one pass, and one standard deviation of each of its knots.
    fn line(self, number: usize, pass: &[Measurement]) -> Result<(PassFit, Vec<f64>), FitError> {
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
        let normal = solve::Normal::new(self.count(), rows);
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
    fn table(self, lowest: &[f64], highest: &[f64], bounded: Option<Millibels>) -> Result<Table, FitError> {
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
