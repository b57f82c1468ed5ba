//! Points: which stand under a train, which are locked, and which are driven.

use super::layout::{Layout, Route};
use super::route::{Phase, RouteState};
use super::set::{CircuitSet, PointSet, Positions};

/// The points with a detector circuit in `circuits`.
#[inline]
pub(super) fn meeting<const R: usize, const P: usize, const N: usize, const S: usize>(
    layout: &Layout<R, P, N, S>,
    circuits: CircuitSet,
) -> PointSet {
    let mut points = PointSet::EMPTY;
    for (number, point) in layout.plan().points.iter().enumerate() {
        points = points.or(PointSet::nth(number).only_if(point.detectors.meets(circuits)));
    }
    points
}

/// What routes want of the points, and what they forbid.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct Demand {
    /// Provisional routes and individual commands want these positions.
    pub wanted: Positions,
    /// Routes past provisional lock these points.
    pub locked: PointSet,
}

impl Demand {
    /// With what one route demands.
    #[inline]
    #[must_use]
    pub(super) fn with<const P: usize>(self, route: &Route<P>, state: RouteState) -> Self {
        let positions = state.positions(route);
        Self {
            wanted: self.wanted.or(positions.only_if(state.phase == Phase::Provisional)),
            locked: self.locked.or(positions.points().only_if(state.locks())),
        }
    }

    /// The points to drive, and whereto: `detected` are the positions that are detected, `under` the points under a train.
    #[inline]
    pub(super) fn drives(self, detected: Positions, under: PointSet) -> Positions {
        //= spec/interlocking.md#ilk-8-detector-locking
        //# A point MUST be driven only while a provisional route or an individual command wants it elsewhere than it is detected, no detector circuit of it is occupied, and no route past provisional locks it.
        self.wanted.missing_in(detected).without(under.or(self.locked))
    }
}
