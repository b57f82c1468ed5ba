//! The configuration: a layout as its TOML file has it, as a JSON object.

use std::borrow::Cow;
use std::fmt;

use atc_layout::form::Station;
use atc_layout::{Compiled, Description, Errors};
use schemars::{JsonSchema, Schema, SchemaGenerator};
use serde::de::{Error as _, MapAccess, SeqAccess, Visitor};
use serde::{Deserialize, Deserializer, Serialize, Serializer};

/// A layout: the tables and fields of a layout file, as a JSON object.
#[derive(Clone, Debug)]
pub struct Config {
    description: Description,
}

impl Config {
    /// The layout in the kernel's form, with its names.
    ///
    /// # Errors
    /// Every rule that it breaks, in sentences.
    pub fn compile(&self) -> Result<Compiled, String> {
        self.description.compile().map_err(|errors| sentences(&errors))
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
        Self { description }
    }
}

impl Serialize for Config {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        self.description.station.serialize(serializer)
    }
}

impl<'de> Deserialize<'de> for Config {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let Tree(tree) = Tree::deserialize(deserializer)?;
        let text = toml::to_string(&tree).map_err(D::Error::custom)?;
        match Description::from_toml("", &text) {
            Ok(description) => Ok(Self { description }),
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
        Station::json_schema(generator)
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
