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

/// What the files of different tools have in different ways.
#[derive(Clone, Copy, Debug, PartialEq)]
#[allow(clippy::struct_excessive_bools, reason = "each is a habit of some tool")]
pub struct Dialect {
    /// Every so many net elements one is measured the other way round; 0 for none.
    pub turned: usize,
    /// How far signals stand ahead of their joint, in metres: less than 0 in rear of it, where the joint is beyond the signal.
    pub offset: f64,
    /// Places in metres instead of shares of the length.
    pub metres: bool,
    /// Positions wrapped in an element of their own.
    pub wrapped: bool,
    /// The exit of a route is the signal where it ends, if there is one, and not a detector.
    pub to_signals: bool,
    /// The section in rear of the entry is listed, too.
    pub rear: bool,
    /// The list of sections is in the other order.
    pub backwards: bool,
    /// Nothing has a name: ids alone.
    pub nameless: bool,
}

impl Dialect {
    /// The plainest.
    pub const PLAIN: Self = Self {
        turned: 0,
        offset: 0.0,
        metres: false,
        wrapped: false,
        to_signals: false,
        rear: false,
        backwards: false,
        nameless: false,
    };

    /// The place of a share of an edge, in its words, as attributes.
    fn place(&self, edge: &Edge, share: f64) -> String {
        let share = if edge.turned { 1.0 - share } else { share };
        if self.metres {
            format!("pos=\"{:.4}\"", share * edge.length)
        } else {
            format!("intrinsicCoord=\"{share:.9}\"")
        }
    }
}

/// A track from switch to switch, with the joints on it.
pub struct Edge {
    /// Track of the point, or `usize::MAX` at an end of the tracks, and joint.
    pub ends: [(usize, usize); 2],
    /// Joints with metres from the begin.
    pub joints: Vec<(usize, f64)>,
    /// In metres.
    pub length: f64,
    /// Whether the file measures it from the other end.
    pub turned: bool,
}

/// The layout of `station` as railML.
pub fn railml(station: &Station, version: Version) -> String {
    written(station, version, &Dialect::PLAIN)
}

/// The same in a dialect.
pub fn written(station: &Station, version: Version, dialect: &Dialect) -> String {
    let description = Description { station: station.clone(), ..Description::default() };
    let model = description.model().unwrap_or_else(|errors| panic!("{errors}"));
    let mut edges = edges(&model);
    for (number, edge) in edges.iter_mut().enumerate() {
        edge.turned = dialect.turned > 0 && number % dialect.turned == 0;
    }
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
    functional(&mut text, &model, &edges, dialect);
    let _ = writeln!(text, "  </infrastructure>\n  <interlocking>");
    let assets = if version == Version::V31 { "assetsForIL" } else { "assetsForInterlocking" };
    let list = if version == Version::V31 { "assetsForILs" } else { "assetsForInterlockings" };
    let _ = writeln!(text, "    <{list}>\n      <{assets} id=\"il\">");
    interlocking(&mut text, &model, version, dialect);
    let _ = writeln!(text, "      </{assets}>\n    </{list}>\n  </interlocking>\n</railML>");
    text
}

/// Follows the tracks from every leg of a point and every end of the line over plain pieces.
pub fn edges(model: &Model) -> Vec<Edge> {
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
        edges.push(Edge { ends: [(from, first), end], joints, length, turned: false });
    }
    edges
}

/// The edge and end that a track reaches at a joint.
fn end_of(edges: &[Edge], track: usize, joint: usize) -> (usize, usize) {
    let found = edges
        .iter()
        .enumerate()
        .find_map(|(number, edge)| edge.ends.iter().position(|end| *end == (track, joint)).map(|end| (number, end)));
    let (number, end) = found.expect("every leg is the end of an edge");
    (number, if edges[number].turned { 1 - end } else { end })
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

fn functional(text: &mut String, model: &Model, edges: &[Edge], dialect: &Dialect) {
    let name =
        |name: &str| if dialect.nameless { String::new() } else { format!("<name name=\"{name}\" language=\"en\"/>") };
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
            "        <bufferStop id=\"bs{number}\">{}<spotLocation id=\"bs{number}l\" netElementRef=\"ne{edge}\" intrinsicCoord=\"{end}\"/></bufferStop>",
            name(&joint.name)
        );
    }
    text.push_str("      </bufferStops>\n      <trainDetectionElements>\n");
    for (joint, (edge, at)) in &spots {
        let _ = writeln!(
            text,
            "        <trainDetectionElement id=\"tde{joint}\" type=\"insulatedRailJoint\">{}<spotLocation id=\"tde{joint}l\" netElementRef=\"ne{edge}\" {}/></trainDetectionElement>",
            name(&model.graph.joints[*joint].name),
            dialect.place(&edges[*edge], *at)
        );
    }
    text.push_str("      </trainDetectionElements>\n      <signalsIS>\n");
    for (id, route) in signals(model) {
        let (edge, at) = spots[&route.start];
        let toward_end = runs_to_end(model, &edges[edge], route);
        let direction = if toward_end == edges[edge].turned { "reverse" } else { "normal" };
        // No farther than half way to the next joint or the end of the edge.
        let here = at * edges[edge].length;
        let others = edges[edge].joints.iter().map(|(_, other)| *other).chain([0.0, edges[edge].length]);
        let room =
            others.map(|other| (other - here).abs()).filter(|room| *room > 0.001).fold(f64::INFINITY, f64::min) / 2.0;
        let ahead = dialect.offset.clamp(-room, room);
        let at = (here + if toward_end { ahead } else { -ahead }) / edges[edge].length;
        let _ = writeln!(
            text,
            "        <signalIS id=\"{id}\" isSwitchable=\"true\">{}<spotLocation id=\"{id}l\" netElementRef=\"ne{edge}\" {} applicationDirection=\"{direction}\"/></signalIS>",
            name(&route.signal),
            dialect.place(&edges[edge], at)
        );
    }
    text.push_str("      </signalsIS>\n      <switchesIS>\n");
    for (number, point) in model.points.iter().enumerate() {
        let _ = writeln!(
            text,
            "        <switchIS id=\"sw{number}\" type=\"ordinarySwitch\" continueCourse=\"left\" branchCourse=\"right\">{}<leftBranch netRelationRef=\"nr{number}n\"/><rightBranch netRelationRef=\"nr{number}r\"/></switchIS>",
            name(&point.name)
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

/// What a route's exit refers to.
fn exit_id(model: &Model, route: &Route, dialect: &Dialect) -> String {
    let onward = |other: &&Route| other.start == route.exit && Some(other.entry) == route.last();
    match model.routes.iter().find(onward) {
        Some(other) if dialect.to_signals => format!("il{}", signal_id(other)),
        _ if model.graph.joints[route.exit].end == Some(EndKind::Buffer) => format!("bs{}", route.exit),
        _ => format!("tde{}", route.exit),
    }
}

fn signal_id(route: &Route) -> String {
    format!("sig{}at{}", route.entry, route.start)
}

/// Whether a train on the route runs toward the end of the edge that its signal stands on: its entry is on the begin's side.
pub fn runs_to_end(model: &Model, edge: &Edge, route: &Route) -> bool {
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

fn interlocking(text: &mut String, model: &Model, version: Version, dialect: &Dialect) {
    let name_of = if version == Version::V31 { "assetName" } else { "objectName" };
    let name = |name: &str| {
        if dialect.nameless { String::new() } else { format!("<{name_of} name=\"{name}\" language=\"en\"/>") }
    };
    text.push_str("        <tvdSections>\n");
    for (number, circuit) in model.circuits.iter().enumerate() {
        let _ = write!(
            text,
            "          <tvdSection id=\"tvd{number}\" technology=\"trackCircuit\">{}",
            name(&circuit.name)
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
            "          <route id=\"rt{number}\" approachReleaseDelay=\"PT{release}S\">\n            {}",
            name(&route.name)
        );
        for (place, passed) in route.path.iter().flat_map(|place| &place.passed).enumerate() {
            let side = if passed.position == Position::Normal { "left" } else { "right" };
            let inner = format!("inPosition=\"{side}\"><refersToSwitch ref=\"swil{}\"/>", passed.point);
            let _ = if dialect.wrapped {
                writeln!(
                    text,
                    "            <facingSwitchInPosition id=\"rt{number}p{place}\"><relatedSwitchAndPosition {inner}</relatedSwitchAndPosition></facingSwitchInPosition>"
                )
            } else {
                writeln!(
                    text,
                    "            <facingSwitchInPosition id=\"rt{number}p{place}\" {inner}</facingSwitchInPosition>"
                )
            };
        }
        let mut listed: Vec<usize> = dialect.rear.then_some(route.entry).into_iter().chain(route.circuits()).collect();
        if dialect.backwards {
            listed.reverse();
        }
        for circuit in listed {
            let _ = writeln!(text, "            <hasTvdSection ref=\"tvd{circuit}\"/>");
        }
        let _ = writeln!(
            text,
            "            <routeEntry id=\"rt{number}e\"><refersTo ref=\"il{}\"/></routeEntry>",
            signal_id(route)
        );
        let _ = writeln!(
            text,
            "            <routeExit id=\"rt{number}x\"><refersTo ref=\"{}\"/></routeExit>\n          </route>",
            exit_id(model, route, dialect)
        );
    }
    text.push_str("        </routes>\n        <overlaps>\n");
    for (number, route) in model.routes.iter().enumerate().filter(|(_, route)| !route.overlap.is_empty()) {
        let stay = (u32::from(route.stay.0) * model.values.cycle_ms).div_ceil(1000);
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
}
