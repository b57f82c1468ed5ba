//! The overlaps of the file: whose they are, and the way of each.

use std::collections::{BTreeMap, BTreeSet};

use roxmltree::Node;

use super::ends::End;
use super::reader::{Reader, time};
use crate::at::At;
use crate::form::{Element, Route};
use crate::import::railml::xml::{Xml, child, reference, references};
use crate::import::search::{Found, Sought, search};

impl<'a> Reader<'a, '_> {
    /// Gives routes their overlaps; those whose overlap cannot be read are returned: without it they would not be the file's. The one that a route's exit names before one that names the route, and that before one that
    /// names the place where the route ends. A route has one at most.
    pub(super) fn overlaps(&mut self, routes: &mut [Route]) -> BTreeSet<usize> {
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
}
