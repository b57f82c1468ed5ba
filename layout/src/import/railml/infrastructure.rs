//! The infrastructure of a railML file: topology, lengths, switches, signals, buffer stops.

use std::collections::{BTreeMap, BTreeSet};

use roxmltree::Node;

use super::places::{Measures, Places, apart, chainage, length, measures, share_of, track_lengths};
use super::xml::{Xml, child, children, duration, number, references};
use crate::form::Position;
use crate::import::limits::Limits;
use crate::import::network::{Edge, EdgeEnd, LONGEST, NEAR, Network, Side, Switch};
use crate::import::report::Report;
use crate::problem::Problem;
use crate::rule::Rule;

/// A place on a track.
#[derive(Clone, Copy, Debug)]
pub struct Spot {
    /// The edge.
    pub edge: usize,
    /// Metres from its begin.
    pub at: f64,
    /// Whether what stands there is for trains that run toward the end of the edge; none if it says nothing.
    pub toward_end: Option<bool>,
}

/// The tracks of a file.
pub struct Tracks<'a> {
    /// The network, without cuts.
    pub network: Network,
    /// Train detection elements by id.
    pub detectors: BTreeMap<&'a str, Spot>,
    /// Signals by id.
    pub signals: BTreeMap<&'a str, Spot>,
    /// Buffer stops by id, and their names in the network.
    pub buffers: BTreeMap<&'a str, String>,
    /// Switches by id.
    pub switches: BTreeMap<&'a str, Switched>,
    /// Positions of the two points of a slip between which there is no way.
    pub absent: Vec<[(usize, Position); 2]>,
    /// What the file says of speeds.
    pub limits: Limits,
    /// Buffer stops that are no end of the tracks: edge, metres from its begin, and where the file has it.
    pub inside: Vec<(usize, f64, String)>,
}

/// What a switch of the file is in the layout.
#[derive(Clone, Copy, Debug)]
pub enum Switched {
    /// A point.
    Point {
        /// Its number.
        point: usize,
        /// Whether its left branch is the normal leg.
        left_is_normal: bool,
    },
    /// A crossing with slips: two points, toe to toe.
    Slip([usize; 2]),
}

/// Length of an edge of which the file tells none, in metres.
const DEFAULT_LENGTH: f64 = 100.0;

/// Reads the infrastructure.
pub fn read<'a>(xml: &Xml<'a>, report: &mut Report, problems: &mut Vec<Problem>) -> Tracks<'a> {
    let mut edges = BTreeMap::new();
    let mut network = Network::default();
    let micro: BTreeSet<&str> = xml
        .all("level")
        .filter(|level| level.attribute("descriptionLevel") == Some("Micro"))
        .flat_map(|level| references(level, "networkResource"))
        .collect();
    let lengths = track_lengths(xml);
    let mut unknown = Vec::new();
    for element in xml.all("netElement") {
        let Some(id) = element.attribute("id") else { continue };
        let aggregated =
            child(element, "elementCollectionUnordered").or(child(element, "elementCollectionOrdered")).is_some();
        if aggregated || !micro.is_empty() && !micro.contains(id) || edges.contains_key(id) {
            continue;
        }
        let by_track = lengths.get(id).copied();
        let length = length(element).or(by_track).unwrap_or_else(|| {
            unknown.push(id);
            DEFAULT_LENGTH
        });
        for (other, whose) in [(chainage(element), "chainage"), (by_track, "track")] {
            if let Some(other) = other.filter(|other| apart(*other, length, length)) {
                let at = Xml::at(element);
                report
                    .defaulted
                    .push(format!("length of the {at}: {length:.0} m; by its {whose} it would be {other:.0} m"));
            }
        }
        if length > LONGEST {
            let what = format!("the {} is {length} m long", Xml::at(element));
            let range = element.range().start..element.range().start + 1;
            let right = format!("lengths are in metres, up to {LONGEST} m");
            problems.push(Problem::new(Rule::Range, &range, what, right));
        }
        edges.insert(id, network.edges.len());
        network.edges.push(Edge { name: id.to_owned(), begin: 0.0, length });
    }
    if network.edges.is_empty() {
        let what = "the file has no netElements, and without topology there are no tracks";
        problems.push(Problem::new(Rule::Form, &(0..0), what, "export the infrastructure with its topology"));
    }
    if !unknown.is_empty() {
        report.defaulted.push(format!(
            "length of {} net elements: {DEFAULT_LENGTH} m: {}",
            unknown.len(),
            unknown.join(", ")
        ));
    }
    report.taken.push(format!("{} net elements", network.edges.len()));
    let relations = relations(xml, &edges);
    let mut tracks = Tracks {
        network,
        detectors: BTreeMap::new(),
        signals: BTreeMap::new(),
        buffers: BTreeMap::new(),
        switches: BTreeMap::new(),
        absent: Vec::new(),
        limits: Limits::default(),
        inside: Vec::new(),
    };
    let measures: BTreeMap<&str, Measures<'_>> =
        xml.all("netElement").filter_map(|element| Some((element.attribute("id")?, measures(element)))).collect();
    let lengths = tracks.network.edges.iter().map(|edge| edge.length).collect();
    let places = Places { edges, lengths, measures };
    tracks.limits = Limits::read(xml, &places, report);
    switches(xml, &relations, &mut tracks, report);
    crossings(xml, &relations, &mut tracks, problems);
    links(&relations, &mut tracks, report);
    on_tracks(xml, &places, &mut tracks, report);
    tracks
}

/// Reads what stands on the tracks: detectors, signals, buffer stops.
fn on_tracks<'a>(xml: &Xml<'a>, places: &Places<'a>, tracks: &mut Tracks<'a>, report: &mut Report) {
    let Places { edges, measures, .. } = places;
    let mut lost = Vec::new();
    let mut beyond = Vec::new();
    let mut spot = |node: Node<'a, 'a>, id: &'a str, network: &Network| {
        let (spot, given) = spot(node, edges, network, measures)?;
        // A centimetre is lost in the digits of coordinates.
        if (given - spot.at).abs() > 0.01 {
            beyond.push(format!("{id} at {given:.0} m of {:.0} m", network.edges[spot.edge].length));
        }
        Some(spot)
    };
    for (list, detector) in [("trainDetectionElement", true), ("signalIS", false)] {
        for node in xml.all(list) {
            let Some(id) = node.attribute("id") else { continue };
            match spot(node, id, &tracks.network) {
                Some(spot) if detector => drop(tracks.detectors.insert(id, spot)),
                Some(spot) => drop(tracks.signals.insert(id, spot)),
                None => lost.push(id),
            }
        }
    }
    let mut stops = Vec::new();
    for node in xml.all("bufferStop") {
        let Some(id) = node.attribute("id") else { continue };
        match spot(node, id, &tracks.network) {
            Some(spot) => stops.push((node, id, spot)),
            None => lost.push(id),
        }
    }
    // Beyond a buffer stop there is nothing: neither what stands on tracks nor where a line goes on.
    let open = xml.all("border").filter_map(|node| spot(node, node.attribute("id")?, &tracks.network));
    let others = tracks.detectors.values().chain(tracks.signals.values()).copied().chain(open);
    let others: Vec<(usize, f64)> = others.map(|spot| (spot.edge, spot.at)).collect();
    for (node, id, spot) in stops {
        end_of_tracks(xml, node, id, spot, &others, tracks, report);
    }
    if !lost.is_empty() {
        report.lacking.push(format!("a place on a net element of: {}", lost.join(", ")));
    }
    if !beyond.is_empty() {
        report
            .defaulted
            .push(format!("places beyond their net element are taken to be at its end: {}", beyond.join(", ")));
    }
}

/// A buffer stop so many metres from the end of its net element is the end of the tracks, even if no section is said to end there.
const NEAR_END: f64 = 20.0;

/// Has the tracks end at a buffer stop, or keeps it as one that is no end of them.
fn end_of_tracks<'a>(
    xml: &Xml<'a>,
    node: Node<'a, 'a>,
    id: &'a str,
    spot: Spot,
    others: &[(usize, f64)],
    tracks: &mut Tracks<'a>,
    report: &mut Report,
) {
    let length = tracks.network.edges[spot.edge].length;
    let place =
        format!("{} at {:.0} m of {length:.0} m of {}", Xml::at(node), spot.at, tracks.network.edges[spot.edge].name);
    // Far from its end it may as well be a slip of the file: the line may go on there, and a train come in.
    let is_near = spot.at.min(length - spot.at) <= NEAR_END;
    let is_border = is_near
        || xml.all("tvdSection").any(|section| references(section, "hasDemarcatingBufferstop").any(|one| one == id));
    let side = is_border.then(|| tracks.network.stop(spot.edge, spot.at, others)).flatten();
    let Some(side) = side else {
        let why = if is_border { "there is something beyond it on either side" } else { "no section ends there" };
        report.lacking.push(format!("an end of the tracks at the {place}: {why}"));
        tracks.inside.push((spot.edge, spot.at, place));
        return;
    };
    let is_at_end = if side == Side::Begin { spot.at <= NEAR } else { spot.at >= length - NEAR };
    if !is_at_end {
        report.defaulted.push(format!("the tracks end at the {place}"));
    }
    let name = xml.name(node).value;
    tracks.network.buffers.push((name.clone(), (spot.edge, side)));
    tracks.buffers.insert(id, name);
}

/// A place, and the metres from the begin of its net element as they are given: a place cannot be beyond its end.
fn spot(
    node: Node<'_, '_>,
    edges: &BTreeMap<&str, usize>,
    network: &Network,
    measures: &BTreeMap<&str, Measures<'_>>,
) -> Option<(Spot, f64)> {
    let location = child(node, "spotLocation")?;
    let element = location.attribute("netElementRef")?;
    let edge = *edges.get(element)?;
    let length = network.edges[edge].length;
    let at = match (number(location, "intrinsicCoord"), number(location, "pos")) {
        // Which of the two is right nobody knows.
        (Some(share), Some(metres)) if apart(share * length, metres, length) => return None,
        (Some(share), _) => share * length,
        (None, Some(metres)) => metres,
        (None, None) => share_of(location, measures.get(element)?)? * length,
    };
    let toward_end = match location.attribute("applicationDirection") {
        Some("normal") => Some(true),
        Some("reverse") => Some(false),
        _ => None,
    };
    Some((Spot { edge, at: at.clamp(0.0, length), toward_end }, at))
}

/// The navigable relations by id: which ends they join.
type Relations<'a> = BTreeMap<&'a str, (EdgeEnd, EdgeEnd)>;

fn relations<'a>(xml: &Xml<'a>, edges: &BTreeMap<&str, usize>) -> Relations<'a> {
    let side = |node: Node<'_, '_>, name: &str| match node.attribute(name) {
        Some("0") => Some(Side::Begin),
        Some("1") => Some(Side::End),
        _ => None,
    };
    let mut relations = BTreeMap::new();
    for relation in xml.all("netRelation") {
        let edge = |name: &str| super::xml::reference(relation, name).and_then(|id| edges.get(id)).copied();
        let one = edge("elementA").zip(side(relation, "positionOnA"));
        let other = edge("elementB").zip(side(relation, "positionOnB"));
        let navigable = relation.attribute("navigability") != Some("None") && one != other;
        if let (Some(id), Some(one), Some(other), true) = (relation.attribute("id"), one, other, navigable) {
            relations.insert(id, (one, other));
        }
    }
    relations
}

fn switches<'a>(xml: &Xml<'a>, relations: &Relations<'a>, tracks: &mut Tracks<'a>, report: &mut Report) {
    let throw = |id: &str, report: &mut Report| {
        let il = xml.all("switchIL").find(|il| super::xml::reference(*il, "refersTo") == Some(id));
        let throw = il.and_then(|il| il.attribute("maxThrowTime").or(il.attribute("typicalThrowTime")));
        if let Some(il) = il.filter(|il| il.attribute("maxThrowTime").is_none() && throw.is_some()) {
            report
                .defaulted
                .push(format!("longest throw time of switch {id}: the typicalThrowTime of the {}", Xml::at(il)));
        }
        let read = throw.and_then(duration);
        if let (Some(text), None) = (throw, read) {
            report.lacking.push(format!("switch {id}: its throw time {text:?} is no time that can be read"));
        }
        (read, il.and_then(|il| il.attribute("preferredPosition")))
    };
    let mut assumed = Vec::new();
    let mut used = BTreeSet::new();
    for switch in xml.all("switchIS") {
        let Some(id) = switch.attribute("id") else { continue };
        let branch = |name: &'static str| -> Vec<(EdgeEnd, EdgeEnd)> {
            children(switch, name)
                .filter_map(|branch| relations.get(branch.attribute("netRelationRef")?).copied())
                .collect()
        };
        let (left, right) = (branch("leftBranch"), branch("rightBranch"));
        let ([left], [right]) = (left.as_slice(), right.as_slice()) else {
            crossing(xml, id, switch, &[branch("straightBranch"), branch("turningBranch")].concat(), tracks, report);
            continue;
        };
        let shared = [left.0, left.1].into_iter().find(|end| *end == right.0 || *end == right.1);
        let Some(toe) = shared else {
            report.lacking.push(format!("switch {id}: its two branches have no toe in common"));
            continue;
        };
        let other = |pair: &(EdgeEnd, EdgeEnd)| if pair.0 == toe { pair.1 } else { pair.0 };
        let (left, right) = (other(left), other(right));
        if left == right || ![toe, left, right].iter().all(|end| used.insert(*end)) {
            report.lacking.push(format!("switch {id}: its ends belong to another switch or to one track"));
            continue;
        }
        let (throw_ms, preferred) = throw(id, report);
        let course = preferred.or(switch.attribute("continueCourse")).filter(|side| ["left", "right"].contains(side));
        if course.is_none() {
            assumed.push(id);
        }
        let left_is_normal = course != Some("right");
        let ports = if left_is_normal { [toe, left, right] } else { [toe, right, left] };
        let point = tracks.network.switches.len();
        tracks.switches.insert(id, Switched::Point { point, left_is_normal });
        for (branch, is_left) in [("leftBranch", true), ("rightBranch", false)] {
            let position = if is_left == left_is_normal { Position::Normal } else { Position::Reverse };
            if let Some(branch) = child(switch, branch) {
                tracks.limits.branch(point, position, branch);
            }
        }
        tracks.network.switches.push(Switch { name: xml.name(switch), ports, throw_ms });
    }
    if !assumed.is_empty() {
        report
            .defaulted
            .push(format!("normal position of {}: left (no preferredPosition or continueCourse)", assumed.join(", ")));
    }
    report.taken.push(format!("{} switches", tracks.network.switches.len()));
}

/// Crossings that are no switches: two tracks that cross. A file that does not say which cannot be read: their routes would not exclude each other.
fn crossings(xml: &Xml<'_>, relations: &Relations<'_>, tracks: &mut Tracks<'_>, problems: &mut Vec<Problem>) {
    for node in xml.all("crossing") {
        let tracks_of = |node: Node<'_, '_>| -> Vec<(EdgeEnd, EdgeEnd)> {
            let named = node.children().filter_map(|child| child.attribute("netRelationRef"));
            named.filter_map(|id| relations.get(id).copied()).collect()
        };
        let network = &mut tracks.network;
        let [one, other] = tracks_of(node)[..] else {
            let what =
                format!("the {} does not name the two net relations of the tracks that cross there", Xml::at(node));
            let range = node.range().start..node.range().start + 1;
            let right = "name both as straightBranch, or describe it as a switchIS of the type simpleCrossing";
            problems.push(Problem::new(Rule::Form, &range, what, right));
            continue;
        };
        let number = |network: &mut Network, way: (EdgeEnd, EdgeEnd)| {
            let same = |link: &(EdgeEnd, EdgeEnd)| *link == way || *link == (way.1, way.0);
            network.links.iter().position(same).unwrap_or_else(|| {
                network.links.push(way);
                network.links.len() - 1
            })
        };
        let pair = [number(network, one), number(network, other)];
        network.crossings.push(pair);
    }
}

/// A crossing with slips becomes two points toe to toe; one without, two tracks that cross.
fn crossing<'a>(
    xml: &Xml<'a>,
    id: &'a str,
    switch: Node<'a, 'a>,
    ways: &[(EdgeEnd, EdgeEnd)],
    tracks: &mut Tracks<'a>,
    report: &mut Report,
) {
    let network = &mut tracks.network;
    if let [one, other] = ways {
        network.crossings.push([network.links.len(), network.links.len() + 1]);
        network.links.extend([*one, *other]);
        return;
    }
    let Some([[a1, a2], [b1, b2]]) = sides(ways) else {
        report.lacking.push(format!("the tracks of the {}: its branches are not those of a slip", Xml::at(switch)));
        return;
    };
    let name = xml.name(switch);
    let between = network.edges.len();
    network.edges.push(Edge { name: id.to_owned(), begin: 0.0, length: 0.0 });
    let first = network.switches.len();
    for (letter, side, legs) in [("A", Side::Begin, [a1, a2]), ("B", Side::End, [b1, b2])] {
        let mut name = name.clone();
        name.value = format!("{name}.{letter}");
        network.switches.push(Switch { name, ports: [(between, side), legs[0], legs[1]], throw_ms: throw_of(xml, id) });
    }
    tracks.switches.insert(id, Switched::Slip([first, first + 1]));
    // A single slip has three of the four ways.
    for (a, of_a) in [(a1, Position::Normal), (a2, Position::Reverse)] {
        for (b, of_b) in [(b1, Position::Normal), (b2, Position::Reverse)] {
            if !ways.contains(&(a, b)) && !ways.contains(&(b, a)) {
                tracks.absent.push([(first, of_a), (first + 1, of_b)]);
            }
        }
    }
    // The limit of the slowest branch holds for all of them.
    let branches = ["straightBranch", "turningBranch"].into_iter().flat_map(|name| children(switch, name));
    for branch in branches {
        for (point, position) in [first, first + 1].into_iter().flat_map(|point| BOTH.map(|position| (point, position)))
        {
            tracks.limits.branch(point, position, branch);
        }
    }
}

/// The two ends on either side of a slip: each way leads from one side to the other.
fn sides(ways: &[(EdgeEnd, EdgeEnd)]) -> Option<[[EdgeEnd; 2]; 2]> {
    let (first, _) = ways.first()?;
    let (mut here, mut there) = (vec![*first], Vec::new());
    for _ in ways {
        for (one, other) in ways.iter().flat_map(|(one, other)| [(one, other), (other, one)]) {
            if here.contains(one) && !there.contains(other) {
                there.push(*other);
            }
            if there.contains(one) && !here.contains(other) {
                here.push(*other);
            }
        }
    }
    let apart = here.iter().all(|end| !there.contains(end));
    let (here, there) = (<[EdgeEnd; 2]>::try_from(here).ok()?, <[EdgeEnd; 2]>::try_from(there).ok()?);
    ((3..=4).contains(&ways.len()) && apart).then_some([here, there])
}

/// Both positions of a point.
const BOTH: [Position; 2] = [Position::Normal, Position::Reverse];

/// The longest throw time of the machines of a switch, in ms.
fn throw_of(xml: &Xml<'_>, id: &str) -> Option<u32> {
    let machines = xml.all("switchIL").filter(|il| super::xml::reference(*il, "refersTo") == Some(id));
    let times = machines.filter_map(|il| il.attribute("maxThrowTime").or(il.attribute("typicalThrowTime")));
    times.filter_map(duration).max()
}

/// What is left over of the relations joins tracks without branches.
fn links(relations: &Relations<'_>, tracks: &mut Tracks<'_>, report: &mut Report) {
    let mut taken: BTreeSet<EdgeEnd> = tracks.network.switches.iter().flat_map(|switch| switch.ports).collect();
    taken.extend(tracks.network.links.iter().flat_map(|(one, other)| [*one, *other]));
    for (id, (one, other)) in relations {
        match (taken.contains(one), taken.contains(other)) {
            (false, false) => {
                taken.extend([*one, *other]);
                tracks.network.links.push((*one, *other));
            }
            // The relations of a switch: both ends are its ports.
            (true, true) => {}
            _ => report.lacking.push(format!("a switch for the net relation {id}, which branches")),
        }
    }
}
