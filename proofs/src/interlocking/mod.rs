//! Interlocking and ATC: T-ILK, T-TRK, T-ATC and T-LAY of `spec/interlocking.md`, for every layout that the constructor accepts.
//!
//! A harness draws a layout, assumes only that `Layout::with_what_proofs_need` accepts it, draws a valid state and an input,
//! runs one cycle after the tracking, and claims. One circuit, one point and one pair of routes stand for all.

mod ahead;
mod any;
mod atc;
mod berth;
mod beside;
mod border;
mod cycle;
mod device;
mod direction;
mod forgotten;
mod heading;
mod layout;
mod line;
mod meeting;
mod out;
mod pair;
mod point;
mod room;
mod route;
mod scene;
mod sets;
mod signal;
mod start;
mod table;
mod track;
mod train;
mod unswept;
mod works;

use crate::Harness;

pub(crate) use any::{LONGEST, any_circuits, any_heading, any_input, any_plan, any_state};
pub use any::{PATH, PLACES, POINTS};

/// The bounds of the harnesses that are smaller when they are compiled for a wrong kernel.
#[cfg(not(chosen))]
pub const SMALLER: [&str; 13] = [
    berth::BOUND,
    direction::BOUND,
    pair::BOUND,
    point::BOUND,
    route::BOUND,
    signal::BOUND,
    scene::ALONE,
    scene::BOUND,
    forgotten::BOUND,
    unswept::BESIDE,
    beside::PAIR,
    beside::TRAIN,
    works::BOUND,
];

/// All harnesses of this room.
#[cfg(not(chosen))]
pub const ALL: &[Harness] = &[
    pair::t_ilk_1::HARNESS,
    pair::t_ilk_1_three::HARNESS,
    beside::t_ilk_12::HARNESS,
    beside::t_ilk_12_train::HARNESS,
    beside::t_ilk_12_block::HARNESS,
    cycle::t_ilk_1_local::HARNESS,
    cycle::t_ilk_1_line::HARNESS,
    cycle::t_ilk_1_valid::HARNESS,
    cycle::t_ilk_1_refused::HARNESS,
    cycle::t_ilk_1_start::HARNESS,
    cycle::t_ilk_1_starting::HARNESS,
    route::t_ilk_2::HARNESS,
    signal::t_ilk_3::HARNESS,
    signal::t_ilk_3_monotone::HARNESS,
    route::t_ilk_5::HARNESS,
    route::t_ilk_5_occupied::HARNESS,
    route::t_ilk_6::HARNESS,
    route::t_ilk_7::HARNESS,
    signal::t_atc_1::HARNESS,
    signal::t_atc_1_sound::HARNESS,
    signal::t_atc_1_overlap::HARNESS,
    track::t_trk_1::HARNESS,
    track::t_trk_1_shared::HARNESS,
    track::t_trk_1_joint::HARNESS,
    table::t_atc_3::HARNESS,
    table::t_atc_3_stale::HARNESS,
    table::t_atc_3_damaged::HARNESS,
    table::t_atc_3_device::HARNESS,
    device::t_atc_3_step::HARNESS,
    works::t_ilk_8::HARNESS,
    direction::t_ilk_9::HARNESS,
    point::t_ilk_4::HARNESS,
    point::t_ilk_4_settled::HARNESS,
    atc::t_atc_1_connect::HARNESS,
    atc::t_atc_1_apart::HARNESS,
    atc::t_atc_2::HARNESS,
    atc::t_atc_2_train::HARNESS,
    atc::t_atc_4::HARNESS,
    atc::t_atc_4_each::HARNESS,
    heading::t_atc_5::HARNESS,
    border::t_atc_6::HARNESS,
    out::t_atc_7::HARNESS,
    room::t_atc_8::HARNESS,
    room::t_atc_8_brakes::HARNESS,
    layout::t_lay_2::HARNESS,
    sets::t_lay_3::HARNESS,
    sets::t_lay_3_check::HARNESS,
    sets::t_lay_3_idle::HARNESS,
    sets::t_lay_3_used::HARNESS,
    train::t_ilk_train::HARNESS,
    train::t_ilk_train_release::HARNESS,
    train::t_ilk_train_overlap::HARNESS,
    train::t_ilk_train_body::HARNESS,
    ahead::t_ilk_train_points::HARNESS,
    ahead::t_ilk_train_worker::HARNESS,
    berth::t_ilk_train_stands::HARNESS,
    berth::t_ilk_train_called::HARNESS,
    meeting::t_ilk_train_line::HARNESS,
    start::t_ilk_train_start::HARNESS,
    unswept::t_ilk_train_unswept::HARNESS,
    unswept::t_ilk_12_unswept::HARNESS,
];
