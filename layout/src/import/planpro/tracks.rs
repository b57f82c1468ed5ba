//! The topology of a PlanPro file as edges, links and switches.

use std::collections::{BTreeMap, BTreeSet};

use roxmltree::Node;

use super::file::{File, Place, Stretch, at, child, figure, places, start, stretches, value};
use crate::form::Station;
use crate::import::limits::{Limits, kmh};
use crate::import::network::{Edge, EdgeEnd, LONGEST, Network, Side};
use crate::import::report::Report;
use crate::problem::Problem;
use crate::rule::Rule;

/// So many metres from a node is at it.
pub const AT_NODE: f64 = 0.5;

/// What no train comes from.
const BUFFERS: [&str; 4] = ["Bremsprellbock", "Festprellbock", "Kopframpe", "Schwellenkreuz"];

/// An edge of the topology, which may be divided where another one crosses it.
pub struct Top<'a> {
    /// The nodes A and B, by identity.
    pub nodes: [String; 2],
    /// What is joined to it there: `Spitze`, `Links`, `Rechts` at a switch.
    pub ports: [&'a str; 2],
    /// Its length, in metres.
    pub length: f64,
    /// Its parts: from, to, in metres from node A, and the edge of the network.
    parts: Vec<(f64, f64, usize)>,
}

/// What is at a node with three edges.
#[derive(Clone, Copy)]
pub struct Fork {
    /// The number of the point.
    pub point: usize,
    /// Whether its left leg is the normal one.
    pub left_is_normal: bool,
}

/// What is no track that a route can hold.
pub struct Obstacle {
    /// Where it is: a stretch, or a place.
    pub on: Stretch,
    /// What it is.
    pub what: String,
}

impl Obstacle {
    /// One at a place.
    pub fn at(place: Place, what: String) -> Self {
        Self { on: Stretch { edge: place.edge, from: place.at, to: place.at }, what }
    }
}

/// The tracks.
pub struct Tracks<'a> {
    /// The edges, links and switches; cuts are made later.
    pub network: Network,
    /// The edges of the topology.
    pub edges: BTreeMap<String, Top<'a>>,
    /// The switches, by the identity of their node.
    pub forks: BTreeMap<String, Fork>,
    /// The points of each W_Kr_Gsp_Element.
    pub elements: BTreeMap<String, Vec<usize>>,
    /// Points that no route can hold, and why.
    pub barred: BTreeMap<usize, String>,
    /// What stands on the tracks and is no part of a layout.
    pub obstacles: Vec<Obstacle>,
    /// What may be asked of any route, as the file does not say of which.
    pub nowhere: Vec<String>,
    /// What the file says of speeds.
    pub limits: Limits,
    /// The identities of all edges of the file.
    top_edges: BTreeSet<String>,
}

/// Reads the tracks.
pub fn read<'a>(file: &File<'a>, station: &Station, report: &mut Report, problems: &mut Vec<Problem>) -> Tracks<'a> {
    let mut tracks = Tracks {
        network: Network::default(),
        edges: BTreeMap::new(),
        forks: BTreeMap::new(),
        elements: BTreeMap::new(),
        barred: BTreeMap::new(),
        obstacles: Vec::new(),
        nowhere: Vec::new(),
        limits: Limits::default(),
        top_edges: file
            .all("TOP_Kante")
            .filter_map(|node| Some(value(node, &["Identitaet"])?.to_lowercase()))
            .collect(),
    };
    tracks.read_edges(file, problems);
    tracks.read_nodes(file, station, report);
    tracks.read_buffers(file, report);
    tracks.read_level_crossings(file);
    tracks.read_flanks(file);
    tracks.read_limits(file, report);
    tracks
}

impl<'a> Tracks<'a> {
    /// The edge of the network at a place, and metres from its begin.
    pub fn spot(&self, place: &Place) -> Option<(usize, f64)> {
        let top = self.edges.get(&place.edge)?;
        if !(-AT_NODE..=top.length + AT_NODE).contains(&place.at) {
            return None;
        }
        let at = place.at.clamp(0.0, top.length);
        let (from, _, edge) = top.parts.iter().find(|(from, to, _)| (*from..=*to).contains(&at))?;
        Some((*edge, at - from))
    }

    /// The parts of the network that a stretch covers: edge, and metres from its begin.
    pub fn parts(&self, stretch: &Stretch) -> Vec<(usize, f64, f64)> {
        let parts = self.edges.get(&stretch.edge).map(|top| top.parts.as_slice()).unwrap_or_default();
        let covered =
            parts.iter().map(|(from, to, edge)| (*edge, stretch.from.max(*from) - from, stretch.to.min(*to) - from));
        covered.filter(|(_, from, to)| from < to).collect()
    }

    /// The ends of edges at a node: the identity of the edge, whether it is its end B, and what is joined there.
    pub fn at_node(&self, node: &str) -> Vec<(&str, bool, &'a str)> {
        let ends = self.edges.iter().flat_map(|(id, top)| {
            [(false, 0), (true, 1)]
                .map(|(is_b, place)| (id.as_str(), is_b, top.ports[place], top.nodes[place].as_str()))
        });
        ends.filter(|(.., of)| *of == node).map(|(id, is_b, port, _)| (id, is_b, port)).collect()
    }

    /// The end of an edge of the topology as one of the network.
    pub fn end(&self, id: &str, is_b: bool) -> Option<EdgeEnd> {
        let parts = &self.edges.get(id)?.parts;
        if is_b { Some((parts.last()?.2, Side::End)) } else { Some((parts.first()?.2, Side::Begin)) }
    }

    fn read_edges(&mut self, file: &File<'a>, problems: &mut Vec<Problem>) {
        let crossings = self.crossings(file);
        let mut crossed: BTreeMap<&str, Vec<(f64, usize)>> = BTreeMap::new();
        for (number, pair) in crossings.iter().enumerate() {
            for place in pair {
                crossed.entry(&place.edge).or_default().push((place.at, number));
            }
        }
        let mut links_of: Vec<Vec<usize>> = vec![Vec::new(); crossings.len()];
        for node in file.all("TOP_Kante") {
            let length = figure(node, &["TOP_Kante_Allg", "TOP_Laenge"]);
            let nodes = value(node, &["ID_TOP_Knoten_A"]).zip(value(node, &["ID_TOP_Knoten_B"]));
            let port = |name| value(node, &["TOP_Kante_Allg", name]).unwrap_or_default();
            let (Some(id), Some(length), Some((a, b))) = (value(node, &["Identitaet"]), length, nodes) else {
                let what = format!("the {} lacks its length or a node", at(node));
                problems.push(Problem::new(Rule::Form, &start(node), what, "give TOP_Laenge and both nodes"));
                continue;
            };
            if !(0.0..=LONGEST).contains(&length) {
                let what = format!("the {} is {length} m long", at(node));
                problems.push(Problem::new(Rule::Range, &start(node), what, format!("give metres, 0 to {LONGEST}")));
                continue;
            }
            let mut cuts = crossed.remove(id.to_lowercase().as_str()).unwrap_or_default();
            cuts.retain(|(at, _)| (AT_NODE..=length - AT_NODE).contains(at));
            cuts.sort_by(|one, other| one.0.total_cmp(&other.0));
            let name = file.name(node).value;
            let (mut parts, mut from) = (Vec::new(), 0.0);
            for (to, crossing) in cuts.iter().map(|(at, crossing)| (*at, Some(*crossing))).chain([(length, None)]) {
                let edge = self.network.edges.len();
                let called = if parts.is_empty() { name.clone() } else { format!("{name} #{}", parts.len() + 1) };
                self.network.edges.push(Edge { name: called, begin: 0.0, length: to - from });
                parts.push((from, to, edge));
                if let Some(crossing) = crossing {
                    links_of[crossing].push(self.network.links.len());
                    self.network.links.push(((edge, Side::End), (edge + 1, Side::Begin)));
                }
                from = to;
            }
            let nodes = [a.to_lowercase(), b.to_lowercase()];
            let ports = [port("TOP_Anschluss_A"), port("TOP_Anschluss_B")];
            self.edges.insert(id.to_lowercase(), Top { nodes, ports, length, parts });
        }
        for (pair, links) in crossings.into_iter().zip(links_of) {
            if let [one, other] = links[..] {
                self.network.crossings.push([one, other]);
            } else {
                let what = "a crossing that does not lie on two edges".to_owned();
                self.obstacles.extend(pair.map(|place| Obstacle::at(place, what.clone())));
            }
        }
    }

    /// Where two edges cross on the level; what is no such place, or is moved, is in the way.
    fn crossings(&mut self, file: &File<'a>) -> Vec<[Place; 2]> {
        let mut found: Vec<[Place; 2]> = Vec::new();
        for node in file.all("W_Kr_Gsp_Komponente").filter(|node| child(*node, "Kreuzung").is_some()) {
            let moves = figure(node, &["Kreuzung", "Elektrischer_Antrieb_Anzahl"]).is_some_and(|motors| motors != 0.0);
            let pair = match <[Place; 2]>::try_from(places(node)) {
                Ok(pair) if pair[0].edge != pair[1].edge && !moves => pair,
                Ok(pair) => {
                    self.obstruct(node, pair.to_vec(), "is moved, or does not lie on two edges");
                    continue;
                }
                Err(here) => {
                    self.obstruct(node, here, "does not lie on two edges");
                    continue;
                }
            };
            // Both sides of a crossing are at one place.
            let near = |one: &Place, other: &Place| one.edge == other.edge && (one.at - other.at).abs() < AT_NODE;
            let same = |other: &[Place; 2]| {
                near(&pair[0], &other[0]) && near(&pair[1], &other[1])
                    || near(&pair[0], &other[1]) && near(&pair[1], &other[0])
            };
            if !found.iter().any(same) {
                found.push(pair);
            }
        }
        found
    }

    /// Has an object stand in the way at each of these places.
    pub fn obstruct(&mut self, node: Node<'a, 'a>, places: Vec<Place>, why: &str) {
        let what = format!("the {} {why}", at(node));
        // The edges may not have been read yet.
        let is_known = |place: &Place| self.top_edges.contains(&place.edge);
        if !places.iter().any(is_known) {
            self.nowhere.push(format!("{what}, and has no place on the tracks"));
        }
        self.obstacles.extend(places.into_iter().map(|place| Obstacle::at(place, what.clone())));
    }

    fn read_buffers(&mut self, file: &File<'a>, report: &mut Report) {
        for node in file.all("Gleis_Abschluss") {
            // Over a turntable or from a ferry trains may come: that is no buffer stop.
            if !value(node, &["Gleis_Abschluss_Art"]).is_some_and(|kind| BUFFERS.contains(&kind)) {
                continue;
            }
            for place in places(node) {
                let Some((edge, metres)) = self.spot(&place) else {
                    report.lacking.push(format!("a place for the {}", at(node)));
                    continue;
                };
                match self.network.stop(edge, metres, &[]) {
                    Some(side) => self.network.buffers.push((file.name(node).value, (edge, side))),
                    None => self.obstruct(node, vec![place], "stands on tracks that lead on"),
                }
            }
        }
    }

    /// No layout asks whether a level crossing is closed.
    fn read_level_crossings(&mut self, file: &File<'a>) {
        for node in file.objects().filter(|node| node.tag_name().name().starts_with("BUE_")) {
            let what = format!("the {} is of a level crossing, which no layout asks for", at(node));
            let places = places(node).into_iter().map(|place| Obstacle::at(place, what.clone()));
            self.obstacles.extend(places);
            match stretches(node) {
                Ok(all) => self.obstacles.extend(all.into_iter().map(|on| Obstacle { on, what: what.clone() })),
                Err(why) => self.nowhere.push(why),
            }
        }
    }

    /// Flank protection whose place is not that of a point: it is in the way there, or may be about any route.
    fn read_flanks(&mut self, file: &File<'a>) {
        for node in file.all("Fla_Schutz") {
            let Some(asks) = child(node, "Fla_Schutz_Anforderer") else { continue };
            let by = value(asks, &["ID_Anforderer_Element"]).unwrap_or_default();
            let element = file.id(by);
            // A zone that is set locally asks for its own vehicles.
            if self.elements.contains_key(&by.to_lowercase())
                || element.is_some_and(|one| one.has_tag_name("NB_Zone_Grenze"))
            {
                continue;
            }
            let own = |part: &Node<'a, 'a>| element.is_some() && file.referred(*part, "ID_W_Kr_Gsp_Element") == element;
            let here: Vec<Place> = file.all("W_Kr_Gsp_Komponente").filter(own).flat_map(places).collect();
            self.obstruct(node, here, "is asked for by what is no point");
        }
        let lacks = |name: &'static str| move |node: &Node<'a, 'a>| file.referred(*node, name).is_none();
        let proved = file.all("Fla_Freimelde_Zuordnung").filter(lacks("ID_Fla_Schutz"));
        let locked = file.all("Fstr_DWeg_W_Kr").filter(lacks("ID_Fstr_DWeg"));
        self.nowhere
            .extend(proved.chain(locked).map(|node| format!("the {} is for what is not in the file", at(node))));
    }

    fn read_limits(&mut self, file: &File<'a>, report: &mut Report) {
        let given = file
            .all("Geschwindigkeitsprofil")
            .map(|node| (node, value(node, &["Geschwindigkeitsprofil_Allg", "Geschwindigkeit"])))
            .chain(
                file.all("Gleis_Abschnitt").filter_map(|node| Some((node, Some(value(node, &["Geschwindigkeit"])?)))),
            );
        let crossings = file.all("W_Kr_Gsp_Komponente").flat_map(|node| {
            let speeds = ["Geschwindigkeit_L", "Geschwindigkeit_R"].map(|name| value(node, &["Kreuzung", name]));
            speeds.into_iter().flatten().map(move |text| (node, kmh(text).unwrap_or(0)))
        });
        for (node, limit) in crossings {
            for Place { edge, at, .. } in places(node) {
                let here = self.parts(&Stretch { edge, from: at - AT_NODE, to: at + AT_NODE });
                self.limits.stretches.extend(here.into_iter().map(|(edge, from, to)| (edge, from, to, limit)));
            }
        }
        for (node, text) in given {
            // What cannot be read may be anything: no route is taken over it. What cannot be placed may be anywhere.
            let limit = text.and_then(kmh).unwrap_or_else(|| {
                report.lacking.push(format!("a speed of the {}: it is no number above 0", at(node)));
                0
            });
            match stretches(node) {
                Ok(covered) if covered.iter().all(|stretch| self.edges.contains_key(&stretch.edge)) => {
                    let parts = covered.iter().flat_map(|stretch| self.parts(stretch));
                    let parts: Vec<_> = parts.map(|(edge, from, to)| (edge, from, to, limit)).collect();
                    self.limits.stretches.extend(parts);
                }
                _ => {
                    report.lacking.push(format!("a place for the {}; {limit} km/h hold everywhere", at(node)));
                    let edges = self.network.edges.iter().enumerate();
                    self.limits.stretches.extend(edges.map(|(edge, given)| (edge, 0.0, given.length, limit)));
                }
            }
        }
    }
}
