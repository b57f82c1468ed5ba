//! A path of a model of one block as a run of the kernel's machine.

use super::{Cycle, Kernel, SLOTS, Single, State};
use crate::block::device::{CYCLE, Counting};
use crate::outcome::{self, Trace};
use atc_protocol::machine::block::{Config, Counted, Output, Step};
use serde::Serialize;

/// What the model knows of a cycle besides.
#[derive(Serialize)]
struct Words {
    heads: [i16; SLOTS],
    faults: Vec<String>,
    hazard: bool,
    #[serde(skip_serializing_if = "Option::is_none")]
    by_the_other_machine: Option<Output>,
}

impl<D: Counting> Single<D> {
    /// The run since the machine last lost its memory.
    pub(super) fn run_of(&self, path: &[(State, Option<Cycle>)]) -> Trace {
        let block = self.block();
        let mut kernel = Kernel::INITIAL;
        let mut cycles: Vec<outcome::Cycle<Counted, _>> = Vec::new();
        for (place, (before, cycle)) in path.iter().enumerate() {
            let Some(cycle) = cycle else { break };
            if cycle.power_loss {
                // A trace is one run of the machine: the one since it lost its memory.
                kernel = Kernel::INITIAL;
                cycles.clear();
            }
            let (_, reported) = self.device.step(block, before.kernel, cycle.input);
            let (after, output) = atc_kernel::block::step(block, kernel, cycle.input);
            kernel = after;
            let words = Words {
                heads: cycle.trains.heads.map(|head| i16::from(head) - 1),
                faults: before.faults.words(),
                hazard: path.get(place + 1).is_some_and(|(after, _)| after.hazard),
                by_the_other_machine: (reported != output).then(|| reported.into()),
            };
            cycles.push((Step::of(block, cycle.input), output.into(), words));
        }
        Trace::of::<Counted, _>(&Config::of(block, CYCLE), &cycles)
    }
}
