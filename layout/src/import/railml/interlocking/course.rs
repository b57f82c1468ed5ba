//! The course of a route or an overlap: its one way over the tracks, and what the layout holds along it.

use std::collections::{BTreeMap, BTreeSet};

use super::ends::{End, NEAR, Start};
use super::reader::Reader;
use crate::at::At;
use crate::form::{Element, Position};
use crate::graph::Way;
use crate::import::search::{Found, Sought, search};
use crate::import::way::{hold, path};

/// The course of a route: the circuit in rear of its signal, its way, and what is to be confirmed.
pub(super) struct Course {
    pub(super) rear: usize,
    pub(super) way: Vec<(usize, Way)>,
    pub(super) remarks: Vec<String>,
}

impl Reader<'_, '_> {
    /// The one way of a route from one of these starts to one of these ends, over all of its sections but the one in rear of its signal.
    pub(super) fn course(
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

    pub(super) fn path(&self, way: &[(usize, Way)]) -> Vec<At<Element>> {
        path(self.station, way)
    }

    pub(super) fn hold(&self, path: &mut [At<Element>], way: &[(usize, Way)], positions: &BTreeMap<usize, Position>) {
        hold(self.station, path, way, positions);
    }

    /// That no buffer stop stands on a way, and no machine of its points asks for what no layout holds.
    pub(super) fn passable(
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
}
