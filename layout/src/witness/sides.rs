//! What is held against each other: the tracks of a file, and the plan that was made of it.

use std::ops::Range;

use atc_kernel::interlocking::{CircuitSet, Plan, PointSet, Positions, Size};

use super::tracks::{Stand, Tracks};
use crate::form::{Position, Station};
use crate::problem::Problem;
use crate::rule::Rule;

/// What is held against each other.
pub(super) struct Sides<'a, const R: usize, const P: usize, const N: usize, const S: usize, Z: Size> {
    pub(super) station: &'a Station,
    pub(super) tracks: Tracks,
    pub(super) plan: &'a Plan<R, P, N, S, Z>,
}

impl<const R: usize, const P: usize, const N: usize, const S: usize, Z: Size> Sides<'_, R, P, N, S, Z> {
    pub(super) fn differs(&self, route: usize, what: &str) -> Problem {
        let name = &self.station.routes[route].name;
        difference(&name.span, format!("route {name}: {what}"))
    }

    pub(super) fn circuit(&self, number: usize) -> &str {
        &self.station.circuits[number].name.value
    }

    pub(super) fn place_of(&self, circuit: &str) -> Option<usize> {
        self.station.circuits.iter().position(|given| given.name.value == circuit)
    }
}

/// Something in which the plan is not what the tracks are.
pub(super) fn difference(span: &Range<usize>, what: String) -> Problem {
    Problem::new(Rule::PlanAgainstTracks, span, what, "tell the authors: the layout was derived wrongly")
}

/// The numbers in a set of circuits.
pub(super) fn members<Z: Size>(set: CircuitSet<Z>) -> impl Iterator<Item = usize> {
    (0..CircuitSet::<Z>::MOST).filter(move |circuit| set.meets(CircuitSet::nth(*circuit)))
}

/// Positions as places in the file. A point that is to stand both ways stands neither.
pub(super) fn stand<Z: Size>(positions: Positions<Z>) -> Stand {
    let of = |point: usize| match (
        positions.normal.meets(PointSet::nth(point)),
        positions.reverse.meets(PointSet::nth(point)),
    ) {
        (true, false) => Some((point, Position::Normal)),
        (false, true) => Some((point, Position::Reverse)),
        _ => None,
    };
    (0..PointSet::<Z>::MOST).filter_map(of).collect()
}
