//! What C's program says in a cycle, held against how many there are of everything.

use atc_kernel::interlocking::{
    CircuitSet, Input, Layout, Orders, PointId, PointSet, Position, Positions, Request, RouteId, RouteSet, SegmentId,
    SegmentSet, SpeedCode, Travel,
};

use super::forms::{
    ATC_REQUEST_DRIVE_NORMAL, ATC_REQUEST_DRIVE_REVERSE, ATC_REQUEST_NONE, ATC_REQUEST_SET, ATC_REQUEST_TURN_AWAY,
    ATC_REQUEST_TURN_TOWARD, ATC_REQUEST_WITHDRAW, interlocking_input_of,
};
use super::sets::{InC, Set as _};
use crate::atc_status;

/// A layout, and what there is of what is numbered.
pub(crate) struct Plan<const R: usize, const P: usize, const N: usize, const S: usize, Z: InC> {
    pub(crate) layout: Layout<R, P, N, S, Z>,
    pub(crate) there: There<Z>,
}

/// Which circuits, points, routes and segments a plan has.
#[derive(Clone, Copy)]
pub(crate) struct There<Z: InC> {
    pub(super) circuits: CircuitSet<Z>,
    pub(super) points: PointSet<Z>,
    pub(super) routes: RouteSet<Z>,
    pub(super) segments: SegmentSet<Z>,
}

/// C's input for a size of station.
pub(super) type InputOf<Z> = interlocking_input_of<<Z as InC>::Circuits, <Z as InC>::Points, <Z as InC>::Segments>;

impl<Z: InC> There<Z> {
    pub(super) fn circuits(self, given: Z::Circuits) -> Result<CircuitSet<Z>, atc_status> {
        let circuits = given.kernel();
        self.circuits.contains(circuits).then_some(circuits).ok_or(atc_status::UnknownCircuit)
    }

    pub(super) fn routes(self, given: Z::Circuits) -> Result<RouteSet<Z>, atc_status> {
        let routes = given.kernel();
        self.routes.contains(routes).then_some(routes).ok_or(atc_status::UnknownRoute)
    }

    pub(super) fn points(self, given: Z::Points) -> Result<PointSet<Z>, atc_status> {
        let points = given.kernel();
        self.points.contains(points).then_some(points).ok_or(atc_status::UnknownPoint)
    }

    pub(super) fn segments(self, given: Z::Segments) -> Result<SegmentSet<Z>, atc_status> {
        let segments = given.kernel();
        self.segments.contains(segments).then_some(segments).ok_or(atc_status::UnknownSegment)
    }

    fn request(self, request: u32, number: u8) -> Result<Option<Request>, atc_status> {
        let route = || RouteId::new(number).filter(|id| self.routes.has(*id)).ok_or(atc_status::UnknownRoute);
        let point = || PointId::new(number).filter(|id| self.points.has(*id)).ok_or(atc_status::UnknownPoint);
        let segment = || SegmentId::new(number).filter(|id| self.segments.has(*id)).ok_or(atc_status::UnknownSegment);
        Ok(match request {
            ATC_REQUEST_NONE => None,
            ATC_REQUEST_SET => Some(Request::Set(route()?)),
            ATC_REQUEST_WITHDRAW => Some(Request::Withdraw(route()?)),
            ATC_REQUEST_DRIVE_NORMAL => Some(Request::Drive(point()?, Position::Normal)),
            ATC_REQUEST_DRIVE_REVERSE => Some(Request::Drive(point()?, Position::Reverse)),
            ATC_REQUEST_TURN_TOWARD => Some(Request::Turn(segment()?, Travel::Toward)),
            ATC_REQUEST_TURN_AWAY => Some(Request::Turn(segment()?, Travel::Away)),
            _ => return Err(atc_status::UnknownChoice),
        })
    }

    pub(super) fn input(self, input: &InputOf<Z>) -> Result<Input<Z>, atc_status> {
        if input.restrict_code > SpeedCode::MOST.0 {
            return Err(atc_status::UnknownCode);
        }
        let (normal, reverse) = (self.points(input.detected_normal)?, self.points(input.detected_reverse)?);
        Ok(Input {
            occupied: self.circuits(input.occupied)?,
            detected: Positions { normal, reverse },
            request: self.request(input.request, input.number)?,
            orders: Orders {
                block: self.circuits(input.block)?,
                unblock: self.circuits(input.unblock)?,
                restrict: self.circuits(input.restrict_circuits)?,
                speed: SpeedCode(input.restrict_code),
                lift: self.circuits(input.lift)?,
            },
            consent: self.segments(input.consent)?,
        })
    }
}
