//! What reads routes and overlaps: the file, what was placed of it, and the sections and switch positions that it names.

use std::collections::{BTreeMap, BTreeSet};

use roxmltree::Node;

use crate::form::{Position, Station};
use crate::import::railml::circuits::Placed;
use crate::import::railml::infrastructure::Switched;
use crate::import::railml::xml::{Xml, children, duration, is_set, reference, references};
use crate::import::report::Report;

pub(super) struct Reader<'a, 'b> {
    pub(super) xml: &'b Xml<'a>,
    pub(super) placed: &'b Placed<'a>,
    pub(super) station: &'b Station,
    pub(super) report: &'b mut Report,
    /// Routes by id.
    pub(super) names: BTreeMap<&'a str, usize>,
}

impl<'a> Reader<'a, '_> {
    pub(super) fn circuit(&self, number: usize) -> String {
        self.station.circuits[number].name.value.clone()
    }

    pub(super) fn sections(&self, node: Node<'a, 'a>) -> Result<BTreeSet<usize>, String> {
        let placed = |id| {
            let found = self.placed.sections.get(id).copied();
            found.ok_or_else(|| format!("its section has no place ({})", self.xml.place(id)))
        };
        references(node, "hasTvdSection").map(placed).collect()
    }

    pub(super) fn positions(&self, node: Node<'a, 'a>, names: &[&'a str]) -> Result<BTreeMap<usize, Position>, String> {
        self.positions_of(names.iter().flat_map(|name| children(node, name)).collect())
    }

    /// The positions that these elements give for switches, as those of points: one each, or several in wrappers.
    pub(super) fn positions_of(&self, given: Vec<Node<'a, 'a>>) -> Result<BTreeMap<usize, Position>, String> {
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
}

/// A time that an attribute gives, in ms.
pub(super) fn time(node: Node<'_, '_>, attribute: &str) -> Result<Option<u32>, String> {
    let Some(text) = node.attribute(attribute) else { return Ok(None) };
    let none = || format!("the {attribute} {text:?} is no time that can be read ({})", Xml::at(node));
    duration(text).map(Some).ok_or_else(none)
}
