//! How large a station is, and the room that a large one needs while it is made.

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
    /// So many circuits and points, and these paths and segments of so many circuits each.
    pub fn new(
        circuits: usize,
        points: usize,
        paths: impl ExactSizeIterator<Item = usize>,
        segments: impl ExactSizeIterator<Item = usize>,
    ) -> Self {
        let (routes, lines) = (paths.len(), segments.len());
        Self { circuits, points, segments: lines, routes, longest: paths.chain(segments).max().unwrap_or(0) }
    }

    /// What a file describes.
    pub fn of(station: &Station) -> Self {
        let paths = station.routes.iter().map(|route| route.path.len());
        let segments = station.segments.iter().map(|segment| segment.circuits.len());
        Self::new(station.circuits.len(), station.points.len(), paths, segments)
    }

    /// Whether a small station has no room for it ([`atc_kernel::interlocking::Station`]).
    pub const fn is_large(self) -> bool {
        self.circuits > 64 || self.points > 32 || self.segments > 8 || self.routes > 64 || self.longest > 16
    }
}

/// The stack on which a large station is made: its layout has nearly a megabyte, and is moved some times.
const STACK: usize = 64 << 20;

/// Runs what moves large stations about, on a stack with room for them.
///
/// # Errors
/// There is no thread for it, or it ended badly.
pub fn with_room<T: Send>(run: impl FnOnce() -> T + Send) -> Result<T, String> {
    std::thread::scope(|scope| {
        let thread = std::thread::Builder::new().stack_size(STACK).spawn_scoped(scope, run);
        let thread = thread.map_err(|error| format!("a large station needs a thread of its own: {error}"))?;
        thread.join().map_err(|_| "a large station cannot be opened here".to_owned())
    })
}
