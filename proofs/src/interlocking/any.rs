//! Any layout, state and input of the interlocking: what harnesses draw, and what a route holds and keeps.

use crate::Engine;
use crate::engine::{any_byte, any_flag, any_u32};
use atc_kernel::interlocking::{
    CircuitSet, Directions, Element, Epoch, Heading, Input, Layout, MAX_CIRCUITS, Orders, PerPoint, Phase, Plan, Point,
    PointId, PointSet, Position, Positions, Rear, Request, Route, RouteId, RouteSet, RouteState, Segment, SegmentId,
    SegmentSet, Settling, SpeedCode, SpeedLimits, State, Track, Travel, Unswept, Works,
};
use atc_kernel::time::Ticks;

/// The places of a path in the harnesses of one route; 16, as many as the machine has, unless the environment variable
/// `ATC_PLACES` says otherwise (1 to 16); 4 for a wrong kernel: what a short path rejects, a long one does.
pub const PLACES: usize = match option_env!("ATC_PLACES") {
    Some(number) => crate::harness::decimal(number),
    None if cfg!(small) => 4,
    None => 16,
};

/// The places of a path in the harnesses of several routes; 4 unless the environment variable `ATC_PATH` says otherwise;
/// 2 for a wrong kernel.
pub const PATH: usize = match option_env!("ATC_PATH") {
    Some(number) => crate::harness::decimal(number),
    None if cfg!(small) => 2,
    None => 4,
};

/// The points of a layout in the harnesses where points play a part of their own.
pub const POINTS: usize = 4;

/// The longest loop: over what there is for each circuit, in the layout and in the state.
pub(crate) const LONGEST: usize = MAX_CIRCUITS;

/// Any set of 32 circuits; `likely` is for the lower 16.
pub(crate) fn any_circuits<E: Engine + ?Sized>(
    e: &mut E,
    what: &'static str,
    likely: core::ops::RangeInclusive<u16>,
) -> CircuitSet {
    CircuitSet::from_bits(u64::from(any_u32(e, what, likely)))
}

/// Any positions of 16 points.
pub(super) fn any_positions<E: Engine + ?Sized>(e: &mut E) -> Positions {
    Positions {
        normal: PointSet::from_bits(u32::from(e.word("points in normal position (bits)", 0..=1))),
        reverse: PointSet::from_bits(u32::from(e.word("points in reverse position (bits)", 0..=2))),
    }
}

/// Any set of the layout's routes.
pub(super) fn any_routes<E: Engine + ?Sized>(e: &mut E, what: &'static str) -> RouteSet {
    RouteSet::from_bits(u64::from(e.word(what, 0..=1)))
}

pub(super) fn any_segments<E: Engine + ?Sized>(e: &mut E, what: &'static str) -> SegmentSet {
    SegmentSet::from_bits(any_byte(e, what, 0..=1))
}

/// Any direction of travel.
pub(crate) fn any_heading<E: Engine + ?Sized>(e: &mut E, what: &'static str) -> Heading {
    if any_flag(e, what) { Heading::Right } else { Heading::Left }
}

/// Any route; `number` only hints at likely circuits.
pub(super) fn any_route<E: Engine + ?Sized, const P: usize>(e: &mut E, number: u16) -> Route<P> {
    let first = 1_u16.wrapping_shl(u32::from(number) * 4);
    let mut place = first;
    let path = core::array::from_fn(|_| {
        let circuits = any_circuits(e, "circuit of a place (bits)", place..=place);
        place = place.wrapping_shl(1);
        Element { circuits, positions: any_positions(e), beside: any_circuits(e, "beside a place (bits)", 0..=0) }
    });
    Route {
        heading: any_heading(e, "heading (odd: right)"),
        entry: any_circuits(e, "entry (bits)", first.rotate_right(1)..=first.rotate_right(1)),
        approach: any_circuits(e, "approach (bits)", 0..=0),
        path,
        length: any_byte(e, "length (places)", 1..=4),
        overlap: Element {
            circuits: any_circuits(e, "overlap (bits)", 0..=0),
            positions: any_positions(e),
            beside: any_circuits(e, "beside the overlap (bits)", 0..=0),
        },
        beyond: any_circuits(e, "beyond (bits)", 0x8000..=0x8000),
        continuing: any_routes(e, "continuing routes (bits)"),
        conflicts: any_routes(e, "conflicting routes (bits)"),
        from: any_segments(e, "from segments (bits)"),
        to: any_segments(e, "to segments (bits)"),
        drive: Ticks(e.word("drive time (cycles)", 1..=3)),
        release: Ticks(e.word("release time (cycles)", 1..=3)),
        stay: Ticks(e.word("stay time (cycles)", 1..=3)),
        ..any_speeds(e)
    }
}

/// Any speeds of a route and of its overlap, from one value, and any trains.
pub(super) fn any_speeds<E: Engine + ?Sized, const P: usize>(e: &mut E) -> Route<P> {
    let [route, overlap] = e.word("speed code, and 256 times that of the overlap", 0..=3).to_le_bytes();
    let kind = e.word("all trains are cab-signalled (odd: yes), and it is a calling-on route (2 more)", 0..=1);
    let (cab_signalled, calling_on) = (kind & 1 == 1, kind >> 1 == 1);
    Route { speed: SpeedCode(route), overlap_speed: SpeedCode(overlap), cab_signalled, calling_on, ..Route::NONE }
}

/// Any plan, as far as the interlocking looks at it.
pub(crate) fn any_plan<E: Engine + ?Sized, const R: usize, const P: usize, const N: usize, const S: usize>(
    e: &mut E,
) -> Plan<R, P, N, S> {
    let mut number = 0;
    let routes = core::array::from_fn(|_| {
        let route = any_route(e, number);
        number += 1;
        route
    });
    let points = core::array::from_fn(|_| Point { detectors: any_circuits(e, "detectors of a point (bits)", 0..=0) });
    let mut place = 0x800_u16;
    let segments = core::array::from_fn(|_| Segment {
        circuits: core::array::from_fn(|_| {
            place = place.rotate_left(1);
            any_circuits(e, "circuit of a segment (bits)", place..=place)
        }),
        length: any_byte(e, "length of a segment (circuits)", 0..=1),
        throat: any_circuits(e, "throat (bits)", 8..=8),
        outward: any_heading(e, "direction out to a segment (odd: right)"),
        shared: 0,
    });
    Plan {
        routes,
        points,
        segments,
        clear: any_byte(e, "clear (cycles)", 1..=2),
        turn: Ticks(e.word("turn time (cycles)", 1..=2)),
        start: Ticks(e.word("time after a start (cycles)", 0..=0)),
        settle: any_byte(e, "settling time (cycles)", 0..=0),
        loss: any_byte(e, "longest loss of shunt (cycles)", 0..=0),
        residual: Ticks(e.word("residual running (cycles)", 0..=1)),
        standstill: Ticks(e.word("standstill time (cycles)", 0..=1)),
        ..Plan::EMPTY
    }
}

/// Any layout that the theorems speak of.
pub(super) fn any_layout<E: Engine + ?Sized, const R: usize, const P: usize, const N: usize, const S: usize>(
    e: &mut E,
) -> Option<Layout<R, P, N, S>> {
    let layout = Layout::with_what_proofs_need(any_plan(e)).ok();
    e.assume(layout.is_some());
    layout
}

/// Any layout that the theorems speak of, any valid state of it, and any input: what one cycle begins with.
pub(super) fn any_cycle<E: Engine + ?Sized, const R: usize, const P: usize, const N: usize, const S: usize>(
    e: &mut E,
) -> Option<(Layout<R, P, N, S>, State<R, S>, Input)> {
    let layout = any_layout(e)?;
    let state: State<R, S> = any_state(e);
    let valid = state.is_valid(&layout);
    e.assume(valid);
    if !valid {
        return None;
    }
    Some((layout, state, any_input(e)))
}

/// Any phase.
pub(super) fn any_phase<E: Engine + ?Sized>(e: &mut E) -> Phase {
    match e.word("phase (0 idle, 1 provisional, 2 failed, 3 set, 4 in use, else releasing)", 0..=5) {
        0 => Phase::Idle,
        1 => Phase::Provisional,
        2 => Phase::Failed,
        3 => Phase::Set,
        4 => Phase::InUse,
        _ => Phase::Releasing,
    }
}

/// Any state of a route. What a phase fixes is drawn all the same, and not used.
pub(super) fn any_route_state<E: Engine + ?Sized>(e: &mut E) -> RouteState {
    let phase = any_phase(e);
    let tail = any_byte(e, "released (places)", 0..=2);
    let head = any_byte(e, "entered (places)", 0..=4);
    let overlap = e.word("overlap is held (odd: yes)", 1..=1) & 1 == 1;
    let time = Ticks(e.word("time in the phase (cycles)", 0..=1));
    let stood = Ticks(e.word("stood (cycles)", 0..=0));
    let rear = match e.word("rear (0 approach, 1 entry, else swept)", 0..=2) {
        0 => Rear::Approach,
        1 => Rear::Entry,
        _ => Rear::Swept,
    };
    let never_set = any_flag(e, "withdrawn before it was set (odd: yes)");
    match phase {
        Phase::Idle => RouteState::IDLE,
        Phase::Provisional => RouteState { time, ..RouteState::RESERVED },
        Phase::Failed => RouteState { phase, ..RouteState::RESERVED },
        Phase::Set => RouteState { phase, proved: true, rear, ..RouteState::RESERVED },
        Phase::Releasing if never_set => RouteState { phase, time, ..RouteState::RESERVED },
        Phase::InUse | Phase::Releasing => RouteState { phase, tail, head, overlap, proved: true, time, rear, stood },
    }
}

/// Any points: the first four have any count, and all were detected anywhere.
pub(super) fn any_settling<E: Engine + ?Sized>(e: &mut E) -> Settling {
    let mut stood = PerPoint::all(0);
    for (number, count) in stood.iter_mut().enumerate() {
        if number < POINTS {
            *count = any_byte(e, "a point has stood for (cycles)", 0..=0);
        }
    }
    Settling::from_parts(stood, any_positions(e))
}

/// Anything that may be unswept, or all that a start leaves so.
pub(super) fn any_unswept<E: Engine + ?Sized>(e: &mut E) -> Unswept {
    let whole = e.word("nothing is swept (1: yes)", 0..=0) == 1;
    let any = Unswept {
        circuits: any_circuits(e, "unswept (bits)", 0..=0),
        running: any_routes(e, "running routes (bits)"),
        still: Ticks(e.word("no route has ended to run for (cycles)", 0..=0)),
    };
    if whole { Unswept::INITIAL } else { any }
}

pub(crate) fn any_state<E: Engine + ?Sized, const R: usize, const S: usize>(e: &mut E) -> State<R, S> {
    State {
        track: Track::INITIAL,
        started: Ticks(e.word("started for (cycles)", 0..=0)),
        unswept: any_unswept(e),
        points: any_settling(e),
        routes: core::array::from_fn(|_| any_route_state(e)),
        directions: Directions {
            toward: any_segments(e, "segments towards the station (bits)"),
            away: any_segments(e, "segments away from the station (bits)"),
            came: any_segments(e, "segments that were last towards the station (bits)"),
            withdrawn: core::array::from_fn(|_| Ticks(e.word("permission withdrawn for (cycles)", 0..=2))),
        },
        works: Works {
            blocked: any_circuits(e, "blocked (bits)", 0..=0),
            confirmed: any_circuits(e, "confirmed (bits)", 0..=0),
            restrictions: SpeedLimits::STOP,
        },
        epoch: Epoch(any_u32(e, "epoch", 0..=u16::MAX)),
    }
}

/// Any request, or none.
pub(super) fn any_request<E: Engine + ?Sized>(e: &mut E) -> Option<Request> {
    let kind = e.word("request (0 set, 1 withdraw, 2 drive, 3 turn, else none)", 0..=4);
    let number = any_byte(e, "number of the route, point or segment", 0..=1);
    let other = any_flag(e, "reverse, or away (odd: yes)");
    match kind {
        0 => RouteId::new(number).map(Request::Set),
        1 => RouteId::new(number).map(Request::Withdraw),
        2 => {
            let position = if other { Position::Reverse } else { Position::Normal };
            PointId::new(number).map(|point| Request::Drive(point, position))
        }
        3 => {
            let travel = if other { Travel::Away } else { Travel::Toward };
            SegmentId::new(number).map(|segment| Request::Turn(segment, travel))
        }
        _ => None,
    }
}

pub(crate) fn any_input<E: Engine + ?Sized>(e: &mut E) -> Input {
    Input {
        occupied: any_circuits(e, "occupied (bits)", 0..=15),
        detected: any_positions(e),
        request: any_request(e),
        orders: Orders {
            block: any_circuits(e, "to block (bits)", 0..=0),
            unblock: any_circuits(e, "to unblock (bits)", 0..=0),
            restrict: any_circuits(e, "to restrict (bits)", 0..=0),
            speed: SpeedCode(any_byte(e, "restriction (code)", 0..=7)),
            lift: any_circuits(e, "to lift (bits)", 0..=0),
        },
        consent: any_segments(e, "neighbour permits (bits)"),
    }
}

/// Any layout of routes of which points and segments play no part.
pub(super) fn any_routes_layout<E: Engine + ?Sized, const R: usize, const P: usize>(
    e: &mut E,
) -> Option<Layout<R, P, 0, 0>> {
    any_layout(e)
}

/// The bit of circuit or point `number`, of 32.
pub(super) fn bit(number: u16) -> u64 {
    1 << (number & 31)
}

/// What a route holds of its path, found place by place.
pub(super) fn held<const P: usize>(route: &Route<P>, state: RouteState) -> Element {
    let (mut circuits, mut beside) = (0, 0);
    let (mut normal, mut reverse) = (0, 0);
    for place in 0..P {
        let element = route.path[place];
        if state.phase != Phase::Idle && place >= usize::from(state.tail) && place < usize::from(route.length) {
            circuits |= element.circuits.bits();
            beside |= element.beside.bits();
            normal |= element.positions.normal.bits();
            reverse |= element.positions.reverse.bits();
        }
    }
    let positions = Positions { normal: PointSet::from_bits(normal), reverse: PointSet::from_bits(reverse) };
    Element { circuits: CircuitSet::from_bits(circuits), positions, beside: CircuitSet::from_bits(beside) }
}

/// What a route holds beyond its path.
pub(super) fn kept<const P: usize>(route: &Route<P>, state: RouteState) -> Element {
    if state.phase != Phase::Idle && state.overlap { route.overlap } else { Element::NONE }
}

/// What two elements hold together.
pub(super) fn both(one: Element, other: Element) -> Element {
    let or = |one: CircuitSet, other: CircuitSet| CircuitSet::from_bits(one.bits() | other.bits());
    let points = |one: PointSet, other: PointSet| PointSet::from_bits(one.bits() | other.bits());
    let (mine, its) = (one.positions, other.positions);
    let positions = Positions { normal: points(mine.normal, its.normal), reverse: points(mine.reverse, its.reverse) };
    Element { circuits: or(one.circuits, other.circuits), positions, beside: or(one.beside, other.beside) }
}

/// Whether a train in one place and one in the other strike each other's side.
pub(super) const fn fouls(one: &Element, other: &Element) -> bool {
    one.beside.bits() & other.circuits.bits() | other.beside.bits() & one.circuits.bits() != 0
}
