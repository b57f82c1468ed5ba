//! Where routes begin and end: at the joints at a signal, a detector or a buffer stop.

use roxmltree::Node;

use super::reader::Reader;
use crate::form::Route;
use crate::graph::Way;
use crate::import::network::{Cut, Side};
use crate::import::railml::infrastructure::Spot;
use crate::import::railml::xml::Xml;

/// A joint so many metres in rear of a signal is at it. Beyond that, how far from its signal a route begins is remarked.
pub(super) const NEAR: f64 = 1.0;

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
pub(super) struct Start {
    pub(super) joint: usize,
    pub(super) rear: usize,
    pub(super) first: usize,
    pub(super) beside: f64,
    pub(super) behind: bool,
}

/// Where a route may end; anywhere without a joint.
pub(super) struct End {
    pub(super) joint: Option<usize>,
    /// The circuit that it comes from, where that is known.
    pub(super) last: Option<usize>,
    pub(super) beside: f64,
    pub(super) behind: bool,
}

impl End {
    /// Whether a route ends here whose last circuit is this one.
    pub(super) fn is(&self, joint: usize, last: usize) -> bool {
        self.joint == Some(joint) && self.last.is_none_or(|one| one == last)
    }
}

impl<'a> Reader<'a, '_> {
    /// Where a route with this signal may begin: at the first joint at or beyond it for a train that it is for, or at one a little in rear of it.
    pub(super) fn starts(&self, signal: Node<'a, 'a>) -> Result<Vec<Start>, String> {
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
    pub(super) fn ends(&self, id: &str) -> Result<Vec<End>, String> {
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

    /// The joint at the end of a route, and its last circuit.
    pub(super) fn end_of(&self, route: &Route) -> Option<(usize, usize)> {
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
}
