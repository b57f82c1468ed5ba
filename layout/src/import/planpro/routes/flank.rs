//! The flank protection that the file gives a route.

use std::collections::{BTreeMap, BTreeSet};

use roxmltree::Node;

use super::Reader;
use crate::form::Position;
use crate::import::planpro::file::{at, child, is_set, value};

impl<'a> Reader<'a, '_> {
    /// The positions that protect the flank of a path, and the circuits that are proved clear for it.
    pub(super) fn flank(
        &self,
        passed: &BTreeMap<usize, Position>,
        proved: &mut BTreeSet<usize>,
    ) -> Result<BTreeMap<usize, Position>, String> {
        let tracks = &self.placed.tracks;
        let mut held = BTreeMap::new();
        for (point, position) in passed {
            let Some(fork) = tracks.forks.values().find(|fork| fork.point == *point) else { continue };
            let other = if (*position == Position::Normal) == fork.left_is_normal { "rechts" } else { "links" };
            // One that does not say over which leg is for both.
            for protection in self.protections(*point, |over| over != Some(other) && over != Some("Spitze")) {
                self.protect(protection, &mut held, proved, 0)?;
            }
        }
        // What is passed on over the toe of a point that protects is for those that count on it.
        let mut asked = BTreeSet::new();
        while let Some(point) = held.keys().copied().find(|point| !asked.contains(point)) {
            asked.insert(point);
            for protection in self.protections(point, |over| over == Some("Spitze")) {
                self.protect(protection, &mut held, proved, 0)?;
            }
        }
        let against = |(point, position): &(&usize, &Position)| passed.get(*point).is_some_and(|own| own != *position);
        if let Some((point, _)) = held.iter().find(against) {
            return Err(format!("its flank asks for the other position of {}", tracks.network.switches[*point].name));
        }
        held.retain(|point, _| !passed.contains_key(point));
        Ok(held)
    }

    /// What a point asks for its flank, by over which of its edges.
    pub(super) fn protections(&self, point: usize, over: impl Fn(Option<&str>) -> bool) -> Vec<Node<'a, 'a>> {
        let elements = &self.placed.tracks.elements;
        let Some((id, _)) = elements.iter().find(|(_, points)| points.contains(&point)) else { return Vec::new() };
        let asks = |node: &Node<'a, 'a>| {
            let by = value(*node, &["Fla_Schutz_Anforderer", "ID_Anforderer_Element"]);
            by.is_some_and(|by| by.eq_ignore_ascii_case(id))
                && over(value(*node, &["Fla_Schutz_Anforderer", "Fahrt_Ueber"]))
        };
        self.file.all("Fla_Schutz").filter(asks).collect()
    }

    pub(super) fn protect(
        &self,
        protection: Node<'a, 'a>,
        held: &mut BTreeMap<usize, Position>,
        proved: &mut BTreeSet<usize>,
        depth: usize,
    ) -> Result<(), String> {
        if depth > 16 {
            return Err(format!("the {} is passed on in a ring", at(protection)));
        }
        if is_set(protection, &["Fla_Schutz_Anforderer", "EKW_Kr_Anteil"]) {
            return Err(format!("the {} is of a slip, which is not read", at(protection)));
        }
        if let Some(by) = child(protection, "Fla_Schutz_W_Gsp") {
            let element = value(by, &["ID_Fla_W_Gsp_Element"]).unwrap_or_default().to_lowercase();
            let side = value(by, &["Fla_W_Lage"]);
            let points = self.placed.tracks.elements.get(&element).map(Vec::as_slice).unwrap_or_default();
            let fork =
                points.first().and_then(|point| self.placed.tracks.forks.values().find(|fork| fork.point == *point));
            match (points, fork, side) {
                ([point], Some(fork), Some(side @ ("links" | "rechts"))) => {
                    let position =
                        if (side == "links") == fork.left_is_normal { Position::Normal } else { Position::Reverse };
                    if held.insert(*point, position).is_some_and(|before| before != position) {
                        return Err(format!("the {} asks for both positions of a point", at(protection)));
                    }
                }
                _ => {
                    return Err(format!(
                        "the {} asks for what is no point of the layout in one position",
                        at(protection)
                    ));
                }
            }
        }
        let id = value(protection, &["Identitaet"]).unwrap_or_default().to_lowercase();
        for clear in self.file.all("Fla_Freimelde_Zuordnung") {
            let is_own = value(clear, &["ID_Fla_Schutz"]).is_some_and(|of| of.to_lowercase() == id);
            if is_own && is_set(clear, &["Fla_Raum_Freimeldung"]) {
                let section = value(clear, &["ID_FMA_Anlage"]).unwrap_or_default().to_lowercase();
                let circuit = self.placed.sections.get(&section);
                proved.insert(*circuit.ok_or_else(|| format!("the {} names a section that is no circuit", at(clear)))?);
            }
        }
        let onward = child(protection, "Fla_Schutz_Weitergabe");
        if onward.is_some_and(|onward| !onward.children().any(|child| value(child, &[]).is_some())) {
            return Err(format!("the {} is passed on to nothing", at(protection)));
        }
        for name in ["ID_Fla_Weitergabe_L", "ID_Fla_Weitergabe_R"] {
            let Some(id) = value(protection, &["Fla_Schutz_Weitergabe", name]) else { continue };
            let next = self
                .file
                .id(id)
                .ok_or_else(|| format!("the {} is passed on to what is not in the file", at(protection)))?;
            self.protect(next, held, proved, depth + 1)?;
        }
        Ok(())
    }
}
