//! A way through the circuits as the path of a route.

use std::collections::{BTreeMap, BTreeSet};

use crate::at::At;
use crate::form::{Element, Position, Station};
use crate::graph::Way;

/// The places of a way: its circuits with the points that it runs over.
pub fn path(station: &Station, way: &[(usize, Way)]) -> Vec<At<Element>> {
    let made = way.iter().map(|(circuit, way)| {
        let points = way
            .passed
            .iter()
            .map(|passed| (station.points[passed.point].name.value.clone(), At::derived(passed.position)));
        At::derived(Element { circuit: station.circuits[*circuit].name.value.clone(), points: points.collect() })
    });
    made.collect()
}

/// Has the first place of a path hold the points that it is not run over.
pub fn hold(station: &Station, path: &mut [At<Element>], way: &[(usize, Way)], positions: &BTreeMap<usize, Position>) {
    let run_over: BTreeSet<usize> = way.iter().flat_map(|(_, way)| &way.passed).map(|passed| passed.point).collect();
    for (point, position) in positions.iter().filter(|(point, _)| !run_over.contains(point)) {
        if let Some(first) = path.first_mut() {
            first.value.points.insert(station.points[*point].name.value.clone(), At::derived(*position));
        }
    }
}
