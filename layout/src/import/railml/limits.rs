//! Speed limits of a railML file: of the branches of switches, and of sections of the tracks.

use roxmltree::Node;

use super::places::{Places, apart};
use super::xml::{Xml, child, children, number};
use crate::form::Position;
use crate::import::limits::{Limits, kmh};
use crate::import::report::Report;

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
                match stretch(at, places) {
                    Ok((edge, from, to)) => stretches.push((edge, from, to, limit)),
                    Err(why) => stretches.extend(anywhere(&why)),
                }
            }
        }
        Self { stretches, ..Self::default() }
    }

    /// Enters the limits of a branch: it may be run over either way, so the lower one holds.
    pub fn branch(&mut self, point: usize, position: Position, branch: roxmltree::Node<'_, '_>) {
        let given = ["branchingSpeed", "joiningSpeed"].into_iter().filter_map(|name| branch.attribute(name));
        if let Some(limit) = given.map(|text| kmh(text).unwrap_or(0)).min() {
            self.leg(point, position, limit);
        }
    }
}

/// A place may be so many metres beyond the end of its net element: lengths are rounded.
const BEYOND: f64 = 1.0;

/// What is shorter, in metres, is a place and no stretch.
const SHORTEST: f64 = 1.0;

/// The stretch of a net element that has a limit: its edge, and metres from its begin. Where it does not say, it is the whole element.
fn stretch(at: Node<'_, '_>, places: &Places<'_>) -> Result<(usize, f64, f64), String> {
    let edge = at.attribute("netElementRef").and_then(|id| places.edge(id));
    let (edge, length) = edge.ok_or("its net element is not known")?;
    let begin = place(at, places, length, ["intrinsicCoordBegin", "posBegin", "linearCoordinateBegin"])?;
    let end = place(at, places, length, ["intrinsicCoordEnd", "posEnd", "linearCoordinateEnd"])?;
    let (begin, end) = (begin.unwrap_or(0.0), end.unwrap_or(length));
    if (end - begin).abs() < SHORTEST.min(length) {
        return Err(format!("it begins at {begin:.0} m of its net element, and ends there"));
    }
    Ok((edge, begin.min(end), begin.max(end)))
}

/// Metres from the begin of a net element, by a share of its length, by metres or by chainage; nothing where it says none.
///
/// # Errors
/// It cannot be read, the first two contradict each other, or it is not on the element: in another measure than it should be.
fn place(
    at: Node<'_, '_>,
    places: &Places<'_>,
    length: f64,
    [share, metres, linear]: [&str; 3],
) -> Result<Option<f64>, String> {
    let figure = |name: &str| {
        let none = || format!("its {name} {:?} is no number", at.attribute(name).unwrap_or_default());
        at.attribute(name).map(|_| number(at, name).ok_or_else(none)).transpose()
    };
    let by_share = figure(share)?.map(|share| share * length);
    let by_metres = figure(metres)?;
    if by_share.zip(by_metres).is_some_and(|(one, other)| apart(one, other, length)) {
        return Err(format!("its {share} and its {metres} are two places"));
    }
    let by_chainage = || {
        let none = || format!("its {linear} is none of its net element");
        child(at, linear).map(|node| places.by_chainage(at, node, length).ok_or_else(none)).transpose()
    };
    let Some(found) = by_share.or(by_metres).map_or_else(by_chainage, |found| Ok(Some(found)))? else {
        return Ok(None);
    };
    if !(-BEYOND..=length + BEYOND).contains(&found) {
        return Err(format!("{found:.0} m is not on its net element of {length:.0} m"));
    }
    Ok(Some(found.clamp(0.0, length)))
}
