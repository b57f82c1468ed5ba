//! The time–distance diagram of a run: time to the right, the line from bottom to top; trains, circuits that are reported
//! occupied, and signals at proceed with their routes.

use std::fmt::Write as _;

use atc_kernel::supervision::Brake;

use crate::line::Line;
use crate::record::Record;

const LEFT: f64 = 110.0;
const TOP: f64 = 50.0;
const WIDTH: f64 = 1_000.0;
const RIGHT: f64 = 20.0;
const BELOW: f64 = 70.0;

/// Colours that people with any kind of colour vision can tell apart (M. Okabe, K. Ito).
const COLOURS: [&str; 6] = ["#0072b2", "#d55e00", "#009e73", "#cc79a7", "#a6761d", "#5a5a5a"];

struct Scale {
    from_s: f64,
    per_s: f64,
    per_m: f64,
    height: f64,
}

impl Scale {
    fn x(&self, seconds: f64) -> f64 {
        LEFT + (seconds - self.from_s) * self.per_s
    }

    fn y(&self, metres: f64) -> f64 {
        TOP + self.height - metres * self.per_m
    }
}

/// The diagram as SVG.
pub fn draw(line: &Line, record: &Record, title: &str) -> String {
    let mut svg = String::new();
    // Writing to a string cannot fail.
    let _ = write(line, record, title, &mut svg);
    svg
}

fn write(line: &Line, record: &Record, title: &str, out: &mut String) -> std::fmt::Result {
    let ends = (record.at_s.first().copied().unwrap_or(0.0), record.at_s.last().copied().unwrap_or(1.0));
    let length = line.track.along_m.iter().copied().fold(1.0, f64::max);
    let height = (length / 8.0).clamp(300.0, 900.0);
    let scale = Scale { from_s: ends.0, per_s: WIDTH / (ends.1 - ends.0).max(1.0), per_m: height / length, height };
    let (width, all) = (LEFT + WIDTH + RIGHT, TOP + height + BELOW);
    writeln!(
        out,
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {width} {all:.0}\" width=\"{width}\" height=\"{all:.0}\" \
         font-family=\"sans-serif\" font-size=\"13\">\n<rect width=\"100%\" height=\"100%\" fill=\"white\"/>"
    )?;
    writeln!(out, "<text x=\"{LEFT}\" y=\"26\" font-size=\"17\">{}</text>", escaped(title))?;
    bands(line, record, &scale, out)?;
    axes(line, (ends, length), &scale, out)?;
    trains(record, &scale, out)?;
    legend(all - 18.0, out)?;
    writeln!(out, "</svg>")
}

/// What is reported occupied, and the routes of signals at proceed.
fn bands(line: &Line, record: &Record, scale: &Scale, out: &mut String) -> std::fmt::Result {
    let track = &line.track;
    let reach = |circuits: &[usize]| {
        let pieces = track.pieces.iter().filter(|piece| circuits.contains(&piece.circuit));
        let along = pieces.flat_map(|piece| &piece.joints).map(|joint| track.along_m[*joint]);
        along.fold((f64::INFINITY, 0.0_f64), |(least, most), at| (least.min(at), most.max(at)))
    };
    let mut rect = |(from_s, to_s): (f64, f64), (from_m, to_m): (f64, f64), style: &str| {
        let (x, y) = (scale.x(from_s), scale.y(to_m));
        let (width, height) = ((to_s - from_s) * scale.per_s, (to_m - from_m) * scale.per_m);
        writeln!(out, "<rect x=\"{x:.1}\" y=\"{y:.1}\" width=\"{width:.1}\" height=\"{height:.1}\" {style}/>")
    };
    for span in &record.occupied {
        rect((span.from_s, span.to_s), reach(&[span.of]), "fill=\"#777\" fill-opacity=\"0.16\"")?;
    }
    for span in &record.proceed {
        let (station, route) = span.of;
        let path = &line.stations[station].paths[route];
        let style = "fill=\"#2a9d3a\" fill-opacity=\"0.28\" stroke=\"#2a9d3a\" stroke-width=\"0.6\"";
        rect((span.from_s, span.to_s), reach(path), style)?;
    }
    Ok(())
}

fn axes(line: &Line, (ends, length): ((f64, f64), f64), scale: &Scale, out: &mut String) -> std::fmt::Result {
    let (left, right, bottom) = (LEFT, LEFT + WIDTH, scale.y(0.0));
    for place in &line.stations {
        let legs = place.platforms.iter().flat_map(|platform| &platform.legs);
        let joints = legs.flat_map(|leg| [leg.enter, leg.exit]).map(|joint| line.track.along_m[joint]);
        let (from, to) = joints.fold((f64::INFINITY, 0.0_f64), |(least, most), at| (least.min(at), most.max(at)));
        let middle = scale.y(f64::midpoint(from, to)) + 4.0;
        writeln!(
            out,
            "<text x=\"{:.0}\" y=\"{middle:.1}\" text-anchor=\"end\">{}</text>",
            left - 34.0,
            escaped(&place.name)
        )?;
        for at in [from, to] {
            let y = scale.y(at);
            writeln!(
                out,
                "<line x1=\"{left}\" y1=\"{y:.1}\" x2=\"{right}\" y2=\"{y:.1}\" stroke=\"#bbb\" stroke-dasharray=\"2 3\"/>"
            )?;
        }
    }
    writeln!(
        out,
        "<rect x=\"{left}\" y=\"{TOP}\" width=\"{WIDTH}\" height=\"{:.1}\" fill=\"none\" stroke=\"#444\"/>",
        scale.height
    )?;
    let step = if ends.1 - ends.0 > 900.0 { 300.0 } else { 60.0 };
    let mut at = (ends.0 / step).ceil() * step;
    while at <= ends.1 {
        let x = scale.x(at);
        writeln!(
            out,
            "<line x1=\"{x:.1}\" y1=\"{bottom:.1}\" x2=\"{x:.1}\" y2=\"{:.1}\" stroke=\"#444\"/>",
            bottom + 5.0
        )?;
        writeln!(out, "<text x=\"{x:.1}\" y=\"{:.1}\" text-anchor=\"middle\">{:.0}</text>", bottom + 20.0, at / 60.0)?;
        at += step;
    }
    let middle = f64::midpoint(left, right);
    writeln!(out, "<text x=\"{middle}\" y=\"{:.1}\" text-anchor=\"middle\">time in min</text>", bottom + 36.0)?;
    let mut at = 0.0;
    while at <= length {
        let y = scale.y(at);
        writeln!(out, "<line x1=\"{:.1}\" y1=\"{y:.1}\" x2=\"{left}\" y2=\"{y:.1}\" stroke=\"#444\"/>", left - 5.0)?;
        writeln!(
            out,
            "<text x=\"{:.1}\" y=\"{:.1}\" text-anchor=\"end\" font-size=\"11\" fill=\"#444\">{:.0} km</text>",
            left - 7.0,
            y + 4.0,
            at / 1000.0
        )?;
        at += 1_000.0;
    }
    Ok(())
}

fn trains(record: &Record, scale: &Scale, out: &mut String) -> std::fmt::Result {
    let count = record.trains.first().map_or(0, Vec::len);
    for train in 0..count {
        let colour = COLOURS[train % COLOURS.len()];
        let path = |of: fn(&crate::record::Glimpse) -> f64| {
            let points = record.at_s.iter().zip(&record.trains);
            points
                .map(|(at, trains)| format!("{:.1},{:.1}", scale.x(*at), scale.y(of(&trains[train]))))
                .collect::<Vec<_>>()
        };
        let (fronts, mut tails) = (path(|glimpse| glimpse.front_m), path(|glimpse| glimpse.tail_m));
        tails.reverse();
        writeln!(
            out,
            "<polygon points=\"{} {}\" fill=\"{colour}\" fill-opacity=\"0.25\"/>",
            fronts.join(" "),
            tails.join(" ")
        )?;
        writeln!(
            out,
            "<polyline points=\"{}\" fill=\"none\" stroke=\"{colour}\" stroke-width=\"1.8\"/>",
            fronts.join(" ")
        )?;
        for (at, trains) in record.at_s.iter().zip(&record.trains) {
            let glimpse = &trains[train];
            if glimpse.brake != Brake::Release && glimpse.speed_kmh > 0.0 {
                let fill = if glimpse.brake == Brake::Emergency { "#c00" } else { "#000" };
                let (x, y) = (scale.x(*at), scale.y(glimpse.front_m));
                writeln!(out, "<circle cx=\"{x:.1}\" cy=\"{y:.1}\" r=\"1.9\" fill=\"{fill}\"/>")?;
            }
        }
    }
    Ok(())
}

fn legend(y: f64, out: &mut String) -> std::fmt::Result {
    let keys = [
        (
            "<rect x=\"-22\" y=\"-10\" width=\"18\" height=\"11\" fill=\"#777\" fill-opacity=\"0.25\"/>",
            "circuit reported occupied",
        ),
        (
            "<rect x=\"-22\" y=\"-10\" width=\"18\" height=\"11\" fill=\"#2a9d3a\" fill-opacity=\"0.28\" stroke=\"#2a9d3a\"/>",
            "signal at proceed, its route",
        ),
        ("<path d=\"M-22,-4h18\" stroke=\"#0072b2\" stroke-width=\"2\"/>", "front of a train"),
        ("<circle cx=\"-12\" cy=\"-4\" r=\"3\"/>", "service brake by ATC"),
        ("<circle cx=\"-12\" cy=\"-4\" r=\"3\" fill=\"#c00\"/>", "emergency brake"),
    ];
    let mut x = LEFT + 24.0;
    for (key, text) in keys {
        writeln!(out, "<g transform=\"translate({x:.0},{y:.0})\">{key}<text>{text}</text></g>")?;
        x += 205.0;
    }
    Ok(())
}

fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;")
}
