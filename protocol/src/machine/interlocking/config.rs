//! The configuration: a layout as its TOML file has it, as a JSON object, or a plan in the kernel's own terms.

use std::borrow::Cow;
use std::fmt;

use atc_kernel::interlocking::Size;
use atc_layout::{Description, Errors, Extent, form};
use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::de::{Error as _, MapAccess, SeqAccess, Visitor};
use serde::{Deserialize, Deserializer, Serialize, Serializer};

use super::opened::{Opened, Said};
use super::plan::PlanConfig;
use crate::machine::sizes::Stationed;

/// A layout: the tables and fields of a layout file, as a JSON object; or a plan in the kernel's own terms.
#[derive(Clone, Debug)]
pub enum Config {
    /// As a layout file has it. Every rule is checked.
    Layout(Box<Description>),
    /// In the kernel's own terms: the field `plan`.
    Plan(Box<PlanConfig>),
}

impl Stationed for Config {
    fn is_large(&self) -> bool {
        match self {
            Self::Layout(description) => Extent::of(&description.station).is_large(),
            Self::Plan(plan) => plan.extent().is_large(),
        }
    }
}

impl Config {
    /// The layout in the kernel's form, with its names.
    ///
    /// # Errors
    /// Every rule that it breaks, in sentences.
    pub(super) fn opened<const R: usize, const P: usize, const N: usize, const S: usize, Z: Size>(
        &self,
    ) -> Result<Opened<R, P, N, S, Z>, String> {
        match self {
            Self::Layout(description) => {
                let compiled = description.compile_to::<R, P, N, S, Z>().map_err(|errors| sentences(&errors))?;
                let values = &compiled.model.values;
                let (speeds_kmh, cycle_ms) = (values.speeds_kmh, values.cycle_ms);
                let said = Some(Said::of(&description.station, &compiled.model));
                Ok(Opened { layout: compiled.layout(), names: compiled.names, speeds_kmh, cycle_ms, said })
            }
            Self::Plan(plan) => plan.opened(),
        }
    }
}

/// The problems without their places, which would be those of a file.
fn sentences(errors: &Errors) -> String {
    let problems = errors.problems.iter().map(|problem| {
        let right = if problem.right.is_empty() { String::new() } else { format!("; {}", problem.right) };
        format!("{}{right} [{}]", problem.what, problem.rule.name())
    });
    problems.collect::<Vec<_>>().join(". ")
}

impl From<Description> for Config {
    fn from(description: Description) -> Self {
        Self::Layout(Box::new(description))
    }
}

/// The object with the one field `plan`.
#[derive(Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(rename = "InterlockingPlanOnly")]
struct PlanOnly {
    /// The plan.
    plan: PlanConfig,
}

impl Serialize for Config {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        match self {
            Self::Layout(description) => description.station.serialize(serializer),
            Self::Plan(plan) => PlanOnly { plan: (**plan).clone() }.serialize(serializer),
        }
    }
}

impl<'de> Deserialize<'de> for Config {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let Tree(tree) = Tree::deserialize(deserializer)?;
        if tree.get("plan").is_some() {
            let only = PlanOnly::deserialize(tree)
                .map_err(|error| D::Error::custom(format_args!("the plan is not of its form: {}", error.message())))?;
            return Ok(Self::Plan(Box::new(only.plan)));
        }
        let text = toml::to_string(&tree).map_err(D::Error::custom)?;
        match Description::from_toml("", &text) {
            Ok(description) => Ok(description.into()),
            Err(errors) => {
                let what: Vec<_> = errors.problems.iter().map(|problem| problem.what.as_str()).collect();
                Err(D::Error::custom(format_args!("the layout is not of its form: {}", what.join(". "))))
            }
        }
    }
}

impl JsonSchema for Config {
    fn schema_name() -> Cow<'static, str> {
        "InterlockingConfig".into()
    }

    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        json_schema!({ "anyOf": [generator.subschema_for::<form::Station>(), generator.subschema_for::<PlanOnly>()] })
    }
}

/// JSON as the values that TOML has: no null, no field twice.
struct Tree(toml::Value);

impl<'de> Deserialize<'de> for Tree {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_any(Reader).map(Self)
    }
}

struct Reader;

impl<'de> Visitor<'de> for Reader {
    type Value = toml::Value;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("a value of a layout: an object, a list, a text, a number, true or false (a field that says nothing is left out)")
    }

    fn visit_bool<E>(self, value: bool) -> Result<toml::Value, E> {
        Ok(value.into())
    }

    fn visit_i64<E>(self, value: i64) -> Result<toml::Value, E> {
        Ok(value.into())
    }

    fn visit_u64<E: serde::de::Error>(self, value: u64) -> Result<toml::Value, E> {
        i64::try_from(value).map(Into::into).map_err(|_| E::custom(format_args!("{value} is too large a number")))
    }

    fn visit_f64<E>(self, value: f64) -> Result<toml::Value, E> {
        Ok(value.into())
    }

    fn visit_str<E>(self, value: &str) -> Result<toml::Value, E> {
        Ok(value.into())
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut list: A) -> Result<toml::Value, A::Error> {
        let mut values = Vec::new();
        while let Some(Tree(value)) = list.next_element()? {
            values.push(value);
        }
        Ok(values.into())
    }

    fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<toml::Value, A::Error> {
        let mut table = toml::Table::new();
        while let Some((name, Tree(value))) = map.next_entry::<String, _>()? {
            if table.contains_key(&name) {
                return Err(A::Error::custom(format_args!("duplicate field `{name}`")));
            }
            table.insert(name, value);
        }
        Ok(table.into())
    }
}
