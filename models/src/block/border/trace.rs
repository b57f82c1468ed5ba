//! A path of a model of a border as a run of one of its blocks.

use super::{CHECKED_IN, CHECKED_OUT, Cycle, DETECTED, Pair, SECTIONS, SLOTS, State};
use crate::block::device::CYCLE;
use crate::block::lines::Lining;
use crate::outcome::{self, Trace};
use atc_kernel::block::{Detection, Input, step};
use atc_protocol::machine::block::{Config, Counted, Output, Step};
use serde::Serialize;

/// What the model knows of a cycle besides.
#[derive(Serialize)]
struct Words {
    heads: [i16; SLOTS],
    crossing: Vec<&'static str>,
    faults: Vec<String>,
    hazard: bool,
    block: &'static str,
    other_block_reads: Step,
    other_block_reports: Output,
}

/// The run of the block in which a section is reported free at the end; if none is, of the block behind. The words have
/// the other one.
pub(super) fn of<L: Lining>(pair: &Pair<L>, path: &[(State, Option<Cycle>)]) -> Trace {
    let line = pair.line();
    let blocks = line.blocks();
    let last = path.last().map(|(last, _)| last.trains);
    let ahead =
        last.is_some_and(|trains| Pair::<L>::sections(trains).iter().all(|head| *head == 0 || *head > SECTIONS));
    let (subject, other) = if ahead { (1, 0) } else { (0, 1) };
    let mut cycles: Vec<outcome::Cycle<Counted, _>> = Vec::new();
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
        let words = Words {
            heads: cycle.trains.heads.map(|head| i16::from(head) - 1),
            crossing: crossing(cycle.trains.crossing),
            faults: before.faults.words(),
            hazard: path.get(place + 1).is_some_and(|(after, _)| after.hazard),
            block: ["behind", "ahead"][subject],
            other_block_reads: Step::of(blocks[other], read(other)),
            other_block_reports: reported.blocks[other].into(),
        };
        cycles.push((Step::of(blocks[subject], input), output.into(), words));
    }
    Trace::of::<Counted, _>(&Config::of(blocks[subject], CYCLE), &cycles)
}

fn crossing(passed: u8) -> Vec<&'static str> {
    let names = [(CHECKED_OUT, "checked out"), (CHECKED_IN, "checked in ahead"), (DETECTED, "detected ahead")];
    names.into_iter().filter(|(bit, _)| passed & bit != 0).map(|(_, name)| name).collect()
}
