//! Stations of many shapes.

use atc_layout::At;
use atc_layout::form::{Element, Station};

use super::{East, at, circuit, element, station as ladders};

/// The shape of a station.
#[derive(Clone, Debug)]
pub struct Shape {
    /// How many tracks, 2 or more.
    pub tracks: usize,
    /// Whether the last one ends at a buffer stop.
    pub bay: bool,
    /// The lengths of circuits, in turn, in metres.
    pub lengths: Vec<u16>,
    /// Into how many circuits the tracks are divided, in turn.
    pub splits: Vec<usize>,
}

/// The station of a shape: ladders of points at either end, tracks of one or more circuits between them.
pub fn station(shape: &Shape) -> Station {
    let bay = shape.bay && shape.tracks > 2;
    let mut made = ladders(shape.tracks, if bay { East::OneBay } else { East::AllThrough });
    for track in 1..=shape.tracks {
        split(&mut made, track, shape.splits[track % shape.splits.len()]);
    }
    for (number, circuit) in made.circuits.iter_mut().enumerate() {
        // The line is as long as braking needs it.
        let is_line = ["W1", "W2", "E1", "E2"].contains(&circuit.name.value.as_str());
        let length = if is_line { 600 } else { shape.lengths[number % shape.lengths.len()] };
        circuit.length_m = At::derived(length);
    }
    // How long an overlap and an approach are is not what is looked at.
    made.overlaps.least_m = At::derived(1);
    made
}

/// Divides a track into so many circuits, from west to east.
fn split(made: &mut Station, track: usize, parts: usize) {
    if parts < 2 {
        return;
    }
    let whole = format!("{track}T");
    let Some(place) = made.circuits.iter().position(|circuit| circuit.name.value == whole) else { return };
    let name = |part: usize| format!("{track}T{part}");
    let joint = |part: usize| match part {
        0 => format!("W{track}"),
        part if part == parts => format!("E{track}"),
        part => format!("t{track}.{part}"),
    };
    let new = (0..parts).map(|part| circuit(name(part), 100, Some((joint(part), joint(part + 1)))));
    made.circuits.splice(place..=place, new);
    made.platforms.retain(|platform| platform.circuits.iter().all(|circuit| circuit.value != whole));
    for route in &mut made.routes {
        let from_west = route.name.value.starts_with('W');
        if route.entry.value == whole {
            route.entry = at(name(if route.name.value.ends_with("-W") { 0 } else { parts - 1 }));
        }
        if let Some(place) = route.path.iter().position(|element| element.circuit == whole) {
            let order: Vec<usize> = if from_west { (0..parts).collect() } else { (0..parts).rev().collect() };
            let new: Vec<At<Element>> = order.into_iter().map(|part| element(name(part))).collect();
            route.path.splice(place..=place, new);
        }
    }
}
