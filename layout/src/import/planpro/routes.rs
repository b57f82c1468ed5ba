//! The train routes of a PlanPro file: over what tracks, with which overlap, flank protection and speed.

use std::collections::{BTreeMap, BTreeSet};

use roxmltree::Node;

use super::circuits::Placed;
use super::file::{File, Place, Stretch, at, child, figure, is_set, places, stretches, value, values};
use super::tracks::AT_NODE;
use crate::at::At;
use crate::form::{Position, Route, Station};
use crate::graph::Way;
use crate::import::joints::{NEAR, Near, OFFSET, near};
use crate::import::limits::kmh;
use crate::import::report::Report;
use crate::import::search::{Found, Sought, search};
use crate::import::way::{hold, path};

/// Kinds of train routes that are taken: regular and alternative ones, and parts of them.
const KINDS: [&str; 4] = ["ZR", "ZU", "ZT", "ZTU"];

/// What may stand in a route and what belongs to it; anything else may be a condition.
const OF_OBJECT: &str = "Identitaet Basis_Objekt_Allg ID_Bearbeitungsvermerk ID_Oertlichkeit_Ausgabe Objektreferenzen";
const OF_ROUTE: &str = "Fstr_Zug_Rangier_Allg ID_Fstr_Ausschluss_Besonders ID_Fstr_Fahrweg Fstr_Zug";
const OF_TRAIN: &str = "Automatische_Einstellung Fstr_Vsigabstand_Verkuerzt Fstr_Zug_Art Fstr_Zug_DWeg";
const OF_ALL: &str = "F_Bedienung Fstr_Bedienstring Fstr_Reihenfolge Fstr_V";
const OF_COURSE: &str = "Bereich_Objekt_Teilbereich Fstr_V_Hg ID_Start ID_Ziel Start_Signal_Charakter";

/// Objects that refer to a route without being a condition of it.
const HARMLESS: [&str; 10] = [
    "Anhang",
    "Bearbeitungsvermerk",
    "Fstr_Aneinander_Zuordnung",
    "Fstr_DWeg",
    "Fstr_Fahrweg",
    "Fstr_Nichthaltfall",
    "Fstr_Rangier_Fla_Zuordnung",
    "Fstr_Signalisierung",
    "Fstr_Umfahrpunkt",
    "Fstr_Zug_Rangier",
];

/// Kinds of signals at which trains routes begin.
const MAIN: [&str; 5] = [
    "Hauptsignal",
    "Hauptsperrsignal",
    "Hauptsperrsignal Ne 14 Ls",
    "Mehrabschnittssignal",
    "Mehrabschnittssperrsignal",
];

struct Reader<'a, 'b> {
    file: &'b File<'a>,
    placed: &'b Placed<'a>,
    station: &'b Station,
    report: &'b mut Report,
    /// What else of the file refers to an object, by its identity.
    referring: BTreeMap<String, Vec<Node<'a, 'a>>>,
}

/// A route as it is read.
struct Asked<'a> {
    /// What stands for it: the Fstr_Zug_Rangier, or the Fstr_Fahrweg where the file has none.
    node: Node<'a, 'a>,
    course: Node<'a, 'a>,
    overlap: Option<Node<'a, 'a>>,
}

/// Writes the routes into `station`.
pub fn write<'a>(file: &File<'a>, placed: &Placed<'a>, station: &mut Station, report: &mut Report) {
    let mut reader = Reader { file, placed, station, report, referring: referring(file) };
    let (asked, count) = reader.asked();
    let (mut routes, mut numbers): (Vec<Route>, BTreeMap<String, usize>) = (Vec::new(), BTreeMap::new());
    for one in &asked {
        match reader.route(one) {
            Ok(route) if routes.iter().any(|other| other.name.value == route.name.value) => {
                reader.report.lacking.push(format!(
                    "{}: another route is called {}; it is left out",
                    at(one.node),
                    route.name
                ));
            }
            Ok(route) => {
                numbers.insert(value(one.node, &["Identitaet"]).unwrap_or_default().to_lowercase(), routes.len());
                routes.push(route);
            }
            Err(why) => {
                let name = reader.called(one.course);
                reader.report.lacking.push(format!("{} ({name}): {why}; it is left out", at(one.node)));
            }
        }
    }
    for one in &asked {
        let Some(number) = numbers.get(&value(one.node, &["Identitaet"]).unwrap_or_default().to_lowercase()) else {
            continue;
        };
        for id in values(one.node, "ID_Fstr_Ausschluss_Besonders") {
            let Some(other) = numbers.get(&id.to_lowercase()) else { continue };
            for (one, other) in [(*number, *other), (*other, *number)] {
                let name = At::derived(routes[other].name.value.clone());
                if one != other && !routes[one].conflicts.contains(&name) {
                    routes[one].conflicts.push(name);
                }
            }
        }
    }
    if count == 0 {
        report.lacking.push("routes: the file has none, so the layout can be drawn, but nothing can be set".to_owned());
    }
    report.taken.push(format!("{} of {count} train routes", routes.len()));
    station.routes = routes;
}

/// What refers to each object, but for what is harmless.
fn referring<'a>(file: &File<'a>) -> BTreeMap<String, Vec<Node<'a, 'a>>> {
    let mut found: BTreeMap<String, Vec<Node<'a, 'a>>> = BTreeMap::new();
    let is_harmless = |kind: &str| HARMLESS.contains(&kind) || kind.starts_with("ZL") || kind.starts_with("Bedien_");
    for object in file.objects().filter(|node| !is_harmless(node.tag_name().name())) {
        for reference in object.descendants().filter(|node| node.tag_name().name().starts_with("ID_")) {
            if let Some(id) = value(reference, &[]) {
                found.entry(id.to_lowercase()).or_default().push(object);
            }
        }
    }
    found
}

impl<'a> Reader<'a, '_> {
    /// The train routes of the file, and how many it has.
    fn asked(&mut self) -> (Vec<Asked<'a>>, usize) {
        let all: Vec<Node<'a, 'a>> = self.file.all("Fstr_Zug_Rangier").collect();
        if all.is_empty() {
            return self.courses();
        }
        let shunting = all.iter().filter(|node| child(**node, "Fstr_Zug").is_none()).count();
        if shunting > 0 {
            self.report.skipped.push(format!("{shunting} shunting routes: no layout has any"));
        }
        let mut asked: Vec<Asked<'a>> = Vec::new();
        let mut count = 0;
        for node in all.into_iter().filter(|node| child(*node, "Fstr_Zug").is_some()) {
            count += 1;
            let Some(course) = self.file.referred(node, "ID_Fstr_Fahrweg") else {
                self.report.lacking.push(format!("{}: its Fstr_Fahrweg is not in the file; it is left out", at(node)));
                continue;
            };
            let of_train = child(node, "Fstr_Zug").and_then(|train| child(train, "Fstr_Zug_DWeg"));
            let overlap = of_train.and_then(|of_train| self.file.referred(of_train, "ID_Fstr_DWeg"));
            if of_train.is_some() && overlap.is_none() {
                self.report.lacking.push(format!("{}: its Fstr_DWeg is not in the file; it is left out", at(node)));
                continue;
            }
            let is_preferred = |node: Node<'a, 'a>| is_set(node, &["Fstr_Zug", "Fstr_Zug_DWeg", "DWeg_Vorzug"]);
            match asked.iter_mut().find(|other| other.course == course) {
                // One path, two overlaps: the one that is set without asking for another.
                Some(other) => {
                    let keeps = is_preferred(other.node) || !is_preferred(node);
                    let left = if keeps { node } else { other.node };
                    self.report.skipped.push(format!("{}: the same path with another overlap", at(left)));
                    if !keeps {
                        *other = Asked { node, course, overlap };
                    }
                }
                None => asked.push(Asked { node, course, overlap }),
            }
        }
        (asked, count)
    }

    /// Where the file has no routes: what could be their paths.
    fn courses(&mut self) -> (Vec<Asked<'a>>, usize) {
        let overlaps: BTreeSet<&str> =
            self.file.all("Fstr_DWeg").filter_map(|node| value(node, &["ID_Fstr_Fahrweg"])).collect();
        let is_overlap = |node: &Node<'a, 'a>| value(*node, &["Identitaet"]).is_some_and(|id| overlaps.contains(id));
        let mut asked = Vec::new();
        let mut others = 0;
        for course in self.file.all("Fstr_Fahrweg").filter(|node| !is_overlap(node)) {
            let kind = self
                .file
                .referred(course, "ID_Start")
                .and_then(|signal| value(signal, &["Signal_Real", "Signal_Real_Aktiv_Schirm", "Signal_Art"]));
            if kind.is_some_and(|kind| MAIN.contains(&kind)) {
                asked.push(Asked { node: course, course, overlap: None });
            } else {
                others += 1;
            }
        }
        if others > 0 {
            self.report.skipped.push(format!("{others} paths that begin at no main signal"));
        }
        if !asked.is_empty() {
            let what =
                "the file has no Fstr_Zug_Rangier: each Fstr_Fahrweg from a main signal is taken as a train route";
            self.report.defaulted.push(what.to_owned());
        }
        let count = asked.len();
        (asked, count)
    }

    fn called(&self, course: Node<'a, 'a>) -> String {
        let end = |name: &str| {
            self.file.referred(course, name).map_or_else(|| "?".to_owned(), |node| self.file.name(node).value)
        };
        format!("{}/{}", end("ID_Start"), end("ID_Ziel"))
    }

    fn route(&mut self, asked: &Asked<'a>) -> Result<Route, String> {
        let Asked { node, course, overlap } = *asked;
        self.conditions(node, course)?;
        let (signal, start) = self.signal(course, "ID_Start")?;
        let (_, exit) = self.signal(course, "ID_Ziel")?;
        let covered = self.covered(course)?;
        let at_start = self.joint(&start, "its signal")?;
        let at_exit = self.joint(&exit, "its exit")?;
        let first = at_start.ahead.ok_or("the tracks end at its signal")?;
        let positions = self.positions(&covered)?;
        let mut within = self.touched(&covered);
        within.remove(&at_start.rear);
        within.retain(|circuit| Some(*circuit) != at_exit.ahead);
        let sought = Sought {
            start: at_start.joint,
            first,
            exit: Some(at_exit.joint),
            last: Some(at_exit.rear),
            within: Some(&within),
            positions: &positions,
        };
        let Some(Found { way, alone }) = search(&self.placed.graph, &sought) else {
            return Err("no way leads from its signal to its exit over what its Fstr_Fahrweg covers".to_owned());
        };
        if !alone {
            return Err("its Fstr_Fahrweg leaves more than one way for it".to_owned());
        }
        let passed: BTreeMap<usize, Position> =
            way.iter().flat_map(|(_, way)| &way.passed).map(|passed| (passed.point, passed.position)).collect();
        let mut proved = BTreeSet::new();
        let held = self.flank(&passed, &mut proved)?;
        self.sound(&way, Some(at_start.rear), held.keys())?;
        let mut places = path(self.station, &way);
        hold(self.station, &mut places, &way, &held);
        let order = value(node, &["Fstr_Zug_Rangier_Allg", "Fstr_Reihenfolge"]).filter(|order| *order != "0");
        let name = self.called(course) + &order.map(|order| format!(" U{order}")).unwrap_or_default();
        let mut route = Route {
            name: At::new(name.clone(), super::file::start(node)),
            signal: Some(self.file.name(signal).value),
            entry: At::derived(self.circuit(at_start.rear)),
            path: places,
            ..Route::default()
        };
        let own: BTreeSet<usize> = way.iter().map(|(circuit, _)| *circuit).chain([at_start.rear]).collect();
        proved.retain(|circuit| !own.contains(circuit));
        route.proved_clear = proved.into_iter().map(|circuit| At::derived(self.circuit(circuit))).collect();
        let mut limits: Vec<u16> = self.placed.tracks.limits.on_way(&way, &self.placed.divided).into_iter().collect();
        let given = [
            value(node, &["Fstr_Zug_Rangier_Allg", "Fstr_V"]),
            value(course, &["Fstr_V_Hg"]),
            overlap.and_then(|overlap| value(overlap, &["Fstr_DWeg_Spezifisch", "DWeg_V"])),
        ];
        // One that cannot be read may be any.
        limits.extend(given.into_iter().flatten().map(|text| kmh(text).unwrap_or(0)));
        self.speed(&mut route, limits.into_iter().min(), passed.values())?;
        for (beside, what) in [(at_start.beside, "begins at the joint"), (at_exit.beside, "ends at the joint")] {
            if beside > NEAR {
                let of = if what.starts_with("begins") { "signal" } else { "exit" };
                self.report.defaulted.push(format!("route {name}: it {what} {beside:.0} m from its {of}"));
            }
        }
        if let Some(overlap) = overlap {
            let last = (at_exit.joint, at_exit.rear);
            self.overlap(&mut route, overlap, last, &own)
                .map_err(|why| format!("its overlap, the {}: {why}", at(overlap)))?;
        }
        self.report.defaulted.push(format!("route {name}: release time of [times]: PlanPro has none"));
        Ok(route)
    }

    /// That the file asks nothing of a route that no layout holds.
    fn conditions(&self, node: Node<'a, 'a>, course: Node<'a, 'a>) -> Result<(), String> {
        let unknown = |node: Option<Node<'a, 'a>>, known: &str| {
            let children = node.into_iter().flat_map(|node| node.children().filter(Node::is_element));
            let mut names = children.map(|child| child.tag_name().name());
            names.find(|name| !known.split(' ').chain(OF_OBJECT.split(' ')).any(|one| one == *name))
        };
        let train = child(node, "Fstr_Zug");
        let found = unknown(Some(course), OF_COURSE)
            .or_else(|| unknown(train, OF_TRAIN))
            .or_else(|| unknown(child(node, "Fstr_Zug_Rangier_Allg"), OF_ALL))
            .or_else(|| if node == course { None } else { unknown(Some(node), OF_ROUTE) });
        if let Some(name) = found {
            return Err(format!("it has {name}, which no layout holds"));
        }
        if let Some(kind) = train.and_then(|train| value(train, &["Fstr_Zug_Art"])).filter(|kind| !KINDS.contains(kind))
        {
            return Err(format!("it is of the kind {kind}; only {} are taken", KINDS.join(", ")));
        }
        let ids = [node, course].into_iter().filter_map(|node| value(node, &["Identitaet"]));
        match ids.filter_map(|id| self.referring.get(&id.to_lowercase())).flatten().next() {
            Some(other) => Err(format!("the {} is about it, and may be a condition that no layout holds", at(*other))),
            None => Ok(()),
        }
    }

    /// The signal at an end of a path, with the one place and direction that it has.
    fn signal(&self, course: Node<'a, 'a>, name: &str) -> Result<(Node<'a, 'a>, Place), String> {
        let signal = self.file.referred(course, name).filter(|node| node.tag_name().name() == "Signal");
        let signal = signal.ok_or_else(|| format!("its {name} is no Signal of the file"))?;
        match <[Place; 1]>::try_from(places(signal)) {
            Ok([place]) if place.toward_end.is_some() => Ok((signal, place)),
            Ok(_) => Err(format!("the {} is for no one direction", at(signal))),
            Err(several) => Err(format!("the {} stands at {} places", at(signal), several.len())),
        }
    }

    /// The stretches that a path covers: on tracks of the file, and with nothing on them that no layout holds.
    fn covered(&self, course: Node<'a, 'a>) -> Result<Vec<Stretch>, String> {
        let covered = stretches(course)?;
        for stretch in &covered {
            let top = self.placed.tracks.edges.get(&stretch.edge);
            if !top.is_some_and(|top| stretch.to <= top.length + AT_NODE && stretch.from >= -AT_NODE) {
                return Err(format!(
                    "it lies on {} from {} to {} m, which is no track",
                    stretch.edge, stretch.from, stretch.to
                ));
            }
            let there = |place: &Place| {
                place.edge == stretch.edge && (stretch.from - AT_NODE..=stretch.to + AT_NODE).contains(&place.at)
            };
            if let Some(obstacle) = self.placed.tracks.obstacles.iter().find(|one| there(&one.place)) {
                return Err(format!("on it, {}", obstacle.what));
            }
        }
        Ok(covered)
    }

    /// The joint that belongs to a signal: the first one at or beyond it, if it is near and none lies a little in rear of it.
    fn joint(&self, place: &Place, whose: &str) -> Result<Near, String> {
        let tracks = &self.placed.tracks;
        let spot = tracks.spot(place).ok_or_else(|| format!("{whose} has no place on the tracks"))?;
        let toward_end = place.toward_end.unwrap_or(true);
        let found = near(&tracks.network, &self.placed.divided, &self.placed.joints, spot, toward_end);
        let behind = found.iter().find(|one| one.behind).map(|one| one.beside);
        let ahead = found.into_iter().find(|one| !one.behind);
        match (ahead, behind) {
            (Some(ahead), _) if ahead.beside <= NEAR => Ok(ahead),
            (_, Some(behind)) => {
                Err(format!("a border of sections lies {behind:.0} m in rear of {whose}, and none at it"))
            }
            // At the end of the tracks there is no other one.
            (Some(ahead), None) if ahead.beside <= OFFSET || ahead.ahead.is_none() => Ok(ahead),
            (Some(ahead), None) => {
                Err(format!("the first border of sections beyond {whose} lies {:.0} m from it", ahead.beside))
            }
            (None, None) => Err(format!("no border of sections lies at or beyond {whose} before the next point")),
        }
    }

    /// The positions of the points that stretches run over.
    fn positions(&self, covered: &[Stretch]) -> Result<BTreeMap<usize, Position>, String> {
        let tracks = &self.placed.tracks;
        let mut found = BTreeMap::new();
        for (node, fork) in &tracks.forks {
            let touched = |port: &str| {
                tracks.at_node(node).into_iter().filter(|(.., at)| *at == port).any(|(edge, is_b, _)| {
                    let length = tracks.edges[edge].length;
                    covered.iter().any(|stretch| {
                        stretch.edge == edge
                            && if is_b { stretch.to >= length - AT_NODE } else { stretch.from <= AT_NODE }
                    })
                })
            };
            match (touched("Spitze"), touched("Links"), touched("Rechts")) {
                (true, left, right) if left != right => {
                    let position = if left == fork.left_is_normal { Position::Normal } else { Position::Reverse };
                    found.insert(fork.point, position);
                }
                (false | true, false, false) | (false, true, false) | (false, false, true) => {}
                _ => return Err(format!("it runs over both legs of {}", tracks.network.switches[fork.point].name)),
            }
        }
        Ok(found)
    }

    /// The circuits that stretches run through, by more than a metre.
    fn touched(&self, covered: &[Stretch]) -> BTreeSet<usize> {
        let parts: Vec<(usize, f64, f64)> =
            covered.iter().flat_map(|stretch| self.placed.tracks.parts(stretch)).collect();
        let is_touched = |area: &usize| {
            self.placed.divided.pieces_of(*area).any(|(edge, from, to)| {
                parts.iter().any(|(on, low, high)| *on == edge && high.min(to) - low.max(from) > NEAR)
            })
        };
        (0..self.placed.divided.areas.len()).filter(is_touched).collect()
    }

    /// That each circuit of a way and the one in rear of it is detected, and each of its points can be set.
    fn sound<'c>(
        &self,
        way: &[(usize, Way)],
        rear: Option<usize>,
        held: impl Iterator<Item = &'c usize>,
    ) -> Result<(), String> {
        for circuit in way.iter().map(|(circuit, _)| *circuit).chain(rear) {
            if let Some(why) = self.placed.unsound.get(&circuit) {
                return Err(format!("{}: {why}", self.circuit(circuit)));
            }
        }
        let passed = way.iter().flat_map(|(_, way)| &way.passed).map(|passed| passed.point);
        match passed.chain(held.copied()).find_map(|point| self.placed.tracks.barred.get(&point)) {
            Some(why) => Err(why.clone()),
            None => Ok(()),
        }
    }

    /// The positions that protect the flank of a path, and the circuits that are proved clear for it.
    fn flank(
        &self,
        passed: &BTreeMap<usize, Position>,
        proved: &mut BTreeSet<usize>,
    ) -> Result<BTreeMap<usize, Position>, String> {
        let tracks = &self.placed.tracks;
        let mut held = BTreeMap::new();
        for (point, position) in passed {
            let Some((id, _)) = tracks.elements.iter().find(|(_, points)| points.contains(point)) else { continue };
            let Some(fork) = tracks.forks.values().find(|fork| fork.point == *point) else { continue };
            let side = if (*position == Position::Normal) == fork.left_is_normal { "links" } else { "rechts" };
            for protection in self.file.all("Fla_Schutz") {
                let asks = value(protection, &["Fla_Schutz_Anforderer", "ID_Anforderer_Element"]);
                let over = value(protection, &["Fla_Schutz_Anforderer", "Fahrt_Ueber"]);
                if asks.is_some_and(|asks| asks.to_lowercase() == *id) && over == Some(side) {
                    self.protect(protection, &mut held, proved, 0)?;
                }
            }
        }
        if let Some((point, _)) =
            held.iter().find(|(point, position)| passed.get(point).is_some_and(|own| own != *position))
        {
            return Err(format!("its flank asks for the other position of {}", tracks.network.switches[*point].name));
        }
        held.retain(|point, _| !passed.contains_key(point));
        Ok(held)
    }

    fn protect(
        &self,
        protection: Node<'a, 'a>,
        held: &mut BTreeMap<usize, Position>,
        proved: &mut BTreeSet<usize>,
        depth: usize,
    ) -> Result<(), String> {
        if depth > 16 {
            return Err(format!("the {} is passed on in a ring", at(protection)));
        }
        if is_set(protection, &["Fla_Schutz_Anforderer", "EKW_Kr_Anteil"]) {
            return Err(format!("the {} is of a slip, which is not read", at(protection)));
        }
        if let Some(by) = child(protection, "Fla_Schutz_W_Gsp") {
            let element = value(by, &["ID_Fla_W_Gsp_Element"]).unwrap_or_default().to_lowercase();
            let side = value(by, &["Fla_W_Lage"]);
            let points = self.placed.tracks.elements.get(&element).map(Vec::as_slice).unwrap_or_default();
            let fork =
                points.first().and_then(|point| self.placed.tracks.forks.values().find(|fork| fork.point == *point));
            match (points, fork, side) {
                ([point], Some(fork), Some(side @ ("links" | "rechts"))) => {
                    let position =
                        if (side == "links") == fork.left_is_normal { Position::Normal } else { Position::Reverse };
                    if held.insert(*point, position).is_some_and(|before| before != position) {
                        return Err(format!("the {} asks for both positions of a point", at(protection)));
                    }
                }
                _ => {
                    return Err(format!(
                        "the {} asks for what is no point of the layout in one position",
                        at(protection)
                    ));
                }
            }
        }
        let id = value(protection, &["Identitaet"]).unwrap_or_default().to_lowercase();
        for clear in self.file.all("Fla_Freimelde_Zuordnung") {
            let is_own = value(clear, &["ID_Fla_Schutz"]).is_some_and(|of| of.to_lowercase() == id);
            if is_own && is_set(clear, &["Fla_Raum_Freimeldung"]) {
                let section = value(clear, &["ID_FMA_Anlage"]).unwrap_or_default().to_lowercase();
                let circuit = self.placed.sections.get(&section);
                proved.insert(*circuit.ok_or_else(|| format!("the {} names a section that is no circuit", at(clear)))?);
            }
        }
        for name in ["ID_Fla_Weitergabe_L", "ID_Fla_Weitergabe_R"] {
            let Some(id) = value(protection, &["Fla_Schutz_Weitergabe", name]) else { continue };
            let next = self
                .file
                .id(id)
                .ok_or_else(|| format!("the {} is passed on to what is not in the file", at(protection)))?;
            self.protect(next, held, proved, depth + 1)?;
        }
        Ok(())
    }

    /// The speed of a route, if its limit is one that a code says.
    fn speed<'c>(
        &mut self,
        route: &mut Route,
        limit: Option<u16>,
        mut positions: impl Iterator<Item = &'c Position>,
    ) -> Result<(), String> {
        let codes = &self.station.braking.speeds_kmh;
        if let Some(limit) = limit.filter(|limit| codes.iter().all(|code| code > limit)) {
            return Err(format!("its limit of {limit} km/h is below the lowest code"));
        }
        if limit.is_none() {
            let reverse = positions.any(|position| *position == Position::Reverse);
            let what = if reverse { "the lowest speed, as it leads over a reverse point" } else { "speed of [speed]" };
            self.report.defaulted.push(format!("route {}: {what}: the file limits none on it", route.name));
        }
        // No train runs faster than the highest code.
        route.speed_kmh = limit.filter(|limit| codes.iter().any(|code| code > limit)).map(At::derived);
        Ok(())
    }

    /// The overlap of a route, from its last joint and circuit on.
    fn overlap(
        &mut self,
        route: &mut Route,
        node: Node<'a, 'a>,
        (joint, last): (usize, usize),
        own: &BTreeSet<usize>,
    ) -> Result<(), String> {
        let course = self.file.referred(node, "ID_Fstr_Fahrweg").ok_or("its Fstr_Fahrweg is not in the file")?;
        let covered = self.covered(course)?;
        let mut within = self.touched(&covered);
        for id in values(node, "ID_FMA_Anlage_Freimeldung") {
            let circuit = self.placed.sections.get(&id.to_lowercase()).copied();
            within.insert(circuit.ok_or_else(|| format!("the section {id} that is proved clear is no circuit"))?);
        }
        within.retain(|circuit| !own.contains(circuit));
        let seconds =
            figure(node, &["Fstr_DWeg_Spezifisch", "Aufloesung_Verzoegerung"]).filter(|seconds| *seconds > 0.0);
        let name = route.name.value.clone();
        if within.is_empty() {
            return Ok(());
        }
        let positions = self.positions(&covered)?;
        let first = self.placed.graph.across(joint, last).ok_or("the tracks end with the route")?;
        let sought =
            Sought { start: joint, first, exit: None, last: None, within: Some(&within), positions: &positions };
        let Some(Found { way, alone }) = search(&self.placed.graph, &sought) else {
            return Err("no way leads over what it covers from the end of the route".to_owned());
        };
        self.sound(&way, None, [].iter())?;
        if !alone {
            self.report
                .defaulted
                .push(format!("route {name}: points beyond the end of its overlap are held in one position"));
        }
        route.overlap = path(self.station, &way);
        match seconds {
            Some(seconds) => {
                #[expect(
                    clippy::cast_possible_truncation,
                    clippy::cast_sign_loss,
                    reason = "clamped to the range of the type"
                )]
                let ms = (seconds * 1000.0).ceil().clamp(1.0, 1e9) as u32;
                route.stay_ms = Some(At::derived(ms));
            }
            None => self.report.defaulted.push(format!("route {name}: stay time of [times]: its overlap has no time")),
        }
        Ok(())
    }

    fn circuit(&self, number: usize) -> String {
        self.station.circuits[number].name.value.clone()
    }
}
