//! Where circuits meet: at the ends of sections of track vacancy detection, or at signals where the file has none.

use std::collections::BTreeSet;

use roxmltree::Node;

use super::circuits::Section;
use super::file::{File, Place, Stretch, at, places, value};
use super::tracks::{AT_NODE, Obstacle, Tracks};
use crate::import::joints::OFFSET;
use crate::import::network::{Cut, EdgeEnd, Side};
use crate::import::report::Report;

/// Where a section ends.
struct Border {
    /// The edge of the topology.
    edge: String,
    /// Metres from its node A.
    at: f64,
    /// At a node: the end of the edge of the network.
    end: Option<EdgeEnd>,
}

/// Cuts the tracks where sections end, and names the cuts by what stands there.
pub fn cut_at_borders<'a>(file: &File<'a>, sections: &[Section<'a>], tracks: &mut Tracks<'a>, report: &mut Report) {
    let standing: Vec<(Place, Node<'a, 'a>)> =
        file.all("FMA_Komponente").flat_map(|node| places(node).into_iter().map(move |place| (place, node))).collect();
    let mut borders = between_nodes(sections, tracks);
    borders.extend(at_nodes(sections, tracks));
    let mut used = BTreeSet::new();
    for border in &borders {
        let spot = match border.end {
            Some((number, Side::Begin)) => Some((number, tracks.network.edges[number].begin)),
            Some((number, Side::End)) => Some((number, tracks.network.edges[number].length)),
            None => tracks.spot(&Place { edge: border.edge.clone(), at: border.at, toward_end: None }),
        };
        let Some((edge, metres)) = spot else { continue };
        let given = &tracks.network.edges[edge];
        // Beyond a buffer stop there is nothing to divide.
        if (given.begin..=given.length).contains(&metres) {
            let near = |(place, _): &&(Place, Node<'a, 'a>)| {
                place.edge == border.edge && (place.at - border.at).abs() <= AT_NODE
            };
            let name = standing.iter().find(near).map(|(_, node)| file.name(*node).value);
            let name = own(name.unwrap_or_else(|| meeting(sections, border)), &mut used);
            tracks.network.cuts.push(Cut { name, edge, at: metres });
        }
    }
    // What stands where no section ends says that one does.
    for (place, node) in standing {
        let there = borders.iter().any(|border| border.edge == place.edge && (border.at - place.at).abs() <= AT_NODE);
        let is_inner =
            tracks.edges.get(&place.edge).is_some_and(|top| (AT_NODE..=top.length - AT_NODE).contains(&place.at));
        if is_inner && !there {
            let what = format!("the {} borders no section of the file", at(node));
            report.lacking.push(format!("{what}; no route is taken over it"));
            tracks.obstacles.push(Obstacle::at(place, what));
        }
    }
}

/// The borders between the nodes of their edges.
fn between_nodes(sections: &[Section<'_>], tracks: &Tracks<'_>) -> Vec<Border> {
    let mut borders: Vec<Border> = Vec::new();
    for stretch in sections.iter().flat_map(|section| &section.stretches) {
        let length = tracks.edges[&stretch.edge].length;
        for metres in [stretch.from, stretch.to] {
            let is_new = borders.iter().all(|other| other.edge != stretch.edge || (other.at - metres).abs() > AT_NODE);
            if is_new && (AT_NODE..=length - AT_NODE).contains(&metres) {
                borders.push(Border { edge: stretch.edge.clone(), at: metres, end: None });
            }
        }
    }
    borders
}

/// The borders at nodes: those of edges that are in other sections than the toe there, or than the first edge.
fn at_nodes(sections: &[Section<'_>], tracks: &Tracks<'_>) -> Vec<Border> {
    let nodes: BTreeSet<&String> = tracks.edges.values().flat_map(|top| &top.nodes).collect();
    let mut borders = Vec::new();
    for node in nodes {
        let mut ends: Vec<(bool, &str, bool, BTreeSet<usize>)> = Vec::new();
        for (edge, is_b, port) in tracks.at_node(node) {
            let length = tracks.edges[edge].length;
            let reaches = |stretch: &Stretch| {
                stretch.edge == edge && if is_b { stretch.to >= length - AT_NODE } else { stretch.from <= AT_NODE }
            };
            let own = (0..sections.len()).filter(|number| sections[*number].stretches.iter().any(reaches));
            ends.push((port != "Spitze", edge, is_b, own.collect()));
        }
        ends.sort();
        let Some((_, _, _, first)) = ends.first().cloned() else { continue };
        for (_, edge, is_b, own) in ends {
            if own != first {
                let at = if is_b { tracks.edges[edge].length } else { 0.0 };
                borders.push(Border { edge: edge.to_owned(), at, end: tracks.end(edge, is_b) });
            }
        }
    }
    borders
}

/// What a border is called at which nothing with a name stands: the sections that meet there.
fn meeting(sections: &[Section<'_>], border: &Border) -> String {
    let ends = |stretch: &Stretch| {
        stretch.edge == border.edge && [stretch.from, stretch.to].iter().any(|end| (end - border.at).abs() <= AT_NODE)
    };
    let here = sections.iter().filter(|section| section.stretches.iter().any(ends));
    let names: BTreeSet<&str> = here.map(|section| section.name.as_str()).collect();
    names.into_iter().collect::<Vec<_>>().join("/")
}

/// A name that no other border has.
fn own(name: String, used: &mut BTreeSet<String>) -> String {
    let numbered = (2..).map(|count| format!("{name} #{count}"));
    let free = [name.clone()].into_iter().chain(numbered).find(|name| !used.contains(name)).unwrap_or(name);
    used.insert(free.clone());
    free
}

/// Cuts the tracks at the signals where routes begin or end; two signals for the two directions share a cut that lies between them.
pub fn cut_at_signals<'a>(file: &File<'a>, tracks: &mut Tracks<'a>) {
    let ends = file.all("Fstr_Fahrweg").flat_map(|node| ["ID_Start", "ID_Ziel"].map(|name| value(node, &[name])));
    let used: BTreeSet<String> = ends.flatten().map(str::to_lowercase).collect();
    let is_used =
        |node: &Node<'_, '_>| value(*node, &["Identitaet"]).is_some_and(|id| used.contains(&id.to_lowercase()));
    for node in file.all("Signal").filter(is_used) {
        let here = places(node);
        let [place] = here.as_slice() else { continue };
        let (Some((edge, metres)), Some(toward_end)) = (tracks.spot(place), place.toward_end) else { continue };
        let beyond = |cut: &Cut| if toward_end { cut.at - metres } else { metres - cut.at };
        let serves = |cut: &Cut| cut.edge == edge && (0.0..=OFFSET).contains(&beyond(cut));
        if !tracks.network.cuts.iter().any(serves) {
            tracks.network.cuts.push(Cut { name: file.name(node).value, edge, at: metres });
        }
    }
}
