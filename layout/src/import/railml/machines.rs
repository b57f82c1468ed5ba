//! What the machines of switches ask of routes: circuits in which a train fouls the switch, and what no layout holds.

use std::collections::BTreeSet;

use roxmltree::Node;

use super::circuits::Placed;
use super::infrastructure::Switched;
use super::xml::{Xml, children, is_set, reference};
use crate::at::At;
use crate::form::Station;
use crate::import::report::Report;

/// Children of a switchIL by which a switch depends on another one.
const DEPENDS: [&str; 2] = ["hasPositionRestriction", "relatedMovableElement"];

/// Writes where points are fouled, and bars those whose machine asks for what no layout holds: routes that hold them are left out.
pub fn write(xml: &Xml<'_>, placed: &mut Placed<'_>, station: &mut Station, report: &mut Report) {
    for machine in xml.all("switchIL") {
        let switch = reference(machine, "refersTo").and_then(|id| placed.switches.get(id));
        let points = match switch {
            Some(Switched::Point { point, .. }) => vec![*point],
            Some(Switched::Slip(points)) => points.to_vec(),
            None => continue,
        };
        let depends = DEPENDS.into_iter().find(|name| children(machine, name).next().is_some());
        let locked = is_set(machine, "isKeyLocked").then_some("isKeyLocked");
        if let Some(what) = depends.or(locked) {
            let why = format!("the {} has {what}, which no layout holds", Xml::at(machine));
            placed.barred.extend(points.iter().map(|point| (*point, why.clone())));
        }
        for detector in children(machine, "hasFoulingTrainDetectors") {
            for point in &points {
                let own = station.points[*point].circuit.value.clone();
                match fouled(xml, placed, station, detector, &own) {
                    Ok(circuits) => {
                        let told = circuits.iter().cloned().collect::<Vec<_>>().join(", ");
                        report.taken.push(format!("point {}: fouled in {told}", station.points[*point].name));
                        let given = &mut station.points[*point].fouled_in;
                        for name in circuits {
                            if given.iter().all(|other| other.value != name) {
                                given.push(At::derived(name));
                            }
                        }
                    }
                    Err(why) => {
                        let at = Xml::at(machine);
                        let why = format!("where a train fouls the switch of the {at} is not known: {why}");
                        placed.barred.insert(*point, why);
                    }
                }
            }
        }
    }
}

/// The circuits at a detector in the fouling area of a switch, without the one that the switch lies in.
fn fouled(
    xml: &Xml<'_>,
    placed: &Placed<'_>,
    station: &Station,
    detector: Node<'_, '_>,
    own: &str,
) -> Result<BTreeSet<String>, String> {
    let id = detector.attribute("ref").ok_or("a hasFoulingTrainDetectors refers to nothing")?;
    let asset = xml.referred(id).and_then(|node| node.attribute("id")).unwrap_or(id);
    let cut = placed.borders.get(asset).and_then(|name| placed.network.cuts.iter().position(|cut| cut.name == *name));
    let areas = match (cut, placed.sections.get(asset)) {
        (Some(cut), _) => placed.divided.beside(cut).into_iter().flatten().collect(),
        (None, Some(area)) => vec![*area],
        (None, None) => return Err(format!("no circuit is at the {}", xml.place(id))),
    };
    let names = areas.into_iter().map(|area| station.circuits[area].name.value.clone());
    Ok(names.filter(|name| name != own).collect())
}
