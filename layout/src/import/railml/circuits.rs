//! The circuits of a railML file: train detection elements cut the tracks, tvdSections name what lies between.

use std::collections::{BTreeMap, BTreeSet};

use roxmltree::Node;

use super::infrastructure::{Spot, Tracks};
use super::xml::{Xml, references};
use crate::at::At;
use crate::form::Station;
use crate::graph::Graph;
use crate::import::Report;
use crate::import::network::{Cut, Divided, Network};
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
    /// Switches by id: their number, and whether the left branch is the normal leg.
    pub switches: BTreeMap<&'a str, (usize, bool)>,
    /// The joints of detectors and buffer stops by id.
    pub borders: BTreeMap<&'a str, String>,
}

/// Writes circuits, points and ends into `station`.
pub fn write<'a>(xml: &Xml<'a>, tracks: Tracks<'a>, station: &mut Station, report: &mut Report) -> Placed<'a> {
    let Tracks { mut network, detectors, signals, buffers, switches } = tracks;
    let demarcating: BTreeSet<&str> =
        xml.all("tvdSection").flat_map(|section| references(section, "hasDemarcatingTraindetector")).collect();
    let mut borders: BTreeMap<&str, String> = buffers;
    let mut used: BTreeSet<String> = borders.values().cloned().collect();
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
        let name = xml.id(id).map_or_else(|| (*id).to_owned(), |node| Xml::name(node).value);
        let name = if used.insert(name.clone()) { name } else { (*id).to_owned() };
        used.insert(name.clone());
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
    distinct_points(station);
    let mut ignored = Vec::new();
    let graph = Graph::of(station, &Names::of(station, &mut ignored), &mut ignored);
    let joints = graph.joints.iter().enumerate().map(|(number, joint)| (joint.name.clone(), number)).collect();
    Placed { graph, joints, network, divided, sections, signals, switches, borders }
}

/// Gives every area the name of the tvdSection with the same borders.
fn sections<'a>(
    xml: &Xml<'a>,
    divided: &Divided,
    borders: &BTreeMap<&str, String>,
    report: &mut Report,
) -> (Vec<At<String>>, BTreeMap<&'a str, usize>) {
    let mut names: Vec<Option<At<String>>> = vec![None; divided.areas.len()];
    let mut sections = BTreeMap::new();
    let mut used = BTreeSet::new();
    let given = |section: Node<'a, 'a>| -> BTreeSet<String> {
        let named =
            references(section, "hasDemarcatingTraindetector").chain(references(section, "hasDemarcatingBufferstop"));
        named.filter_map(|id| borders.get(id).cloned()).collect()
    };
    let mut take = |section: Node<'a, 'a>, id: &'a str, area: usize| {
        let mut name = Xml::name(section);
        if !used.insert(name.value.clone()) {
            id.clone_into(&mut name.value);
            used.insert(name.value.clone());
        }
        names[area] = Some(name);
        sections.insert(id, area);
    };
    // Those that fit exactly first, so that no other one takes their place.
    let mut free: BTreeSet<usize> = (0..divided.areas.len()).collect();
    let mut left = Vec::new();
    for section in xml.all("tvdSection") {
        let Some(id) = section.attribute("id") else { continue };
        let has = given(section);
        let exact = free.iter().copied().find(|area| divided.areas[*area].marked == has).filter(|_| !has.is_empty());
        match exact {
            Some(area) => {
                free.remove(&area);
                take(section, id, area);
            }
            None => left.push((section, id, has)),
        }
    }
    for (section, id, has) in left {
        let common = |area: usize| divided.areas[area].marked.intersection(&has).count();
        let best =
            free.iter().copied().max_by_key(|area| (common(*area), usize::MAX - divided.areas[*area].marked.len()));
        let Some(area) = best.filter(|area| common(*area) > 0) else {
            report
                .lacking
                .push(format!("a place for the tvdSection {id}: no part of the tracks lies between its detectors"));
            continue;
        };
        let what = format!(
            "tvdSection {id}: no part of the tracks has exactly its borders; the one with most of them is taken"
        );
        report.defaulted.push(what);
        free.remove(&area);
        take(section, id, area);
    }
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

/// Two switches of one name get numbers.
fn distinct_points(station: &mut Station) {
    let mut used: BTreeMap<String, usize> = BTreeMap::new();
    for point in &mut station.points {
        let count = used.entry(point.name.value.clone()).and_modify(|count| *count += 1).or_insert(1);
        if *count > 1 {
            point.name.value = format!("{} #{count}", point.name);
        }
    }
}
