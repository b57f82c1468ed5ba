//! Writes a layout as PlanPro, to have files of our own making.

use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write as _;

use atc_layout::Description;
use atc_layout::form::{EndKind, Position, Station};
use atc_layout::graph::Kind;
use atc_layout::model::{Model, Route};

use super::railml::{Edge, edges, runs_to_end};

/// What the files of different tools have in different ways.
#[derive(Clone, Copy, Debug, PartialEq)]
#[allow(clippy::struct_excessive_bools, reason = "each is a habit of some tool")]
pub struct Tool {
    /// Every so many edges one is measured from its other end; 0 for none.
    pub turned: usize,
    /// Every so many points one has its main track on the right; 0 for none.
    pub mirrored: usize,
    /// How far in rear of their border signals stand, in metres.
    pub offset: f64,
    /// The parts of a path come in the other order.
    pub backwards: bool,
    /// What stands at borders has no name.
    pub nameless: bool,
    /// The tracks are the planned state, and not the one that there is.
    pub planned: bool,
}

impl Tool {
    /// The plainest.
    pub const PLAIN: Self =
        Self { turned: 0, mirrored: 0, offset: 0.0, backwards: false, nameless: false, planned: true };
}

/// A place on an edge, in metres from its begin as the model has it.
type Spot = (usize, f64);

/// A stretch of an edge as a train runs over it.
type Leg = (usize, f64, f64);

struct Writer<'a> {
    model: &'a Model,
    edges: Vec<Edge>,
    tool: &'a Tool,
    spots: BTreeMap<usize, Spot>,
    text: String,
}

/// An identity: figures of a kind and a number.
pub fn id(kind: &str, number: usize) -> String {
    let sum = kind.bytes().fold(7_u32, |sum, byte| sum.wrapping_mul(31).wrapping_add(u32::from(byte)));
    format!("{sum:08X}-0000-4000-8000-{number:012X}")
}

/// What the import calls a route of a written file.
pub fn name_of(model: &Model, route: &Route) -> String {
    format!("{}/{}", route.signal, onward(model, route).map_or_else(|| exit_name(route), |other| other.signal.clone()))
}

fn exit_name(route: &Route) -> String {
    format!("to {}", route.exit)
}

/// A route whose signal stands where this one ends.
fn onward<'a>(model: &'a Model, route: &Route) -> Option<&'a Route> {
    model.routes.iter().find(|other| other.start == route.exit && Some(other.entry) == route.last())
}

/// The layout of `station` as PlanPro 1.10.
pub fn written(station: &Station, tool: &Tool) -> String {
    let description = Description { station: station.clone(), ..Description::default() };
    let model = description.model().unwrap_or_else(|errors| panic!("{errors}"));
    let mut edges = edges(&model);
    for (number, edge) in edges.iter_mut().enumerate() {
        edge.turned = number.checked_rem(tool.turned) == Some(0);
    }
    let spots = edges
        .iter()
        .enumerate()
        .flat_map(|(number, edge)| edge.joints.iter().map(move |(joint, at)| (*joint, (number, *at))))
        .collect();
    let mut writer = Writer { model: &model, edges, tool, spots, text: String::new() };
    let name = value("Oertlichkeit_Langname", &station.name);
    writer.object("Oertlichkeit", &id("place", 0), &format!("<Bezeichnung>{name}</Bezeichnung>"));
    writer.topology();
    writer.points();
    writer.sections();
    writer.signals();
    writer.routes();
    let container = format!("<Container>\n{}</Container>", writer.text);
    let state = if tool.planned {
        format!(
            "<LST_Planung><Fachdaten><Ausgabe_Fachdaten><LST_Zustand_Start><Container/></LST_Zustand_Start><LST_Zustand_Ziel>{container}</LST_Zustand_Ziel></Ausgabe_Fachdaten></Fachdaten></LST_Planung>"
        )
    } else {
        format!("<LST_Zustand>{container}</LST_Zustand>")
    };
    format!(
        "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<nsPlanPro:PlanPro_Schnittstelle xmlns:nsPlanPro=\"http://www.plan-pro.org/modell/PlanPro/1.10.0\">\n{state}\n</nsPlanPro:PlanPro_Schnittstelle>\n"
    )
}

fn value(name: &str, text: &str) -> String {
    format!("<{name}><Wert>{text}</Wert></{name}>")
}

impl Writer<'_> {
    fn object(&mut self, kind: &str, id: &str, inner: &str) {
        let rules = format!("<Basis_Objekt_Allg>{}</Basis_Objekt_Allg>", value("Datum_Regelwerk", "2012-02-24"));
        let _ = writeln!(self.text, "<{kind}>{}{rules}{inner}</{kind}>", value("Identitaet", id));
    }

    fn node(end: (usize, usize)) -> String {
        match end {
            (usize::MAX, joint) => id("end", joint),
            (track, _) => id("fork", track),
        }
    }

    /// Metres from node A of an edge as the file has it.
    fn metres(&self, (edge, at): Spot) -> f64 {
        let given = &self.edges[edge];
        if given.turned { given.length - at } else { at }
    }

    fn place(&self, spot: Spot, toward_end: Option<bool>) -> String {
        let direction =
            toward_end.map(|toward_end| if toward_end == self.edges[spot.0].turned { "gegen" } else { "in" });
        let direction = direction.map(|word| value("Wirkrichtung", word)).unwrap_or_default();
        format!(
            "<Punkt_Objekt_TOP_Kante>{}{}{direction}</Punkt_Objekt_TOP_Kante>",
            value("Abstand", &format!("{:.3}", self.metres(spot))),
            value("ID_TOP_Kante", &id("edge", spot.0))
        )
    }

    fn parts(&self, legs: &[Leg]) -> String {
        let mut made: Vec<String> = legs
            .iter()
            .map(|(edge, from, to)| {
                let (one, other) = (self.metres((*edge, *from)), self.metres((*edge, *to)));
                format!(
                    "<Bereich_Objekt_Teilbereich>{}{}{}</Bereich_Objekt_Teilbereich>",
                    value("Begrenzung_A", &format!("{:.3}", one.min(other))),
                    value("Begrenzung_B", &format!("{:.3}", one.max(other))),
                    value("ID_TOP_Kante", &id("edge", *edge))
                )
            })
            .collect();
        if self.tool.backwards {
            made.reverse();
        }
        made.concat()
    }

    fn is_mirrored(&self, point: usize) -> bool {
        point.checked_rem(self.tool.mirrored) == Some(0)
    }

    fn topology(&mut self) {
        let mut nodes = BTreeSet::new();
        for number in 0..self.edges.len() {
            let edge = &self.edges[number];
            let ends = edge.ends.map(|end| (Self::node(end), self.joined(end)));
            let [a, b] = if edge.turned { [1, 0] } else { [0, 1] };
            let inner = format!(
                "{}{}<TOP_Kante_Allg>{}{}{}</TOP_Kante_Allg>",
                value("ID_TOP_Knoten_A", &ends[a].0),
                value("ID_TOP_Knoten_B", &ends[b].0),
                value("TOP_Anschluss_A", ends[a].1),
                value("TOP_Anschluss_B", ends[b].1),
                value("TOP_Laenge", &format!("{:.3}", edge.length))
            );
            nodes.extend(ends.map(|(node, _)| node));
            self.object("TOP_Kante", &id("edge", number), &inner);
        }
        for node in nodes {
            self.object("TOP_Knoten", &node, "");
        }
        for joint in 0..self.model.graph.joints.len() {
            if self.model.graph.joints[joint].end != Some(EndKind::Buffer) {
                continue;
            }
            let spot = self.end_spot(joint);
            let inner = format!("{}{}", self.place(spot, None), value("Gleis_Abschluss_Art", "Festprellbock"));
            self.object("Gleis_Abschluss", &id("buffer", joint), &inner);
        }
    }

    /// Where the tracks end.
    fn end_spot(&self, joint: usize) -> Spot {
        let found = self.edges.iter().enumerate().find_map(|(number, edge)| {
            edge.ends
                .iter()
                .position(|end| *end == (usize::MAX, joint))
                .map(|end| (number, edge.length * [0.0, 1.0][end]))
        });
        found.expect("every end of the tracks is one of an edge")
    }

    fn joined(&self, (track, joint): (usize, usize)) -> &'static str {
        if track == usize::MAX {
            return "Ende";
        }
        let given = &self.model.graph.tracks[track];
        let Kind::Point(point) = given.kind else { unreachable!("edges end at points") };
        match given.joints.iter().position(|own| *own == joint) {
            Some(0) => "Spitze",
            Some(leg) if (leg == 1) == self.is_mirrored(point) => "Rechts",
            _ => "Links",
        }
    }

    fn points(&mut self) {
        for (track, given) in self.model.graph.tracks.iter().enumerate() {
            let Kind::Point(point) = given.kind else { continue };
            let name = value("Bezeichnung_Tabelle", &self.model.points[point].name);
            let inner = format!(
                "<Bezeichnung>{name}</Bezeichnung><W_Kr_Gsp_Element_Allg>{}</W_Kr_Gsp_Element_Allg><Weiche_Element/>",
                value("W_Kr_Gsp_Stellart", "elektrisch_ferngestellt")
            );
            self.object("W_Kr_Gsp_Element", &id("point", point), &inner);
            let toe = (track, given.joints[0]);
            let edge = self.edges.iter().position(|edge| edge.ends.contains(&toe)).expect("each leg is on an edge");
            let at = if self.edges[edge].ends[0] == toe { 0.0 } else { self.edges[edge].length };
            let main = if self.is_mirrored(point) { "rechts" } else { "links" };
            let inner = format!(
                "{}{}<Zungenpaar>{}</Zungenpaar>",
                self.place((edge, at), None),
                value("ID_W_Kr_Gsp_Element", &id("point", point)),
                value("Stammgleis", main)
            );
            self.object("W_Kr_Gsp_Komponente", &id("blades", point), &inner);
        }
    }

    /// The pieces of an edge between its joints, with the circuit of each.
    fn pieces(&self, number: usize) -> Vec<(usize, f64, f64)> {
        let edge = &self.edges[number];
        let graph = &self.model.graph;
        let of_end = |end: (usize, usize)| match end {
            (usize::MAX, joint) => graph.circuits_at(joint).next().expect("a circuit ends there"),
            (track, _) => graph.tracks[track].circuit,
        };
        let count = edge.joints.len();
        let mut found = Vec::new();
        for place in 0..=count {
            let from = if place == 0 { 0.0 } else { edge.joints[place - 1].1 };
            let to = if place == count { edge.length } else { edge.joints[place].1 };
            let circuit = match place {
                0 => of_end(edge.ends[0]),
                _ if place == count => of_end(edge.ends[1]),
                _ => {
                    let (one, other) = (edge.joints[place - 1].0, edge.joints[place].0);
                    let same =
                        graph.circuits_at(one).find(|circuit| graph.circuits_at(other).any(|same| same == *circuit));
                    same.expect("a circuit lies between two joints")
                }
            };
            found.push((circuit, from, to));
        }
        found
    }

    fn sections(&mut self) {
        let mut legs: Vec<Vec<Leg>> = vec![Vec::new(); self.model.circuits.len()];
        for number in 0..self.edges.len() {
            for (circuit, from, to) in self.pieces(number) {
                legs[circuit].push((number, from, to));
            }
        }
        for (circuit, legs) in legs.iter().enumerate() {
            // Two tracks through one circuit without a point cross.
            let is_plain = self.model.points.iter().all(|point| point.circuit != Some(circuit));
            let crosses = is_plain && legs.len() == 2 && legs[0].0 != legs[1].0;
            if crosses {
                let places = legs.iter().map(|(edge, from, to)| self.place((*edge, from.midpoint(*to)), None));
                let motors = value("Elektrischer_Antrieb_Anzahl", "0");
                let inner = format!("{}<Kreuzung>{motors}</Kreuzung>", places.collect::<String>());
                self.object("W_Kr_Gsp_Komponente", &id("crossing", circuit), &inner);
            }
            let name = value("Bezeichnung_Tabelle", &self.model.circuits[circuit].name);
            let inner = format!("{}<Bezeichnung>{name}</Bezeichnung>", self.parts(legs));
            self.object("Gleis_Abschnitt", &id("track", circuit), &inner);
            self.object("FMA_Anlage", &id("section", circuit), &value("ID_Gleis_Abschnitt", &id("track", circuit)));
        }
        for (joint, spot) in self.spots.clone() {
            let name = value("Bezeichnung_Tabelle", &self.model.graph.joints[joint].name);
            let name = if self.tool.nameless { String::new() } else { format!("<Bezeichnung>{name}</Bezeichnung>") };
            let borders: Vec<String> = self
                .model
                .graph
                .circuits_at(joint)
                .map(|circuit| value("ID_FMAgrenze", &id("section", circuit)))
                .collect();
            let inner = format!("{}{name}{}", self.place(spot, None), borders.concat());
            self.object("FMA_Komponente", &id("joint", joint), &inner);
        }
    }

    fn signal_id(route: &Route) -> String {
        id("signal", route.entry * 1000 + route.start)
    }

    /// Where the signal of a route stands, and whether its trains run toward the end of that edge.
    fn signal_spot(&self, route: &Route) -> (Spot, bool) {
        let (edge, at) = self.spots[&route.start];
        let toward_end = runs_to_end(self.model, &self.edges[edge], route);
        // No farther than half way to the joint before it.
        let others = self.edges[edge].joints.iter().map(|(_, other)| *other).chain([0.0, self.edges[edge].length]);
        let room =
            others.map(|other| (other - at).abs()).filter(|room| *room > 0.001).fold(f64::INFINITY, f64::min) / 2.0;
        let back = self.tool.offset.min(room);
        ((edge, if toward_end { at - back } else { at + back }), toward_end)
    }

    fn signals(&mut self) {
        let mut done = BTreeSet::new();
        for route in &self.model.routes {
            if !done.insert(Self::signal_id(route)) {
                continue;
            }
            let (spot, toward_end) = self.signal_spot(route);
            let inner = format!(
                "{}<Bezeichnung>{}</Bezeichnung><Signal_Real><Signal_Real_Aktiv_Schirm>{}</Signal_Real_Aktiv_Schirm></Signal_Real>",
                self.place(spot, Some(toward_end)),
                value("Bezeichnung_Tabelle", &route.signal),
                value("Signal_Art", "Hauptsignal")
            );
            self.object("Signal", &Self::signal_id(route), &inner);
        }
        for route in self.model.routes.iter().filter(|route| onward(self.model, route).is_none()) {
            if !done.insert(exit_name(route)) {
                continue;
            }
            let legs = self.run(route);
            let (edge, from, to) = *legs.last().expect("a route runs over something");
            let inner = format!(
                "{}<Bezeichnung>{}</Bezeichnung><Signal_Fiktiv>{}</Signal_Fiktiv>",
                self.place((edge, to), Some(to > from)),
                value("Bezeichnung_Tabelle", &exit_name(route)),
                value("Fiktives_Signal_Funktion", "Zug_Ziel_Strecke")
            );
            self.object("Signal", &id("exit", route.exit), &inner);
        }
    }

    /// The legs of a route, from its signal to its exit.
    fn run(&self, route: &Route) -> Vec<Leg> {
        let positions: BTreeMap<usize, Position> =
            route.path.iter().flat_map(|place| &place.passed).map(|one| (one.point, one.position)).collect();
        let (spot, toward_end) = self.signal_spot(route);
        let exit = onward(self.model, route).map(|other| self.signal_spot(other).0);
        let is_exit = |edge: usize, joint: Option<usize>| {
            joint == Some(route.exit) && self.spots.get(&route.exit).is_none_or(|spot| spot.0 == edge)
        };
        let mut legs = self.follow(spot, toward_end, &positions, &is_exit);
        if let (Some(exit), Some(last)) = (exit, legs.last_mut()) {
            last.2 = exit.1;
        }
        legs
    }

    /// Runs from a place over the edges until `stops` says so of a joint.
    fn follow(
        &self,
        (mut edge, mut at): Spot,
        mut toward_end: bool,
        positions: &BTreeMap<usize, Position>,
        stops: &dyn Fn(usize, Option<usize>) -> bool,
    ) -> Vec<Leg> {
        let mut legs = Vec::new();
        loop {
            let given = &self.edges[edge];
            let ahead = |metres: f64| if toward_end { metres >= at } else { metres <= at };
            let mut joints: Vec<(usize, f64)> =
                given.joints.iter().copied().filter(|(_, metres)| ahead(*metres)).collect();
            if !toward_end {
                joints.reverse();
            }
            if let Some((_, to)) = joints.into_iter().find(|(joint, _)| stops(edge, Some(*joint))) {
                legs.push((edge, at, to));
                return legs;
            }
            let (end, to) = if toward_end { (given.ends[1], given.length) } else { (given.ends[0], 0.0) };
            legs.push((edge, at, to));
            let (track, joint) = end;
            if track == usize::MAX || stops(edge, None) {
                return legs;
            }
            let tracks = &self.model.graph.tracks[track];
            let Kind::Point(point) = tracks.kind else { unreachable!("edges end at points") };
            let leg = tracks.joints.iter().position(|own| *own == joint).expect("the edge reaches the point");
            let out = match (leg, positions.get(&point)) {
                (0, Some(Position::Reverse)) => 2,
                (0, _) => 1,
                _ => 0,
            };
            let next = (track, tracks.joints[out]);
            edge = self.edges.iter().position(|edge| edge.ends.contains(&next)).expect("each leg is on an edge");
            toward_end = self.edges[edge].ends[0] == next;
            at = if toward_end { 0.0 } else { self.edges[edge].length };
        }
    }

    fn routes(&mut self) {
        for number in 0..self.model.routes.len() {
            let route = &self.model.routes[number];
            let target = onward(self.model, route).map_or_else(|| id("exit", route.exit), Self::signal_id);
            let legs = self.run(route);
            let inner = format!(
                "{}{}{}",
                self.parts(&legs),
                value("ID_Start", &Self::signal_id(route)),
                value("ID_Ziel", &target)
            );
            self.object("Fstr_Fahrweg", &id("path", number), &inner);
            let mut of_overlap = String::new();
            if !route.overlap.is_empty() {
                let positions = route.overlap_passed.iter().map(|passed| (passed.point, passed.position)).collect();
                let (edge, from, to) = *legs.last().expect("a route runs over something");
                let wanted: BTreeSet<usize> = route.overlap.iter().copied().chain(route.last()).collect();
                let graph = &self.model.graph;
                let leaves = |_: usize, joint: Option<usize>| {
                    joint.is_some_and(|joint| graph.circuits_at(joint).any(|circuit| !wanted.contains(&circuit)))
                };
                let legs = self.follow((edge, to), to > from, &positions, &leaves);
                let inner = format!("{}{}", self.parts(&legs), value("ID_Start", &target));
                self.object("Fstr_Fahrweg", &id("overlap path", number), &inner);
                let proved: Vec<String> = route
                    .overlap
                    .iter()
                    .map(|circuit| value("ID_FMA_Anlage_Freimeldung", &id("section", *circuit)))
                    .collect();
                let seconds = (u32::from(route.stay.0) * self.model.values.cycle_ms).div_ceil(1000);
                let inner = format!(
                    "<Fstr_DWeg_Allg>{}{}</Fstr_DWeg_Allg><Fstr_DWeg_Spezifisch>{}{}</Fstr_DWeg_Spezifisch>{}{}",
                    value("Laenge_Soll", "50"),
                    value("Massgebende_Neigung", "0.00"),
                    value("Aufloesung_Verzoegerung", &seconds.min(150).to_string()),
                    value("ID_FMA_Anlage_Zielgleis", &id("section", route.last().unwrap_or(0))),
                    proved.concat(),
                    value("ID_Fstr_Fahrweg", &id("overlap path", number))
                );
                self.object("Fstr_DWeg", &id("overlap", number), &inner);
                of_overlap = format!(
                    "<Fstr_Zug_DWeg>{}{}</Fstr_Zug_DWeg>",
                    value("DWeg_Vorzug", "true"),
                    value("ID_Fstr_DWeg", &id("overlap", number))
                );
            }
            let excluded: Vec<String> = self.model.routes[number]
                .conflicts
                .iter()
                .map(|other| value("ID_Fstr_Ausschluss_Besonders", &id("route", *other)))
                .collect();
            let inner = format!(
                "<Fstr_Zug_Rangier_Allg>{}</Fstr_Zug_Rangier_Allg>{}{}<Fstr_Zug>{}{}{of_overlap}</Fstr_Zug>",
                value("Fstr_Reihenfolge", "0"),
                excluded.concat(),
                value("ID_Fstr_Fahrweg", &id("path", number)),
                value("Fstr_Vsigabstand_Verkuerzt", "false"),
                value("Fstr_Zug_Art", "ZR"),
            );
            self.object("Fstr_Zug_Rangier", &id("route", number), &inner);
        }
    }
}
