//! What is in the way of a request that is refused. The kernel names the reason; the names that go with it follow from its state,
//! which a refused request does not change.

use std::collections::BTreeSet;

use atc_kernel::interlocking::{
    CircuitSet, Input, PointSet, Positions, Refusal, Request, Route, RouteSet, RouteState, SegmentSet, Size, Travel,
};

use super::Interlocked;

/// What the request asks for: circuits of the path and of the overlap, and positions of points.
struct Asked<Z: Size> {
    path: CircuitSet<Z>,
    overlap: CircuitSet<Z>,
    positions: Positions<Z>,
    /// What is beside path and overlap.
    beside: CircuitSet<Z>,
    number: RouteSet<Z>,
    conflicts: RouteSet<Z>,
    continuing: RouteSet<Z>,
    calling_on: bool,
    entry: CircuitSet<Z>,
    approach: CircuitSet<Z>,
    /// The segment that the route leads to, or that is to be turned.
    out: SegmentSet<Z>,
}

impl<const R: usize, const P: usize, const N: usize, const S: usize, Z: Size> Interlocked<R, P, N, S, Z> {
    /// The names that belong to a refusal of this cycle's request.
    pub(super) fn because(&self, input: Input<Z>, occupied: CircuitSet<Z>, refusal: Refusal) -> BTreeSet<String> {
        let Some(request) = input.request else { return BTreeSet::new() };
        let asked = self.asked(request);
        let all = asked.path.or(asked.overlap).or(asked.beside);
        let detected = input.detected.without(input.detected.normal.and(input.detected.reverse));
        match refusal {
            Refusal::Unknown | Refusal::Starting | Refusal::AlreadyHeld | Refusal::NotHeld => match request {
                Request::Set(route) | Request::Withdraw(route) => {
                    self.names.routes.get(usize::from(route.number())).cloned().into_iter().collect()
                }
                Request::Drive(point, _) => self.points_of(point.alone()),
                Request::Turn(segment, _) => self.segments_of(segment.alone()),
            },
            Refusal::Conflict => self.held_where(|number, _, _| asked.conflicts.meets(number)),
            Refusal::PathHeld => self.held_where(|number, route, state| {
                let goes_on = !asked.number.is_empty() && route.continuing.meets(asked.number);
                let (path, overlap) = (state.path(route).circuits, state.overlap(route).circuits);
                let theirs = overlap.or(path.only_if(!asked.continuing.meets(number)));
                let mine = asked.overlap.or(asked.path.only_if(!goes_on));
                let fouls = asked.beside.meets(theirs) || !asked.number.is_empty() && state.beside(route).meets(mine);
                path.meets(asked.path) || overlap.meets(asked.path) && !goes_on || fouls
            }),
            Refusal::OverlapHeld => self.held_where(|number, route, state| {
                let path = state.path(route).circuits;
                let beside = asked.continuing.meets(number) || asked.calling_on && state.stands(route);
                state.overlap(route).circuits.meets(asked.overlap) || path.meets(asked.overlap) && !beside
            }),
            Refusal::PointLocked => self.held_where(|_, route, state| {
                let held = state.positions(route);
                match request {
                    Request::Drive(point, _) => held.points().has(point),
                    _ => held.opposes(asked.positions),
                }
            }),
            Refusal::Occupied if asked.calling_on => self.circuits_of(asked.path.or(asked.beside).and(occupied)),
            Refusal::Occupied => self.circuits_of(all.and(occupied)),
            Refusal::NotCalledFor if asked.entry.meets(occupied) => self.circuits_of(asked.overlap),
            Refusal::NotCalledFor => self.circuits_of(asked.entry),
            Refusal::Unswept => match request {
                Request::Drive(point, _) => self.points_of(point.alone()),
                _ if all.meets(self.state().unswept.circuits) => {
                    self.circuits_of(all.and(self.state().unswept.circuits))
                }
                _ => self.points_of(asked.positions.missing_in(detected).points()),
            },
            Refusal::Blocked => {
                let moving = self.detectors(asked.positions.missing_in(detected).points());
                let before = asked.approach.only_if(asked.approach.without(asked.entry).meets(occupied));
                let needed = all.or(before).or(self.line(asked.out)).or(moving);
                self.circuits_of(needed.and(self.state().works.blocked))
            }
            Refusal::PointUnderTrain => match request {
                Request::Drive(point, _) => self.points_of(point.alone()),
                _ => self.points_of(self.under(asked.positions.missing_in(detected).points(), occupied)),
            },
            Refusal::Direction => self.in_the_way(request, occupied),
            Refusal::Waiting => {
                // A segment with a block waits for its end; otherwise for time, or for the neighbour.
                let blocked: BTreeSet<_> = self.circuits_of(self.line(asked.out).and(self.state().works.blocked));
                if blocked.is_empty() { self.segments_of(asked.out) } else { blocked }
            }
        }
    }

    fn asked(&self, request: Request) -> Asked<Z> {
        let plan = self.layout.plan();
        let nothing = Asked {
            path: CircuitSet::EMPTY,
            overlap: CircuitSet::EMPTY,
            positions: Positions::NONE,
            beside: CircuitSet::EMPTY,
            number: RouteSet::EMPTY,
            conflicts: RouteSet::EMPTY,
            continuing: RouteSet::EMPTY,
            calling_on: false,
            entry: CircuitSet::EMPTY,
            approach: CircuitSet::EMPTY,
            out: SegmentSet::EMPTY,
        };
        match request {
            Request::Set(route) => {
                let number = route.alone();
                let route = &plan.routes[usize::from(route.number())];
                let path = route.held_from(0);
                let whole = path.or(route.overlap);
                Asked {
                    path: path.circuits,
                    overlap: route.overlap.circuits,
                    positions: whole.positions,
                    beside: whole.beside,
                    number,
                    conflicts: route.conflicts,
                    continuing: route.continuing,
                    calling_on: route.calling_on,
                    entry: route.entry,
                    approach: route.approach,
                    out: route.to,
                }
            }
            Request::Drive(point, _) => Asked { path: plan.points[usize::from(point.number())].detectors, ..nothing },
            Request::Turn(segment, _) => Asked { out: segment.alone(), ..nothing },
            Request::Withdraw(_) => nothing,
        }
    }

    /// The circuits of segments.
    fn line(&self, segments: SegmentSet<Z>) -> CircuitSet<Z> {
        let mut circuits = CircuitSet::EMPTY;
        for (number, segment) in self.layout.plan().segments.iter().enumerate() {
            circuits = circuits.or(segment.all().only_if(segments.meets(SegmentSet::nth(number))));
        }
        circuits
    }

    /// The detector circuits of points.
    fn detectors(&self, points: PointSet<Z>) -> CircuitSet<Z> {
        let all = self.layout.plan().points.iter().enumerate();
        all.fold(CircuitSet::EMPTY, |circuits, (number, point)| {
            circuits.or(point.detectors.only_if(points.meets(PointSet::nth(number))))
        })
    }

    fn under(&self, points: PointSet<Z>, occupied: CircuitSet<Z>) -> PointSet<Z> {
        let mut under = PointSet::EMPTY;
        for (number, point) in self.layout.plan().points.iter().enumerate() {
            under = under.or(PointSet::nth(number).only_if(point.detectors.meets(occupied)));
        }
        under.and(points)
    }

    /// The segments that a route lacks; or what keeps a segment from turning: circuits with trains, and routes.
    fn in_the_way(&self, request: Request, occupied: CircuitSet<Z>) -> BTreeSet<String> {
        let directions = self.state().directions;
        match request {
            Request::Set(route) => {
                let route = &self.layout.plan().routes[usize::from(route.number())];
                self.segments_of(route.from.without(directions.toward).or(route.to.without(directions.away)))
            }
            Request::Turn(segment, travel) => {
                let plan = &self.layout.plan().segments[usize::from(segment.number())];
                let mut names: BTreeSet<_> = self.circuits_of(plan.all().or(plan.throat).and(occupied));
                names.extend(self.held_where(|_, route, state| match travel {
                    Travel::Toward => route.to.has(segment),
                    Travel::Away => route.from.has(segment) && state.tail == 0,
                }));
                names
            }
            Request::Withdraw(_) | Request::Drive(..) => BTreeSet::new(),
        }
    }

    /// The held routes for which it is so.
    fn held_where(&self, is_so: impl Fn(RouteSet<Z>, &Route<P, Z>, &RouteState) -> bool) -> BTreeSet<String> {
        let routes = self.layout.plan().routes.iter().zip(&self.state().routes).enumerate();
        let found =
            routes.filter(|(number, (route, state))| state.is_held() && is_so(RouteSet::nth(*number), route, state));
        found.filter_map(|(number, _)| self.names.routes.get(number).cloned()).collect()
    }
}
