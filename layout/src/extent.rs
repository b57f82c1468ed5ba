//! How large a station is.

use crate::form::Station;

/// How much there is of what a station must have room for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Extent {
    /// The track circuits.
    pub circuits: usize,
    /// The points.
    pub points: usize,
    /// The segments of plain line.
    pub segments: usize,
    /// The routes.
    pub routes: usize,
    /// The circuits of the longest path or segment.
    pub longest: usize,
}

impl Extent {
    /// What a file describes.
    pub fn of(station: &Station) -> Self {
        let paths = station.routes.iter().map(|route| route.path.len());
        let segments = station.segments.iter().map(|segment| segment.circuits.len());
        Self {
            circuits: station.circuits.len(),
            points: station.points.len(),
            segments: station.segments.len(),
            routes: station.routes.len(),
            longest: paths.chain(segments).max().unwrap_or(0),
        }
    }

    /// Whether a small station has no room for it ([`atc_kernel::interlocking::Station`]).
    pub const fn is_large(self) -> bool {
        self.circuits > 64 || self.points > 32 || self.segments > 8 || self.routes > 64 || self.longest > 16
    }
}
