//! The circuits of a railML file: train detection elements cut the tracks, tvdSections name what lies between.

use std::collections::{BTreeMap, BTreeSet};

use roxmltree::Node;

use super::infrastructure::{Spot, Switched, Tracks};
use super::xml::{Xml, references};
use crate::at::At;
use crate::form::{Position, Station};
use crate::graph::Graph;
use crate::import::limits::Limits;
use crate::import::network::{Area, Cut, Divided, Network};
use crate::import::report::Report;
use crate::names::Names;

/// Where things of the file are in the layout.
pub struct Placed<'a> {
    /// The tracks of the layout.
    pub graph: Graph,
    /// The joints by name.
    pub joints: BTreeMap<String, usize>,
    /// The cuts.
    pub network: Network,
    /// The circuits between them.
    pub divided: Divided,
    /// tvdSections by id.
    pub sections: BTreeMap<&'a str, usize>,
    /// Signals by id.
    pub signals: BTreeMap<&'a str, Spot>,
    /// Switches by id.
    pub switches: BTreeMap<&'a str, Switched>,
    /// Positions of the two points of a slip between which there is no way.
    pub absent: Vec<[(usize, Position); 2]>,
    /// What the file says of speeds.
    pub limits: Limits,
    /// The joints of detectors and buffer stops by id.
    pub borders: BTreeMap<&'a str, String>,
    /// Buffer stops that are no end of the tracks: edge, metres from its begin, and where the file has it.
    pub inside: Vec<(usize, f64, String)>,
    /// Points whose machine asks for what no layout holds, and what that is.
    pub barred: BTreeMap<usize, String>,
}

/// Writes circuits, points and ends into `station`.
pub fn write<'a>(xml: &Xml<'a>, tracks: Tracks<'a>, station: &mut Station, report: &mut Report) -> Placed<'a> {
    let Tracks { mut network, detectors, signals, buffers, switches, absent, limits, inside } = tracks;
    let demarcating: BTreeSet<&str> =
        xml.all("tvdSection").flat_map(|section| references(section, "hasDemarcatingTraindetector")).collect();
    let mut borders: BTreeMap<&str, String> = buffers;
    let mut virtual_ones = Vec::new();
    for (id, spot) in &detectors {
        let is_virtual =
            xml.id(id).is_some_and(|node| node.attribute("type").is_some_and(|kind| kind.starts_with("virtual")));
        let cuts_here = if demarcating.is_empty() { !is_virtual } else { demarcating.contains(id) };
        if !cuts_here {
            virtual_ones.push(*id);
            continue;
        }
        let same = network.cuts.iter().find(|cut| cut.edge == spot.edge && (cut.at - spot.at).abs() < 0.01);
        if let Some(same) = same {
            borders.insert(id, same.name.clone());
            continue;
        }
        let name = xml.id(id).map_or_else(|| (*id).to_owned(), |node| xml.name(node).value);
        borders.insert(id, name.clone());
        network.cuts.push(Cut { name, edge: spot.edge, at: spot.at });
    }
    if !virtual_ones.is_empty() {
        report.skipped.push(format!("train detection elements that border no section: {}", virtual_ones.join(", ")));
    }
    let mut divided = network.divide();
    let (mut names, mut sections) = sections(xml, &divided, &borders, report);
    // Circuits keep the order of the file; what it does not name comes last.
    let in_file = xml.all("tvdSection").filter_map(|section| sections.get(section.attribute("id")?).copied());
    let mut order: Vec<usize> = Vec::new();
    for area in in_file.chain(0..names.len()) {
        if !order.contains(&area) {
            order.push(area);
        }
    }
    divided.reorder(&order);
    names = order.iter().map(|old| names[*old].clone()).collect();
    for area in sections.values_mut() {
        *area = order.iter().position(|old| old == area).unwrap_or(0);
    }
    divided.write(&network, &names, station);
    report.taken.push(format!("{} train detection elements, {} circuits", network.cuts.len(), station.circuits.len()));
    let mut ignored = Vec::new();
    let graph = Graph::of(station, &Names::of(station, &mut ignored), &mut ignored);
    let joints = graph.joints.iter().enumerate().map(|(number, joint)| (joint.name.clone(), number)).collect();
    let barred = BTreeMap::new();
    Placed { graph, joints, network, divided, sections, signals, switches, absent, limits, borders, inside, barred }
}

/// Gives every area the name of the tvdSection with the same borders. A section whose borders are those of no area, or of two, has no place.
fn sections<'a>(
    xml: &Xml<'a>,
    divided: &Divided,
    borders: &BTreeMap<&str, String>,
    report: &mut Report,
) -> (Vec<At<String>>, BTreeMap<&'a str, usize>) {
    let mut names: Vec<Option<At<String>>> = vec![None; divided.areas.len()];
    let mut sections = BTreeMap::new();
    let given: Vec<(Node<'a, 'a>, Borders)> =
        xml.all("tvdSection").map(|section| (section, Borders::of(xml, section, borders))).collect();
    for (section, has) in &given {
        let Some(id) = section.attribute("id") else { continue };
        let fitting: Vec<usize> = (0..divided.areas.len()).filter(|area| has.fit(&divided.areas[*area])).collect();
        match (fitting.as_slice(), has.unknown.as_slice()) {
            ([area], []) => {
                sections.insert(id, *area);
                // Two sections with the same borders are one circuit.
                let first = names[*area].get_or_insert_with(|| xml.name(*section));
                if sections.values().filter(|other| *other == area).count() > 1 {
                    let what = format!(
                        "{}: it has the borders of section {first}, and is one circuit with it",
                        Xml::at(*section)
                    );
                    report.defaulted.push(what);
                }
            }
            (_, [unknown, ..]) => report.lacking.push(format!(
                "a place for the {}: its border {} has none",
                Xml::at(*section),
                xml.place(unknown)
            )),
            ([], []) => {
                let what =
                    format!("a place for the {}: no part of the tracks has exactly its borders", Xml::at(*section));
                report.lacking.push(what);
            }
            _ => {
                let what =
                    format!("a place for the {}: several parts of the tracks have its borders", Xml::at(*section));
                report.lacking.push(what);
            }
        }
    }
    let mut used: BTreeSet<String> = names.iter().flatten().map(|name| name.value.clone()).collect();
    let mut unnamed = Vec::new();
    let named = names.into_iter().enumerate().map(|(number, name)| {
        name.unwrap_or_else(|| {
            let borders = divided.areas[number].borders.iter().cloned().collect::<Vec<_>>().join("+");
            let name =
                if borders.is_empty() || !used.insert(borders.clone()) { format!("part {number}") } else { borders };
            unnamed.push(name.clone());
            At::derived(name)
        })
    });
    let named: Vec<At<String>> = named.collect();
    if !unnamed.is_empty() {
        report
            .defaulted
            .push(format!("parts of the tracks without a tvdSection are taken as circuits: {}", unnamed.join(", ")));
    }
    (named, sections)
}

/// The borders of a tvdSection.
struct Borders {
    detectors: BTreeSet<String>,
    buffers: BTreeSet<String>,
    /// Those that have no place.
    unknown: Vec<String>,
}

impl Borders {
    fn of(xml: &Xml<'_>, section: Node<'_, '_>, borders: &BTreeMap<&str, String>) -> Self {
        // Where the line goes on is an end of the tracks; it need not be named.
        let is_open = |id: &str| xml.id(id).is_some_and(|node| node.tag_name().name() == "border");
        let mut unknown = Vec::new();
        let mut all = |list: &'static str| -> BTreeSet<String> {
            let mut found = BTreeSet::new();
            for id in references(section, list) {
                match borders.get(id) {
                    Some(name) => drop(found.insert(name.clone())),
                    None if is_open(id) => {}
                    None => unknown.push(id.to_owned()),
                }
            }
            found
        };
        let (detectors, buffers) = (all("hasDemarcatingTraindetector"), all("hasDemarcatingBufferstop"));
        Self { detectors, buffers, unknown }
    }

    /// Whether they are those of this part of the tracks. Its buffer stops may be left out, but none may be another's.
    fn fit(&self, area: &Area) -> bool {
        let names_any = !(self.detectors.is_empty() && self.buffers.is_empty());
        names_any && self.detectors == area.cuts && self.buffers.is_subset(&area.stops)
    }
}
