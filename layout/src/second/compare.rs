//! Routes: what a train meets on the file's tracks, and what the layout's route has.

use std::collections::{BTreeMap, BTreeSet};

use roxmltree::Node;

use super::difference::Difference;
use super::file::{Branch, File, every_ref, refers};
use super::held::{held, overlap, times};
use super::positions::left_is_normal;
use super::readings::{Reading, readings};
use crate::form::Position;
use crate::model::{Model, Route};
use crate::problem::Source;

/// Everything in which routes differ.
pub fn differences(file: &File<'_>, model: &Model, source: &Source) -> Vec<Difference> {
    let mut found = Vec::new();
    for route in &model.routes {
        let mut differs = |node: Option<Node<'_, '_>>, what: String| {
            let place = node.and_then(|node| source.place(&(node.range().start..node.range().start + 1)));
            found.push(Difference { route: Some(route.name.clone()), what, place });
        };
        let ids = file.every("route").filter_map(|node| Some((node.attribute("id")?, node)));
        let named: Vec<_> = ids.filter(|(id, _)| file.means(&route.name, id)).map(|(_, node)| node).collect();
        let [node] = named.as_slice() else {
            differs(None, format!("the file has {} routes of this name", named.len()));
            continue;
        };
        for what in of_route(file, model, route, *node) {
            differs(Some(*node), what);
        }
    }
    found.extend(conflicts(file, model));
    found
}

fn of_route<'a>(file: &File<'a>, model: &Model, route: &Route, node: Node<'a, 'a>) -> Vec<String> {
    let readings = match readings(file, node) {
        Ok(readings) => readings,
        Err(why) => return vec![why],
    };
    let mut differing = Vec::new();
    let branches: BTreeSet<Vec<Branch<'_>>> = readings.iter().map(|reading| reading.branches.clone()).collect();
    if branches.len() > 1 {
        differing.push("the file leaves several ways for it".to_owned());
    }
    let wrong: Vec<Vec<String>> = readings.iter().map(|reading| apart(file, model, route, reading)).collect();
    let fitting = wrong.iter().position(Vec::is_empty);
    match fitting.and_then(|place| readings.get(place)) {
        Some(reading) => {
            let kmh = f64::from(model.values.speeds_kmh.get(usize::from(route.speed.0)).copied().unwrap_or(u16::MAX));
            if reading.limit.is_some_and(|limit| kmh > limit) {
                let limit = reading.limit.unwrap_or_default();
                differing.push(format!("its speed is {kmh} km/h, and the file allows {limit} km/h"));
            }
        }
        None => differing.extend(wrong.into_iter().min_by_key(Vec::len).unwrap_or_default()),
    }
    differing.extend(signal(file, route, node));
    differing.extend(beyond(node));
    differing.extend(other_kind(file, node));
    differing.extend(held(file, model, route, node));
    differing.extend(times(file, model, route, node));
    differing.extend(overlap(file, model, route, node));
    differing
}

/// What the file has of a route that this reading knows nothing of: it may be a condition.
fn beyond(node: Node<'_, '_>) -> Option<String> {
    const ELEMENTS: &str = " additionalRelation assetName designator facingSwitchInPosition handlesRouteType hasReleaseGroup \
        hasTvdSection name objectName routeActivationSection routeEntry routeExit trailingSwitchInPosition ";
    const ATTRIBUTES: &str = " approachReleaseDelay id locksAutomatically processingDelay residualRouteCancellationDelay \
        residualRouteReleaseDelay signalClosureDelay ";
    let elements = node.children().filter(Node::is_element).map(|child| child.tag_name().name());
    let attributes = node.attributes().filter(|at| at.namespace().is_none()).map(|at| at.name());
    let is_new = |known: &str, name: &str| !known.split_whitespace().any(|one| one == name);
    let mut found =
        elements.filter(|name| is_new(ELEMENTS, name)).chain(attributes.filter(|name| is_new(ATTRIBUTES, name)));
    found.next().map(|name| format!("the file has {name} of it, which may be a condition"))
}

/// Where the file tells kinds of routes apart, this one is of a kind that is for trains by its name.
fn other_kind<'a>(file: &File<'a>, node: Node<'a, 'a>) -> Option<String> {
    let kinds = |route: Node<'a, 'a>| every_ref(route, "handlesRouteType").collect::<BTreeSet<&str>>();
    let own = kinds(node);
    let told = |kind: &&str| file.by_id(kind).map_or(*kind, |_| file.call(kind)).to_owned();
    let has = |kind: &&str, word: &str| told(kind).to_lowercase().contains(word);
    let other = |kind: &&str| {
        "shunt rangier call auxil hilf emerg subst ersatz manoeuv manœuv sperr".split(' ').any(|word| has(kind, word))
    };
    // A word of its own: what stands beside it is no letter, or a capital after it.
    let says = |kind: &&str, word: &str| {
        let text = format!(" {} ", told(kind));
        let lower = text.to_ascii_lowercase();
        lower.match_indices(word).any(|(at, _)| {
            let (before, behind) = (text[..at].chars().next_back(), text[at + word.len()..].chars().next());
            let begins = before.is_none_or(|letter| {
                !letter.is_alphabetic() || letter.is_lowercase() && text[at..].starts_with(char::is_uppercase)
            });
            begins && behind.is_none_or(|letter| !letter.is_alphabetic() || letter.is_uppercase())
        })
    };
    let trains = ["main", "train", "trains", "principal", "zugstrasse", "zugstraße"];
    let denies = |kind: &&str| ["no", "non", "not", "nicht"].iter().any(|word| says(kind, word));
    let is_train = own.iter().any(|kind| !other(kind) && !denies(kind) && trains.iter().any(|word| says(kind, word)));
    let alike = file.every("route").all(|route| kinds(route) == own);
    let may_be = alike && own.len() == 1 && !own.iter().all(other);
    (!own.is_empty() && !is_train && !may_be).then(|| format!("in the file it is of the kind {own:?}"))
}

/// The signal of a route is the file's. One that has no name of its own in the layout is called as its route.
fn signal<'a>(file: &File<'a>, route: &Route, node: Node<'a, 'a>) -> Option<String> {
    let entry = node.children().find(|child| child.tag_name().name() == "routeEntry")?;
    let id = file.meant(refers(entry, "refersTo")?)?.attribute("id")?;
    let agrees = route.signal == route.name || file.means(&route.signal, id);
    (!agrees).then(|| format!("its signal is {}, and that of the file {}", route.signal, file.call(id)))
}

/// In what the layout's route is not this reading.
fn apart(file: &File<'_>, model: &Model, route: &Route, reading: &Reading<'_>) -> Vec<String> {
    let mut differing = Vec::new();
    let name = |circuit: usize| model.circuits.get(circuit).map_or("", |circuit| circuit.name.as_str());
    let means = |name: &str, ids: &BTreeSet<&str>| ids.is_empty() || ids.iter().any(|id| file.means(name, id));
    let told = |ids: &BTreeSet<&str>| {
        let words: Vec<&str> =
            ids.iter().map(|id| file.by_id(id).and_then(|node| node.attribute("id")).unwrap_or("")).collect();
        if words.is_empty() { "a part without a name".to_owned() } else { words.join(" or ") }
    };
    let own: Vec<&str> = route.circuits().map(name).collect();
    let same = own.len() == reading.places.len() && own.iter().zip(&reading.places).all(|(name, ids)| means(name, ids));
    if !same {
        let theirs: Vec<String> = reading.places.iter().map(told).collect();
        differing.push(format!("its path is {}, and that of the file {}", own.join(", "), theirs.join(", ")));
    }
    if !means(name(route.entry), &reading.rear) {
        differing.push(format!(
            "its entry is {}, and in rear of the file's signal is {}",
            name(route.entry),
            told(&reading.rear)
        ));
    }
    for (joint, ids, word) in [(route.start, &reading.joints[0], "begins"), (route.exit, &reading.joints[1], "ends")] {
        let joint = model.graph.joints.get(joint).map_or("", |joint| joint.name.as_str());
        if !ids.is_empty() && !ids.iter().any(|id| file.means(joint, id)) {
            differing.push(format!("it {word} at joint {joint}, and in the file at {}", ids.join(" or ")));
        }
    }
    let mut theirs: BTreeMap<String, Option<Position>> = BTreeMap::new();
    for branch in &reading.branches {
        match branch.side {
            "leftBranch" | "rightBranch" => {
                let is_normal = (branch.side == "leftBranch") == left_is_normal(file, branch.switch);
                let position = if is_normal { Position::Normal } else { Position::Reverse };
                theirs.insert(file.call_of(branch.switch), Some(position));
            }
            // Both ends of a slip; in which position, its machines say (`held`). A crossing without slips has no points.
            _ if file.branches.values().filter(|other| other.switch == branch.switch).count() > 2 => {
                for end in ["A", "B"] {
                    theirs.insert(format!("{}.{end}", file.call_of(branch.switch)), None);
                }
            }
            _ => {}
        }
    }
    let passed = route.path.iter().flat_map(|place| &place.passed);
    let point = |point: usize| model.points.get(point).map_or("", |point| point.name.as_str());
    let mine: BTreeMap<String, Position> =
        passed.map(|passed| (point(passed.point).to_owned(), passed.position)).collect();
    let agree = mine.len() == theirs.len()
        && mine.iter().all(|(name, position)| {
            theirs.get(name).is_some_and(|theirs| theirs.is_none_or(|theirs| theirs == *position))
        });
    if !agree {
        differing.push(format!("it runs over {mine:?}, and in the file over {theirs:?}"));
    }
    differing
}

/// Conflicts that the file declares and the layout does not hold.
fn conflicts(file: &File<'_>, model: &Model) -> Vec<Difference> {
    let mut found = Vec::new();
    for node in file.every("conflictingRoute") {
        let Some((one, other)) = refers(node, "refersToRoute").zip(refers(node, "conflictsWithRoute")) else {
            continue;
        };
        let number = |id: &str| model.routes.iter().position(|route| file.means(&route.name, id));
        let (Some(one), Some(other)) = (number(one), number(other)) else { continue };
        if one != other && crate::conflict::reasons(model, one, other).is_empty() {
            let route = model.routes.get(one).map(|route| route.name.clone());
            let other = model.routes.get(other).map_or("", |route| route.name.as_str());
            let what = format!("the file declares a conflict with {other}, and nothing in the layout excludes it");
            found.push(Difference { route, what, place: None });
        }
    }
    found
}
