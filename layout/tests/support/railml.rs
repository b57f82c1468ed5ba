//! Writes a layout as railML 3, to have files of our own making.

use std::collections::BTreeMap;
use std::fmt::Write as _;

use atc_layout::Description;
use atc_layout::form::{EndKind, Position, Station};
use atc_layout::graph::Kind;
use atc_layout::model::{Model, Route};

/// A version of railML, which name a few things differently.
#[derive(Clone, Copy, PartialEq, Eq)]
pub enum Version {
    V31,
    V32,
}

/// A track from switch to switch, with the joints on it.
struct Edge {
    ends: [(usize, usize); 2],
    joints: Vec<(usize, f64)>,
    length: f64,
}

/// The layout of `station` as railML.
pub fn railml(station: &Station, version: Version) -> String {
    let description = Description { station: station.clone(), ..Description::default() };
    let model = description.model().unwrap_or_else(|errors| panic!("{errors}"));
    let edges = edges(&model);
    let mut text = String::new();
    let number = if version == Version::V31 { "3.1" } else { "3.2" };
    let namespace = format!("https://www.railml.org/schemas/{number}");
    let name = &station.name;
    let _ = writeln!(
        text,
        "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<railML xmlns=\"{namespace}\" xmlns:dc=\"http://purl.org/dc/elements/1.1/\" version=\"{number}\">"
    );
    let _ = writeln!(text, "  <metadata><dc:title>{name}</dc:title></metadata>\n  <infrastructure id=\"is\">");
    topology(&mut text, &model, &edges);
    functional(&mut text, &model, &edges);
    let _ = writeln!(text, "  </infrastructure>\n  <interlocking>");
    let assets = if version == Version::V31 { "assetsForIL" } else { "assetsForInterlocking" };
    let list = if version == Version::V31 { "assetsForILs" } else { "assetsForInterlockings" };
    let _ = writeln!(text, "    <{list}>\n      <{assets} id=\"il\">");
    interlocking(&mut text, station, &model, version);
    let _ = writeln!(text, "      </{assets}>\n    </{list}>\n  </interlocking>\n</railML>");
    text
}

/// Follows the tracks from every leg of a point and every end of the line over plain pieces.
fn edges(model: &Model) -> Vec<Edge> {
    let graph = &model.graph;
    // A point's circuit is as long on each way through: half of it before the blades, half behind them.
    let stub = |track: usize| f64::from(model.circuits[graph.tracks[track].circuit].length.0) / 2.0;
    let mut starts = Vec::new();
    for (track, given) in graph.tracks.iter().enumerate() {
        for joint in &given.joints {
            if given.kind != Kind::Plain {
                starts.push((track, *joint, stub(track)));
            }
        }
    }
    for (joint, given) in graph.joints.iter().enumerate() {
        if given.tracks.len() == 1 {
            starts.push((usize::MAX, joint, 0.0));
        }
    }
    let mut edges: Vec<Edge> = Vec::new();
    for (from, first, stub_length) in starts {
        if edges.iter().any(|edge| edge.ends.contains(&(from, first))) {
            continue;
        }
        let (mut track, mut joint, mut length) = (from, first, stub_length);
        let mut joints = Vec::new();
        let end = loop {
            let at = &graph.joints[joint];
            let borders =
                at.tracks.len() == 2 && graph.tracks[at.tracks[0]].circuit != graph.tracks[at.tracks[1]].circuit;
            if borders {
                joints.push((joint, length));
            }
            let Some(next) = at.tracks.iter().copied().find(|next| *next != track) else { break (usize::MAX, joint) };
            if graph.tracks[next].kind != Kind::Plain {
                length += stub(next);
                break (next, joint);
            }
            length += f64::from(model.circuits[graph.tracks[next].circuit].length.0);
            let [left, right] = graph.tracks[next].joints[..] else { unreachable!("plain pieces have two ends") };
            joint = if joint == left { right } else { left };
            track = next;
        };
        edges.push(Edge { ends: [(from, first), end], joints, length });
    }
    edges
}

/// The edge and end that a track reaches at a joint.
fn end_of(edges: &[Edge], track: usize, joint: usize) -> (usize, usize) {
    let found = edges
        .iter()
        .enumerate()
        .find_map(|(number, edge)| edge.ends.iter().position(|end| *end == (track, joint)).map(|end| (number, end)));
    found.expect("every leg is the end of an edge")
}

fn topology(text: &mut String, model: &Model, edges: &[Edge]) {
    text.push_str("    <topology>\n      <netElements>\n");
    for (number, edge) in edges.iter().enumerate() {
        let _ = writeln!(text, "        <netElement id=\"ne{number}\" length=\"{}\"/>", edge.length);
    }
    text.push_str("      </netElements>\n      <netRelations>\n");
    for (track, given) in model.graph.tracks.iter().enumerate() {
        let Kind::Point(point) = given.kind else { continue };
        let [toe, normal, reverse] = [0, 1, 2].map(|leg| end_of(edges, track, given.joints[leg]));
        for (letter, one, other, navigability) in
            [("n", toe, normal, "Both"), ("r", toe, reverse, "Both"), ("x", normal, reverse, "None")]
        {
            let _ = writeln!(
                text,
                "        <netRelation id=\"nr{point}{letter}\" navigability=\"{navigability}\" positionOnA=\"{}\" positionOnB=\"{}\"><elementA ref=\"ne{}\"/><elementB ref=\"ne{}\"/></netRelation>",
                one.1, other.1, one.0, other.0
            );
        }
    }
    text.push_str("      </netRelations>\n    </topology>\n");
}

fn functional(text: &mut String, model: &Model, edges: &[Edge]) {
    let spots: BTreeMap<usize, (usize, f64)> = edges
        .iter()
        .enumerate()
        .flat_map(|(number, edge)| edge.joints.iter().map(move |(joint, at)| (*joint, (number, at / edge.length))))
        .collect();
    text.push_str("    <functionalInfrastructure>\n      <bufferStops>\n");
    for (number, joint) in model.graph.joints.iter().enumerate().filter(|(_, joint)| joint.end == Some(EndKind::Buffer))
    {
        let (edge, end) = end_of(edges, usize::MAX, number);
        let _ = writeln!(
            text,
            "        <bufferStop id=\"bs{number}\"><name name=\"{}\" language=\"en\"/><spotLocation id=\"bs{number}l\" netElementRef=\"ne{edge}\" intrinsicCoord=\"{end}\"/></bufferStop>",
            joint.name
        );
    }
    text.push_str("      </bufferStops>\n      <trainDetectionElements>\n");
    for (joint, (edge, at)) in &spots {
        let _ = writeln!(
            text,
            "        <trainDetectionElement id=\"tde{joint}\" type=\"insulatedRailJoint\"><name name=\"{}\" language=\"en\"/><spotLocation id=\"tde{joint}l\" netElementRef=\"ne{edge}\" intrinsicCoord=\"{at:.9}\"/></trainDetectionElement>",
            model.graph.joints[*joint].name
        );
    }
    text.push_str("      </trainDetectionElements>\n      <signalsIS>\n");
    for (id, route) in signals(model) {
        let (edge, at) = spots[&route.start];
        let toward_end = runs_to_end(model, &edges[edge], route);
        let direction = if toward_end { "normal" } else { "reverse" };
        let _ = writeln!(
            text,
            "        <signalIS id=\"{id}\" isSwitchable=\"true\"><name name=\"{}\" language=\"en\"/><spotLocation id=\"{id}l\" netElementRef=\"ne{edge}\" intrinsicCoord=\"{at:.9}\" applicationDirection=\"{direction}\"/></signalIS>",
            route.signal
        );
    }
    text.push_str("      </signalsIS>\n      <switchesIS>\n");
    for (number, point) in model.points.iter().enumerate() {
        let _ = writeln!(
            text,
            "        <switchIS id=\"sw{number}\" type=\"ordinarySwitch\" continueCourse=\"left\" branchCourse=\"right\"><name name=\"{}\" language=\"en\"/><leftBranch netRelationRef=\"nr{number}n\"/><rightBranch netRelationRef=\"nr{number}r\"/></switchIS>",
            point.name
        );
    }
    text.push_str("      </switchesIS>\n    </functionalInfrastructure>\n");
}

/// One route for each signal, by the signal's id.
fn signals(model: &Model) -> BTreeMap<String, &Route> {
    let mut signals = BTreeMap::new();
    for route in model.routes.iter().rev() {
        signals.insert(signal_id(route), route);
    }
    signals
}

fn signal_id(route: &Route) -> String {
    format!("sig{}at{}", route.entry, route.start)
}

/// Whether a train on the route runs toward the end of the edge that its signal stands on: its entry is on the begin's side.
fn runs_to_end(model: &Model, edge: &Edge, route: &Route) -> bool {
    let graph = &model.graph;
    let place = edge.joints.iter().position(|(joint, _)| *joint == route.start).expect("the signal is on the edge");
    let before = match (place, edge.ends[0]) {
        (0, (usize::MAX, joint)) => graph.circuits_at(joint).next(),
        (0, (track, _)) => Some(graph.tracks[track].circuit),
        _ => {
            let (one, other) = (edge.joints[place - 1].0, edge.joints[place].0);
            graph.circuits_at(one).find(|circuit| graph.circuits_at(other).any(|same| same == *circuit))
        }
    };
    before == Some(route.entry)
}

fn interlocking(text: &mut String, station: &Station, model: &Model, version: Version) {
    let name_of = if version == Version::V31 { "assetName" } else { "objectName" };
    text.push_str("        <tvdSections>\n");
    for (number, circuit) in model.circuits.iter().enumerate() {
        let _ = write!(
            text,
            "          <tvdSection id=\"tvd{number}\" technology=\"trackCircuit\"><{name_of} name=\"{}\" language=\"en\"/>",
            circuit.name
        );
        for joint in model.graph.borders(number) {
            match model.graph.joints[joint].end {
                None => drop(write!(text, "<hasDemarcatingTraindetector ref=\"tde{joint}\"/>")),
                Some(EndKind::Buffer) => drop(write!(text, "<hasDemarcatingBufferstop ref=\"bs{joint}\"/>")),
                Some(EndKind::Line) => {}
            }
        }
        text.push_str("</tvdSection>\n");
    }
    text.push_str("        </tvdSections>\n        <switchesIL>\n");
    for (number, point) in model.points.iter().enumerate() {
        let _ = writeln!(
            text,
            "          <switchIL id=\"swil{number}\" maxThrowTime=\"PT{}S\" preferredPosition=\"left\"><refersTo ref=\"sw{number}\"/></switchIL>",
            f64::from(point.throw_ms) / 1000.0
        );
    }
    text.push_str("        </switchesIL>\n        <signalsIL>\n");
    for id in signals(model).keys() {
        let _ = writeln!(text, "          <signalIL id=\"il{id}\"><refersTo ref=\"{id}\"/></signalIL>");
    }
    text.push_str("        </signalsIL>\n        <routes>\n");
    for (number, route) in model.routes.iter().enumerate() {
        let release = u32::from(route.release.0) * model.values.cycle_ms / 1000;
        let _ = writeln!(
            text,
            "          <route id=\"rt{number}\" approachReleaseDelay=\"PT{release}S\">\n            <{name_of} name=\"{}\" language=\"en\"/>",
            route.name
        );
        for (place, passed) in route.path.iter().flat_map(|place| &place.passed).enumerate() {
            let side = if passed.position == Position::Normal { "left" } else { "right" };
            let _ = writeln!(
                text,
                "            <facingSwitchInPosition id=\"rt{number}p{place}\" inPosition=\"{side}\"><refersToSwitch ref=\"swil{}\"/></facingSwitchInPosition>",
                passed.point
            );
        }
        for circuit in route.circuits() {
            let _ = writeln!(text, "            <hasTvdSection ref=\"tvd{circuit}\"/>");
        }
        let _ = writeln!(
            text,
            "            <routeEntry id=\"rt{number}e\"><refersTo ref=\"il{}\"/></routeEntry>",
            signal_id(route)
        );
        let _ = writeln!(
            text,
            "            <routeExit id=\"rt{number}x\"><refersTo ref=\"{}{}\"/></routeExit>\n          </route>",
            if model.graph.joints[route.exit].end == Some(EndKind::Buffer) { "bs" } else { "tde" },
            route.exit
        );
    }
    text.push_str("        </routes>\n        <overlaps>\n");
    for (number, route) in model.routes.iter().enumerate().filter(|(_, route)| !route.overlap.is_empty()) {
        let stay = u32::from(route.stay.0) * model.values.cycle_ms / 1000;
        let _ = write!(text, "          <overlap id=\"ov{number}\"><activeForApproachRoute ref=\"rt{number}\"/>");
        for circuit in &route.overlap {
            let _ = write!(text, "<hasTvdSection ref=\"tvd{circuit}\"/>");
        }
        let _ = writeln!(
            text,
            "<overlapRelease id=\"ov{number}r\"><overlapReleaseTimer timerValue=\"PT{stay}S\"/></overlapRelease></overlap>"
        );
    }
    text.push_str("        </overlaps>\n        <conflictingRoutes>\n");
    for (number, route) in model.routes.iter().enumerate() {
        for other in &route.conflicts {
            let _ = writeln!(
                text,
                "          <conflictingRoute id=\"cr{number}x{other}\"><refersToRoute ref=\"rt{number}\"/><conflictsWithRoute ref=\"rt{other}\"/></conflictingRoute>"
            );
        }
    }
    text.push_str("        </conflictingRoutes>\n");
    debug_assert_eq!(station.routes.len(), model.routes.len());
}
