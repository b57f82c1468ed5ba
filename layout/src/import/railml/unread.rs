//! What elements have that this import does not read: told, and where a route has it that it may depend on, the route is left out.

use std::collections::{BTreeMap, BTreeSet};

use roxmltree::Node;

use super::xml::Xml;
use crate::import::report::Report;

/// What is read of an element.
struct Read {
    element: &'static str,
    attributes: &'static [&'static str],
    children: &'static [&'static str],
    /// What a layout may do without: when a route is called, and how long its signal goes on to show proceed.
    harmless: &'static [&'static str],
}

const READ: [Read; 8] = [
    Read {
        element: "route",
        attributes: &["approachReleaseDelay", "residualRouteCancellationDelay", "residualRouteReleaseDelay"],
        children: &[
            "additionalRelation",
            "facingSwitchInPosition",
            "handlesRouteType",
            "hasReleaseGroup",
            "hasTvdSection",
            "routeEntry",
            "routeExit",
            "trailingSwitchInPosition",
        ],
        harmless: &["locksAutomatically", "processingDelay", "routeActivationSection", "signalClosureDelay"],
    },
    Read { element: "routeEntry", attributes: &[], children: &["refersTo"], harmless: &[] },
    Read { element: "routeExit", attributes: &[], children: &["hasOverlap", "refersTo"], harmless: &[] },
    Read {
        element: "switchIL",
        attributes: &["maxThrowTime", "preferredPosition", "typicalThrowTime"],
        children: &["branchLeft", "branchRight", "hasFoulingTrainDetectors", "refersTo"],
        harmless: &[],
    },
    Read {
        element: "tvdSection",
        attributes: &[
            "partialRouteReleaseDelay",
            "residualRouteCancellationDelay",
            "residualRouteReleaseDelay",
            "technology",
        ],
        children: &["hasDemarcatingBufferstop", "hasDemarcatingTraindetector"],
        harmless: &[],
    },
    Read {
        element: "speedSection",
        attributes: &["maxSpeed"],
        children: &["areaLocation", "linearLocation", "spotLocation"],
        harmless: &[],
    },
    Read { element: "bufferStop", attributes: &[], children: &["spotLocation"], harmless: &[] },
    Read { element: "trainDetectionElement", attributes: &["type"], children: &["spotLocation"], harmless: &[] },
];

/// Every element may have them.
const NAMES: [&str; 4] = ["assetName", "designator", "name", "objectName"];

/// What is not read of an element, attributes first: `the attribute x`, `the element y`, each with its name.
fn unread<'a>(node: Node<'a, 'a>) -> impl Iterator<Item = (String, &'a str)> {
    let read = READ.iter().find(|read| read.element == node.tag_name().name());
    let attributes = node.attributes().filter(|at| at.namespace().is_none() && at.name() != "id");
    let attributes = attributes.filter(move |at| read.is_some_and(|read| !read.attributes.contains(&at.name())));
    let children = node.children().filter(Node::is_element).map(|child| child.tag_name().name());
    let children =
        children.filter(move |name| read.is_some_and(|read| !read.children.contains(name)) && !NAMES.contains(name));
    let attributes = attributes.map(|at| (format!("the attribute {}", at.name()), at.name()));
    attributes.chain(children.map(|name| (format!("the element {name}"), name)))
}

/// Reports what is not read, each kind once, with how many elements have it and the first of them.
pub fn tell(xml: &Xml<'_>, report: &mut Report) {
    for read in &READ {
        let mut found: BTreeMap<String, (usize, String)> = BTreeMap::new();
        for node in xml.all(read.element) {
            let kinds: BTreeSet<String> = unread(node).map(|(what, _)| what).collect();
            for what in kinds {
                found.entry(what).or_insert_with(|| (0, Xml::at(node))).0 += 1;
            }
        }
        for (what, (count, first)) in found {
            let element = read.element;
            report.skipped.push(format!("{what} of {element}, which {count} have; the first is {first}"));
        }
    }
}

/// What a route has that it may depend on, and that is not read.
pub fn asks(route: Node<'_, '_>) -> Option<String> {
    let harmless = READ.iter().find(|read| read.element == "route").map_or(&[][..], |read| read.harmless);
    unread(route).find(|(_, name)| !harmless.contains(name)).map(|(what, _)| what)
}
