//! The joints at a signal.

use std::collections::BTreeMap;

use super::network::{Cut, Divided, Network, Side};

/// A joint so many metres in rear of a signal is at it. Beyond that, how far from its signal a route begins is remarked.
pub const NEAR: f64 = 1.0;

/// A joint at most so many metres in rear of a signal may be the one that belongs to it, if the file says so.
pub const OFFSET: f64 = 20.0;

/// A joint at a signal, for trains in one direction.
pub struct Near {
    /// Its number in the graph.
    pub joint: usize,
    /// The circuit in rear of it.
    pub rear: usize,
    /// The circuit ahead; none at an end of the tracks.
    pub ahead: Option<usize>,
    /// How far from the signal it lies, in metres.
    pub beside: f64,
    /// Whether it lies in rear of the signal.
    pub behind: bool,
}

/// The first joint at or beyond a place for trains in this direction, before the next switch, and the last one in rear of it if it is near.
///
/// `joints` are those of the graph, by name; the place is an edge and metres from its begin.
pub fn near(
    network: &Network,
    divided: &Divided,
    joints: &BTreeMap<String, usize>,
    (mut edge, mut at): (usize, f64),
    mut toward_end: bool,
) -> Vec<Near> {
    let number = |name: &str| joints.get(name).copied();
    let mut found = Vec::new();
    let mut run = 0.0;
    for step in 0..network.edges.len() {
        let cuts = network.cuts.iter().enumerate().filter(|(_, cut)| cut.edge == edge);
        // How far beyond the place a cut is.
        let beyond = |cut: &Cut| if toward_end { cut.at - at } else { at - cut.at };
        let areas = |cut: usize| {
            let [before, after] = divided.beside(cut);
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
        let length = network.edges[edge].length;
        run += if toward_end { length - at } else { at - network.edges[edge].begin };
        let Some((next, side)) = divided.linked((edge, side)) else {
            // An end of the tracks is one for a route, too.
            let end = divided.end_at((edge, side));
            if let Some((Some(joint), rear)) = end.map(|(name, rear)| (number(name), rear)) {
                found.push(Near { joint, rear, ahead: None, beside: run, behind: false });
            }
            break;
        };
        (edge, toward_end) = (next, side == Side::Begin);
        at = if toward_end { 0.0 } else { network.edges[edge].length };
    }
    found
}
