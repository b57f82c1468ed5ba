//! Where routes begin and end: at the joints at a signal, a detector or a buffer stop.

use roxmltree::Node;

use super::reader::Reader;
use crate::form::Route;
use crate::graph::Way;
use crate::import::joints::{Near, near};
use crate::import::railml::infrastructure::Spot;
use crate::import::railml::xml::Xml;

pub(super) use crate::import::joints::NEAR;

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

    fn joints_at(&self, spot: Spot, toward_end: bool) -> Vec<Near> {
        near(&self.placed.network, &self.placed.divided, &self.placed.joints, (spot.edge, spot.at), toward_end)
    }
}
