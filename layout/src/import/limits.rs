//! Limits of speed: of the legs of points, and of stretches of the tracks.

use std::collections::{BTreeMap, BTreeSet};

use super::network::Divided;
use crate::form::Position;
use crate::graph::Way;

/// What a file says of speeds, in km/h, rounded down.
#[derive(Debug, Default)]
pub struct Limits {
    /// Of the legs of points, by number.
    pub branches: BTreeMap<(usize, Position), u16>,
    /// Of stretches of edges: edge, metres from its begin, limit. They hold for either direction.
    pub stretches: Vec<(usize, f64, f64, u16)>,
}

impl Limits {
    /// Enters a limit of a leg: the lowest holds.
    pub fn leg(&mut self, point: usize, position: Position, limit: u16) {
        let lowest = self.branches.entry((point, position)).or_insert(limit);
        *lowest = limit.min(*lowest);
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
pub fn kmh(text: &str) -> Option<u16> {
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
