//! What the models of block counting share: assumptions and requirements.

use crate::check::About;

// The assumptions of a model: which are in force, which are lifted. One component that fails breaches one of [`FAULTS`] or the
// working of one detector, but not that of two.

/// No fault.
pub(super) const NO_FAULT: &[&str] = &[
    "live-transmitter",
    "train-whole",
    "no-reversing-over-exit",
    "entries-apart",
    "hold-covers-train",
    "heard-by-one",
    "independent-detectors",
    "check-in-fail-safe",
    "check-out-not-spurious",
    "verified-reset",
];
/// One faulty component.
pub(super) const ONE_FAULT: &[&str] = &[
    "live-transmitter",
    "train-whole",
    "no-reversing-over-exit",
    "entries-apart",
    "hold-covers-train",
    "heard-by-one",
    "independent-detectors",
];
/// No fault, at a border.
pub(super) const BORDER_NO_FAULT: &[&str] = &[
    "live-transmitter",
    "train-whole",
    "no-reversing-over-exit",
    "entries-apart",
    "hold-covers-train",
    "heard-by-one",
    "independent-detectors",
    "check-in-fail-safe",
    "check-out-not-spurious",
    "verified-reset",
    "loops-overlap",
];
/// One faulty component, at a border.
pub(super) const BORDER_ONE_FAULT: &[&str] = &[
    "live-transmitter",
    "train-whole",
    "no-reversing-over-exit",
    "entries-apart",
    "hold-covers-train",
    "heard-by-one",
    "independent-detectors",
    "loops-overlap",
];
/// Two faulty components.
pub(super) const USUAL: &[&str] = &[
    "live-transmitter",
    "train-whole",
    "no-reversing-over-exit",
    "entries-apart",
    "hold-covers-train",
    "heard-by-one",
];
/// Entries in any two cycles.
pub(super) const NOT_APART: &[&str] =
    &["live-transmitter", "train-whole", "no-reversing-over-exit", "hold-covers-train", "heard-by-one"];
/// A hold that is too short.
pub(super) const NOT_COVERED: &[&str] =
    &["live-transmitter", "train-whole", "no-reversing-over-exit", "entries-apart", "heard-by-one"];
/// Heads on borders heard by none or by two.
pub(super) const NOT_HEARD_BY_ONE: &[&str] =
    &["live-transmitter", "train-whole", "no-reversing-over-exit", "entries-apart", "hold-covers-train"];
/// A dead transmitter.
pub(super) const NOT_LIVE: &[&str] =
    &["train-whole", "no-reversing-over-exit", "entries-apart", "hold-covers-train", "heard-by-one"];
/// A split train.
pub(super) const NOT_WHOLE: &[&str] =
    &["live-transmitter", "no-reversing-over-exit", "entries-apart", "hold-covers-train", "heard-by-one"];
/// Reversing over the exit.
pub(super) const REVERSING: &[&str] =
    &["live-transmitter", "train-whole", "entries-apart", "hold-covers-train", "heard-by-one"];
/// What one faulty component breaches.
pub(super) const FAULTS: &[&str] = &["check-in-fail-safe", "check-out-not-spurious", "verified-reset"];
/// The same, where the check-out lies before the check-in ahead.
pub(super) const BORDER_FAULTS: &[&str] =
    &["check-in-fail-safe", "check-out-not-spurious", "verified-reset", "loops-overlap"];
/// What excludes the cut sets.
pub(super) const SINGLE_FAULTS: &[&str] =
    &["independent-detectors", "check-in-fail-safe", "check-out-not-spurious", "verified-reset"];

pub(super) const COUNT: &[&str] =
    &["BLK-1", "BLK-2", "BLK-3", "BLK-4", "BLK-5", "BLK-7", "T-BLK-1", "T-BLK-2", "T-BLK-3", "T-BLK-4", "T-BLK-5"];
pub(super) const CUTS: &[&str] = &["BLK-1", "BLK-2", "T-BLK-1", "T-BLK-6"];
pub(super) const BORDER: &[&str] = &["BLK-5", "BLK-6", "BLK-10", "T-BLK-1", "T-BLK-4"];

pub(super) fn about(
    name: &'static str,
    statement: &str,
    environment: &str,
    requirements: &'static [&'static str],
    in_force: &'static [&'static str],
    lifted: &'static [&'static str],
) -> About {
    About { name, statement: statement.to_owned(), requirements, environment: environment.to_owned(), in_force, lifted }
}
