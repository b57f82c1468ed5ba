//! The pictures of the signal and of the receivers' measurements.

use crate::measure::{
    Bench, BitErrorCurve, Picture, coherent, differentially_decoded, differentially_decoded_under_code,
};
use crate::plot::{Axis, Chart, Legend, PlotError, Scale, Series, Style, draw};
use crate::units::{Decibels, Hertz};

fn series(name: impl Into<String>, colour: usize, style: Style, points: Vec<(f64, f64)>) -> Series {
    Series { name: name.into(), colour, style, points }
}

/// A curve of theory from 0 dB up.
fn theory(highest: u32, of: impl Fn(Decibels) -> f64) -> Vec<(f64, f64)> {
    (0..=10 * highest + 5).map(|tenths| f64::from(tenths) / 10.0).map(|db| (db, of(Decibels(db)))).collect()
}

/// The points that mean something: a handful of errors says little of the rate.
fn measured(curve: &BitErrorCurve) -> Vec<(f64, f64)> {
    curve.points.iter().filter(|point| point.errors >= 10).map(|point| (point.eb_n0_db, point.rate)).collect()
}

/// All pictures of a run: a file name and the SVG text of each.
///
/// # Errors
/// [`PlotError`] if one cannot be drawn.
pub fn plots(bench: &Bench, depth: f64, bit_rate: Hertz) -> Result<Vec<(&'static str, String)>, PlotError> {
    let mut plots = vec![
        ("bit-errors.svg", bit_errors(&bench.bit_errors)?),
        ("bit-errors-under-code.svg", bit_errors_under_code(&bench.bit_errors, depth, bit_rate)?),
        ("detection.svg", detection(bench)?),
    ];
    if let Some(picture) = &bench.picture {
        plots.push(("spectrum.svg", spectrum(picture)?));
        plots.push(("envelope.svg", envelope(picture)?));
    }
    Ok(plots)
}

fn error_axes(title: &str, highest: u32, lowest: f64, series: Vec<Series>) -> Chart {
    Chart {
        title: title.into(),
        x: Axis::new("Eb/N0 (dB)", 0.0, f64::from(highest) + 0.5),
        y: Axis::new("bit error rate", lowest, 1.0),
        scale: Scale::Logarithmic,
        legend: Legend::LowerLeft,
        series,
    }
}

/// Bit error rate without codes, beside theory.
///
/// # Errors
/// [`PlotError`] if it cannot be drawn.
pub fn bit_errors(curves: &[BitErrorCurve]) -> Result<String, PlotError> {
    let mut lines = vec![
        series("theory: coherent MSK, Q(√(2Eb/N0))", 6, Style::Dashed, theory(10, coherent)),
        series("theory: coherent, differentially decoded", 0, Style::Line, theory(10, differentially_decoded)),
    ];
    for (curve, colour) in curves.iter().filter(|curve| curve.codes_hz.is_none()).zip(1..) {
        lines.push(series(format!("measured: {}", curve.name), colour, Style::Points, measured(curve)));
    }
    draw(&[error_axes("Bit errors without a code", 10, 0.9e-6, lines)], 860, 560)
}

/// Bit error rate under codes, beside theory averaged over the envelope.
///
/// # Errors
/// [`PlotError`] if it cannot be drawn.
pub fn bit_errors_under_code(curves: &[BitErrorCurve], depth: f64, bit_rate: Hertz) -> Result<String, PlotError> {
    let mut lines = vec![series("theory: no code", 6, Style::Dashed, theory(18, differentially_decoded))];
    let coded = curves.iter().filter_map(|curve| curve.codes_hz.map(|codes| (curve, codes)));
    for ((curve, (main, sub)), colour) in coded.zip(0..) {
        let of = |ratio, code| differentially_decoded_under_code(ratio, depth, Hertz(code), bit_rate);
        let average = theory(18, |ratio| f64::midpoint(of(ratio, main), of(ratio, sub)));
        lines.push(series(format!("theory: {}", curve.name), colour, Style::Line, average));
        lines.push(series(format!("measured: {}", curve.name), colour, Style::Points, measured(curve)));
    }
    draw(&[error_axes("Bit errors under the amplitude modulation of the codes", 18, 0.9e-5, lines)], 860, 560)
}

/// Detection times over the signal-to-noise ratio.
///
/// # Errors
/// [`PlotError`] if it cannot be drawn.
pub fn detection(bench: &Bench) -> Result<String, PlotError> {
    let points = &bench.detection;
    let times = |of: fn(&crate::measure::DetectionPoint) -> Option<f64>| -> Vec<(f64, f64)> {
        points.iter().map(|point| (point.snr_db, of(point).unwrap_or(f64::NAN))).collect()
    };
    let lowest = points.first().map_or(-10.0, |point| point.snr_db);
    let highest = points.last().map_or(20.0, |point| point.snr_db);
    let chart = Chart {
        title: "From the start of the signal to the first right report".into(),
        x: Axis::new("signal-to-noise ratio from 0 to 4 kHz (dB)", lowest, highest),
        y: Axis::new("time (s)", 0.0, 3.0),
        scale: Scale::Linear,
        legend: Legend::UpperRight,
        series: vec![
            series("speed by codes: median", 0, Style::Line, times(|point| point.code.median)),
            series("speed by codes: 95 %", 0, Style::Dashed, times(|point| point.code.percentile_95)),
            series("main telegram: median", 1, Style::Line, times(|point| point.main_telegram.median)),
            series("main telegram: 95 %", 1, Style::Dashed, times(|point| point.main_telegram.percentile_95)),
        ],
    };
    draw(&[chart], 860, 480)
}

/// The spectrum of a signal.
///
/// # Errors
/// [`PlotError`] if it cannot be drawn.
pub fn spectrum(picture: &Picture) -> Result<String, PlotError> {
    let chart = Chart {
        title: format!(
            "Spectrum: main carrier at {} Hz, sub carrier at {} Hz",
            picture.carriers_hz.0, picture.carriers_hz.1
        ),
        x: Axis::new("frequency (Hz)", 0.0, 2000.0),
        y: Axis::new("power density (dB of full scale in 1 Hz)", -110.0, -20.0),
        scale: Scale::Linear,
        legend: Legend::None,
        series: vec![series(
            "",
            0,
            Style::Line,
            picture.spectrum.iter().copied().filter(|&(hertz, _)| hertz <= 2000.0).collect(),
        )],
    };
    draw(&[chart], 860, 480)
}

/// The signal over time, and the envelopes that the receivers see.
///
/// # Errors
/// [`PlotError`] if it cannot be drawn.
pub fn envelope(picture: &Picture) -> Result<String, PlotError> {
    let chart = |title: &str, y: Axis, legend, series| Chart {
        title: title.into(),
        x: Axis::new("time (s)", 0.0, 0.5),
        y,
        scale: Scale::Linear,
        legend,
        series,
    };
    let samples = series("", 0, Style::Thin, picture.samples.clone());
    let main =
        series(format!("main carrier, code {} Hz", picture.codes_hz.0), 0, Style::Line, picture.main_envelope.clone());
    let sub =
        series(format!("sub carrier, code {} Hz", picture.codes_hz.1), 1, Style::Line, picture.sub_envelope.clone());
    draw(
        &[
            chart("The signal", Axis::new("part of full scale", -1.0, 1.0), Legend::None, vec![samples]),
            chart("Its envelopes", Axis::new("part of full scale", 0.0, 0.6), Legend::UpperRight, vec![main, sub]),
        ],
        860,
        640,
    )
}
