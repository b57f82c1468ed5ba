//! OSRD infrastructures: track sections, switches, detectors and routes in JSON.

use std::collections::{BTreeMap, BTreeSet};

use serde::Deserialize;

use super::complete::{complete, steepest};
use super::network::{Cut, Divided, Edge, EdgeEnd, LONGEST, NEAR, Network, Side, Switch};
use super::report::{Imported, Report};
use super::search::{Sought, search};
use super::way::path;
use crate::at::At;
use crate::description::Description;
use crate::form::{Position, Route, Station};
use crate::graph::{Graph, Kind};
use crate::names::Names;
use crate::problem::{Errors, Problem, Source};
use crate::rule::Rule;

#[derive(Deserialize)]
struct Infra {
    track_sections: Vec<TrackSection>,
    #[serde(default)]
    switches: Vec<Node>,
    #[serde(default)]
    detectors: Vec<Spot>,
    #[serde(default)]
    buffer_stops: Vec<Spot>,
    #[serde(default)]
    routes: Vec<Run>,
    #[serde(default)]
    speed_sections: Vec<SpeedSection>,
}

/// Limits in metres a second, for all trains and for some.
#[derive(Deserialize)]
struct SpeedSection {
    #[serde(default)]
    speed_limit: Option<f64>,
    #[serde(default)]
    speed_limit_by_tag: BTreeMap<String, f64>,
}

#[derive(Deserialize)]
struct Slope {
    gradient: f64,
}

#[derive(Deserialize)]
struct TrackSection {
    id: String,
    length: f64,
    #[serde(default)]
    slopes: Vec<Slope>,
}

#[derive(Deserialize)]
struct Spot {
    id: String,
    track: String,
    position: f64,
}

#[derive(Deserialize)]
struct Node {
    id: String,
    switch_type: String,
    ports: BTreeMap<String, PortEnd>,
    #[serde(default)]
    group_change_delay: f64,
}

#[derive(Deserialize)]
struct PortEnd {
    endpoint: Endpoint,
    track: String,
}

#[derive(Clone, Copy, Deserialize)]
#[serde(rename_all = "UPPERCASE")]
enum Endpoint {
    Begin,
    End,
}

#[derive(Deserialize)]
struct Run {
    id: String,
    entry_point: Waypoint,
    entry_point_direction: Direction,
    exit_point: Waypoint,
    #[serde(default)]
    release_detectors: Vec<String>,
    #[serde(default)]
    switches_directions: BTreeMap<String, String>,
}

#[derive(Deserialize)]
struct Waypoint {
    id: String,
}

#[derive(Clone, Copy, Deserialize, PartialEq, Eq)]
#[serde(rename_all = "SCREAMING_SNAKE_CASE")]
enum Direction {
    StartToStop,
    StopToStart,
}

/// Reads an infrastructure.
pub fn import(source: &Source) -> Result<Imported, Errors> {
    let infra: Infra = serde_json::from_str(&source.text).map_err(|error| {
        let start: usize = source.text.split_inclusive('\n').take(error.line().saturating_sub(1)).map(str::len).sum();
        let at = (start + error.column()).saturating_sub(1).min(source.text.len().saturating_sub(1));
        let what = format!("{error}");
        Errors::one(source, Problem::new(Rule::Form, &(at..at + 1), what, "an OSRD infrastructure in JSON is expected"))
    })?;
    let mut report = Report::default();
    let mut problems = Vec::new();
    let network = network(&infra, &mut report, &mut problems);
    if network.edges.is_empty() {
        problems.push(Problem::new(Rule::Form, &(0..0), "the infrastructure has no track sections", ""));
    }
    if !problems.is_empty() {
        return Err(Errors::new(source, problems));
    }
    let divided = network.divide();
    let mut station = Station { name: name_of(source), ..Station::default() };
    divided.write(&network, &divided.names(), &mut station);
    report.taken.push(format!(
        "{} track sections and {} detectors as {} circuits",
        infra.track_sections.len(),
        infra.detectors.len(),
        station.circuits.len()
    ));
    report.taken.push(format!("{} switches as {} points", infra.switches.len(), station.points.len()));
    routes(&infra, &network, &divided, &mut station, &mut report);
    let slowest = slowest(&infra, &mut station, &mut report);
    let slopes = infra.track_sections.iter().flat_map(|section| &section.slopes).map(|slope| slope.gradient);
    steepest(slopes, &mut station, &mut report).map_err(|problem| Errors::new(source, vec![problem]))?;
    for name in ["times", "braking", "speed", "longest_train_m"].iter().filter(|name| !slowest || **name != "speed") {
        report.defaulted.push(format!("[{name}]: the defaults of the layout form; the file says nothing of them"));
    }
    complete(&mut station, "OSRD", &mut report);
    // The text is no layout file, so places in it would lead astray; names do.
    let description = Description { station, source: Source { name: source.name.clone(), text: String::new() } };
    Ok(Imported { description, report })
}

/// The lowest limit of the file holds for all tracks. Whether it has one that says anything.
fn slowest(infra: &Infra, station: &mut Station, report: &mut Report) -> bool {
    let given =
        infra.speed_sections.iter().flat_map(|one| one.speed_limit.iter().chain(one.speed_limit_by_tag.values()));
    // Whole km/h, rounded down; what is lost in the digits of metres a second is far less than a thousandth.
    let kmh = given.map(|metres| (metres * 3.6 + 0.001).floor()).min_by(f64::total_cmp);
    let highest = station.braking.speeds_kmh.iter().max().copied().unwrap_or(0);
    let Some(kmh) = kmh.filter(|kmh| *kmh < f64::from(highest)) else { return kmh.is_some() };
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "clamped to the range of the type")]
    let kmh = kmh.clamp(0.0, f64::from(highest)) as u16;
    report.taken.push(format!("{kmh} km/h everywhere: the lowest limit of the file"));
    report.defaulted.push(
        "reverse_kmh of [speed]: the lowest speed; the file does not say how fast points are run over".to_owned(),
    );
    station.speed.line_kmh = Some(At::derived(kmh));
    true
}

fn name_of(source: &Source) -> String {
    let file = source.name.rsplit('/').next().unwrap_or_default();
    file.split('.').next().filter(|name| !name.trim().is_empty()).unwrap_or("OSRD").to_owned()
}

fn network(infra: &Infra, report: &mut Report, problems: &mut Vec<Problem>) -> Network {
    let mut network = Network::default();
    let mut numbers = BTreeMap::new();
    for section in &infra.track_sections {
        numbers.insert(section.id.as_str(), network.edges.len());
        if !(0.0..=LONGEST).contains(&section.length) {
            let what = format!("track section {} is {} m long", section.id, section.length);
            problems.push(Problem::new(Rule::Range, &(0..0), what, format!("give metres, 0 to {LONGEST}")));
        }
        network.edges.push(Edge { name: section.id.clone(), begin: 0.0, length: section.length });
    }
    let mut edge = |track: &str, whose: &str| {
        let found = numbers.get(track).copied();
        if found.is_none() {
            let what = format!("{whose} lies on track section {track}, which does not exist");
            problems.push(Problem::new(Rule::NoSuchName, &(0..0), what, "name a track section of the file"));
        }
        found
    };
    let mut stops = Vec::new();
    for buffer in &infra.buffer_stops {
        stops.extend(edge(&buffer.track, &format!("buffer stop {}", buffer.id)).map(|number| (buffer, number)));
    }
    for detector in &infra.detectors {
        let Some(number) = edge(&detector.track, &format!("detector {}", detector.id)) else { continue };
        let at = detector.position.clamp(0.0, network.edges[number].length);
        if (at - detector.position).abs() > NEAR {
            report.defaulted.push(format!(
                "detector {}: at the end of its track section, and not at {} m of {} m",
                detector.id, detector.position, network.edges[number].length
            ));
        }
        network.cuts.push(Cut { name: detector.id.clone(), edge: number, at });
    }
    for node in &infra.switches {
        let mut port = |name: &str| -> Option<EdgeEnd> {
            let Some(end) = node.ports.get(name) else {
                report.lacking.push(format!("switch {}: it has no port {name}", node.id));
                return None;
            };
            let side = match end.endpoint {
                Endpoint::Begin => Side::Begin,
                Endpoint::End => Side::End,
            };
            edge(&end.track, &format!("switch {}", node.id)).map(|number| (number, side))
        };
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "clamped to the range of the type")]
        let throw_ms =
            (node.group_change_delay > 0.0).then(|| (node.group_change_delay * 1000.0).ceil().clamp(1.0, 1e9) as u32);
        let switch = |name: &str, ports| Switch { name: At::derived(name.to_owned()), ports, throw_ms };
        match node.switch_type.as_str() {
            "link" => network.links.extend(port("A").zip(port("B"))),
            "point_switch" => {
                if let (Some(toe), Some(normal), Some(reverse)) = (port("A"), port("B1"), port("B2")) {
                    network.switches.push(switch(&node.id, [toe, normal, reverse]));
                }
            }
            "crossing" | "double_slip_switch" => {
                let ports = (port("A1"), port("A2"), port("B1"), port("B2"));
                let (Some(a1), Some(a2), Some(b1), Some(b2)) = ports else { continue };
                if node.switch_type == "crossing" {
                    network.crossings.push([network.links.len(), network.links.len() + 1]);
                    network.links.extend([(a1, b1), (a2, b2)]);
                } else {
                    // Two points, toe to toe over a track of no length.
                    let between = network.edges.len();
                    network.edges.push(Edge { name: node.id.clone(), begin: 0.0, length: 0.0 });
                    network.switches.push(switch(&format!("{}.A", node.id), [(between, Side::Begin), a1, a2]));
                    network.switches.push(switch(&format!("{}.B", node.id), [(between, Side::End), b1, b2]));
                }
            }
            other => report.skipped.push(format!("switch {} of the type {other}: its tracks end there", node.id)),
        }
    }
    for (buffer, number) in stops {
        let length = network.edges[number].length;
        let place = format!("buffer stop {} at {} m of {length} m of {}", buffer.id, buffer.position, buffer.track);
        let others: Vec<(usize, f64)> = network.cuts.iter().map(|cut| (cut.edge, cut.at)).collect();
        let is_on = (0.0 - NEAR..=length + NEAR).contains(&buffer.position);
        let Some(side) = is_on.then(|| network.stop(number, buffer.position, &others)).flatten() else {
            let what = format!("{place}: the tracks do not end there");
            let right = "have the track section end at its buffer stop";
            problems.push(Problem::new(Rule::Range, &(0..0), what, right));
            continue;
        };
        let is_at_end = if side == Side::Begin { buffer.position <= NEAR } else { buffer.position >= length - NEAR };
        if !is_at_end {
            report.defaulted.push(format!("the tracks end at the {place}"));
        }
        network.buffers.push((buffer.id.clone(), (number, side)));
    }
    network
}

fn positions(run: &Run, points: &BTreeMap<&str, usize>) -> BTreeMap<usize, Position> {
    let mut found = BTreeMap::new();
    for (switch, group) in &run.switches_directions {
        let of = |port: &str| if port.ends_with('1') { Position::Normal } else { Position::Reverse };
        if let Some((a, b)) = group.split_once('_') {
            let mut at = |name: &str, port: &str| found.extend(points.get(name).map(|point| (*point, of(port))));
            at(switch, b);
            at(&format!("{switch}.A"), a);
            at(&format!("{switch}.B"), b);
        }
    }
    found
}

fn routes(infra: &Infra, network: &Network, divided: &Divided, station: &mut Station, report: &mut Report) {
    let mut ignored = Vec::new();
    let names = Names::of(station, &mut ignored);
    let graph = Graph::of(station, &names, &mut ignored);
    let joints: BTreeMap<&str, usize> =
        graph.joints.iter().enumerate().map(|(number, joint)| (joint.name.as_str(), number)).collect();
    let cuts: BTreeMap<&str, usize> =
        network.cuts.iter().enumerate().map(|(number, cut)| (cut.name.as_str(), number)).collect();
    let points: BTreeMap<&str, usize> =
        station.points.iter().enumerate().map(|(number, point)| (point.name.as_str(), number)).collect();
    let known: BTreeSet<usize> = graph
        .tracks
        .iter()
        .filter_map(|track| match track.kind {
            Kind::Point(point) => Some(point),
            Kind::Plain => None,
        })
        .collect();
    let (mut taken, mut at_buffers, mut released) = (Vec::new(), Vec::new(), 0);
    for run in &infra.routes {
        let start = joints.get(run.entry_point.id.as_str());
        let cut = cuts.get(run.entry_point.id.as_str());
        let [before, after] = cut.map_or([None, None], |cut| divided.beside(*cut));
        let (rear, ahead) =
            if run.entry_point_direction == Direction::StartToStop { (before, after) } else { (after, before) };
        // From a buffer stop a train starts on the first circuit.
        let at_buffer = start.filter(|_| cut.is_none()).and_then(|start| graph.circuits_at(*start).next());
        let positions: BTreeMap<usize, Position> =
            positions(run, &points).into_iter().filter(|(point, _)| known.contains(point)).collect();
        let exit = joints.get(run.exit_point.id.as_str()).copied();
        let look = |start: usize, first: usize| {
            search(&graph, &Sought { start, first, exit, last: None, within: None, positions: &positions })
                .filter(|found| found.alone)
                .map(|found| found.way)
        };
        let found = match (start, rear, ahead, exit) {
            (Some(start), Some(rear), Some(first), Some(_)) if rear != first => {
                look(*start, first).map(|way| (rear, way))
            }
            (Some(start), _, _, Some(_)) => {
                at_buffer.and_then(|first| look(*start, first)).map(|mut way| (way.remove(0).0, way))
            }
            _ => None,
        };
        if found.as_ref().is_some_and(|(_, way)| way.is_empty()) {
            at_buffers.push(run.id.clone());
            continue;
        }
        if at_buffer.is_some() && found.is_some() {
            report.defaulted.push(format!("route {}: its train starts on the circuit at the buffer stop", run.id));
        }
        let Some((rear, way)) = found else {
            report.lacking.push(format!(
                "route {}: there is no way from {} to {} with its switches, or more than one",
                run.id, run.entry_point.id, run.exit_point.id
            ));
            continue;
        };
        released += usize::from(!run.release_detectors.is_empty());
        taken.push(Route {
            name: At::derived(run.id.clone()),
            signal: Some(run.entry_point.id.clone()),
            entry: At::derived(station.circuits[rear].name.value.clone()),
            path: path(station, &way),
            ..Route::default()
        });
    }
    report.taken.push(format!("{} of {} routes", taken.len(), infra.routes.len()));
    if !at_buffers.is_empty() {
        let listed = at_buffers.join(", ");
        report.lacking.push(format!(
            "{} routes are one circuit at a buffer stop, where a train stands and nothing is to be set: {listed}",
            at_buffers.len()
        ));
    }
    if released > 0 {
        report
            .skipped
            .push(format!("the release detectors of {released} routes: every circuit is released on its own"));
    }
    station.routes = taken;
}
