//! The overlap of a route, and what is locked with it.

use std::collections::{BTreeMap, BTreeSet};

use roxmltree::Node;

use super::Reader;
use super::conditions::{OF_OVERLAP, OF_SPECIAL, known};
use crate::at::At;
use crate::form::{Position, Route};
use crate::import::joints::{NEAR, OFFSET};
use crate::import::planpro::file::{at, child, figure, value, values};
use crate::import::search::{Found, Sought, search};
use crate::import::way::path;

/// A figure that may be left out.
///
/// # Errors
/// It is there and cannot be read.
pub(super) fn figure_of(node: Node<'_, '_>, path: &[&str]) -> Result<Option<f64>, String> {
    let Some(text) = value(node, path) else { return Ok(None) };
    let name = path.last().copied().unwrap_or_default();
    figure(node, path).map(Some).ok_or_else(|| format!("its {name} {text:?} is no number"))
}

/// Where a route ends and its overlap begins.
pub(super) struct From<'a> {
    /// The signal there.
    pub(super) signal: Node<'a, 'a>,
    /// The joint that belongs to it.
    pub(super) joint: usize,
    /// The last circuit of the route.
    pub(super) circuit: usize,
}

impl<'a> Reader<'a, '_> {
    /// The overlap of a route, from its last joint and circuit on.
    pub(super) fn overlap(
        &mut self,
        route: &mut Route,
        node: Node<'a, 'a>,
        from: &From<'a>,
        own: &BTreeSet<usize>,
    ) -> Result<(), String> {
        let course = self.file.referred(node, "ID_Fstr_Fahrweg").ok_or("its Fstr_Fahrweg is not in the file")?;
        if value(course, &["ID_Start"]).and_then(|id| self.file.id(id)) != Some(from.signal) {
            return Err(format!("it does not begin at the {}, where the route ends", at(from.signal)));
        }
        known(node, OF_OVERLAP)?;
        child(node, "Fstr_DWeg_Spezifisch").map_or(Ok(()), |special| known(special, OF_SPECIAL))?;
        self.unreferred(node)?;
        self.unreferred(course)?;
        let target = self.file.referred(course, "ID_Ziel");
        let asks = |child: &Node<'_, '_>| child.tag_name().name().ends_with("Erlaubnisabhaengig");
        if target.is_some_and(|target| target.children().any(|child| asks(&child))) {
            return Err("it depends on the direction of a line".to_owned());
        }
        let covered = self.covered(course)?;
        let length: f64 = covered.iter().map(|stretch| stretch.to - stretch.from).sum();
        let asked = figure_of(node, &["Fstr_DWeg_Allg", "Laenge_Soll"])?.unwrap_or(0.0);
        if asked > length + NEAR {
            return Err(format!("it is {length:.0} m long, and {asked} m are asked for"));
        }
        let mut within = self.touched(&covered);
        for id in values(node, "ID_FMA_Anlage_Freimeldung") {
            let circuit = self.placed.sections.get(&id.to_lowercase()).copied();
            within.insert(circuit.ok_or_else(|| format!("the section {id} that is proved clear is no circuit"))?);
        }
        within.retain(|circuit| !own.contains(circuit));
        // What lies in rear of the border at the signal is the route's own.
        let parts: Vec<_> = covered.iter().flat_map(|stretch| self.placed.tracks.parts(stretch)).collect();
        let pieces = within.iter().flat_map(|area| self.placed.divided.pieces_of(*area));
        let beyond: f64 = pieces
            .flat_map(|(edge, from, to)| {
                let same = parts.iter().filter(move |(on, ..)| *on == edge);
                same.map(move |(_, low, high)| (high.min(to) - low.max(from)).max(0.0))
            })
            .sum();
        if asked > beyond + OFFSET + NEAR {
            let beyond = beyond.abs();
            return Err(format!("{beyond:.0} m of it lie beyond the end of the route, and {asked} m are asked for"));
        }
        let seconds = figure_of(node, &["Fstr_DWeg_Spezifisch", "Aufloesung_Verzoegerung"])?.filter(|time| *time > 0.0);
        let name = route.name.value.clone();
        let positions = self.positions(&covered)?;
        let mut passed: BTreeSet<usize> = BTreeSet::new();
        if !within.is_empty() {
            let first = self.placed.graph.across(from.joint, from.circuit).ok_or("the tracks end with the route")?;
            let sought = Sought {
                start: from.joint,
                first,
                exit: None,
                last: None,
                within: Some(&within),
                positions: &positions,
            };
            let Some(Found { way, alone }) = search(&self.placed.graph, &sought) else {
                return Err("no way leads over what it covers from the end of the route".to_owned());
            };
            self.sound(&way, None, [].iter())?;
            if !alone {
                let what = "points beyond the end of its overlap are held in one position";
                self.report.defaulted.push(format!("route {name}: {what}"));
            }
            for one in way.iter().flat_map(|(_, way)| &way.passed) {
                let name = &self.station.points[one.point].name.value;
                let given = route.path.iter().filter_map(|place| place.value.points.get(name));
                if given.into_iter().any(|position| position.value != one.position) {
                    return Err(format!("the path, or its flank, asks for the other position of {name}"));
                }
            }
            passed.extend(way.iter().flat_map(|(_, way)| &way.passed).map(|passed| passed.point));
            route.overlap = path(self.station, &way);
            match seconds {
                Some(seconds) => {
                    #[expect(
                        clippy::cast_possible_truncation,
                        clippy::cast_sign_loss,
                        reason = "clamped to the range of the type"
                    )]
                    let ms = (seconds * 1000.0).ceil().clamp(1.0, 1e9) as u32;
                    route.stay_ms = Some(At::derived(ms));
                }
                None => {
                    self.report.defaulted.push(format!("route {name}: stay time of [times]: its overlap has no time"));
                }
            }
        }
        self.locked(route, node, &passed, &positions)
    }

    /// Has points be held with an overlap that it does not run over: in the position that the file gives, or in the normal one.
    pub(super) fn locked(
        &mut self,
        route: &mut Route,
        overlap: Node<'a, 'a>,
        passed: &BTreeSet<usize>,
        positions: &BTreeMap<usize, Position>,
    ) -> Result<(), String> {
        let id = value(overlap, &["Identitaet"]).unwrap_or_default();
        let own = |node: &Node<'a, 'a>| value(*node, &["ID_Fstr_DWeg"]).is_some_and(|of| of.eq_ignore_ascii_case(id));
        for node in self.file.all("Fstr_DWeg_W_Kr").filter(own) {
            if value(node, &["Element_Verschluss"]) == Some("false") {
                continue;
            }
            let element = value(node, &["ID_W_Kr_Gsp_Element"]).unwrap_or_default().to_lowercase();
            let point = match self.placed.tracks.elements.get(&element).map(Vec::as_slice) {
                Some([point]) => *point,
                _ => return Err(format!("the {} names what is no point of the layout", at(node))),
            };
            if let Some(why) = self.placed.tracks.barred.get(&point) {
                return Err(why.clone());
            }
            let name = self.station.points[point].name.value.clone();
            let held = route.path.iter().any(|place| place.value.points.contains_key(&name));
            if passed.contains(&point) || held {
                continue;
            }
            let position = positions.get(&point).copied().unwrap_or(Position::Normal);
            let what = "is held with its overlap in one position, though the overlap does not run over it";
            self.report.defaulted.push(format!("route {}: point {name} {what}", route.name));
            // Until the train has come to a stand: with the overlap, or with the last place.
            if let Some(place) = route.overlap.first_mut().or(route.path.last_mut()) {
                place.value.points.insert(name, At::derived(position));
            }
        }
        Ok(())
    }
}
