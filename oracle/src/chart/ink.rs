//! What charts are drawn with: colours, signs, lines and letters.

use svg::Node;
use svg::node::element::{Group, Line, Polygon, Polyline, Rectangle, Text};

use super::scene::{Sign, Tone};

/// The colour of lines and text.
pub(super) const INK: &str = "#111111";
/// The colour of the lines of a grid.
pub(super) const FAINT: &str = "#dddddd";
/// Where rows begin.
pub(super) const LEFT: f64 = 160.0;
/// Where they end.
pub(super) const RIGHT: f64 = 980.0;

/// How a tone is painted: fill, edge, and the ink of a text on it.
pub(super) struct Paint {
    pub(super) fill: &'static str,
    pub(super) edge: &'static str,
    pub(super) ink: &'static str,
}

pub(super) fn paint(tone: Tone) -> Paint {
    let (fill, edge, ink) = match tone {
        Tone::Signal => ("#e4e8ee", INK, INK),
        Tone::Operate | Tone::Detected => ("#a9cdec", "#1f5f99", INK),
        Tone::Shortened | Tone::Service => ("#ffc48a", "#b35900", INK),
        Tone::Recovery | Tone::Held => ("#b5dfae", "#2f7d32", INK),
        Tone::Mask | Tone::Pending => ("#fff0a8", "#9a7d00", INK),
        Tone::Dropped => ("#cfcfcf", "#555555", INK),
        Tone::All => ("#f7c8c2", "#a01b10", INK),
        Tone::Emergency => ("#f2a39b", "#a01b10", INK),
        Tone::Limit => ("#ffffff", "#a01b10", INK),
        Tone::Code => ("#ffffff", "#1f5f99", INK),
        Tone::Blank => ("#ffffff", "#777777", "#444444"),
        Tone::Difference => ("#d7191c", "#7a0000", "#ffffff"),
    };
    Paint { fill, edge, ink }
}

/// How a curve of this tone is broken.
pub(super) fn dashes(tone: Tone) -> &'static str {
    match tone {
        Tone::Limit => "7 3",
        Tone::Code => "2 3",
        _ => "none",
    }
}

pub(super) fn sign_at(body: &mut Group, x: f64, y: f64, sign: Sign) {
    match sign {
        Sign::Accepted => {
            let points = [(x, y - 9.0), (x - 5.0, y), (x + 5.0, y)];
            body.append(Polygon::new().set("points", join(&points)).set("fill", INK));
        }
        Sign::Gone => {
            for (from, to) in [(y - 9.0, y), (y, y - 9.0)] {
                body.append(line(x - 4.5, from, x + 4.5, to, "#a01b10").set("stroke-width", 2));
            }
        }
    }
}

/// The width of a text of the usual size, estimated from its letters.
pub(super) fn width(text: &str) -> f64 {
    text.chars()
        .map(|letter| if matches!(letter, ' ' | ':' | ',' | '.' | 'i' | 'l' | 't' | '/') { 3.6 } else { 7.0 })
        .sum()
}

/// The text in lines of at most `longest` letters, broken at spaces.
pub(super) fn wrap(text: &str, longest: usize) -> Vec<&str> {
    let mut lines = Vec::new();
    let mut rest = text;
    while rest.len() > longest {
        let Some(end) = rest.char_indices().take_while(|(at, _)| *at <= longest).filter(|(_, c)| *c == ' ').last()
        else {
            break;
        };
        lines.push(&rest[..end.0]);
        rest = &rest[end.0 + 1..];
    }
    lines.push(rest);
    lines
}

/// Pixels, to a tenth.
pub(super) fn round(value: f64) -> f64 {
    (value * 10.0).round() / 10.0
}

pub(super) fn text(content: &str, x: f64, y: f64, anchor: &str) -> Text {
    Text::new(content).set("x", round(x)).set("y", round(y)).set("text-anchor", anchor)
}

pub(super) fn line(x1: f64, y1: f64, x2: f64, y2: f64, stroke: &str) -> Line {
    Line::new()
        .set("x1", round(x1))
        .set("y1", round(y1))
        .set("x2", round(x2))
        .set("y2", round(y2))
        .set("stroke", stroke)
}

pub(super) fn rectangle(left: f64, top: f64, right: f64, bottom: f64) -> Rectangle {
    let (width, height) = (round(right) - round(left), round(bottom) - round(top));
    Rectangle::new().set("x", round(left)).set("y", round(top)).set("width", round(width)).set("height", round(height))
}

pub(super) fn polyline(points: &[(f64, f64)]) -> Polyline {
    Polyline::new().set("points", join(points)).set("fill", "none")
}

pub(super) fn join(points: &[(f64, f64)]) -> String {
    let points: Vec<_> = points.iter().map(|(x, y)| format!("{},{}", round(*x), round(*y))).collect();
    points.join(" ")
}

/// 1, 2 or 5 times a power of ten, at least `least` and at least 1.
pub(super) fn axis_step(least: f64) -> f64 {
    let power = 10_f64.powf(least.max(1.0).log10().floor());
    [1.0, 2.0, 5.0, 10.0].into_iter().map(|factor| factor * power).find(|step| *step >= least).unwrap_or(10.0 * power)
}
