//! The picture of a fit: the measurements with the table around them, and what the lines leave.

use super::fit::Fit;
use super::pass::Measurement;
use crate::plot::{Axis, COLOURS, Chart, Legend, PlotError, Scale, Series, Style, draw};
use crate::rail::Metres;

/// Measurements, lines, the table's band and, below, the residuals with twice the tolerance, as SVG. `names` are those
/// of the passes.
///
/// # Errors
/// [`PlotError`] if it cannot be drawn.
pub fn picture(fit: &Fit, passes: &[Vec<Measurement>], names: &[String]) -> Result<String, PlotError> {
    let measured = passes.iter().flatten().map(|measurement| measurement.distance.0);
    let end = measured.fold(fit.distance(fit.last).0, f64::max);
    let off = 2.0 * f64::from(fit.tolerance.0) / 100.0;
    draw(&[differences(fit, passes, names, end), residuals(fit, passes, names, end, off)], 900, 1000)
}

fn differences(fit: &Fit, passes: &[Vec<Measurement>], names: &[String], end: f64) -> Chart {
    let knots = fit.first..=fit.last;
    let curve = |levels: &[atc_kernel::position::Millibels]| -> Vec<(f64, f64)> {
        knots.clone().map(|k| (fit.distance(k).0, f64::from(levels[k].0) / 100.0)).collect()
    };
    let (lowest, highest) = (curve(fit.table.lowest()), curve(fit.table.highest()));
    let around: Vec<_> = lowest.iter().copied().chain(highest.iter().rev().copied()).collect();
    let edge = |points: Vec<(f64, f64)>| Series { name: String::new(), colour: 6, style: Style::Line, points };
    let mut series = vec![
        Series { name: "table: lowest to highest".into(), colour: 6, style: Style::Area, points: around },
        edge(lowest),
        edge(highest),
    ];
    let (mut least, mut most) = (f64::INFINITY, f64::NEG_INFINITY);
    for (number, pass) in passes.iter().enumerate() {
        let points: Vec<_> = pass.iter().map(|m| (m.distance.0, m.difference.0)).collect();
        least = points.iter().fold(least, |least, point| least.min(point.1));
        most = points.iter().fold(most, |most, point| most.max(point.1));
        let line = knots.clone().filter_map(|k| Some((fit.distance(k).0, fit.line(number, fit.distance(k))?.0)));
        let line = line.collect();
        series.push(Series { name: String::new(), colour: colour(number), style: Style::Thin, points: line });
        series.push(Series { name: name(names, number), colour: colour(number), style: Style::Points, points });
    }
    for points in [&series[1].points, &series[2].points] {
        least = points.iter().fold(least, |least, point| least.min(point.1));
        most = points.iter().fold(most, |most, point| most.max(point.1));
    }
    let room = (most - least).max(0.1) * 0.08;
    Chart {
        title: "Level difference over the distance: measured, fitted, and the table".into(),
        x: Axis::new("distance to the transmitter ahead (m)", 0.0, end * 1.02),
        y: Axis::new("first less second level (dB)", least - room, most + room),
        scale: Scale::Linear,
        legend: Legend::UpperLeft,
        series,
    }
}

fn residuals(fit: &Fit, passes: &[Vec<Measurement>], names: &[String], end: f64, off: f64) -> Chart {
    let bound = |sign: f64, name: &str| Series {
        name: name.into(),
        colour: 6,
        style: Style::Dashed,
        points: vec![(0.0, sign * off), (end, sign * off)],
    };
    let mut series = vec![bound(1.0, "twice the tolerance of a level"), bound(-1.0, "")];
    for (number, pass) in fit.passes.iter().enumerate() {
        let at = |place: usize| passes.get(number).and_then(|pass| pass.get(place)).map_or(Metres(0.0), |m| m.distance);
        let points = pass.residuals.iter().map(|&(place, residual)| (at(place).0, residual)).collect();
        series.push(Series { name: name(names, number), colour: colour(number), style: Style::Points, points });
    }
    Chart {
        title: "Measured less fitted".into(),
        x: Axis::new("distance to the transmitter ahead (m)", 0.0, end * 1.02),
        y: Axis::new("residual (dB)", -off * 2.4, off * 2.4),
        scale: Scale::Linear,
        legend: Legend::UpperRight,
        series,
    }
}

/// Grey is the table's.
fn colour(pass: usize) -> usize {
    pass % (COLOURS.len() - 1)
}

/// The legend has room for some names.
fn name(names: &[String], pass: usize) -> String {
    if pass >= 8 { String::new() } else { names.get(pass).cloned().unwrap_or_default() }
}
