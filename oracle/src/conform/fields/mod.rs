//! What is compared: the fields of an output, the level to which each belongs, on which side a wrong value is dangerous, and which
//! requirements speak of it.

mod tables;

use std::collections::BTreeSet;

use schemars::JsonSchema;
use serde::de::Error as _;
use serde::{Deserialize, Deserializer, Serialize};
use serde_json::{Map, Value};

pub use tables::{TABLES, table};

/// How much of a reply is compared. Each level holds the ones before it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Level {
    /// What leaves the device.
    Output,
    /// And why: the reason of a refusal, the name of a fault.
    #[default]
    Reason,
    /// And what is remembered, where the other side reports it.
    State,
}

/// The fields of one machine.
pub struct Table {
    /// The machine's name.
    pub machine: &'static str,
    /// The requirements by which a configuration is taken or rejected.
    pub start: &'static [&'static str],
    /// The requirements by which times become cycles.
    pub cycles: &'static [&'static str],
    /// The fields of an output.
    pub fields: &'static [Field],
}

/// One field.
pub struct Field {
    /// Its name, as it is reported.
    pub name: &'static str,
    /// The level from which on it is compared.
    pub level: Level,
    /// Where its value is in an output; without this, below its name.
    pub get: Option<fn(&Value) -> Option<Value>>,
    /// How two values are held against each other.
    pub shape: Shape,
    /// What it means if the other side leaves it out.
    pub absent: Absent,
    /// When a wrong value is dangerous.
    pub danger: Danger,
    /// The requirements that speak of it.
    pub requirements: &'static [&'static str],
}

/// How two values are held against each other.
pub enum Shape {
    /// As they stand.
    Plain,
    /// As sets: the order of a list does not count.
    Set,
    /// Entry by entry, each entry by its fields (or as it stands, if there are none).
    Entries(&'static [Field]),
}

/// What it means if the other side leaves a field out.
#[derive(Clone, Copy, PartialEq, Eq)]
pub enum Absent {
    /// A difference, if the kernel has it.
    Counts,
    /// It is not compared.
    NotCompared,
    /// The same as an empty set.
    Empty,
}

/// When a wrong value is dangerous.
#[derive(Clone, Copy, PartialEq, Eq)]
pub enum Danger {
    /// It is a matter of availability, or of words.
    No,
    /// Whatever it is.
    Always,
    /// If it is higher; nothing is the lowest.
    Higher,
    /// If it is lower.
    Lower,
    /// If something is missing in it.
    Fewer,
    /// If something is in it that should not be.
    More,
    /// If it is there, true or accepted, and should not be.
    Appears,
    /// If it is not there, or false, and should be.
    Vanishes,
    /// If the brake is weaker.
    WeakerBrake,
    /// If the interval does not contain the right one.
    Narrower,
}

/// One field in which two replies differ.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Difference {
    /// The field's name, with the entry below a map.
    pub field: String,
    /// What the kernel says; absent: nothing.
    #[serde(default, deserialize_with = "there_at_least", skip_serializing_if = "Option::is_none")]
    pub expected: Option<Value>,
    /// What the other side says; absent: nothing.
    #[serde(default, deserialize_with = "there_at_least", skip_serializing_if = "Option::is_none")]
    pub got: Option<Value>,
    /// Whether it is on the dangerous side.
    pub dangerous: bool,
    /// The requirements that speak of the field.
    #[serde(deserialize_with = "known_requirements")]
    pub requirements: Vec<&'static str>,
}

/// Reads a value that is there: null is one, and not the same as nothing.
fn there_at_least<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Option<Value>, D::Error> {
    Value::deserialize(deserializer).map(Some)
}

/// Reads requirements: those that a table names.
fn known_requirements<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Vec<&'static str>, D::Error> {
    let named = Vec::<String>::deserialize(deserializer)?;
    let listed = |table: &Table| -> Vec<&'static str> {
        let fields = table.fields.iter().flat_map(|field| match field.shape {
            Shape::Entries(inner) => inner.iter().chain([field]).flat_map(|field| field.requirements).collect(),
            _ => field.requirements.iter().collect::<Vec<_>>(),
        });
        table.start.iter().chain(table.cycles).chain(fields).copied().collect()
    };
    let find = |id: &String| TABLES.iter().flat_map(listed).find(|listed| listed == id);
    named
        .iter()
        .map(|id| find(id).ok_or_else(|| D::Error::custom(format_args!("no field has a requirement {id:?}"))))
        .collect()
}

impl Difference {
    /// The field without the entry below it.
    pub fn base(&self) -> &str {
        self.field.split(['/', ' ']).next().unwrap_or_default()
    }
}

/// All fields in which an output differs from the kernel's, the dangerous ones first.
pub fn compare(machine: &str, level: Level, expected: &Value, got: &Value) -> Vec<Difference> {
    let mut differences = Vec::new();
    match table(machine) {
        Some(table) => {
            for field in table.fields {
                field.compare(level, expected, got, &mut differences);
            }
        }
        // A machine that has no table yet: every field as it stands.
        None => {
            for (name, value) in expected.as_object().into_iter().flatten() {
                if !got.get(name).is_some_and(|other| same(value, other)) {
                    let (expected, got) = (Some(value.clone()), got.get(name).cloned());
                    let field = name.clone();
                    differences.push(Difference { field, expected, got, dangerous: true, requirements: Vec::new() });
                }
            }
        }
    }
    differences.sort_by_key(|difference| !difference.dangerous);
    differences
}

/// Compares what a started reply says of the parameters, where both sides say it.
pub fn compare_cycles(machine: &str, expected: &Value, got: &Value) -> Vec<Difference> {
    let cycles = |body: &Value| body.get("cycles").and_then(Value::as_object).cloned().unwrap_or_else(Map::new);
    let (ours, theirs) = (cycles(expected), cycles(got));
    let mut differences = Vec::new();
    for (name, value) in &ours {
        if let Some(other) = theirs.get(name).filter(|other| !same(value, other)) {
            differences.push(Difference {
                field: format!("cycles/{name}"),
                expected: Some(value.clone()),
                got: Some(other.clone()),
                dangerous: true,
                requirements: table(machine).map(|table| table.cycles.to_vec()).unwrap_or_default(),
            });
        }
    }
    differences
}

/// The difference between a start that is taken and one that is rejected.
pub fn start_difference(machine: &str, expected: &str, got: &str) -> Difference {
    Difference {
        field: "start".to_owned(),
        expected: Some(expected.into()),
        got: Some(got.into()),
        dangerous: got == "started",
        requirements: table(machine).map(|table| table.start.to_vec()).unwrap_or_default(),
    }
}

impl Field {
    /// Its value in an output.
    pub(super) fn value(&self, of: &Value) -> Option<Value> {
        self.get.map_or_else(|| of.get(self.name).cloned(), |get| get(of))
    }

    fn compare(&self, level: Level, expected: &Value, got: &Value, into: &mut Vec<Difference>) {
        // The name of what is not there at all is no second difference.
        let told = |difference: &Difference| difference.base() == self.name.split(' ').next().unwrap_or_default();
        if level < self.level || self.level > Level::Output && into.iter().any(told) {
            return;
        }
        let empty = |value: Option<Value>| value.or((self.absent == Absent::Empty).then(|| Value::Array(Vec::new())));
        let (ours, theirs) = (empty(self.value(expected)), empty(self.value(got)));
        if theirs.is_none() && self.absent == Absent::NotCompared || ours.is_none() && theirs.is_none() {
            return;
        }
        if let (Shape::Entries(fields), Some(Value::Object(ours)), Some(Value::Object(theirs))) =
            (&self.shape, &ours, &theirs)
        {
            self.entries(fields, level, ours, theirs, into);
            return;
        }
        let equal = match (&ours, &theirs, &self.shape) {
            (Some(ours), Some(theirs), Shape::Set) => as_set(ours).is_some() && as_set(ours) == as_set(theirs),
            (Some(ours), Some(theirs), _) => same(ours, theirs),
            _ => false,
        };
        if !equal {
            into.push(self.difference(self.name.to_owned(), ours, theirs));
        }
    }

    fn entries(
        &self,
        fields: &[Self],
        level: Level,
        ours: &Map<String, Value>,
        theirs: &Map<String, Value>,
        into: &mut Vec<Difference>,
    ) {
        for name in ours.keys().chain(theirs.keys().filter(|name| !ours.contains_key(*name))) {
            let place = format!("{}/{name}", self.name);
            match (ours.get(name), theirs.get(name)) {
                (Some(one), Some(other)) if !fields.is_empty() => {
                    let mut inner = Vec::new();
                    for field in fields {
                        field.compare(level, one, other, &mut inner);
                    }
                    into.extend(
                        inner.into_iter().map(|difference| Difference {
                            field: format!("{place}/{}", difference.field),
                            ..difference
                        }),
                    );
                }
                (Some(one), Some(other)) if same(one, other) => {}
                (one, other) => into.push(self.difference(place, one.cloned(), other.cloned())),
            }
        }
    }

    fn difference(&self, field: String, expected: Option<Value>, got: Option<Value>) -> Difference {
        let dangerous = self.danger.is(expected.as_ref(), got.as_ref());
        Difference { field, expected, got, dangerous, requirements: self.requirements.to_vec() }
    }
}

impl Danger {
    fn is(self, expected: Option<&Value>, got: Option<&Value>) -> bool {
        let number = |value: Option<&Value>| value.and_then(Value::as_f64).unwrap_or(f64::NEG_INFINITY);
        let set = |value: Option<&Value>| value.and_then(as_set).unwrap_or_default();
        let there = |value: Option<&Value>| {
            !matches!(value, None | Some(Value::Null | Value::Bool(false)))
                && value.and_then(Value::as_str) != Some("refused")
        };
        match self {
            Self::No => false,
            Self::Always => true,
            Self::Higher => number(got) > number(expected),
            Self::Lower => number(got) < number(expected),
            Self::Fewer => !set(expected).is_subset(&set(got)),
            Self::More if matches!(got, Some(Value::Array(_))) => !set(got).is_subset(&set(expected)),
            Self::More => got.is_some(),
            Self::Appears => there(got) && !there(expected),
            Self::Vanishes => there(expected) && !there(got),
            Self::WeakerBrake => {
                let rank = |value: Option<&Value>| match value.and_then(Value::as_str) {
                    Some("emergency") => 2,
                    Some("service") => 1,
                    _ => 0,
                };
                rank(got) < rank(expected)
            }
            Self::Narrower => match (ends(expected), ends(got)) {
                (_, None) => false,
                (None, Some(_)) => true,
                (Some((near, far)), Some((nearest, farthest))) => nearest > near || farthest < far,
            },
        }
    }
}

fn ends(interval: Option<&Value>) -> Option<(f64, f64)> {
    let ends = interval?.as_array()?;
    Some((ends.first()?.as_f64()?, ends.get(1)?.as_f64()?))
}

fn as_set(list: &Value) -> Option<BTreeSet<String>> {
    Some(list.as_array()?.iter().map(ToString::to_string).collect())
}

/// Whether two values say the same: a number is what it is worth, and the other side may say more than the kernel.
pub(crate) fn same(ours: &Value, theirs: &Value) -> bool {
    match (ours, theirs) {
        // Both come from few decimal digits, so equal numbers are equal doubles.
        (Value::Number(one), Value::Number(other)) => one == other || one.as_f64() == other.as_f64(),
        (Value::Array(one), Value::Array(other)) => {
            one.len() == other.len() && one.iter().zip(other).all(|(one, other)| same(one, other))
        }
        (Value::Object(one), Value::Object(other)) => {
            one.iter().all(|(name, value)| other.get(name).is_some_and(|other| same(value, other)))
        }
        _ => ours == theirs,
    }
}
