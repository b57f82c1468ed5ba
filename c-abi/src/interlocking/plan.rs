//! The kernel's plan from C's flat arrays.

use atc_kernel::distance::Metres;
use atc_kernel::interlocking::{
    Broken, CircuitId, CircuitSet, Element, Heading, Layout, Place, PointSet, Positions, Route, RouteSet, Rule,
    Segment, SegmentSet, SpeedCode, SpeedLimits,
};
use atc_kernel::time::Ticks;

use super::forms::{
    ATC_HEADING_LEFT, ATC_HEADING_RIGHT, ATC_PLACE_CIRCUIT, ATC_PLACE_OVERLAP, ATC_PLACE_PATH, ATC_PLACE_PLAN,
    ATC_PLACE_POINT, ATC_PLACE_ROUTE, ATC_PLACE_ROUTES, ATC_PLACE_SEGMENT, ATC_PLACE_SEGMENTS, atc_place, element_of,
    interlocking_config_of, route_of, segment_of,
};
use super::input::{Plan, There};
use super::sets::InC;
use crate::{atc_status, flag};

/// What is wrong in a plan, and where.
pub(crate) type Fault = (atc_status, atc_place);

/// C's plan for a size of station.
pub(crate) type ConfigOf<Z> = interlocking_config_of<<Z as InC>::Circuits, <Z as InC>::Points, <Z as InC>::Segments>;

pub(crate) type ElementOf<Z> = element_of<<Z as InC>::Circuits, <Z as InC>::Points>;
pub(crate) type RouteOf<Z> = route_of<<Z as InC>::Circuits, <Z as InC>::Points, <Z as InC>::Segments>;
pub(crate) type SegmentOf<Z> = segment_of<<Z as InC>::Circuits>;

/// The arrays of a configuration, with their lengths: none is longer than its most.
pub(crate) struct Arrays<'a, Z: InC> {
    pub(crate) lengths_m: &'a [u16],
    pub(crate) line_codes: &'a [u8],
    pub(crate) detectors: &'a [Z::Circuits],
    pub(crate) segments: &'a [SegmentOf<Z>],
    pub(crate) segment_circuits: &'a [u8],
    pub(crate) routes: &'a [RouteOf<Z>],
    pub(crate) elements: &'a [ElementOf<Z>],
    pub(crate) braking_m: &'a [u16],
}

fn place(kind: u32, first: usize) -> atc_place {
    atc_place { kind, first: u32::try_from(first).unwrap_or(u32::MAX), second: 0 }
}

/// The checked layout of a configuration whose arrays are `arrays`.
///
/// # Errors
/// The first thing that is wrong: what is out of its range, then the first rule of the kernel that is broken.
pub(crate) fn layout<const R: usize, const P: usize, const N: usize, const S: usize, Z: InC>(
    config: &ConfigOf<Z>,
    arrays: &Arrays<'_, Z>,
) -> Result<Plan<R, P, N, S, Z>, Fault> {
    let there = There {
        circuits: (0..arrays.lengths_m.len()).fold(CircuitSet::EMPTY, |all, number| all.or(CircuitSet::nth(number))),
        points: (0..arrays.detectors.len()).fold(PointSet::EMPTY, |all, number| all.or(PointSet::nth(number))),
        routes: (0..arrays.routes.len()).fold(RouteSet::EMPTY, |all, number| all.or(RouteSet::nth(number))),
        segments: (0..arrays.segments.len()).fold(SegmentSet::EMPTY, |all, number| all.or(SegmentSet::nth(number))),
    };
    let mut plan = atc_kernel::interlocking::Plan::<R, P, N, S, Z>::EMPTY;
    plan.clear = config.clear_cycles;
    plan.turn = Ticks(config.turn_cycles);
    plan.start = Ticks(config.start_cycles);
    plan.settle = config.settle_cycles;
    plan.loss = config.loss_cycles;
    plan.residual = Ticks(config.residual_cycles);
    plan.standstill = Ticks(config.standstill_cycles);
    for (kept, metres) in plan.lengths.iter_mut().zip(arrays.lengths_m) {
        *kept = Metres(*metres);
    }
    for (kept, metres) in plan.braking.iter_mut().zip(arrays.braking_m) {
        *kept = Metres(*metres);
    }
    for (number, code) in arrays.line_codes.iter().enumerate() {
        let code = code_of(*code).map_err(|status| (status, place(ATC_PLACE_CIRCUIT, number)))?;
        // The highest code is no limit.
        let limited = CircuitSet::nth(number).only_if(code < SpeedCode::MOST);
        plan.line = plan.line.and(SpeedLimits::NONE.and_at_most(code, limited));
    }
    for (number, (kept, circuits)) in plan.points.iter_mut().zip(arrays.detectors).enumerate() {
        kept.detectors = there.circuits(*circuits).map_err(|status| (status, place(ATC_PLACE_POINT, number)))?;
    }
    for (number, (kept, given)) in plan.segments.iter_mut().zip(arrays.segments).enumerate() {
        segment(there, given, arrays.segment_circuits, kept)
            .map_err(|status| (status, place(ATC_PLACE_SEGMENT, number)))?;
    }
    for (number, (kept, given)) in plan.routes.iter_mut().zip(arrays.routes).enumerate() {
        route(there, given, arrays.elements, kept).map_err(|status| (status, place(ATC_PLACE_ROUTE, number)))?;
    }
    match Layout::new(plan) {
        Ok(layout) => Ok(Plan { layout, there }),
        Err(broken) => Err(fault(broken)),
    }
}

fn code_of(code: u8) -> Result<SpeedCode, atc_status> {
    if code > SpeedCode::MOST.0 { Err(atc_status::UnknownCode) } else { Ok(SpeedCode(code)) }
}

fn heading(heading: u8) -> Result<Heading, atc_status> {
    match heading {
        ATC_HEADING_LEFT => Ok(Heading::Left),
        ATC_HEADING_RIGHT => Ok(Heading::Right),
        _ => Err(atc_status::UnknownChoice),
    }
}

/// The `length` entries from `first` on: 1 to `most` of them.
fn part<T>(array: &[T], most: usize, first: u16, length: u16) -> Result<(&[T], u8), atc_status> {
    let first = usize::from(first);
    let there = array.get(first..).and_then(|rest| rest.get(..usize::from(length)));
    match u8::try_from(length) {
        // In the kernel a length of 0 means that there is no such thing; what is listed is there.
        Ok(0) => Err(atc_status::PlanNotThere),
        Ok(length) if usize::from(length) <= most => Ok((there.ok_or(atc_status::BeyondArray)?, length)),
        _ => Err(atc_status::PlanPathTooLong),
    }
}

fn element<Z: InC>(there: There<Z>, given: &ElementOf<Z>) -> Result<Element<Z>, atc_status> {
    let (normal, reverse) = (there.points(given.normal)?, there.points(given.reverse)?);
    let (circuits, beside) = (there.circuits(given.circuits)?, there.circuits(given.beside)?);
    Ok(Element { circuits, positions: Positions { normal, reverse }, beside })
}

fn segment<const P: usize, Z: InC>(
    there: There<Z>,
    given: &SegmentOf<Z>,
    circuits: &[u8],
    kept: &mut Segment<P, Z>,
) -> Result<(), atc_status> {
    let (circuits, length) = part(circuits, P, given.circuits_first, given.circuits_length)?;
    for (kept, number) in kept.circuits.iter_mut().zip(circuits) {
        let circuit = CircuitId::new(*number).filter(|id| there.circuits.has(*id));
        *kept = circuit.ok_or(atc_status::UnknownCircuit)?.alone();
    }
    kept.length = length;
    kept.throat = there.circuits(given.throat)?;
    kept.outward = heading(given.outward)?;
    kept.shared = given.shared;
    Ok(())
}

fn route<const P: usize, Z: InC>(
    there: There<Z>,
    given: &RouteOf<Z>,
    elements: &[ElementOf<Z>],
    kept: &mut Route<P, Z>,
) -> Result<(), atc_status> {
    let (path, length) = part(elements, P, given.path_first, given.path_length)?;
    for (kept, given) in kept.path.iter_mut().zip(path) {
        *kept = element(there, given)?;
    }
    kept.length = length;
    kept.heading = heading(given.heading)?;
    kept.entry = there.circuits(given.entry)?;
    kept.approach = there.circuits(given.approach)?;
    kept.overlap = element(there, &given.overlap)?;
    kept.beyond = there.circuits(given.beyond)?;
    kept.continuing = there.routes(given.continuing)?;
    kept.conflicts = there.routes(given.conflicts)?;
    kept.from = there.segments(given.from)?;
    kept.to = there.segments(given.to)?;
    kept.drive = Ticks(given.drive_cycles);
    kept.release = Ticks(given.release_cycles);
    kept.stay = Ticks(given.stay_cycles);
    kept.speed = code_of(given.speed_code)?;
    kept.overlap_speed = code_of(given.overlap_speed_code)?;
    kept.cab_signalled = flag(given.cab_signalled)?;
    kept.calling_on = flag(given.calling_on)?;
    Ok(())
}

/// A broken rule of the kernel as a status and a place.
fn fault(broken: Broken) -> Fault {
    let (kind, first, second) = match broken.place {
        Place::Plan => (ATC_PLACE_PLAN, 0, 0),
        Place::Route(route) => (ATC_PLACE_ROUTE, route, 0),
        Place::Path(route, place) => (ATC_PLACE_PATH, route, place),
        Place::Overlap(route) => (ATC_PLACE_OVERLAP, route, 0),
        Place::Routes(one, other) => (ATC_PLACE_ROUTES, one, other),
        Place::Point(point) => (ATC_PLACE_POINT, point, 0),
        Place::Segment(segment) => (ATC_PLACE_SEGMENT, segment, 0),
        Place::Segments(one, other) => (ATC_PLACE_SEGMENTS, one, other),
        Place::Circuit(circuit) => (ATC_PLACE_CIRCUIT, circuit, 0),
    };
    let status = match broken.rule {
        Rule::PathTooLong => atc_status::PlanPathTooLong,
        Rule::NoTime => atc_status::PlanNoTime,
        Rule::ClearShort => atc_status::PlanClearShort,
        Rule::ReleaseShort => atc_status::PlanReleaseShort,
        Rule::StayShort => atc_status::PlanStayShort,
        Rule::PointBothWays => atc_status::PlanPointBothWays,
        Rule::PointNotPositioned => atc_status::PlanPointNotPositioned,
        Rule::ConflictOneWay => atc_status::PlanConflictOneWay,
        Rule::OpposingStarts => atc_status::PlanOpposingStarts,
        Rule::ContinuesElsewhere => atc_status::PlanContinuesElsewhere,
        Rule::TurnsBack => atc_status::PlanTurnsBack,
        Rule::ThroatsDiffer => atc_status::PlanThroatsDiffer,
        Rule::SegmentShared => atc_status::PlanSegmentShared,
        Rule::PointInSegment => atc_status::PlanPointInSegment,
        Rule::NotOneCircuit => atc_status::PlanNotOneCircuit,
        Rule::CircuitTwice => atc_status::PlanCircuitTwice,
        Rule::BrakingFalls => atc_status::PlanBrakingFalls,
        Rule::OverlapUnderOwnPath => atc_status::PlanOverlapUnderOwnPath,
        Rule::EntryNotInApproach => atc_status::PlanEntryNotInApproach,
        Rule::ApproachInPath => atc_status::PlanApproachInPath,
        Rule::NothingBeyond => atc_status::PlanNothingBeyond,
        Rule::ConflictsWithItself => atc_status::PlanConflictsWithItself,
        Rule::NotThere => atc_status::PlanNotThere,
        Rule::NoDetector => atc_status::PlanNoDetector,
        Rule::NoLength => atc_status::PlanNoLength,
        Rule::CodeOutOfTable => atc_status::PlanCodeOutOfTable,
        Rule::ManySegments => atc_status::PlanManySegments,
        Rule::CallingOnEnds => atc_status::PlanCallingOnEnds,
        Rule::CallingOnAgainst => atc_status::PlanCallingOnAgainst,
        Rule::CallingOnBerth => atc_status::PlanCallingOnBerth,
    };
    (status, atc_place { kind, first: first.into(), second: second.into() })
}
