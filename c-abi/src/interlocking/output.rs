//! What the machine puts out, in C's forms.

use atc_kernel::interlocking::{CircuitSet, Commands, Heading, Memory, Movement, Phase, Refusal};

use super::forms::{
    ATC_ANSWER_ACCEPTED, ATC_ANSWER_ALREADY_HELD, ATC_ANSWER_BLOCKED, ATC_ANSWER_CONFLICT, ATC_ANSWER_DIRECTION,
    ATC_ANSWER_NONE, ATC_ANSWER_NOT_CALLED_FOR, ATC_ANSWER_NOT_HELD, ATC_ANSWER_OCCUPIED, ATC_ANSWER_OVERLAP_HELD,
    ATC_ANSWER_PATH_HELD, ATC_ANSWER_POINT_LOCKED, ATC_ANSWER_POINT_UNDER_TRAIN, ATC_ANSWER_STARTING,
    ATC_ANSWER_UNKNOWN, ATC_ANSWER_UNSWEPT, ATC_ANSWER_WAITING, ATC_HEADING_LEFT, ATC_HEADING_NONE, ATC_HEADING_RIGHT,
    ATC_PHASE_FAILED, ATC_PHASE_IDLE, ATC_PHASE_IN_USE, ATC_PHASE_PROVISIONAL, ATC_PHASE_RELEASING, ATC_PHASE_SET,
    interlocking_output_of, movement_of,
};
use super::input::There;
use super::sets::{Bits, InC, Set as _};

const fn heading(heading: Option<Heading>) -> u8 {
    match heading {
        None => ATC_HEADING_NONE,
        Some(Heading::Left) => ATC_HEADING_LEFT,
        Some(Heading::Right) => ATC_HEADING_RIGHT,
    }
}

pub(super) const fn phase(phase: Phase) -> u8 {
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
            Refusal::NotCalledFor => ATC_ANSWER_NOT_CALLED_FOR,
            Refusal::Unswept => ATC_ANSWER_UNSWEPT,
            Refusal::Blocked => ATC_ANSWER_BLOCKED,
            Refusal::PointUnderTrain => ATC_ANSWER_POINT_UNDER_TRAIN,
            Refusal::Direction => ATC_ANSWER_DIRECTION,
            Refusal::Waiting => ATC_ANSWER_WAITING,
        },
    }
}

/// C's output for a size of station, with as many routes as circuits.
pub(super) type OutputOf<const R: usize, Z> =
    interlocking_output_of<<Z as InC>::Circuits, <Z as InC>::Points, <Z as InC>::Segments, R>;

/// Nothing is sent.
const fn silent<C: Bits>() -> movement_of<C> {
    movement_of { hold: C::NONE, sent: 0, stop: 0, heading: ATC_HEADING_NONE, speed_code: 0 }
}

/// The kernel's safe output, [`Combined::SAFE`](atc_kernel::interlocking::Combined), in which every circuit counts as
/// occupied. A test compares them.
pub(super) const fn safe<const R: usize, Z: InC>() -> OutputOf<R, Z> {
    interlocking_output_of {
        proceed: Bits::NONE,
        confirmed: Bits::NONE,
        occupied: Bits::ALL,
        drive_normal: Bits::NONE,
        drive_reverse: Bits::NONE,
        answer: ATC_ANSWER_NONE,
        permits: Bits::NONE,
        phases: [ATC_PHASE_IDLE; R],
        telegrams: [silent(); R],
    }
}

fn telegram<Z: InC>(movement: Option<Movement<Z>>) -> movement_of<Z::Circuits> {
    movement.map_or(silent(), |movement| movement_of {
        hold: Z::Circuits::of(movement.hold),
        sent: 1,
        stop: movement.stop.number(),
        heading: heading(movement.heading),
        speed_code: movement.speed.0,
    })
}

/// Of what is beyond the plan nothing is said: in the kernel a circuit that is not there is occupied and blocked for ever.
pub(super) fn output<const R: usize, const S: usize, Z: InC>(
    there: There<Z>,
    memory: &Memory<R, S, Z>,
    commands: &Commands<R, Z>,
) -> OutputOf<R, Z> {
    let said = &commands.interlocking;
    let occupied = said.table.read(memory.cycle).map_or(CircuitSet::ALL, |contents| contents.occupied);
    interlocking_output_of {
        proceed: Z::Circuits::of(said.proceed),
        confirmed: Z::Circuits::of(said.confirmed.and(there.circuits)),
        occupied: Z::Circuits::of(occupied.and(there.circuits)),
        drive_normal: Z::Points::of(said.drives.normal),
        drive_reverse: Z::Points::of(said.drives.reverse),
        answer: answer(said.answer),
        permits: Z::Segments::of(said.permits),
        phases: memory.interlocking.routes.map(|route| phase(route.phase)),
        telegrams: core::array::from_fn(|circuit| {
            telegram(if there.circuits.has_number(circuit) { commands.telegrams[circuit] } else { None })
        }),
    }
}
