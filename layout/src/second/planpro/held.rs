//! What the file asks a route to hold besides its path: its overlap and the flank of its points.

use std::collections::{BTreeMap, BTreeSet};

use roxmltree::Node;

use super::asked::unset;
use super::plan::{Plan, identity, is_on, metres, parts, text};
use super::run::{Run, named, position};
use super::{Meant, circuit};
use crate::form::Position;
use crate::model::{Model, Route};

/// The overlap of the file is held by the layout, for its time.
pub(super) fn overlap<'a>(plan: &Plan<'a>, model: &Model, route: &Route, meant: &Meant<'a>, run: &Run) -> Vec<String> {
    let Some(node) = meant.overlap else { return Vec::new() };
    let Some(course) = plan.at(node, "ID_Fstr_Fahrweg") else {
        return vec!["its overlap has no path in the file".to_owned()];
    };
    let parts = parts(course);
    let mut differing = Vec::new();
    if plan.at(course, "ID_Start") != plan.at(meant.course, "ID_Ziel") {
        differing.push("in the file its overlap begins at another signal than it ends at".to_owned());
    }
    let own: BTreeSet<&str> = route.circuits().chain([route.entry]).map(|number| circuit(model, number)).collect();
    let have: BTreeSet<&str> = route.overlap.iter().map(|number| circuit(model, *number)).collect();
    let all = plan.sections();
    let covers = |(_, section): &&(String, Vec<(String, f64, f64)>)| {
        section.iter().any(|(edge, low, high)| {
            parts.iter().any(|(on, from, to)| on == edge && high.min(*to) - low.max(*from) > 1.0)
        })
    };
    let mut wanted: BTreeSet<String> = all.iter().filter(covers).map(|(name, _)| name.clone()).collect();
    for proved in node.children().filter(|child| child.has_tag_name("ID_FMA_Anlage_Freimeldung")) {
        let section = plan.at(proved, "").and_then(|section| plan.at(section, "ID_Gleis_Abschnitt"));
        wanted.extend(section.map(|section| plan.call(section)));
    }
    let missing: Vec<&str> =
        wanted.iter().map(String::as_str).filter(|name| !own.contains(name) && !have.contains(name)).collect();
    if !missing.is_empty() {
        differing.push(format!("its overlap lacks {}, which the file has in it", missing.join(", ")));
    }
    // A time or a length that cannot be read may be any.
    let read = |path: &str| text(node, path).map_or(0.0, |_| metres(node, path).unwrap_or(f64::MAX));
    let length: f64 = parts.iter().map(|(_, from, to)| to - from).sum();
    let asked = read("Fstr_DWeg_Allg/Laenge_Soll");
    if asked > length + 1.0 {
        differing.push(format!("its overlap is {length:.0} m long in the file, which asks for {asked} m"));
    }
    let seconds = read("Fstr_DWeg_Spezifisch/Aufloesung_Verzoegerung");
    let stay = f64::from(model.values.ms(route.stay));
    if !have.is_empty() && stay + 0.5 < seconds * 1000.0 {
        differing.push(format!("its overlap is given up after {stay} ms, and in the file after {seconds} s"));
    }
    if plan.movable().any(|part| is_on(part, &parts)) {
        differing.push("in the file something stands on its overlap that must be moved off".to_owned());
    }
    // Where the overlap leaves a point by a leg, the point is held for that leg.
    let held: BTreeMap<&str, Position> = route
        .overlap_positions
        .iter()
        .filter_map(|(point, at)| Some((model.points.get(*point)?.name.as_str(), *at)))
        .collect();
    let on_path: BTreeMap<&str, Position> =
        route.positions().filter_map(|(point, at)| Some((model.points.get(point)?.name.as_str(), at))).collect();
    for lock in plan.kind("Fstr_DWeg_W_Kr").filter(|lock| plan.at(*lock, "ID_Fstr_DWeg") == Some(node)) {
        let name = plan.at(lock, "ID_W_Kr_Gsp_Element").map(|element| plan.call(element)).unwrap_or_default();
        let is_held = held.contains_key(name.as_str()) || on_path.contains_key(name.as_str());
        if text(lock, "Element_Verschluss") != Some("false") && !is_held {
            differing.push(format!("its overlap has {name} locked in the file, and the layout does not"));
        }
    }
    for (node, blades) in &plan.blades {
        let touched = |word: &str| {
            plan.edges.iter().any(|(id, edge)| {
                [(0, 0.0), (1, edge.length)].into_iter().any(|(end, at)| {
                    edge.nodes[end] == *node
                        && edge.joined[end] == word
                        && parts.iter().any(|(on, from, to)| on == id && (from - 0.5..=to + 0.5).contains(&at))
                })
            })
        };
        let legs = [touched("Links"), touched("Rechts")];
        if !touched("Spitze") || legs[0] == legs[1] || run.nodes(plan).iter().any(|(passed, ..)| passed == node) {
            continue;
        }
        differing.extend(unset(plan, *blades));
        let element = plan.at(*blades, "ID_W_Kr_Gsp_Element");
        let name = element.map(|element| plan.call(element)).unwrap_or_default();
        let wanted = position(Some(*blades), element, legs[0]);
        if held.get(name.as_str()) != Some(&wanted) {
            differing.push(format!("its overlap runs over {name} {wanted:?}, and the layout does not hold it so"));
        }
    }
    differing
}

/// The points that the file has protect the flank of a route are held so, and the sections that it has proved clear are.
pub(super) fn flank(plan: &Plan<'_>, model: &Model, route: &Route, run: &Run, (begin, end): (f64, f64)) -> Vec<String> {
    let mut asked: Vec<(String, Position)> = Vec::new();
    let mut clear: Vec<String> = Vec::new();
    let mut differing = Vec::new();
    for (blades, is_left, at) in run.legs(plan) {
        let element = blades.and_then(|blades| plan.at(blades, "ID_W_Kr_Gsp_Element")).and_then(identity);
        let Some(element) = element.filter(|_| (begin..end).contains(&at)) else { continue };
        // One that does not say over which leg is for both; what goes over the toe is for points that protect.
        let other = if is_left { "rechts" } else { "links" };
        let own = |node: &Node<'_, '_>| {
            let by = text(*node, "Fla_Schutz_Anforderer/ID_Anforderer_Element");
            by.is_some_and(|by| by.eq_ignore_ascii_case(&element))
                && ![Some(other), Some("Spitze")].contains(&text(*node, "Fla_Schutz_Anforderer/Fahrt_Ueber"))
        };
        let mut open: Vec<Node<'_, '_>> = plan.kind("Fla_Schutz").filter(own).collect();
        let mut seen = 0;
        while let Some(node) = open.pop() {
            seen += 1;
            if seen > 64 {
                return vec!["in the file its flank protection is passed on in a ring".to_owned()];
            }
            for next in ["Fla_Schutz_Weitergabe/ID_Fla_Weitergabe_L", "Fla_Schutz_Weitergabe/ID_Fla_Weitergabe_R"] {
                open.extend(plan.at(node, next));
            }
            if text(node, "Fla_Schutz_W_Gsp/ID_Fla_W_Gsp_Element").is_some() {
                let element = plan.at(node, "Fla_Schutz_W_Gsp/ID_Fla_W_Gsp_Element");
                let is_of = |blades: &&Node<'_, '_>| plan.at(**blades, "ID_W_Kr_Gsp_Element") == element;
                let blades = plan.blades.values().find(is_of).copied();
                let is_left = text(node, "Fla_Schutz_W_Gsp/Fla_W_Lage") == Some("links");
                let name = element.map(|element| plan.call(element)).unwrap_or_default();
                differing.extend(blades.and_then(|blades| unset(plan, blades)));
                asked.push((name, position(blades, element, is_left)));
            }
            let id = identity(node);
            for proved in plan.kind("Fla_Freimelde_Zuordnung") {
                let own = text(proved, "ID_Fla_Schutz").map(str::to_lowercase) == id;
                if own && text(proved, "Fla_Raum_Freimeldung") != Some("false") {
                    let section =
                        plan.at(proved, "ID_FMA_Anlage").and_then(|section| plan.at(section, "ID_Gleis_Abschnitt"));
                    clear.extend(section.map(|section| plan.call(section)));
                }
            }
        }
    }
    let held: BTreeMap<&str, Position> =
        route.positions().filter_map(|(point, at)| Some((model.points.get(point)?.name.as_str(), at))).collect();
    for (name, wanted) in asked {
        if held.get(name.as_str()) != Some(&wanted) {
            differing.push(format!(
                "its flank is protected by {name} {wanted:?} in the file, and the layout does not hold it so"
            ));
        }
    }
    let proved: BTreeSet<&str> = route
        .beside()
        .into_iter()
        .chain(route.circuits())
        .chain([route.entry])
        .map(|number| circuit(model, number))
        .collect();
    for name in clear.iter().filter(|name| !proved.contains(name.as_str())) {
        differing.push(format!("the file has {name} proved clear for its flank, and the layout does not"));
    }
    differing
}

/// The points of a route that a train fouls in another section by the file, and not in the layout; also those of other routes, where this one
/// runs over that section.
pub(super) fn fouled(plan: &Plan<'_>, model: &Model, route: &Route) -> Vec<String> {
    let runs: BTreeSet<&str> = route
        .circuits()
        .chain([route.entry])
        .chain(route.overlap.iter().copied())
        .map(|number| circuit(model, number))
        .collect();
    let mut differing = Vec::new();
    for (node, blades) in &plan.blades {
        let (name, _, element) = named(plan, node);
        let kind = element.and_then(|element| element.children().find(|child| child.has_tag_name("Weiche_Element")));
        let Some((number, point)) = model.points.iter().enumerate().find(|(_, point)| point.name == name) else {
            continue;
        };
        let legs = kind.into_iter().flat_map(|kind| kind.children());
        for leg in legs.filter(|child| child.tag_name().name().starts_with("GZ_Freimeldung")) {
            let by = plan.at(leg, "ID_Element").unwrap_or(*blades);
            // A section is called as its circuit; a point stands for the circuit that it lies in.
            let other = model.points.iter().find(|point| point.name == plan.call(by)).and_then(|point| point.circuit);
            let by = if by.has_tag_name("Gleis_Abschnitt") {
                plan.call(by)
            } else {
                other.map_or_else(|| plan.call(by), |number| circuit(model, number).to_owned())
            };
            let mut have = point.fouled_in.iter().chain(&point.circuit).map(|number| circuit(model, *number));
            let counts = runs.contains(by.as_str()) || route.positions().any(|(one, _)| one == number);
            if counts && !have.any(|name| name == by) {
                differing.push(format!("point {name} is fouled in {by} in the file, and not in the layout"));
            }
        }
    }
    differing
}
