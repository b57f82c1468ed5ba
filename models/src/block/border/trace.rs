//! A path of a model of a border as a run of one of its blocks.

use super::{CHECKED_IN, CHECKED_OUT, Cycle, DETECTED, Pair, SECTIONS, State};
use crate::block::device::words;
use crate::block::lines::Lining;
use crate::outcome::{Step, Trace};
use atc_kernel::block::{Detection, Input, step};
use serde_json::json;
use std::collections::BTreeMap;

/// The run of the block in which a section is reported free at the end; if none is, of the block behind. The words have
/// the other one.
pub(super) fn of<L: Lining>(pair: &Pair<L>, path: &[(State, Option<Cycle>)]) -> Trace {
    let line = pair.line();
    let blocks = line.blocks();
    let last = path.last().map(|(last, _)| last.trains);
    let ahead =
        last.is_some_and(|trains| Pair::<L>::sections(trains).iter().all(|head| *head == 0 || *head > SECTIONS));
    let (subject, other) = if ahead { (1, 0) } else { (0, 1) };
    let mut steps = Vec::new();
    let mut alone = atc_kernel::block::State::INITIAL;
    for (place, (before, cycle)) in path.iter().enumerate() {
        let Some(cycle) = cycle else { break };
        let (_, reported) = pair.device.step(&line, before.line, cycle.input);
        let read = |block: usize| {
            let Detection { low_check, high_check, present, reset } = cycle.input.blocks[block];
            let (ahead_hold, ahead_entered) = match block {
                0 => (
                    reported.blocks[1].behind_hold,
                    pair.device.takes_over(&before.line, &cycle.input, &reported.blocks[1]),
                ),
                _ => (cycle.input.beyond.hold, true),
            };
            Input { check_in: low_check, check_out: high_check, present, reset, ahead_hold, ahead_entered }
        };
        let input = read(subject);
        let (after, output) = step(blocks[subject], alone, input);
        alone = after;
        let more = BTreeMap::from([
            ("heads".to_owned(), json!(cycle.trains.heads.map(|head| i16::from(head) - 1))),
            ("crossing".to_owned(), json!(crossing(cycle.trains.crossing))),
            ("faults".to_owned(), json!(before.faults.words())),
            ("hazard".to_owned(), json!(path.get(place + 1).is_some_and(|(after, _)| after.hazard))),
            ("block".to_owned(), json!(["behind", "ahead"][subject])),
            ("other_block_reads".to_owned(), words::input(blocks[other], read(other))),
            ("other_block_reports".to_owned(), words::output(blocks[other], reported.blocks[other])),
        ]);
        steps.push(Step {
            input: words::input(blocks[subject], input),
            output: words::output(blocks[subject], output),
            words: more,
        });
    }
    Trace { machine: "block-count".to_owned(), config: words::config(blocks[subject]), steps, loop_start: None }
}

fn crossing(passed: u8) -> Vec<&'static str> {
    let names = [(CHECKED_OUT, "checked out"), (CHECKED_IN, "checked in ahead"), (DETECTED, "detected ahead")];
    names.into_iter().filter(|(bit, _)| passed & bit != 0).map(|(_, name)| name).collect()
}
