//! Interlocking and ATC behind the border: [`atc_kernel::interlocking`], for a station of the greatest size.

mod bytes;
mod forms;
mod plan;

pub use forms::*;
pub(crate) use plan::{Arrays, Fault, layout};

use atc_kernel::Machine as _;
use atc_kernel::interlocking::{
    CircuitSet, Combined, Commands, Heading, Input, MAX_CIRCUITS, Memory, Movement, Orders, Phase, PointId, PointSet,
    Position, Positions, Refusal, Request, RouteId, SegmentId, SegmentSet, SpeedCode, Station, Travel,
};

use crate::atc_status;
use crate::memory::{Machine, Reader, Writer};

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
fn within(bits: u64, count: u8) -> bool {
    bits.checked_shr(count.into()).unwrap_or(0) == 0
}

impl Counts {
    fn circuits(self, bits: u64) -> Result<CircuitSet, atc_status> {
        let known = within(bits, self.circuits).then_some(CircuitSet::from_bits(bits));
        known.ok_or(atc_status::UnknownCircuit)
    }

    fn points(self, bits: u32) -> Result<PointSet, atc_status> {
        let known = within(bits.into(), self.points).then_some(PointSet::from_bits(bits));
        known.ok_or(atc_status::UnknownPoint)
    }

    fn segments(self, bits: u8) -> Result<SegmentSet, atc_status> {
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

    fn input(self, input: &atc_interlocking_input) -> Result<Input, atc_status> {
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

const fn heading(heading: Option<Heading>) -> u8 {
    match heading {
        None => ATC_HEADING_NONE,
        Some(Heading::Left) => ATC_HEADING_LEFT,
        Some(Heading::Right) => ATC_HEADING_RIGHT,
    }
}

const fn phase(phase: Phase) -> u8 {
    match phase {
        Phase::Idle => ATC_PHASE_IDLE,
        Phase::Provisional => ATC_PHASE_PROVISIONAL,
        Phase::Failed => ATC_PHASE_FAILED,
        Phase::Set => ATC_PHASE_SET,
        Phase::InUse => ATC_PHASE_IN_USE,
        Phase::Releasing => ATC_PHASE_RELEASING,
    }
}

const fn answer(answer: Option<Result<(), Refusal>>) -> u32 {
    match answer {
        None => ATC_ANSWER_NONE,
        Some(Ok(())) => ATC_ANSWER_ACCEPTED,
        Some(Err(refusal)) => match refusal {
            Refusal::Unknown => ATC_ANSWER_UNKNOWN,
            Refusal::Starting => ATC_ANSWER_STARTING,
            Refusal::AlreadyHeld => ATC_ANSWER_ALREADY_HELD,
            Refusal::NotHeld => ATC_ANSWER_NOT_HELD,
            Refusal::Conflict => ATC_ANSWER_CONFLICT,
            Refusal::PathHeld => ATC_ANSWER_PATH_HELD,
            Refusal::OverlapHeld => ATC_ANSWER_OVERLAP_HELD,
            Refusal::PointLocked => ATC_ANSWER_POINT_LOCKED,
            Refusal::Occupied => ATC_ANSWER_OCCUPIED,
            Refusal::Unswept => ATC_ANSWER_UNSWEPT,
            Refusal::Blocked => ATC_ANSWER_BLOCKED,
            Refusal::PointUnderTrain => ATC_ANSWER_POINT_UNDER_TRAIN,
            Refusal::Direction => ATC_ANSWER_DIRECTION,
            Refusal::Waiting => ATC_ANSWER_WAITING,
        },
    }
}

/// Nothing is sent.
const SILENT: atc_movement = atc_movement { hold: 0, sent: 0, stop: 0, heading: ATC_HEADING_NONE, speed_code: 0 };

fn telegram(movement: Option<Movement>) -> atc_movement {
    movement.map_or(SILENT, |movement| atc_movement {
        hold: movement.hold.bits(),
        sent: 1,
        stop: movement.stop.number(),
        heading: heading(movement.heading),
        speed_code: movement.speed.0,
    })
}

pub(crate) fn output(memory: &Memory<64, 8>, commands: &Commands<64>) -> atc_interlocking_output {
    let said = &commands.interlocking;
    let occupied = said.table.read(memory.cycle).map_or(CircuitSet::ALL, |contents| contents.occupied);
    atc_interlocking_output {
        proceed: said.proceed.bits(),
        confirmed: said.confirmed.bits(),
        occupied: occupied.bits(),
        drive_normal: said.drives.normal.bits(),
        drive_reverse: said.drives.reverse.bits(),
        answer: answer(said.answer),
        permits: said.permits.bits(),
        phases: memory.interlocking.routes.map(|route| phase(route.phase)),
        telegrams: commands.telegrams.map(telegram),
    }
}

pub(crate) struct Interlocked;

impl Machine for Interlocked {
    const TAG: [u8; 4] = *b"ILCK";
    const PARAMETERS: usize = bytes::PARAMETERS;
    type Parameters = Plan;
    type State = Memory<64, 8>;
    type Input = atc_interlocking_input;
    type Output = atc_interlocking_output;
    // The kernel's: `Combined::SAFE`, in which every circuit counts as occupied. A test compares them.
    const SAFE: Self::Output = atc_interlocking_output {
        proceed: 0,
        confirmed: 0,
        occupied: u64::MAX,
        drive_normal: 0,
        drive_reverse: 0,
        answer: ATC_ANSWER_NONE,
        permits: 0,
        phases: [ATC_PHASE_IDLE; 64],
        telegrams: [SILENT; MAX_CIRCUITS],
    };

    fn initial(_: &Plan) -> Self::State {
        Memory::INITIAL
    }

    fn put_parameters(plan: &Plan, to: &mut Writer<'_>) {
        bytes::put_plan(plan, to);
    }

    fn take_parameters(from: &mut Reader<'_>) -> Option<Plan> {
        bytes::take_plan(from)
    }

    fn put_state(memory: &Self::State, to: &mut Writer<'_>) {
        bytes::put_memory(memory, to);
    }

    fn take_state(plan: &Plan, from: &mut Reader<'_>) -> Option<Self::State> {
        bytes::take_memory(from).filter(|memory| memory.is_valid(&plan.layout))
    }

    fn step(
        plan: &Plan,
        memory: Self::State,
        input: &atc_interlocking_input,
    ) -> Result<(Self::State, atc_interlocking_output), atc_status> {
        let input = plan.counts.input(input)?;
        let (memory, commands) = Combined(&plan.layout).step(memory, input);
        let output = output(&memory, &commands);
        Ok((memory, output))
    }
}
