//! What a film can be made of: a session in JSON lines, or a trace of a model, which knows more of each step.

use std::fmt;

use atc_protocol::form::Line;
use serde::Deserialize;
use serde_json::Value;

use super::take::Words;
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
    let mut lines = vec![Line::start(&trace.machine, &trace.config).text()];
    let mut words = Vec::new();
    for step in trace.steps {
        lines.extend([Line::Step(&step.input), Line::Output(&step.output)].map(|line| line.text()));
        words.push(step.words);
    }
    let trace = Trace::parse(&lines.join("\n")).map_err(TracedError::Trace)?;
    Ok(Traced { trace, words, title })
}
