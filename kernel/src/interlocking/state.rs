//! The state of the whole device.

use super::direction::{Directions, Needs};
use super::layout::Layout;
use super::point::Settling;
use super::route::{self, RouteState};
use super::set::{CircuitSet, RouteSet};
use super::size::{Size, Small};
use super::table::Epoch;
use super::track::Track;
use super::unswept::Unswept;
use super::works::Works;
use crate::time::Ticks;

/// What the device remembers from one logic cycle to the next.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct State<const R: usize, const S: usize, Z: Size = Small> {
    /// The track circuits.
    pub track: Track<Z>,
    /// For how long the device has run, up to the layout's time.
    pub started: Ticks,
    /// Where trains from before the start may still be on their way.
    pub unswept: Unswept<Z>,
    /// The points.
    pub points: Settling<Z>,
    /// The routes.
    pub routes: [RouteState; R],
    /// The segments of plain line.
    pub directions: Directions<S, Z>,
    /// Blocks and restrictions.
    pub works: Works<Z>,
    /// The number of the cycle.
    pub epoch: Epoch,
}

impl<const R: usize, const S: usize, Z: Size> State<R, S, Z> {
    /// The most restrictive state: all circuits occupied, blocked and restricted to stop; no route held; no segment with a direction.
    pub const INITIAL: Self = Self {
        track: Track::INITIAL,
        started: Ticks(0),
        unswept: Unswept::INITIAL,
        points: Settling::INITIAL,
        routes: [RouteState::IDLE; R],
        directions: Directions::INITIAL,
        works: Works::INITIAL,
        epoch: Epoch(0),
    };

    /// Whether the device can be in this state.
    pub fn is_valid<const P: usize, const N: usize>(&self, layout: &Layout<R, P, N, S, Z>) -> bool {
        let plan = layout.plan();
        let mut valid = self.track.is_valid(plan.clear) && self.works.is_valid() && self.directions.is_valid(plan.turn);
        valid &= self.points.is_valid(plan.settle) && self.started <= plan.start;
        let starts = self.is_starting(layout);
        let none = self.works.confirmed.is_empty() && self.directions.toward.or(self.directions.away).is_empty();
        valid &= !starts || none && self.unswept == Unswept::INITIAL;
        let mut held = CircuitSet::EMPTY;
        for (route, state) in plan.routes.iter().zip(&self.routes) {
            valid &= state.is_valid(route) && (!starts || !state.is_held());
            held = held.or(state.circuits(route)).or(state.beside(route));
        }
        let needs = Needs::of(layout, &self.routes);
        valid &= self.directions.toward.contains(needs.toward) && self.directions.away.contains(needs.away);
        valid &= !held.meets(self.works.confirmed);
        for one in 0..R {
            for other in 0..one {
                valid &= self.compatible(layout, one, other);
            }
        }
        valid
    }

    /// Whether a train may still count on what was before the device started.
    pub fn is_starting<const P: usize, const N: usize>(&self, layout: &Layout<R, P, N, S, Z>) -> bool {
        self.started < layout.plan().start
    }

    /// Whether two routes hold what they may hold together: no common circuit but an overlap under a continuing route, or a berth with the train of
    /// the other one at a stand; nothing beside what the other holds, but the path of a continuing route; no point both ways, no declared conflict.
    pub fn compatible<const P: usize, const N: usize>(
        &self,
        layout: &Layout<R, P, N, S, Z>,
        one: usize,
        other: usize,
    ) -> bool {
        let routes = &layout.plan().routes;
        let (states, pair) = ((self.routes[one], self.routes[other]), (&routes[one], &routes[other]));
        let numbers = (RouteSet::nth(one), RouteSet::nth(other));
        let paths = (states.0.path(pair.0), states.1.path(pair.1));
        let overlaps = (states.0.overlap(pair.0), states.1.overlap(pair.1));
        let goes_on = (pair.1.continuing.meets(numbers.0), pair.0.continuing.meets(numbers.1));
        let together = (
            pair.0.calling_on && states.1.stands(pair.1) || goes_on.1,
            pair.1.calling_on && states.0.stands(pair.0) || goes_on.0,
        );
        let apart = !paths.0.circuits.meets(paths.1.circuits)
            && !overlaps.0.circuits.meets(overlaps.1.circuits)
            && (!paths.0.circuits.meets(overlaps.1.circuits) || together.1)
            && (!paths.1.circuits.meets(overlaps.0.circuits) || together.0)
            && !route::foul((paths.0, overlaps.0, goes_on.0), (paths.1, overlaps.1, goes_on.1));
        let agree = !states.0.positions(pair.0).opposes(states.1.positions(pair.1));
        let both = states.0.is_held() && states.1.is_held();
        let declared = pair.0.conflicts.meets(numbers.1) || pair.1.conflicts.meets(numbers.0);
        apart && agree && !(both && declared)
    }
}
