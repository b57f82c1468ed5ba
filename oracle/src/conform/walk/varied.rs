//! Stations changed at random where engineering has a choice: times, lengths, speeds, overlaps, cab signalling, what is beside a path. Braking distances are those
//! from one circuit of a route to another of it, and one metre more or less.

use serde_json::{Value, json};

use crate::conform::random::Random;
use atc_protocol::machine::Machine as _;
use atc_protocol::machine::interlocking::{Config, Interlocked};

/// The least of them counts as many cycles as the rules ask for.
fn times(plan: &mut Value, random: &mut Random) {
    let loss = random.between(0, 1);
    let (residual, standstill) = (random.between(0, 2), random.between(0, 2));
    for (name, value) in [
        ("loss_cycles", loss),
        ("clear_cycles", random.between(1, 2) + 2 * loss),
        ("settle_cycles", random.between(0, 2)),
        ("start_cycles", random.between(0, 4)),
        ("turn_cycles", random.between(1, 3)),
        ("residual_cycles", residual),
        ("standstill_cycles", standstill),
    ] {
        plan[name] = value.into();
    }
    for route in plan["routes"].as_array_mut().into_iter().flatten() {
        for (name, value) in [
            ("drive_cycles", random.between(1, 4)),
            ("release_cycles", residual + loss + random.between(1, 3)),
            ("stay_cycles", standstill + loss + random.between(1, 3)),
        ] {
            route[name] = value.into();
        }
    }
}

/// The length of the circuit of that name.
fn length(plan: &Value, name: &Value) -> i64 {
    let circuits = plan["circuits"].as_array().into_iter().flatten();
    circuits.filter(|circuit| circuit["name"] == *name).filter_map(|circuit| circuit["length_m"].as_i64()).sum()
}

/// Distances along a route, from somewhere in it to somewhere ahead.
fn distances(plan: &Value, random: &mut Random) -> Vec<i64> {
    let mut all = Vec::new();
    for route in plan["routes"].as_array().into_iter().flatten() {
        let path = route["path"].as_array().into_iter().flatten().filter_map(|at| at["circuits"].as_array()).flatten();
        let lengths: Vec<i64> = path.map(|circuit| length(plan, circuit)).collect();
        for from in 0..lengths.len() {
            for to in from..lengths.len() {
                all.push(lengths[from..=to].iter().sum::<i64>() + random.one_of(&[0, 0, 1, -1]));
            }
        }
    }
    all
}

fn speeds(plan: &mut Value, random: &mut Random) {
    let all = distances(plan, random);
    let codes = random.between(1, 4);
    let mut braking: Vec<i64> =
        (0..codes).filter_map(|_| random.pick(&all).copied()).filter(|metres| *metres > 0).collect();
    braking.sort_unstable();
    braking.dedup();
    let most = i64::try_from(braking.len()).unwrap_or(1);
    if let Some(last) = braking.last_mut().filter(|_| random.one_in(6)) {
        // A code that is not in the table.
        *last = 65_535;
    }
    braking.insert(0, 0);
    plan["speeds_km_h"] = json!([0, 15, 25, 45, 75][..braking.len()]);
    plan["braking_m"] = json!(braking);
    for route in plan["routes"].as_array_mut().into_iter().flatten() {
        route["speed_code"] = random.between(1, most).into();
        if random.one_in(2) {
            route["overlap_speed_code"] = random.between(0, most).into();
        }
    }
}

/// What a route holds behind its end, and whether its trains look at its signal.
fn ends(plan: &mut Value, random: &mut Random) {
    let detectors: Vec<(Value, Value)> = plan["points"]
        .as_array()
        .into_iter()
        .flatten()
        .map(|point| (point["name"].clone(), point["detectors"].clone()))
        .collect();
    for route in plan["routes"].as_array_mut().into_iter().flatten() {
        if random.one_in(3) {
            route["cab_signalled"] = random.one_in(2).into();
        }
        let beyond = route["beyond"].as_array().cloned().unwrap_or_default();
        let to_line = route["to"].as_array().is_some_and(|to| !to.is_empty());
        if let Some(circuit) = random.pick(&beyond).filter(|_| !to_line && random.one_in(2)).cloned() {
            let mut points = serde_json::Map::new();
            for (name, at) in &detectors {
                if at.as_array().is_some_and(|at| at.contains(&circuit)) {
                    let side = if random.one_in(2) { "normal" } else { "reverse" };
                    points.insert(name.as_str().unwrap_or_default().to_owned(), side.into());
                }
            }
            route["overlap"] = json!({"circuits": [circuit], "points": points});
        }
    }
}

/// Two routes that exclude each other for a reason that the circuits do not show.
fn conflict(plan: &mut Value, random: &mut Random) {
    let Some(routes) = plan["routes"].as_array_mut() else { return };
    let pair = [random.below(routes.len()), random.below(routes.len())];
    for (one, other) in [(pair[0], pair[1]), (pair[1], pair[0])] {
        let name = routes[other]["name"].clone();
        if let Some(conflicts) =
            routes[one]["conflicts"].as_array_mut().filter(|all| one != other && !all.contains(&name))
        {
            conflicts.push(name);
        }
    }
}

/// The circuits of a place, or of an overlap.
fn circuits(at: &Value) -> impl Iterator<Item = &Value> {
    at["circuits"].as_array().into_iter().flatten()
}

/// Circuits of other routes beside those of some, as where a joint is too near to a point.
fn beside(plan: &mut Value, random: &mut Random) {
    let places = |route: &Value| -> Vec<Value> {
        let path = route["path"].as_array().into_iter().flatten();
        path.chain([&route["overlap"]]).flat_map(circuits).cloned().collect()
    };
    let all: Vec<Value> = plan["routes"].as_array().into_iter().flatten().flat_map(places).collect();
    for route in plan["routes"].as_array_mut().into_iter().flatten() {
        if random.one_in(2) {
            continue;
        }
        let mut own = places(route);
        own.extend(route["entry"].as_array().cloned().unwrap_or_default());
        let others: Vec<&Value> = all.iter().filter(|circuit| !own.contains(circuit)).collect();
        let Some(circuit) = random.pick(&others).map(|circuit| (*circuit).clone()) else { continue };
        let length = route["path"].as_array().map_or(0, Vec::len);
        let place = random.below(length + 1);
        let at = if place < length { &mut route["path"][place] } else { &mut route["overlap"] };
        at["beside"] = json!([circuit]);
    }
}

/// So many stations, each one of these with other values. The same for the same number.
pub(super) fn varied(stations: &[Value], count: u64) -> Vec<Value> {
    let one = |number: u64| {
        let mut random = Random::of(number, "varied", 0);
        // What breaks a rule is drawn once more.
        (0..50).find_map(|_| {
            let mut config = random.pick(stations)?.clone();
            let plan = &mut config["plan"];
            for circuit in plan["circuits"].as_array_mut().into_iter().flatten() {
                if random.one_in(2) {
                    circuit["length_m"] = random.one_of(&[50, 100, 200, 300, 600, 40_000]).into();
                }
                if random.one_in(4) {
                    circuit["speed_code"] = random.between(0, 4).into();
                }
            }
            times(plan, &mut random);
            speeds(plan, &mut random);
            ends(plan, &mut random);
            if random.one_in(2) {
                conflict(plan, &mut random);
            }
            if random.one_in(3) {
                beside(plan, &mut random);
            }
            is_taken(&config).then_some(config)
        })
    };
    (0..count).filter_map(one).collect()
}

/// Whether the kernel takes the station.
fn is_taken(config: &Value) -> bool {
    let config = serde_json::from_value::<Config>(config.clone());
    config.is_ok_and(|config| <Interlocked>::open(&config).is_ok())
}
