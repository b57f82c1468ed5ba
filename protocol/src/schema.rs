//! The JSON Schema of protocol 1, generated from the types that read and write it.

use schemars::generate::SchemaSettings;
use schemars::{JsonSchema, SchemaGenerator};
use serde_json::{Map, Value, json};

use crate::form::{Malformed, PROTOCOL, Rejected, Stop, Stopped};
use crate::machine::{KINDS, Kind};

/// The schema: a line is a request or a reply. `#/$defs/request` and `#/$defs/reply` are the two alone.
///
/// A schema cannot say everything that the oracle checks: whole tenths, the rules of a configuration, an aspect of
/// the line, a step inside a case.
pub fn schema() -> Value {
    let mut generator = SchemaSettings::draft2020_12().into_generator();
    let mut defs = Map::new();
    let (mut starts, mut steps, mut started, mut outputs) = (Vec::new(), Vec::new(), Vec::new(), Vec::new());
    for kind in KINDS {
        starts.push(start(kind, &mut generator));
        started.push(reply_to_start(kind, &mut generator));
        steps.push((kind.step)(&mut generator).to_value());
        outputs.push((kind.output)(&mut generator).to_value());
    }
    let stop = form::<Stop>(&mut generator);
    let replies = [
        ("started", json!({ "anyOf": started })),
        ("rejected", form::<Rejected>(&mut generator)),
        ("output", json!({ "anyOf": outputs })),
        ("stopped", form::<Stopped>(&mut generator)),
        ("malformed", form::<Malformed>(&mut generator)),
    ];
    let requests = [("start", json!({ "anyOf": starts })), ("step", json!({ "anyOf": steps })), ("stop", stop)];
    defs.insert("request".to_owned(), one_of(requests));
    defs.insert("reply".to_owned(), one_of(replies));
    defs.append(&mut generator.take_definitions(true));
    json!({
        "$schema": "https://json-schema.org/draft/2020-12/schema",
        "title": format!("oracle serve, protocol {PROTOCOL}: one line"),
        "anyOf": [{ "$ref": "#/$defs/request" }, { "$ref": "#/$defs/reply" }],
        "$defs": defs,
    })
}

/// The schema as the file `protocol-1.schema.json` has it.
pub fn text() -> String {
    format!("{:#}\n", schema())
}

fn form<T: JsonSchema>(generator: &mut SchemaGenerator) -> Value {
    generator.subschema_for::<T>().to_value()
}

/// An object with exactly one of these keys.
fn one_of<const N: usize>(forms: [(&str, Value); N]) -> Value {
    let forms = forms.map(|(key, body)| {
        let mut properties = Map::new();
        properties.insert(key.to_owned(), body);
        json!({ "type": "object", "properties": properties, "required": [key], "additionalProperties": false })
    });
    json!({ "oneOf": forms.as_slice() })
}

fn start(kind: &Kind, generator: &mut SchemaGenerator) -> Value {
    json!({
        "type": "object",
        "properties": {
            "protocol": { "type": "integer", "minimum": 0, "maximum": u32::MAX, "description": "1; any other is rejected." },
            "machine": { "const": kind.name },
            "config": (kind.config)(generator),
        },
        "required": ["protocol", "machine"],
        "additionalProperties": false,
    })
}

fn reply_to_start(kind: &Kind, generator: &mut SchemaGenerator) -> Value {
    json!({
        "type": "object",
        "properties": {
            "protocol": { "const": PROTOCOL },
            "machine": { "const": kind.name },
            "config": (kind.config)(generator),
            "cycles": {
                "type": "object",
                "additionalProperties": { "type": "integer", "minimum": 0 },
                "description": "The times in logic cycles, after rounding.",
            },
        },
        "required": ["protocol", "machine", "config"],
    })
}
