//! The headline as a picture, and the speed profile of one train.

use atc_kernel::supervision::Brake;
use atc_waveform::plot::{Axis, Chart, Legend, PlotError, Scale, Series, Style, draw};

use crate::headline::{Headline, Measured};
use crate::record::Record;

/// How wide a picture is, in px.
const WIDTH: u32 = 900;

fn series(name: &str, colour: usize, style: Style, points: Vec<(f64, f64)>) -> Series {
    Series { name: name.to_owned(), colour, style, points }
}

/// The next multiple of `step` at or above the highest value.
fn top(series: &[Series], step: f64) -> f64 {
    let highest = series.iter().flat_map(|one| &one.points).map(|point| point.1).fold(0.0, f64::max);
    ((highest / step).ceil() * step).max(step)
}

/// Needless brake applications, delay and margins against the length of interruptions.
///
/// # Errors
/// [`PlotError`] if there is but one length.
pub fn headline(headline: &Headline) -> Result<String, PlotError> {
    let longest = headline.rows.last().map_or(0.0, |row| f64::from(row.length_ms));
    let both = |of: fn(&Measured) -> f64| {
        let points = |device: fn(&crate::headline::Row) -> &Measured| {
            headline.rows.iter().map(|row| (f64::from(row.length_ms), of(device(row)))).collect()
        };
        vec![
            series("conventional: operate time 300 ms", 1, Style::Dashed, points(|row| &row.conventional)),
            series("shortened operate time: 100 ms", 0, Style::Line, points(|row| &row.shortened)),
        ]
    };
    let x = || Axis::new("length of the interruption of the cab signal (ms)", 0.0, longest);
    let share = both(|one| one.share() * 100.0);
    let delay = both(|one| one.delay_s);
    let margin = both(|one| one.pattern_m);
    let (late, far) = (top(&delay, 5.0), top(&margin, 20.0) + 20.0);
    let charts = [
        Chart {
            title: "Interruptions that brake the train needlessly".to_owned(),
            x: x(),
            y: Axis::new("share (%)", 0.0, 105.0),
            scale: Scale::Linear,
            legend: Legend::None,
            series: share,
        },
        Chart {
            title: "Delay of a train".to_owned(),
            x: x(),
            y: Axis::new("delay at the end (s)", 0.0, late),
            scale: Scale::Linear,
            legend: Legend::UpperLeft,
            series: delay,
        },
        Chart {
            title: "Least distance to the stop point, beyond the braking distance".to_owned(),
            x: x(),
            y: Axis::new("margin (m)", 0.0, far),
            scale: Scale::Linear,
            legend: Legend::None,
            series: margin,
        },
    ];
    draw(&charts, WIDTH, 900)
}

/// The speed of one train, what was permitted, and its brake, over time.
///
/// # Errors
/// [`PlotError`] if the run has no length.
pub fn profile(record: &Record, train: usize, title: &str) -> Result<String, PlotError> {
    let points = |of: &dyn Fn(&crate::record::Glimpse) -> f64| -> Vec<(f64, f64)> {
        let trains = record.at_s.iter().zip(&record.trains);
        trains.filter_map(|(at, trains)| Some((*at, of(trains.get(train)?)))).collect()
    };
    let speeds = vec![
        series("permitted", 2, Style::Dashed, points(&|glimpse| glimpse.permitted_kmh.unwrap_or(0.0))),
        series("actual", 0, Style::Line, points(&|glimpse| glimpse.speed_kmh)),
    ];
    let brake = |glimpse: &crate::record::Glimpse| match glimpse.brake {
        Brake::Release => 0.0,
        Brake::Service => 1.0,
        Brake::Emergency => 2.0,
    };
    let brakes = vec![series("brake", 1, Style::Line, points(&brake))];
    let ends = (record.at_s.first().copied().unwrap_or(0.0), record.at_s.last().copied().unwrap_or(0.0));
    let highest = top(&speeds, 20.0) + 10.0;
    let chart = |title: &str, y: Axis, series: Vec<Series>, legend: Legend| Chart {
        title: title.to_owned(),
        x: Axis::new("time (s)", ends.0, ends.1),
        y,
        scale: Scale::Linear,
        legend,
        series,
    };
    let charts = [
        chart(title, Axis::new("speed (km/h)", 0.0, highest), speeds, Legend::UpperRight),
        chart("Brake command: 0 released, 1 service, 2 emergency", Axis::new("brake", 0.0, 2.2), brakes, Legend::None),
    ];
    draw(&charts, WIDTH, 620)
}
