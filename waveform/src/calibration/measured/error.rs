//! Why measurements make no table.

use crate::rail::{Decibels, Metres};
use atc_kernel::position::TableError;
use std::fmt;

/// Spans that a table must have at least.
pub(super) const LEAST_SPANS: usize = 2;

/// Measurements that make no table. Passes and measurements are told by their places in what was given.
#[derive(Clone, Debug, PartialEq)]
pub enum FitError {
    /// There is no measurement.
    Nothing,
    /// The section is not within the measurements of this pass, which end at the distance.
    Section {
        /// The pass.
        pass: usize,
        /// Its farthest measurement.
        measurement: usize,
        /// The distance of that.
        reached: Metres,
        /// The section's length.
        section: Metres,
    },
    /// With this spacing the table ends before the section does, or no spacing reaches that far.
    Reach {
        /// The spacing, metres.
        spacing: Metres,
        /// How far it must reach.
        needed: Metres,
    },
    /// The distances that all passes have in common are less than two spans.
    Short {
        /// The nearest common distance.
        from: Metres,
        /// The farthest one.
        to: Metres,
        /// The spacing, metres.
        spacing: Metres,
    },
    /// A pass has too few measurements for its line.
    Few {
        /// The pass.
        pass: usize,
        /// How many there are within the table.
        found: usize,
        /// How many are needed.
        needed: usize,
        /// The spacing, metres.
        spacing: Metres,
    },
    /// In a span of the table a pass was measured at fewer than two distances.
    Gap {
        /// The pass.
        pass: usize,
        /// The last measurement before the gap, if there is one.
        before: Option<usize>,
        /// The first one after it.
        after: Option<usize>,
        /// The span's ends.
        from: Metres,
        /// The farther one.
        to: Metres,
        /// At how many distances it was measured.
        found: usize,
    },
    /// The difference falls by more than the spread explains.
    Falls {
        /// The pass.
        pass: usize,
        /// The measurement that is farthest from any line that rises.
        measurement: usize,
        /// Where the fall begins.
        from: Metres,
        /// Where it ends.
        to: Metres,
        /// By how much it falls.
        fall: Decibels,
        /// How much of that the spread explains.
        explained: Decibels,
    },
    /// Over the whole table the difference of a pass rises by no more than the spread explains.
    Flat {
        /// The pass.
        pass: usize,
        /// By how much it rises.
        rise: Decibels,
        /// How much of that the spread explains.
        explained: Decibels,
    },
    /// A curve is not within ±300 dB.
    TooWide {
        /// The knot, 0 to 16.
        knot: usize,
    },
    /// The kernel refuses the table.
    Table(TableError),
}

impl fmt::Display for FitError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Nothing => write!(f, "there is no measurement; a table needs {LEAST_SPANS} spans or more"),
            Self::Section { reached, section, .. } => write!(
                f,
                "the measurements end at {} m, and the section at {} m; they must reach its far end",
                reached.0, section.0
            ),
            Self::Reach { spacing, needed } => write!(
                f,
                "with {} m between its knots a table ends before {} m; a spacing of up to 204.8 m reaches 3072 m",
                spacing.0, needed.0
            ),
            Self::Short { from, to, spacing } => write!(
                f,
                "what every pass covers, {} to {} m, is less than {LEAST_SPANS} spans of {} m: \
                 measure farther, or choose a smaller spacing",
                from.0, to.0, spacing.0
            ),
            Self::Few { found, needed, spacing, .. } => write!(
                f,
                "{found} measurements within the table; with {} m between its knots {needed} are needed: \
                 measure at more places, or choose a greater spacing",
                spacing.0
            ),
            Self::Gap { from, to, found, .. } => write!(
                f,
                "a gap: from {} to {} m there {} measured; every span needs two: measure there, or choose a greater \
                 spacing",
                from.0,
                to.0,
                match found {
                    0 => "is nothing".to_owned(),
                    1 => "is one distance".to_owned(),
                    _ => format!("are {found} distances"),
                }
            ),
            Self::Falls { from, to, fall, explained, .. } => write!(
                f,
                "from {} to {} m the difference falls by {:.2} dB, and the spread of the measurements explains {:.2} dB; it \
                 must rise with the distance: check this measurement, and that the first signal is the one that the \
                 rail attenuates less",
                from.0, to.0, fall.0, explained.0
            ),
            Self::Flat { rise, explained, .. } => write!(
                f,
                "over the whole table the difference rises by {:.2} dB, and the spread of the measurements explains {:.2} dB: no \
                 distance can be told; frequencies farther apart, or levels measured more closely, are needed",
                rise.0, explained.0
            ),
            Self::TooWide { knot } => write!(
                f,
                "at knot {knot} a curve is beyond 300 dB: the measurements near it do not agree with each other"
            ),
            Self::Table(TableError::Crossed(knot)) => {
                write!(f, "at knot {knot} the lowest difference is above the highest")
            }
            Self::Table(TableError::NowhereRising) => write!(
                f,
                "nowhere does the difference rise by 0.01 dB from knot to knot: frequencies farther apart or a greater \
                 spacing are needed"
            ),
        }
    }
}

impl std::error::Error for FitError {}
