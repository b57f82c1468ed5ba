//! Points: which stand under a train, which are locked, and which are driven.

use super::layout::{Layout, Route};
use super::route::{Phase, RouteState};
use super::set::{CircuitSet, PerPoint, PointSet, Positions};
use super::size::{Size, Small};

/// The points with a detector circuit in `circuits`.
#[inline]
pub(super) fn meeting<const R: usize, const P: usize, const N: usize, const S: usize, Z: Size>(
    layout: &Layout<R, P, N, S, Z>,
    circuits: CircuitSet<Z>,
) -> PointSet<Z> {
    let mut points = PointSet::EMPTY;
    for (number, point) in layout.plan().points.iter().enumerate() {
        points = points.or(PointSet::nth(number).only_if(point.detectors.meets(circuits)));
    }
    points
}

/// The detector circuits of `points`.
#[inline]
pub(super) fn detectors<const R: usize, const P: usize, const N: usize, const S: usize, Z: Size>(
    layout: &Layout<R, P, N, S, Z>,
    points: PointSet<Z>,
) -> CircuitSet<Z> {
    let mut circuits = CircuitSet::EMPTY;
    for (number, point) in layout.plan().points.iter().enumerate() {
        circuits = circuits.or(point.detectors.only_if(points.meets(PointSet::nth(number))));
    }
    circuits
}

/// For how many cycles in a row each point has been detected in one position and not been driven, up to the layout's number.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Settling<Z: Size = Small> {
    pub(super) stood: PerPoint<u8, Z>,
    pub(super) last: Positions<Z>,
}

impl<Z: Size> Settling<Z> {
    /// No point has stood yet.
    pub const INITIAL: Self = Self { stood: PerPoint::NONE, last: Positions::NONE };

    /// A state for proofs and models; not every value is valid. `last` are the positions of the cycle before.
    pub const fn from_parts(stood: PerPoint<u8, Z>, last: Positions<Z>) -> Self {
        Self { stood, last }
    }

    /// For how many cycles each point has stood, and where the points were detected last.
    pub const fn parts(&self) -> (PerPoint<u8, Z>, Positions<Z>) {
        (self.stood, self.last)
    }

    /// Whether no count is over `settle`, the layout's number.
    pub fn is_valid(&self, settle: u8) -> bool {
        let mut valid = true;
        for count in &self.stood {
            valid &= *count <= settle;
        }
        valid
    }

    /// One cycle of `points` points; the answer is the positions that count as detected.
    #[inline]
    #[must_use]
    pub(super) fn step(
        mut self,
        points: usize,
        settle: u8,
        detected: Positions<Z>,
        drives: Positions<Z>,
    ) -> (Self, Positions<Z>) {
        //= spec/interlocking.md#ilk-23-settling
        //# A point MUST count as detected only while it is not driven and has been detected in one position for the layout's number of cycles in a row since it was driven last, by a route or by hand.
        let undriven = detected.without(drives.points());
        let still = undriven.without(undriven.missing_in(self.last).points());
        let mut settled = PointSet::EMPTY;
        for (number, count) in self.stood.iter_mut().enumerate() {
            if number < points {
                let point = PointSet::nth(number);
                let more = if *count < settle { *count + 1 } else { settle };
                *count = if still.points().meets(point) { more } else { 0 };
                settled = settled.or(point.only_if(*count >= settle));
            }
        }
        // Without a settling time nothing is asked of the past.
        self.last = detected.only_if(settle > 0);
        (self, undriven.only_among(settled))
    }
}

/// What routes want of the points, and what they forbid.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct Demand<Z: Size = Small> {
    /// Provisional routes and individual commands want these positions.
    pub wanted: Positions<Z>,
    /// What must not move: routes past provisional lock points, what the start has left unswept keeps some, and blocks are on others.
    pub locked: PointSet<Z>,
}

impl<Z: Size> Demand<Z> {
    /// With what one route demands.
    #[inline]
    #[must_use]
    pub(super) fn with<const P: usize>(self, route: &Route<P, Z>, state: RouteState) -> Self {
        let positions = state.positions(route);
        Self {
            wanted: self.wanted.or(positions.only_if(state.phase == Phase::Provisional)),
            locked: self.locked.or(positions.points().only_if(state.locks())),
        }
    }

    /// The points to drive, and whereto: `detected` are the positions that are detected, `under` the points under a train.
    #[inline]
    pub(super) fn drives(self, detected: Positions<Z>, under: PointSet<Z>) -> Positions<Z> {
        //= spec/interlocking.md#ilk-8-detector-locking
        //# A point MUST be driven only while a provisional route or an individual command wants it elsewhere than it is detected, no detector circuit of it is occupied or blocked, and no route past provisional locks it.
        self.wanted.missing_in(detected).without(under.or(self.locked))
    }
}
