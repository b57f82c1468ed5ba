//! The machine in a model of block counting: the kernel's, or a wrong one to compare with.

use atc_kernel::block::{Block, Detection, Input, Output, State, step};
use atc_kernel::time::Millis;
use atc_protocol::Sections;
use serde::Serialize;

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

/// The length of a logic cycle in a trace.
pub(super) const CYCLE: Millis = Millis(10);

/// What a block read of its line, and how it counts after that: further words of a trace.
#[derive(Serialize)]
pub(crate) struct Counts {
    check_in: bool,
    check_out: bool,
    present: Sections,
    reset: Option<u8>,
    count: u8,
    agree: bool,
}

impl Counts {
    /// Of a block whose state after the cycle is `after`.
    pub(crate) fn of(read: Detection, after: State, agree: bool) -> Self {
        Self {
            check_in: read.low_check,
            check_out: read.high_check,
            present: Sections(read.present),
            reset: read.reset.map(|number| number.0),
            count: after.parts().count,
            agree,
        }
    }
}
