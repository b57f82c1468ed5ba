//! Limits of speed: of the legs of points, and of stretches of the tracks.

use std::collections::{BTreeMap, BTreeSet};

use super::network::{Divided, Network, Side};
use crate::form::{Position, Station};
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

    /// Whether a way leads over a reverse leg of which nothing says how fast: neither its own limit nor one that holds at its blades.
    pub fn leaves_open(&self, way: &[(usize, Way)], network: &Network) -> bool {
        let reverse = way.iter().flat_map(|(_, way)| &way.passed).filter(|passed| passed.position == Position::Reverse);
        let mut open = reverse.filter(|passed| !self.branches.contains_key(&(passed.point, passed.position)));
        open.any(|passed| {
            let Some([_, _, (leg, side)]) = network.switches.get(passed.point).map(|switch| switch.ports) else {
                return true;
            };
            let given = &network.edges[leg];
            let at = if side == Side::Begin { given.begin } else { given.length };
            let holds = |(edge, from, to, _): &(usize, f64, f64, u16)| {
                *edge == leg && (from - AT_BLADES..=to + AT_BLADES).contains(&at)
            };
            !self.stretches.iter().any(holds)
        })
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

/// A limit that begins so many metres from the blades of a point holds there.
const AT_BLADES: f64 = 1.0;

/// The lowest speed that a code says.
pub fn lowest(station: &Station) -> u16 {
    station.braking.speeds_kmh.iter().copied().filter(|kmh| *kmh > 0).min().unwrap_or(0)
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
