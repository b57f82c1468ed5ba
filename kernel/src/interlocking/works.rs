//! Maintenance: blocks of circuits and temporary speed restrictions. Only commands change them.

use super::code::SpeedCode;
use super::layout::{Element, Layout};
use super::limits::SpeedLimits;
use super::set::CircuitSet;
use super::size::{Size, Small};

/// What staff command in one cycle; empty sets where they command nothing.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Orders<Z: Size = Small> {
    /// Circuits to block.
    pub block: CircuitSet<Z>,
    /// Circuits to unblock; a circuit that is to be blocked as well is blocked.
    pub unblock: CircuitSet<Z>,
    /// Circuits to restrict to `speed`, where they are not restricted to less.
    pub restrict: CircuitSet<Z>,
    /// The highest speed code on them.
    pub speed: SpeedCode,
    /// Circuits whose restriction is lifted; a circuit that is to be restricted as well has the new restriction only.
    pub lift: CircuitSet<Z>,
}

/// What is remembered for each circuit.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Works<Z: Size = Small> {
    /// No route is set over these circuits, and none shows proceed.
    pub blocked: CircuitSet<Z>,
    /// The blocked circuits that were found neither held nor occupied since: staff may rely on these.
    pub confirmed: CircuitSet<Z>,
    /// The highest speed code by temporary restriction.
    pub restrictions: SpeedLimits<Z>,
}

impl<Z: Size> Works<Z> {
    /// Every circuit is blocked and restricted to stop.
    pub const INITIAL: Self =
        Self { blocked: CircuitSet::ALL, confirmed: CircuitSet::EMPTY, restrictions: SpeedLimits::STOP };

    /// Whether only blocked circuits are confirmed.
    pub fn is_valid(&self) -> bool {
        self.blocked.contains(self.confirmed)
    }

    /// The orders of one cycle.
    #[inline]
    #[must_use]
    pub fn obey(mut self, orders: Orders<Z>) -> Self {
        //= spec/interlocking.md#ilk-15-commands-only
        //# Blocks and restrictions MUST be set and cleared by command only, a command to block or to restrict is always carried out, and only one to lift raises a restriction.
        self.blocked = self.blocked.without(orders.unblock).or(orders.block);
        self.confirmed = self.confirmed.and(self.blocked);
        self.restrictions = self.restrictions.without(orders.lift).and_at_most(orders.speed, orders.restrict);
        self
    }

    /// Confirms as protection what is blocked and neither held by a route nor occupied.
    #[inline]
    #[must_use]
    pub fn confirm(mut self, held: CircuitSet<Z>, occupied: CircuitSet<Z>) -> Self {
        //= spec/interlocking.md#ilk-16-protection
        //# A block MUST be confirmed as protection only when its circuit is neither held by a route nor occupied, nobody may be on the way over it to a signal, no held route needs a point in it, every point in it counts as detected, and, on plain line, nobody may be on the way to it: the segment and its throat are clear, no route out is held, and before this cycle the neighbour has not been permitted to send for the turn time.
        self.confirmed = self.confirmed.or(self.blocked.without(held.or(occupied)));
        self
    }
}

/// Where somebody stands in the way of those who work: of two circuits that foul each other the one, while the other is occupied. Nothing where no block is to
/// be confirmed.
#[inline]
pub(super) fn struck<const R: usize, const P: usize, const N: usize, const S: usize, Z: Size>(
    layout: &Layout<R, P, N, S, Z>,
    works: Works<Z>,
    occupied: CircuitSet<Z>,
) -> CircuitSet<Z> {
    //= spec/interlocking.md#ilk-39-block-beside-a-vehicle
    //# A block MUST be confirmed only while no circuit is occupied that a route has beside the circuit of the block, or beside which a route has that.
    let mut struck = CircuitSet::EMPTY;
    if works.blocked.without(works.confirmed).is_empty() {
        return struck;
    }
    let strikes = |element: &Element<Z>| {
        let one = element.circuits.only_if(element.beside.meets(occupied));
        one.or(element.beside.only_if(element.circuits.meets(occupied)))
    };
    for route in &layout.plan().routes {
        for (place, element) in (0_u8..).zip(Z::used(&route.path, route.length)) {
            struck = struck.or(strikes(element).only_if(place < route.length));
        }
        struck = struck.or(strikes(&route.overlap).only_if(route.exists()));
    }
    struck
}
