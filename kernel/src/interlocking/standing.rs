//! Where trains may stand behind their fronts, and which speed limits hold there.

use super::layout::Layout;
use super::limits::SpeedLimits;
use super::route::RouteState;
use super::set::CircuitSet;
use super::size::{Size, Small};

/// What is known of where trains stand, and of the limits under them.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Standing<const R: usize, Z: Size = Small> {
    /// For each held route the occupied circuits of its path, of its entry while no place is released, and of its held overlap while its last
    /// circuit is occupied: one train may stand on all of them.
    pub bodies: [CircuitSet<Z>; R],
    /// The occupied circuits that are neither plain line nor of the path of a held route: nobody knows which train is there.
    pub loose: CircuitSet<Z>,
    /// The highest code on each circuit: of the line, of temporary restrictions, of the route that holds it and, where none does, of every
    /// route and overlap over it.
    pub limits: SpeedLimits<Z>,
}

impl<const R: usize, Z: Size> Standing<R, Z> {
    /// Any train may stand anywhere, and trains stop.
    pub const UNKNOWN: Self =
        Self { bodies: [CircuitSet::EMPTY; R], loose: CircuitSet::ALL, limits: SpeedLimits::STOP };

    /// What the routes in these states say of it.
    #[inline]
    pub fn of<const P: usize, const N: usize, const S: usize>(
        layout: &Layout<R, P, N, S, Z>,
        routes: &[RouteState; R],
        occupied: CircuitSet<Z>,
        restrictions: SpeedLimits<Z>,
    ) -> Self {
        //= spec/interlocking.md#atc-9-limits
        //# The limit of a circuit MUST NOT be above its line speed, a temporary restriction, the speed of the route that holds it or, where none does, of any route or overlap over it.
        let plan = layout.plan();
        let mut bodies = [CircuitSet::EMPTY; R];
        let mut held = CircuitSet::EMPTY;
        let mut limits = restrictions.and(plan.line);
        for ((route, state), body) in plan.routes.iter().zip(routes).zip(&mut bodies) {
            if state.is_asked::<Z>() {
                let path = state.path(route).circuits;
                held = held.or(path);
                //= spec/interlocking.md#atc-17-shared-berth
                //# The limit of a berth MUST NOT be above the speed of the calling-on route that holds it.
                let berth = state.overlap(route).circuits.only_if(route.calling_on);
                limits = limits.and_at_most(route.speed, path.or(berth));
                let within = path.and(occupied);
                let entering = state.tail == 0 && !within.is_empty();
                let arrived = within.meets(route.last());
                let beyond = state.overlap(route).circuits.and(occupied);
                *body = within.or(route.entry.and(occupied).only_if(entering)).or(beyond.only_if(arrived));
            }
        }
        for route in &plan.routes {
            limits = limits.and_at_most(route.speed, route.held_from(0).circuits.without(held));
            limits = limits.and_at_most(route.overlap_speed, route.overlap.circuits.without(held));
        }
        let mut known = held;
        for segment in &plan.segments {
            known = known.or(segment.all());
        }
        Self { bodies, loose: occupied.without(known), limits }
    }

    /// Where the train may stand whose front is in `front`: everything that may be one train with it, and where that is not known, every occupied
    /// circuit.
    #[inline]
    pub fn train<const P: usize, const N: usize, const S: usize>(
        &self,
        layout: &Layout<R, P, N, S, Z>,
        occupied: CircuitSet<Z>,
        front: CircuitSet<Z>,
    ) -> CircuitSet<Z> {
        //= spec/interlocking.md#atc-8-train
        //# A train MUST be taken to stand on its front's circuit and, from there on, on every occupied circuit that is of the same held route, its entry included while no place is released and its held overlap while its last circuit is occupied, or follows on plain line; and on every occupied circuit where one of these is neither of a held route nor of plain line.
        let (mut train, mut longer) = (front, front);
        for _ in 0..=MAX_JOINTS {
            train = longer;
            for body in &self.bodies {
                longer = longer.or(body.only_if(body.meets(longer)));
            }
            for segment in &layout.plan().segments {
                longer = longer.or(segment.joined_to(longer, occupied));
            }
            if Z::RESTS && longer == train {
                break;
            }
        }
        if longer != train || train.meets(self.loose) { occupied.or(train) } else { train }
    }
}

/// How many borders of routes and segments a train is followed over.
const MAX_JOINTS: usize = 4;
