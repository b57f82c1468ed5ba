//! The configuration: a layout as its TOML file has it, as a JSON object, or a plan in the kernel's own terms.

use std::borrow::Cow;
use std::fmt;

use atc_kernel::interlocking::{Heading, Layout, MAX_CODES, Size};
use atc_layout::model::Model;
use atc_layout::{Description, Errors, Extent, Names, form};
use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::de::{Error as _, MapAccess, SeqAccess, Visitor};
use serde::{Deserialize, Deserializer, Serialize, Serializer};

use super::plan::PlanConfig;

/// A layout: the tables and fields of a layout file, as a JSON object; or a plan in the kernel's own terms.
#[derive(Clone, Debug)]
pub enum Config {
    /// As a layout file has it. Every rule is checked.
    Layout(Box<Description>),
    /// In the kernel's own terms: the field `plan`.
    Plan(Box<PlanConfig>),
}

/// What the machine needs of a configuration.
pub(super) struct Opened<const R: usize, const P: usize, const N: usize, const S: usize, Z: Size> {
    pub(super) layout: Box<Layout<R, P, N, S, Z>>,
    pub(super) names: Names,
    pub(super) speeds_kmh: [u16; MAX_CODES],
    pub(super) cycle_ms: u32,
    /// What the file says besides; a plan has no file.
    pub(super) said: Option<Said>,
}

/// What a layout file says of trains and tracks, and a plan in the kernel's own terms does not.
#[derive(Clone, Debug)]
pub struct Said {
    /// The age of telegrams that the layout counts on, in ms.
    pub telegram_age_ms: u32,
    /// The length of the longest train, in metres, if the file has one.
    pub longest_train_m: Option<u16>,
    /// What trains find in each circuit, and ahead of it: of those that travel to the left, and of those that travel to the right.
    pub facing: [Vec<Found>; 2],
}

/// What a train finds that stands in a circuit and travels one way.
#[derive(Clone, Copy, Debug)]
pub struct Found {
    /// The steepest gradient of the circuit and of all that the train may be granted, in thousandths, whichever way it falls: 0 to 128. A circuit
    /// of which the file has none counts as level.
    pub fall_permille: u8,
    /// The highest speed at which it may run there, in km/h; 0 where no train runs.
    pub fastest_kmh: u16,
}

impl Said {
    fn of(station: &form::Station, model: &Model) -> Self {
        let fall = |circuit: usize| {
            let gradient = station.circuits.get(circuit).and_then(|given| given.gradient.as_ref());
            gradient.map_or(0, |given| given.value.unsigned_abs())
        };
        let found = |circuit: usize, heading: Heading| Found {
            fall_permille: model.ahead(circuit, heading).into_iter().map(fall).max().unwrap_or(0),
            fastest_kmh: model.fastest_kmh(circuit, heading),
        };
        let facing = [Heading::Left, Heading::Right]
            .map(|heading| (0..station.circuits.len()).map(|circuit| found(circuit, heading)).collect());
        Self {
            telegram_age_ms: model.values.telegram_age_ms,
            longest_train_m: station.longest_train_m.as_ref().map(|length| length.value),
            facing,
        }
    }
}

impl Config {
    /// Whether a small station has no room for it.
    pub(super) fn is_large(&self) -> bool {
        match self {
            Self::Layout(description) => Extent::of(&description.station).is_large(),
            Self::Plan(plan) => plan.extent().is_large(),
        }
    }

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
