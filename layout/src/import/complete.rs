//! What a file of another form leaves open and a layout must say: filled in and reported, each to be confirmed.

use std::collections::{BTreeMap, BTreeSet};

use super::report::Report;
use crate::at::At;
use crate::derive;
use crate::form::{EndKind, Segment, Station};
use crate::graph::{Graph, Kind, Track};
use crate::model::{Guard, Model};
use crate::names::Names;
use crate::problem::Problem;
use crate::rule::Rule;

/// Circuits that are longer, in metres, are remarked.
const LONG: u16 = 10_000;

/// Fills in segments of plain line, missing flank protection and missing overlaps, and makes stay times longer that are too short.
pub fn complete(station: &mut Station, form: &str, report: &mut Report) {
    for circuit in station.circuits.iter().filter(|circuit| circuit.length_m.value > LONG) {
        let what = format!("circuit {}: it is {} m long, if the file has metres", circuit.name, circuit.length_m);
        report.defaulted.push(what);
    }
    derive::heading::align(station);
    segments(station, report);
    let model = derive::model(station, &mut Vec::new());
    unprotected(station, &model, form, report);
    for (number, route) in model.routes.iter().enumerate() {
        let at_line = route.to.is_some() || model.graph.joints.get(route.exit).is_some_and(|joint| joint.end.is_some());
        let length: u32 = route.overlap.iter().map(|circuit| u32::from(model.circuits[*circuit].length.0)).sum();
        if route.is_sound() && !at_line && length < u32::from(station.overlaps.least_m.value) {
            let given = &mut station.routes[number];
            given.short_overlap =
                Some(At::derived(format!("assumed on import: the {form} file gives no overlap that is long enough")));
            report.defaulted.push(format!("route {}: an overlap of {length} m is taken to be enough", given.name));
        }
        if route.is_sound() && !derive::signals_behind_points(&model, route).is_empty() {
            let given = &mut station.routes[number];
            given.no_reversal = Some(At::derived(format!(
                "assumed on import: the {form} file does not show that each train has a signal ahead there before the next point"
            )));
            report.defaulted.push(format!(
                "route {}: no train is taken to change ends where it ends: a point may lie before the signal that it comes to first",
                given.name
            ));
        }
        // A timer of the file that runs out before a train can stand there.
        let (values, given) = (&model.values, &mut station.routes[number]);
        if let Some(stay) = given.stay_ms.as_mut().filter(|stay| stay.value < values.stay_ms.value) {
            report.defaulted.push(format!(
                "route {}: the overlap is given up after {} ms and not after the {stay} ms of the file: before that a train need not stand",
                given.name, values.stay_ms
            ));
            *stay = At::derived(values.stay_ms.value);
        }
    }
}

/// Gives a reason wherever no flank point protects a path, and reports it.
fn unprotected(station: &mut Station, model: &Model, form: &str, report: &mut Report) {
    let mut open = BTreeMap::new();
    let routes = model.routes.iter().flat_map(|route| route.flanks.iter().map(move |flank| (Some(route), flank)));
    let segments = model.segments.iter().flat_map(|segment| segment.flanks.iter().map(|flank| (None, flank)));
    for (route, flank) in routes.chain(segments) {
        let kept = |guard: &Guard| match guard {
            Guard::Point(point, position) => {
                route.is_some_and(|route| route.path.iter().any(|place| place.positions.get(point) == Some(position)))
            }
            Guard::Signal(_) | Guard::Line | Guard::Standing(_) => false,
            Guard::Own | Guard::Buffer | Guard::Declared(_) => true,
        };
        if !flank.guards.iter().all(kept) {
            open.insert((flank.track, flank.end), flank);
        }
    }
    for ((track, end), flank) in open {
        let at = &model.graph.tracks[track];
        let field = match (at.kind, end) {
            (Kind::Point(point), 0) => Some(&mut station.points[point].toe_unprotected),
            (Kind::Point(point), 1) => Some(&mut station.points[point].normal_unprotected),
            (Kind::Point(point), _) => Some(&mut station.points[point].reverse_unprotected),
            (Kind::Plain, _) => {
                let plain = |other: &&Track| other.circuit == at.circuit && other.kind == Kind::Plain;
                let place = model.graph.tracks[..track].iter().filter(plain).count();
                station.circuits[at.circuit]
                    .unprotected_mut(place)
                    .map(|[left, right]| if end == 0 { left } else { right })
            }
        };
        let Some(field) = field else { continue };
        *field = Some(At::derived(format!(
            "assumed on import: signals and ATC keep trains off, as the {form} file names no flank point"
        )));
        let word = flank.word(model);
        report.defaulted.push(match at.kind {
            Kind::Point(point) => format!(
                "point {}: no point protects its {word}{}; signals and ATC are taken to do",
                model.points[point].name,
                if end == 0 { "" } else { " leg" }
            ),
            Kind::Plain => format!(
                "circuit {}: no point protects the {word} end of {}; signals and ATC are taken to do",
                model.circuits[at.circuit].name,
                flank.of(model)
            ),
        });
    }
}

/// The steepest gradient of a file, in thousandths, holds for all circuits, either way.
///
/// # Errors
/// It is steeper than any railway.
pub fn steepest(
    gradients: impl Iterator<Item = f64>,
    station: &mut Station,
    report: &mut Report,
) -> Result<(), Problem> {
    let Some(steepest) = gradients.map(|gradient| gradient.abs().ceil()).max_by(f64::total_cmp) else { return Ok(()) };
    if !(0.0..=127.0).contains(&steepest) {
        let what = format!("the file has a gradient of {steepest} ‰");
        return Err(Problem::new(Rule::Range, &(0..0), what, "up to 127 ‰ are possible"));
    }
    #[expect(clippy::cast_possible_truncation, reason = "it is in the range of the type")]
    let steepest = steepest as i8;
    report.taken.push(format!("{steepest} ‰ everywhere: the steepest gradient of the file"));
    for circuit in &mut station.circuits {
        circuit.gradient = Some(At::derived(steepest));
    }
    Ok(())
}

/// Makes a segment of the circuits between an open end of the line and the first circuit that a route holds.
fn segments(station: &mut Station, report: &mut Report) {
    let mut ignored = Vec::new();
    let names = Names::of(station, &mut ignored);
    let graph = Graph::of(station, &names, &mut ignored);
    let held = station.routes.iter().flat_map(|route| route.path.iter().chain(&route.overlap));
    let mut used: BTreeSet<usize> =
        held.filter_map(|element| names.circuit_at(&element.circuit, &element.span, &mut ignored)).collect();
    for point in &station.points {
        used.extend(names.circuit(&point.circuit, &mut ignored));
    }
    for (joint, _) in graph.joints.iter().enumerate().filter(|(_, joint)| joint.end == Some(EndKind::Line)) {
        let mut circuits = Vec::new();
        let mut at = (joint, graph.circuits_at(joint).next());
        while let (from, Some(circuit)) = at {
            if used.contains(&circuit) {
                break;
            }
            used.insert(circuit);
            circuits.push(circuit);
            let ways = graph.ways(circuit, from);
            let [way] = ways.as_slice() else { break };
            at = (way.exit, graph.across(way.exit, circuit));
        }
        // However many there are: a line that is left out is one on which nobody asks whose trains are under way.
        if circuits.is_empty() {
            continue;
        }
        let listed: Vec<At<String>> =
            circuits.iter().rev().map(|circuit| At::derived(station.circuits[*circuit].name.value.clone())).collect();
        let name = format!("line at {}", listed[0]);
        report.defaulted.push(format!("segment {name}: the circuits up to the open end {}", graph.joints[joint].name));
        station.segments.push(Segment { name: At::derived(name), circuits: listed, ..Segment::default() });
    }
}
