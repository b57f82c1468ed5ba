//! Which small change of the kernel would give the same replies: a first guess at what is wrong on the other side.
//!
//! Each guess is a change of the configuration, a time one cycle longer or shorter, a limit one step off, a parameter that is ignored.
//! A guess is told only if the kernel with that change gives every reply of the trace as the other side did. It is no proof: other
//! mistakes may look the same on so short a trace.

use serde_json::Value;

use super::case::Expected;
use super::fields::{Level, compare};

/// A guess that fits.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Alike {
    /// What is as if, in words.
    pub says: String,
    /// The requirement that the change breaks.
    pub requirement: &'static str,
}

enum Change {
    /// One cycle longer or shorter.
    Cycle(&'static str),
    /// One more or less.
    One(&'static str),
    /// As if it were this number.
    Ignored(&'static str, i64),
}

use Change::{Cycle, Ignored, One};

/// A change, and the requirement of it.
type Guess = (Change, &'static str);

/// The times of aspect acceptance.
const ACCEPTANCE: &[Guess] = &[
    (Cycle("operate_ms"), "ACC-1"),
    (Cycle("recovery_ms"), "ACC-4"),
    (Cycle("mask_ms"), "ACC-6"),
    (Cycle("interruption_ms"), "ACC-8"),
    (Cycle("shortened_operate_ms"), "ACC-8"),
];

/// The lives and counters of telegrams.
const TELEGRAMS: &[Guess] = &[
    (Cycle("fresh_ms"), "PER-1"),
    (Cycle("life_ms"), "PER-8"),
    (Cycle("fixed_life_ms"), "PER-8"),
    (Cycle("memory_ms"), "TEL-6"),
    (One("window"), "TEL-6"),
    (One("run"), "TEL-6"),
];

/// The times of a station.
const STATION: &[Guess] = &[
    (One("clear_cycles"), "TRK-1"),
    (One("turn_cycles"), "ILK-19"),
    (One("start_cycles"), "ILK-24"),
    (One("drive_cycles"), "ILK-5"),
    (One("release_cycles"), "ILK-13"),
    (One("stay_cycles"), "ILK-14"),
];

/// The times of a station's layout, as its file has them.
const FILE: &[Guess] = &[
    (Cycle("clear_ms"), "TRK-1"),
    (Cycle("turn_ms"), "ILK-19"),
    (Cycle("start_ms"), "ILK-24"),
    (Cycle("drive_ms"), "ILK-5"),
    (Cycle("release_ms"), "ILK-13"),
    (Cycle("stay_ms"), "ILK-14"),
];

/// The numbers of a block.
const BLOCK: &[Guess] = &[(One("tail_hold_sections"), "BLK-5"), (One("max_trains"), "BLK-3")];

/// The guesses for each machine, group by group.
const GUESSES: &[(&str, &[&[Guess]])] = &[
    ("aspect-acceptance", &[ACCEPTANCE, &[(Ignored("interruption_ms", 0), "ACC-8"), (Ignored("mask_ms", 0), "ACC-6")]]),
    ("speed-supervision", &[&[(Ignored("release_margin_km_h", 0), "SUP-1"), (Ignored("maximum_km_h", 6553), "SUP-2")]]),
    ("block-count", &[&[(Cycle("pass_ms"), "BLK-3")], BLOCK, &[(Ignored("tail_hold_sections", 0), "BLK-5")]]),
    (
        "permitted-speed",
        &[
            TELEGRAMS,
            &[
                (Ignored("run", 1), "TEL-6"),
                (Ignored("margin_m", 0), "PER-4"),
                (Ignored("worst_gradient_permille", 0), "PER-5"),
            ],
        ],
    ),
    ("train-position", &[&[(Ignored("tolerance_db", 0), "POS-1"), (Ignored("floor_db", -300), "POS-2")]]),
    (
        "interlocking",
        &[
            STATION,
            &[
                (Ignored("start_cycles", 0), "ILK-24"),
                (One("settle_cycles"), "ILK-23"),
                (Ignored("settle_cycles", 0), "ILK-23"),
            ],
        ],
    ),
    ("train", &[ACCEPTANCE, TELEGRAMS]),
    ("wayside", &[&[(Cycle("life_ms"), "WAY-8")], STATION, BLOCK]),
];

/// The guesses for a machine.
fn guesses(machine: &str) -> impl Iterator<Item = &'static Guess> {
    let its = GUESSES.iter().find(|(name, _)| *name == machine).map_or(&[][..], |(_, groups)| groups);
    its.iter().copied().flatten()
}

/// Configurations of a machine in which one limit is a cycle, or one, off: with words for it, and the requirement.
pub(super) fn limits(machine: &str, config: &Value) -> Vec<(Value, String, &'static str)> {
    off(guesses(machine), config)
}

/// The same, with the times of a layout's file.
pub(super) fn limits_of_a_file(machine: &str, config: &Value) -> Vec<(Value, String, &'static str)> {
    off(guesses(machine).chain(FILE), config)
}

fn off<'a>(guesses: impl Iterator<Item = &'a Guess>, config: &Value) -> Vec<(Value, String, &'static str)> {
    let off = guesses.filter(|(change, _)| !matches!(change, Ignored(..)));
    let each = off.flat_map(|(change, requirement)| {
        change.changed(config).into_iter().map(move |(config, says)| (config, says, *requirement))
    });
    each.collect()
}

/// The guesses that fit a case and the replies of the other side to its steps.
pub fn alike(expected: &Expected, replies: &[String], level: Level) -> Vec<Alike> {
    let machine = expected.case.machine.as_str();
    // Only where every reply is there: the last one is the one that differs.
    if replies.is_empty() || replies.len() != expected.case.steps.len() {
        return Vec::new();
    }
    // The started reply has every default.
    let started: Value = serde_json::from_str(&expected.start).unwrap_or_default();
    let config = &started["started"]["config"];
    let mut fitting: Vec<Alike> = Vec::new();
    for (change, requirement) in guesses(machine) {
        for (changed, says) in change.changed(config) {
            let mut case = expected.case.clone();
            case.config = changed;
            if case.expected().is_ok_and(|guess| fits(machine, level, &guess, replies)) {
                fitting.push(Alike { says, requirement });
            }
        }
    }
    fitting.dedup();
    fitting
}

fn fits(machine: &str, level: Level, guess: &Expected, replies: &[String]) -> bool {
    guess.outputs.len() == replies.len()
        && guess.outputs.iter().zip(replies).all(|(guess, reply)| same(machine, level, guess, reply))
}

/// Whether two output lines of a machine are the same in all that is compared.
pub(super) fn same(machine: &str, level: Level, one: &str, other: &str) -> bool {
    let body = |line: &str| serde_json::from_str::<Value>(line).unwrap_or_default()["output"].take();
    one == other || compare(machine, level, &body(one), &body(other)).is_empty()
}

impl Change {
    /// The configurations with this change, each with words for it.
    fn changed(&self, config: &Value) -> Vec<(Value, String)> {
        let cycle = [
            "/cycle_ms",
            "/permitted/cycle_ms",
            "/layout/plan/cycle_ms",
            "/layout/times/cycle_ms",
            "/plan/cycle_ms",
            "/times/cycle_ms",
        ];
        let cycle = cycle.iter().find_map(|at| config.pointer(at)?.as_i64()).unwrap_or(10);
        let (name, steps): (_, &[(i64, &str)]) = match self {
            Cycle(name) => (name, &[(-1, "one cycle shorter"), (1, "one cycle longer")]),
            One(name) => (name, &[(-1, "one less"), (1, "one more")]),
            Ignored(name, _) => (name, &[(0, "")]),
        };
        let mut all = Vec::new();
        for (step, words) in steps {
            let mut changed = config.clone();
            let new = |old: Option<i64>| match self {
                Cycle(_) => old.map(|old| old + step * cycle),
                One(_) => old.map(|old| old + step),
                Ignored(_, number) => Some(*number),
            };
            if replace(&mut changed, name, &new) > 0 && changed != *config {
                let words = if let Ignored(_, number) = self { format!("{number}") } else { (*words).to_owned() };
                all.push((changed, format!("{name} {words}")));
            }
        }
        all
    }
}

/// Gives every field of that name, in the configuration and its tables, another number; returns how many there are.
fn replace(value: &mut Value, name: &str, new: &dyn Fn(Option<i64>) -> Option<i64>) -> usize {
    match value {
        Value::Object(entries) => {
            let mut count = 0;
            for (key, entry) in entries {
                if key == name {
                    if let Some(number) = new(entry.as_i64()).filter(|number| *number >= 0 || name == "floor_db") {
                        *entry = number.into();
                        count += 1;
                    }
                } else {
                    count += replace(entry, name, new);
                }
            }
            count
        }
        Value::Array(items) => items.iter_mut().map(|item| replace(item, name, new)).sum(),
        _ => 0,
    }
}

/// The requirements that the guesses name.
#[cfg(test)]
fn named() -> Vec<&'static str> {
    GUESSES.iter().flat_map(|(machine, _)| guesses(machine)).map(|(_, requirement)| *requirement).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::conform::fields::TABLES;

    /// A guess names a requirement that a field of the machine names.
    #[test]
    fn the_requirements_are_those_of_the_fields() {
        let listed: Vec<_> =
            TABLES.iter().flat_map(|table| table.fields).flat_map(|field| field.requirements).collect();
        for requirement in named() {
            assert!(listed.contains(&&requirement), "{requirement}");
        }
    }
}
