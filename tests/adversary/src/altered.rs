//! Stations whose files were altered at random: an attack on the checks of a layout.
//!
//! A file that breaks no rule any more than before is a station like any other, whoever wrote it. So the adversary hunts on it, on the tracks
//! that the altered file describes, under the conditions that it states. An accident there is a rule that is missing.

use atc_layout::Description;

use super::arsenal::Arsenal;
use super::dice::Dice;
use super::hunt::{Hunt, Tally, hunt};
use super::judge::Family;
use super::{device, known, words};

/// What a value is multiplied with, in tenths, where it is altered.
const FACTORS: [u64; 6] = [0, 1, 5, 9, 20, 100];

/// The most alterations of one file.
const MOST: usize = 3;

/// What may be added to a table that lacks it: a number of these, or circuits.
const ADDED: [(&str, &[&str]); 5] = [
    (
        "[times]",
        &[
            "clear_ms",
            "shunt_loss_ms",
            "drive_ms",
            "throw_ms",
            "start_ms",
            "settle_ms",
            "release_ms",
            "residual_ms",
            "stay_ms",
            "standstill_ms",
            "turn_ms",
            "telegram_age_ms",
            "cycle_ms",
        ],
    ),
    ("[braking]", &["deceleration_mm_s2", "heard_beyond_m"]),
    ("[[route]]", &["approach", "beyond", "overlap", "speed_kmh", "approach_kmh", "drive_ms", "release_ms", "stay_ms"]),
    ("[[point]]", &["detectors", "fouled_in", "throw_ms"]),
    ("[[segment]]", &["shared", "throat", "speed_kmh"]),
];

/// The numbers that are added.
const NUMBERS: [u64; 14] = [0, 1, 10, 25, 45, 75, 100, 500, 1_000, 2_000, 5_000, 20_000, 40_000, 90_000];

/// What was altered, in words, and the altered file; nothing if it breaks a rule, or if nothing is left to alter.
pub fn altered(original: &Description, dice: &mut Dice) -> Option<(String, Description)> {
    let mut blocks = blocks(&original.to_toml());
    let mut said = Vec::new();
    for _ in 0..=dice.below(MOST) {
        said.push(alter(&mut blocks, dice)?);
    }
    let text = blocks.iter().flatten().map(String::as_str).collect::<Vec<_>>().join("\n");
    let description = Description::from_toml(&original.source.name, &text).ok()?;
    (description.to_toml() != original.to_toml() && description.model().is_ok()).then(|| (said.join("; "), description))
}

/// What an attack on the checks has done.
#[derive(Clone, Debug, Default)]
pub struct Attack {
    /// Files that were altered and broke no rule: stations to hunt on.
    pub accepted: usize,
    /// Files that broke one.
    pub rejected: usize,
    /// The hunts on the accepted ones, together.
    pub tally: Tally,
    /// For each accepted file with an accident: what was altered, the file, and what happened.
    pub finds: Vec<(String, Description, String)>,
}

/// Alters the file so often, from this seed, and hunts for so many cycles on each that breaks no rule. Accidents under a broken condition count
/// too: which conditions a file can break by itself is for the checks.
pub fn attack(original: &Description, seed: u64, times: usize, cycles: u64) -> Attack {
    let (mut attack, mut dice) = (Attack::default(), Dice::new(seed));
    for _ in 0..times {
        let Some((said, description)) = altered(original, &mut dice) else {
            attack.rejected += 1;
            continue;
        };
        // A layout that is sound has room, too, or the compiler says no.
        let Ok((mut kernel, ground)) = device::kernel(&description) else {
            attack.rejected += 1;
            continue;
        };
        attack.accepted += 1;
        if ground.lines.len() < description.station.segments.len() {
            attack.finds.push((said, description, "a segment does not reach the end of its line".to_owned()));
            continue;
        }
        let sought = Family::ALL.to_vec();
        let wanted = Hunt { seed: dice.next(), cycles, episode: known::EPISODE, arsenal: Arsenal::ALL, sought };
        let (find, tally) = hunt(&mut *kernel, &ground, &wanted);
        let all = &mut attack.tally;
        (all.cycles, all.episodes) = (all.cycles + tally.cycles, all.episodes + tally.episodes);
        (all.routes_set, all.trains) = (all.routes_set + tally.routes_set, all.trains + tally.trains);
        (all.metres, all.discarded) = (all.metres + tally.metres, all.discarded + tally.discarded);
        if let Some(find) = find {
            let told = words::tell(&mut *kernel, &ground, &find);
            attack.finds.push((said, description, told));
        } else if tally.discarded > 0 {
            attack.finds.push((said, description, "an accident under a broken condition".to_owned()));
        }
    }
    attack
}

/// The lines of each table of a file.
fn blocks(text: &str) -> Vec<Vec<String>> {
    let mut blocks = vec![Vec::new()];
    for line in text.lines().filter(|line| !line.trim().is_empty()) {
        if line.starts_with('[') {
            blocks.push(Vec::new());
        }
        if let Some(block) = blocks.last_mut() {
            block.push(line.to_owned());
        }
    }
    blocks
}

/// Adds a value that was derived until now.
fn add(blocks: &mut Vec<Vec<String>>, dice: &mut Dice) -> Option<String> {
    let (head, keys) = dice.pick(&ADDED)?;
    let key = dice.pick(keys)?;
    let circuits: Vec<String> = blocks
        .iter()
        .filter(|block| block[0] == "[[circuit]]")
        .flatten()
        .filter_map(|line| line.strip_prefix("name = "))
        .map(ToOwned::to_owned)
        .collect();
    let mut circuit = || circuits.get(dice.below(circuits.len())).cloned().unwrap_or_default();
    let value = match key {
        "throat" => circuit(),
        "approach" | "beyond" | "overlap" | "detectors" | "fouled_in" | "shared" => {
            let (one, other) = (circuit(), circuit());
            if dice.once_in(2) { format!("[{one}]") } else { format!("[{one}, {other}]") }
        }
        _ => dice.pick(&NUMBERS)?.to_string(),
    };
    let places: Vec<usize> = (0..blocks.len()).filter(|number| blocks[*number][0] == head).collect();
    let place = match dice.pick(&places) {
        Some(place) => place,
        None if head.starts_with("[[") => return None,
        None => {
            blocks.push(vec![head.to_owned()]);
            blocks.len() - 1
        }
    };
    let line = format!("{key} = {value}");
    // In place of what the file has.
    blocks[place].retain(|line| !line.starts_with(&format!("{key} = ")));
    blocks[place].push(line.clone());
    Some(format!("{} with {line}", blocks[place].join(" ")))
}

/// Alters one thing.
fn alter(blocks: &mut Vec<Vec<String>>, dice: &mut Dice) -> Option<String> {
    if dice.once_in(3) {
        return add(blocks, dice);
    }
    let number = dice.below(blocks.len());
    let head = blocks[number].first().cloned().unwrap_or_default();
    if dice.once_in(8) && head.starts_with("[[") {
        return Some(format!("without {}", blocks.remove(number).join(" ")));
    }
    if dice.once_in(12) && head.starts_with("[[") {
        let twin = blocks[dice.below(blocks.len())].clone();
        let said = format!("once more {}", twin.join(" "));
        blocks.push(twin);
        return Some(said);
    }
    let keys: Vec<usize> = (0..blocks[number].len()).filter(|line| blocks[number][*line].contains(" = ")).collect();
    let line = dice.pick(&keys)?;
    let old = blocks[number][line].clone();
    if dice.once_in(6) {
        blocks[number].remove(line);
        return Some(format!("{head}: without {old}"));
    }
    let (key, value) = old.split_once(" = ")?;
    let new = if let Ok(given) = value.parse::<u64>() {
        match dice.below(3) {
            0 => given.saturating_add(1).to_string(),
            1 => given.saturating_sub(1).to_string(),
            _ => (given * dice.pick(&FACTORS)? / 10).to_string(),
        }
    } else if value.starts_with('[') && dice.once_in(2) {
        of_list(value, dice)?
    } else {
        // What stands elsewhere in its place: another joint, circuit, position, kind or list.
        let others: Vec<String> = blocks
            .iter()
            .flatten()
            .filter_map(|other| other.split_once(" = "))
            .filter(|(other, _)| *other == key || alike(other, key))
            .map(|(_, value)| value.to_owned())
            .filter(|other| *other != value)
            .collect();
        others.get(dice.below(others.len()))?.clone()
    };
    blocks[number][line] = format!("{key} = {new}");
    Some(format!("{head}: {old} is {new}"))
}

/// Whether the values of two keys are of one kind.
fn alike(one: &str, other: &str) -> bool {
    const KINDS: [&[&str]; 3] = [
        &["left", "right", "toe", "normal", "reverse", "joint"],
        &["path", "overlap", "approach", "beyond", "circuits", "shared", "detectors"],
        &["from", "to"],
    ];
    KINDS.iter().any(|kind| kind.contains(&one) && kind.contains(&other))
}

/// A list with an item less, or with two of them exchanged.
fn of_list(value: &str, dice: &mut Dice) -> Option<String> {
    let inner = value.strip_prefix('[')?.strip_suffix(']')?;
    let mut items = items(inner);
    if items.is_empty() {
        return None;
    }
    let (one, other) = (dice.below(items.len()), dice.below(items.len()));
    if one == other {
        items.remove(one);
    } else {
        items.swap(one, other);
    }
    Some(format!("[{}]", items.join(", ")))
}

/// The items of a list: commas within braces and brackets belong to an item.
fn items(inner: &str) -> Vec<String> {
    let (mut depth, mut items, mut item) = (0_i32, Vec::new(), String::new());
    for letter in inner.chars() {
        depth += match letter {
            '{' | '[' => 1,
            '}' | ']' => -1,
            _ => 0,
        };
        if letter == ',' && depth == 0 {
            items.push(std::mem::take(&mut item));
        } else {
            item.push(letter);
        }
    }
    items.push(item);
    items.into_iter().map(|item| item.trim().to_owned()).filter(|item| !item.is_empty()).collect()
}
