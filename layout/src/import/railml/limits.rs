//! Speed limits of a railML file: of the branches of switches, and of sections of the tracks.

use std::collections::{BTreeMap, BTreeSet};

use super::infrastructure::Places;
use super::xml::{Xml, child, children, number};
use crate::form::Position;
use crate::graph::Way;
use crate::import::Report;
use crate::import::network::Divided;

/// What the file says of speeds, in km/h, rounded down.
#[derive(Debug, Default)]
pub struct Limits {
    /// Of the legs of points, by number.
    pub branches: BTreeMap<(usize, Position), u16>,
    /// Of stretches of edges: edge, metres from its begin, limit. They hold for either direction.
    stretches: Vec<(usize, f64, f64, u16)>,
}

impl Limits {
    /// Reads the sections of speed.
    pub fn read(xml: &Xml<'_>, places: &Places<'_>, report: &mut Report) -> Self {
        let mut stretches = Vec::new();
        for section in xml.all("speedSection") {
            // What cannot be read may be anything: no route is taken over it. What cannot be placed may be anywhere.
            let limit = section.attribute("maxSpeed").and_then(kmh).unwrap_or_else(|| {
                report.lacking.push(format!("a speed of the {}: its maxSpeed is no number above 0", Xml::at(section)));
                0
            });
            let mut anywhere = |why: &str| {
                report
                    .lacking
                    .push(format!("a place for the {}: {why}; {limit} km/h hold everywhere", Xml::at(section)));
                places.edges().map(|(edge, length)| (edge, 0.0, length, limit)).collect::<Vec<_>>()
            };
            let locations = ["linearLocation", "areaLocation"].into_iter().flat_map(|name| children(section, name));
            let on: Vec<_> = locations.flat_map(|at| children(at, "associatedNetElement")).collect();
            if on.is_empty() {
                stretches.extend(anywhere("it names no net element"));
            }
            for at in on {
                let Some((edge, length)) = at.attribute("netElementRef").and_then(|id| places.edge(id)) else {
                    stretches.extend(anywhere("its net element is not known"));
                    continue;
                };
                let place = |share: &str, metres: &str, linear: &str| {
                    let by_share = number(at, share).map(|share| share * length);
                    let by_metres = number(at, metres);
                    by_share.or(by_metres).or_else(|| places.by_chainage(at, child(at, linear)?, length))
                };
                // Where it does not say, the whole element has the limit.
                let from = place("intrinsicCoordBegin", "posBegin", "linearCoordinateBegin").unwrap_or(0.0);
                let to = place("intrinsicCoordEnd", "posEnd", "linearCoordinateEnd").unwrap_or(length);
                stretches.push((edge, from.min(to), from.max(to), limit));
            }
        }
        Self { branches: BTreeMap::new(), stretches }
    }

    /// Enters the limits of a branch: it may be run over either way, so the lower one holds.
    pub fn branch(&mut self, point: usize, position: Position, branch: roxmltree::Node<'_, '_>) {
        let given = ["branchingSpeed", "joiningSpeed"].into_iter().filter_map(|name| branch.attribute(name));
        if let Some(limit) = given.map(|text| kmh(text).unwrap_or(0)).min() {
            let lowest = self.branches.entry((point, position)).or_insert(limit);
            *lowest = limit.min(*lowest);
        }
    }

    /// How many there are: of branches, and of stretches.
    pub fn count(&self) -> (usize, usize) {
        (self.branches.len(), self.stretches.len())
    }

    /// The lowest limit on a way, if any is given.
    pub fn on_way(&self, way: &[(usize, Way)], divided: &Divided) -> Option<u16> {
        let passed = way.iter().flat_map(|(_, way)| &way.passed);
        let branches = passed.filter_map(|passed| self.branches.get(&(passed.point, passed.position)).copied());
        branches.chain(self.in_circuits(&way.iter().map(|(circuit, _)| *circuit).collect(), divided)).min()
    }

    /// The lowest limit of a stretch in these circuits, if any is given.
    pub fn in_circuits(&self, circuits: &BTreeSet<usize>, divided: &Divided) -> Option<u16> {
        let touched = |(edge, from, to, _): &&(usize, f64, f64, u16)| {
            divided.along(*edge, *from, *to).intersection(circuits).next().is_some()
        };
        self.stretches.iter().filter(touched).map(|(.., limit)| *limit).min()
    }
}

/// Whole km/h, rounded down; nothing if it is no speed.
fn kmh(text: &str) -> Option<u16> {
    let speed = text.trim().parse::<f64>().ok().filter(|speed| speed.is_finite() && *speed >= 1.0)?;
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "it is in the range of the type")]
    let whole = speed.floor().min(f64::from(u16::MAX)) as u16;
    Some(whole)
}

#[cfg(test)]
mod tests {
    use super::kmh;

    #[test]
    fn a_speed_is_rounded_down_and_nonsense_is_none() {
        assert_eq!(["60", "62.9", "1e9"].map(kmh), [Some(60), Some(62), Some(u16::MAX)]);
        assert_eq!(["0", "-5", "NaN", "fast", ""].map(kmh), [None; 5]);
    }
}
