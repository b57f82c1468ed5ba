//! The circuits of a PlanPro file: its sections of track vacancy detection; where it has none, what lies between its signals.

use std::collections::{BTreeMap, BTreeSet};

use roxmltree::Node;

use super::borders::{cut_at_borders, cut_at_signals};
use super::file::{File, Stretch, at, child, stretches, value};
use super::tracks::{AT_NODE, Tracks};
use crate::at::At;
use crate::form::Station;
use crate::graph::Graph;
use crate::import::network::Divided;
use crate::import::report::Report;
use crate::names::Names;

/// Where things of the file are in the layout.
pub struct Placed<'a> {
    /// The edges, points and what stands on them.
    pub tracks: Tracks<'a>,
    /// The circuits between the cuts.
    pub divided: Divided,
    /// The tracks of the layout.
    pub graph: Graph,
    /// The joints by name.
    pub joints: BTreeMap<String, usize>,
    /// Circuits that no route can hold, and why.
    pub unsound: BTreeMap<usize, String>,
    /// The circuit of each FMA_Anlage.
    pub sections: BTreeMap<String, usize>,
}

/// A section of track vacancy detection.
pub struct Section<'a> {
    /// The identity of its FMA_Anlage.
    id: String,
    /// What it is called.
    pub name: At<String>,
    /// Its Gleis_Abschnitt.
    node: Node<'a, 'a>,
    /// What it covers.
    pub stretches: Vec<Stretch>,
}

/// Writes circuits, points and ends into `station`.
pub fn write<'a>(file: &File<'a>, mut tracks: Tracks<'a>, station: &mut Station, report: &mut Report) -> Placed<'a> {
    let sections = sections(file, &tracks, report);
    let detected = file.all("FMA_Anlage").next().is_some();
    if detected {
        cut_at_borders(file, &sections, &mut tracks, report);
    } else {
        report
            .defaulted
            .push("the file has no track vacancy detection: circuits are taken to meet at its signals".to_owned());
        cut_at_signals(file, &mut tracks);
    }
    let mut divided = tracks.network.divide();
    let mut names = divided.names();
    let mut unsound = BTreeMap::new();
    let mut found = BTreeMap::new();
    if detected {
        let covered =
            |section: &Section<'_>| section.stretches.iter().flat_map(|stretch| tracks.parts(stretch)).collect();
        let parts: Vec<Vec<(usize, f64, f64)>> = sections.iter().map(covered).collect();
        let mut of_area: Vec<Result<usize, String>> =
            (0..divided.areas.len()).map(|area| detects(&sections, &parts, &divided, area)).collect();
        for (number, section) in sections.iter().enumerate() {
            let own: Vec<usize> = (0..of_area.len()).filter(|area| of_area[*area] == Ok(number)).collect();
            if own.len() > 1 {
                let why = format!("the {} is in {} parts, and is no one circuit", at(section.node), own.len());
                for area in own {
                    of_area[area] = Err(why.clone());
                }
            }
        }
        let place = |area: &usize| of_area[*area].as_ref().map_or(usize::MAX, |section| *section);
        let mut order: Vec<usize> = (0..of_area.len()).collect();
        order.sort_by_key(place);
        divided.reorder(&order);
        names = order.iter().map(|old| names[*old].clone()).collect();
        for (area, old) in order.into_iter().enumerate() {
            match &of_area[old] {
                Ok(section) => {
                    names[area] = sections[*section].name.clone();
                    found.insert(sections[*section].id.clone(), area);
                }
                Err(why) => {
                    report.lacking.push(format!("circuit {}: {why}; no route is taken over it", names[area]));
                    unsound.insert(area, why.clone());
                }
            }
        }
        for section in sections.iter().filter(|section| !found.contains_key(&section.id)) {
            report.lacking.push(format!("a circuit for the {}", at(section.node)));
        }
    }
    divided.write(&tracks.network, &names, station);
    report.taken.push(format!(
        "{} borders of sections, {} circuits",
        tracks.network.cuts.len(),
        station.circuits.len()
    ));
    let of_track = |section: &Section<'_>| {
        Some((value(section.node, &["Identitaet"])?.to_lowercase(), found.get(&section.id).copied()?))
    };
    fouled(file, &sections.iter().filter_map(of_track).collect(), &mut tracks, station);
    let mut ignored = Vec::new();
    let graph = Graph::of(station, &Names::of(station, &mut ignored), &mut ignored);
    let joints = graph.joints.iter().enumerate().map(|(number, joint)| (joint.name.clone(), number)).collect();
    Placed { tracks, divided, graph, joints, unsound, sections: found }
}

/// Enters the circuits in which a train fouls a point, where the border of its section lies within its fouling limit.
fn fouled(file: &File<'_>, tracks_of: &BTreeMap<String, usize>, tracks: &mut Tracks<'_>, station: &mut Station) {
    for (id, points) in &tracks.elements {
        let Some(element) = file.id(id) else { continue };
        for leg in ["GZ_Freimeldung_L", "GZ_Freimeldung_R"] {
            let Some(given) = child(element, "Weiche_Element").and_then(|kind| child(kind, leg)) else { continue };
            let by = value(given, &["ID_Element"]).unwrap_or_default().to_lowercase();
            let circuit = tracks_of.get(&by).map(|circuit| station.circuits[*circuit].name.value.clone());
            let points_there = tracks.elements.get(&by).map(Vec::as_slice).unwrap_or_default();
            let of_point = points_there.first().map(|point| station.points[*point].circuit.value.clone());
            let Some(circuit) = circuit.or(of_point) else {
                let why = format!("the {leg} of the {} names what is no circuit or point of the layout", at(element));
                tracks.barred.extend(points.iter().map(|point| (*point, why.clone())));
                continue;
            };
            for point in points {
                let point = &mut station.points[*point];
                let is_new = point.fouled_in.iter().all(|other| other.value != circuit);
                if is_new && point.circuit.value != circuit {
                    point.fouled_in.push(At::derived(circuit.clone()));
                }
            }
        }
    }
}

/// The sections that the file has, each with where it lies.
fn sections<'a>(file: &File<'a>, tracks: &Tracks<'a>, report: &mut Report) -> Vec<Section<'a>> {
    let mut found = Vec::new();
    for node in file.all("FMA_Anlage") {
        let track = file.referred(node, "ID_Gleis_Abschnitt");
        let id = value(node, &["Identitaet"]).unwrap_or_default().to_lowercase();
        let covered = track.ok_or_else(|| format!("the {} names no Gleis_Abschnitt", at(node))).and_then(|track| {
            let covered = stretches(track)?;
            let is_known = |stretch: &Stretch| {
                tracks
                    .edges
                    .get(&stretch.edge)
                    .is_some_and(|top| stretch.to <= top.length + AT_NODE && stretch.from >= -AT_NODE)
            };
            match covered.iter().find(|stretch| !is_known(stretch)) {
                Some(other) => Err(format!(
                    "the {} lies on {} from {} to {} m, which is no track",
                    at(track),
                    other.edge,
                    other.from,
                    other.to
                )),
                None => Ok((track, covered)),
            }
        });
        match covered {
            Ok((track, stretches)) => found.push(Section { id, name: file.name(track), node: track, stretches }),
            Err(why) => report.lacking.push(format!("a section: {why}")),
        }
    }
    found
}

/// The section that detects all of an area, and alone.
fn detects(
    sections: &[Section<'_>],
    parts: &[Vec<(usize, f64, f64)>],
    divided: &Divided,
    area: usize,
) -> Result<usize, String> {
    let pieces: Vec<_> = divided.pieces_of(area).filter(|(_, from, to)| to - from > 2.0 * AT_NODE).collect();
    let named = |number: &usize| at(sections[*number].node);
    // Touched by more than what is lost in the digits.
    let touching: BTreeSet<usize> = (0..sections.len())
        .filter(|number| {
            parts[*number].iter().any(|(edge, low, high)| {
                pieces.iter().any(|(on, from, to)| on == edge && high.min(*to) - low.max(*from) > AT_NODE)
            })
        })
        .collect();
    let mut touching_names = touching.iter().map(named);
    match (touching.first(), touching.len()) {
        (None, _) => Err("no section of track vacancy detection lies there".to_owned()),
        (Some(only), 1) => {
            let whole = pieces.iter().all(|(on, from, to)| {
                let covered = parts[*only].iter().filter(|(edge, ..)| edge == on);
                covered.map(|(_, low, high)| (high.min(*to) - low.max(*from)).max(0.0)).sum::<f64>()
                    >= to - from - 2.0 * AT_NODE
            });
            if whole { Ok(*only) } else { Err(format!("the {} covers a part of it alone", named(only))) }
        }
        _ => {
            let (one, other) = (touching_names.next().unwrap_or_default(), touching_names.next().unwrap_or_default());
            Err(format!("the {one} and the {other} both lie there"))
        }
    }
}
