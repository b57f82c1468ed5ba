//! Vectors: cases with the kernel's replies and the requirements that they are about, in files that outlive this program.
//!
//! The form is told in `oracle/VECTORS.md`.

use std::collections::{BTreeMap, BTreeSet, HashSet};
use std::fmt::Write as _;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use serde_json::{Map, Value, json};
use sha2::{Digest as _, Sha256};

use super::case::{Case, Expected};
use super::coverage::coverage;
use super::directed;
use super::fields::{self, Level, TABLES};
use super::walk::{self, Sizes};

/// The version of the form.
pub const FORM: u32 = 1;

/// A vector: one line of a file.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(rename = "Vector")]
pub struct Vector {
    /// Sixteen hexadecimal digits of the SHA-256 of machine, config, steps and replies. What has the same id has the same content.
    pub id: String,
    /// The version of the form.
    pub form: u32,
    /// The machine.
    pub machine: String,
    /// The fields of these outputs that no sentence with MUST settles: words for reasons, and what is remembered. All others must be
    /// as they stand here. `--level output` does not compare the open ones.
    pub open: Vec<String>,
    /// The requirements that speak of what the vector shows.
    pub requirements: Vec<String>,
    /// What it is about, in a few words.
    pub note: String,
    /// The body of the start's config.
    pub config: Value,
    /// Whether the start must be rejected. Then there are no steps.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub rejected: bool,
    /// The parameters in cycles that the started reply may report.
    #[serde(default, skip_serializing_if = "Map::is_empty")]
    pub cycles: Map<String, Value>,
    /// The bodies of the steps.
    pub steps: Vec<Value>,
    /// The bodies of the outputs, one for each step.
    pub outputs: Vec<Value>,
}

impl Vector {
    /// The vector of a case.
    pub fn of(expected: &Expected, note: String) -> Self {
        let start: Value = serde_json::from_str(&expected.start).unwrap_or_default();
        let body = |line: &String| serde_json::from_str::<Value>(line).unwrap_or_default()["output"].take();
        let outputs: Vec<Value> = expected.outputs.iter().map(body).collect();
        let rejected = expected.is_rejected();
        let cycles = start["started"]["cycles"].as_object().cloned().unwrap_or_default();
        let requirements = requirements(&expected.case.machine, rejected, &outputs);
        let open = open(&expected.case.machine, &outputs);
        let Case { machine, config, steps } = expected.case.clone();
        let mut vector = Self {
            id: String::new(),
            form: FORM,
            machine,
            open,
            requirements,
            note,
            config,
            rejected,
            cycles,
            steps,
            outputs,
        };
        vector.id = vector.identity();
        vector
    }

    /// The id of the content.
    pub fn identity(&self) -> String {
        let content = json!([self.machine, self.config, self.rejected, self.steps, self.outputs]);
        hex(&Sha256::digest(canonical(&content).as_bytes()))[..16].to_owned()
    }

    /// The case, with the replies that the vector holds (not those of the kernel in this program).
    pub fn expected(&self) -> Expected {
        let case = Case { machine: self.machine.clone(), config: self.config.clone(), steps: self.steps.clone() };
        let start = if self.rejected {
            json!({"rejected": {"reason": ""}})
        } else {
            json!({"started": {"protocol": 1, "machine": self.machine, "config": self.config, "cycles": self.cycles}})
        };
        let outputs = self.outputs.iter().map(|output| json!({"output": output}).to_string()).collect();
        Expected { case, start: start.to_string(), outputs }
    }
}

/// The requirements of the fields whose value changes within the case or is not what it is at rest: what a case at rest alone shows is
/// not what it is about.
fn requirements(machine: &str, rejected: bool, outputs: &[Value]) -> Vec<String> {
    let Some(table) = fields::table(machine) else { return Vec::new() };
    let owned = |ids: &[&str]| ids.iter().map(|id| (*id).to_owned()).collect::<Vec<_>>();
    if rejected {
        return owned(table.start);
    }
    let mut all = BTreeSet::new();
    for field in table.fields {
        let name = field.name.split(' ').next().unwrap_or_default();
        let mut values: Vec<_> = outputs.iter().map(|output| &output[name]).collect();
        values.dedup();
        let rests = values.iter().all(|value| matches!(value, Value::Null | Value::Bool(false)));
        if values.len() > 1 || outputs.len() == 1 && !rests {
            all.extend(owned(field.requirements));
        }
    }
    if all.is_empty() {
        all.extend(table.fields.iter().take(1).flat_map(|field| owned(field.requirements)));
    }
    all.into_iter().collect()
}

/// The fields above the level of outputs that stand in these.
fn open(machine: &str, outputs: &[Value]) -> Vec<String> {
    let fields = fields::table(machine).map_or(&[][..], |table| table.fields);
    let above = fields.iter().filter(|field| field.level > Level::Output);
    let there =
        above.filter(|field| outputs.iter().any(|output| field.value(output).is_some_and(|value| !value.is_null())));
    there.map(|field| field.name.to_owned()).collect()
}

/// The text of a value with the names of every object in order: the same whichever way a library keeps them.
fn canonical(value: &Value) -> String {
    match value {
        Value::Object(entries) => {
            let sorted: BTreeMap<_, _> = entries.iter().collect();
            let entries = sorted.iter().map(|(name, entry)| format!("{}:{}", json!(name), canonical(entry)));
            format!("{{{}}}", entries.collect::<Vec<_>>().join(","))
        }
        Value::Array(items) => format!("[{}]", items.iter().map(canonical).collect::<Vec<_>>().join(",")),
        other => other.to_string(),
    }
}

pub(crate) fn hex(bytes: &[u8]) -> String {
    bytes.iter().fold(String::new(), |mut text, byte| {
        let _ = write!(text, "{byte:02x}");
        text
    })
}

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
