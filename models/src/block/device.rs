//! The machine in a model of block counting: the kernel's, or a wrong one to compare with.

use atc_kernel::block::{Block, Input, Output, State, step};

/// A machine that may stand in the place of the kernel's.
pub trait Counting: Clone + std::fmt::Debug + Send + Sync + 'static {
    /// Whether it is the machine that `promela/block.pml` writes a second time.
    const HAS_TWIN: bool = false;

    /// One logic cycle.
    fn step(&self, block: Block, state: State, input: Input) -> (State, Output);
}

/// The kernel's own.
#[derive(Clone, Copy, Debug)]
pub struct Real;

impl Counting for Real {
    const HAS_TWIN: bool = true;

    fn step(&self, block: Block, state: State, input: Input) -> (State, Output) {
        step(block, state, input)
    }
}

/// Counts, but believes its detectors whatever the count says: BLK-2 is left out.
#[derive(Clone, Copy, Debug)]
pub struct WithoutComparison;

impl Counting for WithoutComparison {
    fn step(&self, block: Block, state: State, input: Input) -> (State, Output) {
        let (next, report) = step(block, state, input);
        let heads = input.present.and(block.all());
        // A count that agrees with these detectors has just been verified: the kernel's own holds, for these heads.
        let verified = Input {
            check_in: false,
            check_out: false,
            reset: Some(atc_kernel::block::TrainCount(heads.len())),
            ..input
        };
        let (_, believed) = step(block, State::INITIAL, verified);
        (
            next,
            if believed.agree {
                Output { occupied: believed.occupied, behind_hold: believed.behind_hold, ..report }
            } else {
                report
            },
        )
    }
}

/// A block's inputs and outputs in the words of the oracle's machine `block-count`.
pub(super) mod words {
    use atc_kernel::block::{Block, Fault, Input, Output, SectionSet, Status};
    use serde_json::{Value, json};

    /// The length of a logic cycle in a trace, in milliseconds.
    const CYCLE_MS: u32 = 10;

    pub(in crate::block) fn sections(set: SectionSet) -> Vec<u8> {
        (0..16).filter(|section| set.contains(*section)).collect()
    }

    pub(in crate::block) fn config(block: Block) -> Value {
        json!({
            "sections": block.sections(),
            "max_trains": block.max_trains().0,
            "tail_hold_sections": block.hold().sections(),
            "cycle_ms": CYCLE_MS,
            "pass_ms": CYCLE_MS * u32::from(block.pass().0),
        })
    }

    pub(in crate::block) fn input(block: Block, input: Input) -> Value {
        json!({
            "check_in": input.check_in,
            "check_out": input.check_out,
            "present": sections(input.present.and(block.all())),
            "reset": input.reset.map(|number| number.0),
            "ahead_hold_sections": input.ahead_hold.sections(),
            "ahead_entered": input.ahead_entered,
        })
    }

    pub(in crate::block) fn output(block: Block, output: Output) -> Value {
        let fault = match output.status {
            Status::Unverified | Status::Counting => None,
            Status::Fault(Fault::CheckOutAtZero) => Some("check-out-at-zero"),
            Status::Fault(Fault::CheckInAtMaximum) => Some("check-in-at-maximum"),
            Status::Fault(Fault::CheckInStaysOn) => Some("check-in-stays-on"),
        };
        json!({
            "occupied": sections(output.occupied.and(block.all())),
            "behind_hold_sections": output.behind_hold.sections(),
            "agree": output.agree,
            "count": output.count.0,
            "fault": fault,
            "counting": output.status == Status::Counting,
        })
    }
}
