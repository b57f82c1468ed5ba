//! Draws a figure over distance: the curves of all cases, and sections and places below and between them.

use svg::Node;
use svg::node::element::{Group, Polygon, Title};

use super::figure::{Curve, Figure, Stroke};
use super::ink::{FAINT, INK, LEFT, RIGHT, axis_step, join, line, polyline, rectangle, round, text, width, wrap};
use super::scene::Scene;

/// The height of the plot.
const HEIGHT: f64 = 320.0;

/// The colours of the cases.
const COLOURS: [&str; 4] = ["#1f5f99", "#b35900", "#2f7d32", "#7a3b9a"];

/// The figures of all cases as one: every case keeps its colour, and what they have in common is drawn once.
pub(super) fn of_all(scenes: &[Scene]) -> Option<Figure> {
    let mut all: Option<Figure> = None;
    for (case, figure) in scenes.iter().enumerate().filter_map(|(case, scene)| Some((case, scene.figure.as_ref()?))) {
        let all = all.get_or_insert_default();
        all.notes.extend(figure.notes.iter().filter(|note| !all.notes.contains(note)).cloned().collect::<Vec<_>>());
        all.curves.extend(figure.curves.iter().cloned().map(|curve| Curve { case: curve.case + case, ..curve }));
        for span in &figure.spans {
            if all.spans.iter().all(|known| known.2 != span.2) {
                all.spans.push(span.clone());
            }
        }
        for place in &figure.places {
            if all.places.iter().all(|known| (known.0 - place.0).abs() >= 1.0) {
                all.places.push(place.clone());
            }
        }
        all.arrivals.extend(figure.arrivals.iter().map(|(at, what, of)| (*at, what.clone(), of + case)));
    }
    all
}

/// Draws a figure from `y` down and returns where it ends.
pub(super) fn draw(figure: &Figure, body: &mut Group, title: &str, mut y: f64) -> f64 {
    y += 12.0;
    body.append(text(title, 14.0, y, "start").set("font-size", 17).set("font-weight", "bold"));
    for note in figure.notes.iter().flat_map(|note| wrap(note, 168)) {
        y += 18.0;
        body.append(text(note, 14.0, y, "start"));
    }
    let (from, to, top) = figure.range();
    let (high, low) = (y + 34.0, y + 34.0 + HEIGHT);
    let across = |at: f64| LEFT + (at - from) / (to - from) * (RIGHT - LEFT);
    let up = |value: f64| low - value / top * (low - high);
    grid(body, (from, to), top, (high, low));
    let strip = low + 26.0;
    for (place, (left, right, name)) in figure.spans.iter().enumerate() {
        let (left, right) = (across(left.max(from)), across(right.min(to)));
        if right <= left {
            continue;
        }
        let fill = if place % 2 == 0 { "#f2f4f7" } else { "#ffffff" };
        body.append(rectangle(left, strip, right, strip + 20.0).set("fill", fill).set("stroke", "#777777"));
        body.append(line(right, high, right, strip, "#bbbbbb"));
        if width(name) + 4.0 < right - left {
            body.append(text(name, f64::midpoint(left, right), strip + 14.0, "middle"));
        }
    }
    for (at, name) in &figure.places {
        let x = across(*at);
        body.append(line(x, high - 6.0, x, strip, INK).set("stroke-width", 1.6).set("stroke-dasharray", "10 3 2 3"));
        let (x, anchor) = if x + width(name) / 2.0 > RIGHT { (RIGHT, "end") } else { (x, "middle") };
        body.append(text(name, x, high - 11.0, anchor));
    }
    for curve in &figure.curves {
        draw_curve(body, curve, across, up);
    }
    for (at, what, case) in &figure.arrivals {
        let x = across(*at);
        let points = [(x, low - 10.0), (x - 4.5, low - 1.0), (x + 4.5, low - 1.0)];
        let mut sign = Polygon::new().set("points", join(&points)).set("fill", COLOURS[case % COLOURS.len()]);
        sign.append(Title::new(format!("{what}: {} m", round(*at))));
        body.append(sign);
    }
    let foot = if figure.spans.is_empty() { low + 24.0 } else { strip + 24.0 };
    legend(figure, body, foot + 20.0)
}

fn grid(body: &mut Group, (from, to): (f64, f64), top: f64, (high, low): (f64, f64)) {
    let step = axis_step((to - from) / 10.0);
    let mut value = (from / step).ceil() * step;
    while value <= to {
        let x = LEFT + (value - from) / (to - from) * (RIGHT - LEFT);
        body.append(line(x, high, x, low, FAINT));
        body.append(line(x, low, x, low + 5.0, INK));
        body.append(text(&format!("{}", round(value)), x, low + 18.0, "middle"));
        value += step;
    }
    body.append(text("distance, m", LEFT - 12.0, low + 18.0, "end"));
    let step = axis_step(top / 8.0);
    let mut value = 0.0;
    while value <= top {
        let y = low - value / top * (low - high);
        body.append(line(LEFT, y, RIGHT, y, FAINT));
        body.append(text(&format!("{}", round(value)), LEFT - 6.0, y + 4.0, "end"));
        value += step;
    }
    body.append(text("speed, km/h", LEFT - 36.0, high + 4.0, "end").set("font-size", 13).set("font-weight", "bold"));
    body.append(line(LEFT, high, LEFT, low, INK));
    body.append(line(LEFT, low, RIGHT, low, INK));
}

fn draw_curve(body: &mut Group, curve: &Curve, across: impl Fn(f64) -> f64, up: impl Fn(f64) -> f64) {
    let colour = COLOURS[curve.case % COLOURS.len()];
    for piece in curve.points.split(Option::is_none) {
        let points: Vec<_> = piece.iter().flatten().map(|(at, value)| (across(*at), up(*value))).collect();
        if curve.stroke == Stroke::Dots {
            for (x, y) in points {
                body.append(rectangle(x - 2.0, y - 2.0, x + 2.0, y + 2.0).set("fill", colour));
            }
        } else if points.len() > 1 {
            body.append(stroke(polyline(&points).set("stroke", colour), curve.stroke));
        }
    }
}

fn stroke<E: Node>(mut element: E, stroke: Stroke) -> E {
    let (width, dashes) = match stroke {
        Stroke::Full => (2.2, "none"),
        Stroke::Broken => (1.5, "6 3"),
        Stroke::Thin | Stroke::Dots => (0.8, "none"),
    };
    element.assign("stroke-width", width);
    if dashes != "none" {
        element.assign("stroke-dasharray", dashes);
    }
    element
}

fn legend(figure: &Figure, body: &mut Group, mut y: f64) -> f64 {
    let mut x = LEFT;
    let mut entry = |y: &mut f64, name: &str, draw: &mut dyn FnMut(f64, f64)| {
        let length = 50.0 + width(name);
        if x + length > RIGHT && x > LEFT {
            x = LEFT;
            *y += 20.0;
        }
        draw(x, *y);
        x += length;
    };
    for curve in &figure.curves {
        let colour = COLOURS[curve.case % COLOURS.len()];
        entry(&mut y, &curve.label, &mut |x, y| {
            if curve.stroke == Stroke::Dots {
                body.append(rectangle(x + 9.0, y - 6.0, x + 13.0, y - 2.0).set("fill", colour));
            } else {
                body.append(stroke(line(x, y - 4.0, x + 26.0, y - 4.0, colour), curve.stroke));
            }
            body.append(text(&curve.label, x + 31.0, y, "start"));
        });
    }
    if let Some((_, _, case)) = figure.arrivals.first() {
        let name = "sub telegram of a section is first used";
        entry(&mut y, name, &mut |x, y| {
            let points = [(x + 13.0, y - 9.0), (x + 8.5, y), (x + 17.5, y)];
            body.append(Polygon::new().set("points", join(&points)).set("fill", COLOURS[case % COLOURS.len()]));
            body.append(text(name, x + 31.0, y, "start"));
        });
    }
    y + 26.0
}
