//! A vector: a case with the kernel's replies and the requirements that it is about, as one line of a file.

use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write as _;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use serde_json::{Map, Value, json};
use sha2::{Digest as _, Sha256};

use atc_protocol::form::Line;

use super::case::{Case, Expected};
use super::fields::{self, Level};

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
        let outputs = self.outputs.iter().map(|output| Line::Output(output).text()).collect();
        Expected { case, start: start.to_string(), outputs, left_out: 0 }
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
