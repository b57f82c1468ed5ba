//! One route of the file: its course, its positions beside it, its speed and its release time.

use std::collections::BTreeMap;

use roxmltree::Node;

use super::course::Course;
use super::reader::{Reader, time};
use crate::at::At;
use crate::form::{Position, Route};
use crate::graph::Way;
use crate::import::limits::lowest;
use crate::import::railml::unread;
use crate::import::railml::xml::{Xml, child, children, reference, references};

impl<'a> Reader<'a, '_> {
    pub(super) fn route(&mut self, node: Node<'a, 'a>) -> Result<Route, String> {
        let entry =
            child(node, "routeEntry").and_then(|entry| reference(entry, "refersTo")).ok_or("it has no routeEntry")?;
        let signal = self.xml.referred(entry).ok_or_else(|| format!("its routeEntry {entry} does not exist"))?;
        if let Some(what) = unread::asks(node) {
            return Err(format!("it has {what}, which no layout holds"));
        }
        self.for_trains(node)?;
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
        let mut speed_kmh = self.placed.limits.on_way(&way, &self.placed.divided);
        if self.placed.limits.leaves_open(&way, &self.placed.network) && speed_kmh.is_some() {
            // A limit somewhere else says nothing of this leg.
            speed_kmh = speed_kmh.map(|limit| limit.min(lowest(self.station)));
            let what = "the lowest speed, as it leads over a reverse point that the file does not limit";
            self.report.defaulted.push(format!("route {name}: {what}"));
        }
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
}

/// The time that a route or a section stays locked for when a route is cancelled, in ms: railML 3.1 and 3.2 have a name for it each.
fn residual_time(node: Node<'_, '_>) -> Result<Option<u32>, String> {
    Ok(time(node, "residualRouteCancellationDelay")?.max(time(node, "residualRouteReleaseDelay")?))
}
