//! Routes: what a train meets on the file's tracks, and what the layout's route has.

use std::collections::{BTreeMap, BTreeSet};

use roxmltree::Node;

use super::Difference;
use super::file::{Branch, File, every_ref, figure, milliseconds, refers};
use super::walk::{Asked, NEAR, OFFSET, Walk, walks};
use crate::form::Position;
use crate::model::{Model, Route};
use crate::problem::Source;

/// What a train meets between the joint where a route begins and the one where it ends.
#[derive(Clone, Debug, PartialEq)]
struct Reading<'a> {
    /// What the sections in rear of the first joint can be.
    rear: BTreeSet<&'a str>,
    /// What the section at each place can be: none if the file names none there.
    places: Vec<BTreeSet<&'a str>>,
    /// The ids of what stands at the first joint and at the last; none at an end without a name.
    joints: [Vec<&'a str>; 2],
    /// The branches that it runs over.
    branches: Vec<Branch<'a>>,
    /// The lowest limit of speed, in km/h.
    limit: Option<f64>,
    /// Whether a listed section lies in rear of it.
    drops: bool,
}

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

/// The signal of a route is the file's. One that has no name of its own in the layout is called as its route.
fn signal<'a>(file: &File<'a>, route: &Route, node: Node<'a, 'a>) -> Option<String> {
    let entry = node.children().find(|child| child.tag_name().name() == "routeEntry")?;
    let id = file.meant(refers(entry, "refersTo")?)?.attribute("id")?;
    let agrees = route.signal == route.name || file.means(&route.signal, id);
    (!agrees).then(|| format!("its signal is {}, and that of the file {}", route.signal, file.call(id)))
}

/// What the file can mean by a route.
fn readings<'a>(file: &File<'a>, node: Node<'a, 'a>) -> Result<Vec<Reading<'a>>, String> {
    let child = |name: &str| node.children().find(|child| child.tag_name().name() == name);
    let entry = child("routeEntry").and_then(|entry| refers(entry, "refersTo")).and_then(|id| file.meant(id));
    let signal = entry.and_then(|signal| file.spot(signal)).ok_or("the file gives its signal no place")?;
    let exit = child("routeExit").and_then(|exit| refers(exit, "refersTo"));
    let exit_node = exit.map(|id| file.meant(id).ok_or("its exit is not in the file")).transpose()?;
    let place = |node: Node<'a, 'a>| file.spot(node).ok_or("the file gives its exit no place");
    let exit_at = exit_node.map(place).transpose()?;
    let is_signal = exit_node.is_some_and(|node| node.tag_name().name() == "signalIS");
    let listed: BTreeSet<&str> = every_ref(node, "hasTvdSection").collect();
    if exit_at.is_none() && listed.is_empty() {
        return Err("the file names neither its sections nor its exit".to_owned());
    }
    let asked = asked(file, node)?;
    let mut found: Vec<Reading<'a>> = Vec::new();
    for toward_end in [true, false] {
        if signal.toward_end.is_some_and(|given| given != toward_end) {
            continue;
        }
        let longest = listed.len() + 2;
        let all = walks(file, signal, toward_end, exit_at, longest, &asked)
            .map_err(|()| "the file leaves too many ways for it")?;
        for walk in all {
            for reading in of_walk(file, &walk, &listed, exit_at.is_some(), is_signal) {
                if !found.contains(&reading) {
                    found.push(reading);
                }
            }
        }
    }
    // A listed section is in rear of the signal only where it cannot be run over.
    if found.iter().any(|reading| !reading.drops) {
        found.retain(|reading| !reading.drops);
    }
    if found.is_empty() {
        let why = "no train that leaves its signal comes to its exit over the sections and with the switches that the file gives";
        return Err(why.to_owned());
    }
    Ok(found)
}

/// The readings of one way: from each joint where it may begin to each where it may end.
fn of_walk<'a>(
    file: &File<'a>,
    walk: &Walk<'a>,
    listed: &BTreeSet<&'a str>,
    has_exit: bool,
    at_signal: bool,
) -> Vec<Reading<'a>> {
    let sections = sections(file, walk);
    let named = |places: &BTreeSet<&'a str>| places.iter().any(|id| listed.contains(id));
    let mut starts = Vec::new();
    let ahead = walk.dividers.iter().position(|(_, run)| *run >= -NEAR);
    starts.extend(ahead);
    starts.extend((0..walk.dividers.len()).filter(|place| {
        let run = walk.dividers[*place].1;
        (-OFFSET..-NEAR).contains(&run) && sections.get(*place).is_some_and(named)
    }));
    let count = walk.dividers.len();
    let mut ends = Vec::new();
    match walk.exit {
        Some(exit) => {
            let first = walk.dividers.iter().position(|(_, run)| *run >= exit - NEAR);
            // At a buffer stop, or a signal beyond which the tracks end.
            ends.push(first.unwrap_or(count));
            let behind = (0..count).filter(|place| (exit - OFFSET..exit - NEAR).contains(&walk.dividers[*place].1));
            ends.extend(behind.filter(|_| at_signal));
        }
        None if !has_exit => ends.extend(0..=count),
        None => {}
    }
    let mut found = Vec::new();
    for start in starts {
        for end in ends.iter().copied().filter(|end| *end > start) {
            let places: Vec<BTreeSet<&str>> = sections.get(start..end).unwrap_or_default().to_vec();
            if places.len() != end - start || end == count && walk.end.is_none() {
                continue;
            }
            let first = &walk.dividers[start];
            let own = places.first().cloned().unwrap_or_default();
            let rear: BTreeSet<&str> = file.beside(&first.0).difference(&own).copied().collect();
            let over: BTreeSet<&str> = places.iter().flatten().chain(&rear).copied().collect();
            let covers = places.iter().all(|place| place.is_empty() || named(place));
            let agrees = listed.is_empty() || covers && listed.is_subset(&over);
            if !agrees {
                continue;
            }
            // Without an exit, the sections say where it ends: they are all run over.
            if !has_exit && !places.last().is_some_and(named) {
                continue;
            }
            let last = walk.dividers.get(end).map_or_else(|| end_names(file, walk), |(divider, _)| divider.ids.clone());
            let from = first.1;
            let to = walk.dividers.get(end).map_or_else(|| walk.end.map_or(f64::MAX, |(run, _)| run), |(_, run)| *run);
            let branches: Vec<Branch<'a>> =
                walk.branches.iter().filter(|(_, run)| (from..to).contains(run)).map(|(branch, _)| *branch).collect();
            let limit = limit(file, walk, &branches, from, to);
            let drops = rear.iter().any(|id| listed.contains(id));
            found.push(Reading { drops, rear, places, joints: [first.0.ids.clone(), last], branches, limit });
        }
    }
    found
}

/// What the section behind each divider of a way can be.
fn sections<'a>(file: &File<'a>, walk: &Walk<'a>) -> Vec<BTreeSet<&'a str>> {
    let mut found: Vec<BTreeSet<&str>> = Vec::new();
    for (place, (divider, _)) in walk.dividers.iter().enumerate() {
        let here = file.beside(divider);
        let there = match walk.dividers.get(place + 1) {
            Some((next, _)) => Some(file.beside(next)),
            None => walk.end.map(|_| {
                let stops = end_names(file, walk);
                let with =
                    |id: &&&str| file.sections.get(**id).is_some_and(|all| stops.iter().any(|stop| all.contains(stop)));
                let marked: BTreeSet<&str> = here.iter().filter(with).copied().collect();
                // The end of the tracks need not be named: then it is what is not in rear of the last joint.
                if marked.is_empty() {
                    let rear = found.last().cloned().unwrap_or_default();
                    here.difference(&rear).copied().collect()
                } else {
                    marked
                }
            }),
        };
        let Some(there) = there else { break };
        found.push(here.intersection(&there).copied().collect());
    }
    found
}

/// The ids of buffer stops at the end where a way comes out of the tracks.
fn end_names<'a>(file: &File<'a>, walk: &Walk<'a>) -> Vec<&'a str> {
    walk.end.map(|(_, end)| file.stops_at(end)).unwrap_or_default()
}

/// The lowest limit between two places of a way.
fn limit<'a>(file: &File<'a>, walk: &Walk<'a>, branches: &[Branch<'a>], from: f64, to: f64) -> Option<f64> {
    let mut limits = Vec::new();
    for branch in branches {
        let node = file.by_id(branch.switch);
        let own = node
            .iter()
            .flat_map(Node::children)
            .filter(|child| child.attribute("netRelationRef") == Some(branch.relation));
        for (child, name) in own.flat_map(|child| [(child, "branchingSpeed"), (child, "joiningSpeed")]) {
            // One that cannot be read may be any.
            let speed = figure(child, name).filter(|speed| *speed >= 1.0).unwrap_or(0.0);
            limits.extend(child.attribute(name).map(|_| speed));
        }
    }
    for limit in &file.limits {
        let touches = limit.on.is_none_or(|(limited, begin, end)| {
            walk.stretches.iter().any(|(element, low, high, run)| {
                // The part of the stretch between the joints of the route.
                let overlaps = begin < *high - 0.01 && *low + 0.01 < end;
                limited == *element && overlaps && *run < to && run + (high - low) > from
            })
        });
        limits.extend(touches.then_some(limit.kmh));
    }
    limits.into_iter().min_by(f64::total_cmp)
}

/// Which branches the file's positions for a route leave, by switch.
fn asked<'a>(file: &File<'a>, node: Node<'a, 'a>) -> Result<Asked<'a>, String> {
    let mut asked = Asked::new();
    for (switch, relations) in positions(file, node, &["facingSwitchInPosition", "trailingSwitchInPosition"])? {
        match asked.get_mut(switch) {
            None => drop(asked.insert(switch, relations)),
            Some(before) => before.retain(|relation| relations.contains(relation)),
        }
    }
    Ok(asked)
}

/// The switches of these elements, each with the relations that its position leaves.
fn positions<'a>(file: &File<'a>, node: Node<'a, 'a>, names: &[&str]) -> Result<Vec<(&'a str, Vec<&'a str>)>, String> {
    let mut found = Vec::new();
    let given = node.children().filter(|child| names.contains(&child.tag_name().name()));
    let given: Vec<Node<'a, 'a>> = given.flat_map(|given| given.descendants()).collect();
    // What is not left need not be right.
    let says_not = |at: &Node<'a, 'a>| !matches!(at.attribute("isNegated").map(str::trim), None | Some("false" | "0"));
    if given.iter().any(says_not) {
        return Err("a position of it is negated".to_owned());
    }
    for given in given.into_iter().filter(|at| at.attribute("inPosition").is_some()) {
        let machine = refers(given, "refersToSwitch").or(refers(given, "refersTo"));
        let machine =
            machine.and_then(|id| file.by_id(id)).ok_or("a position of it is of a switch that is not there")?;
        let switch = machine.attribute("id").and_then(|id| file.meant(id)).and_then(|switch| switch.attribute("id"));
        let switch = switch.ok_or("a position of it is of a switch that is not there")?;
        let (side, leg) = match given.attribute("inPosition") {
            Some("left") => ("leftBranch", "branchLeft"),
            Some("right") => ("rightBranch", "branchRight"),
            other => return Err(format!("a position {:?} of it is neither left nor right", other.unwrap_or_default())),
        };
        let own: Vec<&Branch<'a>> = file.branches.values().filter(|branch| branch.switch == switch).collect();
        let plain: Vec<&str> = own.iter().filter(|branch| branch.side == side).map(|branch| branch.relation).collect();
        let relations = if plain.is_empty() {
            // A slip: the machine says to which net element its blades lead.
            let leg = refers(machine, leg).ok_or("a position of it is of a slip whose machine names no branches")?;
            let leads = |relation: &str| {
                let ends = file.by_id(relation).map(|node| [refers(node, "elementA"), refers(node, "elementB")]);
                ends.is_some_and(|ends| ends.contains(&Some(leg)))
            };
            own.iter().map(|branch| branch.relation).filter(|relation| leads(relation)).collect()
        } else {
            plain
        };
        if relations.is_empty() {
            return Err(format!("a position of it is of {switch}, which has no such branch"));
        }
        found.push((switch, relations));
    }
    Ok(found)
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

/// Whether the left branch of a switch is its normal leg.
pub fn left_is_normal(file: &File<'_>, switch: &str) -> bool {
    let machine = file.every("switchIL").find(|machine| refers(*machine, "refersTo") == Some(switch));
    let preferred = machine.and_then(|machine| machine.attribute("preferredPosition"));
    let course = file.by_id(switch).and_then(|node| node.attribute("continueCourse"));
    preferred.or(course).filter(|side| ["left", "right"].contains(side)) != Some("right")
}

/// Positions that the file asks for and the layout does not hold.
fn held<'a>(file: &File<'a>, model: &Model, route: &Route, node: Node<'a, 'a>) -> Vec<String> {
    let relations = every_ref(node, "additionalRelation").filter_map(|id| file.by_id(id));
    let mut all = vec![positions(file, node, &["facingSwitchInPosition", "trailingSwitchInPosition"])];
    all.extend(relations.map(|relation| positions(file, relation, &["requiredSwitchPosition"])));
    let mine: BTreeMap<usize, Position> = route.positions().collect();
    let mut differing = Vec::new();
    for one in all {
        let given = match one {
            Ok(given) => given,
            Err(why) => {
                differing.push(why);
                continue;
            }
        };
        for (switch, relations) in given {
            let sides: BTreeSet<&str> =
                relations.iter().filter_map(|relation| file.branches.get(relation)).map(|branch| branch.side).collect();
            let Some(side) = sides.first().filter(|side| ["leftBranch", "rightBranch"].contains(side)) else {
                continue;
            };
            let is_normal = (*side == "leftBranch") == left_is_normal(file, switch);
            let wanted = if is_normal { Position::Normal } else { Position::Reverse };
            let point = model.points.iter().position(|point| file.means(&point.name, switch));
            if point.and_then(|point| mine.get(&point)) != Some(&wanted) {
                differing.push(format!(
                    "the file asks for {} {wanted:?}, and the layout does not hold it so",
                    file.call_of(switch)
                ));
            }
        }
    }
    differing
}

/// How long a cancelled route stays locked, by the names of railML 3.1 and 3.2.
const RESIDUAL: [&str; 2] = ["residualRouteCancellationDelay", "residualRouteReleaseDelay"];

fn times<'a>(file: &File<'a>, model: &Model, route: &Route, node: Node<'a, 'a>) -> Vec<String> {
    let mut differing = Vec::new();
    let mut least = |have: f64, node: Node<'a, 'a>, attribute: &str, what: &str| {
        let Some(text) = node.attribute(attribute) else { return };
        match milliseconds(text) {
            Some(wanted) if have + 0.5 >= wanted => {}
            Some(wanted) => differing.push(format!("{what} is {have} ms, and the file has {attribute} {wanted} ms")),
            None => differing.push(format!("the {attribute} {text:?} cannot be read")),
        }
    };
    let release = f64::from(model.values.ms(route.release));
    let clear = f64::from(u32::from(model.values.clear) * model.values.cycle_ms);
    least(release, node, "approachReleaseDelay", "its release time");
    for attribute in RESIDUAL {
        least(release, node, attribute, "its release time");
    }
    let circuits: BTreeSet<&str> =
        route.circuits().filter_map(|circuit| Some(model.circuits.get(circuit)?.name.as_str())).collect();
    for section in file.every("tvdSection") {
        let Some(id) = section.attribute("id") else { continue };
        if circuits.iter().any(|name| file.means(name, id)) {
            for attribute in RESIDUAL {
                least(release, section, attribute, "its release time");
            }
            least(clear, section, "partialRouteReleaseDelay", "the time after which a circuit counts as clear");
        }
    }
    differing
}

/// The overlap that the file gives a route is held by the layout, with its positions and its time.
fn overlap<'a>(file: &File<'a>, model: &Model, route: &Route, node: Node<'a, 'a>) -> Vec<String> {
    let id = node.attribute("id").unwrap_or_default();
    let exit = node.children().find(|child| child.tag_name().name() == "routeExit");
    let target = exit.and_then(|exit| refers(exit, "refersTo")).and_then(|id| file.by_id(id));
    let named: Vec<&str> = exit.into_iter().chain(target).flat_map(|at| every_ref(at, "hasOverlap")).collect();
    let given: Vec<Node<'a, 'a>> = file
        .every("overlap")
        .filter(|overlap| {
            let own = overlap.attribute("id").unwrap_or_default();
            named.contains(&own) || every_ref(*overlap, "activeForApproachRoute").any(|route| route == id)
        })
        .collect();
    let have: BTreeSet<&str> =
        route.overlap.iter().filter_map(|circuit| Some(model.circuits.get(*circuit)?.name.as_str())).collect();
    let fits = |overlap: &Node<'a, 'a>| {
        let sections: Vec<&str> = every_ref(*overlap, "hasTvdSection").collect();
        sections.iter().all(|id| have.iter().any(|name| file.means(name, id))) && !have.is_empty()
    };
    if given.is_empty() {
        return Vec::new();
    }
    let Some(one) = given.iter().find(|overlap| fits(overlap)) else {
        let ids: Vec<&str> = given.iter().filter_map(|overlap| overlap.attribute("id")).collect();
        return vec![format!("the file gives it the overlap {}, and the layout holds {have:?}", ids.join(" or "))];
    };
    let mut differing = Vec::new();
    let mine: BTreeMap<usize, Position> = route.overlap_positions.iter().map(|(point, at)| (*point, *at)).collect();
    let asks = positions(file, *one, &["requiresSwitchInPosition"]).unwrap_or_else(|why| {
        differing.push(format!("its overlap: {why}"));
        Vec::new()
    });
    for (switch, relations) in asks {
        let Some(branch) = relations.first().and_then(|relation| file.branches.get(relation)) else { continue };
        if !["leftBranch", "rightBranch"].contains(&branch.side) {
            continue;
        }
        let is_normal = (branch.side == "leftBranch") == left_is_normal(file, switch);
        let wanted = if is_normal { Position::Normal } else { Position::Reverse };
        let point = model.points.iter().position(|point| file.means(&point.name, switch));
        if point.and_then(|point| mine.get(&point)) != Some(&wanted) {
            differing.push(format!(
                "its overlap asks for {} {wanted:?}, and the layout does not hold it so",
                file.call_of(switch)
            ));
        }
    }
    let timer = one.descendants().find_map(|timer| timer.attribute("timerValue")).and_then(milliseconds);
    let stay = f64::from(model.values.ms(route.stay));
    if let Some(wanted) = timer.filter(|wanted| stay + 0.5 < *wanted) {
        differing.push(format!("its overlap is given up after {stay} ms, and in the file after {wanted} ms"));
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

impl<'a> File<'a> {
    /// The ids of buffer stops at a place on a net element.
    pub fn stops_at(&self, (element, at): (&str, f64)) -> Vec<&'a str> {
        let stops = self.stops.get(element).into_iter().flatten();
        stops.filter(|(place, _)| (place - at).abs() < 0.01).map(|(_, id)| *id).collect()
    }

    /// What an element is called, as text of its own.
    pub fn call_of(&self, id: &str) -> String {
        self.by_id(id)
            .and_then(|node| node.attribute("id"))
            .map_or_else(|| id.to_owned(), |id| self.call(id).to_owned())
    }
}
