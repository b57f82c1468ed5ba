//! A finished plan held against the tracks of its file, by other code than that which made it.
//!
//! The theorems of the interlocking are about the plan. That the plan is the station was the work of one derivation. Here the
//! file is read a second time, with nothing of the derivation but the form of the file: vehicles run over its tracks, in both directions and with
//! points as they may stand, and what they meet is asked of the plan. It is asked of every layout that is compiled; a difference is a fault of
//! the derivation, and the layout is refused.
//!
//! | part | asks |
//! |---|---|
//! | `routes` | that the train of a route runs over its path and no other, slides into its overlap, and comes to what is beyond |
//! | `flank` | that no vehicle comes onto the path from aside or against it, but past a signal, or over what the file gives a reason for |
//! | `lines` | segments from the station to where the line goes on, and what detects a point |
//! | `numbers` | approaches, distances, lengths, speeds and times, in floating point |

mod flank;
mod lines;
mod numbers;
mod routes;
mod tracks;

use std::ops::Range;

use atc_kernel::interlocking::{CircuitSet, PointSet, Positions};

use crate::form::{Position, Station};
use crate::problem::Problem;
use crate::rule::Rule;

pub use atc_kernel::interlocking::Plan;
use tracks::{Stand, Tracks};

/// What is held against each other.
struct Sides<'a, const R: usize, const P: usize, const N: usize, const S: usize> {
    station: &'a Station,
    tracks: Tracks,
    plan: &'a Plan<R, P, N, S>,
}

/// Everything in which `plan` is not what vehicles meet on the tracks of `station`, a file that breaks no other rule.
pub fn differences<const R: usize, const P: usize, const N: usize, const S: usize>(
    station: &Station,
    plan: &Plan<R, P, N, S>,
) -> Vec<Problem> {
    let sides = Sides { station, tracks: Tracks::of(station), plan };
    let mut found = Vec::new();
    sides.lines(&mut found);
    sides.numbers(&mut found);
    let ways: Vec<Option<routes::Way>> =
        (0..station.routes.len().min(R)).map(|route| sides.route(route, &mut found)).collect();
    sides.flanks(&ways, &mut found);
    sides.ends(&ways, &mut found);
    sides.approaches(&ways, &mut found);
    found
}

impl<const R: usize, const P: usize, const N: usize, const S: usize> Sides<'_, R, P, N, S> {
    fn differs(&self, route: usize, what: &str) -> Problem {
        let name = &self.station.routes[route].name;
        difference(&name.span, format!("route {name}: {what}"))
    }

    fn circuit(&self, number: usize) -> &str {
        &self.station.circuits[number].name.value
    }

    fn place_of(&self, circuit: &str) -> Option<usize> {
        self.station.circuits.iter().position(|given| given.name.value == circuit)
    }
}

/// Something in which the plan is not what the tracks are.
fn difference(span: &Range<usize>, what: String) -> Problem {
    Problem::new(Rule::PlanAgainstTracks, span, what, "tell the authors: the layout was derived wrongly")
}

/// The numbers in a set of circuits.
fn members(set: CircuitSet) -> impl Iterator<Item = usize> {
    (0..64).filter(move |circuit| set.meets(CircuitSet::nth(*circuit)))
}

/// Positions as places in the file. A point that is to stand both ways stands neither.
fn stand(positions: Positions) -> Stand {
    let of = |point: usize| match (
        positions.normal.meets(PointSet::nth(point)),
        positions.reverse.meets(PointSet::nth(point)),
    ) {
        (true, false) => Some((point, Position::Normal)),
        (false, true) => Some((point, Position::Reverse)),
        _ => None,
    };
    (0..32).filter_map(of).collect()
}
