//! What a start leaves unswept: the way of a driver who has passed a signal before, and is still in its route.

use super::layout::{Element, Layout, Route};
use super::set::{CircuitSet, PointSet, RouteSet, SegmentSet};
use super::size::{Size, Small};
use crate::time::Ticks;

/// The circuits that a train may still run over by a signal that it passed before the start. A set that only shrinks.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Unswept<Z: Size = Small> {
    /// The circuits.
    pub circuits: CircuitSet<Z>,
    /// The routes that ran in the cycle before: such a train may have been in them, and not wholly in the last circuit.
    pub running: RouteSet<Z>,
    /// For how many cycles no route has ended to run, up to the longest overlap release time of all routes.
    pub still: Ticks,
}

/// What trains from before the start still need in one cycle, besides the circuits.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Ways<Z: Size = Small> {
    /// The points of their ways, flank points included.
    pub points: PointSet<Z>,
    /// The segments that they may be on their way out to.
    pub outward: SegmentSet<Z>,
    /// The circuits beside their ways.
    pub beside: CircuitSet<Z>,
}

/// What one route keeps unswept.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
struct Kept<Z: Size = Small> {
    held: Element<Z>,
    running: bool,
}

impl<Z: Size> Unswept<Z> {
    /// Whatever was before the start: everything, and every route runs.
    pub const INITIAL: Self = Self { circuits: CircuitSet::ALL, running: RouteSet::ALL, still: Ticks(0) };

    /// Nothing.
    pub const SWEPT: Self = Self { circuits: CircuitSet::EMPTY, running: RouteSet::EMPTY, still: Ticks(0) };

    /// One cycle after the start: `occupied` are the circuits that count as occupied.
    #[inline]
    #[must_use]
    pub fn sweep<const R: usize, const P: usize, const N: usize, const S: usize>(
        self,
        layout: &Layout<R, P, N, S, Z>,
        occupied: CircuitSet<Z>,
    ) -> (Self, Ways<Z>) {
        if self.circuits.is_empty() {
            return (Self::SWEPT, Ways::default());
        }
        let mut after = Self::SWEPT;
        let mut ways = Ways::default();
        let (mut longest, mut ended) = (Ticks(0), false);
        for (number, route) in layout.plan().routes.iter().enumerate() {
            let it = RouteSet::nth(number);
            let kept = self.kept_by(route, it, occupied);
            after.circuits = after.circuits.or(kept.held.circuits);
            after.running = after.running.or(it.only_if(kept.running));
            ways.points = ways.points.or(kept.held.positions.points());
            ways.outward = ways.outward.or(route.to.only_if(kept.running));
            ways.beside = ways.beside.or(kept.held.beside);
            ended |= route.exists() && self.running.meets(it) && !kept.running;
            longest = if route.stay > longest { route.stay } else { longest };
        }
        //= spec/interlocking.md#ilk-27-unswept
        //# A circuit MUST count as unswept from a start until the start time is over and no route keeps it, and never again before the next start.
        if after.circuits.is_empty() {
            return (Self::SWEPT, ways);
        }
        let more = Ticks(self.still.0.saturating_add(1));
        let longer = if more < longest { more } else { longest };
        after.still = if ended { Ticks(0) } else { longer };
        (after, ways)
    }

    /// What a route of number `it` keeps.
    #[inline]
    fn kept_by<const P: usize>(&self, route: &Route<P, Z>, it: RouteSet<Z>, occupied: CircuitSet<Z>) -> Kept<Z> {
        //= spec/interlocking.md#ilk-28-kept
        //# A route that is not cab-signalled MUST keep the places of its path from the first occupied one on, and its overlap, where all of these are unswept, while it runs and for its overlap release time after that; and a berth while it is occupied.
        let overlap = route.overlap;
        let mut seen = false;
        let mut kept = Kept::default();
        let mut end = Element::NONE;
        for (place, element) in (0_u8..).zip(Z::used(&route.path, route.length)) {
            if place < route.length {
                let unswept = self.circuits.contains(element.circuits);
                // Whoever is before a place that is swept is none of these trains.
                kept = if unswept { kept } else { Kept::default() };
                seen = unswept && (seen || element.circuits.meets(occupied));
                // Behind the last place of a calling-on route the way goes on into the berth.
                if place + 1 < route.length || route.calling_on {
                    kept.running |= seen;
                    kept.held = kept.held.or(element.only_if(seen));
                } else {
                    end = element.only_if(seen);
                }
            }
        }
        // Before the only place of a path is the entry.
        kept.running |= seen && route.length == 1 && route.entry.meets(occupied);
        let stopping = self.running.meets(it) || self.still < route.stay;
        let slid = route.overlap.circuits.meets(occupied);
        // Who is in a berth may go on there at any time.
        let called = route.calling_on && slid;
        let keeps = kept.running || called || stopping && (seen || slid);
        if route.cab_signalled || !keeps || !self.circuits.contains(overlap.circuits) {
            return Kept::default();
        }
        kept.held = kept.held.or(end).or(overlap);
        kept
    }

    /// Whether a train from before the start is in the way of the route of number `asked`: one that may still run over a circuit of its path
    /// or overlap, and is not the train that the route begins for.
    #[inline]
    pub(super) fn is_in_the_way<const R: usize, const P: usize, const N: usize, const S: usize>(
        &self,
        layout: &Layout<R, P, N, S, Z>,
        asked: usize,
        occupied: CircuitSet<Z>,
    ) -> bool {
        let routes = &layout.plan().routes;
        let route = &routes[asked];
        let whole = route.held_from(0).or(route.overlap);
        let needed = whole.circuits;
        let mut in_the_way = false;
        for (number, other) in routes.iter().enumerate() {
            let it = RouteSet::nth(number);
            let kept = self.kept_by(other, it, occupied).held.circuits;
            let beyond = other.overlap.circuits;
            let (mut own, mut shares) = (false, false);
            for (place, element) in (0_u8..).zip(Z::used(&other.path, other.length)) {
                if place < other.length {
                    let meets = needed.meets(element.circuits);
                    in_the_way |= meets && !own && kept.meets(element.circuits);
                    let begins = other.heading == route.heading && element.circuits == route.entry;
                    shares |= meets || begins;
                    // A berth need not be clear: the train that is called may not be the one that is there.
                    own = (begins || own && meets) && !route.calling_on;
                    //= spec/interlocking.md#ilk-38-beside-a-way
                    //# A route MUST be refused if it and what a route keeps foul each other, unless it begins in the last circuit of that route, which leads to no line, and nothing is in its overlap; and no block be confirmed beside what a route keeps.
                    // Beside the last place is the train that the route begins for, unless it has gone on.
                    let last = place + 1 == other.length && other.to.is_empty() && !beyond.meets(occupied);
                    in_the_way |= kept.meets(element.circuits) && whole.fouls(element) && !(last && begins && own);
                }
            }
            // A train that has slid there is not the one that waits where the route begins.
            in_the_way |= needed.meets(beyond.and(kept)) && (!own || beyond.meets(occupied));
            in_the_way |= !kept.is_empty() && whole.fouls(&other.overlap);
            // What two routes share says it all; where they share nothing the declared conflict alone does.
            let apart = !shares && !needed.meets(beyond);
            in_the_way |= apart && route.conflicts.meets(it) && !kept.is_empty();
        }
        in_the_way
    }
}
