//! What a film can be made of: a session in JSON lines, or a trace of a model, which knows more of each step.

use std::collections::BTreeMap;
use std::fmt;

use atc_film::{Class, Film};
use serde::Deserialize;
use serde_json::{Value, json};

use super::Words;
use super::plain::text;
use crate::trace::{Trace, TraceError};

/// A session or a trace of a model.
#[derive(Clone, Debug)]
pub struct Traced {
    /// As a session.
    pub trace: Trace,
    /// What the model knows of each step; empty for a session.
    pub words: Vec<Words>,
    /// What it shows; none for a session.
    pub title: Option<String>,
}

/// Why nothing can be made of a text.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum TracedError {
    /// It is no session.
    Trace(TraceError),
    /// It is no trace of a model, or the one that was asked for is not in it.
    Model(String),
}

impl fmt::Display for TracedError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Trace(error) => error.fmt(f),
            Self::Model(what) => f.write_str(what),
        }
    }
}

/// A trace of a model, as `models check --json` writes it.
#[derive(Clone, Debug, Deserialize)]
struct ModelTrace {
    #[serde(default)]
    title: Option<String>,
    machine: String,
    config: Value,
    steps: Vec<ModelStep>,
}

#[derive(Clone, Debug, Deserialize)]
struct ModelStep {
    input: Value,
    output: Value,
    #[serde(default)]
    words: Words,
}

#[derive(Deserialize)]
struct Outcome {
    model: String,
    #[serde(default)]
    properties: Vec<Property>,
    #[serde(default)]
    cut_sets: Vec<CutSet>,
}

#[derive(Deserialize)]
struct Property {
    name: String,
    text: String,
    trace: Option<ModelTrace>,
}

#[derive(Deserialize)]
struct CutSet {
    faults: Vec<String>,
    text: String,
    trace: ModelTrace,
}

/// Reads a session in JSON lines, a trace of a model, or the traces of outcomes: then `wanted` is the name of one,
/// `model/property`, or its end.
///
/// # Errors
/// What is wrong with it; the names of what there is.
pub fn read(text: &str, wanted: Option<&str>) -> Result<Traced, TracedError> {
    let start = text.trim_start();
    // A session has one value a line; the first of a file of outcomes begins a list, and a trace has its machine in it.
    let whole =
        start.starts_with('[') || serde_json::from_str::<Value>(start).is_ok_and(|all| all.get("steps").is_some());
    if !whole {
        if let Some(wanted) = wanted {
            return Err(TracedError::Model(format!("a session has no traces with names, such as {wanted:?}")));
        }
        let trace = Trace::parse(text).map_err(TracedError::Trace)?;
        return Ok(Traced { trace, words: Vec::new(), title: None });
    }
    let wrong = |error: serde_json::Error| {
        TracedError::Model(format!("neither a session nor traces as `models check --json` writes them: {error}"))
    };
    if start.starts_with('{') {
        let trace: ModelTrace = serde_json::from_str(text).map_err(wrong)?;
        let title = trace.title.clone();
        return session(trace, title);
    }
    let outcomes: Vec<Outcome> = serde_json::from_str(text).map_err(wrong)?;
    let mut found: Vec<(String, String, ModelTrace)> = Vec::new();
    for outcome in outcomes {
        for property in outcome.properties {
            if let Some(trace) = property.trace {
                found.push((format!("{}/{}", outcome.model, property.name), property.text, trace));
            }
        }
        for set in outcome.cut_sets {
            found.push((format!("{}/{}", outcome.model, set.faults.join("+")), set.text, set.trace));
        }
    }
    let names: Vec<String> = found.iter().map(|(name, ..)| name.clone()).collect();
    let named = |name: &str| wanted.is_none_or(|wanted| name == wanted || name.ends_with(&format!("/{wanted}")));
    let mut fitting = found.into_iter().filter(|(name, ..)| named(name));
    let (first, another) = (fitting.next(), fitting.next());
    match (first, another) {
        (Some((name, text, trace)), None) => session(trace, Some(format!("{name}: {text}"))),
        _ if names.is_empty() => Err(TracedError::Model("there is no trace in it: nothing was found".to_owned())),
        _ => Err(TracedError::Model(format!("name one trace with --trace; there are {}", names.join(", ")))),
    }
}

/// The trace as the session that it is.
fn session(trace: ModelTrace, title: Option<String>) -> Result<Traced, TracedError> {
    let start =
        json!({"start": {"protocol": atc_protocol::form::PROTOCOL, "machine": trace.machine, "config": trace.config}});
    let mut lines = vec![start.to_string()];
    let mut words = Vec::new();
    for step in trace.steps {
        lines.push(json!({"step": step.input}).to_string());
        lines.push(json!({"output": step.output}).to_string());
        words.push(step.words);
    }
    let trace = Trace::parse(&lines.join("\n")).map_err(TracedError::Trace)?;
    Ok(Traced { trace, words, title })
}

/// Puts what a model, or the adversary, knows into a film: where trains are, how points lie, what goes wrong.
pub(super) fn words(film: &mut Film, words: &[Words]) {
    let mut names: BTreeMap<&str, Vec<&Value>> = BTreeMap::new();
    for name in words.iter().flat_map(|words| words.keys()) {
        names.entry(name).or_default();
    }
    for (name, values) in &mut names {
        values.extend(words.iter().map(|words| words.get(*name).unwrap_or(&Value::Null)));
    }
    let mut rest = false;
    for (name, values) in names {
        match name {
            "trains" => trains(film, &values),
            "points_at" => {
                let most = values.iter().filter_map(|value| value.as_array()).map(Vec::len).max().unwrap_or(0);
                for point in 0..most {
                    let lies = values.iter().map(|value| value.get(point).and_then(Value::as_str).unwrap_or(""));
                    film.channel(("truth", &format!("point P{point} lies"), "value"), lies);
                }
                rest |= most > 0;
            }
            _ => {
                let said = |value: &&Value| if value.is_null() { String::new() } else { text(value) };
                film.channel(("truth", &name.replace('_', " "), "value"), values.iter().map(said));
                rest = true;
            }
        }
    }
    if rest {
        film.table("What is true", "truth", &[("value", "value")], true);
    }
    let harm = |name: &str, word: &str| {
        (name == "harm" && word != "none" && !word.is_empty()).then(|| format!("harm: {word}"))
    };
    film.happenings(("truth", "value"), Class::Harm, harm);
}

fn trains(film: &mut Film, values: &[&Value]) {
    let most = values.iter().filter_map(|value| value.as_array()).map(Vec::len).max().unwrap_or(0);
    for train in 0..most {
        let named = values.iter().find_map(|value| value.get(train)?.get("name")?.as_str());
        let name = named.map_or_else(|| format!("T{train}"), str::to_owned);
        let at = |value: &Value| value.get(train).cloned().unwrap_or_default();
        for what in ["front", "rear", "heading"] {
            let said = values.iter().map(|value| at(value).get(what).and_then(Value::as_str).unwrap_or("").to_owned());
            film.channel(("train", &name, what), said);
        }
        let place = values.iter().map(|value| match at(value) {
            Value::String(word) => word,
            Value::Object(_) => "here".to_owned(),
            _ => String::new(),
        });
        film.channel(("train", &name, "place"), place);
        film.trains.push(name);
    }
    let mut columns = vec![("place", "where"), ("front", "front in"), ("rear", "rear in"), ("heading", "heading")];
    // What knows metres also says which pieces a train is on, and how far into the first and the last one, in
    // thousandths.
    let number =
        |value: &Value, train: usize, what: &str| value.get(train).and_then(|at| at.get(what)).and_then(Value::as_i64);
    if values.iter().any(|value| (0..most).any(|train| number(value, train, "front_share").is_some())) {
        for (train, name) in film.trains.clone().iter().enumerate() {
            let on = values.iter().map(|value| value[train]["on"].as_str().unwrap_or("").to_owned());
            film.channel(("train", name, "on"), on);
            for (what, of, unit) in [
                ("front_share", "front_share", ("", 1000)),
                ("rear_share", "rear_share", ("", 1000)),
                ("speed", "speed_km_h", ("km/h", 1)),
            ] {
                film.curve(("train", name, what), unit, values.iter().map(|value| number(value, train, of)));
            }
        }
        columns.push(("speed", "speed"));
    }
    film.table("Trains, as they truly are", "train", &columns, true);
}
