//! What a path covers, and where its signals stand.

use std::collections::{BTreeMap, BTreeSet};

use roxmltree::Node;

use super::Reader;
use crate::form::Position;
use crate::graph::Way;
use crate::import::joints::{NEAR, Near, OFFSET, near};
use crate::import::planpro::file::{Place, Stretch, at, places, stretches};
use crate::import::planpro::tracks::AT_NODE;

impl<'a> Reader<'a, '_> {
    /// The signal at an end of a path, with the one place and direction that it has.
    pub(super) fn signal(&self, course: Node<'a, 'a>, name: &str) -> Result<(Node<'a, 'a>, Place), String> {
        let signal = self.file.referred(course, name).filter(|node| node.tag_name().name() == "Signal");
        let signal = signal.ok_or_else(|| format!("its {name} is no Signal of the file"))?;
        match <[Place; 1]>::try_from(places(signal)) {
            Ok([place]) if place.toward_end.is_some() => Ok((signal, place)),
            Ok(_) => Err(format!("the {} is for no one direction", at(signal))),
            Err(several) => Err(format!("the {} stands at {} places", at(signal), several.len())),
        }
    }

    /// The stretches that a path covers: on tracks of the file, and with nothing on them that no layout holds.
    pub(super) fn covered(&self, course: Node<'a, 'a>) -> Result<Vec<Stretch>, String> {
        let covered = stretches(course)?;
        for stretch in &covered {
            let top = self.placed.tracks.edges.get(&stretch.edge);
            if !top.is_some_and(|top| stretch.to <= top.length + AT_NODE && stretch.from >= -AT_NODE) {
                return Err(format!(
                    "it lies on {} from {} to {} m, which is no track",
                    stretch.edge, stretch.from, stretch.to
                ));
            }
            for (edge, from, to) in self.placed.tracks.parts(stretch) {
                let given = &self.placed.tracks.network.edges[edge];
                if from < given.begin - AT_NODE || to > given.length + AT_NODE {
                    return Err("a buffer stop stands on its way".to_owned());
                }
            }
            let there = |on: &Stretch| {
                on.edge == stretch.edge && on.from <= stretch.to + AT_NODE && on.to >= stretch.from - AT_NODE
            };
            if let Some(obstacle) = self.placed.tracks.obstacles.iter().find(|one| there(&one.on)) {
                return Err(format!("on it, {}", obstacle.what));
            }
        }
        Ok(covered)
    }

    /// The joint that belongs to a signal: the first one at or beyond it, if it is near and none lies a little in rear of it.
    pub(super) fn joint(&self, place: &Place, whose: &str) -> Result<Near, String> {
        let tracks = &self.placed.tracks;
        let spot = tracks.spot(place).ok_or_else(|| format!("{whose} has no place on the tracks"))?;
        let toward_end = place.toward_end.unwrap_or(true);
        let found = near(&tracks.network, &self.placed.divided, &self.placed.joints, spot, toward_end);
        let behind = found.iter().find(|one| one.behind).map(|one| one.beside);
        let ahead = found.into_iter().find(|one| !one.behind);
        match (ahead, behind) {
            (Some(ahead), _) if ahead.beside <= NEAR => Ok(ahead),
            (_, Some(behind)) => {
                Err(format!("a border of sections lies {behind:.0} m in rear of {whose}, and none at it"))
            }
            // At the end of the tracks there is no other one.
            (Some(ahead), None) if ahead.beside <= OFFSET || ahead.ahead.is_none() => Ok(ahead),
            (Some(ahead), None) => {
                Err(format!("the first border of sections beyond {whose} lies {:.0} m from it", ahead.beside))
            }
            (None, None) => Err(format!("no border of sections lies at or beyond {whose} before the next point")),
        }
    }

    /// The positions of the points that stretches run over.
    pub(super) fn positions(&self, covered: &[Stretch]) -> Result<BTreeMap<usize, Position>, String> {
        let tracks = &self.placed.tracks;
        let mut found = BTreeMap::new();
        for (node, fork) in &tracks.forks {
            let touched = |port: &str| {
                tracks.at_node(node).into_iter().filter(|(.., at)| *at == port).any(|(edge, is_b, _)| {
                    let length = tracks.edges[edge].length;
                    covered.iter().any(|stretch| {
                        stretch.edge == edge
                            && if is_b { stretch.to >= length - AT_NODE } else { stretch.from <= AT_NODE }
                    })
                })
            };
            match (touched("Spitze"), touched("Links"), touched("Rechts")) {
                (true, left, right) if left != right => {
                    let position = if left == fork.left_is_normal { Position::Normal } else { Position::Reverse };
                    found.insert(fork.point, position);
                }
                (false | true, false, false) | (false, true, false) | (false, false, true) => {}
                _ => return Err(format!("it runs over both legs of {}", tracks.network.switches[fork.point].name)),
            }
        }
        Ok(found)
    }

    /// The circuits that stretches run through, by more than a metre.
    pub(super) fn touched(&self, covered: &[Stretch]) -> BTreeSet<usize> {
        let parts: Vec<(usize, f64, f64)> =
            covered.iter().flat_map(|stretch| self.placed.tracks.parts(stretch)).collect();
        let is_touched = |area: &usize| {
            self.placed.divided.pieces_of(*area).any(|(edge, from, to)| {
                parts.iter().any(|(on, low, high)| *on == edge && high.min(to) - low.max(from) > NEAR)
            })
        };
        (0..self.placed.divided.areas.len()).filter(is_touched).collect()
    }

    /// That each circuit of a way and the one in rear of it is detected, and each of its points can be set.
    pub(super) fn sound<'c>(
        &self,
        way: &[(usize, Way)],
        rear: Option<usize>,
        held: impl Iterator<Item = &'c usize>,
    ) -> Result<(), String> {
        for circuit in way.iter().map(|(circuit, _)| *circuit).chain(rear) {
            if let Some(why) = self.placed.unsound.get(&circuit) {
                return Err(format!("{}: {why}", self.circuit(circuit)));
            }
        }
        let passed = way.iter().flat_map(|(_, way)| &way.passed).map(|passed| passed.point);
        match passed.chain(held.copied()).find_map(|point| self.placed.tracks.barred.get(&point)) {
            Some(why) => Err(why.clone()),
            None => Ok(()),
        }
    }
}
