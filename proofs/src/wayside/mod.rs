//! The ground's device as one machine: T-WAY of `spec/theorems.md`, a harness for each hand-off between its parts.
//!
//! What the parts guarantee is proven elsewhere (T-BLK, T-ILK, T-ATC, T-TEL) and supposed here where it is needed. A sentence about a
//! train has a train in its harness: on metres, with a front and a tail.

mod consent;
mod counter;
mod direction;
mod joint;
mod occupancy;
mod said;
mod signals;
mod speech;
mod track;

use crate::Harness;
use atc_kernel::distance::Metres;
use atc_kernel::interlocking::{MAX_CIRCUITS, Plan};
use atc_kernel::time::Ticks;

/// The harnesses of this module.
#[cfg(not(chosen))]
pub const ALL: &[Harness] = &[
    occupancy::t_way_1::HARNESS,
    joint::t_way_1_joint::HARNESS,
    track::t_way_1_track::HARNESS,
    occupancy::t_way_2::HARNESS,
    speech::t_way_3::HARNESS,
    speech::t_way_3_train::HARNESS,
    speech::t_way_3_sub::HARNESS,
    speech::t_way_4::HARNESS,
    consent::t_way_5::HARNESS,
    consent::t_way_5_told::HARNESS,
    consent::way_life::HARNESS,
    counter::t_way_6::HARNESS,
    direction::t_way_7::HARNESS,
    joint::way_join::HARNESS,
    signals::way_signals::HARNESS,
    signals::way_codes::HARNESS,
    signals::way_speeds::HARNESS,
    signals::way_words::HARNESS,
    signals::way_word::HARNESS,
    speech::t_way_8_sent::HARNESS,
    speech::way_safe::HARNESS,
];

/// The longest loop: over what there is for each circuit.
pub(crate) const LONGEST: usize = MAX_CIRCUITS;

/// The circuits of the layouts here: numbers 0 to 15.
const CIRCUITS: usize = 16;

/// A plan whose circuits are 100 m long.
fn plan<const R: usize, const P: usize, const S: usize>() -> Plan<R, P, 0, S> {
    with_lengths(Plan { clear: 1, turn: Ticks(1), ..Plan::EMPTY })
}

/// The plan with circuits that are 100 m long.
fn with_lengths<const R: usize, const P: usize, const S: usize>(mut plan: Plan<R, P, 0, S>) -> Plan<R, P, 0, S> {
    for length in plan.lengths.iter_mut().take(CIRCUITS) {
        *length = Metres(100);
    }
    plan
}
