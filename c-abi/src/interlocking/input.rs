//! What C's program says in a cycle, held against how many there are of everything.

use atc_kernel::interlocking::{
    CircuitSet, Input, Orders, PointId, PointSet, Position, Positions, Request, RouteId, SegmentId, SegmentSet,
    SpeedCode, Station, Travel,
};

use super::forms::{
    ATC_REQUEST_DRIVE_NORMAL, ATC_REQUEST_DRIVE_REVERSE, ATC_REQUEST_NONE, ATC_REQUEST_SET, ATC_REQUEST_TURN_AWAY,
    ATC_REQUEST_TURN_TOWARD, ATC_REQUEST_WITHDRAW, atc_interlocking_input,
};
use crate::atc_status;

/// A layout, and how many there are of what is numbered.
pub(crate) struct Plan {
    pub(crate) layout: Station,
    pub(crate) counts: Counts,
}

/// How many circuits, points, routes and segments a plan has.
#[derive(Clone, Copy)]
pub(crate) struct Counts {
    pub(crate) circuits: u8,
    pub(crate) points: u8,
    pub(crate) routes: u8,
    pub(crate) segments: u8,
}

/// Whether only the lowest `count` bits are set.
pub(super) fn within(bits: u64, count: u8) -> bool {
    bits.checked_shr(count.into()).unwrap_or(0) == 0
}

impl Counts {
    pub(super) fn circuits(self, bits: u64) -> Result<CircuitSet, atc_status> {
        let known = within(bits, self.circuits).then_some(CircuitSet::from_bits(bits));
        known.ok_or(atc_status::UnknownCircuit)
    }

    pub(super) fn points(self, bits: u32) -> Result<PointSet, atc_status> {
        let known = within(bits.into(), self.points).then_some(PointSet::from_bits(bits));
        known.ok_or(atc_status::UnknownPoint)
    }

    pub(super) fn segments(self, bits: u8) -> Result<SegmentSet, atc_status> {
        let known = within(bits.into(), self.segments).then_some(SegmentSet::from_bits(bits));
        known.ok_or(atc_status::UnknownSegment)
    }

    fn request(self, request: u32, number: u8) -> Result<Option<Request>, atc_status> {
        let route = || RouteId::new(number).filter(|_| number < self.routes).ok_or(atc_status::UnknownRoute);
        let point = || PointId::new(number).filter(|_| number < self.points).ok_or(atc_status::UnknownPoint);
        let segment = || SegmentId::new(number).filter(|_| number < self.segments).ok_or(atc_status::UnknownSegment);
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

    pub(super) fn input(self, input: &atc_interlocking_input) -> Result<Input, atc_status> {
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
