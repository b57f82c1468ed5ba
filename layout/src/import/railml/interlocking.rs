//! The interlocking of a railML file: routes, overlaps, conflicts, flank positions, release times.

use std::collections::{BTreeMap, BTreeSet};

use roxmltree::Node;

use super::circuits::Placed;
use super::xml::{Xml, child, children, duration, reference, references};
use crate::at::At;
use crate::form::{Element, Position, Route, Station};
use crate::graph::Way;
use crate::import::Report;
use crate::import::search::{Sought, search};

/// How far from its signal a route may begin without a remark, in metres.
const NEAR: f64 = 1.0;

/// Writes the routes into `station`.
pub fn write<'a>(xml: &Xml<'a>, placed: &Placed<'a>, station: &mut Station, report: &mut Report) {
    let mut reader = Reader { xml, placed, station, report, names: BTreeMap::new() };
    let mut routes = Vec::new();
    let mut used = BTreeSet::new();
    let mut count = 0;
    for node in xml.all("route") {
        count += 1;
        let id = node.attribute("id").unwrap_or_default();
        match reader.route(node) {
            Ok(mut route) => {
                if !used.insert(route.name.value.clone()) {
                    id.clone_into(&mut route.name.value);
                    used.insert(route.name.value.clone());
                }
                reader.names.insert(id, routes.len());
                routes.push(route);
            }
            Err(why) => reader.report.lacking.push(format!("route {id}: {why}; it is left out")),
        }
    }
    reader.overlaps(&mut routes);
    reader.conflicts(&mut routes);
    let groups = xml.all("routeReleaseGroupAhead").chain(xml.all("routeReleaseGroupRear")).count();
    if groups > 0 {
        reader.report.skipped.push(format!("{groups} release groups: every circuit is released on its own, in order"));
    }
    let combined = xml.all("combinedRoute").count();
    if combined > 0 {
        reader.report.skipped.push(format!("{combined} combined routes: their parts are set one after the other"));
    }
    if count == 0 {
        report.lacking.push("routes: the file has none, so the layout can be drawn, but nothing can be set".to_owned());
    }
    report.taken.push(format!("{} of {count} routes", routes.len()));
    station.routes = routes;
}

struct Reader<'a, 'b> {
    xml: &'b Xml<'a>,
    placed: &'b Placed<'a>,
    station: &'b Station,
    report: &'b mut Report,
    /// Routes by id.
    names: BTreeMap<&'a str, usize>,
}

impl<'a> Reader<'a, '_> {
    fn circuit(&self, number: usize) -> String {
        self.station.circuits[number].name.value.clone()
    }

    /// A position that the file gives for a switch, as that of a point.
    fn position(&mut self, node: Node<'a, 'a>) -> Option<(usize, Position)> {
        let node = child(node, "relatedSwitchAndPosition").unwrap_or(node);
        let id = reference(node, "refersToSwitch").or_else(|| reference(node, "refersTo"))?;
        let switch = self.xml.referred(id)?.attribute("id")?;
        let Some((point, left_is_normal)) = self.placed.switches.get(switch) else {
            self.report.skipped.push(format!("a position of {id}, which is no switch with a left and a right branch"));
            return None;
        };
        let left = match node.attribute("inPosition")? {
            "left" => true,
            "right" => false,
            _ => return None,
        };
        Some((*point, if left == *left_is_normal { Position::Normal } else { Position::Reverse }))
    }

    fn positions(&mut self, node: Node<'a, 'a>, names: &[&'a str]) -> BTreeMap<usize, Position> {
        let given: Vec<Node<'a, 'a>> = names.iter().flat_map(|name| children(node, name)).collect();
        given.into_iter().filter_map(|given| self.position(given)).collect()
    }

    fn sections(&self, node: Node<'a, 'a>) -> BTreeSet<usize> {
        references(node, "hasTvdSection").filter_map(|id| self.placed.sections.get(id).copied()).collect()
    }

    fn route(&mut self, node: Node<'a, 'a>) -> Result<Route, String> {
        let entry =
            child(node, "routeEntry").and_then(|entry| reference(entry, "refersTo")).ok_or("it has no routeEntry")?;
        let entry_asset = self.xml.referred(entry).ok_or_else(|| format!("its routeEntry {entry} does not exist"))?;
        let signal_id = entry_asset.attribute("id").unwrap_or_default();
        let sections = self.sections(node);
        let positions = self.positions(node, &["facingSwitchInPosition", "trailingSwitchInPosition"]);
        let exit =
            child(node, "routeExit").and_then(|exit| reference(exit, "refersTo")).and_then(|exit| self.exit(exit));
        if exit.is_none() && sections.is_empty() {
            return Err("it names neither sections nor an exit with a place".to_owned());
        }
        let starts = self.starts(signal_id, &sections)?;
        let within = if sections.is_empty() { None } else { Some(&sections) };
        let mut found = None;
        for (distance, joint, rear, first) in starts {
            let ends = [None, exit].into_iter().filter(|exit| exit.is_some() || within.is_some());
            let way = ends.filter_map(|exit| {
                let sought = Sought { start: joint, first, exit, within, positions: &positions };
                search(&self.placed.graph, &sought)
            });
            if let Some(way) = { way }.next() {
                found = Some((distance, rear, way));
                break;
            }
        }
        let (distance, rear, way) = found.ok_or("no way leads from its signal over its sections with its switches")?;
        let name = Xml::name(node);
        if distance > NEAR {
            self.report.defaulted.push(format!("route {name}: it begins at the joint {distance:.0} m from its signal"));
        }
        let mut path = self.path(&way);
        for (point, position) in self.flank(node) {
            let run_over = way.iter().flat_map(|(_, way)| &way.passed).any(|passed| passed.point == point);
            if !run_over {
                path[0].value.points.insert(self.station.points[point].name.value.clone(), At::derived(position));
            }
        }
        let time = |attribute: &str| node.attribute(attribute).and_then(duration).map(At::derived);
        let release_ms = time("approachReleaseDelay");
        if release_ms.is_none() {
            self.report
                .defaulted
                .push(format!("route {name}: release time of [times]: it has no approachReleaseDelay"));
        }
        Ok(Route {
            name,
            signal: Some(Xml::name(entry_asset).value),
            entry: At::derived(self.circuit(rear)),
            path,
            release_ms,
            ..Route::default()
        })
    }

    fn path(&self, way: &[(usize, Way)]) -> Vec<At<Element>> {
        let made = way.iter().map(|(circuit, way)| {
            let points = way
                .passed
                .iter()
                .map(|passed| (self.station.points[passed.point].name.value.clone(), At::derived(passed.position)));
            At::derived(Element { circuit: self.circuit(*circuit), points: points.collect() })
        });
        made.collect()
    }

    /// Where a route may begin, the likeliest first: distance from the signal, joint, circuit in rear, first circuit.
    fn starts(&self, signal: &str, sections: &BTreeSet<usize>) -> Result<Vec<(f64, usize, usize, usize)>, String> {
        let spot =
            self.placed.signals.get(signal).ok_or_else(|| format!("its signal {signal} has no place on the tracks"))?;
        let mut starts = Vec::new();
        let cuts = self.placed.network.cuts.iter().enumerate().filter(|(_, cut)| cut.edge == spot.edge);
        for (number, cut) in cuts {
            let [before, after] = self.placed.divided.beside(number);
            let both = [(before, after, true), (after, before, false)];
            for (rear, first, toward_end) in both {
                let (Some(rear), Some(first), Some(joint)) = (rear, first, self.placed.joints.get(&cut.name)) else {
                    continue;
                };
                let against = spot.toward_end.is_some_and(|given| given != toward_end);
                if rear != first && !against {
                    starts.push((
                        Self::badness(sections, (rear, first)),
                        (cut.at - spot.at).abs(),
                        *joint,
                        rear,
                        first,
                    ));
                }
            }
        }
        starts.sort_by(|a, b| (a.0, a.1).partial_cmp(&(b.0, b.1)).unwrap_or(std::cmp::Ordering::Equal));
        if starts.is_empty() {
            return Err(format!("no joint between two circuits lies on the track of its signal {signal}"));
        }
        Ok(starts.into_iter().map(|(_, distance, joint, rear, first)| (distance, joint, rear, first)).collect())
    }

    /// How unlikely it is that a route over `sections` begins there: 0 is as it should be.
    fn badness(sections: &BTreeSet<usize>, (rear, first): (usize, usize)) -> u8 {
        u8::from(!sections.is_empty() && !sections.contains(&first)) + u8::from(sections.contains(&rear))
    }

    /// The joint at the exit of a route: nearest to the signal, or that of a buffer stop or detector.
    fn exit(&self, id: &str) -> Option<usize> {
        let asset = self.xml.referred(id)?.attribute("id")?;
        if let Some(name) = self.placed.borders.get(asset) {
            return self.placed.joints.get(name).copied();
        }
        let spot = self.placed.signals.get(asset)?;
        let near = self.placed.network.cuts.iter().filter(|cut| cut.edge == spot.edge);
        let nearest = near.min_by(|a, b| (a.at - spot.at).abs().total_cmp(&(b.at - spot.at).abs()))?;
        self.placed.joints.get(&nearest.name).copied()
    }

    /// Positions of points that routeRelations ask for.
    fn flank(&mut self, node: Node<'a, 'a>) -> BTreeMap<usize, Position> {
        let relations: Vec<Node<'a, 'a>> =
            references(node, "additionalRelation").filter_map(|id| self.xml.id(id)).collect();
        let mut found = BTreeMap::new();
        for required in relations.into_iter().flat_map(|relation| children(relation, "requiredSwitchPosition")) {
            found.extend(self.position(required));
        }
        found
    }

    /// Gives routes their overlaps: the one that a route's exit names before one that names the route, and that before one that
    /// names the place where the route ends. A route has one at most.
    fn overlaps(&mut self, routes: &mut [Route]) {
        let mut at_exits: BTreeMap<&str, Vec<usize>> = BTreeMap::new();
        for node in self.xml.all("route") {
            let number = node.attribute("id").and_then(|id| self.names.get(id)).copied();
            let (Some(number), Some(exit)) = (number, child(node, "routeExit")) else { continue };
            let point = reference(exit, "refersTo").and_then(|id| self.xml.id(id));
            for id in references(exit, "hasOverlap").chain(point.iter().flat_map(|at| references(*at, "hasOverlap"))) {
                at_exits.entry(id).or_default().push(number);
            }
        }
        let mut wanted: Vec<(u8, usize, Node<'a, 'a>)> = Vec::new();
        for node in self.xml.all("overlap") {
            let id = node.attribute("id").unwrap_or_default();
            let of_exits = at_exits.get(id).into_iter().flatten().map(|route| (0, *route));
            let named =
                references(node, "activeForApproachRoute").filter_map(|id| self.names.get(id)).map(|at| (1, *at));
            let mut found: Vec<(u8, usize)> = of_exits.chain(named).collect();
            if found.is_empty() {
                let at = reference(node, "relatedToTrackAsset").and_then(|id| self.exit(id));
                let ends = (0..routes.len())
                    .filter(|route| at.is_some() && self.end_of(&routes[*route]).map(|end| end.0) == at);
                found.extend(ends.map(|route| (2, route)));
            }
            if found.is_empty() {
                self.report.lacking.push(format!("overlap {id}: it names no route that was taken"));
            }
            wanted.extend(found.into_iter().map(|(rank, route)| (rank, route, node)));
        }
        wanted.sort_by_key(|(rank, ..)| *rank);
        let mut given: BTreeMap<usize, &str> = BTreeMap::new();
        for (_, number, node) in wanted {
            let id = node.attribute("id").unwrap_or_default();
            let name = &routes[number].name;
            match given.get(&number) {
                Some(other) if *other == id => continue,
                Some(other) => {
                    self.report.skipped.push(format!("overlap {id} for route {name}, which has the overlap {other}"));
                    continue;
                }
                None => {}
            }
            let positions = self.positions(node, &["requiresSwitchInPosition"]);
            match self.overlap(node, &routes[number], &positions) {
                Ok(path) => {
                    let timer = node.descendants().find_map(|timer| timer.attribute("timerValue").and_then(duration));
                    if timer.is_none() {
                        self.report
                            .defaulted
                            .push(format!("route {name}: stay time of [times]: overlap {id} has no release timer"));
                    }
                    routes[number].overlap = path;
                    routes[number].stay_ms = timer.map(At::derived);
                    given.insert(number, id);
                }
                Err(why) => self.report.lacking.push(format!("overlap {id} for route {name}: {why}")),
            }
        }
    }

    /// The way of an overlap from the end of a route: over its sections, or to what limits it if it names none.
    fn overlap(
        &self,
        node: Node<'a, 'a>,
        route: &Route,
        positions: &BTreeMap<usize, Position>,
    ) -> Result<Vec<At<Element>>, &'static str> {
        let sections = self.sections(node);
        let limit = references(node, "isLimitedBy").find_map(|id| self.exit(id));
        let within = if sections.is_empty() { None } else { Some(&sections) };
        if within.is_none() && limit.is_none() {
            return Err("it names neither sections nor a limit with a place");
        }
        let way = self.end_of(route).and_then(|(joint, last)| {
            let first = self.placed.graph.across(joint, last)?;
            let exit = if within.is_none() { limit } else { None };
            search(&self.placed.graph, &Sought { start: joint, first, exit, within, positions })
        });
        let way =
            way.ok_or("no way leads from the end of the route over its sections, or to its limit, with its switches")?;
        Ok(self.path(&way))
    }

    /// The joint at the end of a route, and its last circuit.
    fn end_of(&self, route: &Route) -> Option<(usize, usize)> {
        let number = |name: &str| self.station.circuits.iter().position(|circuit| circuit.name.value == name);
        let mut at = number(&route.entry)?;
        let mut joints = Vec::new();
        for element in &route.path {
            let circuit = number(&element.circuit)?;
            if joints.is_empty() {
                joints = self.placed.graph.between(at, circuit);
            }
            let fits = |way: &Way| {
                way.passed.iter().all(|passed| {
                    let given = element.points.get(&self.station.points[passed.point].name.value);
                    given.is_some_and(|given| given.value == passed.position)
                })
            };
            joints = joints
                .iter()
                .flat_map(|joint| self.placed.graph.ways(circuit, *joint))
                .filter(fits)
                .map(|way| way.exit)
                .collect();
            at = circuit;
        }
        joints.first().map(|joint| (*joint, at))
    }

    fn conflicts(&mut self, routes: &mut [Route]) {
        for conflict in self.xml.all("conflictingRoute") {
            let number = |name| reference(conflict, name).and_then(|id| self.names.get(id)).copied();
            let (Some(one), Some(other)) = (number("refersToRoute"), number("conflictsWithRoute")) else { continue };
            for (one, other) in [(one, other), (other, one)] {
                let name = routes[other].name.clone();
                if one != other && !routes[one].conflicts.contains(&name) {
                    routes[one].conflicts.push(At::derived(name.value));
                }
            }
        }
    }
}
