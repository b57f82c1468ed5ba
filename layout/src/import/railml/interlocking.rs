//! The interlocking of a railML file: routes, overlaps, conflicts, flank positions, release times.

use std::collections::{BTreeMap, BTreeSet};

use super::circuits::Placed;
use super::xml::{Xml, reference};
use crate::at::At;
use crate::form::{Route, Station};
use crate::import::report::Report;
use reader::Reader;

mod course;
mod ends;
mod kind;
mod overlap;
mod reader;
mod route;

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
    if let Some(only) = kind::only_type(xml).filter(|only| !kind::is_told(xml, only)) {
        reader.report.defaulted.push(format!("all routes are of the type {only}: they are taken to be for trains"));
    }
    if count == 0 {
        report.lacking.push("routes: the file has none, so the layout can be drawn, but nothing can be set".to_owned());
    }
    report.taken.push(format!("{} of {count} routes", routes.len()));
    station.routes = routes;
}

impl Reader<'_, '_> {
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
