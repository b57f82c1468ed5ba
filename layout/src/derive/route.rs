//! One route: its way, times and speed.

use atc_kernel::time::Cycle;

use super::values::{self, Rounding, ticks};
use super::way::{Step, Through, through};
use crate::at::At;
use crate::form::{self, Station};
use crate::model::{Circuits, Model, Place, Positions, Route};
use crate::names::Names;
use crate::problem::Problem;
use crate::rule::Rule;

/// The route that `given` describes, without what depends on other routes. Its path is empty if no train can run it.
pub fn route(
    station: &Station,
    given: &form::Route,
    names: &Names,
    model: &Model,
    cycle: Cycle,
    problems: &mut Vec<Problem>,
) -> Route {
    let times = &station.times;
    let name = &given.name;
    let mut time = |what: &str, own: &Option<At<u32>>, default: &At<u32>, rounding| {
        ticks(&format!("{what} of route {name}"), own.as_ref().unwrap_or(default), rounding, cycle, problems)
    };
    let drive = time("drive_ms", &given.drive_ms, &times.drive_ms, Rounding::Restricts);
    let release = time("release_ms", &given.release_ms, &times.release_ms, Rounding::Permits);
    let stay = time("stay_ms", &given.stay_ms, &model.values.stay_ms, Rounding::Permits);
    let mut route = Route {
        name: name.value.clone(),
        signal: given.signal.clone().unwrap_or_else(|| name.value.clone()),
        no_reversal: given.no_reversal.as_ref().map(|reason| reason.value.clone()),
        short_overlap: given.short_overlap.as_ref().map(|reason| reason.value.clone()),
        drive,
        release,
        stay,
        span: name.span.clone(),
        ..Route::default()
    };
    let entry = names.circuit(&given.entry, problems);
    let path = steps(&given.path, names, problems);
    route.calling_on = !given.berth.is_empty();
    if let (Some(berth), false) = (given.berth.first(), given.overlap.is_empty()) {
        let rule = Rule::Plan(atc_kernel::interlocking::Rule::CallingOnEnds);
        let what = format!("route {name} has an overlap and a berth");
        problems.push(Problem::new(rule, &berth.span, what, "leave one of them out"));
    }
    let overlap = steps(if route.calling_on { &given.berth } else { &given.overlap }, names, problems);
    if given.path.is_empty() {
        let what = format!("route {name} has no path");
        problems.push(Problem::new(
            Rule::Range,
            &name.span,
            what,
            "name its circuits, the first one behind the signal",
        ));
    }
    let (Some(entry), Some(path), Some(overlap)) = (entry, path, overlap) else { return route };
    if path.is_empty() {
        return route;
    }
    route.entry = entry;
    match the_way(given, (entry, &path, &overlap), names, model) {
        Ok((way, ahead)) => {
            route.start = way.start;
            route.exit = way.exit();
            route.berth_end = ahead.exit();
            route.overlap = overlap.iter().map(|step| step.circuit).collect();
            route.overlap_positions = given_positions(&overlap);
            route.overlap_passed = ahead.ways.into_iter().flat_map(|way| way.passed).collect();
            route.overlap_positions.extend(route.overlap_passed.iter().map(|passed| (passed.point, passed.position)));
            route.path = places(path, way);
        }
        Err(problem) => problems.push(problem.of(name)),
    }
    route_speed(station, given, model, &mut route, problems);
    route
}

impl Problem {
    fn of(mut self, route: &str) -> Self {
        self.what = format!("route {route}: {}", self.what);
        self
    }
}

fn steps(given: &[At<form::Element>], names: &Names, problems: &mut Vec<Problem>) -> Option<Vec<Step>> {
    let mut steps = Vec::new();
    let mut sound = true;
    for element in given {
        let circuit = names.circuit_at(&element.circuit, &element.span, problems);
        let mut positions = Positions::new();
        for (point, position) in &element.points {
            match names.point_at(point, &position.span, problems) {
                Some(point) => drop(positions.insert(point, position.value)),
                None => sound = false,
            }
        }
        match circuit {
            Some(circuit) => steps.push(Step { circuit, positions, span: element.span.clone() }),
            None => sound = false,
        }
    }
    sound.then_some(steps)
}

fn given_positions(steps: &[Step]) -> Positions {
    steps.iter().flat_map(|step| step.positions.clone()).collect()
}

fn places(path: Vec<Step>, way: Through) -> Vec<Place> {
    let made = path.into_iter().zip(way.ways).map(|(step, way)| {
        let mut positions = step.positions;
        positions.extend(way.passed.iter().map(|passed| (passed.point, passed.position)));
        let (passed, tracks) = (way.passed, way.tracks);
        Place { circuit: step.circuit, passed, tracks, positions, beside: Circuits::new(), span: step.span }
    });
    made.collect()
}

/// The only way of a path, and that of its overlap.
fn the_way(
    given: &form::Route,
    (entry, path, overlap): (usize, &[Step], &[Step]),
    names: &Names,
    model: &Model,
) -> Result<(Through, Through), Problem> {
    let graph = &model.graph;
    let name_of = |circuit: usize| model.circuits[circuit].name.clone();
    let starts = graph.between(entry, path[0].circuit);
    if starts.is_empty() {
        let what =
            format!("the path starts at {}, which does not adjoin the entry {}", name_of(path[0].circuit), given.entry);
        let neighbours: Vec<String> =
            graph.borders(entry).into_iter().filter_map(|joint| graph.across(joint, entry)).map(name_of).collect();
        let right = format!("{} adjoins {}", given.entry, neighbours.join(", "));
        return Err(Problem::new(Rule::NoWay, &path[0].span, what, right));
    }
    let mut ways = through(graph, &name_of, &starts, path)?;
    let last = path[path.len() - 1].circuit;
    let ends_at = |ways: &mut Vec<Through>, wanted: &dyn Fn(usize) -> bool| {
        let ends = |way: &Through| graph.across(way.exit(), last).is_some_and(wanted);
        if ways.iter().any(ends) {
            ways.retain(ends);
        }
    };
    if let Some(first) = overlap.first() {
        ends_at(&mut ways, &|next| next == first.circuit);
    }
    if let Some(beyond) = &given.beyond {
        ends_at(&mut ways, &|next| beyond.iter().any(|name| name.value == model.circuits[next].name));
    }
    // A name that does not exist is told elsewhere.
    let to = given.to.as_ref().and_then(|to| names.segment(to, &mut Vec::new()));
    if let Some(segment) = to {
        ends_at(&mut ways, &|next| model.segments[segment].circuits.first() == Some(&next));
    }
    if ways.len() > 1 {
        // A path that can end at plain line does, rather than at another track of the station.
        ends_at(&mut ways, &|next| model.segments.iter().any(|segment| segment.circuits.first() == Some(&next)));
    }
    let way = ways[0].clone();
    if let Some(other) = ways.get(1) {
        let (one, two) = (&graph.joints[way.exit()].name, &graph.joints[other.exit()].name);
        let span = &path[path.len() - 1].span;
        let what = format!("there are {} ways through the path, for example to the joints {one} and {two}", ways.len());
        let right = "say where it goes with `to` or `beyond`, or give the positions of the points: { circuit = \"…\", points = { … = \"normal\" } }";
        return Err(Problem::new(Rule::ManyWays, span, what, right));
    }
    if overlap.is_empty() {
        return Ok((way.clone(), Through { start: way.exit(), ways: Vec::new() }));
    }
    if graph.across(way.exit(), last) != Some(overlap[0].circuit) {
        let what = format!("the overlap starts at {}, which is not where the path ends", name_of(overlap[0].circuit));
        let right = match graph.across(way.exit(), last) {
            Some(next) => format!("{} follows the end of the path", name_of(next)),
            None => "the tracks end there: leave out the overlap".to_owned(),
        };
        return Err(Problem::new(Rule::OverlapNotAhead, &overlap[0].span, what, right));
    }
    // Of several ways through the overlap, the one over the fewest reverse points is taken.
    let ahead = through(graph, &name_of, &[way.exit()], overlap)?.swap_remove(0);
    Ok((way, ahead))
}

fn route_speed(station: &Station, given: &form::Route, model: &Model, route: &mut Route, problems: &mut Vec<Problem>) {
    let line = values::line_kmh(station, &model.values);
    let straight = station.speed.route_kmh.as_ref().unwrap_or(&line);
    // What nobody has said costs speed.
    let slowest = At::derived(model.values.speeds_kmh[1]);
    let on_sight = station.speed.calling_on_kmh.as_ref().unwrap_or(&slowest);
    let over_reverse =
        route.path.iter().flat_map(|place| &place.passed).any(|passed| passed.position == form::Position::Reverse);
    let default = if over_reverse { station.speed.reverse_kmh.as_ref().unwrap_or(&slowest) } else { straight };
    let default = if route.calling_on && on_sight.value < default.value { on_sight } else { default };
    route.speed = values::code(&model.values, given.speed_kmh.as_ref().unwrap_or(default), problems);
    if let Some(faster) = given.speed_kmh.as_ref().filter(|own| route.calling_on && own.value > on_sight.value) {
        let what = format!("calling-on route {}: {faster} km/h, and trains run on sight at {on_sight}", given.name);
        let right = format!("give at most {on_sight} km/h, or raise calling_on_kmh in [speed]");
        problems.push(Problem::new(Rule::Range, &faster.span, what, right));
    }
    // A speed of the route's own is one of its path.
    let beyond_reverse = route.overlap_passed.iter().any(|passed| passed.position == form::Position::Reverse);
    let beyond = if beyond_reverse { station.speed.reverse_kmh.as_ref().unwrap_or(&slowest) } else { straight };
    route.overlap_speed = values::code(&model.values, beyond, problems);
    let approach = given.approach_kmh.as_ref().unwrap_or(&line);
    for (field, speed) in [("approach_kmh", &given.approach_kmh), ("speed_kmh", &given.speed_kmh)] {
        let what = format!("route {}: {field}", given.name);
        values::within_codes(&what, speed.as_ref(), &model.values, problems);
    }
    route.approach_kmh = approach.value;
}
