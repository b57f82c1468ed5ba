//! Configurations of `wayside`: a halt with a line on each side, of which one may be counted.

use serde_json::{Value, json};

use super::mutate::examples;

/// The example's configuration.
fn example() -> Value {
    examples("wayside").into_iter().next().map(|(_, case)| case.config).unwrap_or_default()
}

/// With these times in cycles.
fn timed(mut config: Value, life: u64, turn: u64, clear: u64, start: u64) -> Value {
    let cycle = config["layout"]["plan"]["cycle_ms"].as_u64().unwrap_or(1);
    config["life_ms"] = (life * cycle).into();
    let plan = &mut config["layout"]["plan"];
    (plan["turn_cycles"], plan["clear_cycles"], plan["start_cycles"]) = (turn.into(), clear.into(), start.into());
    for (name, value) in [("drive_cycles", 2), ("release_cycles", 3), ("stay_cycles", 2)] {
        plan["routes"][0][name] = value.into();
    }
    config
}

/// The line of the trains that leave, counted away from the station, with its low end outside.
fn away(mut config: Value) -> Value {
    config["counted"] = json!({
        "segment": "East", "travel": "away", "direction": "down", "train_m": 200,
        "blocks": [{"circuits": ["E1", "B"], "max_trains": 2, "tail_hold_sections": 1, "pass_ms": 3000}],
    });
    config
}

/// With counted blocks of so many circuits each, from the outermost one, and with so many of them held behind a head.
fn blocks(mut config: Value, sizes: &[usize], hold: u64) -> Value {
    let count: usize = sizes.iter().sum();
    for number in 3..=count {
        let name = format!("W{number}");
        let plan = &mut config["layout"]["plan"];
        for (list, more) in [
            ("/circuits", json!({"name": name, "length_m": 270})),
            ("/segments/0/circuits", name.as_str().into()),
            ("/routes/0/approach", name.as_str().into()),
        ] {
            if let Some(list) = plan.pointer_mut(list).and_then(Value::as_array_mut) {
                list.push(more);
            }
        }
        let side = |section: usize| json!({"section": section, "gradient_permille": 5, "curve_km_h": 75});
        config["signals"]["circuits"][&name] = json!({"left": side(107 + 2 * number), "right": side(206 + 2 * number)});
    }
    let mut names = (1..=count).rev().map(|number| format!("W{number}"));
    let block = |size: &usize| {
        let circuits: Vec<String> = names.by_ref().take(*size).collect();
        json!({"circuits": circuits, "max_trains": size, "tail_hold_sections": hold, "pass_ms": 3000})
    };
    config["counted"]["blocks"] = sizes.iter().map(block).collect();
    config
}

/// With one more route of the station.
fn and_route(mut config: Value, route: Value) -> Value {
    if let Some(routes) = config["layout"]["plan"]["routes"].as_array_mut() {
        routes.push(route);
    }
    config
}

/// A route of this heading from the circuit `entry` over `path`, from no segment and to that one, if any.
fn route(heading: &str, entry: &str, path: &[&str], overlap: &[&str], to: &[&str]) -> Value {
    let at = |circuit: &&str| {
        let points = if *circuit == "A" { json!({"P": "normal"}) } else { json!({}) };
        json!({"circuits": [circuit], "points": points})
    };
    let beyond = if heading == "left" { "W1" } else { "E1" };
    json!({
        "name": "other", "heading": heading, "entry": [entry], "approach": [entry],
        "path": path.iter().map(at).collect::<Vec<_>>(), "overlap": {"circuits": overlap, "points": {}},
        "beyond": [beyond], "continuing": [], "conflicts": [], "from": [], "to": to, "drive_cycles": 4,
        "release_cycles": 40, "stay_cycles": 4, "speed_code": 3, "cab_signalled": true,
    })
}

/// The station with one more circuit, C, of this length.
fn second_way(mut config: Value, length: u64) -> Value {
    if let Some(circuits) = config["layout"]["plan"]["circuits"].as_array_mut() {
        circuits.push(json!({"name": "C", "length_m": length}));
    }
    let side = |section: u32| json!({"section": section, "gradient_permille": 5, "curve_km_h": 75});
    config["signals"]["circuits"]["C"] = json!({"left": side(301), "right": side(300)});
    config
}

/// The same with a route from there to the line in the east.
fn joining(config: Value, length: u64) -> Value {
    and_route(second_way(config, length), route("right", "C", &["B"], &[], &["East"]))
}

/// With the outermost circuit of the line in the west seen by the neighbour too.
fn shared(mut config: Value) -> Value {
    config["layout"]["plan"]["segments"][0]["shared"] = 1.into();
    config
}

/// A line that leads out of the station to the left, which is that of the counted trains for the other direction.
fn out_to_the_west(mut config: Value) -> Value {
    config["layout"]["plan"]["segments"][0]["throat"] = json!(["A"]);
    and_route(config, route("left", "B", &["A"], &[], &["West"]))
}

/// With circuits of these lengths, in the order of the plan.
fn long(mut config: Value, lengths: &[u64]) -> Value {
    for (circuit, length) in config["layout"]["plan"]["circuits"].as_array_mut().into_iter().flatten().zip(lengths) {
        circuit["length_m"] = (*length).into();
    }
    config
}

/// With as many sections held behind a head, in a line of the trains that leave.
fn away_held(config: Value, hold: u64, train_m: u64) -> Value {
    let mut config = away(config);
    config["counted"]["blocks"][0]["tail_hold_sections"] = hold.into();
    config["counted"]["train_m"] = train_m.into();
    config
}

/// Without a counted line.
fn plain(mut config: Value) -> Value {
    config["counted"] = Value::Null;
    config
}

/// With times of a few cycles.
pub(super) fn small() -> Vec<Value> {
    let example = example();
    vec![
        timed(example.clone(), 1, 2, 1, 0),
        timed(example.clone(), 3, 4, 2, 1),
        timed(away(example.clone()), 2, 3, 1, 0),
        timed(plain(example.clone()), 2, 5, 1, 2),
        timed(away_held(example.clone(), 2, 400), 2, 3, 1, 0),
        timed(joining(away_held(example.clone(), 2, 400), 220), 2, 3, 1, 0),
        // A route that ends in the station.
        timed(and_route(second_way(away(example.clone()), 220), route("right", "C", &["A"], &[], &[])), 2, 3, 1, 0),
        timed(shared(example.clone()), 2, 3, 1, 0),
        timed(shared(plain(example.clone())), 2, 3, 1, 0),
        // A route to another line than that of the counted trains.
        timed(plain(out_to_the_west(example.clone())), 2, 3, 1, 0),
        timed(out_to_the_west(away(example.clone())), 2, 3, 1, 0),
        timed(long(plain(example.clone()), &[60_000, 220, 230, 60_000, 60_000, 260]), 2, 3, 1, 0),
        timed(blocks(example.clone(), &[1, 1, 1], 1), 2, 3, 1, 0),
        timed(blocks(example.clone(), &[1, 1, 1, 1], 2), 2, 3, 1, 0),
        timed(blocks(example.clone(), &[2, 1, 3], 1), 1, 2, 1, 0),
        timed(blocks(example.clone(), &[1, 2, 1, 1, 2], 3), 2, 4, 2, 1),
    ]
}

/// As the example has it.
pub(super) fn large() -> Vec<Value> {
    let example = example();
    vec![example.clone(), away(example.clone()), plain(example)]
}

/// Each breaks one rule.
pub(super) fn wrong() -> Vec<Value> {
    let change = |change: fn(&mut Value)| {
        let mut config = example();
        change(&mut config);
        config
    };
    vec![
        change(|config| config["life_ms"] = 0.into()),
        change(|config| config["life_ms"] = 5000.into()),
        change(|config| config["counted"]["direction"] = "down".into()),
        change(|config| config["counted"]["travel"] = "away".into()),
        change(|config| config["counted"]["train_m"] = 221.into()),
        change(|config| config["counted"]["blocks"][1]["circuits"] = json!(["W2"])),
        change(|config| config["counted"]["blocks"][1]["circuits"] = json!(["E1"])),
        change(|config| config["counted"]["blocks"][1]["tail_hold_sections"] = 2.into()),
        change(|config| config["counted"]["blocks"] = json!([])),
        change(|config| config["signals"]["speeds_km_h"] = json!([0, 15, 25, 75])),
        change(|config| config["signals"]["codes"]["pairs"][3]["speed_km_h"] = 74.into()),
        change(|config| config["signals"]["circuits"]["B"]["left"]["section"] = 206.into()),
        change(|config| config["signals"]["circuits"]["B"]["left"]["section"] = 101.into()),
        change(|config| config["signals"]["circuits"]["B"]["left"]["section"] = 202.into()),
        change(|config| config["signals"]["circuits"]["B"]["right"]["section"] = 103.into()),
        change(|config| config["signals"]["circuits"]["B"]["right"]["section"] = 200.into()),
        change(|config| config["signals"]["speeds_km_h"] = json!([5, 15, 25, 45, 75])),
        change(|config| config["signals"]["speeds_km_h"] = json!([0, 25, 25, 45, 75])),
        change(|config| config["layout"]["plan"]["residual_cycles"] = 2.into()),
        change(|config| config["layout"]["plan"]["braking_m"] = json!([0, 100, 300, 700, 900])),
        against(),
        out_to_the_west(example()),
        // A route over circuits of the counted line, and one whose overlap is there.
        and_route(away(example()), route("right", "W1", &["A", "B"], &[], &[])),
        and_route(away(example()), route("right", "W1", &["A"], &["B"], &[])),
        // The shortest of two ways before the entry counts.
        joining(away_held(example(), 1, 215), 300),
        joining(away_held(example(), 1, 205), 200),
        change(|config| config["signals"]["code_speeds_km_h"] = json!([25, 45, 25])),
        change(|config| config["layout"]["plan"]["speeds_km_h"] = json!([25, 25, 45, 75])),
        change(|config| {
            config["signals"]["circuits"].as_object_mut().map(|circuits| circuits.remove("A"));
        }),
        change(|config| {
            config["signals"]["circuits"].as_object_mut().map(|circuits| circuits.remove("E2"));
        }),
        away_to_the_end(),
        away_with(211),
    ]
}

/// A counted line of trains of this length, whose hold at the entry is one circuit of 210 m.
fn away_with(train_m: u64) -> Value {
    let mut config = away(example());
    config["counted"]["train_m"] = train_m.into();
    config
}

/// A counted line against which the route leads.
fn against() -> Value {
    let mut config = away(example());
    config["counted"]["travel"] = "toward".into();
    config["counted"]["direction"] = "up".into();
    config
}

/// A counted line beyond whose exit the layout has nothing.
fn away_to_the_end() -> Value {
    let mut config = away(example());
    config["counted"]["blocks"][0]["circuits"] = json!(["E2", "E1"]);
    config
}
