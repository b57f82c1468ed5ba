//! Interlocking and ATC behind the border: [`atc_kernel::interlocking`], for a station of the greatest size.

mod bytes;
mod forms;
mod input;
mod output;
mod plan;

pub use forms::*;
pub(crate) use plan::{Arrays, Fault, layout};

use atc_kernel::Machine as _;
use atc_kernel::interlocking::{Combined, MAX_CIRCUITS, Memory};

use crate::atc_status;
use crate::memory::{Machine, Reader, Writer};
pub(crate) use input::Plan;
use output::SILENT;
pub(crate) use output::output;

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
