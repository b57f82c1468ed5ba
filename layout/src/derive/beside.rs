//! The circuits beside a path that are proved clear and not run over.

use std::collections::BTreeSet;

use crate::form::Station;
use crate::model::{Circuits, Model, Note, Route};
use crate::names::Names;
use crate::problem::Problem;
use crate::rule::Rule;

/// Fills in what is beside the places of every route with a path: of each pair of circuits that foul each other, the one that it does not hold itself;
/// and what the file names for the route, beside all of its path.
pub fn beside(station: &Station, names: &Names, model: &mut Model, problems: &mut Vec<Problem>) {
    let pairs = fouling(model);
    for number in 0..model.routes.len() {
        let mut route = std::mem::take(&mut model.routes[number]);
        if route.is_sound() {
            of_pairs(model, &pairs, &mut route);
            for name in &station.routes[number].proved_clear {
                let Some(circuit) = names.circuit(name, problems) else { continue };
                if route.held().contains(&circuit) || circuit == route.entry {
                    let what = format!("route {}: {name} is its own", route.name);
                    let right = "name only circuits that it does not run over, and not its entry";
                    problems.push(Problem::new(Rule::ProvedClearOwn, &name.span, what, right));
                    continue;
                }
                for place in &mut route.path {
                    place.beside.insert(circuit);
                }
            }
        }
        model.routes[number] = route;
    }
}

/// Every pair of circuits that foul each other: as the file has them, and of points those in which they are fouled.
fn fouling(model: &Model) -> BTreeSet<(usize, usize)> {
    let of_points = model.points.iter().flat_map(|point| {
        let others = point.detectors.iter().copied();
        point.circuit.into_iter().flat_map(move |own| others.clone().map(move |other| (own, other)))
    });
    let both = |(one, other)| [(one, other), (other, one)];
    model.fouling.iter().copied().chain(of_points).flat_map(both).filter(|(one, other)| one != other).collect()
}

fn of_pairs(model: &mut Model, pairs: &BTreeSet<(usize, usize)>, route: &mut Route) {
    let own = route.held();
    let entry = route.entry;
    let found = |over: usize| -> Circuits {
        let others = pairs.iter().filter(|(one, _)| *one == over).map(|(_, other)| *other);
        others.filter(|other| *other != entry && !own.contains(other)).collect()
    };
    for place in &mut route.path {
        place.beside.extend(found(place.circuit));
    }
    route.overlap_beside = route.overlap.iter().flat_map(|over| found(*over)).collect();
    for circuit in route.beside() {
        let text = format!("{} proved clear: it fouls a circuit that the route holds", model.circuits[circuit].name);
        model.notes.push(Note { about: format!("route {}", route.name), text });
    }
}
