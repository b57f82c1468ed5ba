//! A path of a model of one block as a run of the kernel's machine.

use super::{Cycle, Kernel, Single, State};
use crate::block::device::{Counting, words};
use crate::outcome::{Step, Trace};
use serde_json::json;
use std::collections::BTreeMap;

impl<D: Counting> Single<D> {
    /// The run since the machine last lost its memory.
    pub(super) fn run_of(&self, path: &[(State, Option<Cycle>)]) -> Trace {
        let block = self.block();
        let mut kernel = Kernel::INITIAL;
        let mut steps = Vec::new();
        for (place, (before, cycle)) in path.iter().enumerate() {
            let Some(cycle) = cycle else { break };
            if cycle.power_loss {
                // A trace is one run of the machine: the one since it lost its memory.
                kernel = Kernel::INITIAL;
                steps.clear();
            }
            let (_, reported) = self.device.step(block, before.kernel, cycle.input);
            let (after, output) = atc_kernel::block::step(block, kernel, cycle.input);
            kernel = after;
            let mut more = BTreeMap::from([
                ("heads".to_owned(), json!(cycle.trains.heads.map(|head| i16::from(head) - 1))),
                ("faults".to_owned(), json!(before.faults.words())),
                ("hazard".to_owned(), json!(path.get(place + 1).is_some_and(|(after, _)| after.hazard))),
            ]);
            if reported != output {
                more.insert("by_the_other_machine".to_owned(), words::output(block, reported));
            }
            steps.push(Step {
                input: words::input(block, cycle.input),
                output: words::output(block, output),
                words: more,
            });
        }
        Trace { machine: "block-count".to_owned(), config: words::config(block), steps, loop_start: None }
    }
}
