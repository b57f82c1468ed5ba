//! Looking things up in a railML tree: by local name, by id, with durations and names.

use std::collections::{BTreeMap, BTreeSet};

use roxmltree::{Document, Node};

use crate::at::At;
use crate::import::report::Report;

/// A railML tree with its ids.
pub struct Xml<'a> {
    root: Node<'a, 'a>,
    ids: BTreeMap<&'a str, Node<'a, 'a>>,
    /// How many elements of a kind have a name. Only ids tell elements apart; names are for people.
    named: BTreeMap<(&'a str, &'a str), usize>,
}

/// Elements whose names must differ, by what they become in a layout: joints have one set of names.
const KINDS: [(&str, &str); 6] = [
    ("trainDetectionElement", "joint"),
    ("bufferStop", "joint"),
    ("signalIS", "signal"),
    ("switchIS", "point"),
    ("tvdSection", "circuit"),
    ("route", "route"),
];

/// Elements that are looked at; the others are reported as not used.
const USED: [&str; 29] = [
    "netElements",
    "netRelations",
    "networks",
    "switchesIS",
    "trainDetectionElements",
    "signalsIS",
    "bufferStops",
    "tracks",
    "tvdSections",
    "switchesIL",
    "signalsIL",
    "routes",
    "overlaps",
    "destinationPoints",
    "conflictingRoutes",
    "routeRelations",
    "platforms",
    "borders",
    "metadata",
    "common",
    "organizationalUnits",
    "positioning",
    "geometricPositioningSystems",
    "linearPositioningSystems",
    "crossings",
    "speeds",
    "topology",
    "infrastructureVisualizations",
    "specificIMs",
];

impl<'a> Xml<'a> {
    /// Indexes the ids of a document.
    pub fn new(document: &'a Document<'a>) -> Self {
        let root = document.root_element();
        let with_id = root.descendants().filter_map(|node| node.attribute("id").map(|id| (id, node)));
        let mut named = BTreeMap::new();
        for node in root.descendants() {
            if let Some(kind) = kind(node) {
                *named.entry((kind, called(node))).or_default() += 1;
            }
        }
        Self { root, ids: with_id.collect(), named }
    }

    /// An element and where it stands, for people: `route rt3, line 120`.
    pub fn at(node: Node<'_, '_>) -> String {
        let line = node.document().text_pos_at(node.range().start).row;
        format!("{} {}, line {line}", node.tag_name().name(), node.attribute("id").unwrap_or("without an id"))
    }

    /// The same of the element with this id, or the id alone if there is none.
    pub fn place(&self, id: &str) -> String {
        self.id(id).map_or_else(|| format!("{id}, which does not exist"), Self::at)
    }

    /// Every element of this local name, in the order of the file.
    pub fn all(&self, name: &'a str) -> impl Iterator<Item = Node<'a, 'a>> + 'a {
        self.root.descendants().filter(move |node| node.is_element() && node.tag_name().name() == name)
    }

    /// The element with this id.
    pub fn id(&self, id: &str) -> Option<Node<'a, 'a>> {
        self.ids.get(id).copied()
    }

    /// The element of the infrastructure that one of the interlocking stands for: that of its `refersTo`, or itself.
    pub fn referred(&self, id: &str) -> Option<Node<'a, 'a>> {
        let mut node = self.id(id)?;
        // A route's exit names a destination point, that a signal of the interlocking, that one of the infrastructure.
        for _ in 0..3 {
            let Some(next) = reference(node, "refersTo").and_then(|id| self.id(id)) else { break };
            node = next;
        }
        Some(node)
    }

    /// A title of the file: its metadata, or the name of an operational point.
    pub fn title(&self) -> Option<String> {
        let point = self.all("operationalPoint").next().map(|point| self.name(point).value);
        let title = self
            .all("title")
            .filter_map(|title| title.text())
            .map(|text| text.trim().to_owned())
            .find(|text| !text.is_empty());
        point.filter(|name| !name.trim().is_empty()).or(title)
    }

    /// What people call an element: its name, its designator, or its id; its id alone where another one of its kind is called the same.
    pub fn name(&self, node: Node<'a, 'a>) -> At<String> {
        let called = called(node);
        let alone = kind(node).is_none_or(|kind| self.named.get(&(kind, called)) == Some(&1));
        let name = if alone { called } else { node.attribute("id").unwrap_or(called) };
        // The start tag alone: an element may be long.
        let range = node.range();
        At::new(name.to_owned(), range.start..range.end.min(range.start + 1))
    }

    /// Reports the lists of elements that the import does not look at, each once with its length.
    pub fn unused(&self, report: &mut Report) {
        let wanted: BTreeSet<&str> = USED.into_iter().collect();
        let lists = ["functionalInfrastructure", "assetsForIL", "assetsForInterlocking", "infrastructure"];
        let mut counts: BTreeMap<&str, usize> = BTreeMap::new();
        for parent in lists.iter().flat_map(|list| self.all(list)) {
            for list in parent.children().filter(Node::is_element) {
                let name = list.tag_name().name();
                if !wanted.contains(name) && !lists.contains(&name) {
                    *counts.entry(name).or_default() += list.children().filter(Node::is_element).count();
                }
            }
        }
        for (name, count) in counts {
            // `steepest` has looked at them.
            let but = if name == "geometryCurves" { ", but for the steepest gradient" } else { "" };
            report.skipped.push(format!("{name} with {count} elements{but}"));
        }
    }
}

fn kind(node: Node<'_, '_>) -> Option<&'static str> {
    KINDS.iter().find(|(name, _)| *name == node.tag_name().name()).map(|(_, kind)| *kind)
}

fn called<'a>(node: Node<'a, 'a>) -> &'a str {
    let named = node.children().find_map(|child| match child.tag_name().name() {
        "name" | "objectName" | "assetName" => child.attribute("name"),
        "designator" => child.attribute("entry"),
        _ => None,
    });
    named.filter(|name| !name.trim().is_empty()).or_else(|| node.attribute("id")).unwrap_or("unnamed")
}

/// The first child of this local name.
pub fn child<'a>(node: Node<'a, 'a>, name: &str) -> Option<Node<'a, 'a>> {
    node.children().find(|child| child.is_element() && child.tag_name().name() == name)
}

/// The children of this local name.
pub fn children<'a>(node: Node<'a, 'a>, name: &'a str) -> impl Iterator<Item = Node<'a, 'a>> + 'a {
    node.children().filter(move |child| child.is_element() && child.tag_name().name() == name)
}

/// The id that the child of this name refers to.
pub fn reference<'a>(node: Node<'a, 'a>, name: &str) -> Option<&'a str> {
    child(node, name).and_then(|child| child.attribute("ref"))
}

/// The ids that the children of this name refer to.
pub fn references<'a>(node: Node<'a, 'a>, name: &'a str) -> impl Iterator<Item = &'a str> + 'a {
    children(node, name).filter_map(|child| child.attribute("ref"))
}

/// A number that an attribute gives, if it is finite.
pub fn number(node: Node<'_, '_>, name: &str) -> Option<f64> {
    node.attribute(name)?.trim().parse::<f64>().ok().filter(|number| number.is_finite())
}

/// Whether an attribute is there and says neither `false` nor `0`: one that cannot be read may be true.
pub fn is_set(node: Node<'_, '_>, name: &str) -> bool {
    node.attribute(name).is_some_and(|text| !["false", "0"].contains(&text.trim()))
}

/// A time like `PT4S`, `P1D`, `PT1M30S` or `P0Y0M0DT0H2M0.5S` in ms, rounded up. Years and months, which have no length of their own,
/// must be 0.
pub fn duration(text: &str) -> Option<u32> {
    let text = text.trim().strip_prefix('P')?;
    let (days, time) = text.split_once('T').unwrap_or((text, ""));
    if text.is_empty() || text.ends_with('T') {
        return None;
    }
    let days = figures(days, &[('Y', None), ('M', None), ('D', Some(86_400.0))])?;
    let seconds = days + figures(time, &[('H', Some(3600.0)), ('M', Some(60.0)), ('S', Some(1.0))])?;
    let ms = (seconds * 1000.0).ceil();
    if !(0.0..=4e9).contains(&ms) {
        return None;
    }
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "it is in the range of the type")]
    let ms = ms as u32;
    Some(ms)
}

/// Figures with units, each at most once and in this order, in seconds; a unit without a length takes 0 alone.
fn figures(mut text: &str, units: &[(char, Option<f64>)]) -> Option<f64> {
    let mut seconds = 0.0;
    for (unit, length) in units {
        let Some((figure, rest)) = text.split_once(*unit) else { continue };
        let plain = !figure.is_empty() && figure.chars().all(|letter| letter.is_ascii_digit() || letter == '.');
        let figure = figure.parse::<f64>().ok().filter(|figure| plain && (length.is_some() || *figure == 0.0))?;
        seconds += figure * length.unwrap_or(0.0);
        text = rest;
    }
    text.is_empty().then_some(seconds)
}
