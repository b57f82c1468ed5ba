//! The track plan as a drawing (SVG).

mod ink;
mod orient;
mod place;

use std::collections::{BTreeMap, BTreeSet};

use crate::form::{EndKind, Station};
use crate::graph::Kind;
use crate::model::Model;
use ink::{Drawn, Ink};
use orient::is_left;
use place::{Placed, ROW, by_reverse, place};

/// The margin around the tracks.
const MARGIN: i32 = 50;

/// The track plan of a layout. `station` gives its platforms. The first circuit of the file is left of the last one.
pub fn svg(station: &Station, model: &Model) -> String {
    drawn(station, model, true)
}

/// The same with the left ends of the file on the left: so it lies beside its neighbours, and a train that is told to
/// go right goes right.
pub fn svg_as_laid(station: &Station, model: &Model) -> String {
    drawn(station, model, false)
}

fn drawn(station: &Station, model: &Model, may_turn: bool) -> String {
    let placed = place(model, may_turn);
    let right = placed.joints.iter().map(|(x, _)| *x).max().unwrap_or(0);
    let bottom = placed.rows.iter().max().map_or(0, |row| i32::try_from(*row).unwrap_or(0) * ROW);
    let mut ink = Ink::new(&station.name, (right + 2 * MARGIN, bottom + 2 * MARGIN + 60), (MARGIN, MARGIN + 40));
    platforms(&mut ink, station, model, &placed);
    segments(&mut ink, model, &placed);
    tracks(&mut ink, model, &placed);
    joints(&mut ink, model, &placed);
    labels(&mut ink, model, &placed);
    signals(&mut ink, model, &placed);
    ink.finish()
}

fn tracks(ink: &mut Ink, model: &Model, placed: &Placed) {
    for (number, track) in model.graph.tracks.iter().enumerate() {
        let y = placed.y(number);
        let xs: Vec<i32> = track.joints.iter().map(|joint| placed.joints[*joint].0).collect();
        let circuit = &model.circuits[track.circuit].name;
        match track.kind {
            Kind::Plain => ink.track(&Drawn { circuit, number, leg: None }, &[(xs[0], y), (xs[1], y)]),
            Kind::Point(point) => {
                let leg = |reverse| Some((model.points[point].name.as_str(), reverse));
                let toward = if placed.joints[track.joints[1]].0 >= xs[0] { 1 } else { -1 };
                let blade = xs[0] + toward * 8;
                let (x, end) = placed.joints[track.joints[2]];
                ink.track(&Drawn { circuit, number, leg: leg(false) }, &[(xs[0], y), (xs[1], y)]);
                // A gap at the blade shows that the other leg is the normal one.
                let away = if end > y { 5 } else { -5 };
                let slant = (x - blade).abs().max(1);
                ink.track(
                    &Drawn { circuit, number, leg: leg(true) },
                    &[(blade + toward * (5 * slant / (end - y).abs().max(slant)).max(3), y + away), (x, end)],
                );
            }
        }
    }
}

/// Joints between circuits as ticks, ends as buffer stops or arrows.
fn joints(ink: &mut Ink, model: &Model, placed: &Placed) {
    let graph = &model.graph;
    for (number, joint) in graph.joints.iter().enumerate() {
        let (x, y) = placed.joints[number];
        let circuits: BTreeSet<usize> = graph.circuits_at(number).collect();
        match joint.end {
            Some(EndKind::Buffer) => ink.buffer((x, y)),
            Some(EndKind::Line) => {
                let to_left =
                    joint.tracks.first().is_some_and(|track| is_left(graph, *track, number, placed.flipped[*track]));
                ink.goes_on((x, y), if to_left { -1 } else { 1 });
            }
            None if circuits.len() > 1 => ink.joint((x, y), &joint.name),
            None => {}
        }
    }
}

/// Names of circuits above their longest piece, names of points at their blades.
fn labels(ink: &mut Ink, model: &Model, placed: &Placed) {
    let mut longest: BTreeMap<usize, (i32, i32, i32)> = BTreeMap::new();
    let mut with_plain = BTreeSet::new();
    let mut small: BTreeMap<usize, ((i32, i32), i32)> = BTreeMap::new();
    for (number, track) in model.graph.tracks.iter().enumerate() {
        let y = placed.y(number);
        let (one, other) = (placed.joints[track.joints[0]].0, placed.joints[track.joints[1]].0);
        if track.kind == Kind::Plain {
            with_plain.insert(track.circuit);
        }
        let label = ((one - other).abs(), (one + other) / 2, y);
        let known = longest.entry(track.circuit).or_insert(label);
        if label.0 > known.0 {
            *known = label;
        }
        if let Kind::Point(point) = track.kind {
            let toward = if other >= one { 1 } else { -1 };
            // Names stand where the reverse leg does not run: the point's at its blades, the circuit's behind them.
            let (height, away) = if placed.joints[track.joints[2]].1 > y { (y - 7, -1) } else { (y + 15, 1) };
            ink.point((one + toward * 10, height), away, &model.points[point].name);
            small.entry(track.circuit).or_insert(((one + toward * 44, height), away));
        }
    }
    for (circuit, (_, x, y)) in longest {
        let name = &model.circuits[circuit].name;
        match small.get(&circuit) {
            Some((place, away)) if !with_plain.contains(&circuit) => ink.small_circuit(*place, *away, name),
            _ => ink.circuit((x, y - 6), name),
        }
    }
}

/// A signal for each name and joint, at the left of the track as its train runs.
fn signals(ink: &mut Ink, model: &Model, placed: &Placed) {
    let mut drawn = BTreeSet::new();
    for route in model.routes.iter().filter(|route| route.is_sound()) {
        if !drawn.insert((route.start, route.entry, route.signal.clone())) {
            continue;
        }
        let graph = &model.graph;
        let rear = graph.joints[route.start].tracks.iter().find(|track| graph.tracks[**track].circuit == route.entry);
        let Some(rear) = rear else { continue };
        let to_right = !is_left(graph, *rear, route.start, placed.flipped[*rear]);
        let (x, y) = placed.joints[route.start];
        let y = if by_reverse(graph, *rear, route.start) { y } else { placed.y(*rear) };
        ink.signal((x, y), if to_right { 1 } else { -1 }, &route.signal);
    }
}

/// The stretch that some circuits cover in each row: row height, left and right.
fn stretches(model: &Model, placed: &Placed, circuits: &BTreeSet<usize>) -> BTreeMap<i32, (i32, i32)> {
    let mut found: BTreeMap<i32, (i32, i32)> = BTreeMap::new();
    for (number, track) in model.graph.tracks.iter().enumerate() {
        if circuits.contains(&track.circuit) {
            let stretch = found.entry(placed.y(number)).or_insert((i32::MAX, i32::MIN));
            for joint in track.joints.iter().take(2) {
                let x = placed.joints[*joint].0;
                *stretch = (stretch.0.min(x), stretch.1.max(x));
            }
        }
    }
    found
}

fn segments(ink: &mut Ink, model: &Model, placed: &Placed) {
    for segment in &model.segments {
        let circuits = segment.circuits.iter().copied().collect();
        for (y, (left, right)) in stretches(model, placed, &circuits) {
            ink.segment((left, right), y, &segment.name);
        }
    }
}

fn platforms(ink: &mut Ink, station: &Station, model: &Model, placed: &Placed) {
    for platform in &station.platforms {
        let named = |circuit: &usize| platform.circuits.iter().any(|name| name.value == model.circuits[*circuit].name);
        let circuits = (0..model.circuits.len()).filter(named).collect();
        for (y, (left, right)) in stretches(model, placed, &circuits) {
            ink.platform((left, right), y, &platform.name);
        }
    }
}
