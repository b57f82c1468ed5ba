//! What the file can mean by a route: the ways that a train has from its signal to its exit.

use std::collections::BTreeSet;

use roxmltree::Node;

use super::file::{Branch, File, every_ref, figure, refers};
use super::positions::asked;
use super::walk::{NEAR, OFFSET, Walk, walks};

/// What a train meets between the joint where a route begins and the one where it ends.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Reading<'a> {
    /// What the sections in rear of the first joint can be.
    pub(super) rear: BTreeSet<&'a str>,
    /// What the section at each place can be: none if the file names none there.
    pub(super) places: Vec<BTreeSet<&'a str>>,
    /// The ids of what stands at the first joint and at the last; none at an end without a name.
    pub(super) joints: [Vec<&'a str>; 2],
    /// The branches that it runs over.
    pub(super) branches: Vec<Branch<'a>>,
    /// The lowest limit of speed, in km/h.
    pub(super) limit: Option<f64>,
    /// Whether a listed section lies in rear of it.
    pub(super) drops: bool,
}

/// What the file can mean by a route.
pub(super) fn readings<'a>(file: &File<'a>, node: Node<'a, 'a>) -> Result<Vec<Reading<'a>>, String> {
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
