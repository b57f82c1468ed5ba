//! The interlocking of a railML file: routes, overlaps, conflicts, flank positions, release times.

use std::collections::{BTreeMap, BTreeSet};

use roxmltree::Node;

use super::circuits::Placed;
use super::xml::{Xml, child, children, duration, reference, references};
use crate::at::At;
use crate::form::{Element, Position, Route, Station};
use crate::graph::Way;
use crate::import::Report;
use crate::import::search::{Extent, Found, Sought, search};

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

    /// The positions that these elements give for switches, as those of points: one each, or several in wrappers.
    fn positions_of(&mut self, given: Vec<Node<'a, 'a>>) -> Result<BTreeMap<usize, Position>, String> {
        let mut found = BTreeMap::new();
        for node in given {
            let wrapped: Vec<Node<'a, 'a>> = children(node, "relatedSwitchAndPosition").collect();
            for node in if wrapped.is_empty() { vec![node] } else { wrapped } {
                let id = reference(node, "refersToSwitch")
                    .or_else(|| reference(node, "refersTo"))
                    .ok_or("a position of it names no switch")?;
                let switch = self.xml.referred(id).and_then(|switch| switch.attribute("id"));
                let switch = switch.ok_or_else(|| format!("the switch {id} of a position does not exist"))?;
                let Some((point, left_is_normal)) = self.placed.switches.get(switch) else {
                    self.report
                        .skipped
                        .push(format!("a position of {id}, which is no switch with a left and a right branch"));
                    continue;
                };
                let left = match node.attribute("inPosition") {
                    Some("left") => true,
                    Some("right") => false,
                    other => {
                        return Err(format!(
                            "the position {:?} of {id} is neither left nor right",
                            other.unwrap_or("")
                        ));
                    }
                };
                let position = if left == *left_is_normal { Position::Normal } else { Position::Reverse };
                if found.insert(*point, position).is_some_and(|before| before != position) {
                    return Err(format!("{id} is to stand in both positions"));
                }
            }
        }
        Ok(found)
    }

    fn positions(&mut self, node: Node<'a, 'a>, names: &[&'a str]) -> Result<BTreeMap<usize, Position>, String> {
        self.positions_of(names.iter().flat_map(|name| children(node, name)).collect())
    }

    fn sections(&self, node: Node<'a, 'a>) -> Result<BTreeSet<usize>, String> {
        let placed = |id| self.placed.sections.get(id).copied().ok_or_else(|| format!("its section {id} has no place"));
        references(node, "hasTvdSection").map(placed).collect()
    }

    /// A time that an attribute gives; one that cannot be read is reported.
    fn time(&mut self, node: Node<'a, 'a>, attribute: &str, about: &str) -> Option<u32> {
        let text = node.attribute(attribute)?;
        let read = duration(text);
        if read.is_none() {
            self.report.lacking.push(format!("{about}: {attribute} {text:?} is no time that can be read"));
        }
        read
    }

    fn route(&mut self, node: Node<'a, 'a>) -> Result<Route, String> {
        let entry =
            child(node, "routeEntry").and_then(|entry| reference(entry, "refersTo")).ok_or("it has no routeEntry")?;
        let entry_asset = self.xml.referred(entry).ok_or_else(|| format!("its routeEntry {entry} does not exist"))?;
        let signal_id = entry_asset.attribute("id").unwrap_or_default();
        let sections = self.sections(node)?;
        let mut positions = self.positions(node, &["facingSwitchInPosition", "trailingSwitchInPosition"])?;
        let exit =
            child(node, "routeExit").and_then(|exit| reference(exit, "refersTo")).and_then(|exit| self.exit(exit));
        if exit.is_none() && sections.is_empty() {
            return Err("it names neither sections nor an exit with a place".to_owned());
        }
        let name = Xml::name(node);
        let (distance, rear, Found { way, alone }, remark) = self.way(signal_id, &sections, exit, &positions)?;
        if distance > NEAR {
            self.report.defaulted.push(format!("route {name}: it begins at the joint {distance:.0} m from its signal"));
        }
        if let Some((_, beside)) = exit.filter(|(_, beside)| *beside > NEAR) {
            self.report.defaulted.push(format!("route {name}: it ends at the joint {beside:.0} m from its exit"));
        }
        if let Some(remark) = remark {
            self.report.defaulted.push(format!("route {name}: {remark}"));
        }
        if !alone {
            self.report
                .defaulted
                .push(format!("route {name}: the file leaves more than one way; the shortest is taken"));
        }
        let mut path = self.path(&way);
        positions.extend(self.flank(node)?);
        self.hold(&mut path, &way, &positions);
        let release_ms = self.time(node, "approachReleaseDelay", &format!("route {name}")).map(At::derived);
        if node.attribute("approachReleaseDelay").is_none() {
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

    /// The way of a route: how far from its signal it begins, the circuit in rear, the way, and what it does not keep of what is given.
    #[allow(clippy::type_complexity, reason = "said above")]
    fn way(
        &self,
        signal: &str,
        sections: &BTreeSet<usize>,
        exit: Option<(usize, f64)>,
        positions: &BTreeMap<usize, Position>,
    ) -> Result<(f64, usize, Found, Option<&'static str>), String> {
        let exit = exit.map(|(joint, _)| joint);
        let all = (!sections.is_empty()).then_some((sections, Extent::All));
        let some = (!sections.is_empty()).then_some((sections, Extent::Some));
        // All that is given, or all but one thing.
        let mut looks = vec![(exit, all, None)];
        if exit.is_some() && all.is_some() {
            looks.push((None, all, Some("its sections do not end at its exit; it is taken to end with them")));
            looks.push((exit, some, Some("not all of its sections lie between its signal and its exit")));
        }
        let starts = self.starts(signal, sections)?;
        for (exit, within, remark) in looks {
            for (distance, joint, rear, first) in &starts {
                let sought = Sought { start: *joint, first: *first, exit, within, positions };
                if let Some(found) = search(&self.placed.graph, &sought) {
                    return Ok((*distance, *rear, found, remark));
                }
            }
        }
        Err("no way leads from its signal over its sections with its switches".to_owned())
    }

    /// Has the first place of a path hold the points that it is not run over.
    fn hold(&self, path: &mut [At<Element>], way: &[(usize, Way)], positions: &BTreeMap<usize, Position>) {
        let run_over: BTreeSet<usize> =
            way.iter().flat_map(|(_, way)| &way.passed).map(|passed| passed.point).collect();
        for (point, position) in positions.iter().filter(|(point, _)| !run_over.contains(point)) {
            if let Some(first) = path.first_mut() {
                first.value.points.insert(self.station.points[*point].name.value.clone(), At::derived(*position));
            }
        }
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

    /// The joint at the exit of a route, and how far from it in metres: nearest to the signal, or that of a buffer stop or detector.
    fn exit(&self, id: &str) -> Option<(usize, f64)> {
        let asset = self.xml.referred(id)?.attribute("id")?;
        if let Some(name) = self.placed.borders.get(asset) {
            return self.placed.joints.get(name).map(|joint| (*joint, 0.0));
        }
        let spot = self.placed.signals.get(asset)?;
        let near = self.placed.network.cuts.iter().filter(|cut| cut.edge == spot.edge);
        let nearest = near.min_by(|a, b| (a.at - spot.at).abs().total_cmp(&(b.at - spot.at).abs()))?;
        self.placed.joints.get(&nearest.name).map(|joint| (*joint, (nearest.at - spot.at).abs()))
    }

    /// Positions of points that routeRelations ask for.
    fn flank(&mut self, node: Node<'a, 'a>) -> Result<BTreeMap<usize, Position>, String> {
        let mut required = Vec::new();
        for id in references(node, "additionalRelation") {
            let relation = self.xml.id(id).ok_or_else(|| format!("its relation {id} does not exist"))?;
            required.extend(children(relation, "requiredSwitchPosition"));
        }
        self.positions_of(required)
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
            let names_routes = references(node, "activeForApproachRoute").next().is_some();
            if found.is_empty() && !names_routes {
                let at = reference(node, "relatedToTrackAsset").and_then(|id| self.exit(id)).map(|(joint, _)| joint);
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
            let about = format!("overlap {id} for route {name}");
            match self.overlap(node, &routes[number], &about) {
                Ok(path) => {
                    let timer = node.descendants().find(|timer| timer.attribute("timerValue").is_some());
                    let timer = timer.map(|timer| self.time(timer, "timerValue", &about));
                    if timer.is_none() {
                        self.report
                            .defaulted
                            .push(format!("route {name}: stay time of [times]: overlap {id} has no release timer"));
                    }
                    routes[number].overlap = path;
                    routes[number].stay_ms = timer.flatten().map(At::derived);
                    given.insert(number, id);
                }
                Err(why) => self.report.lacking.push(format!("{about}: {why}; it is left out")),
            }
        }
    }

    /// The way of an overlap from the end of a route: over its sections, and to what limits it.
    fn overlap(&mut self, node: Node<'a, 'a>, route: &Route, about: &str) -> Result<Vec<At<Element>>, String> {
        let positions = self.positions(node, &["requiresSwitchInPosition"])?;
        let sections = self.sections(node)?;
        let mut limits = Vec::new();
        for id in references(node, "isLimitedBy") {
            limits.push(self.exit(id).ok_or_else(|| format!("its limit {id} has no place"))?);
        }
        if sections.is_empty() && limits.is_empty() {
            return Err("it names neither sections nor a limit".to_owned());
        }
        let (joint, last) = self.end_of(route).ok_or("the end of the route is not known")?;
        let first = self.placed.graph.across(joint, last).ok_or("the tracks end with the route")?;
        let within = (!sections.is_empty()).then_some((&sections, Extent::All));
        let mut ends: Vec<Option<(usize, f64)>> = limits.iter().copied().map(Some).collect();
        if within.is_some() {
            ends.push(None);
        }
        let mut ways = ends.into_iter().filter_map(|limit| {
            let exit = limit.map(|(joint, _)| joint);
            let sought = Sought { start: joint, first, exit, within, positions: &positions };
            search(&self.placed.graph, &sought).map(|found| (found, limit))
        });
        let (Found { way, alone }, limit) = ways
            .next()
            .ok_or("no way leads from the end of the route over its sections, or to its limit, with its switches")?;
        if limit.is_none() && !limits.is_empty() {
            self.report
                .defaulted
                .push(format!("{about}: its sections do not end at its limit; they are taken as they are"));
        }
        let beside = limit.map_or(0.0, |(_, beside)| beside);
        if beside > NEAR {
            self.report.defaulted.push(format!("{about}: it ends at the joint {beside:.0} m from its limit"));
        }
        if !alone {
            self.report.defaulted.push(format!("{about}: the file leaves more than one way; the shortest is taken"));
        }
        let mut path = self.path(&way);
        self.hold(&mut path, &way, &positions);
        Ok(path)
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
