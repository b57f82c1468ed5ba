//! The committed example sessions as cases: as they stand, and changed here and there. A machine without walks of its own is compared on
//! these alone.

use serde_json::Value;

use super::super::case::{Case, Expected, Kernel, is_rejected};
use super::super::random::Random;

/// The sessions of `oracle/examples/`, with their names.
const SESSIONS: &[(&str, &str)] = &[
    ("figure-3", include_str!("../../../examples/figure-3.jsonl")),
    ("figure-6", include_str!("../../../examples/figure-6.jsonl")),
    ("figure-7", include_str!("../../../examples/figure-7.jsonl")),
    ("figure-8", include_str!("../../../examples/figure-8.jsonl")),
    ("supervision", include_str!("../../../examples/supervision.jsonl")),
    ("block-count", include_str!("../../../examples/block-count.jsonl")),
    ("telegram-codec", include_str!("../../../examples/telegram-codec.jsonl")),
    ("braking-pattern", include_str!("../../../examples/braking-pattern.jsonl")),
    ("speed-pattern", include_str!("../../../examples/speed-pattern.jsonl")),
    ("train-position", include_str!("../../../examples/train-position.jsonl")),
    ("train", include_str!("../../../examples/train.jsonl")),
    ("wayside", include_str!("../../../examples/wayside.jsonl")),
    ("interlocking", include_str!("../../../examples/interlocking.jsonl")),
];

/// The cases of the committed sessions, with the names of their sessions, of one machine.
pub fn examples(machine: &str) -> Vec<(&'static str, Case)> {
    let mut cases = Vec::new();
    for (name, text) in SESSIONS {
        let mut open: Option<Case> = None;
        for line in text.lines() {
            let Ok(line) = serde_json::from_str::<Value>(line) else { continue };
            if let Some(start) = line.get("start") {
                let machine = start["machine"].as_str().unwrap_or_default().to_owned();
                let config = start.get("config").cloned().unwrap_or_else(|| Value::Object(serde_json::Map::new()));
                cases.extend(open.replace(Case { machine, config, steps: Vec::new() }).map(|case| (*name, case)));
            } else if let (Some(step), Some(case)) = (line.get("step"), &mut open) {
                case.steps.push(step.clone());
            }
        }
        cases.extend(open.map(|case| (*name, case)));
    }
    cases.retain(|(_, case)| case.machine == machine);
    cases
}

/// The example of that number, then examples with changes; none for a machine without an example.
pub(super) fn case(machine: &str, number: u64, config: Option<&Value>, random: &mut Random) -> Option<Expected> {
    let examples = examples(machine);
    let place = usize::try_from(number).ok().filter(|place| *place < examples.len());
    let (_, mut case) = examples.get(place.unwrap_or_else(|| random.below(examples.len())))?.clone();
    if let Some(config) = config {
        case.config = config.clone();
    }
    if place.is_none() {
        change(&mut case.steps, random);
    }
    // A step that the kernel does not take (its session shows that too) is left out.
    let mut kernel = Kernel::new();
    let start = kernel.start(&case).ok().filter(|start| !is_rejected(start))?;
    let mut outputs = Vec::new();
    case.steps.retain(|step| kernel.step(step).map(|output| outputs.push(output)).is_ok());
    Some(Expected { case, start, outputs, left_out: 0 })
}

/// Leaves steps out, repeats and exchanges them.
fn change(steps: &mut Vec<Value>, random: &mut Random) {
    for _ in 0..=random.below(6) {
        if steps.is_empty() {
            return;
        }
        let at = random.below(steps.len());
        let step = steps[at].clone();
        match random.below(5) {
            0 => drop(steps.remove(at)),
            1 => {
                let until = (at + random.below(12)).min(steps.len());
                steps.drain(at..until);
            }
            2 => {
                let count = usize::try_from(random.between(1, 30)).unwrap_or(1);
                steps.splice(at..at, std::iter::repeat_n(step, count));
            }
            3 => {
                let other = random.below(steps.len());
                steps.swap(at, other);
            }
            _ => steps.truncate(at + 1),
        }
    }
}
