//! What stands in a step and in an output. Everything goes by its name in the layout.

use std::borrow::Cow;
use std::collections::{BTreeMap, BTreeSet};
use std::fmt;
use std::marker::PhantomData;

use atc_line::decimal::OrNull;
use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::de::{Error as _, MapAccess, Visitor};
use serde::{Deserialize, Deserializer, Serialize};

use super::words::{Heading, Phase, Reason, Side, Travel};

/// One logic cycle's input.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(rename = "InterlockingStep")]
pub struct Step {
    /// The circuits that are reported occupied, each once.
    pub occupied: Vec<String>,
    /// The position in which each point is detected; null or absent: in none.
    pub detected: ByName<Option<Side>>,
    /// At most one request; null or absent: none. What is refused is not remembered.
    #[serde(default)]
    pub request: Option<Request>,
    /// What staff command.
    #[serde(default)]
    pub orders: Orders,
    /// The segments where the neighbour permits this station to send trains.
    #[serde(default)]
    pub consent: Vec<String>,
    /// Whether stop telegrams are to be in the output as well.
    #[serde(default)]
    pub all_telegrams: bool,
}

/// A request.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(untagged)]
pub enum Request {
    /// Set a route.
    Set {
        /// The route.
        set: String,
    },
    /// Withdraw a route.
    Withdraw {
        /// The route.
        withdraw: String,
    },
    /// Drive a point, in this cycle.
    Drive {
        /// The point.
        drive: String,
        /// The position.
        to: Side,
    },
    /// Give a segment a direction.
    Turn {
        /// The segment.
        turn: String,
        /// The direction.
        to: Travel,
    },
}

/// The fields that a request can have; which belong together is looked at afterwards.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Fields {
    #[serde(default, deserialize_with = "given")]
    set: Option<String>,
    #[serde(default, deserialize_with = "given")]
    withdraw: Option<String>,
    #[serde(default, deserialize_with = "given")]
    drive: Option<String>,
    #[serde(default, deserialize_with = "given")]
    turn: Option<String>,
    #[serde(default, deserialize_with = "given")]
    to: Option<String>,
}

/// A text, not null.
fn given<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Option<String>, D::Error> {
    String::deserialize(deserializer).map(Some)
}

impl<'de> Deserialize<'de> for Request {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        const FORMS: &str = r#"a request is {"set":route}, {"withdraw":route}, {"drive":point,"to":"normal" or "reverse"} or {"turn":segment,"to":"toward" or "away"}"#;
        let Fields { set, withdraw, drive, turn, to } = Fields::deserialize(deserializer)?;
        let wrong = |error: serde_json::Error| D::Error::custom(format_args!("{error}; {FORMS}"));
        let word = |to: String| serde_json::Value::String(to);
        match (set, withdraw, drive, turn, to) {
            (Some(set), None, None, None, None) => Ok(Self::Set { set }),
            (None, Some(withdraw), None, None, None) => Ok(Self::Withdraw { withdraw }),
            (None, None, Some(drive), None, Some(to)) => {
                Ok(Self::Drive { drive, to: Side::deserialize(word(to)).map_err(wrong)? })
            }
            (None, None, None, Some(turn), Some(to)) => {
                Ok(Self::Turn { turn, to: Travel::deserialize(word(to)).map_err(wrong)? })
            }
            _ => Err(D::Error::custom(FORMS)),
        }
    }
}

impl JsonSchema for Request {
    fn schema_name() -> Cow<'static, str> {
        "InterlockingRequest".into()
    }

    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        let name =
            |what: &str| serde_json::json!({ "type": "string", "description": format!("The name of a {what}.") });
        let form = |properties: serde_json::Value| {
            let required: Vec<_> = properties.as_object().into_iter().flatten().map(|field| field.0.clone()).collect();
            serde_json::json!({ "type": "object", "properties": properties, "required": required, "additionalProperties": false })
        };
        let forms = [
            form(serde_json::json!({ "set": name("route") })),
            form(serde_json::json!({ "withdraw": name("route") })),
            form(serde_json::json!({ "drive": name("point"), "to": generator.subschema_for::<Side>() })),
            form(serde_json::json!({ "turn": name("segment"), "to": generator.subschema_for::<Travel>() })),
        ];
        json_schema!({ "description": "A request: set or withdraw a route, drive a point, give a segment a direction.", "oneOf": forms.as_slice() })
    }
}

/// What staff command in one cycle.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
#[schemars(rename = "InterlockingOrders")]
pub struct Orders {
    /// Circuits to block.
    pub block: Vec<String>,
    /// Circuits to unblock; one that is to be blocked as well is blocked.
    pub unblock: Vec<String>,
    /// Circuits to restrict, each to a speed in km/h; all of one cycle to the same. The highest code that is not faster counts.
    pub restrict: ByName<u16>,
    /// Circuits whose restriction is lifted; one that is to be restricted as well has the new restriction only.
    pub lift: Vec<String>,
}

/// Values by name, no name twice.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(transparent)]
pub struct ByName<V>(pub BTreeMap<String, V>);

impl<V> Default for ByName<V> {
    fn default() -> Self {
        Self(BTreeMap::new())
    }
}

struct Entries<V>(PhantomData<V>);

impl<'de, V: Deserialize<'de>> Visitor<'de> for Entries<V> {
    type Value = ByName<V>;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("an object with a field for each name")
    }

    fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<ByName<V>, A::Error> {
        let mut values = BTreeMap::new();
        while let Some((name, value)) = map.next_entry::<String, V>()? {
            if values.contains_key(&name) {
                return Err(A::Error::custom(format_args!("{name:?} a second time; each is named once")));
            }
            values.insert(name, value);
        }
        Ok(ByName(values))
    }
}

impl<'de, V: Deserialize<'de>> Deserialize<'de> for ByName<V> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_map(Entries(PhantomData))
    }
}

impl<V: JsonSchema> JsonSchema for ByName<V> {
    fn schema_name() -> Cow<'static, str> {
        format!("{}ByName", V::schema_name()).into()
    }

    fn inline_schema() -> bool {
        true
    }

    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        BTreeMap::<String, V>::json_schema(generator)
    }
}

/// One logic cycle's output.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[schemars(rename = "InterlockingOutput")]
pub struct Output {
    /// The phase of every route that is not idle.
    pub routes: BTreeMap<String, Phase>,
    /// The routes whose signals show proceed; all others show stop.
    pub proceed: BTreeSet<String>,
    /// The points that are driven, and whereto.
    pub drives: BTreeMap<String, Side>,
    /// The telegrams: of circuits with a train that may leave them, and on request of all.
    pub telegrams: BTreeMap<String, Telegram>,
    /// The circuits in which this device sends no telegram, because the neighbour's device speaks there; left out if there are none.
    #[serde(default, skip_serializing_if = "BTreeSet::is_empty")]
    pub silent: BTreeSet<String>,
    /// The segments where this station permits the neighbour to send trains.
    pub permits: BTreeSet<String>,
    /// The blocked circuits that staff may rely on.
    pub confirmed: BTreeSet<String>,
    /// What became of the request; null: there was none.
    // It may be null, but it may not be missing.
    #[serde(deserialize_with = "Option::deserialize")]
    #[schemars(with = "AnswerOrNull")]
    pub answer: Option<Answer>,
}

/// What a circuit's telegram tells the train there.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[schemars(rename = "InterlockingTelegram")]
pub struct Telegram {
    /// The last circuit that the train may enter; its own if it must stay there.
    pub stop: String,
    /// The speed of the code.
    pub speed_km_h: u16,
    /// Whether it may leave its circuit.
    pub open: bool,
    /// The direction of travel in which it may leave it; null: it must stay there. A train that faces the other way must stop.
    // It may be null, but it may not be missing.
    #[serde(deserialize_with = "Option::deserialize")]
    #[schemars(with = "HeadingOrNull")]
    pub heading: Option<Heading>,
}

/// What became of a request.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(untagged)]
#[schemars(rename = "InterlockingAnswer")]
pub enum Answer {
    /// It is carried out.
    Accepted(Accepted),
    /// Nothing has changed, but that a segment that is to be turned away is no longer permitted to the neighbour (ILK-20).
    Refused(Refused),
}

/// The answer "accepted".
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Accepted {
    /// The request is carried out.
    Accepted,
}

/// Why a request is refused.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
pub struct Refused {
    /// The first reason, in the order in which the kernel looks.
    pub refused: Reason,
    /// The routes, circuits, points or segments that are in the way. An implementation may leave it out; it is not compared.
    #[serde(default)]
    pub because: BTreeSet<String>,
}

impl PartialEq for Refused {
    fn eq(&self, other: &Self) -> bool {
        self.refused == other.refused
    }
}

// For the schema only: not to be left out.
type AnswerOrNull = OrNull<Answer>;
type HeadingOrNull = OrNull<Heading>;
