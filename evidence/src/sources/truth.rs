//! What a model knows and the machine does not: where the heads really are, and what fails. For the captions of charts.

use atc_models::Trace;
use atc_protocol::form::Line;
use serde_json::Value;

/// The faults and the heads of a trace in a sentence; nothing if the model does not tell.
pub fn words(trace: &Trace) -> String {
    let sections = trace.config["sections"].as_i64().unwrap_or(0);
    let faults = trace.steps.iter().rev().find_map(|step| step.words.get("faults")).map(names).unwrap_or_default();
    let heads: Vec<_> =
        trace.steps.iter().filter_map(|step| step.words.get("heads")).map(|value| heads(value, sections)).collect();
    let mut text = String::new();
    if !faults.is_empty() {
        text = format!(" Faulty: {}.", faults.join(", "));
    }
    if heads.len() == trace.steps.len() && !heads.is_empty() {
        let all = heads.iter().zip(1..).map(|(heads, cycle)| format!("{cycle}: {heads}"));
        text = format!("{text} Heads really in section, by cycle: {}.", all.collect::<Vec<_>>().join("; "));
    }
    text + &ground(trace)
}

/// Where trains and points of a station really are, in the cycles in which that changes, and what comes of it.
fn ground(trace: &Trace) -> String {
    let mut changes: Vec<String> = Vec::new();
    let mut last = String::new();
    for (step, cycle) in trace.steps.iter().zip(1..) {
        let Some(trains) = step.words.get("trains").and_then(Value::as_array) else { return String::new() };
        let trains: Vec<_> = trains.iter().filter_map(train).collect();
        let points = step.words.get("points_at").map(names).unwrap_or_default();
        let mut now = if trains.is_empty() { "no train".to_owned() } else { trains.join(" and ") };
        if !points.is_empty() {
            now = format!("{now}, points {}", points.join(", "));
        }
        if now != last {
            changes.push(format!("{cycle}: {now}"));
            last = now;
        }
    }
    let harm = trace.steps.last().and_then(|step| step.words.get("harm")).and_then(Value::as_str);
    let harm = harm.filter(|harm| *harm != "none").map(|harm| format!(" At the end: {harm}.")).unwrap_or_default();
    format!(" Really, from cycle: {}.{harm}", changes.join("; "))
}

/// A train that is on the tracks of the station: from its rear to its front.
fn train(train: &Value) -> Option<String> {
    let (front, rear) = (train["front"].as_str()?, train["rear"].as_str()?);
    let heading = train["heading"].as_str()?;
    let at = if front == rear { front.to_owned() } else { format!("{rear} to {front}") };
    Some(format!("a train in {at} going {heading}"))
}

fn names(value: &Value) -> Vec<String> {
    value.as_array().into_iter().flatten().filter_map(|name| Some(name.as_str()?.to_owned())).collect()
}

/// The sections with a head; a negative number is a train that is not there, one from `sections` on is beyond the exit.
fn heads(value: &Value, sections: i64) -> String {
    let mut all: Vec<_> =
        value.as_array().into_iter().flatten().filter_map(Value::as_i64).filter(|head| *head >= 0).collect();
    all.sort_unstable();
    let inside = all.iter().filter(|head| **head < sections).map(ToString::to_string);
    let inside = inside.collect::<Vec<_>>().join(" and ");
    if inside.is_empty() { "none".to_owned() } else { inside }
}

/// The record with one more cycle of the same inputs and no reset or request, so that a chart shows what the last one brought: an
/// output stands from the end of its cycle on.
pub fn one_more(trace: &Trace) -> String {
    let mut record = trace.trace_jsonl();
    if let Some(last) = trace.steps.last().filter(|_| ["block-count", "interlocking"].contains(&&*trace.machine)) {
        let mut input = last.input.clone();
        for command in ["reset", "request"] {
            if let Some(given) = input.get_mut(command) {
                *given = Value::Null;
            }
        }
        record.extend([Line::Step(&input).text().as_str(), "\n"]);
    }
    record
}

#[cfg(test)]
mod tests {
    use super::{one_more, words};
    use atc_models::{Step, Trace};
    use serde_json::json;
    use std::collections::BTreeMap;

    fn trace() -> Trace {
        let step = |heads, faults, reset| Step {
            input: json!({ "present": [1], "reset": reset }),
            output: json!({}),
            words: BTreeMap::from([("heads".to_owned(), json!(heads)), ("faults".to_owned(), json!(faults))]),
        };
        Trace {
            machine: "block-count".to_owned(),
            config: json!({ "sections": 3 }),
            steps: vec![step([-1, -1], Vec::<&str>::new(), None), step([2, 0], vec!["missed in section 0"], Some(2))],
            loop_start: None,
        }
    }

    #[test]
    fn heads_and_faults_are_told() {
        let text = words(&trace());
        assert_eq!(text, " Faulty: missed in section 0. Heads really in section, by cycle: 1: none; 2: 0 and 2.");
        let mut beyond = trace();
        beyond.steps[1].words.insert("heads".to_owned(), json!([3, 1]));
        assert!(words(&beyond).ends_with("2: 1."));
        beyond.steps[0].words.clear();
        assert_eq!(words(&beyond), " Faulty: missed in section 0.");
    }

    #[test]
    fn trains_and_points_of_a_station_are_told_when_they_change() {
        let step = |trains, points, harm| Step {
            input: json!({ "occupied": [], "request": { "set": "R0" } }),
            output: json!({}),
            words: BTreeMap::from([
                ("trains".to_owned(), trains),
                ("points_at".to_owned(), points),
                ("harm".to_owned(), json!(harm)),
            ]),
        };
        let (coming, here) = (json!(["coming"]), json!([{ "front": "B", "rear": "A", "heading": "up" }]));
        let station = Trace {
            machine: "interlocking".to_owned(),
            config: json!({}),
            steps: vec![
                step(coming.clone(), json!(["normal"]), "none"),
                step(coming, json!(["normal"]), "none"),
                step(here, json!(["to reverse"]), "derailment"),
            ],
            loop_start: None,
        };
        assert_eq!(
            words(&station),
            " Really, from cycle: 1: no train, points normal; 3: a train in A to B going up, points to reverse. At the \
             end: derailment."
        );
        let last: serde_json::Value =
            serde_json::from_str(one_more(&station).lines().last().unwrap_or_default()).expect("JSON");
        assert_eq!(last, json!({ "step": { "occupied": [], "request": null } }));
    }

    #[test]
    fn the_last_cycle_is_held_without_its_reset() {
        let record = one_more(&trace());
        let last: serde_json::Value = serde_json::from_str(record.lines().last().unwrap_or_default()).expect("JSON");
        assert_eq!(last, json!({ "step": { "present": [1], "reset": null } }));
        let other = Trace { machine: "aspect-acceptance".to_owned(), ..trace() };
        assert_eq!(one_more(&other), other.trace_jsonl());
    }
}
