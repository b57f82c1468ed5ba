//! The values of each step as they stand on the wire, for machines without a picture of their own; and where a record
//! differs.

use atc_film::{Class, Film};
use serde_json::Value;

use super::take::Take;
use atc_protocol::machine::Machine;

/// The longest text of a value.
const LONGEST: usize = 160;

/// Every field of the steps and of the outputs as a channel; what changes in the outputs as events.
pub(super) fn values<M: Machine>(film: &mut Film, take: &Take<'_, M>) {
    let said = take.cycles.iter().map(|cycle| cycle.recorded.as_ref().unwrap_or(&cycle.output));
    let said: Vec<Value> = said.map(|output| serde_json::to_value(output).unwrap_or_default()).collect();
    for (kind, list) in [("input", take.steps), ("output", said.as_slice())] {
        for name in names(list) {
            film.channel((kind, &name, "value"), list.iter().map(|body| field(body, &name)));
        }
    }
    film.table("Read in this step", "input", &[("value", "value")], false);
    film.table("Answered", "output", &[("value", "value")], false);
    // What changes at most steps, such as a distance, is no event.
    let often = film.frames / 2 + 1;
    let quiet: Vec<String> = film
        .channels
        .iter()
        .filter(|one| one.kind == "output" && one.at.len() > often.try_into().unwrap_or(usize::MAX))
        .map(|one| one.name.clone())
        .collect();
    let told = |name: &str, word: &str| {
        let word = if word.is_empty() { "nothing" } else { word };
        (!quiet.iter().any(|other| other == name)).then(|| format!("{name}: {word}"))
    };
    film.happenings(("output", "value"), Class::Output, told);
}

/// The fields of all bodies, in the order in which they come.
fn names(bodies: &[Value]) -> Vec<String> {
    let mut names: Vec<String> = Vec::new();
    for name in bodies.iter().filter_map(Value::as_object).flat_map(serde_json::Map::keys) {
        if !names.contains(name) {
            names.push(name.clone());
        }
    }
    names
}

fn field(body: &Value, name: &str) -> String {
    body.get(name).map_or_else(String::new, text)
}

/// A value as a text: as JSON has it, but for a text, which stands without its marks.
pub(super) fn text(value: &Value) -> String {
    let text = match value {
        Value::String(text) => text.clone(),
        Value::Array(list) => list.iter().map(text).collect::<Vec<_>>().join(", "),
        Value::Object(fields) => {
            fields.iter().map(|(name, value)| format!("{name}: {}", self::text(value))).collect::<Vec<_>>().join(", ")
        }
        Value::Null => "none".to_owned(),
        other => other.to_string(),
    };
    match text.char_indices().nth(LONGEST) {
        Some((end, _)) => format!("{}…", &text[..end]),
        None => text,
    }
}

/// Where the record says something else than the kernel: the film shows the record, and what the kernel says stands
/// beside it.
pub(super) fn differences<M: Machine>(film: &mut Film, take: &Take<'_, M>) {
    let kernel: Vec<String> = take
        .cycles
        .iter()
        .map(|cycle| match &cycle.recorded {
            Some(said) if *said != cycle.output => {
                let (said, kernel) = (serde_json::to_value(said), serde_json::to_value(&cycle.output));
                other_fields(&said.unwrap_or_default(), &kernel.unwrap_or_default())
            }
            _ => String::new(),
        })
        .collect();
    if kernel.iter().all(String::is_empty) {
        return;
    }
    film.notes.insert(
        0,
        "THE RECORD DIFFERS FROM THE KERNEL. What was answered is shown as recorded; what is only remembered, such as what a \
         circuit counts as and is held for, is the kernel's, and so are the rows over time."
            .to_owned(),
    );
    film.channel(("record", "the kernel says", "kernel"), &kernel);
    film.table("The record differs", "record", &[("kernel", "instead")], true);
    let told = |_: &str, word: &str| (!word.is_empty()).then(|| format!("the record differs; the kernel says {word}"));
    film.happenings(("record", "kernel"), Class::Harm, told);
    if let Some(first) = kernel.first().filter(|first| !first.is_empty()) {
        film.event(0, Class::Harm, &format!("the record differs; the kernel says {first}"));
    }
}

fn other_fields(said: &Value, kernel: &Value) -> String {
    let Some(kernel) = kernel.as_object() else { return text(kernel) };
    let other = kernel.iter().filter(|(name, value)| said.get(name.as_str()) != Some(value));
    other.map(|(name, value)| format!("{name}: {}", text(value))).collect::<Vec<_>>().join("; ")
}
