//! Values over time: curves, bands and staircases.

use svg::Node;
use svg::node::element::{Group, Title};

use super::ink::{FAINT, INK, LEFT, RIGHT, axis_step, dashes, line, paint, polyline, rectangle, round, text, width};
use super::plot::Plot;
use super::scene::{Scale, Tone};

/// Where a value stands between the two rows.
fn height(value: f64, scale: Scale, rows: (f64, f64)) -> f64 {
    let (high, low) = rows;
    low - (value.clamp(scale.bottom, scale.top) - scale.bottom) / (scale.top - scale.bottom) * (low - high)
}

/// The faint lines of a scale and their numbers.
fn scale_lines(body: &mut Group, scale: Scale, rows: (f64, f64)) {
    let step = axis_step((scale.top - scale.bottom) / 4.0);
    let mut value = (scale.bottom / step).ceil() * step;
    while value <= scale.top {
        let y = height(value, scale, rows);
        body.append(line(LEFT, y, RIGHT, y, FAINT));
        body.append(text(&format!("{}", round(value)), LEFT - 4.0, y - 2.0, "end").set("font-size", 11));
        value += step;
    }
}

impl Plot<'_> {
    /// Values over time, each from its cycle on; where there is none, a gap.
    pub(super) fn curve(
        &self,
        body: &mut Group,
        steps: &[(u64, Option<f64>)],
        tone: Tone,
        scale: Scale,
        rows: (f64, f64),
    ) {
        let height = |value: f64| height(value, scale, rows);
        if tone == Tone::Limit {
            // The scale belongs to the row: it is drawn with the first curve.
            scale_lines(body, scale, rows);
        }
        let mut piece: Vec<(f64, f64)> = Vec::new();
        let ends = steps.iter().skip(1).map(|step| step.0).chain([self.scene.cycles]);
        let mut pieces = Vec::new();
        for ((from, value), to) in steps.iter().zip(ends) {
            match (value, self.clip(*from, to)) {
                (Some(value), Some((left, right))) => piece.extend([(left, height(*value)), (right, height(*value))]),
                _ => pieces.push(std::mem::take(&mut piece)),
            }
        }
        pieces.push(piece);
        for piece in pieces.iter().filter(|piece| !piece.is_empty()) {
            let mut curve = polyline(piece).set("stroke", paint(tone).edge).set("stroke-width", 1.8);
            if dashes(tone) != "none" {
                curve = curve.set("stroke-dasharray", dashes(tone));
            }
            body.append(curve);
        }
    }

    /// A staircase, with each number over its step; where there is none, a gap.
    pub(super) fn steps(&self, body: &mut Group, steps: &[(u64, Option<u8>)], top: u8, rows: (f64, f64)) {
        let (high, low) = rows;
        let height = |number: u8| low - f64::from(number.min(top)) / f64::from(top.max(1)) * (low - high);
        let ends = steps.iter().skip(1).map(|step| step.0).chain([self.scene.cycles]);
        let (mut stair, mut written): (Vec<(f64, f64)>, _) = (Vec::new(), LEFT);
        let mut stairs = Vec::new();
        for ((from, number), to) in steps.iter().zip(ends) {
            let Some((left, right)) = self.clip(*from, to) else { continue };
            let Some(number) = *number else {
                stairs.push(std::mem::take(&mut stair));
                continue;
            };
            let y = height(number);
            body.append(rectangle(left, y, right, low).set("fill", "#e4e8ee"));
            stair.extend([(left, y), (right, y)]);
            let content = number.to_string();
            let half = width(&content) / 2.0;
            let middle = f64::midpoint(left, right);
            // A number that would stand on its neighbour is left out: the height says it.
            if middle - half >= written {
                body.append(text(&content, middle, y - 3.0, "middle"));
                written = middle + half + 2.0;
            }
        }
        stairs.push(stair);
        for stair in stairs.iter().filter(|stair| !stair.is_empty()) {
            body.append(polyline(stair).set("stroke", INK).set("stroke-width", 1.6));
        }
    }

    /// Everything from a lower to an upper value, each pair from its cycle on, with the row's scale.
    pub(super) fn band(
        &self,
        body: &mut Group,
        steps: &[(u64, Option<(f64, f64)>)],
        tone: Tone,
        scale: Scale,
        rows: (f64, f64),
    ) {
        scale_lines(body, scale, rows);
        let paint = paint(tone);
        let ends = steps.iter().skip(1).map(|step| step.0).chain([self.scene.cycles]);
        let mut edges: [Vec<(f64, f64)>; 2] = [Vec::new(), Vec::new()];
        let mut draw = |edges: &mut [Vec<(f64, f64)>; 2]| {
            let [lower, upper] = edges;
            if !lower.is_empty() {
                let outline: Vec<_> = lower.iter().copied().chain(upper.iter().rev().copied()).collect();
                body.append(polyline(&outline).set("fill", paint.fill));
                for edge in [&*lower, &*upper] {
                    body.append(polyline(edge).set("stroke", paint.edge).set("stroke-width", 1.2));
                }
            }
            lower.clear();
            upper.clear();
        };
        for ((from, pair), to) in steps.iter().zip(ends) {
            match (pair, self.clip(*from, to)) {
                (Some((lower, upper)), Some((left, right))) => {
                    for (edge, value) in edges.iter_mut().zip([lower, upper]) {
                        let y = height(*value, scale, rows);
                        edge.extend([(left, y), (right, y)]);
                    }
                }
                _ => draw(&mut edges),
            }
        }
        draw(&mut edges);
    }

    /// A short coloured span without a text.
    pub(super) fn tick(&self, body: &mut Group, span: (u64, u64), tone: Tone, hint: &str, rows: (f64, f64)) {
        let Some((left, right)) = self.clip(span.0, span.1) else { return };
        let paint = paint(tone);
        let mut shape = rectangle(left, rows.0, right.max(left + 1.5), rows.1).set("fill", paint.edge);
        shape.append(Title::new(format!("{hint}: {}", self.scene.unit.text(span.0))));
        body.append(shape);
    }

    /// A letter for each cycle from `from` on, if there is room for them.
    pub(super) fn letters(&self, body: &mut Group, from: u64, letters: &str, y: f64) {
        if self.x(1.0) - self.x(0.0) < 6.0 {
            return;
        }
        let middle = |at: u64| self.clip(at, at + 1).map(|(left, right)| f64::midpoint(left, right));
        let shown = letters.chars().zip(from..).filter_map(|(letter, at)| Some((letter, middle(at)?)));
        let (row, places): (String, Vec<_>) = shown.map(|(letter, x)| (letter, round(x).to_string())).unzip();
        // One text, each letter at its own place.
        body.append(text(&row, 0.0, y, "middle").set("x", places.join(" ")).set("font-size", 9));
    }
}
