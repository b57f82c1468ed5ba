//! Circuits and points: their lengths, borders, legs and times.

use std::collections::{BTreeMap, BTreeSet};

use roxmltree::Node;

use super::difference::Difference;
use super::file::{Divider, End, File, figure, milliseconds, refers};
use super::positions::left_is_normal;
use crate::model::{Model, Route};
use crate::problem::Source;

/// A metre is lost in the digits of coordinates and in rounding.
const SLACK: f64 = 1.0;

/// Everything in which circuits, points and segments differ.
pub fn differences(file: &File<'_>, model: &Model, source: &Source) -> Vec<Difference> {
    let mut found = Vec::new();
    // Each route that counts on it has the difference; where none does, nobody.
    let mut differs = |id: &str, what: String, counts: &dyn Fn(&Route) -> bool| {
        let place = file.by_id(id).and_then(|node| source.place(&(node.range().start..node.range().start + 1)));
        let before = found.len();
        for route in model.routes.iter().filter(|route| counts(route)) {
            found.push(Difference { route: Some(route.name.clone()), what: what.clone(), place });
        }
        if found.len() == before {
            found.push(Difference { route: None, what, place });
        }
    };
    for (number, circuit) in model.circuits.iter().enumerate() {
        let over = |route: &Route| {
            route.entry == number || route.circuits().any(|one| one == number) || route.overlap.contains(&number)
        };
        let ids: Vec<&str> = file.sections.keys().copied().filter(|id| file.means(&circuit.name, id)).collect();
        let Some(id) = ids.first() else { continue };
        let borders = file.sections.get(id).cloned().unwrap_or_default();
        let is_there = |joint: &str| borders.iter().any(|border| file.means(joint, border));
        for joint in model.graph.borders(number).into_iter().filter_map(|joint| model.graph.joints.get(joint)) {
            // Ends of the tracks need not be named.
            if joint.end.is_none() && !is_there(&joint.name) && !same_place(file, &joint.name, &borders) {
                differs(
                    id,
                    format!(
                        "circuit {} ends at joint {}, which is no border of it in the file",
                        circuit.name, joint.name
                    ),
                    &over,
                );
            }
        }
        let is_less = |shortest: &f64| f64::from(circuit.length.0) > shortest + SLACK;
        if let Some(shortest) = shortest(file, &borders).filter(is_less) {
            let what =
                format!("circuit {} is {} m long, and in the file {shortest:.1} m", circuit.name, circuit.length.0);
            differs(id, what, &over);
        }
    }
    for (number, point) in model.points.iter().enumerate() {
        let needs = |route: &Route| route.positions().any(|(one, _)| one == number);
        let switches = file.every("switchIS").filter_map(|node| node.attribute("id"));
        let Some(id) = switches.into_iter().find(|id| file.means(&point.name, id)) else { continue };
        let machines: Vec<Node<'_, '_>> =
            file.every("switchIL").filter(|machine| refers(*machine, "refersTo") == Some(id)).collect();
        for (what, circuit) in machines.iter().flat_map(|machine| asked(file, model, number, *machine)) {
            // A route over a circuit in which a train fouls a point has it held, too.
            let over = |route: &Route| {
                let runs = |one: usize| route.entry == one || route.circuits().any(|other| other == one);
                needs(route) || circuit.is_some_and(|one| runs(one) || route.overlap.contains(&one))
            };
            if model.routes.iter().any(over) {
                differs(id, format!("point {}: {what}", point.name), &over);
            }
        }
        let longest = machines
            .iter()
            .filter_map(|machine| machine.attribute("maxThrowTime").or(machine.attribute("typicalThrowTime")))
            .filter_map(milliseconds)
            .reduce(f64::max);
        if longest.is_some_and(|longest| f64::from(point.throw_ms) + 0.5 < longest) {
            let longest = longest.unwrap_or_default();
            differs(
                id,
                format!("point {} takes {} ms, and in the file {longest} ms", point.name, point.throw_ms),
                &needs,
            );
        }
        for (leg, side) in [(1, true), (2, false)] {
            let branch = if side == left_is_normal(file, id) { "leftBranch" } else { "rightBranch" };
            let Some(theirs) = beyond_branch(file, id, branch) else { continue };
            let mine = beyond_leg(model, number, leg);
            // Names of the ends of lines are the layout's own.
            let known = |name: &String| {
                file.every("trainDetectionElement")
                    .chain(file.every("bufferStop"))
                    .filter_map(|node| node.attribute("id"))
                    .any(|id| file.means(name, id))
            };
            let mine: BTreeSet<String> = mine.into_iter().filter(known).collect();
            let means = |name: &str, ids: &[&str]| ids.iter().any(|id| file.means(name, id));
            let agree = mine.iter().all(|name| theirs.iter().any(|ids| means(name, ids)))
                && theirs.iter().all(|ids| mine.iter().any(|name| means(name, ids)));
            if !agree {
                let word = if leg == 1 { "normal" } else { "reverse" };
                let names: Vec<&str> = theirs.iter().flatten().copied().collect();
                differs(
                    id,
                    format!("the {word} leg of point {} leads to {mine:?}, and in the file to {names:?}", point.name),
                    &needs,
                );
            }
        }
    }
    segments(file, model, &mut differs);
    found
}

/// What a machine asks of a point that the layout does not have, and the circuit that it is about.
fn asked(file: &File<'_>, model: &Model, point: usize, machine: Node<'_, '_>) -> Vec<(String, Option<usize>)> {
    let mut found = Vec::new();
    let Some(point) = model.points.get(point) else { return found };
    let is_false = |text: &str| matches!(text.trim(), "false" | "0");
    if machine.attribute("isKeyLocked").is_some_and(|text| !is_false(text)) {
        found.push(("its machine is locked by a key".to_owned(), None));
    }
    for child in machine.children() {
        let name = child.tag_name().name();
        match name {
            "hasPositionRestriction" | "relatedMovableElement" => {
                found.push((format!("its machine has a {name}"), None));
            }
            "hasFoulingTrainDetectors" => {
                let id = child.attribute("ref").unwrap_or_default();
                let id = file.meant(id).and_then(|node| node.attribute("id")).unwrap_or(id);
                let joint = model.graph.joints.iter().position(|joint| file.means(&joint.name, id));
                let at_joint = joint.into_iter().flat_map(|joint| model.graph.circuits_at(joint));
                // A section, in words of its own; or what borders that, where another detector at the same place gave the joint its name.
                let is_near = |name: &str| {
                    let own = |(section, borders): (&&str, &BTreeSet<&str>)| {
                        file.means(name, section) && (*section == id || borders.contains(id))
                    };
                    file.sections.iter().any(own)
                };
                let named = (0..model.circuits.len()).filter(|circuit| is_near(&model.circuits[*circuit].name));
                let near: BTreeSet<usize> = at_joint.chain(named).collect();
                let missing = near
                    .iter()
                    .filter(|circuit| point.circuit != Some(**circuit) && !point.fouled_in.contains(circuit));
                if near.is_empty() {
                    found.push((format!("it is fouled at {id}, which the layout does not have"), None));
                }
                for circuit in missing {
                    found.push((
                        format!("a train in {} fouls it in the file", model.circuits[*circuit].name),
                        Some(*circuit),
                    ));
                }
            }
            _ => {}
        }
    }
    found
}

/// Whether a joint is one of two detectors at one place, of which the other is a border.
fn same_place(file: &File<'_>, joint: &str, borders: &BTreeSet<&str>) -> bool {
    let at = |divider: &Divider<'_>| {
        divider.ids.iter().any(|id| file.means(joint, id)) && divider.ids.iter().any(|id| borders.contains(id))
    };
    file.dividers.values().flatten().any(at)
}

/// The shortest way in the file between two borders of a section, over ground that nothing divides; nothing if there is none.
fn shortest(file: &File<'_>, borders: &BTreeSet<&str>) -> Option<f64> {
    let mut best: Option<f64> = None;
    for (element, there) in &file.dividers {
        for divider in there.iter().filter(|divider| divider.ids.iter().any(|id| borders.contains(id))) {
            for toward_end in [true, false] {
                for (run, at) in reached(file, element, divider.at, toward_end) {
                    let ends_it = match at {
                        Reached::Divider(other) => other.ids.iter().any(|id| borders.contains(id)),
                        Reached::End(_) => true,
                    };
                    // On the other side of the border lies another section, which may have the same borders: it is no shorter then.
                    if ends_it && belongs(file, borders, divider, at) {
                        best = Some(best.map_or(run, |best| best.min(run)));
                    }
                }
            }
        }
    }
    best
}

/// Whether the ground between a border and what was reached is this section's: no other section lies between the two.
fn belongs(file: &File<'_>, borders: &BTreeSet<&str>, from: &Divider<'_>, to: Reached<'_>) -> bool {
    let to = match to {
        Reached::Divider(to) => to,
        // To the end of the tracks: the section has no other border beside it there, or names the end.
        Reached::End(end) => {
            let is_named = file.stops_at(end).iter().any(|id| borders.contains(id));
            return is_named || file.beside(from).len() < 2 || borders.len() == from.ids.len();
        }
    };
    let both = file
        .sections
        .values()
        .filter(|all| from.ids.iter().any(|id| all.contains(id)) && to.ids.iter().any(|id| all.contains(id)));
    both.count() == 1
}

/// What a train comes to first, and after how many metres.
#[derive(Clone, Copy)]
enum Reached<'b> {
    Divider(&'b Divider<'b>),
    /// The end of the tracks, or a buffer stop: net element, and metres from its begin.
    End((&'b str, f64)),
}

fn reached<'b>(file: &'b File<'b>, element: &'b str, at: f64, toward_end: bool) -> Vec<(f64, Reached<'b>)> {
    let mut found = Vec::new();
    let mut open = vec![(element, at, toward_end, 0.0, true)];
    let mut seen: BTreeMap<(&str, bool), f64> = BTreeMap::new();
    while let Some((element, at, toward_end, run, is_first)) = open.pop() {
        if !is_first && seen.get(&(element, toward_end)).is_some_and(|before| *before <= run) || seen.len() > 4096 {
            continue;
        }
        if !is_first {
            seen.insert((element, toward_end), run);
        }
        let length = file.lengths.get(element).copied().unwrap_or(0.0);
        let ahead = |place: f64| if toward_end { place - at } else { at - place };
        let least = if is_first { 0.005 } else { -0.005 };
        let buffer = file.stop_ahead(element, at, toward_end, least);
        let room = buffer.unwrap_or(f64::MAX);
        let is_ahead = |divider: &&Divider<'_>| (least..=room).contains(&ahead(divider.at));
        let there = file.dividers.get(element).into_iter().flatten().filter(is_ahead);
        if let Some(divider) = there.min_by(|one, other| ahead(one.at).total_cmp(&ahead(other.at))) {
            found.push((run + ahead(divider.at), Reached::Divider(divider)));
            continue;
        }
        if let Some(buffer) = buffer {
            let place = if toward_end { at + buffer } else { at - buffer };
            found.push((run + buffer, Reached::End((element, place))));
            continue;
        }
        let run = run + ahead(if toward_end { length } else { 0.0 });
        let onward = file.onward.get(&(element, toward_end));
        if onward.is_none_or(Vec::is_empty) {
            found.push((run, Reached::End((element, if toward_end { length } else { 0.0 }))));
        }
        for ((next, at_its_end), _) in onward.into_iter().flatten() {
            let begin = if *at_its_end { file.lengths.get(next).copied().unwrap_or(0.0) } else { 0.0 };
            open.push((next, begin, !at_its_end, run, false));
        }
    }
    found
}

/// What divides the tracks beyond a branch of a switch, away from it, and what ends them: the ids of what stands there.
fn beyond_branch<'b>(file: &'b File<'b>, switch: &str, side: &str) -> Option<Vec<Vec<&'b str>>> {
    let branch = |side: &str| file.branches.values().find(|branch| branch.switch == switch && branch.side == side);
    let relation = branch(side)?;
    let other = branch(if side == "leftBranch" { "rightBranch" } else { "leftBranch" })?;
    let ends = |relation: &str| -> Option<[End<'b>; 2]> {
        let node = file.by_id(relation)?;
        let end = |element: &str, position: &str| Some((refers(node, element)?, figure(node, position)? > 0.5));
        Some([end("elementA", "positionOnA")?, end("elementB", "positionOnB")?])
    };
    let (own, other) = (ends(relation.relation)?, ends(other.relation)?);
    let (element, at_its_end) = own.into_iter().find(|end| !other.contains(end))?;
    // From the switch a train enters the element at that end.
    let at = if at_its_end { file.lengths.get(element).copied().unwrap_or(0.0) } else { 0.0 };
    // A detector at the very switch counts: the search leaves one out only where it starts from it.
    let here = file.dividers.get(element).into_iter().flatten().find(|divider| (divider.at - at).abs() < 0.005);
    if let Some(divider) = here {
        return Some(vec![divider.ids.clone()]);
    }
    let ids = |reached: Reached<'b>| match reached {
        Reached::Divider(divider) => divider.ids.clone(),
        Reached::End(end) => file.stops_at(end),
    };
    let all = reached(file, element, at, !at_its_end).into_iter().map(|(_, at)| ids(at));
    Some(all.filter(|ids| !ids.is_empty()).collect())
}

/// The joints at the border of the circuit that the leg of a point leads to in the layout.
pub(super) fn beyond_leg(model: &Model, point: usize, leg: usize) -> BTreeSet<String> {
    let graph = &model.graph;
    let mut found = BTreeSet::new();
    let Some(track) = graph.of_point(point) else { return found };
    let Some(joint) = graph.tracks.get(track).and_then(|track| track.joints.get(leg)).copied() else { return found };
    let mut open = vec![(track, joint)];
    let mut seen = BTreeSet::new();
    while let Some((from, joint)) = open.pop() {
        let Some(at) = graph.joints.get(joint).filter(|_| seen.insert((from, joint))) else { continue };
        let circuit = |track: usize| graph.tracks.get(track).map(|track| track.circuit);
        let next = at.tracks.iter().copied().find(|next| *next != from);
        match next.filter(|next| circuit(*next) == circuit(from)) {
            Some(next) => open.extend(graph.moves(next, joint).into_iter().map(|(exit, _)| (next, exit))),
            None => drop(found.insert(at.name.clone())),
        }
    }
    found
}

/// Plain line is not faster than the file has it.
fn segments(file: &File<'_>, model: &Model, differs: &mut impl FnMut(&str, String, &dyn Fn(&Route) -> bool)) {
    for (number, segment) in model.segments.iter().enumerate() {
        let uses = |route: &Route| route.to == Some(number) || route.from == Some(number);
        let kmh = model.values.speeds_kmh.get(usize::from(segment.speed.0)).copied().unwrap_or(u16::MAX);
        let circuits = segment.circuits.iter().filter_map(|circuit| model.circuits.get(*circuit));
        let borders: BTreeSet<&str> = circuits
            .flat_map(|circuit| file.sections.iter().filter(|(id, _)| file.means(&circuit.name, id)))
            .flat_map(|(_, borders)| borders.iter().copied())
            .collect();
        for limit in file.limits.iter().filter(|limit| f64::from(kmh) > limit.kmh) {
            // Between two borders of the segment on one net element, and strictly inside the limited stretch.
            let covered = limit.on.is_none_or(|(element, low, high)| {
                let there = file.dividers.get(element).into_iter().flatten();
                let own = there.filter(|divider| divider.ids.iter().any(|id| borders.contains(id)));
                let on: Vec<f64> = own.map(|divider| divider.at).collect();
                on.windows(2).any(|two| low < two[1] - SLACK && two[0] + SLACK < high)
            });
            if covered {
                let speed = limit.kmh;
                let what =
                    format!("segment {} runs at {kmh} km/h, and the file allows {speed} km/h there", segment.name);
                differs(limit.id, what, &uses);
            }
        }
    }
}
