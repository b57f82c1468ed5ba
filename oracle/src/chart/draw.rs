//! Scenes as SVG: black on white, few colours, no scripts, no ids and no style sheets, so that several charts can
//! stand in one page.

use svg::node::element::{Group, Polygon, Rectangle, SVG, Title};
use svg::{Document, Node};

use super::distance;
use super::ink::{
    FAINT, INK, LEFT, RIGHT, axis_step, dashes, join, line, paint, polyline, rectangle, round, sign_at, text, width,
    wrap,
};
use super::plot::{Plot, float};
use super::scene::{Lane, Mark, Scene, Sign, Tone};
use super::view::{Part, View};
use crate::trace::error::TraceError;
use atc_protocol::form::Fault;

const WIDTH: f64 = 1000.0;
const TEXT: f64 = 12.0;

pub(super) fn svg(scenes: &[Scene], view: &View) -> Result<String, TraceError> {
    let mut body =
        Group::new().set("font-family", "Helvetica, Arial, sans-serif").set("font-size", TEXT).set("fill", INK);
    let mut y = 14.0;
    let heading = view.title.as_deref().or(scenes.first().map(|scene| scene.machine)).unwrap_or_default();
    let figure = distance::of_all(scenes);
    if let (Some(figure), true) = (&figure, view.only != Some(Part::Rows)) {
        y = distance::draw(figure, &mut body, heading, y);
    } else if view.only == Some(Part::Figure) {
        let what = format!("the cases of {heading} have no figure, only rows over time");
        return Err(TraceError { line: 0, fault: Fault::whole(what) });
    }
    let scenes = if view.only == Some(Part::Figure) { &[] } else { scenes };
    for (place, scene) in scenes.iter().enumerate() {
        let plot = Plot::new(scene, view, place)?;
        let title = if scenes.len() > 1 { format!("{heading} — case {}", place + 1) } else { heading.to_owned() };
        y = plot.draw(&mut body, &title, y);
    }
    let paper = Rectangle::new().set("width", WIDTH).set("height", round(y)).set("fill", "#ffffff");
    let document: SVG = Document::new()
        .set("viewBox", (0, 0, 1000, round(y)))
        .set("width", WIDTH)
        .set("height", round(y))
        .set("role", "img")
        .add(Title::new(heading))
        .add(paper)
        .add(body);
    Ok(format!("{document}\n"))
}

impl Plot<'_> {
    /// Draws the scene from `y` down and returns where it ends.
    fn draw(&self, body: &mut Group, title: &str, mut y: f64) -> f64 {
        y += 12.0;
        body.append(text(title, 14.0, y, "start").set("font-size", 17).set("font-weight", "bold"));
        for note in &self.scene.notes {
            let warning = note.starts_with("THE RECORD");
            for line in wrap(note, 168) {
                y += 18.0;
                let mut node = text(line, 14.0, y, "start");
                if warning {
                    node = node.set("fill", "#b00000").set("font-weight", "bold");
                }
                body.append(node);
            }
        }
        y += 14.0;
        let top = y;
        let foot = top + self.scene.lanes.iter().map(lane_height).sum::<f64>();
        self.grid(body, top, foot);
        for lane in &self.scene.lanes {
            self.lane(body, lane, y);
            y += lane_height(lane);
        }
        for guide in &self.scene.guides {
            let at = float(*guide);
            if self.from < at && at < self.to {
                body.append(line(self.x(at), top, self.x(at), foot, "#888888").set("stroke-dasharray", "3 3"));
            }
        }
        body.append(line(LEFT, foot, RIGHT, foot, INK));
        self.legend(body, foot + 44.0)
    }

    /// The time axis and its faint lines.
    fn grid(&self, body: &mut Group, top: f64, foot: f64) {
        let per_cycle = f64::from(self.scene.unit.per_cycle);
        let (from, to) = (self.from * per_cycle, self.to * per_cycle);
        let step = axis_step((to - from) / 10.0);
        let mut value = (from / step).ceil() * step;
        while value <= to {
            let x = self.x(value / per_cycle);
            body.append(line(x, top, x, foot, FAINT));
            body.append(line(x, foot, x, foot + 5.0, INK));
            body.append(text(&format!("{}", round(value)), x, foot + 18.0, "middle"));
            value += step;
        }
        body.append(text(
            &format!("{}, {}", self.scene.unit.axis, self.scene.unit.name),
            LEFT - 12.0,
            foot + 18.0,
            "end",
        ));
    }

    fn lane(&self, body: &mut Group, lane: &Lane, y: f64) {
        let height = lane_height(lane);
        if lane.first {
            body.append(line(14.0, y, RIGHT, y, "#777777"));
        }
        let (mut curves, mut bars, mut dimensions) = (false, false, false);
        for mark in &lane.marks {
            curves |= matches!(mark, Mark::Curve { .. } | Mark::Band { .. });
            bars |= matches!(mark, Mark::Bar { .. });
            dimensions |= matches!(mark, Mark::Dimension { .. });
        }
        // Dimensions under bars have a strip of their own; the numbers of a scale stand where the label would.
        let strip = if bars && dimensions { 22.0 } else { 0.0 };
        let label_y = if curves { y + 16.0 } else { y + (height - strip) / 2.0 + 4.0 };
        let mut label = text(&lane.label, LEFT - if curves { 36.0 } else { 12.0 }, label_y, "end");
        if lane.first {
            label = label.set("font-size", 13).set("font-weight", "bold");
        }
        body.append(label);
        let mut written = LEFT;
        for (place, mark) in lane.marks.iter().enumerate() {
            match mark {
                Mark::Wave(spans) => self.wave(body, spans, y + 8.0, y + height - 6.0),
                Mark::Bar { from, to, tone, texts } => {
                    let next = lane.marks[place + 1..].iter().find_map(|mark| match mark {
                        Mark::Bar { from, .. } => Some(*from),
                        _ => None,
                    });
                    let room = next.map_or(RIGHT, |next| self.x(float(next).min(self.to)));
                    self.bar(body, (*from, *to), *tone, texts, (y + 3.0, y + height - strip - 3.0), room);
                }
                Mark::Dimension { from, to, text } => {
                    let below = if bars { 6.0 } else { 13.0 };
                    self.dimension(body, (*from, *to), text, y + height - below, &mut written);
                }
                Mark::Sign { at, sign } => self.sign(body, *at, *sign, y + height - 3.0),
                Mark::Curve { points, tone, scale } => {
                    self.curve(body, points, *tone, *scale, (y + 8.0, y + height - 8.0));
                }
                Mark::Band { points, tone, scale } => {
                    self.band(body, points, *tone, *scale, (y + 8.0, y + height - 8.0));
                }
                Mark::Tick { from, to, tone, hint } => {
                    self.tick(body, (*from, *to), *tone, hint, (y + 4.0, y + height - 4.0));
                }
                Mark::Letters { from, text } => self.letters(body, *from, text, y + height - 5.0),
                Mark::Steps { points, top } => self.steps(body, points, *top, (y + 16.0, y + height - 7.0)),
            }
        }
    }

    fn wave(&self, body: &mut Group, spans: &[(u64, u64)], high: f64, low: f64) {
        let mut points = vec![(LEFT, low)];
        for (from, to) in spans {
            if let Some((left, right)) = self.clip(*from, *to) {
                body.append(rectangle(left, high, right, low).set("fill", "#e4e8ee"));
                points.extend([(left, low), (left, high), (right, high), (right, low)]);
            }
        }
        points.push((RIGHT, low));
        body.append(polyline(&points).set("stroke", INK).set("stroke-width", 1.6));
    }

    fn bar(&self, body: &mut Group, span: (u64, u64), tone: Tone, texts: &[String], rows: (f64, f64), room: f64) {
        let Some((left, right)) = self.clip(span.0, span.1) else { return };
        let (top, bottom) = rows;
        let paint = paint(tone);
        let mut shape = rectangle(left, top, right, bottom).set("fill", paint.fill).set("stroke", paint.edge);
        if tone == Tone::Blank {
            shape = shape.set("stroke-dasharray", "4 3");
        }
        if let Some(full) = texts.first() {
            let unit = self.scene.unit;
            let hint = format!("{full}: {} to {} {}", unit.value(span.0), unit.value(span.1), unit.name);
            shape.append(Title::new(hint));
        }
        body.append(shape);
        let middle = f64::midpoint(top, bottom) + 4.0;
        // A longer text beside the bar says more than a short one in it.
        for content in texts {
            let length = width(content);
            if length + 6.0 <= right - left {
                body.append(text(content, f64::midpoint(left, right), middle, "middle").set("fill", paint.ink));
                return;
            }
            if length + 16.0 <= room - right {
                body.append(text(content, right + 9.0, middle, "start"));
                return;
            }
        }
    }

    /// A measured span. `written` is how far to the right this row has text already.
    fn dimension(&self, body: &mut Group, span: (u64, u64), measured: &str, y: f64, written: &mut f64) {
        let Some((left, right)) = self.clip(span.0, span.1) else { return };
        // In a narrow span the arrows stand outside and point at it.
        let narrow = right - left < 16.0;
        let reach = if narrow { 12.0 } else { 0.0 };
        body.append(line(left - reach, y, right + reach, y, "#444444"));
        for (tip, way) in [(left, 6.0), (right, -6.0)] {
            let tail = if narrow { tip - way } else { tip + way };
            let points = [(tip, y), (tail, y - 3.0), (tail, y + 3.0)];
            body.append(Polygon::new().set("points", join(&points)).set("fill", "#444444"));
        }
        let half = width(measured) / 2.0;
        let middle = f64::midpoint(left, right).clamp(LEFT + half, RIGHT - half);
        if middle - half >= *written {
            body.append(text(measured, middle, y - 4.0, "middle"));
            *written = middle + half + 4.0;
        }
    }

    fn sign(&self, body: &mut Group, at: u64, sign: Sign, y: f64) {
        let at = float(at);
        if self.from <= at && at <= self.to {
            sign_at(body, self.x(at), y, sign);
        }
    }

    fn legend(&self, body: &mut Group, mut y: f64) -> f64 {
        let mut x = LEFT;
        let curves =
            self.scene.lanes.iter().any(|lane| lane.marks.iter().any(|mark| matches!(mark, Mark::Curve { .. })));
        let marks = || self.scene.lanes.iter().flat_map(|lane| &lane.marks);
        for (tone, name) in &self.scene.legend {
            let used = marks().any(|mark| match mark {
                Mark::Bar { tone: used, .. }
                | Mark::Tick { tone: used, .. }
                | Mark::Band { tone: used, .. }
                | Mark::Curve { tone: used, .. } => used == tone,
                _ => false,
            });
            if !used {
                continue;
            }
            let length = 34.0 + width(name);
            if x + length > RIGHT {
                x = LEFT;
                y += 20.0;
            }
            let paint = paint(*tone);
            if curves && matches!(tone, Tone::Signal | Tone::Limit | Tone::Code) {
                let dashes = dashes(*tone);
                body.append(
                    line(x, y - 4.0, x + 18.0, y - 4.0, paint.edge)
                        .set("stroke-width", 1.8)
                        .set("stroke-dasharray", dashes),
                );
            } else {
                body.append(
                    rectangle(x, y - 10.0, x + 18.0, y + 1.0).set("fill", paint.fill).set("stroke", paint.edge),
                );
            }
            body.append(text(name, x + 23.0, y, "start"));
            x += length;
        }
        for (sign, name) in [(Sign::Accepted, "accepted"), (Sign::Gone, "gone")] {
            if self
                .scene
                .lanes
                .iter()
                .flat_map(|lane| &lane.marks)
                .any(|mark| matches!(mark, Mark::Sign { sign: s, .. } if *s == sign))
            {
                if x + 24.0 + width(name) > RIGHT {
                    x = LEFT;
                    y += 20.0;
                }
                sign_at(body, x + 6.0, y, sign);
                body.append(text(name, x + 16.0, y, "start"));
                x += 28.0 + width(name);
            }
        }
        y + 26.0
    }
}

fn lane_height(lane: &Lane) -> f64 {
    f64::from(lane.height)
}
