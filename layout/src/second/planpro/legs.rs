//! The legs of points: what stands at the first border beyond each of them.

use std::collections::{BTreeMap, BTreeSet};

use super::plan::{Plan, metres, text};
use super::run::{named, position};
use crate::form::Position;
use crate::model::Model;
use crate::second::parts::beyond_leg;

/// The points whose legs do not lead in the layout where they do in the file, and how they differ.
pub(super) fn apart(plan: &Plan<'_>, model: &Model) -> BTreeMap<usize, String> {
    let mut found = BTreeMap::new();
    if plan.kind("FMA_Anlage").next().is_none() {
        return found;
    }
    let standing = standing(plan);
    let known: BTreeSet<&String> = standing.values().flatten().map(|(_, name)| name).collect();
    let nodes: BTreeSet<&String> = plan.edges.values().flat_map(|edge| &edge.nodes).collect();
    for node in nodes.into_iter().filter(|node| plan.joined_at(node) == 3) {
        let (name, blades, element) = named(plan, node);
        let Some(point) = model.points.iter().position(|point| point.name == name) else { continue };
        for (word, is_left) in [("Links", true), ("Rechts", false)] {
            let leg = if position(blades, element, is_left) == Position::Normal { 1 } else { 2 };
            let mine = beyond_leg(model, point, leg);
            let is_open = |name: &String| {
                let joint = model.graph.joints.iter().find(|joint| joint.name == *name);
                joint.is_some_and(|joint| joint.end.is_some())
            };
            // A border at which nothing stands has a name of the layout's own.
            if mine.iter().any(|name| !known.contains(name) && !is_open(name)) {
                continue;
            }
            let mine: BTreeSet<&String> = mine.iter().filter(|name| known.contains(*name)).collect();
            let theirs = beyond(plan, node, word, &standing);
            if mine != theirs.iter().collect() {
                let what = format!("the {word} leg of point {name} leads to {mine:?}, and in the file to {theirs:?}");
                found.insert(point, what);
            }
        }
    }
    found
}

/// What borders tracks, on each edge: metres from node A, and its name.
type Standing = BTreeMap<String, Vec<(f64, String)>>;

fn standing(plan: &Plan<'_>) -> Standing {
    let mut found = Standing::new();
    for node in plan.kind("FMA_Komponente").chain(plan.kind("Gleis_Abschluss")) {
        for place in node.children().filter(|child| child.has_tag_name("Punkt_Objekt_TOP_Kante")) {
            if let Some((edge, at)) = text(place, "ID_TOP_Kante").zip(metres(place, "Abstand")) {
                found.entry(edge.to_lowercase()).or_default().push((at, plan.call(node)));
            }
        }
    }
    found
}

/// The names of what stands first beyond a leg.
fn beyond(plan: &Plan<'_>, node: &str, word: &str, standing: &Standing) -> BTreeSet<String> {
    let mut found = BTreeSet::new();
    let leaving = |node: &str, words: &[&str], not: Option<&(String, bool)>| -> Vec<(String, bool)> {
        let ends = plan.edges.iter().flat_map(|(id, edge)| [(id, edge, false), (id, edge, true)]);
        let here = ends.filter(|(_, edge, is_b)| {
            let end = usize::from(*is_b);
            edge.nodes[end] == node && (words.is_empty() || words.contains(&edge.joined[end].as_str()))
        });
        here.map(|(id, _, is_b)| (id.clone(), is_b)).filter(|end| Some(end) != not).collect()
    };
    // Edges that are left to follow, and from which end.
    let mut open = leaving(node, &[word], None);
    let mut seen = BTreeSet::new();
    while let Some((id, from_b)) = open.pop() {
        let Some(edge) = plan.edges.get(&id).filter(|_| seen.insert((id.clone(), from_b))) else { continue };
        let ahead = |at: f64| if from_b { edge.length - at } else { at };
        let first =
            standing.get(&id).into_iter().flatten().min_by(|one, other| ahead(one.0).total_cmp(&ahead(other.0)));
        if let Some((_, name)) = first {
            found.insert(name.clone());
            continue;
        }
        let (into, end) = (usize::from(!from_b), (id.clone(), !from_b));
        let node = &edge.nodes[into];
        open.extend(match (plan.joined_at(node), edge.joined[into].as_str()) {
            (2, _) => leaving(node, &[], Some(&end)),
            (3, "Spitze") => leaving(node, &["Links", "Rechts"], Some(&end)),
            (3, _) => leaving(node, &["Spitze"], Some(&end)),
            _ => Vec::new(),
        });
    }
    found
}
