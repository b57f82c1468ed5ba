//! Stations that no engineer would build, in a few circuits: routes of one circuit with an overlap, routes within others, two that begin in one
//! place or meet head-on, points in an overlap, two lines behind one throat. What the rules of engineering forbid is possible here.

use serde_json::{Value, json};

/// A route: name, heading, approach (its last circuit is the entry), path, overlap, what adjoins its end, and the line that it leads to.
struct Route(
    &'static str,
    &'static str,
    &'static [&'static str],
    &'static [&'static str],
    &'static [&'static str],
    &'static [&'static str],
    &'static [&'static str],
);

/// Circuits, some with the side on which their point must lie: `A+` is the circuit A with its point normal, `A-` reversed.
fn element(circuits: &[&str]) -> Value {
    let mut points = serde_json::Map::new();
    let mut names = Vec::new();
    for circuit in circuits {
        let name = circuit.trim_end_matches(['+', '-']);
        if name != *circuit {
            let side = if circuit.ends_with('+') { "normal" } else { "reverse" };
            points.insert(format!("P{name}"), side.into());
        }
        names.push(name);
    }
    json!({"circuits": names, "points": points})
}

fn station(circuits: &[&str], points: &[&str], segments: &Value, routes: &[Route]) -> Value {
    let circuits: Vec<_> = circuits.iter().map(|name| json!({"name": name, "length_m": 200})).collect();
    let points: Vec<_> = points.iter().map(|at| json!({"name": format!("P{at}"), "detectors": [at]})).collect();
    let route = |Route(name, heading, approach, path, overlap, beyond, to): &Route| {
        let from_here = |other: &&Route| {
            other.1 == *heading && other.2.last().copied() == path.last().map(|last| last.trim_end_matches(['+', '-']))
        };
        let continuing: Vec<_> = routes.iter().filter(from_here).map(|other| other.0).collect();
        json!({
            "name": name, "heading": heading, "entry": approach.last().map(|entry| vec![*entry]).unwrap_or_default(),
            "approach": approach, "path": path.iter().map(|at| element(&[at])).collect::<Vec<_>>(),
            "overlap": element(overlap), "beyond": beyond, "continuing": continuing, "conflicts": [], "from": [], "to": to,
            "drive_cycles": 2, "release_cycles": 3, "stay_cycles": 2, "speed_code": 1, "cab_signalled": false,
        })
    };
    json!({"plan": {
        "station": "Row", "cycle_ms": 1000, "clear_cycles": 1, "turn_cycles": 1, "speeds_km_h": [0, 45],
        "braking_m": [0, 200], "circuits": circuits, "points": points, "segments": segments,
        "routes": routes.iter().map(route).collect::<Vec<_>>(),
    }})
}

/// A row of circuits with a point in A.
pub(super) fn row() -> Value {
    station(
        &["V", "W", "A", "B", "C", "D", "E", "F"],
        &["A"],
        &json!([]),
        &[
            Route("W-A", "right", &["V", "W"], &["A+"], &["B"], &["B"], &[]),
            Route("A-B", "right", &["W", "A"], &["B"], &["E"], &["E"], &[]),
            Route("W-E", "right", &["V", "W"], &["A+", "B", "E"], &["F"], &["F"], &[]),
            Route("W-C", "right", &["V", "W"], &["A-", "C"], &[], &["D"], &[]),
            Route("W-D", "right", &["V", "W"], &["D"], &[], &["F"], &[]),
            Route("E-B", "left", &["F", "E"], &["B"], &["A+"], &["A"], &[]),
            Route("B-A", "left", &["E", "B"], &["A+"], &["W"], &["W"], &[]),
            Route("C-D", "left", &["C"], &["D"], &[], &["F"], &[]),
        ],
    )
}

/// A row of circuits behind which two lines begin, and one before it.
pub(super) fn lines() -> Value {
    let line = |name: &str, circuits: &[&str], throat: &[&str], outward: &str, shared: u32| json!({"name": name, "circuits": circuits, "throat": throat, "outward": outward, "shared": shared});
    let segments = [
        line("S", &["S1", "S2", "S3"], &["B"], "right", 1),
        line("T", &["T1", "T2"], &["B"], "right", 0),
        line("U", &["U1", "U2"], &["A"], "left", 1),
    ];
    let mut config = station(
        &["A", "B", "C", "S1", "S2", "S3", "T1", "T2", "U1", "U2"],
        &["A", "B"],
        &json!(segments),
        &[
            Route("U-S", "right", &["U2", "U1"], &["A+", "B+"], &[], &["S1"], &["S"]),
            Route("U-T", "right", &["U2", "U1"], &["A+", "B-"], &[], &["T1"], &["T"]),
            Route("U-C", "right", &["U2", "U1"], &["A-", "C"], &[], &["S1"], &[]),
            Route("C-S", "right", &["A", "C"], &["B+"], &[], &["S1"], &["S"]),
            Route("S-C", "left", &["S2", "S1"], &["B+", "C"], &["A-"], &["A"], &[]),
            Route("S-U", "left", &["S2", "S1"], &["B+", "A+"], &[], &["U1"], &["U"]),
            Route("T-U", "left", &["T2", "T1"], &["B-", "A+"], &[], &["U1"], &["U"]),
        ],
    );
    for (route, from) in [(0, "U"), (1, "U"), (2, "U"), (4, "S"), (5, "S"), (6, "T")] {
        config["plan"]["routes"][route]["from"] = json!([from]);
    }
    config
}
