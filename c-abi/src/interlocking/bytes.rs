//! Plan and memory of an interlocking as bytes, and back.

use atc_kernel::distance::Metres;
use atc_kernel::interlocking::{
    CircuitSet, Directions, Element, Epoch, Heading, Layout, MAX_CODES, Memory, PerCircuit, PerPoint, Phase, PointSet,
    Positions, Rear, Route, RouteSet, RouteState, Segment, SegmentSet, Settling, SpeedCode, SpeedLimits, State, Track,
    Unswept, Works,
};
use atc_kernel::time::Ticks;

use super::input::{Plan, There};
use super::sets::{Bits, InC, Set};
use crate::memory::{HEADER, Reader, Writer};

/// The bytes of a set of circuits, of points, of segments.
const fn widths<Z: InC>() -> (usize, usize, usize) {
    (<Z::Circuits as Bits>::BYTES, <Z::Points as Bits>::BYTES, <Z::Segments as Bits>::BYTES)
}

/// The bytes of a plan, to the next 8.
pub(super) const fn parameters<const R: usize, const P: usize, const N: usize, const S: usize, Z: InC>() -> usize {
    let (circuits, points, segments) = widths::<Z>();
    let element = 2 * circuits + 2 * points;
    let route = 1 + 3 * circuits + (P + 1) * element + 1 + 2 * circuits + 2 * segments + 6 + 4;
    let segment = P * circuits + 1 + circuits + 2;
    let there = 2 * circuits + points + segments;
    let scalars = 3 + 8 + 2 * CircuitSet::<Z>::MOST + 2 * MAX_CODES + MAX_CODES * circuits;
    (there + scalars + N * circuits + S * segment + R * route).next_multiple_of(8)
}

/// The bytes of a machine: the head, a plan, and what the device remembers, to the next 8.
pub(super) const fn size<const R: usize, const P: usize, const N: usize, const S: usize, Z: InC>() -> usize {
    let (circuits, points, segments) = widths::<Z>();
    let track = CircuitSet::<Z>::MOST + 2 + 2 * circuits + 2;
    let settling = PointSet::<Z>::MOST + 2 * points;
    let directions = 3 * segments + 2 * S;
    let works = 2 * circuits + MAX_CODES * circuits;
    let memory = track + settling + 10 * R + directions + works + 8;
    HEADER + parameters::<R, P, N, S, Z>() + memory.next_multiple_of(8)
}

fn put_circuits<Z: InC>(circuits: CircuitSet<Z>, to: &mut Writer<'_>) {
    Z::Circuits::of(circuits).put(to);
}

fn put_routes<Z: InC>(routes: RouteSet<Z>, to: &mut Writer<'_>) {
    Z::Circuits::of(routes).put(to);
}

fn put_points<Z: InC>(points: PointSet<Z>, to: &mut Writer<'_>) {
    Z::Points::of(points).put(to);
}

fn put_segments<Z: InC>(segments: SegmentSet<Z>, to: &mut Writer<'_>) {
    Z::Segments::of(segments).put(to);
}

fn circuits<Z: InC>(from: &mut Reader<'_>) -> Option<CircuitSet<Z>> {
    Z::Circuits::take(from).map(Set::kernel)
}

fn routes<Z: InC>(from: &mut Reader<'_>) -> Option<RouteSet<Z>> {
    Z::Circuits::take(from).map(Set::kernel)
}

fn points<Z: InC>(from: &mut Reader<'_>) -> Option<PointSet<Z>> {
    Z::Points::take(from).map(Set::kernel)
}

fn segments<Z: InC>(from: &mut Reader<'_>) -> Option<SegmentSet<Z>> {
    Z::Segments::take(from).map(Set::kernel)
}

fn put_positions<Z: InC>(positions: Positions<Z>, to: &mut Writer<'_>) {
    put_points(positions.normal, to);
    put_points(positions.reverse, to);
}

fn take_positions<Z: InC>(from: &mut Reader<'_>) -> Option<Positions<Z>> {
    Some(Positions { normal: points(from)?, reverse: points(from)? })
}

fn put_element<Z: InC>(element: Element<Z>, to: &mut Writer<'_>) {
    put_circuits(element.circuits, to);
    put_positions(element.positions, to);
    put_circuits(element.beside, to);
}

fn ticks(from: &mut Reader<'_>) -> Option<Ticks> {
    from.u16().map(Ticks)
}

fn heading(from: &mut Reader<'_>) -> Option<Heading> {
    Some(if from.flag()? { Heading::Right } else { Heading::Left })
}

fn take_element<Z: InC>(from: &mut Reader<'_>) -> Option<Element<Z>> {
    Some(Element { circuits: circuits(from)?, positions: take_positions(from)?, beside: circuits(from)? })
}

fn put_limits<Z: InC>(limits: SpeedLimits<Z>, to: &mut Writer<'_>) {
    for circuits in limits.parts() {
        put_circuits(circuits, to);
    }
}

fn take_limits<Z: InC>(from: &mut Reader<'_>) -> Option<SpeedLimits<Z>> {
    let mut limits = [CircuitSet::EMPTY; MAX_CODES];
    for kept in &mut limits {
        *kept = circuits(from)?;
    }
    Some(SpeedLimits::from_parts(limits))
}

fn put_route<const P: usize, Z: InC>(route: &Route<P, Z>, to: &mut Writer<'_>) {
    to.flag(route.heading == Heading::Right);
    for circuits in [route.entry, route.approach, route.beyond] {
        put_circuits(circuits, to);
    }
    for element in route.path {
        put_element(element, to);
    }
    to.u8(route.length);
    put_element(route.overlap, to);
    for routes in [route.continuing, route.conflicts] {
        put_routes(routes, to);
    }
    put_segments(route.from, to);
    put_segments(route.to, to);
    for time in [route.drive, route.release, route.stay] {
        to.u16(time.0);
    }
    to.u8(route.speed.0);
    to.u8(route.overlap_speed.0);
    to.flag(route.cab_signalled);
    to.flag(route.calling_on);
}

fn take_route<const P: usize, Z: InC>(route: &mut Route<P, Z>, from: &mut Reader<'_>) -> Option<()> {
    route.heading = heading(from)?;
    (route.entry, route.approach, route.beyond) = (circuits(from)?, circuits(from)?, circuits(from)?);
    for element in &mut route.path {
        *element = take_element(from)?;
    }
    route.length = from.u8()?;
    route.overlap = take_element(from)?;
    (route.continuing, route.conflicts) = (routes(from)?, routes(from)?);
    (route.from, route.to) = (segments(from)?, segments(from)?);
    (route.drive, route.release, route.stay) = (ticks(from)?, ticks(from)?, ticks(from)?);
    route.speed = SpeedCode(from.u8()?);
    route.overlap_speed = SpeedCode(from.u8()?);
    route.cab_signalled = from.flag()?;
    route.calling_on = from.flag()?;
    Some(())
}

fn put_segment<const P: usize, Z: InC>(segment: &Segment<P, Z>, to: &mut Writer<'_>) {
    for circuit in segment.circuits {
        put_circuits(circuit, to);
    }
    to.u8(segment.length);
    put_circuits(segment.throat, to);
    to.flag(segment.outward == Heading::Right);
    to.u8(segment.shared);
}

fn take_segment<const P: usize, Z: InC>(segment: &mut Segment<P, Z>, from: &mut Reader<'_>) -> Option<()> {
    for circuit in &mut segment.circuits {
        *circuit = circuits(from)?;
    }
    segment.length = from.u8()?;
    segment.throat = circuits(from)?;
    segment.outward = heading(from)?;
    segment.shared = from.u8()?;
    Some(())
}

/// Writes a plan: as many bytes as [`parameters`] says.
pub(super) fn put_plan<const R: usize, const P: usize, const N: usize, const S: usize, Z: InC>(
    plan: &Plan<R, P, N, S, Z>,
    to: &mut Writer<'_>,
) {
    let Plan { layout, there } = plan;
    put_circuits(there.circuits, to);
    put_points(there.points, to);
    put_routes(there.routes, to);
    put_segments(there.segments, to);
    let plan = layout.plan();
    to.u8(plan.clear);
    to.u8(plan.settle);
    to.u8(plan.loss);
    for time in [plan.turn, plan.start, plan.residual, plan.standstill] {
        to.u16(time.0);
    }
    for metres in plan.lengths.iter().chain(&plan.braking) {
        to.u16(metres.0);
    }
    put_limits(plan.line, to);
    for point in plan.points {
        put_circuits(point.detectors, to);
    }
    for segment in &plan.segments {
        put_segment(segment, to);
    }
    for route in &plan.routes {
        put_route(route, to);
    }
}

/// Reads a plan, and checks it anew.
pub(super) fn take_plan<const R: usize, const P: usize, const N: usize, const S: usize, Z: InC>(
    from: &mut Reader<'_>,
) -> Option<Plan<R, P, N, S, Z>> {
    let there =
        There { circuits: circuits(from)?, points: points(from)?, routes: routes(from)?, segments: segments(from)? };
    let mut plan = atc_kernel::interlocking::Plan::<R, P, N, S, Z>::EMPTY;
    (plan.clear, plan.settle, plan.loss) = (from.u8()?, from.u8()?, from.u8()?);
    (plan.turn, plan.start) = (ticks(from)?, ticks(from)?);
    (plan.residual, plan.standstill) = (ticks(from)?, ticks(from)?);
    for metres in plan.lengths.iter_mut().chain(&mut plan.braking) {
        *metres = Metres(from.u16()?);
    }
    plan.line = take_limits(from)?;
    for point in &mut plan.points {
        point.detectors = circuits(from)?;
    }
    for segment in &mut plan.segments {
        take_segment(segment, from)?;
    }
    for route in &mut plan.routes {
        take_route(route, from)?;
    }
    Layout::new(plan).ok().map(|layout| Plan { layout, there })
}

const PHASES: [Phase; 6] = [Phase::Idle, Phase::Provisional, Phase::Failed, Phase::Set, Phase::InUse, Phase::Releasing];
const REARS: [Rear; 3] = [Rear::Approach, Rear::Entry, Rear::Swept];

const fn rear(rear: Rear) -> u8 {
    match rear {
        Rear::Approach => 0,
        Rear::Entry => 1,
        Rear::Swept => 2,
    }
}

fn put_held(route: &RouteState, to: &mut Writer<'_>) {
    to.u8(super::output::phase(route.phase));
    to.u8(route.tail);
    to.u8(route.head);
    to.flag(route.overlap);
    to.u16(route.time.0);
    to.u8(rear(route.rear));
    to.flag(route.proved);
    to.u16(route.stood.0);
}

fn take_held(from: &mut Reader<'_>) -> Option<RouteState> {
    Some(RouteState {
        phase: *PHASES.get(usize::from(from.u8()?))?,
        tail: from.u8()?,
        head: from.u8()?,
        overlap: from.flag()?,
        time: ticks(from)?,
        rear: *REARS.get(usize::from(from.u8()?))?,
        proved: from.flag()?,
        stood: ticks(from)?,
    })
}

/// Writes what the device remembers.
pub(super) fn put_memory<const R: usize, const S: usize, Z: InC>(memory: &Memory<R, S, Z>, to: &mut Writer<'_>) {
    let Memory { interlocking: state, cycle } = memory;
    for count in state.track.clear_for() {
        to.u8(count);
    }
    to.u16(state.started.0);
    put_circuits(state.unswept.circuits, to);
    put_routes(state.unswept.running, to);
    to.u16(state.unswept.still.0);
    let (stood, last) = state.points.parts();
    for count in stood {
        to.u8(count);
    }
    put_positions(last, to);
    for route in &state.routes {
        put_held(route, to);
    }
    for segments in [state.directions.toward, state.directions.away, state.directions.came] {
        put_segments(segments, to);
    }
    for time in state.directions.withdrawn {
        to.u16(time.0);
    }
    put_circuits(state.works.blocked, to);
    put_circuits(state.works.confirmed, to);
    put_limits(state.works.restrictions, to);
    to.u32(state.epoch.0);
    to.u32(cycle.0);
}

/// Reads what the device remembers. Whether it is valid is not looked at.
pub(super) fn take_memory<const R: usize, const S: usize, Z: InC>(from: &mut Reader<'_>) -> Option<Memory<R, S, Z>> {
    let mut clear_for = PerCircuit::<u8, Z>::NONE;
    for count in &mut clear_for {
        *count = from.u8()?;
    }
    let started = ticks(from)?;
    let unswept = Unswept { circuits: circuits(from)?, running: routes(from)?, still: ticks(from)? };
    let mut stood = PerPoint::<u8, Z>::NONE;
    for count in &mut stood {
        *count = from.u8()?;
    }
    let points = Settling::from_parts(stood, take_positions(from)?);
    let mut held = [RouteState::IDLE; R];
    for route in &mut held {
        *route = take_held(from)?;
    }
    let mut directions =
        Directions { toward: segments(from)?, away: segments(from)?, came: segments(from)?, withdrawn: [Ticks(0); S] };
    for time in &mut directions.withdrawn {
        *time = ticks(from)?;
    }
    let works = Works { blocked: circuits(from)?, confirmed: circuits(from)?, restrictions: take_limits(from)? };
    let interlocking = State {
        track: Track::from_parts(clear_for),
        started,
        unswept,
        points,
        routes: held,
        directions,
        works,
        epoch: Epoch(from.u32()?),
    };
    Some(Memory { interlocking, cycle: Epoch(from.u32()?) })
}
