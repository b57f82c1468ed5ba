//! A second reading of a PlanPro file: a train runs over the edges of its topology, in metres, from each route's signal to its exit.
//!
//! Nothing of the import is used. It makes circuits of the tracks and looks for a way through them; here the parts of an `Fstr_Fahrweg` are put
//! one behind the other as a train meets them, and the sections are those in which it is, metre by metre.

mod asked;
mod held;
mod legs;
mod plan;
mod run;

use std::collections::{BTreeMap, BTreeSet};

use roxmltree::{Document, Node};

use super::difference::Difference;
use crate::form::Position;
use crate::model::{Model, Route};
use crate::problem::Source;
use held::{flank, fouled, overlap};
use plan::{Plan, metres, parts, text};
use run::Run;

/// What a train route of the file is made of.
struct Meant<'a> {
    /// The Fstr_Zug_Rangier, or the path where the file has none.
    node: Node<'a, 'a>,
    course: Node<'a, 'a>,
    overlap: Option<Node<'a, 'a>>,
}

/// Everything in which `model` is not what the file says.
pub(super) fn differences(document: &Document<'_>, model: &Model, source: &Source) -> Vec<Difference> {
    let plan = Plan::of(document);
    let mut found = Vec::new();
    let routes = meant(&plan);
    let turned = legs::apart(&plan, model);
    for route in &model.routes {
        let mut differs = |node: Option<Node<'_, '_>>, what: String| {
            let place = node.and_then(|node| source.place(&(node.range().start..node.range().start + 1)));
            found.push(Difference { route: Some(route.name.clone()), what, place });
        };
        match routes.get(&route.name).map(Vec::as_slice) {
            Some([one]) => {
                for what in of_route(&plan, model, route, one) {
                    differs(Some(one.node), what);
                }
                for what in route.positions().filter_map(|(point, _)| turned.get(&point)) {
                    differs(Some(one.node), what.clone());
                }
            }
            Some(several) => differs(None, format!("the file has {} routes of this name", several.len())),
            None => differs(None, "the file has no route of this name".to_owned()),
        }
    }
    found.extend(exclusions(&plan, model, &routes));
    found
}

/// The train routes by the names that a layout gives them. Of several with one path the one with the preferred overlap is meant.
fn meant<'a>(plan: &Plan<'a>) -> BTreeMap<String, Vec<Meant<'a>>> {
    let mut found: BTreeMap<String, Vec<Meant<'a>>> = BTreeMap::new();
    let trains: Vec<Node<'a, 'a>> = plan.kind("Fstr_Zug_Rangier").collect();
    let nodes: Vec<Node<'a, 'a>> = if trains.is_empty() { plan.kind("Fstr_Fahrweg").collect() } else { trains };
    for node in nodes {
        let is_path = node.has_tag_name("Fstr_Fahrweg");
        if !is_path && text(node, "Fstr_Zug/Fstr_Zug_Art").is_none() {
            continue;
        }
        let Some(course) = (if is_path { Some(node) } else { plan.at(node, "ID_Fstr_Fahrweg") }) else { continue };
        let overlap = plan.at(node, "Fstr_Zug/Fstr_Zug_DWeg/ID_Fstr_DWeg");
        let end = |name| plan.at(course, name).map(|signal| plan.call(signal));
        let Some((from, to)) = end("ID_Start").zip(end("ID_Ziel")) else { continue };
        let detour = text(node, "Fstr_Zug_Rangier_Allg/Fstr_Reihenfolge").filter(|order| *order != "0");
        let name = detour.map_or_else(|| format!("{from}/{to}"), |order| format!("{from}/{to} U{order}"));
        let preferred = |node| text(node, "Fstr_Zug/Fstr_Zug_DWeg/DWeg_Vorzug") == Some("true");
        let all = found.entry(name).or_default();
        match all.iter_mut().find(|other| other.course == course) {
            Some(other) if preferred(node) && !preferred(other.node) => *other = Meant { node, course, overlap },
            Some(_) => {}
            None => all.push(Meant { node, course, overlap }),
        }
    }
    found
}

fn of_route<'a>(plan: &Plan<'a>, model: &Model, route: &Route, meant: &Meant<'a>) -> Vec<String> {
    let run = match Run::of(plan, meant.course) {
        Ok(run) => run,
        Err(why) => return vec![why],
    };
    let mut differing = Vec::new();
    let signal = plan.at(meant.course, "ID_Start").map(|signal| plan.call(signal)).unwrap_or_default();
    if signal != route.signal {
        differing.push(format!("its signal is {}, and that of the file {signal}", route.signal));
    }
    let between = if plan.kind("FMA_Anlage").next().is_some() {
        sections(plan, model, route, &run, &mut differing)
    } else {
        signals(plan, model, route, &run, &mut differing)
    };
    points(plan, model, route, &run, between, &mut differing);
    let own = f64::from(model.values.speeds_kmh.get(usize::from(route.speed.0)).copied().unwrap_or(u16::MAX));
    if let Some(limit) = limit(plan, model, meant, &run, between).filter(|limit| own > *limit) {
        differing.push(format!("its speed is {own} km/h, and the file allows {limit} km/h"));
    }
    differing.extend(asked::more(plan, meant, &run, between));
    differing.extend(overlap(plan, model, route, meant, &run));
    differing.extend(flank(plan, model, route, &run, between));
    differing.extend(fouled(plan, model, route));
    differing
}

/// What names a circuit of the layout.
fn circuit(model: &Model, number: usize) -> &str {
    model.circuits.get(number).map_or("", |circuit| circuit.name.as_str())
}

/// Compares the circuits of a route with the sections in which a train is; where it begins and ends, in metres from its signal.
fn sections(plan: &Plan<'_>, model: &Model, route: &Route, run: &Run, differing: &mut Vec<String>) -> (f64, f64) {
    let all = plan.sections();
    let within = run.inside(&all);
    let borders: BTreeSet<i64> = within.iter().flat_map(|(_, from, to)| [*from, *to]).map(run::millimetres).collect();
    let at_or_beyond =
        |metres: f64| borders.iter().map(|border| run::metres_of(*border)).find(|border| *border >= metres - 1.0);
    let begin = at_or_beyond(0.0).unwrap_or(0.0);
    let end = at_or_beyond(run.length).unwrap_or(run.length);
    let names = |low: f64, high: f64| {
        let mut found: Vec<(f64, &str)> = within
            .iter()
            .filter(|(_, from, to)| to.min(high) - from.max(low) > 1.0)
            .map(|(name, from, _)| (*from, name.as_str()))
            .collect();
        found.sort_by(|one, other| one.0.total_cmp(&other.0));
        found.dedup_by_key(|(_, name)| *name);
        found.into_iter().map(|(_, name)| name).collect::<Vec<&str>>()
    };
    let theirs = names(begin, end);
    let own: Vec<&str> = route.circuits().map(|number| circuit(model, number)).collect();
    if own != theirs {
        differing.push(format!("its path is {}, and that of the file {}", own.join(", "), theirs.join(", ")));
    }
    // A stop is not farther than the train runs.
    let mut longer = |number: usize, most: f64| {
        let length = model.circuits.get(number).map_or(0.0, |circuit| f64::from(circuit.length.0));
        if length > most + 1.0 {
            differing
                .push(format!("circuit {} is {length} m long, and in the file {most:.1} m", circuit(model, number)));
        }
    };
    for number in route.circuits() {
        let run: f64 =
            within.iter().filter(|(name, ..)| name == circuit(model, number)).map(|(_, from, to)| to - from).sum();
        longer(number, run);
    }
    for number in route.overlap.iter().copied().chain([route.entry]) {
        let all = all.iter().filter(|(name, _)| name == circuit(model, number)).flat_map(|(_, parts)| parts);
        longer(number, all.map(|(_, from, to)| to - from).sum());
    }
    // A train that waits at the signal stands in rear of the border.
    let rear = names(begin - 2.5, begin);
    if rear != [circuit(model, route.entry)] {
        let entry = circuit(model, route.entry);
        differing.push(format!("its entry is {entry}, and in rear of the file's signal is {}", rear.join(" and ")));
    }
    (begin, end)
}

/// Where no section is in the file: a route begins and ends at signals, and what meets between them does so at signals, too.
fn signals(plan: &Plan<'_>, model: &Model, route: &Route, run: &Run, differing: &mut Vec<String>) -> (f64, f64) {
    let joint = |number: usize| model.graph.joints.get(number).map_or("", |joint| joint.name.as_str());
    let passed = run.signals(plan);
    let stands = |name: &str, from: f64, to: f64| {
        passed.iter().any(|(signal, metres)| signal == name && (from - 0.5..=to + 0.5).contains(metres))
    };
    let is_end = |number: usize| model.graph.joints.get(number).is_some_and(|joint| joint.end.is_some());
    for (number, at, word) in [(route.start, 0.0, "begins"), (route.exit, run.length, "ends")] {
        if !is_end(number) && !stands(joint(number), at, at + run::OFFSET) {
            differing.push(format!(
                "it {word} at joint {}, and no signal of that name stands there in the file",
                joint(number)
            ));
        }
    }
    let own: Vec<usize> = [route.entry].into_iter().chain(route.circuits()).collect();
    for pair in own.windows(2).skip(1) {
        let between = model.graph.between(pair[0], pair[1]);
        if !between.iter().any(|number| stands(joint(*number), 0.0, run.length)) {
            let (one, other) = (circuit(model, pair[0]), circuit(model, pair[1]));
            differing.push(format!("{one} and {other} meet on its way where no signal stands in the file"));
        }
    }
    // A stop is not farther than the train runs, but for a border beyond its exit.
    let long = |number: usize| model.circuits.get(number).map_or(0.0, |circuit| f64::from(circuit.length.0));
    let own: f64 = route.circuits().map(long).sum();
    if own > run.length + run::OFFSET + 1.0 {
        differing.push(format!("its path is {own} m long, and in the file {:.0} m", run.length));
    }
    (0.0, run.length)
}

/// Compares the points that a route runs over with the forks that a train comes to.
fn points(
    plan: &Plan<'_>,
    model: &Model,
    route: &Route,
    run: &Run,
    (begin, end): (f64, f64),
    differing: &mut Vec<String>,
) {
    let theirs: BTreeMap<String, Position> = run
        .forks(plan)
        .into_iter()
        .filter(|(_, _, at)| (begin..end).contains(at))
        .map(|(name, position, _)| (name, position))
        .collect();
    let passed = route.path.iter().flat_map(|place| &place.passed);
    let name = |point: usize| model.points.get(point).map_or("", |point| point.name.as_str()).to_owned();
    let own: BTreeMap<String, Position> = passed.map(|passed| (name(passed.point), passed.position)).collect();
    if own != theirs {
        differing.push(format!("it runs over {own:?}, and in the file over {theirs:?}"));
    }
}

/// The lowest limit that the file has on a route, in km/h.
fn limit(plan: &Plan<'_>, model: &Model, meant: &Meant<'_>, run: &Run, (begin, end): (f64, f64)) -> Option<f64> {
    // One that cannot be read may be any.
    let read = |node: Node<'_, '_>, path: &str| {
        text(node, path).map(|_| metres(node, path).filter(|kmh| *kmh >= 1.0).unwrap_or(0.0))
    };
    let mut limits: Vec<f64> = Vec::new();
    limits.extend(read(meant.node, "Fstr_Zug_Rangier_Allg/Fstr_V"));
    limits.extend(read(meant.course, "Fstr_V_Hg"));
    limits.extend(meant.overlap.and_then(|overlap| read(overlap, "Fstr_DWeg_Spezifisch/DWeg_V")));
    for (kind, path) in [
        ("Geschwindigkeitsprofil", "Geschwindigkeitsprofil_Allg/Geschwindigkeit"),
        ("Gleis_Abschnitt", "Geschwindigkeit"),
    ] {
        for node in plan.kind(kind) {
            if run.touches(&parts(node), begin, end) {
                limits.extend(read(node, path));
            }
        }
    }
    for node in plan.kind("W_Kr_Gsp_Komponente").filter(|node| run.meets(*node, begin, end)) {
        for path in ["Kreuzung/Geschwindigkeit_L", "Kreuzung/Geschwindigkeit_R"] {
            limits.extend(read(node, path));
        }
    }
    let lowest = model.values.speeds_kmh.iter().copied().filter(|kmh| *kmh > 0).min().map(f64::from);
    for (blades, is_left, at) in run.legs(plan) {
        if !(begin..end).contains(&at) {
            continue;
        }
        let own = if is_left { "Zungenpaar/Geschwindigkeit_L" } else { "Zungenpaar/Geschwindigkeit_R" };
        match blades.and_then(|blades| read(blades, own)) {
            Some(limit) => limits.push(limit),
            // Which leg diverges is not said: this one may.
            None if blades.and_then(|blades| text(blades, "Zungenpaar/Stammgleis")).is_none() => limits.extend(lowest),
            None => {}
        }
    }
    limits.into_iter().min_by(f64::total_cmp)
}

/// Routes that the file excludes from each other and the layout does not.
fn exclusions<'a>(plan: &Plan<'a>, model: &Model, routes: &BTreeMap<String, Vec<Meant<'a>>>) -> Vec<Difference> {
    let number = |node: Node<'a, 'a>| {
        // What is said of one route over a path holds for the one that is meant.
        let course = plan.at(node, "ID_Fstr_Fahrweg");
        let same = |one: &Meant<'a>| one.node == node || Some(one.course) == course;
        let name = routes.iter().find(|(_, all)| all.iter().any(same)).map(|(name, _)| name);
        name.and_then(|name| model.routes.iter().position(|route| route.name == *name))
    };
    let mut found = Vec::new();
    for node in plan.kind("Fstr_Zug_Rangier") {
        for other in node.children().filter(|child| child.has_tag_name("ID_Fstr_Ausschluss_Besonders")) {
            let pair = number(node).zip(plan.at(other, "").and_then(number));
            let Some((one, other)) = pair.filter(|(one, other)| one != other) else { continue };
            if crate::conflict::reasons(model, one, other).is_empty() {
                let what = format!("the file excludes {}, and nothing in the layout does", model.routes[other].name);
                found.push(Difference { route: Some(model.routes[one].name.clone()), what, place: None });
            }
        }
    }
    found
}
