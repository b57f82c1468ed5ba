//! A part of a layout: some routes and what they need.

use std::collections::BTreeSet;

use crate::at::At;
use crate::derive;
use crate::description::Description;
use crate::form::{End, EndKind};
use crate::problem::{Errors, Problem};
use crate::rule::Rule;

/// The layout with the routes `wanted` alone and the circuits, points and segments that these need. Where tracks are cut off, the line
/// goes on unseen.
///
/// # Errors
/// That there is no such route.
pub fn only(description: &Description, wanted: &[String]) -> Result<Description, Errors> {
    let station = &description.station;
    let there = |name: &String| station.routes.iter().any(|route| route.name.value == *name);
    let missing = wanted.iter().filter(|name| !there(name)).map(|name| {
        let listed: Vec<&str> = station.routes.iter().take(8).map(|route| route.name.as_str()).collect();
        Problem::new(
            Rule::NoSuchName,
            &(0..0),
            format!("there is no route {name}"),
            format!("the first routes are {}", listed.join(", ")),
        )
    });
    let missing: Vec<Problem> = missing.collect();
    if !missing.is_empty() {
        return Err(Errors::new(&description.source, missing));
    }
    let model = derive::model(station, &mut Vec::new());
    let is_wanted = |name: &str| wanted.iter().any(|wanted| wanted == name);
    let mut kept = BTreeSet::new();
    let mut points = BTreeSet::new();
    for route in model.routes.iter().filter(|route| is_wanted(&route.name)) {
        kept.extend(route.held().into_iter().chain(route.beside()).chain([route.entry]));
        kept.extend(route.approach.iter().chain(&route.beyond));
        points.extend(route.positions().map(|(point, _)| point));
    }
    for point in &points {
        kept.extend(model.points[*point].circuit.iter().chain(&model.points[*point].detectors));
    }
    // A segment is kept whole if one of its circuits is.
    for segment in &model.segments {
        if segment.circuits.iter().any(|circuit| kept.contains(circuit)) {
            kept.extend(&segment.circuits);
        }
    }
    let circuit = |name: &At<String>| model.circuits.iter().position(|circuit| circuit.name == name.value);
    let is_kept = |name: &At<String>| circuit(name).is_some_and(|circuit| kept.contains(&circuit));
    let mut part = station.clone();
    part.circuits.retain(|circuit| is_kept(&circuit.name));
    part.points.retain(|point| is_kept(&point.circuit));
    for point in &mut part.points {
        point.fouled_in.retain(&is_kept);
        if let Some(detectors) = &mut point.detectors {
            detectors.retain(&is_kept);
        }
    }
    part.segments.retain(|segment| segment.circuits.iter().any(&is_kept));
    part.fouling.retain(|fouling| fouling.between.iter().all(&is_kept));
    for platform in &mut part.platforms {
        platform.circuits.retain(&is_kept);
    }
    part.platforms.retain(|platform| !platform.circuits.is_empty());
    part.routes.retain(|route| is_wanted(&route.name));
    for route in &mut part.routes {
        route.conflicts.retain(|name| is_wanted(name));
        if let Some(continuing) = &mut route.continuing {
            continuing.retain(|name| is_wanted(name));
        }
    }
    part.ends.clear();
    for joint in &model.graph.joints {
        let inside = joint.tracks.iter().filter(|track| kept.contains(&model.graph.tracks[**track].circuit)).count();
        if inside == 1 {
            let kind = joint.end.unwrap_or(EndKind::Line);
            part.ends.push(End { joint: At::derived(joint.name.clone()), kind });
        }
    }
    Ok(Description { station: part, source: description.source.clone() })
}
