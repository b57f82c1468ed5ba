//! The ground's device as one machine: T-WAY of `spec/theorems.md`, a harness for each hand-off between its parts.
//!
//! What the parts guarantee is proven elsewhere (T-BLK, T-ILK, T-ATC, T-TEL) and supposed here where it is needed. A sentence about a
//! train has a train in its harness: on metres, with a front and a tail.

mod consent;
mod counter;
mod direction;
mod joint;
mod occupancy;
mod plans;
mod said;
mod signals;
mod speech;
mod track;

use crate::Harness;

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
