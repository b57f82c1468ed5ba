//! How large the stations of the models may be, and the layouts of this size.

use atc_kernel::interlocking::{CircuitSet, Layout, Plan};

/// The most routes of a model.
pub const ROUTES: usize = 8;
/// The most circuits of a route.
pub const PLACES: usize = 3;
/// The most points.
pub const POINTS: usize = 2;
/// The most segments of plain line.
pub const SEGMENTS: usize = 2;
/// The most circuits of a station.
pub const CIRCUITS: usize = 8;

/// The most signals.
pub const SIGNALS: usize = 6;

/// A layout of this size.
pub type Small = Layout<ROUTES, PLACES, POINTS, SEGMENTS>;
/// A plan of this size.
pub type SmallPlan = Plan<ROUTES, PLACES, POINTS, SEGMENTS>;

/// The set of circuits of a mask.
pub const fn circuits(mask: u8) -> CircuitSet {
    CircuitSet::from_bits(mask as u64)
}
