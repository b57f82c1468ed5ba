//! What the file asks a route to hold: positions, times and its overlap.

use std::collections::{BTreeMap, BTreeSet};

use roxmltree::Node;

use super::file::{File, every_ref, milliseconds, refers};
use super::positions::{left_is_normal, positions};
use crate::form::Position;
use crate::model::{Model, Route};

/// Positions that the file asks for and the layout does not hold.
pub(super) fn held<'a>(file: &File<'a>, model: &Model, route: &Route, node: Node<'a, 'a>) -> Vec<String> {
    let relations = every_ref(node, "additionalRelation").filter_map(|id| file.by_id(id));
    let mut all = vec![positions(file, node, &["facingSwitchInPosition", "trailingSwitchInPosition"])];
    all.extend(relations.map(|relation| positions(file, relation, &["requiredSwitchPosition"])));
    let mine: BTreeMap<usize, Position> = route.positions().collect();
    let mut differing = Vec::new();
    for one in all {
        let given = match one {
            Ok(given) => given,
            Err(why) => {
                differing.push(why);
                continue;
            }
        };
        for (switch, relations) in given {
            let sides: BTreeSet<&str> =
                relations.iter().filter_map(|relation| file.branches.get(relation)).map(|branch| branch.side).collect();
            let Some(side) = sides.first().filter(|side| ["leftBranch", "rightBranch"].contains(side)) else {
                continue;
            };
            let is_normal = (*side == "leftBranch") == left_is_normal(file, switch);
            let wanted = if is_normal { Position::Normal } else { Position::Reverse };
            let point = model.points.iter().position(|point| file.means(&point.name, switch));
            if point.and_then(|point| mine.get(&point)) != Some(&wanted) {
                differing.push(format!(
                    "the file asks for {} {wanted:?}, and the layout does not hold it so",
                    file.call_of(switch)
                ));
            }
        }
    }
    differing
}

/// How long a cancelled route stays locked, by the names of railML 3.1 and 3.2.
const RESIDUAL: [&str; 2] = ["residualRouteCancellationDelay", "residualRouteReleaseDelay"];

pub(super) fn times<'a>(file: &File<'a>, model: &Model, route: &Route, node: Node<'a, 'a>) -> Vec<String> {
    let mut differing = Vec::new();
    let mut least = |have: f64, node: Node<'a, 'a>, attribute: &str, what: &str| {
        let Some(text) = node.attribute(attribute) else { return };
        match milliseconds(text) {
            Some(wanted) if have + 0.5 >= wanted => {}
            Some(wanted) => differing.push(format!("{what} is {have} ms, and the file has {attribute} {wanted} ms")),
            None => differing.push(format!("the {attribute} {text:?} cannot be read")),
        }
    };
    let release = f64::from(model.values.ms(route.release));
    let clear = f64::from(u32::from(model.values.clear) * model.values.cycle_ms);
    least(release, node, "approachReleaseDelay", "its release time");
    for attribute in RESIDUAL {
        least(release, node, attribute, "its release time");
    }
    let circuits: BTreeSet<&str> =
        route.circuits().filter_map(|circuit| Some(model.circuits.get(circuit)?.name.as_str())).collect();
    for section in file.every("tvdSection") {
        let Some(id) = section.attribute("id") else { continue };
        if circuits.iter().any(|name| file.means(name, id)) {
            for attribute in RESIDUAL {
                least(release, section, attribute, "its release time");
            }
            least(clear, section, "partialRouteReleaseDelay", "the time after which a circuit counts as clear");
        }
    }
    differing
}

/// The overlap that the file gives a route is held by the layout, with its positions and its time.
pub(super) fn overlap<'a>(file: &File<'a>, model: &Model, route: &Route, node: Node<'a, 'a>) -> Vec<String> {
    let id = node.attribute("id").unwrap_or_default();
    let exit = node.children().find(|child| child.tag_name().name() == "routeExit");
    let target = exit.and_then(|exit| refers(exit, "refersTo")).and_then(|id| file.by_id(id));
    let named: Vec<&str> = exit.into_iter().chain(target).flat_map(|at| every_ref(at, "hasOverlap")).collect();
    let given: Vec<Node<'a, 'a>> = file
        .every("overlap")
        .filter(|overlap| {
            let own = overlap.attribute("id").unwrap_or_default();
            named.contains(&own) || every_ref(*overlap, "activeForApproachRoute").any(|route| route == id)
        })
        .collect();
    let have: BTreeSet<&str> =
        route.overlap.iter().filter_map(|circuit| Some(model.circuits.get(*circuit)?.name.as_str())).collect();
    let fits = |overlap: &Node<'a, 'a>| {
        let sections: Vec<&str> = every_ref(*overlap, "hasTvdSection").collect();
        sections.iter().all(|id| have.iter().any(|name| file.means(name, id))) && !have.is_empty()
    };
    if given.is_empty() {
        return Vec::new();
    }
    let Some(one) = given.iter().find(|overlap| fits(overlap)) else {
        let ids: Vec<&str> = given.iter().filter_map(|overlap| overlap.attribute("id")).collect();
        return vec![format!("the file gives it the overlap {}, and the layout holds {have:?}", ids.join(" or "))];
    };
    let mut differing = Vec::new();
    let mine: BTreeMap<usize, Position> = route.overlap_positions.iter().map(|(point, at)| (*point, *at)).collect();
    let asks = positions(file, *one, &["requiresSwitchInPosition"]).unwrap_or_else(|why| {
        differing.push(format!("its overlap: {why}"));
        Vec::new()
    });
    for (switch, relations) in asks {
        let Some(branch) = relations.first().and_then(|relation| file.branches.get(relation)) else { continue };
        if !["leftBranch", "rightBranch"].contains(&branch.side) {
            continue;
        }
        let is_normal = (branch.side == "leftBranch") == left_is_normal(file, switch);
        let wanted = if is_normal { Position::Normal } else { Position::Reverse };
        let point = model.points.iter().position(|point| file.means(&point.name, switch));
        if point.and_then(|point| mine.get(&point)) != Some(&wanted) {
            differing.push(format!(
                "its overlap asks for {} {wanted:?}, and the layout does not hold it so",
                file.call_of(switch)
            ));
        }
    }
    let timer = one.descendants().find_map(|timer| timer.attribute("timerValue")).and_then(milliseconds);
    let stay = f64::from(model.values.ms(route.stay));
    if let Some(wanted) = timer.filter(|wanted| stay + 0.5 < *wanted) {
        differing.push(format!("its overlap is given up after {stay} ms, and in the file after {wanted} ms"));
    }
    differing
}
