//! Interlocking and ATC in one device: routes, points, signals and the telegrams of every track circuit (JP4290933B2).
//!
//! One cycle runs in a fixed order over one table that both parts share, so that neither waits for the other: the circuits
//! are tracked once ([`Track`]); the interlocking checks the request, drives points, reserves routes and sets signals; it writes
//! the [`Table`]; the ATC reads it and says, for each circuit with a train, which circuit is the last that it may enter and how fast.
//!
//! Nothing here knows a station: a [`Layout`] does. The theorems hold for every layout that its constructor accepts.
//!
//! Requirements: `spec/interlocking.md`. Read in this order: [`Plan`] and [`Layout`] (parameters), [`Rule`] (what is checked),
//! [`Input`] and [`Output`], [`State`] with its `is_valid`, [`RouteState`], [`Layout::cycle`].

mod atc;
mod check;
mod code;
mod combined;
mod direction;
mod layout;
mod limits;
mod point;
mod request;
mod room;
mod route;
mod set;
mod signal;
mod size;
mod standing;
mod state;
mod table;
mod track;
mod unswept;
mod works;

pub use crate::heading::Heading;
pub use atc::{MAX_LINKS, Movement, begins, connect, movement, silent, telegram};
pub use check::{Broken, Place, Rule};
pub use code::{MAX_CODES, SpeedCode};
pub use combined::{Combined, Commands, Memory};
pub use direction::{Directions, Needs, Travel};
pub use layout::{Element, LargeStation, Layout, MAX_CIRCUITS, MAX_POINTS, Plan, Point, Route, Segment, Station};
pub use limits::SpeedLimits;
pub use point::Settling;
pub use request::{Refusal, Request, Sight, refuse_again, refuse_point, refuse_route};
pub use room::{code_stops_within, needed_room};
pub use route::{Phase, Rear, RouteState};
pub(crate) use set::short;
pub use set::{
    CircuitId, CircuitSet, PerCircuit, PerPoint, PointId, PointSet, Position, Positions, RouteId, RouteSet, SegmentId,
    SegmentSet,
};
pub use signal::{Grant, View, grant, ready, shows_proceed};
pub use size::{Bits, Large, Size, Small, Value, Values};
pub use standing::Standing;
pub use state::State;
pub use table::{Contents, Epoch, Table};
pub use track::Track;
pub use unswept::{Unswept, Ways};
pub use works::{Orders, Works};

use crate::Machine;
use crate::time::Ticks;
use direction::Turned;
use point::Demand;

/// What the device reads in one logic cycle.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Input<Z: Size = Small> {
    /// The circuits that are reported occupied.
    pub occupied: CircuitSet<Z>,
    /// The positions in which points are detected; a point that is in both is in neither.
    pub detected: Positions<Z>,
    /// One request, or none.
    pub request: Option<Request>,
    /// What staff command.
    pub orders: Orders<Z>,
    /// The segments where the neighbour permits this station to send trains, by a telegram that is no older than its life.
    pub consent: SegmentSet<Z>,
}

/// What the interlocking commands in one logic cycle. With the telegrams it is [`Commands`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Output<const R: usize, Z: Size = Small> {
    /// The routes whose signals show proceed; all others show stop.
    pub proceed: RouteSet<Z>,
    /// The points that are driven, and whereto.
    pub drives: Positions<Z>,
    /// The segments where this station permits the neighbour to send trains.
    pub permits: SegmentSet<Z>,
    /// The blocked circuits that staff may rely on.
    pub confirmed: CircuitSet<Z>,
    /// What became of the request.
    pub answer: Option<Result<(), Refusal>>,
    /// The shared table, from which the ATC makes the telegrams.
    pub table: Table<R, Z>,
}

/// Positions as detection delivers them, without points that are in both.
#[inline]
fn plausible<Z: Size>(detected: Positions<Z>) -> Positions<Z> {
    detected.without(detected.normal.and(detected.reverse))
}

impl<const R: usize, const P: usize, const N: usize, const S: usize, Z: Size> Layout<R, P, N, S, Z> {
    /// One logic cycle: receive, track, check, points, reservation, signals, shared table.
    #[must_use]
    pub fn cycle(&self, mut state: State<R, S, Z>, input: Input<Z>) -> (State<R, S, Z>, Output<R, Z>) {
        let (track, occupied) = state.track.step(self.plan().clear, input.occupied);
        state.track = track;
        self.interlock(state, Input { occupied, ..input })
    }

    /// The cycle after the tracking: `input.occupied` are the circuits that count as occupied.
    #[inline]
    #[must_use]
    pub fn interlock(&self, mut state: State<R, S, Z>, input: Input<Z>) -> (State<R, S, Z>, Output<R, Z>) {
        let plan = self.plan();
        let (occupied, detected) = (input.occupied, plausible(input.detected));
        let starting = state.is_starting(self);
        if starting {
            state.started = Ticks(state.started.0.saturating_add(1));
        }
        state.works = state.works.obey(input.orders);
        for (route, held) in plan.routes.iter().zip(&mut state.routes) {
            *held = held.follow(route, occupied);
        }
        let under = point::meeting(self, occupied);
        let from_before = state.unswept;
        let (unswept, ways) =
            if starting { (Unswept::INITIAL, Ways::default()) } else { from_before.sweep(self, occupied) };
        state.unswept = unswept;
        //= spec/interlocking.md#ilk-26-outward
        //# A route to a segment MUST be set and show proceed, and trains be granted the segment outward, only in cycles in which the neighbour permits this station to send.
        let directions = (state.directions.toward, state.directions.away.and(input.consent));
        let closed = direction::closed(self, state.works.blocked);
        let sight =
            Sight { occupied, blocked: state.works.blocked, closed, detected, under, directions, from_before, ways };
        //= spec/interlocking.md#ilk-24-start
        //# After a start, until the layout's time has passed, a device MUST refuse to set a route, to drive a point and to turn a segment, and confirm no block.
        let moves = !matches!(input.request, None | Some(Request::Withdraw(_)));
        let refused = starting && moves;
        let heard = Input { request: if refused { None } else { input.request }, ..input };
        let waited = state.directions.withdrawn;
        let (alone, answer) = self.carry_out(&mut state, heard, sight);
        let answer = if refused { Some(Err(Refusal::Starting)) } else { answer };
        //= spec/interlocking.md#ilk-30-points-ahead
        //# A point that a kept place, or a kept overlap, needs MUST NOT be driven.
        let shut = point::meeting(self, state.works.blocked);
        let mut demand = Demand { wanted: alone, locked: ways.points.or(shut) };
        for (route, held) in plan.routes.iter().zip(&state.routes) {
            if held.is_asked::<Z>() {
                demand = demand.with(route, *held);
            }
        }
        let drives = demand.drives(detected, under);
        let (points, firm) = state.points.step(N, plan.settle, detected, drives);
        state.points = points;
        let unsent = SegmentSet::ALL.without(input.consent);
        let view = View { occupied, blocked: state.works.blocked, closed: closed.or(unsent), firm };
        //= spec/interlocking.md#ilk-32-line-ahead
        //# While a route out to a segment runs, the segment MUST be treated as one to which a route out is held.
        let needs = Needs::of(self, &state.routes).and_out_to(ways.outward);
        //= spec/interlocking.md#ilk-31-blocks-ahead
        //# A block on an unswept circuit MUST NOT be confirmed.
        let mut circuits = direction::open_line(self, &waited, (occupied, needs)).or(unswept.circuits).or(ways.beside);
        // Their strokes may begin, or go on.
        let mut moving = PointSet::ALL.without(firm.points());
        for (route, held) in plan.routes.iter().zip(&mut state.routes) {
            if held.is_asked::<Z>() {
                let ready = held.phase == Phase::Provisional && signal::ready(route, *held, view);
                *held = held.reserve(route, occupied, ready);
                moving = moving.or(held.positions(route).points());
                let kept = held.circuits(route).or(held.beside(route));
                circuits = circuits.or(kept).or(held.before_signal(route, occupied));
            }
        }
        circuits = circuits.or(point::detectors(self, moving));
        if !starting {
            let struck = works::struck(self, state.works, occupied);
            state.works = state.works.confirm(circuits.or(struck), occupied);
        }
        state.epoch = state.epoch.next();
        let (proceed, grants) = signal::all(self, &state.routes, view);
        let contents = Contents {
            occupied,
            blocked: state.works.blocked,
            grants,
            toward: state.directions.toward,
            away: state.directions.away.and(input.consent),
            standing: Standing::of(self, &state.routes, occupied, state.works.restrictions),
        };
        let table = Table::write(state.epoch, contents);
        let (permits, confirmed) = (state.directions.toward.without(closed), state.works.confirmed);
        (state, Output { proceed, drives, permits, confirmed, answer, table })
    }

    /// Carries out the request, or refuses it. The positions are those of an individual point command.
    #[inline]
    fn carry_out(
        &self,
        state: &mut State<R, S, Z>,
        input: Input<Z>,
        sight: Sight<Z>,
    ) -> (Positions<Z>, Option<Result<(), Refusal>>) {
        //= spec/interlocking.md#ilk-4-all-or-nothing
        //# A request that is refused MUST NOT be remembered, and changes nothing but that a segment that is to be turned away is no longer permitted to the neighbour.
        let mut alone = Positions::NONE;
        let mut answer = None;
        for (number, route) in self.plan().routes.iter().enumerate() {
            match input.request {
                Some(Request::Set(asked)) if usize::from(asked.number()) == number => {
                    let held = state.routes[number];
                    let again = request::refuse_again(route, held, sight);
                    let refusal = request::refuse_route(self, &state.routes, number, sight);
                    let refusal = if held.may_resume() { again } else { refusal };
                    if refusal.is_none() {
                        state.routes[number] = state.routes[number].requested();
                    }
                    answer = Some(refusal);
                }
                Some(Request::Withdraw(asked)) if usize::from(asked.number()) == number => {
                    let held = state.routes[number];
                    let refusal = if route.exists() { Refusal::NotHeld } else { Refusal::Unknown };
                    answer = Some((!held.is_held()).then_some(refusal));
                    if held.is_held() {
                        state.routes[number] = held.withdraw(route, sight.occupied);
                    }
                }
                _ => {}
            }
        }
        if let Some(Request::Drive(point, position)) = input.request {
            let refusal = request::refuse_point(self, &state.routes, point, sight);
            alone = Positions::of(point, position).only_if(refusal.is_none());
            answer = Some(refusal);
        }
        let command = match input.request {
            Some(Request::Turn(segment, travel)) => Some((segment.alone(), travel)),
            _ => None,
        };
        let needs = Needs::of(self, &state.routes).and_out_to(sight.ways.outward);
        let (directions, turned) =
            direction::turn(self, state.directions, command, (sight.occupied, sight.closed, needs, input.consent));
        state.directions = directions;
        answer = match turned {
            Some(Turned::Done) => Some(None),
            Some(Turned::Waiting) => Some(Some(Refusal::Waiting)),
            Some(Turned::InTheWay) => Some(Some(Refusal::Direction)),
            Some(Turned::Unknown) => Some(Some(Refusal::Unknown)),
            Some(Turned::Blocked) => Some(Some(Refusal::Blocked)),
            None => answer,
        };
        let unknown = input.request.map(|_| Some(Refusal::Unknown));
        (alone, answer.or(unknown).map(|refusal| refusal.map_or(Ok(()), Err)))
    }

    /// The telegram of each circuit, from the shared table and the number of this cycle: all stop telegrams if the table is not
    /// of this cycle, or damaged. `None`: this device sends nothing there; the neighbour's is the one that speaks.
    /// [`Combined`] has the number of the cycle, and its output has these telegrams: a device is that machine.
    #[must_use]
    pub fn telegrams(&self, table: &Table<R, Z>, epoch: Epoch) -> PerCircuit<Option<Movement<Z>>, Z> {
        let contents = table.read(epoch);
        let silent = silent(self, contents.as_ref());
        let begins = contents.as_ref().map_or(CircuitSet::EMPTY, |contents| begins(self, contents));
        PerCircuit::from_fn(|number| {
            let circuit = CircuitId::new(short(number)).unwrap_or(CircuitId::ZERO);
            (!silent.has(circuit)).then(|| telegram(self, contents.as_ref(), begins, circuit))
        })
    }
}

impl<const R: usize, const P: usize, const N: usize, const S: usize, Z: Size> Machine for Layout<R, P, N, S, Z> {
    type State = State<R, S, Z>;
    type Input = Input<Z>;
    type Output = Output<R, Z>;

    const SAFE: Self::Output = Output {
        proceed: RouteSet::EMPTY,
        drives: Positions::NONE,
        permits: SegmentSet::EMPTY,
        confirmed: CircuitSet::EMPTY,
        answer: None,
        table: Table::UNREADABLE,
    };

    fn initial(&self) -> Self::State {
        State::INITIAL
    }

    fn step(&self, state: Self::State, input: Self::Input) -> (Self::State, Self::Output) {
        self.cycle(state, input)
    }
}
