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
mod sides;
mod tracks;

use crate::form::Station;
use crate::problem::Problem;

pub use atc_kernel::interlocking::{Plan, Size};
use sides::Sides;
use tracks::Tracks;

/// Everything in which `plan` is not what vehicles meet on the tracks of `station`, a file that breaks no other rule.
pub fn differences<const R: usize, const P: usize, const N: usize, const S: usize, Z: Size>(
    station: &Station,
    plan: &Plan<R, P, N, S, Z>,
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
