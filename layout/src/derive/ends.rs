//! What lies beyond the ends of routes: neighbours, continuing routes, segments, throats; and the declared conflicts.

use std::collections::BTreeSet;

use super::values;
use crate::form::Station;
use crate::model::{Circuits, Model, Note, Route};
use crate::names::Names;
use crate::problem::Problem;
use crate::rule::Rule;

/// Fills in, for every route with a path, what depends on its ends.
pub fn ends(station: &Station, names: &Names, model: &mut Model, problems: &mut Vec<Problem>) {
    for number in 0..model.routes.len() {
        let given = &station.routes[number];
        let conflicts: BTreeSet<usize> =
            given.conflicts.iter().filter_map(|name| names.route(name, problems)).collect();
        let from = given.from.as_ref().map(|name| names.segment(name, problems));
        let to = given.to.as_ref().map(|name| names.segment(name, problems));
        let beyond = given.beyond.as_ref().map(|given| names.circuits(given, problems));
        let continuing: Option<BTreeSet<usize>> = given
            .continuing
            .as_ref()
            .map(|given| given.iter().filter_map(|name| names.route(name, problems)).collect());
        if !model.routes[number].is_sound() {
            continue;
        }
        let mut notes = Vec::new();
        let mut note = |text: String| notes.push(Note { about: format!("route {}", given.name), text });
        let route = &model.routes[number];
        let ahead = route.last().and_then(|last| model.graph.across(route.exit, last));
        let listed = |circuits: &Circuits| {
            circuits.iter().map(|circuit| model.circuits[*circuit].name.as_str()).collect::<Vec<_>>().join(", ")
        };
        let beyond = beyond.unwrap_or_else(|| {
            let beyond = if route.calling_on { ahead.into_iter().collect() } else { beyond_of(model, route, ahead) };
            note(format!("beyond the end: {}", listed(&beyond)));
            beyond
        });
        let continuing = continuing.unwrap_or_else(|| {
            let go_on = |other: &Route| {
                let there = other.start == route.exit && Some(other.entry) == route.last();
                other.is_sound() && there && !route.calling_on
            };
            let continuing: BTreeSet<usize> =
                (0..model.routes.len()).filter(|other| go_on(&model.routes[*other])).collect();
            if !continuing.is_empty() {
                let listed: Vec<&str> = continuing.iter().map(|other| model.routes[*other].name.as_str()).collect();
                note(format!("continued by {}", listed.join(", ")));
            }
            continuing
        });
        let segment_at = |circuit: Option<usize>| {
            (0..model.segments.len())
                .find(|segment| circuit.is_some() && model.segments[*segment].circuits.first() == circuit.as_ref())
        };
        let from = from.unwrap_or_else(|| {
            let from = segment_at(Some(route.entry));
            from.inspect(|segment| note(format!("comes from segment {}", model.segments[*segment].name)))
        });
        let to = to.unwrap_or_else(|| {
            let to = segment_at(ahead);
            to.inspect(|segment| note(format!("goes out to segment {}", model.segments[*segment].name)))
        });
        model.notes.extend(notes);
        if let (Some(from), Some(approach)) = (from, &given.approach_kmh) {
            let segment = &model.segments[from];
            let line = model.values.speeds_kmh[usize::from(segment.speed.0)];
            if line > approach.value {
                let what = format!(
                    "route {}: trains come up at {approach} km/h, and {} is for {line}",
                    given.name, segment.name
                );
                let right = format!("give the segment a speed_kmh of {approach} as well");
                problems.push(Problem::new(Rule::Range, &approach.span, what, right));
            }
        }
        let route = &mut model.routes[number];
        (route.conflicts, route.beyond, route.continuing) = (conflicts, beyond, continuing);
        (route.from, route.to) = (from, to);
    }
    throats(model);
    speeds(station, model, problems);
}

/// How fast trains come up to each signal: as fast as the line, and as the routes that end there; and how far back the approach must reach for that.
fn speeds(station: &Station, model: &mut Model, problems: &mut Vec<Problem>) {
    for number in 0..model.routes.len() {
        let route = &model.routes[number];
        let leads = |other: &&Route| {
            let there = other.exit == route.start || other.continuing.contains(&number);
            route.is_sound() && other.is_sound() && there && other.last() == Some(route.entry)
        };
        let kmh = |other: &Route| model.values.speeds_kmh[usize::from(other.speed.0)];
        let mut speed = route.approach_kmh;
        let fastest = model.routes.iter().filter(leads).max_by_key(|other| kmh(other));
        if let Some(fastest) = fastest.filter(|fastest| kmh(fastest) > speed) {
            let (name, fast) = (&route.name, kmh(fastest));
            if let Some(approach) = &station.routes[number].approach_kmh {
                let what = format!(
                    "route {name}: trains come up at {approach} km/h, and route {} leads there at {fast}",
                    fastest.name
                );
                let right = format!("give at least {fast} km/h, or route {} a lower speed_kmh", fastest.name);
                problems.push(Problem::new(Rule::Range, &approach.span, what, right));
            } else {
                let text = format!("trains come up at {fast} km/h: so fast route {} leads there", fastest.name);
                model.notes.push(Note { about: format!("route {name}"), text });
            }
            speed = fast;
        }
        model.routes[number].approach_kmh = speed;
        model.routes[number].approach_m = values::approach_m(&model.values, speed);
    }
}

/// The circuit ahead of the end, and the one in rear of the last circuit if trains leave it that way too.
fn beyond_of(model: &Model, route: &Route, ahead: Option<usize>) -> Circuits {
    let mut beyond: Circuits = ahead.into_iter().collect();
    let circuits: Vec<usize> = std::iter::once(route.entry).chain(route.circuits()).collect();
    if let [.., rear, last] = circuits[..] {
        let leaves = |other: &Route| other.is_sound() && other.entry == last && other.path[0].circuit == rear;
        if ahead.is_none() || model.routes.iter().any(leaves) {
            beyond.insert(rear);
        }
    }
    beyond
}

/// The throat of a segment that names none: the last circuit of the routes that go out to it.
fn throats(model: &mut Model) {
    for number in 0..model.segments.len() {
        if model.segments[number].throat.is_some() {
            continue;
        }
        let out = model.routes.iter().find(|route| route.to == Some(number));
        let Some(throat) = out.and_then(Route::last) else { continue };
        model.segments[number].throat = Some(throat);
        let text = format!("throat: {}", model.circuits[throat].name);
        model.notes.push(Note { about: format!("segment {}", model.segments[number].name), text });
    }
}
