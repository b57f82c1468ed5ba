//! Plans of a small station that each break one rule of a layout.

use serde_json::{Value, json};

/// Changes of a plan: where, as a JSON pointer below `plan`, and what stands there then.
type Changes = &'static [(&'static str, &'static str)];

/// Each breaks one rule of the station as it is: its circuits are W, A, B, C and E, and its routes lead over the point P in A from W to B and
/// to C, the first one with the overlap E.
const WRONG: &[Changes] = &[
    &[("/cycle_ms", "0")],
    &[("/clear_cycles", "0")],
    &[("/turn_cycles", "0")],
    &[("/routes/0/drive_cycles", "0")],
    &[("/routes/0/release_cycles", "0")],
    &[("/routes/0/stay_cycles", "0")],
    &[("/routes/1/drive_cycles", "0")],
    // The release time covers residual running and loss; the stay the standstill time, the loss and a cycle; twice the loss is clear.
    &[("/residual_cycles", "4")],
    &[("/residual_cycles", "3"), ("/loss_cycles", "1"), ("/clear_cycles", "2")],
    &[("/standstill_cycles", "2")],
    &[("/standstill_cycles", "1"), ("/loss_cycles", "1"), ("/clear_cycles", "2")],
    // Points.
    &[("/routes/0/path/0/points", "{}")],
    &[("/routes/0/overlap/points", r#"{"P": "reverse"}"#)],
    &[("/points", r#"[{"name": "P", "detectors": ["A"]}, {"name": "Q", "detectors": ["E"]}]"#)],
    // Routes beside each other.
    &[("/routes/0/conflicts", r#"["to-C"]"#)],
    &[("/routes/1/heading", r#""left""#)],
    &[("/routes/0/continuing", r#"["to-C"]"#)],
    // Places.
    &[("/routes/0/path", "[]")],
    &[("/routes/0/path/1/circuits", r#"["B", "C"]"#)],
    &[("/routes/0/path/1", r#"{"circuits": ["A"], "points": {"P": "normal"}}"#), ("/routes/0/beyond", r#"["B"]"#)],
    // Speeds.
    &[("/speeds_km_h", "[45, 90]")],
    &[("/speeds_km_h", "[0, 45, 65]"), ("/braking_m", "[0, 300, 200]")],
];

/// The same with the segment S behind B.
const WRONG_LINES: &[Changes] = &[
    &[("/segments/0/circuits", r#"["C"]"#)],
    &[("/segments/0/circuits", r#"["E", "E"]"#)],
    &[("/segments/0/throat", r#"["E"]"#)],
    &[("/routes/0/overlap/circuits", r#"["E"]"#)],
    &[(
        "/segments",
        r#"[{"name": "S", "circuits": ["E"], "throat": ["B"], "outward": "right"},
                          {"name": "T", "circuits": ["E"], "throat": ["B"], "outward": "right"}]"#,
    )],
];

/// The station with a segment.
pub(super) fn with_line(mut fork: Value) -> Value {
    let plan = &mut fork["plan"];
    plan["segments"] = json!([{"name": "S", "circuits": ["E"], "throat": ["B"], "outward": "right"}]);
    plan["routes"][0]["to"] = json!(["S"]);
    plan["routes"][0]["overlap"]["circuits"] = json!([]);
    fork
}

/// The plans.
pub(super) fn wrong(fork: &Value) -> Vec<Value> {
    let line = with_line(fork.clone());
    let pairs = WRONG.iter().map(|changes| (fork, changes)).chain(WRONG_LINES.iter().map(|changes| (&line, changes)));
    pairs.map(|(plan, changes)| changed(plan, changes)).chain([long(fork)]).collect()
}

fn changed(plan: &Value, changes: Changes) -> Value {
    let mut plan = plan.clone();
    for (at, text) in changes {
        let value = serde_json::from_str(text).unwrap_or_default();
        if let Some(place) = plan.pointer_mut(&format!("/plan{at}")) {
            *place = value;
        }
    }
    plan
}

/// A path of a place more than there is room for.
fn long(fork: &Value) -> Value {
    let mut plan = fork.clone();
    let names: Vec<String> = (0..15).map(|number| format!("D{number}")).collect();
    let circuits = names.iter().map(|name| json!({"name": name, "length_m": 600}));
    let places = names.iter().map(|name| json!({"circuits": [name], "points": {}}));
    for (at, more) in [("/plan/circuits", circuits.collect::<Vec<_>>()), ("/plan/routes/1/path", places.collect())] {
        if let Some(list) = plan.pointer_mut(at).and_then(Value::as_array_mut) {
            list.extend(more);
        }
    }
    plan
}

#[cfg(test)]
mod tests {
    use super::super::interlocking::fork;
    use super::{with_line, wrong};
    use crate::conform::case::{Case, is_rejected};
    use serde_json::Value;

    fn started(config: Value) -> String {
        let case = Case { machine: "interlocking".to_owned(), config, steps: Vec::new() };
        case.expected().map_or_else(|error| error, |expected| expected.start)
    }

    #[test]
    fn the_station_is_taken_and_each_of_its_wrong_plans_is_not() {
        assert!(!is_rejected(&started(fork())) && !is_rejected(&started(with_line(fork()))));
        for plan in wrong(&fork()) {
            let reply = started(plan);
            assert!(is_rejected(&reply), "{reply}");
        }
    }
}
