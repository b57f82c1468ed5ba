//! The train routes of a PlanPro file: over what tracks, with which overlap, flank protection and speed.

mod conditions;
mod course;
mod flank;
mod overlap;

use std::collections::{BTreeMap, BTreeSet};

use roxmltree::Node;

pub use self::conditions::known;
use self::conditions::{passing, referring};
use self::overlap::From;
use super::circuits::Placed;
use super::file::{File, at, child, is_set, value, values};
use crate::at::At;
use crate::form::{Position, Route, Station};
use crate::import::joints::NEAR;
use crate::import::limits::{kmh, lowest};
use crate::import::report::Report;
use crate::import::search::{Found, Sought, search};
use crate::import::way::{hold, path};

/// Kinds of signals at which trains routes begin.
const MAIN: [&str; 5] = [
    "Hauptsignal",
    "Hauptsperrsignal",
    "Hauptsperrsignal Ne 14 Ls",
    "Mehrabschnittssignal",
    "Mehrabschnittssperrsignal",
];

/// What reads routes.
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
    /// Others with the same path.
    others: Vec<Node<'a, 'a>>,
    /// Whether one of them has the same overlap.
    twice: bool,
}

impl<'a> Asked<'a> {
    /// What stands for it and for others with its path: what is said of one holds for all.
    fn all(&self) -> impl Iterator<Item = Node<'a, 'a>> + '_ {
        [self.node].into_iter().chain(self.others.iter().copied())
    }
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
                let ids = one.all().filter_map(|node| value(node, &["Identitaet"]));
                numbers.extend(ids.map(|id| (id.to_lowercase(), routes.len())));
                routes.push(route);
            }
            Err(why) => {
                let name = reader.called(one.course);
                reader.report.lacking.push(format!("{} ({name}): {why}; it is left out", at(one.node)));
            }
        }
    }
    for node in asked.iter().flat_map(Asked::all) {
        let number = value(node, &["Identitaet"]).and_then(|id| numbers.get(&id.to_lowercase())).copied();
        for id in values(node, "ID_Fstr_Ausschluss_Besonders") {
            let other = numbers.get(&id.to_lowercase()).copied();
            let Some((number, other)) = number.zip(other) else { continue };
            for (one, other) in [(number, other), (other, number)] {
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
                // One path and one overlap: what tells them apart is not held.
                Some(other) if other.overlap == overlap => {
                    other.twice = true;
                    other.others.push(node);
                }
                // One path, two overlaps: the one that is set without asking for another.
                Some(other) => {
                    let keeps = is_preferred(other.node) || !is_preferred(node);
                    let left = if keeps { node } else { other.node };
                    self.report.skipped.push(format!("{}: the same path with another overlap", at(left)));
                    other.others.push(left);
                    if !keeps {
                        (other.node, other.overlap) = (node, overlap);
                    }
                }
                None => asked.push(Asked { node, course, overlap, others: Vec::new(), twice: false }),
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
                asked.push(Asked { node: course, course, overlap: None, others: Vec::new(), twice: false });
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
        let Asked { node, course, overlap, twice, .. } = *asked;
        if let Some(what) = self.placed.tracks.nowhere.first() {
            return Err(format!("{what}: it may be about any route"));
        }
        if twice {
            return Err("another train route has the same path and the same overlap".to_owned());
        }
        self.conditions(node, course)?;
        let (signal, start) = self.signal(course, "ID_Start")?;
        let (target, exit) = self.signal(course, "ID_Ziel")?;
        for one in [signal, target] {
            passing(one)?;
        }
        for id in asked.all().flat_map(|node| values(node, "ID_Fstr_Ausschluss_Besonders")) {
            self.file.id(id).ok_or_else(|| format!("it excludes {id}, which is not in the file"))?;
        }
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
        let tracks = &self.placed.tracks;
        let limits = own_limits(asked)?.into_iter().chain(tracks.limits.on_way(&way, &self.placed.divided));
        let mut limit = limits.min();
        let is_planned = value(node, &["Fstr_Zug_Rangier_Allg", "Fstr_V"]).is_some();
        if !is_planned && tracks.limits.leaves_open(&way, &tracks.network) {
            // A limit somewhere else says nothing of this leg; that of the route does.
            limit = limit.map(|limit| limit.min(lowest(self.station)));
        }
        self.speed(&mut route, limit, passed.values())?;
        for (beside, word, of) in [(at_start.beside, "begins", "signal"), (at_exit.beside, "ends", "exit")] {
            if beside > NEAR {
                let what = format!("route {name}: it {word} at the joint {beside:.0} m from its {of}");
                self.report.defaulted.push(what);
            }
        }
        if let Some(overlap) = overlap {
            let from = From { signal: target, joint: at_exit.joint, circuit: at_exit.rear };
            self.overlap(&mut route, overlap, &from, &own)
                .map_err(|why| format!("its overlap, the {}: {why}", at(overlap)))?;
        }
        self.report.defaulted.push(format!("route {name}: release time of [times]: PlanPro has none"));
        Ok(route)
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

    fn circuit(&self, number: usize) -> String {
        self.station.circuits[number].name.value.clone()
    }
}

/// The limits that a route, its path and its overlap have of their own, in km/h.
///
/// # Errors
/// One that cannot be read: it may be any.
fn own_limits(asked: &Asked<'_>) -> Result<Vec<u16>, String> {
    let given = [
        value(asked.node, &["Fstr_Zug_Rangier_Allg", "Fstr_V"]),
        value(asked.course, &["Fstr_V_Hg"]),
        asked.overlap.and_then(|overlap| value(overlap, &["Fstr_DWeg_Spezifisch", "DWeg_V"])),
    ];
    let read = |text: &str| kmh(text).ok_or_else(|| format!("its speed {text:?} is no number of km/h above 0"));
    given.into_iter().flatten().map(read).collect()
}
