//! Left and right: which way every track lies, and in which direction of travel routes and segments lead.

use atc_kernel::interlocking::Heading;

use crate::at::At;
use crate::form::Station;
use crate::graph::{Graph, Kind};
use crate::model::{Model, Note};
use crate::names::Names;
use crate::problem::Problem;
use crate::rule::Rule;

/// For each track whether it lies the other way round, its left end or the toe of its point towards the right; and a joint where that is true and
/// false at once.
///
/// Tracks that meet have left and right in common. Of those that hang together most plain ones say which is which.
fn lie(graph: &Graph) -> (Vec<bool>, Option<usize>) {
    let mut turned: Vec<Option<bool>> = vec![None; graph.tracks.len()];
    let mut round = None;
    for first in 0..graph.tracks.len() {
        if turned[first].is_some() {
            continue;
        }
        turned[first] = Some(false);
        let mut together = vec![first];
        let mut looked_at = 0;
        while let Some(track) = together.get(looked_at).copied() {
            looked_at += 1;
            let here = turned[track].unwrap_or_default();
            for joint in &graph.tracks[track].joints {
                for next in graph.joints[*joint].tracks.iter().copied().filter(|next| *next != track) {
                    // One has its right end there, the other its left one.
                    let lies = here ^ (at_left(graph, track, *joint) == at_left(graph, next, *joint));
                    match turned[next] {
                        None => {
                            turned[next] = Some(lies);
                            together.push(next);
                        }
                        Some(known) if known != lies => round = round.or(Some(*joint)),
                        Some(_) => {}
                    }
                }
            }
        }
        let plain = together.iter().filter(|track| graph.tracks[**track].kind == Kind::Plain);
        let (against, with): (Vec<usize>, Vec<usize>) = plain.partition(|track| turned[**track] == Some(true));
        if against.len() > with.len() {
            for track in together {
                turned[track] = turned[track].map(|turned| !turned);
            }
        }
    }
    (turned.into_iter().map(Option::unwrap_or_default).collect(), round)
}

/// For each track whether it lies the other way round. That no plain one does, and that left is not right, is checked.
pub fn turned(graph: &Graph, station: &Station, problems: &mut Vec<Problem>) -> Vec<bool> {
    let (turned, round) = lie(graph);
    if let Some(joint) = round {
        let joint = &graph.joints[joint];
        let what = format!(
            "at joint {} left and right change places: a train that ran round came back facing the other way",
            joint.name
        );
        let right = "divide the station there: a telegram says left or right, and no track may be both";
        problems.push(Problem::new(Rule::TurningLoop, &joint.span, what, right));
        return turned;
    }
    for (track, _) in graph.tracks.iter().zip(&turned).filter(|(track, turned)| **turned && track.kind == Kind::Plain) {
        let circuit = &station.circuits[track.circuit].name;
        let what = format!("left and right of circuit {circuit} are the other way round than those of most tracks");
        problems.push(Problem::new(Rule::SidesDiffer, &circuit.span, what, "change its left and right over"));
    }
    turned
}

/// Changes left and right over where a plain track lies the other way round than most: for files that do not say what is left.
pub fn align(station: &mut Station) {
    let mut ignored = Vec::new();
    let names = Names::of(station, &mut ignored);
    let graph = Graph::of(station, &names, &mut ignored);
    let (turned, _) = lie(&graph);
    for (track, _) in graph.tracks.iter().zip(turned).filter(|(track, turned)| *turned && track.kind == Kind::Plain) {
        let circuit = &mut station.circuits[track.circuit];
        let is_it = |left: &At<String>| graph.joints[track.joints[0]].name == left.value;
        if circuit.left.as_ref().is_some_and(is_it) {
            core::mem::swap(&mut circuit.left, &mut circuit.right);
            core::mem::swap(&mut circuit.left_unprotected, &mut circuit.right_unprotected);
        } else if let Some(crossing) = circuit.crossings.iter_mut().find(|crossing| is_it(&crossing.left)) {
            core::mem::swap(&mut crossing.left, &mut crossing.right);
            core::mem::swap(&mut crossing.left_unprotected, &mut crossing.right_unprotected);
        }
    }
}

/// Whether a track has its left end, or the toe of its point, at a joint.
fn at_left(graph: &Graph, track: usize, joint: usize) -> bool {
    graph.tracks[track].joints.first() == Some(&joint)
}

/// The direction of travel of a train that goes into `circuit` over `joint`.
pub fn into(graph: &Graph, turned: &[bool], circuit: usize, joint: usize) -> Heading {
    let enters = |track: &usize| graph.tracks[*track].circuit == circuit;
    let track = graph.joints[joint].tracks.iter().copied().find(enters);
    let from_left = track.is_none_or(|track| at_left(graph, track, joint) ^ turned[track]);
    if from_left { Heading::Right } else { Heading::Left }
}

/// The direction of travel out to each segment, from its routes or its circuits; and the conflicts of routes that start from one circuit in
/// opposite directions.
pub fn segments_and_starts(model: &mut Model, turned: &[bool]) {
    for number in 0..model.segments.len() {
        let routes = || model.routes.iter().filter(|route| route.is_sound());
        let out = routes().find(|route| route.to == Some(number)).map(|route| route.heading);
        let within = routes().find(|route| route.from == Some(number)).map(|route| route.heading.opposite());
        let by_tracks = || match model.segments[number].circuits[..] {
            [inner, outer, ..] => {
                let joint = model.graph.between(inner, outer).first().copied();
                joint.map(|joint| into(&model.graph, turned, outer, joint))
            }
            _ => None,
        };
        model.segments[number].outward = out.or(within).or_else(by_tracks).unwrap_or(Heading::Right);
        let segment = &model.segments[number];
        if let (true, 0, Some(outermost)) = (out.is_some(), segment.shared, segment.circuits.last()) {
            let circuit = &model.circuits[*outermost].name;
            let text =
                format!("no circuit is shared with the neighbour: a train out on {circuit} is told to stop there");
            model.notes.push(Note { about: format!("segment {}", segment.name), text });
        }
    }
    for one in 0..model.routes.len() {
        for other in 0..model.routes.len() {
            let (route, against) = (&model.routes[one], &model.routes[other]);
            if route.is_sound() && against.is_sound() && route.opposes_the_start_of(against) {
                let text = format!("excludes {}, which starts there in the other direction", against.name);
                model.notes.push(Note { about: format!("route {}", route.name), text });
                model.routes[one].conflicts.insert(other);
            }
        }
    }
}
