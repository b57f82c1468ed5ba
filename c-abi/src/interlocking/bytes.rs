//! Plan and memory of an interlocking as bytes, and back.

use atc_kernel::distance::Metres;
use atc_kernel::interlocking::{
    CircuitSet, Directions, Element, Epoch, Heading, MAX_CIRCUITS, MAX_CODES, MAX_POINTS, Memory, Phase, PointSet,
    Positions, Rear, Route, RouteSet, RouteState, Segment, SegmentSet, Settling, SpeedCode, SpeedLimits, State,
    Station, Track, Unswept, Works,
};
use atc_kernel::time::Ticks;

use super::input::{Counts, Plan};
use crate::memory::{Reader, Writer};

type KernelPlan = atc_kernel::interlocking::Plan<64, 16, 32, 8>;

/// The bytes of a plan: 64 routes of 461, 8 segments of 139, 32 points of 8, 64 lengths, limits, distances, times
/// and counts;
/// 1 to fill.
pub(super) const PARAMETERS: usize = 31160;

fn put_positions(positions: Positions, to: &mut Writer<'_>) {
    to.u32(positions.normal.bits());
    to.u32(positions.reverse.bits());
}

fn take_positions(from: &mut Reader<'_>) -> Option<Positions> {
    Some(Positions { normal: PointSet::from_bits(from.u32()?), reverse: PointSet::from_bits(from.u32()?) })
}

fn put_element(element: Element, to: &mut Writer<'_>) {
    to.u64(element.circuits.bits());
    put_positions(element.positions, to);
    to.u64(element.beside.bits());
}

fn circuits(from: &mut Reader<'_>) -> Option<CircuitSet> {
    from.u64().map(CircuitSet::from_bits)
}

fn routes(from: &mut Reader<'_>) -> Option<RouteSet> {
    from.u64().map(RouteSet::from_bits)
}

fn segments(from: &mut Reader<'_>) -> Option<SegmentSet> {
    from.u8().map(SegmentSet::from_bits)
}

fn ticks(from: &mut Reader<'_>) -> Option<Ticks> {
    from.u16().map(Ticks)
}

fn heading(from: &mut Reader<'_>) -> Option<Heading> {
    Some(if from.flag()? { Heading::Right } else { Heading::Left })
}

fn take_element(from: &mut Reader<'_>) -> Option<Element> {
    Some(Element { circuits: circuits(from)?, positions: take_positions(from)?, beside: circuits(from)? })
}

fn put_limits(limits: SpeedLimits, to: &mut Writer<'_>) {
    for circuits in limits.parts() {
        to.u64(circuits.bits());
    }
}

fn take_limits(from: &mut Reader<'_>) -> Option<SpeedLimits> {
    let mut limits = [CircuitSet::EMPTY; MAX_CODES];
    for kept in &mut limits {
        *kept = circuits(from)?;
    }
    Some(SpeedLimits::from_parts(limits))
}

fn put_route(route: &Route<16>, to: &mut Writer<'_>) {
    to.flag(route.heading == Heading::Right);
    for circuits in [route.entry, route.approach, route.beyond] {
        to.u64(circuits.bits());
    }
    for element in route.path {
        put_element(element, to);
    }
    to.u8(route.length);
    put_element(route.overlap, to);
    for routes in [route.continuing, route.conflicts] {
        to.u64(routes.bits());
    }
    to.u8(route.from.bits());
    to.u8(route.to.bits());
    for time in [route.drive, route.release, route.stay] {
        to.u16(time.0);
    }
    to.u8(route.speed.0);
    to.u8(route.overlap_speed.0);
    to.flag(route.cab_signalled);
    to.flag(route.calling_on);
}

fn take_route(route: &mut Route<16>, from: &mut Reader<'_>) -> Option<()> {
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

fn put_segment(segment: &Segment<16>, to: &mut Writer<'_>) {
    for circuit in segment.circuits {
        to.u64(circuit.bits());
    }
    to.u8(segment.length);
    to.u64(segment.throat.bits());
    to.flag(segment.outward == Heading::Right);
    to.u8(segment.shared);
}

fn take_segment(segment: &mut Segment<16>, from: &mut Reader<'_>) -> Option<()> {
    for circuit in &mut segment.circuits {
        *circuit = circuits(from)?;
    }
    segment.length = from.u8()?;
    segment.throat = circuits(from)?;
    segment.outward = heading(from)?;
    segment.shared = from.u8()?;
    Some(())
}

/// Writes a plan: [`PARAMETERS`] bytes.
pub(super) fn put_plan(plan: &Plan, to: &mut Writer<'_>) {
    let Plan { layout, counts } = plan;
    for count in [counts.circuits, counts.points, counts.routes, counts.segments] {
        to.u8(count);
    }
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
        to.u64(point.detectors.bits());
    }
    for segment in &plan.segments {
        put_segment(segment, to);
    }
    for route in &plan.routes {
        put_route(route, to);
    }
}

/// Reads a plan, and checks it anew.
pub(super) fn take_plan(from: &mut Reader<'_>) -> Option<Plan> {
    let counts = Counts { circuits: from.u8()?, points: from.u8()?, routes: from.u8()?, segments: from.u8()? };
    let mut plan = KernelPlan::EMPTY;
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
    Station::new(plan).ok().map(|layout| Plan { layout, counts })
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
pub(super) fn put_memory(memory: &Memory<64, 8>, to: &mut Writer<'_>) {
    let Memory { interlocking: state, cycle } = memory;
    for count in state.track.clear_for() {
        to.u8(count);
    }
    to.u16(state.started.0);
    to.u64(state.unswept.circuits.bits());
    to.u64(state.unswept.running.bits());
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
        to.u8(segments.bits());
    }
    for time in state.directions.withdrawn {
        to.u16(time.0);
    }
    to.u64(state.works.blocked.bits());
    to.u64(state.works.confirmed.bits());
    put_limits(state.works.restrictions, to);
    to.u32(state.epoch.0);
    to.u32(cycle.0);
}

/// Reads what the device remembers. Whether it is valid is not looked at.
pub(super) fn take_memory(from: &mut Reader<'_>) -> Option<Memory<64, 8>> {
    let mut clear_for = [0; MAX_CIRCUITS];
    for count in &mut clear_for {
        *count = from.u8()?;
    }
    let started = ticks(from)?;
    let unswept = Unswept { circuits: circuits(from)?, running: routes(from)?, still: ticks(from)? };
    let mut stood = [0; MAX_POINTS];
    for count in &mut stood {
        *count = from.u8()?;
    }
    let points = Settling::from_parts(stood.into(), take_positions(from)?);
    let mut held = [RouteState::IDLE; 64];
    for route in &mut held {
        *route = take_held(from)?;
    }
    let mut directions =
        Directions { toward: segments(from)?, away: segments(from)?, came: segments(from)?, withdrawn: [Ticks(0); 8] };
    for time in &mut directions.withdrawn {
        *time = ticks(from)?;
    }
    let works = Works { blocked: circuits(from)?, confirmed: circuits(from)?, restrictions: take_limits(from)? };
    let interlocking = State {
        track: Track::from_parts(clear_for.into()),
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
