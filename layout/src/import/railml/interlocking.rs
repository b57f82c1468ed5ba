//! The interlocking of a railML file: routes, overlaps, conflicts, flank positions, release times.

use std::collections::{BTreeMap, BTreeSet};

use roxmltree::Node;

use super::circuits::Placed;
use super::infrastructure::{Spot, Switched};
use super::unread;
use super::xml::{Xml, child, children, duration, is_set, reference, references};
use crate::at::At;
use crate::form::{Element, Position, Route, Station};
use crate::graph::Way;
use crate::import::Report;
use crate::import::network::{Cut, Side};
use crate::import::search::{Found, Sought, search};

/// A joint so many metres in rear of a signal is at it. Beyond that, how far from its signal a route begins is remarked.
const NEAR: f64 = 1.0;

/// A joint at most so many metres in rear of a signal may be the one that belongs to it, if the route's sections say so.
const OFFSET: f64 = 20.0;

/// A joint at a signal, for trains in one direction.
struct Near {
    joint: usize,
    /// The circuit in rear of it.
    rear: usize,
    /// The circuit ahead; none at an end of the tracks.
    ahead: Option<usize>,
    /// How far from the signal it lies, in metres.
    beside: f64,
    /// Whether it lies in rear of the signal.
    behind: bool,
}

/// Where a route may begin.
struct Start {
    joint: usize,
    rear: usize,
    first: usize,
    beside: f64,
    behind: bool,
}

/// Where a route may end; anywhere without a joint.
struct End {
    joint: Option<usize>,
    /// The circuit that it comes from, where that is known.
    last: Option<usize>,
    beside: f64,
    behind: bool,
}

impl End {
    /// Whether a route ends here whose last circuit is this one.
    fn is(&self, joint: usize, last: usize) -> bool {
        self.joint == Some(joint) && self.last.is_none_or(|one| one == last)
    }
}

/// The course of a route: the circuit in rear of its signal, its way, and what is to be confirmed.
struct Course {
    rear: usize,
    way: Vec<(usize, Way)>,
    remarks: Vec<String>,
}

/// Writes the routes into `station`.
pub fn write<'a>(xml: &Xml<'a>, placed: &Placed<'a>, station: &mut Station, report: &mut Report) {
    let mut reader = Reader { xml, placed, station, report, names: BTreeMap::new() };
    let mut routes = Vec::new();
    let mut count = 0;
    for node in xml.all("route") {
        count += 1;
        let id = node.attribute("id").unwrap_or_default();
        match reader.route(node) {
            Ok(route) => {
                reader.names.insert(id, routes.len());
                routes.push(route);
            }
            Err(why) => reader.report.lacking.push(format!("{}: {why}; it is left out", Xml::at(node))),
        }
    }
    let bad = reader.overlaps(&mut routes);
    reader.conflicts(&mut routes);
    let mut number = 0..;
    routes.retain(|_| number.next().is_some_and(|number| !bad.contains(&number)));
    let left: BTreeSet<String> = routes.iter().map(|route| route.name.value.clone()).collect();
    for route in &mut routes {
        route.conflicts.retain(|other| left.contains(&other.value));
    }
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
    fn positions_of(&self, given: Vec<Node<'a, 'a>>) -> Result<BTreeMap<usize, Position>, String> {
        let mut found = BTreeMap::new();
        for node in given {
            let wrapped: Vec<Node<'a, 'a>> = children(node, "relatedSwitchAndPosition").collect();
            // Not left need not be right: what else there is, and whether all of it is negated, is not said.
            if let Some(negated) = node.descendants().find(|at| is_set(*at, "isNegated")) {
                return Err(format!("a position of it is negated ({})", Xml::at(negated)));
            }
            for node in if wrapped.is_empty() { vec![node] } else { wrapped } {
                let (point, position) = self.position(node)?;
                if found.insert(point, position).is_some_and(|before| before != position) {
                    return Err(format!("it asks for both positions of a switch ({})", Xml::at(node)));
                }
            }
        }
        Ok(found)
    }

    fn position(&self, node: Node<'a, 'a>) -> Result<(usize, Position), String> {
        let at = Xml::at(node);
        let id = reference(node, "refersToSwitch")
            .or_else(|| reference(node, "refersTo"))
            .ok_or_else(|| format!("a position of it names no switch ({at})"))?;
        let machine = self.xml.id(id).ok_or_else(|| format!("the switch {id} does not exist ({at})"))?;
        let switch = self.xml.referred(id).and_then(|switch| switch.attribute("id")).unwrap_or_default();
        let left = match node.attribute("inPosition") {
            Some("left") => true,
            Some("right") => false,
            other => return Err(format!("the position {:?} is neither left nor right ({at})", other.unwrap_or(""))),
        };
        let branch = |name| reference(machine, name).and_then(|id| self.placed.network.named(id));
        let branches = branch("branchLeft").zip(branch("branchRight"));
        let position = |is_normal: bool| if is_normal { Position::Normal } else { Position::Reverse };
        match self.placed.switches.get(switch) {
            Some(Switched::Point { point, left_is_normal }) => {
                let legs = self
                    .placed
                    .network
                    .legs(*point)
                    .map(|[one, other]| if *left_is_normal { (one, other) } else { (other, one) });
                if branches.zip(legs).is_some_and(|(said, there)| said != there) {
                    return Err(format!("the branches of the {} are not those of its switch", Xml::at(machine)));
                }
                Ok((*point, position(left == *left_is_normal)))
            }
            Some(Switched::Slip(points)) => {
                // One of its two machines: which, its branches say.
                let Some((one, other)) = branches else {
                    return Err(format!("the {} of a slip names no branchLeft and branchRight", Xml::at(machine)));
                };
                let wanted = if left { one } else { other };
                let legs = points.iter().filter_map(|point| Some((*point, self.placed.network.legs(*point)?)));
                let mut fitting = legs.filter(|(_, legs)| *legs == [one, other] || *legs == [other, one]);
                match (fitting.next(), fitting.next()) {
                    (Some((point, [normal, _])), None) => Ok((point, position(wanted == normal))),
                    _ => Err(format!("the branches of the {} are not those of its slip", Xml::at(machine))),
                }
            }
            None => Err(format!(
                "its position of the {} cannot be read: the switch is not one that was taken",
                Xml::at(machine)
            )),
        }
    }

    fn positions(&self, node: Node<'a, 'a>, names: &[&'a str]) -> Result<BTreeMap<usize, Position>, String> {
        self.positions_of(names.iter().flat_map(|name| children(node, name)).collect())
    }

    fn sections(&self, node: Node<'a, 'a>) -> Result<BTreeSet<usize>, String> {
        let placed = |id| {
            let found = self.placed.sections.get(id).copied();
            found.ok_or_else(|| format!("its section has no place ({})", self.xml.place(id)))
        };
        references(node, "hasTvdSection").map(placed).collect()
    }

    fn route(&mut self, node: Node<'a, 'a>) -> Result<Route, String> {
        let entry =
            child(node, "routeEntry").and_then(|entry| reference(entry, "refersTo")).ok_or("it has no routeEntry")?;
        let signal = self.xml.referred(entry).ok_or_else(|| format!("its routeEntry {entry} does not exist"))?;
        if let Some(what) = unread::asks(node) {
            return Err(format!("it has {what}, which no layout holds"));
        }
        let sections = self.sections(node)?;
        let mut positions = self.positions(node, &["facingSwitchInPosition", "trailingSwitchInPosition"])?;
        let exit = child(node, "routeExit").and_then(|exit| reference(exit, "refersTo"));
        if exit.is_none() && sections.is_empty() {
            return Err("it names neither sections nor an exit".to_owned());
        }
        let name = self.xml.name(node);
        let starts = self.starts(signal)?;
        let ends = exit.map(|exit| self.ends(exit)).transpose()?;
        let Course { rear, way, remarks } = self.course(&starts, ends.as_deref(), &sections, &positions)?;
        for remark in remarks {
            self.report.defaulted.push(format!("route {name}: {remark}"));
        }
        let passed: BTreeMap<usize, Position> =
            way.iter().flat_map(|(_, way)| &way.passed).map(|passed| (passed.point, passed.position)).collect();
        let absent = |pair: &&[(usize, Position); 2]| pair.iter().all(|(point, at)| passed.get(point) == Some(at));
        if self.placed.absent.iter().any(|pair| absent(&pair)) {
            return Err("it runs over a single slip where that has no way".to_owned());
        }
        let mut path = self.path(&way);
        positions.extend(self.flank(node)?);
        self.passable(&way, Some(rear), &positions)?;
        self.hold(&mut path, &way, &positions);
        let speed_kmh = self.placed.limits.on_way(&way, &self.placed.divided);
        if let Some(limit) = speed_kmh.filter(|limit| self.station.braking.speeds_kmh.iter().all(|code| code > limit)) {
            return Err(format!("its limit of {limit} km/h is below the lowest code"));
        }
        if speed_kmh.is_none() {
            let reverse =
                way.iter().flat_map(|(_, way)| &way.passed).any(|passed| passed.position == Position::Reverse);
            let what = if reverse { "the lowest speed, as it leads over a reverse point" } else { "speed of [speed]" };
            self.report.defaulted.push(format!("route {name}: {what}: the file limits none on it"));
        }
        let release_ms = self.release(node, &way, &name)?;
        // No train runs faster than the highest code.
        let speed_kmh = speed_kmh.filter(|limit| self.station.braking.speeds_kmh.iter().any(|code| code > limit));
        Ok(Route {
            name,
            signal: Some(self.xml.name(signal).value),
            entry: At::derived(self.circuit(rear)),
            path,
            release_ms,
            speed_kmh: speed_kmh.map(At::derived),
            ..Route::default()
        })
    }

    /// That no buffer stop stands on a way, and no machine of its points asks for what no layout holds.
    fn passable(
        &self,
        way: &[(usize, Way)],
        rear: Option<usize>,
        held: &BTreeMap<usize, Position>,
    ) -> Result<(), String> {
        let circuits: BTreeSet<usize> = way.iter().map(|(circuit, _)| *circuit).chain(rear).collect();
        let there =
            |edge: usize, at: f64| !self.placed.divided.along(edge, at - NEAR, at + NEAR).is_disjoint(&circuits);
        if let Some((.., stop)) = self.placed.inside.iter().find(|(edge, at, _)| there(*edge, *at)) {
            return Err(format!("the {stop} stands in its way"));
        }
        let passed = way.iter().flat_map(|(_, way)| &way.passed).map(|passed| passed.point);
        match passed.chain(held.keys().copied()).find_map(|point| self.placed.barred.get(&point)) {
            Some(why) => Err(why.clone()),
            None => Ok(()),
        }
    }

    /// The longest of the times that a route stays locked for: its own, and what its sections ask.
    fn release(&mut self, node: Node<'a, 'a>, way: &[(usize, Way)], name: &str) -> Result<Option<At<u32>>, String> {
        let own = time(node, "approachReleaseDelay")?;
        let mut residual = residual_time(node)?;
        for (circuit, _) in way {
            let sections = self.placed.sections.iter().filter(|(_, area)| *area == circuit);
            for node in sections.filter_map(|(id, _)| self.xml.id(id)) {
                residual = residual.max(residual_time(node)?);
            }
        }
        if own.is_none() {
            self.report
                .defaulted
                .push(format!("route {name}: release time of [times]: it has no approachReleaseDelay"));
        }
        let least = own.unwrap_or(self.station.times.release_ms.value);
        let longest = residual.map_or(least, |residual| residual.max(least));
        let most = self.station.times.cycle_ms.value.saturating_mul(60_000);
        if longest > most {
            return Err(format!("its release time of {longest} ms is more than 60 000 cycles, {most} ms"));
        }
        Ok((own.is_some() || longest > least).then_some(At::derived(longest)))
    }

    /// The one way of a route from one of these starts to one of these ends, over all of its sections but the one in rear of its signal.
    fn course(
        &self,
        starts: &[Start],
        ends: Option<&[End]>,
        sections: &BTreeSet<usize>,
        positions: &BTreeMap<usize, Position>,
    ) -> Result<Course, String> {
        let listed = |circuit| sections.contains(&circuit);
        let anywhere = [End { joint: None, last: None, beside: 0.0, behind: false }];
        let ends_or_any = ends.unwrap_or(&anywhere);
        // A listed section in which a signal stands near its begin is run over rather than left in rear. It is the other way round at an exit.
        for (start_behind, end_behind) in [(true, false), (true, true), (false, false), (false, true)] {
            let mut found: Vec<Course> = Vec::new();
            for start in starts.iter().filter(|start| start.behind == start_behind) {
                let mut over = sections.clone();
                over.remove(&start.rear);
                if start.behind && !listed(start.first) {
                    continue;
                }
                let within = (!sections.is_empty()).then_some(&over);
                for end in ends_or_any.iter().filter(|end| end.behind == end_behind) {
                    if end.behind && !end.last.is_some_and(listed) {
                        continue;
                    }
                    let sought = Sought {
                        start: start.joint,
                        first: start.first,
                        exit: end.joint,
                        last: end.last,
                        within,
                        positions,
                    };
                    let Some(Found { way, alone }) = search(&self.placed.graph, &sought) else { continue };
                    if !alone {
                        return Err("the file leaves more than one way for it".to_owned());
                    }
                    let mut remarks = Vec::new();
                    if start.beside > NEAR {
                        remarks.push(format!("it begins at the joint {:.0} m from its signal", start.beside));
                    }
                    if end.beside > NEAR {
                        remarks.push(format!("it ends at the joint {:.0} m from its exit", end.beside));
                    }
                    found.push(Course { rear: start.rear, way, remarks });
                }
            }
            if found.len() > 1 {
                let both =
                    "the file leaves more than one way for it: its signal or its exit may be for either direction";
                return Err(both.to_owned());
            }
            if let Some(course) = found.pop() {
                return Ok(course);
            }
        }
        Err(self.astray(starts, ends, sections, positions))
    }

    /// Why there is no such way: which sections lie elsewhere, if without them there is one.
    fn astray(
        &self,
        starts: &[Start],
        ends: Option<&[End]>,
        sections: &BTreeSet<usize>,
        positions: &BTreeMap<usize, Position>,
    ) -> String {
        let pairs = starts.iter().flat_map(|start| ends.into_iter().flatten().map(move |end| (start, end)));
        for (start, end) in pairs.filter(|(start, end)| !start.behind && !end.behind) {
            let sought = Sought {
                start: start.joint,
                first: start.first,
                exit: end.joint,
                last: end.last,
                within: None,
                positions,
            };
            let Some(Found { way, .. }) = search(&self.placed.graph, &sought) else { continue };
            let run_over: BTreeSet<usize> = way.iter().map(|(circuit, _)| *circuit).chain([start.rear]).collect();
            let named = |circuits: Vec<usize>| {
                let of = |circuit: &usize| self.placed.sections.iter().find(|(_, area)| *area == circuit);
                let told =
                    |circuit: usize| of(&circuit).map_or_else(|| self.circuit(circuit), |(id, _)| self.xml.place(id));
                circuits.into_iter().map(told).collect::<Vec<_>>().join("; ")
            };
            let apart = named(sections.difference(&run_over).copied().collect());
            let unnamed =
                named(way.iter().map(|(circuit, _)| *circuit).filter(|one| !sections.contains(one)).collect());
            return match (apart.as_str(), unnamed.as_str()) {
                (apart, "") => format!("sections that it lists do not lie between its signal and its exit: {apart}"),
                ("", unnamed) => format!("it runs over sections that it does not list: {unnamed}"),
                (apart, unnamed) => format!(
                    "sections that it lists do not lie between its signal and its exit: {apart}; it runs over others that it does not list: {unnamed}"
                ),
            };
        }
        "no way leads from its signal to its exit over its sections with its switches".to_owned()
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

    /// Where a route with this signal may begin: at the first joint at or beyond it for a train that it is for, or at one a little in rear of it.
    fn starts(&self, signal: Node<'a, 'a>) -> Result<Vec<Start>, String> {
        let spot = signal.attribute("id").and_then(|id| self.placed.signals.get(id));
        let spot = spot.ok_or_else(|| format!("its signal has no place on the tracks ({})", Xml::at(signal)))?;
        let directions = spot.toward_end.map_or_else(|| vec![true, false], |given| vec![given]);
        let joints = directions.into_iter().flat_map(|toward_end| self.joints_at(*spot, toward_end));
        let starts = joints.filter_map(|at| {
            Some(Start { joint: at.joint, rear: at.rear, first: at.ahead?, beside: at.beside, behind: at.behind })
        });
        let starts: Vec<Start> = starts.collect();
        if starts.is_empty() {
            return Err(format!("no joint lies at or beyond its signal before the next switch ({})", Xml::at(signal)));
        }
        Ok(starts)
    }

    /// Where a route may end that this is the exit of: at a detector or buffer stop, or at the first joint at or beyond a signal in the
    /// direction of travel, or at one a little in rear of it.
    fn ends(&self, id: &str) -> Result<Vec<End>, String> {
        let asset = self.xml.referred(id).ok_or_else(|| format!("its exit {id} does not exist"))?;
        let own = asset.attribute("id").unwrap_or_default();
        if let Some(name) = self.placed.borders.get(own) {
            let joint = self.placed.joints.get(name).copied();
            let joint = joint.ok_or_else(|| format!("its exit has no place on the tracks ({})", Xml::at(asset)))?;
            return Ok(vec![End { joint: Some(joint), last: None, beside: 0.0, behind: false }]);
        }
        let spot = self.placed.signals.get(own);
        let spot = spot.ok_or_else(|| format!("its exit has no place on the tracks ({})", Xml::at(asset)))?;
        let joints = [true, false].into_iter().flat_map(|toward_end| self.joints_at(*spot, toward_end));
        let ends: Vec<End> = joints
            .map(|at| End { joint: Some(at.joint), last: Some(at.rear), beside: at.beside, behind: at.behind })
            .collect();
        if ends.is_empty() {
            return Err(format!("no joint lies at or beyond its exit before the next switch ({})", Xml::at(asset)));
        }
        Ok(ends)
    }

    /// The first joint at or beyond a place for trains in this direction, and the last one in rear of it if it is near.
    fn joints_at(&self, spot: Spot, toward_end: bool) -> Vec<Near> {
        let placed = self.placed;
        let number = |name: &str| placed.joints.get(name).copied();
        let mut found = Vec::new();
        let (mut edge, mut toward_end, mut at) = (spot.edge, toward_end, spot.at);
        let mut run = 0.0;
        for step in 0..placed.network.edges.len() {
            let cuts = placed.network.cuts.iter().enumerate().filter(|(_, cut)| cut.edge == edge);
            // How far beyond the place a cut is.
            let beyond = |cut: &Cut| if toward_end { cut.at - at } else { at - cut.at };
            let areas = |cut: usize| {
                let [before, after] = placed.divided.beside(cut);
                if toward_end { (before, after) } else { (after, before) }
            };
            let slack = if step == 0 { -NEAR } else { 0.0 };
            let ahead = cuts.clone().filter(|(_, cut)| beyond(cut) >= slack);
            let ahead = ahead.min_by(|(_, one), (_, other)| beyond(one).total_cmp(&beyond(other)));
            let behind = cuts.filter(|(_, cut)| (-OFFSET..-NEAR).contains(&beyond(cut)));
            let behind = behind.max_by(|(_, one), (_, other)| beyond(one).total_cmp(&beyond(other)));
            if let Some((place, cut)) = behind.filter(|_| step == 0) {
                if let (Some(joint), (Some(rear), ahead)) = (number(&cut.name), areas(place)) {
                    found.push(Near { joint, rear, ahead, beside: beyond(cut).abs(), behind: true });
                }
            }
            if let Some((place, cut)) = ahead {
                if let (Some(joint), (Some(rear), ahead)) = (number(&cut.name), areas(place)) {
                    found.push(Near { joint, rear, ahead, beside: (run + beyond(cut)).abs(), behind: false });
                }
                break;
            }
            let side = if toward_end { Side::End } else { Side::Begin };
            let length = placed.network.edges[edge].length;
            run += if toward_end { length - at } else { at - placed.network.edges[edge].begin };
            let Some((next, side)) = placed.divided.linked((edge, side)) else {
                // An end of the tracks is one for a route, too.
                let end = placed.divided.end_at((edge, side));
                if let Some((Some(joint), rear)) = end.map(|(name, rear)| (number(name), rear)) {
                    found.push(Near { joint, rear, ahead: None, beside: run, behind: false });
                }
                break;
            };
            (edge, toward_end) = (next, side == Side::Begin);
            at = if toward_end { 0.0 } else { placed.network.edges[edge].length };
        }
        found
    }

    /// Positions of points that routeRelations ask for.
    fn flank(&self, node: Node<'a, 'a>) -> Result<BTreeMap<usize, Position>, String> {
        let mut required = Vec::new();
        for id in references(node, "additionalRelation") {
            let relation = self.xml.id(id).ok_or_else(|| format!("its relation {id} does not exist"))?;
            let mut asks = relation.children().map(|child| child.tag_name().name());
            let is_other = |what: &&str| what.starts_with("required") && *what != "requiredSwitchPosition";
            if let Some(what) = asks.find(is_other) {
                return Err(format!("the {} asks for a {what}, which no layout holds", Xml::at(relation)));
            }
            required.extend(children(relation, "requiredSwitchPosition"));
        }
        self.positions_of(required)
    }

    /// Gives routes their overlaps; those whose overlap cannot be read are returned: without it they would not be the file's. The one that a route's exit names before one that names the route, and that before one that
    /// names the place where the route ends. A route has one at most.
    fn overlaps(&mut self, routes: &mut [Route]) -> BTreeSet<usize> {
        let mut bad = BTreeSet::new();
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
                let at = reference(node, "relatedToTrackAsset").and_then(|id| self.ends(id).ok()).unwrap_or_default();
                let ends = |route: &Route| {
                    let end = self.end_of(route);
                    end.is_some_and(|(joint, last)| at.iter().any(|at| !at.behind && at.is(joint, last)))
                };
                found.extend((0..routes.len()).filter(|route| ends(&routes[*route])).map(|route| (2, route)));
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
            match self.overlap(node, &routes[number]) {
                Ok((path, timer)) => {
                    if timer.is_none() {
                        self.report
                            .defaulted
                            .push(format!("route {name}: stay time of [times]: overlap {id} has no release timer"));
                    }
                    routes[number].overlap = path;
                    routes[number].stay_ms = timer.map(At::derived);
                    given.insert(number, id);
                }
                Err(why) => {
                    self.report.lacking.push(format!("{about}: {why}; the route is left out ({})", Xml::at(node)));
                    bad.insert(number);
                }
            }
        }
        bad
    }

    /// The way of an overlap from the end of a route, over its sections and to what limits it; and the time of its release, in ms.
    fn overlap(&self, node: Node<'a, 'a>, route: &Route) -> Result<(Vec<At<Element>>, Option<u32>), String> {
        let positions = self.positions(node, &["requiresSwitchInPosition"])?;
        let sections = self.sections(node)?;
        let mut limits = Vec::new();
        for id in references(node, "isLimitedBy") {
            limits.extend(self.ends(id)?);
        }
        if sections.is_empty() && limits.is_empty() {
            return Err("it names neither sections nor a limit".to_owned());
        }
        let (joint, last) = self.end_of(route).ok_or("the end of the route is not known")?;
        let first = self.placed.graph.across(joint, last).ok_or("the tracks end with the route")?;
        let within = (!sections.is_empty()).then_some(&sections);
        // What its sections say is enough; where it names none, its limit says how far it goes.
        let anywhere = vec![End { joint: None, last: None, beside: 0.0, behind: false }];
        let ends = if within.is_some() { &anywhere } else { &limits };
        let ways = ends.iter().filter(|end| !end.behind).filter_map(|end| {
            let sought = Sought { start: joint, first, exit: end.joint, last: end.last, within, positions: &positions };
            search(&self.placed.graph, &sought)
        });
        let ways: Vec<Found> = ways.collect();
        let [Found { way, alone: true }] = ways.as_slice() else {
            let none = "no way leads from the end of the route over its sections, or to its limit, with its switches";
            return Err(if ways.is_empty() { none } else { "the file leaves more than one way for it" }.to_owned());
        };
        let mut path = self.path(way);
        self.passable(way, None, &positions)?;
        self.hold(&mut path, way, &positions);
        let timer = node.descendants().find(|timer| timer.attribute("timerValue").is_some());
        Ok((path, timer.map(|timer| time(timer, "timerValue")).transpose()?.flatten()))
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
            let known = |name| reference(conflict, name).is_some_and(|id| self.xml.id(id).is_some());
            if !known("refersToRoute") || !known("conflictsWithRoute") {
                self.report.lacking.push(format!("a route of the {}: it does not exist", Xml::at(conflict)));
            }
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

/// The time that a route or a section stays locked for when a route is cancelled, in ms: railML 3.1 and 3.2 have a name for it each.
fn residual_time(node: Node<'_, '_>) -> Result<Option<u32>, String> {
    Ok(time(node, "residualRouteCancellationDelay")?.max(time(node, "residualRouteReleaseDelay")?))
}

/// A time that an attribute gives, in ms.
fn time(node: Node<'_, '_>, attribute: &str) -> Result<Option<u32>, String> {
    let Some(text) = node.attribute(attribute) else { return Ok(None) };
    let none = || format!("the {attribute} {text:?} is no time that can be read ({})", Xml::at(node));
    duration(text).map(Some).ok_or_else(none)
}
