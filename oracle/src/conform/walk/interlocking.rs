//! Walks of `interlocking`: the stations, and the plans in the kernel's own terms, whose times are a few cycles.

use serde_json::{Value, json};

use super::ground::ground;
use super::plan::{Times, layout, with_times};
use super::source::{Source, Walk};
use super::varied::varied;
use super::{rows, wrong_plans};
use crate::conform::random::Random;

pub(super) const SOURCE: Source =
    Source { machine: "interlocking", small, large, wrong, begin, most: (70, 1600), own: 4000 };

const PASSING_LOOP: &str = include_str!("../../../../layouts/passing-loop.toml");
const JUNCTION: &str = include_str!("../../../../layouts/junction.toml");
const TERMINUS: &str = include_str!("../../../../layouts/terminus.toml");
const STATION_30: &str = include_str!("../../../../layouts/station-30.toml");

/// The shortest times that the theorems allow.
const SHORTEST: Times = Times {
    clear: 1,
    turn: 1,
    start: 0,
    settle: 0,
    loss: 0,
    residual: 0,
    standstill: 0,
    drive: 2,
    release: 2,
    stay: 2,
};

/// A station of three circuits in a row and two routes, with one point: where most differences show within a few steps.
pub(super) fn fork() -> Value {
    let circuits = ["W", "A", "B", "C", "E"].map(|name| json!({"name": name, "length_m": 600}));
    let route = |name: &str, side: &str, last: &str, overlap: &[&str]| {
        json!({
            "name": name, "heading": "right", "entry": ["W"], "approach": ["W"],
            "path": [{"circuits": ["A"], "points": {"P": side}}, {"circuits": [last], "points": {}}],
            "overlap": {"circuits": overlap, "points": {}}, "beyond": ["E"], "continuing": [], "conflicts": [],
            "from": [], "to": [], "drive_cycles": 2, "release_cycles": 3, "stay_cycles": 2, "speed_code": 1,
            "cab_signalled": false,
        })
    };
    json!({"plan": {
        "station": "Fork", "cycle_ms": 1000, "clear_cycles": 1, "turn_cycles": 1, "start_cycles": 0,
        "settle_cycles": 0, "loss_cycles": 0, "residual_cycles": 0, "standstill_cycles": 0,
        "speeds_km_h": [0, 45], "braking_m": [0, 300], "circuits": circuits,
        "points": [{"name": "P", "detectors": ["A"]}], "segments": [],
        "routes": [route("to-B", "normal", "B", &["E"]), route("to-C", "reverse", "C", &[])],
    }})
}

fn small() -> Vec<Value> {
    let loop_ = layout(PASSING_LOOP);
    let mut all = vec![
        fork(),
        wrong_plans::with_line(fork()),
        with_times(&loop_, SHORTEST),
        with_times(
            &loop_,
            Times {
                clear: 2,
                turn: 2,
                start: 3,
                settle: 1,
                loss: 1,
                residual: 1,
                standstill: 1,
                drive: 4,
                release: 4,
                stay: 4,
            },
        ),
        with_times(&layout(TERMINUS), Times { clear: 2, settle: 1, start: 1, ..SHORTEST }),
        with_times(&layout(JUNCTION), SHORTEST),
        rows::row(),
        rows::lines(),
    ];
    let rows = [rows::row(), rows::lines(), all[0].clone(), all[1].clone()];
    let varied = [varied(&all, VARIED), varied(&rows, VARIED)].concat();
    all.extend(varied);
    all
}

/// How many stations have other values than the layouts.
const VARIED: u64 = 40;

fn large() -> Vec<Value> {
    [PASSING_LOOP, JUNCTION, TERMINUS, STATION_30].map(layout).to_vec()
}

fn wrong() -> Vec<Value> {
    wrong_plans::wrong(&fork())
}

fn begin(config: &Value, _: &Value, random: &mut Random) -> Box<dyn Walk> {
    Box::new(ground(config, random))
}
