//! The positions that a route needs beyond the points it runs over: flank points, and points that a circuit of the path detects.

use super::flank::{Path, Signals, beside, guards};
use super::way::of_segment;
use crate::form::Position;
use crate::model::{Circuits, Flank, Guard, Model, Note, Positions, Route, Segment};

/// Fills in the flank protection and the positions of every route with a path, and the flank protection of the segments.
pub fn positions(model: &mut Model) {
    let signals: Signals = model
        .routes
        .iter()
        .filter(|route| route.is_sound())
        .map(|route| (route.start, route.entry, route.signal.clone()))
        .collect();
    for number in 0..model.routes.len() {
        let mut route = std::mem::take(&mut model.routes[number]);
        if route.is_sound() {
            flanks(model, &signals, &mut route);
            detected(model, &mut route);
        }
        model.routes[number] = route;
    }
    for number in 0..model.segments.len() {
        model.segments[number].flanks = crossed(model, &signals, &model.segments[number]);
    }
}

fn path(route: &Route) -> Path {
    let passed = route.path.iter().flat_map(|place| &place.passed);
    Path {
        points: passed.map(|passed| (passed.point, passed.position)).collect(),
        circuits: route.circuits().collect(),
    }
}

fn flanks(model: &mut Model, signals: &Signals, route: &mut Route) {
    let path = path(route);
    for number in 0..route.path.len() {
        let place = &route.path[number];
        for (track, end) in beside(&model.graph, place.circuit, &place.tracks, &place.passed) {
            let guards = guards(&model.graph, signals, &path, track, end);
            let flank = Flank { track, end, guards };
            for guard in &flank.guards {
                let Guard::Point(point, position) = guard else { continue };
                // What the file gives stands; whether it protects is checked later.
                if route.path.iter().any(|place| place.positions.contains_key(point)) {
                    continue;
                }
                route.path[number].positions.insert(*point, *position);
                let text = format!(
                    "point {} {} as flank protection of {}",
                    model.points[*point].name,
                    word(*position),
                    flank.of(model)
                );
                model.notes.push(Note { about: format!("route {}", route.name), text });
            }
            route.flanks.push(flank);
        }
    }
}

/// The protection of plain line where other tracks cross it: no point is held for it.
fn crossed(model: &Model, signals: &Signals, segment: &Segment) -> Vec<Flank> {
    let path = Path { points: Positions::new(), circuits: segment.circuits.iter().copied().collect() };
    let ways = of_segment(model, segment, &[]).unwrap_or_default();
    let mut found = Vec::new();
    for (place, circuit) in segment.circuits.iter().enumerate() {
        // Where the file does not say which of two tracks is the line, each is asked for.
        let over =
            |track: &usize| ways.iter().all(|way| way.ways.get(place).is_some_and(|way| way.tracks.contains(track)));
        let run: Vec<usize> = (0..model.graph.tracks.len()).filter(over).collect();
        for (track, end) in beside(&model.graph, *circuit, &run, &[]) {
            found.push(Flank { track, end, guards: guards(&model.graph, signals, &path, track, end) });
        }
    }
    found
}

/// Positions the points whose detectors are among the circuits of a place, as the kernel's rule asks.
fn detected(model: &mut Model, route: &mut Route) {
    let mut needed: Positions = route.positions().collect();
    for place in 0..=route.path.len() {
        let circuits: Circuits = match route.path.get(place) {
            Some(place) => [place.circuit].into(),
            None => route.overlap.iter().copied().collect(),
        };
        for point in 0..model.points.len() {
            let positions = route.path.get(place).map_or(&route.overlap_positions, |place| &place.positions);
            if positions.contains_key(&point) || model.points[point].detectors.is_disjoint(&circuits) {
                continue;
            }
            let position = *needed.entry(point).or_insert_with(|| {
                let position = away_from(model, point, &circuits);
                let text = format!(
                    "point {} {}: it is not run over, but detected there",
                    model.points[point].name,
                    word(position)
                );
                model.notes.push(Note { about: format!("route {}", route.name), text });
                position
            });
            match route.path.get_mut(place) {
                Some(place) => place.positions.insert(point, position),
                None => route.overlap_positions.insert(point, position),
            };
        }
    }
}

/// The position whose leg does not lead to one of `circuits`; normal if both do, or neither.
fn away_from(model: &Model, point: usize, circuits: &Circuits) -> Position {
    let track = model.graph.of_point(point).map(|track| &model.graph.tracks[track]);
    let leads = |leg: usize| {
        track.is_some_and(|track| {
            model.graph.circuits_at(track.joints[leg]).any(|at| at != track.circuit && circuits.contains(&at))
        })
    };
    if leads(1) && !leads(2) { Position::Reverse } else { Position::Normal }
}

/// The other position.
pub const fn opposite(position: Position) -> Position {
    match position {
        Position::Normal => Position::Reverse,
        Position::Reverse => Position::Normal,
    }
}

/// A position as a word.
pub const fn word(position: Position) -> &'static str {
    match position {
        Position::Normal => "normal",
        Position::Reverse => "reverse",
    }
}
