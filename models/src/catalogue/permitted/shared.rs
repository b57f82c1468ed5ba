//! What the models of the permitted speed share: conditions, and a ride.

use crate::catalogue::about::{Conditions, all_but};
use crate::check::{About, Entry};
use crate::permitted::Purpose;
use crate::permitted::device::{Device, Real};
use crate::permitted::layout::Layout;
use crate::permitted::ride::{Environment, Ride, Small};

/// What all models assume that do not lift it.
pub(super) const ALL: [&str; 8] = [
    "limits-reach-over-the-border",
    "odometer-bound",
    "stop-point-life",
    "transmitter-does-not-loop",
    "sub-data-worst",
    "fix-of-the-section-heard",
    "margin-covers-the-crossing",
    "line-is-told",
];

/// All but the one at `place`.
pub(super) const fn without(place: usize) -> [&'static str; ALL.len() - 1] {
    all_but(ALL, place)
}

pub(super) const SOUND: Conditions = (&ALL, &[]);

pub(super) const NO_LIMITS: Conditions = (&without(0), &["limits-reach-over-the-border"]);

pub(super) const NO_ODOMETER: Conditions = (&without(1), &["odometer-bound"]);

pub(super) const NO_POINT_LIFE: Conditions = (&without(2), &["stop-point-life"]);

pub(super) const LOOPS: Conditions = (&without(3), &["transmitter-does-not-loop"]);

pub(super) const NO_WORST: Conditions = (&without(4), &["sub-data-worst"]);

pub(super) const NO_FIX: Conditions = (&without(5), &["fix-of-the-section-heard"]);

pub(super) const NO_MARGIN: Conditions = (&without(6), &["margin-covers-the-crossing"]);

pub(super) const NOT_TOLD: Conditions = (&without(7), &["line-is-told"]);

pub(super) const DISTANCE: &[&str] = &["PER-1", "PER-4", "PER-8"];

pub(super) const WORST: &[&str] = &["PER-1", "PER-5", "PER-8"];

pub(super) const AGE: &[&str] = &["PER-6", "PER-8", "PER-12", "TEL-6", "TEL-8"];

/// A ride with the kernel's device.
pub(super) fn ride(about: About, layout: &Layout, small: Small, environment: Environment, purpose: Purpose) -> Entry {
    other(about, Real, layout, small, environment, purpose)
}

pub(super) fn other<D: Device>(
    about: About,
    device: D,
    layout: &Layout,
    small: Small,
    environment: Environment,
    purpose: Purpose,
) -> Entry {
    Entry::new(about, Ride::new(device, layout.clone(), small, environment, purpose))
}
