//! What a set of vectors covers: the limits of a machine, each decided by a vector, and the transitions of its outputs.
//!
//! A limit is covered on one side if a vector has other replies where the number is a cycle (or one) less, or more.

use std::collections::{BTreeMap, BTreeSet};

use serde::Serialize;
use serde_json::Value;

use super::alike::limits;
use super::fields::{Shape, table};
use super::vector::Vector;

/// A limit, and the vector that decides it.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Limit {
    /// The number, and what is wrong with it.
    pub change: String,
    /// The requirement.
    pub requirement: &'static str,
    /// The id of a vector that has other replies then; none: there is no such vector.
    pub vector: Option<String>,
}

/// What is covered of one machine.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize)]
pub struct Coverage {
    /// The limits.
    pub limits: Vec<Limit>,
    /// For each output field the changes from one cycle to the next that are in a vector.
    pub transitions: BTreeMap<&'static str, BTreeSet<String>>,
}

impl Coverage {
    /// The limits that no vector decides.
    pub fn open(&self) -> Vec<&str> {
        self.limits.iter().filter(|limit| limit.vector.is_none()).map(|limit| limit.change.as_str()).collect()
    }

    /// How many transitions there are.
    pub fn count(&self) -> usize {
        self.transitions.values().map(BTreeSet::len).sum()
    }
}

/// What the vectors of a machine cover.
pub fn coverage(machine: &str, vectors: &[Vector]) -> Coverage {
    let mut coverage = Coverage::default();
    let mut found: BTreeMap<(String, &'static str), Option<String>> = BTreeMap::new();
    for vector in vectors.iter().filter(|vector| !vector.rejected) {
        transitions(machine, vector, &mut coverage.transitions);
        let Ok(right) = vector.expected().case.expected() else { continue };
        // The started reply has every default.
        let started: Value = serde_json::from_str(&right.start).unwrap_or_default();
        for (config, change, requirement) in limits(machine, &started["started"]["config"]) {
            let decided = found.entry((change, requirement)).or_default();
            if decided.is_none() {
                let mut case = right.case.clone();
                case.config = config;
                // A number that the kernel does not take is no other limit.
                let other = case.expected().is_ok_and(|other| !other.is_rejected() && other.outputs != right.outputs);
                *decided = other.then(|| vector.id.clone());
            }
        }
    }
    let limit = |((change, requirement), vector)| Limit { change, requirement, vector };
    coverage.limits = found.into_iter().map(limit).collect();
    coverage
}

/// The word for a value: numbers, lists and texts that are no words are there or not.
fn word(value: Option<&Value>) -> String {
    match value {
        None | Some(Value::Null) => "none".to_owned(),
        Some(Value::Bool(set)) => set.to_string(),
        Some(Value::String(word)) if word.len() > 32 => "a text".to_owned(),
        Some(Value::String(word)) => word.clone(),
        Some(Value::Number(_)) => "a number".to_owned(),
        Some(Value::Array(items)) => if items.is_empty() { "none" } else { "some" }.to_owned(),
        Some(Value::Object(entries)) => entries.keys().next().cloned().unwrap_or_else(|| "none".to_owned()),
    }
}

fn transitions(machine: &str, vector: &Vector, all: &mut BTreeMap<&'static str, BTreeSet<String>>) {
    for field in table(machine).map_or(&[][..], |table| table.fields) {
        for pair in vector.outputs.windows(2) {
            let [before, after] = [&pair[0], &pair[1]].map(|output| field.value(output));
            let seen = all.entry(field.name).or_default();
            if let (Shape::Entries(_), Some(Value::Object(before)), Some(Value::Object(after))) =
                (&field.shape, &before, &after)
            {
                for name in before.keys().chain(after.keys()) {
                    seen.insert(format!("{} > {}", word(before.get(name)), word(after.get(name))));
                }
            } else {
                seen.insert(format!("{} > {}", word(before.as_ref()), word(after.as_ref())));
            }
        }
    }
}
