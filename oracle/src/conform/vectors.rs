//! Vectors: cases with the kernel's replies and the requirements that they are about, in files that outlive this program.
//!
//! The form is told in `oracle/VECTORS.md`.

use std::collections::{BTreeSet, HashSet};

use serde_json::{Value, json};
use sha2::{Digest as _, Sha256};

use super::case::Expected;
use super::coverage::coverage;
use super::directed;
use super::fields::TABLES;
use super::vector::hex;
use super::walk::{self, Sizes};

pub use super::vector::{FORM, Vector};

/// Which vectors.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Set {
    /// A minute's worth.
    Minimal,
    /// At least ten thousand.
    Thorough,
}

/// The seed of the vectors. It does not change: ids are permanent.
const SEED: u64 = 5_937_270;

/// How many walks a machine has in a set.
const fn count(machine: &str, set: Set) -> u64 {
    let thorough = match machine.as_bytes() {
        b"interlocking" => 4800,
        b"permitted-speed" => 2000,
        b"speed-supervision" | b"braking-pattern" => 600,
        _ => 1500,
    };
    match (set, machine.as_bytes()) {
        // Its stations are many.
        (Set::Minimal, b"interlocking" | b"wayside") => thorough / 3,
        (Set::Minimal, _) => thorough / 10,
        (Set::Thorough, _) => thorough,
    }
}

/// The vectors of a machine: the committed examples, directed ones, configurations to be rejected, and walks.
pub fn vectors(machine: &str, set: Set) -> Vec<Vector> {
    let mut seen = HashSet::new();
    let mut all = Vec::new();
    let mut add = |vector: Vector| {
        if seen.insert(vector.id.clone()) {
            all.push(vector);
        }
    };
    for (name, case) in walk::examples(machine) {
        // A step that is not taken is not part of a vector.
        if let Ok(expected) = case.expected() {
            add(Vector::of(&expected, format!("the example {name}")));
        }
    }
    for directed in directed::all().into_iter().filter(|directed| directed.machine == machine) {
        if let Ok(expected) = directed.case().expected() {
            add(Vector::of(&expected, format!("catches {}", directed.catches.join(", "))));
        }
    }
    let wrong = walk::source(machine).map_or(0, walk::Source::wrong_count) as u64;
    for number in 0..wrong + count(machine, set) {
        // The lines' own configurations only in the thorough set, and few: their traces are long.
        let sizes = if set == Set::Thorough { Sizes::Few } else { Sizes::Small };
        let Some(expected) = walk::case(machine, SEED, number, sizes, None) else { continue };
        let what = if expected.is_rejected() { "a rule broken by one step, walk" } else { "walk" };
        add(Vector::of(&expected, format!("{what} {number}")));
    }
    all
}

/// The vectors of the minimal set that have this note: one, or the sessions of an example.
pub fn noted(machine: &str, note: &str) -> Vec<Vector> {
    let expected: Vec<Expected> = if let Some(name) = note.strip_prefix("the example ") {
        let its = walk::examples(machine).into_iter().filter(|(known, _)| *known == name);
        its.filter_map(|(_, case)| case.expected().ok()).collect()
    } else if let Some(number) = note.rsplit_once("walk ").and_then(|(_, number)| number.parse().ok()) {
        walk::case(machine, SEED, number, Sizes::Small, None).into_iter().collect()
    } else {
        let names = |directed: &directed::Directed| format!("catches {}", directed.catches.join(", "));
        let its = directed::all().into_iter().filter(|directed| directed.machine == machine && names(directed) == note);
        its.filter_map(|directed| directed.case().expected().ok()).collect()
    };
    expected.iter().map(|expected| Vector::of(expected, note.to_owned())).collect()
}

/// The JSON Schema of a vector.
pub fn schema() -> String {
    format!("{:#}\n", schemars::schema_for!(Vector).to_value())
}

/// The files of a set: names and contents, the list with their checksums last.
pub fn files(machines: &[&str], set: Set) -> Vec<(String, String)> {
    let mut files = Vec::new();
    let mut list = Vec::new();
    for machine in machines {
        let vectors = vectors(machine, set);
        let mut text = String::new();
        for vector in &vectors {
            text.push_str(&json!(vector).to_string());
            text.push('\n');
        }
        let (name, steps) =
            (format!("{machine}.jsonl"), vectors.iter().map(|vector| vector.steps.len()).sum::<usize>());
        let covered: BTreeSet<_> = vectors.iter().flat_map(|vector| vector.requirements.clone()).collect();
        list.push(json!({
            "file": name, "machine": machine, "vectors": vectors.len(), "steps": steps,
            "requirements": covered, "sha256": hex(&Sha256::digest(text.as_bytes())),
            "coverage": coverage(machine, &vectors),
        }));
        files.push((name, text));
    }
    files.push(("vector.schema.json".to_owned(), schema()));
    let set = if set == Set::Minimal { "minimal" } else { "thorough" };
    let list = json!({"form": FORM, "set": set, "seed": SEED, "oracle": env!("CARGO_PKG_VERSION"), "files": list});
    files.push(("vectors.json".to_owned(), format!("{list:#}\n")));
    files
}

/// Reads the vectors of the files in a list, given the reader of a file.
///
/// # Errors
/// A file that cannot be read, whose checksum is wrong, or a line that is no vector or has not the id of its content.
pub fn read(mut file: impl FnMut(&str) -> Result<String, String>) -> Result<Vec<Vector>, String> {
    const LIST: &str = "vectors.json";
    let list: Value = serde_json::from_str(&file(LIST)?).map_err(|error| format!("{LIST}: {error}"))?;
    if list["form"] != FORM {
        return Err(format!("{LIST}: form {} is not read here; form {FORM} is", list["form"]));
    }
    let mut vectors = Vec::new();
    for entry in list["files"].as_array().into_iter().flatten() {
        let name = entry["file"].as_str().unwrap_or_default();
        if name.is_empty() || name.contains(['/', '\\']) {
            return Err(format!("{LIST}: {name:?} is not the name of a file beside it"));
        }
        let text = file(name)?;
        if entry["sha256"] != hex(&Sha256::digest(text.as_bytes())) {
            return Err(format!("{name}: its SHA-256 is not the one in {LIST}; write the vectors anew"));
        }
        for (number, line) in text.lines().enumerate() {
            let place = number + 1;
            let vector: Vector =
                serde_json::from_str(line).map_err(|error| format!("{name}: line {place} is no vector: {error}"))?;
            if vector.identity() != vector.id || vector.steps.len() != vector.outputs.len() {
                return Err(format!("{name}: line {place}: the content of {} is not that of its id", vector.id));
            }
            if !TABLES.iter().any(|table| table.machine == vector.machine) {
                return Err(format!("{name}: line {place}: there is no machine {:?}", vector.machine));
            }
            vectors.push(vector);
        }
    }
    Ok(vectors)
}
