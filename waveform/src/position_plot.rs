//! The pictures of the train's position.

use crate::plot::{
    Axis, COLOURS, Chart, Legend, PlotError, Scale, Series, Style, draw, fault, frame, legend, mesh, number,
};
use crate::position_measure::{Odometry, PositionBench, Run};
use plotters::prelude::*;

/// Fine lines of the grid between two labels.
const LIGHT_LINES: usize = 10;

/// All pictures of a measurement: a file name and the SVG text of each.
///
/// # Errors
/// [`PlotError`] if one cannot be drawn.
pub fn plots(bench: &PositionBench) -> Result<Vec<(String, String)>, PlotError> {
    let mut all = vec![
        ("position-attenuation".into(), attenuation(bench)?),
        ("position-width".into(), width(bench)?),
        ("position-error".into(), error(bench)?),
        ("position-outside".into(), outside(bench)?),
        ("position-meter".into(), meter(bench)?),
    ];
    for arrangement in ['a', 'b', 'c'] {
        let runs: Vec<&Run> = bench.runs.iter().filter(|run| run.arrangement == arrangement).collect();
        all.push((format!("position-run-{arrangement}"), bands(&runs, name(arrangement))?));
    }
    let runs: Vec<&Run> = bench.from_samples.iter().collect();
    all.push(("position-run-from-samples".into(), bands(&runs, "Levels measured from samples, noise added (a)")?));
    Ok(all.into_iter().map(|(name, svg): (String, String)| (name + ".svg", svg)).collect())
}

fn name(arrangement: char) -> &'static str {
    match arrangement {
        'a' => "One transmitter ahead, 1 and 3 kHz (a)",
        'b' => "Two transmitters ahead, 60 m apart, 1 and 3 kHz (b)",
        _ => "One ahead, one behind, 600 m apart, 3 kHz, train of 200 m (c)",
    }
}

fn ballast(ohm_km: f64) -> String {
    let word = match ohm_km {
        x if x < 5.0 => "wet, ",
        x if x > 20.0 => "dry, ",
        _ => "",
    };
    format!("{word}{ohm_km} Ω·km")
}

/// Wet blue, dry red, green between.
fn colour(ohm_km: f64) -> usize {
    match ohm_km {
        x if x < 5.0 => 0,
        x if x > 20.0 => 1,
        _ => 2,
    }
}

fn attenuation(bench: &PositionBench) -> Result<String, PlotError> {
    let lines = |style, label: &str, value: &dyn Fn(&[f64; 4]) -> f64| {
        let series = |curve: &crate::position_measure::LineCurve| Series {
            name: format!("{}{label}", ballast(curve.ohm_km)),
            colour: colour(curve.ohm_km),
            style,
            points: curve.points.iter().map(|point| (point[0], value(point))).collect(),
        };
        bench.curves.iter().map(series).collect::<Vec<_>>()
    };
    let mut both = lines(Style::Dashed, ", 1 kHz", &|point| -point[1]);
    both.extend(lines(Style::Line, ", 3 kHz", &|point| -point[2]));
    let levels = Chart {
        title: "Level over the distance from the transmitter".into(),
        x: Axis::new("distance (m)", 0.0, 1000.0),
        y: Axis::new("level against the transmitter (dB)", -25.0, 0.0),
        scale: Scale::Linear,
        legend: Legend::LowerLeft,
        series: both,
    };
    let mut differences = lines(Style::Line, "", &|point| point[2] - point[1]);
    differences.extend(lines(Style::Dashed, ", fixed impedance", &|point| point[3]));
    let difference = Chart {
        title: "Difference of the levels; dashed: a transmitter matched to 10 Ω·km in all weather".into(),
        x: Axis::new("distance (m)", 0.0, 1000.0),
        y: Axis::new("level difference, 1 less 3 kHz (dB)", 0.0, 15.0),
        scale: Scale::Linear,
        legend: Legend::UpperRight,
        series: differences,
    };
    draw(&[levels, difference], 900, 900)
}

/// One chart for each arrangement, a line for each ballast, dashed without the odometer.
fn over_distance(
    bench: &PositionBench,
    what: &str,
    label: &str,
    value: impl Fn(f64, [f64; 2]) -> f64,
) -> Result<String, PlotError> {
    let charts = ['a', 'b', 'c'].map(|arrangement| {
        let runs = || bench.runs.iter().filter(|run| run.arrangement == arrangement);
        let values = runs().flat_map(|run| run.points.iter().filter_map(|p| Some(value(p.truth, p.interval?))));
        // Room for the legend above the greatest.
        let most = (values.fold(1.0, f64::max) * 1.35 / 50.0).ceil() * 50.0;
        let series = |run: &Run| Series {
            name: if run.odometer == Odometry::With { ballast(run.ohm_km) } else { String::new() },
            colour: colour(run.ohm_km),
            style: if run.odometer == Odometry::With { Style::Line } else { Style::Thin },
            points: run
                .points
                .iter()
                .rev()
                .map(|p| (p.truth, p.interval.map_or(f64::NAN, |i| value(p.truth, i))))
                .collect(),
        };
        Chart {
            title: format!("{what}: {}", name(arrangement)),
            x: Axis::new("true distance to the transmitter ahead (m); thin: without the odometer", 0.0, 400.0),
            y: Axis::new(label, 0.0, most),
            scale: Scale::Linear,
            legend: Legend::UpperRight,
            series: runs().map(series).collect(),
        }
    });
    draw(&charts, 900, 1200)
}

fn width(bench: &PositionBench) -> Result<String, PlotError> {
    over_distance(bench, "Width", "width of the interval (m)", |_, [nearest, farthest]| farthest - nearest)
}

fn error(bench: &PositionBench) -> Result<String, PlotError> {
    let value = |truth: f64, [nearest, farthest]: [f64; 2]| (f64::midpoint(nearest, farthest) - truth).abs();
    over_distance(bench, "Error", "middle of the interval to train (m)", value)
}

/// The share of wrong answers over the true ballast, on a logarithmic axis; dashed if the first contradiction were kept.
fn outside(bench: &PositionBench) -> Result<String, PlotError> {
    let mut text = String::new();
    {
        let root = SVGBackend::with_string(&mut text, (900, 520)).into_drawing_area();
        root.fill(&WHITE).map_err(fault)?;
        let mut context = frame(&root, "A table for 5 to 20 Ω·km on other ballast: answers without the train")
            .build_cartesian_2d((1.0..100.0).log_scale(), 0.0..140.0)
            .map_err(fault)?;
        mesh(
            &mut context,
            [
                "true insulation of the ballast (Ω·km); dashed: no more answers after the first contradiction",
                "cycles with a wrong interval (%)",
            ],
            LIGHT_LINES,
            &|share| if *share > 100.0 { String::new() } else { number(*share) },
        )?;
        let limits = Rectangle::new([(5.0, 0.0), (20.0, 140.0)], RGBColor(225, 242, 225).filled());
        context
            .draw_series([limits])
            .map_err(fault)?
            .label("the table's limits")
            .legend(|(x, y)| Rectangle::new([(x, y - 5), (x + 20, y + 5)], RGBColor(225, 242, 225).filled()));
        for (arrangement, colour) in [('a', COLOURS[0]), ('b', COLOURS[1]), ('c', COLOURS[2])] {
            let rows = || bench.outside.iter().filter(|row| row.arrangement == arrangement);
            let wrong = rows().map(|row| (row.ohm_km, row.wrong * 100.0));
            context
                .draw_series(LineSeries::new(wrong, colour.stroke_width(2)))
                .map_err(fault)?
                .label(name(arrangement))
                .legend(move |(x, y)| PathElement::new(vec![(x, y), (x + 20, y)], colour.stroke_width(2)));
            let kept = rows().map(|row| (row.ohm_km, row.wrong_if_kept * 100.0));
            context.draw_series(DashedLineSeries::new(kept, 6, 4, colour.stroke_width(1))).map_err(fault)?;
        }
        legend(&mut context, SeriesLabelPosition::UpperRight)?;
        root.present().map_err(fault)?;
    }
    Ok(text)
}

fn meter(bench: &PositionBench) -> Result<String, PlotError> {
    let series = |name: &str, colour, style, value: &dyn Fn(&crate::position_measure::MeterPoint) -> f64| Series {
        name: name.into(),
        colour,
        style,
        points: bench.meter.iter().map(|point| (point.signal_to_noise_db, value(point))).collect(),
    };
    let tolerance = Series {
        name: "tolerance of the runs".into(),
        colour: 6,
        style: Style::Dashed,
        points: vec![(10.0, 0.1), (40.0, 0.1)],
    };
    let chart = Chart {
        title: "Error of a level measured in 100 ms at 8 kHz".into(),
        x: Axis::new("signal over noise in 4 kHz (dB)", 10.0, 40.0),
        y: Axis::new("error (dB)", 0.001, 1.0),
        scale: Scale::Logarithmic,
        legend: Legend::LowerLeft,
        series: vec![
            series("standard deviation, theory", 0, Style::Line, &|point| point.expected_db),
            series("standard deviation, measured", 0, Style::Points, &|point| point.deviation_db),
            series(
                &format!("greatest of {}", bench.meter.first().map_or(0, |p| p.windows)),
                1,
                Style::Points,
                &|point| point.greatest_db,
            ),
            tolerance,
        ],
    };
    draw(&[chart], 900, 520)
}

/// One panel for each ballast: the interval over time as a band, light without the odometer, and the train in it.
fn bands(runs: &[&Run], title: &str) -> Result<String, PlotError> {
    let mut leakages: Vec<f64> = runs.iter().map(|run| run.ohm_km).collect();
    leakages.dedup();
    let mut text = String::new();
    {
        let root = SVGBackend::with_string(&mut text, (900, 380 * u32::try_from(leakages.len()).unwrap_or(1)))
            .into_drawing_area();
        root.fill(&WHITE).map_err(fault)?;
        for (area, &ohm_km) in root.split_evenly((leakages.len(), 1)).iter().zip(&leakages) {
            let here = || runs.iter().filter(|run| run.ohm_km.to_bits() == ohm_km.to_bits());
            let most = here()
                .flat_map(|run| &run.points)
                .filter_map(|p| p.interval)
                .fold(400.0, |m: f64, [_, far]| m.max(far));
            let mut context = frame(area, &format!("{title}: {}", ballast(ohm_km)))
                .build_cartesian_2d(0.0..20.0, 0.0..(most * 1.05 / 100.0).ceil() * 100.0)
                .map_err(fault)?;
            mesh(
                &mut context,
                ["time (s), 20 m/s", "distance to the transmitter ahead (m)"],
                LIGHT_LINES,
                &|metres| number(*metres),
            )?;
            for run in here() {
                let (shade, name) = match run.odometer {
                    Odometry::Without => (RGBColor(246, 222, 165), "each cycle for itself"),
                    Odometry::With => (RGBColor(150, 196, 224), "carried on by the odometer"),
                };
                for (place, piece) in
                    run.points.split(|p| p.interval.is_none()).filter(|piece| !piece.is_empty()).enumerate()
                {
                    let edge = |end: usize| piece.iter().filter_map(move |p| Some((p.seconds, p.interval?[end])));
                    let outline: Vec<(f64, f64)> =
                        edge(0).chain(edge(1).collect::<Vec<_>>().into_iter().rev()).collect();
                    let drawn = context.draw_series([Polygon::new(outline, shade.filled())]).map_err(fault)?;
                    if place == 0 {
                        drawn
                            .label(name)
                            .legend(move |(x, y)| Rectangle::new([(x, y - 5), (x + 20, y + 5)], shade.filled()));
                    }
                }
            }
            if let Some(run) = here().next() {
                let truth = run.points.iter().map(|p| (p.seconds, p.truth));
                context
                    .draw_series(LineSeries::new(truth, BLACK.stroke_width(2)))
                    .map_err(fault)?
                    .label("train")
                    .legend(|(x, y)| PathElement::new(vec![(x, y), (x + 20, y)], BLACK.stroke_width(2)));
            }
            legend(&mut context, SeriesLabelPosition::UpperRight)?;
        }
        root.present().map_err(fault)?;
    }
    Ok(text)
}
