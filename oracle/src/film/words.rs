//! What a model, or the adversary, knows of each step, as a part of a film.

use std::collections::BTreeMap;

use atc_film::{Class, Film};
use serde_json::Value;

use super::plain::text;
use super::take::Words;

/// Puts what a model, or the adversary, knows into a film: where trains are, how points lie, what goes wrong.
pub(super) fn put(film: &mut Film, words: &[Words]) {
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
