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

/// Each breaks one rule of engineering of the station as it is, whose rules are all checked.
const UNSOUND: &[Changes] = &[
    &[("/loss_cycles", "2"), ("/clear_cycles", "3"), ("/routes/0/stay_cycles", "3"), ("/routes/1/stay_cycles", "3")],
    &[("/routes/1/entry", r#"["W", "B"]"#), ("/routes/1/approach", r#"["W", "B"]"#)],
    &[("/routes/1/approach", r#"["B"]"#)],
    &[("/routes/0/approach", r#"["W", "B"]"#)],
    &[("/routes/0/approach", r#"["W", "E"]"#)],
    &[("/routes/0/overlap", r#"{"circuits": ["A"], "points": {"P": "normal"}}"#)],
    &[("/routes/1/beyond", "[]")],
    &[("/routes/1/beyond", r#"["C"]"#)],
    &[("/routes/0/conflicts", r#"["to-B"]"#)],
    &[
        ("/points", r#"[{"name": "P", "detectors": ["A"]}, {"name": "Q", "detectors": []}]"#),
        ("/routes/0/path/0/points", r#"{"P": "normal", "Q": "normal"}"#),
    ],
    &[("/braking_m", "[0, 65535]")],
    &[("/routes/0/speed_code", "0")],
    &[("/circuits/1/length_m", "0")],
];

/// The same with the segment S behind B.
const UNSOUND_LINES: &[Changes] = &[
    &[("/segments/0/throat", r#"["C"]"#)],
    &[("/segments/0/outward", r#""left""#)],
    &[("/routes/1/from", r#"["S"]"#)],
    &[("/points", r#"[{"name": "P", "detectors": ["A"]}, {"name": "Q", "detectors": ["E"]}]"#)],
    &[("/circuits/4/length_m", "0")],
    &[
        (
            "/circuits",
            r#"[{"name": "W", "length_m": 600}, {"name": "A", "length_m": 600}, {"name": "B", "length_m": 600},
                {"name": "C", "length_m": 600}, {"name": "E", "length_m": 600}, {"name": "F", "length_m": 600}]"#,
        ),
        (
            "/segments",
            r#"[{"name": "S", "circuits": ["E"], "throat": ["B"], "outward": "right"},
                {"name": "T", "circuits": ["F"], "throat": ["C"], "outward": "left"},
                {"name": "U", "circuits": ["W"], "throat": ["C"], "outward": "left"}]"#,
        ),
        ("/routes/1/from", r#"["T", "U"]"#),
    ],
    &[
        (
            "/routes/1",
            r#"{"name": "back", "heading": "left", "entry": ["B"], "approach": ["B"],
                "path": [{"circuits": ["A"], "points": {"P": "normal"}}], "overlap": {"circuits": [], "points": {}},
                "beyond": ["W"], "continuing": [], "conflicts": [], "from": [], "to": [], "drive_cycles": 2,
                "release_cycles": 3, "stay_cycles": 2, "speed_code": 1, "cab_signalled": false}"#,
        ),
        ("/routes/0/continuing", r#"["back"]"#),
    ],
];

/// The station, with the rules of engineering checked.
pub(super) fn sound(mut fork: Value) -> Value {
    fork["plan"]["rules"] = true.into();
    fork
}

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
    let (all_rules, all_rules_of_line) = (sound(fork.clone()), sound(line.clone()));
    let groups = [(fork, WRONG), (&line, WRONG_LINES), (&all_rules, UNSOUND), (&all_rules_of_line, UNSOUND_LINES)];
    let each = groups.iter().flat_map(|(plan, all)| all.iter().map(|changes| changed(plan, changes)));
    each.chain([long(fork)]).collect()
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
    let names: Vec<String> = (0..31).map(|number| format!("D{number}")).collect();
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
    use super::{UNSOUND, UNSOUND_LINES, changed, sound, with_line, wrong};
    use crate::conform::case::{Case, is_rejected};
    use serde_json::Value;

    fn started(config: Value) -> String {
        let case = Case { machine: "interlocking".to_owned(), config, steps: Vec::new() };
        case.expected().map_or_else(|error| error, |expected| expected.start)
    }

    #[test]
    fn the_station_is_taken_and_each_of_its_wrong_plans_is_not() {
        for plan in [fork(), with_line(fork()), sound(fork()), sound(with_line(fork()))] {
            let reply = started(plan);
            assert!(!is_rejected(&reply), "{reply}");
        }
        // What breaks a rule of engineering alone is taken where those are not checked.
        for (plan, all) in [(fork(), UNSOUND), (with_line(fork()), UNSOUND_LINES)] {
            for changes in all {
                let reply = started(changed(&plan, changes));
                assert!(!is_rejected(&reply), "{reply}");
            }
        }
        for plan in wrong(&fork()) {
            let reply = started(plan);
            assert!(is_rejected(&reply), "{reply}");
        }
    }
}
