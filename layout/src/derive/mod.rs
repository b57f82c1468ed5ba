//! From names to numbers, and everything that the file leaves out.

mod approach;
mod beside;
mod ends;
mod flank;
pub mod heading;
pub mod positions;
mod reversal;
mod route;
pub mod values;
pub(crate) mod way;

pub use approach::{Back, Shortfall, back};
pub use reversal::signals_behind_points;

use crate::at::At;
use crate::form::Station;
use crate::graph::Graph;
use crate::model::{Circuit, Circuits, Model, Note, Point, Segment, Values};
use crate::names::Names;
use crate::problem::Problem;
use crate::rule::Rule;

use atc_kernel::distance::Metres;
use atc_kernel::interlocking::Heading;
use atc_kernel::time::{Cycle, Ticks};

use values::Rounding;

/// The model of `station` as far as it can be made; what cannot is a problem.
pub fn model(station: &Station, problems: &mut Vec<Problem>) -> Model {
    let names = Names::of(station, problems);
    let graph = Graph::of(station, &names, problems);
    let (values, cycle) = values::values(station, problems);
    let turned = heading::turned(&graph, station, problems);
    let mut model = Model { graph, values, ..Model::default() };
    model.circuits = circuits(station, problems);
    model.points = points(station, &names, &mut model.notes, problems);
    model.segments = segments(station, &names, &model.values, problems);
    for fouling in &station.fouling {
        let [one, other] = &fouling.between;
        if let (Some(one), Some(other)) = (names.circuit(one, problems), names.circuit(other, problems)) {
            model.fouling.push((one, other));
        }
    }
    for platform in &station.platforms {
        names.circuits(&platform.circuits, problems);
    }
    for given in &station.routes {
        let mut route = route::route(station, given, &names, &model, cycle, problems);
        if let Some(first) = route.path.first() {
            route.heading = heading::into(&model.graph, &turned, first.circuit, route.start);
        }
        model.routes.push(route);
    }
    stand(station, &mut model, cycle, problems);
    if station.times.start_ms.is_none() {
        model.values.start = model.longest_authority();
        model.values.start_ms = At::derived(model.values.ms(model.values.start));
    }
    ends::ends(station, &names, &mut model, problems);
    heading::segments_and_starts(&mut model, &turned);
    positions::positions(&mut model);
    beside::beside(station, &names, &mut model, problems);
    approaches(station, &names, &mut model, problems);
    model
}

/// The times to a stand, and before an overlap is given up, where the file does not have them: in whole seconds.
fn stand(station: &Station, model: &mut Model, cycle: Cycle, problems: &mut Vec<Problem>) {
    let times = &station.times;
    if times.standstill_ms.is_none() {
        model.values.standstill_ms =
            At::derived(model.longest_standstill_ms().max(values::STANDSTILL_MS).div_ceil(1000) * 1000);
        let given = &model.values.standstill_ms;
        model.values.standstill = values::ticks("standstill_ms", given, Rounding::Permits, cycle, problems);
    }
    if times.stay_ms.is_none() {
        // Longer than both together, by a cycle: the kernel asks for that.
        let least = Ticks(model.values.standstill.0.saturating_add(u16::from(model.values.loss)).saturating_add(1));
        let stay = At::derived(model.values.ms(least).max(values::STAY_MS).div_ceil(1000) * 1000);
        let ticks = values::ticks("stay_ms", &stay, Rounding::Permits, cycle, problems);
        model.values.stay_ms = stay;
        for (given, route) in station.routes.iter().zip(&mut model.routes) {
            route.stay = if given.stay_ms.is_some() { route.stay } else { ticks };
        }
    }
}

fn circuits(station: &Station, problems: &mut Vec<Problem>) -> Vec<Circuit> {
    let made = station.circuits.iter().map(|given| {
        if given.length_m.value == 0 || given.length_m.value == u16::MAX {
            let what = format!("circuit {} is {} m long", given.name, given.length_m);
            problems.push(Problem::new(Rule::Range, &given.length_m.span, what, "1 to 65 534 m are possible"));
        }
        Circuit { name: given.name.value.clone(), length: Metres(given.length_m.value), span: given.name.span.clone() }
    });
    made.collect()
}

fn points(station: &Station, names: &Names, notes: &mut Vec<Note>, problems: &mut Vec<Problem>) -> Vec<Point> {
    let mut points = Vec::new();
    for given in &station.points {
        // The graph has told of a circuit that is not there.
        let circuit = names.circuit(&given.circuit, &mut Vec::new());
        let fouled_in = names.circuits(&given.fouled_in, problems);
        let detectors = if let Some(detectors) = &given.detectors {
            names.circuits(detectors, problems)
        } else {
            let detectors: Circuits = fouled_in.iter().copied().chain(circuit).collect();
            let listed: Vec<&str> = detectors.iter().map(|circuit| station.circuits[*circuit].name.as_str()).collect();
            notes.push(Note {
                about: format!("point {}", given.name),
                text: format!("detectors: the circuit it lies in and those it is fouled in: {}", listed.join(", ")),
            });
            detectors
        };
        let throw = given.throw_ms.as_ref().unwrap_or(&station.times.throw_ms);
        points.push(Point {
            name: given.name.value.clone(),
            circuit,
            detectors,
            fouled_in,
            throw_ms: throw.value,
            span: given.name.span.clone(),
        });
    }
    points
}

fn segments(station: &Station, names: &Names, values: &Values, problems: &mut Vec<Problem>) -> Vec<Segment> {
    let mut segments = Vec::new();
    let line = values::line_kmh(station, values);
    let speeds = &station.speed;
    for (what, speed) in [
        ("line_kmh", &speeds.line_kmh),
        ("route_kmh", &speeds.route_kmh),
        ("reverse_kmh", &speeds.reverse_kmh),
        ("calling_on_kmh", &speeds.calling_on_kmh),
    ] {
        values::within_codes(what, speed.as_ref(), values, problems);
    }
    for given in &station.segments {
        if given.circuits.is_empty() {
            let what = format!("segment {} has no circuit", given.name);
            problems.push(Problem::new(
                Rule::Range,
                &given.name.span,
                what,
                "name at least the one next to the station",
            ));
        }
        if let Some(faster) = given.speed_kmh.as_ref().filter(|speed| speed.value > line.value) {
            let what = format!("segment {}: {faster} km/h, and trains come up to signals at {line} km/h", given.name);
            let right = format!("give at most {line} km/h, or raise line_kmh in [speed]");
            problems.push(Problem::new(Rule::Range, &faster.span, what, right));
        }
        let own = given.circuits.len().saturating_sub(given.shared.len());
        let outermost = given.circuits.iter().skip(own).map(|name| &name.value);
        let is_outermost = given.shared.iter().map(|name| &name.value).eq(outermost);
        if let Some(first) = given.shared.first().filter(|_| !is_outermost) {
            let what = format!("segment {}: the shared circuits are not its outermost ones, in its order", given.name);
            let right = "name the last of its circuits, as far as the neighbour's device sees them too";
            problems.push(Problem::new(Rule::SharedWithin, &first.span, what, right));
        }
        let twice = |line: &str| segments.iter().any(|other: &Segment| other.line.as_deref() == Some(line));
        if let Some(line) = given.line.as_ref().filter(|line| twice(&line.value)) {
            let what = format!("two segments are of the line {line}");
            problems.push(Problem::new(
                Rule::NameTwice,
                &line.span,
                what,
                "give each line to a neighbour its own name",
            ));
        }
        segments.push(Segment {
            flanks: Vec::new(),
            name: given.name.value.clone(),
            circuits: given.circuits.iter().filter_map(|name| names.circuit(name, problems)).collect(),
            line: given.line.as_ref().map(|name| name.value.clone()),
            shared: given.shared.len(),
            outward: Heading::Right,
            throat: given.throat.as_ref().and_then(|name| names.circuit(name, problems)),
            speed: values::code(values, given.speed_kmh.as_ref().unwrap_or(&line), problems),
            span: given.name.span.clone(),
        });
    }
    segments
}

fn approaches(station: &Station, names: &Names, model: &mut Model, problems: &mut Vec<Problem>) {
    for number in 0..model.routes.len() {
        let route = &model.routes[number];
        if !route.is_sound() {
            continue;
        }
        let given = &station.routes[number];
        let approach = if let Some(given) = &given.approach {
            names.circuits(given, problems)
        } else {
            let found = back(model, route, route.approach_m, None);
            let listed: Vec<&str> =
                found.circuits.iter().map(|circuit| model.circuits[*circuit].name.as_str()).collect();
            let text = format!("approach: {} m back from the signal: {}", route.approach_m, listed.join(", "));
            model.notes.push(Note { about: format!("route {}", given.name), text });
            found.circuits
        };
        model.routes[number].approach = approach;
    }
}
