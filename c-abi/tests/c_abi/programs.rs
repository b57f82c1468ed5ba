//! The examples in C: compiled, linked with the static library, run, and held against what the oracle says of the
//! same steps;
//! and run under valgrind.

use std::ffi::OsString;
use std::fmt::Write as _;

use atc_protocol::Session;
use serde_json::{Value, json};

use crate::tools::{self, Scratch};

/// What `std` in the static library needs of the system.
const SYSTEM: [&str; 4] = ["-lgcc_s", "-lpthread", "-ldl", "-lm"];

/// A case of the oracle.
struct Oracle(Session);

impl Oracle {
    fn start(machine: &str, config: &Value) -> Self {
        let mut oracle = Self(Session::new());
        oracle.say(&json!({"start": {"protocol": 1, "machine": machine, "config": config}}), "started");
        oracle
    }

    fn step(&mut self, step: &Value) -> Value {
        self.say(&json!({ "step": step }), "output")
    }

    fn say(&mut self, request: &Value, expected: &str) -> Value {
        let mut reply = Vec::new();
        self.0.answer(request.to_string().as_bytes(), &mut reply);
        let mut reply: Value = serde_json::from_slice(&reply).expect("the oracle writes JSON");
        assert!(reply.get(expected).is_some(), "{request}: {reply}");
        reply[expected].take()
    }
}

/// What a program prints; none if there is no compiler. It is run under valgrind as well, where there is one.
fn printed(name: &str) -> Option<String> {
    let scratch = Scratch::new();
    let source = format!("{}/examples/{name}.c", env!("CARGO_MANIFEST_DIR"));
    let program = OsString::from(scratch.path(name));
    let strict = ["-std=c99", "-Wall", "-Wextra", "-Wpedantic", "-Werror", "-O1", "-g"].map(OsString::from);
    let files = [tools::include(), source.into(), tools::library().into(), "-o".into(), program.clone()];
    let options = strict.into_iter().chain(files).chain(SYSTEM.map(OsString::from));
    let Some(compiled) = tools::run("gcc", options) else {
        eprintln!("NOT RUN: no gcc here: nothing is known of the examples in C");
        return None;
    };
    assert!(compiled.status.success(), "{name}: {}", String::from_utf8_lossy(&compiled.stderr));
    let ran = tools::run(&program.to_string_lossy(), []).expect("the program was made");
    let text = String::from_utf8_lossy(&ran.stdout).into_owned();
    assert!(ran.status.success() && ran.stderr.is_empty(), "{name}: {}", String::from_utf8_lossy(&ran.stderr));
    let watched = ["--error-exitcode=9", "--leak-check=full", "--quiet"].map(OsString::from);
    match tools::run("valgrind", watched.into_iter().chain([program])) {
        None => eprintln!("NOT RUN: no valgrind here: nothing is known of what {name} does to memory"),
        Some(ran) => {
            assert!(ran.status.success(), "{name}: {}", String::from_utf8_lossy(&ran.stderr));
            assert_eq!(String::from_utf8_lossy(&ran.stdout), text, "{name} under valgrind");
        }
    }
    Some(text)
}

#[test]
fn aspect() {
    let Some(printed) = printed("aspect") else { return };
    let mut aspect = Oracle::start("aspect-acceptance", &json!({"aspects_km_h": [25, 45, 65, 90]}));
    let mut supervision = Oracle::start("speed-supervision", &json!({}));
    let (mut said, mut before) = (String::new(), (Value::Null, Value::Null));
    for cycle in 1..=200 {
        let heard = if cycle <= 100 { json!([45, 90]) } else { json!([]) };
        let display = aspect.step(&json!({ "detected_km_h": heard }))["display_km_h"].take();
        let brake = supervision.step(&json!({"speed_km_h": 50, "permitted_km_h": display}))["brake"].take();
        let word = brake.as_str().expect("a brake is a word");
        if cycle == 1 || (&display, &brake) != (&before.0, &before.1) {
            match display.as_f64() {
                Some(speed) => writeln!(said, "cycle {cycle}: {speed:.1} km/h, {word}"),
                None => writeln!(said, "cycle {cycle}: no display, {word}"),
            }
            .expect("a text takes it");
        }
        before = (display, brake);
    }
    assert_eq!(printed, said);
}

#[test]
fn train() {
    let Some(printed) = printed("train") else { return };
    let pair = |main: f64, sub: f64, speed: u16| json!({"main_hz": main, "sub_hz": sub, "speed_km_h": speed});
    let config = json!({
        "permitted": {
            "cycle_ms": 10, "fresh_ms": 2200, "life_ms": 5000, "fixed_life_ms": 10_000, "memory_ms": 2000,
            "speeds_km_h": [0, 45, 90], "brake_mm_s2": 800, "margin_m": 10, "lowest_limit_km_h": 45,
            "worst_gradient_permille": -35, "window": 3, "run": 1,
        },
        "acceptance": {
            "operate_ms": 300, "recovery_ms": 400, "mask_ms": 400, "interruption_ms": 800, "shortened_operate_ms": 100,
        },
        "codes": {"tolerance_hz": 0.5, "pairs": [pair(22.0, 31.5, 0), pair(26.0, 36.0, 45), pair(29.0, 39.0, 90)]},
        "supervision": {"maximum_km_h": 400, "release_margin_km_h": 0},
    });
    let mut train = Oracle::start("train", &config);
    let (mut said, mut before) = (String::new(), (Value::Null, Value::Null));
    for cycle in 1..=200 {
        let mut step = json!({"speed_km_h": 50, "facing": "right"});
        if cycle == 1 {
            step["line"] = json!("analog");
        }
        if cycle <= 100 {
            step["main"] = json!({"code_hz": 26.1});
            step["sub"] = json!({"code_hz": 35.9});
        }
        let mut output = train.step(&step);
        let (display, brake) = (output["display_km_h"].take(), output["brake"].take());
        let word = brake.as_str().expect("a brake is a word");
        if cycle == 1 || (&display, &brake) != (&before.0, &before.1) {
            match output["permitted_km_h"].as_f64() {
                Some(speed) => writeln!(said, "cycle {cycle}: {speed:.1} km/h permitted, {word}"),
                None => writeln!(said, "cycle {cycle}: nothing permitted, {word}"),
            }
            .expect("a text takes it");
        }
        before = (display, brake);
    }
    assert_eq!(printed, said);
    assert!(said.lines().count() >= 3 && said.contains("45.0 km/h permitted, service"), "{said}");
}

#[test]
fn block() {
    let Some(printed) = printed("block") else { return };
    let mut block = Oracle::start("block-count", &json!({"sections": 3, "max_trains": 3, "tail_hold_sections": 1}));
    let cycles: [(bool, bool, bool, &[u8]); 10] = [
        (false, false, false, &[]),
        (false, false, true, &[]),
        (true, false, false, &[]),
        (true, false, false, &[0]),
        (false, false, false, &[0]),
        (false, false, false, &[1]),
        (false, false, false, &[2]),
        (false, true, false, &[2]),
        (false, true, false, &[]),
        (false, false, false, &[]),
    ];
    let mut said = String::new();
    for (number, (check_in, check_out, reset, present)) in (1..).zip(cycles) {
        let reset = reset.then_some(0);
        let step = json!({"check_in": check_in, "check_out": check_out, "present": present, "reset": reset});
        let output = block.step(&step);
        let occupied = output["occupied"].as_array().expect("a list").iter();
        let occupied = occupied.fold(String::new(), |list, section| format!("{list} {section}"));
        let counting = if output["counting"] == true { "" } else { ", not counting" };
        let (count, behind) = (&output["count"], &output["behind_hold_sections"]);
        writeln!(said, "cycle {number}: occupied{occupied}; trains {count}, behind {behind}{counting}")
            .expect("a text takes it");
    }
    assert_eq!(printed, said);
}

#[test]
fn telegram() {
    let Some(printed) = printed("telegram") else { return };
    let mut codec = Oracle::start("telegram-codec", &json!({}));
    let mut permitted = Oracle::start("permitted-speed", &json!({}));
    let mut said = String::new();
    for number in 1..=4 {
        let telegram = json!({"main": {"section": 7, "counter": number, "beyond_exit_m": 400, "speed_rank": 4}});
        let frame = codec.step(&json!({ "encode": telegram }))["frame"].take();
        let mut bits = frame.as_str().expect("a text").to_owned().into_bytes();
        if number == 3 {
            bits[40] ^= 1;
        }
        let mut output = Value::Null;
        for bit in bits {
            let found = codec.step(&json!({"bits": char::from(bit).to_string()}))["telegrams"].take();
            let main = found.get(0).map(|found| found["telegram"]["main"].clone());
            output = permitted.step(&json!({"analog_km_h": 45, "main": main, "moved_m": 0.05}));
        }
        let speed = output["speed_km_h"].as_f64().expect("a code is heard");
        let words = ["nothing", "analog", "pattern", "both", "running-down"];
        let basis = words.iter().position(|word| output["basis"] == *word).expect("one of these");
        writeln!(said, "telegram {number}: {speed:.1} km/h, basis {basis}").expect("a text takes it");
    }
    assert_eq!(printed, said);
}

/// Whether the request was accepted, the phase of a route by its number in C, and how many signals show proceed.
fn of_route(output: &Value, route: &str) -> (u8, usize, usize) {
    let words = ["idle", "provisional", "failed", "set", "in-use", "releasing"];
    let phase = output["routes"].get(route).unwrap_or(&json!("idle")).clone();
    let phase = words.iter().position(|word| phase == *word).expect("one of these");
    (u8::from(output["answer"] == "accepted"), phase, output["proceed"].as_array().expect("a list").len())
}

#[test]
fn interlocking() {
    let Some(printed) = printed("interlocking") else { return };
    let circuits = ["0", "1", "2", "3"].map(|name| json!({"name": name, "length_m": 200}));
    let plan = json!({"plan": {
        "station": "Example", "cycle_ms": 100, "clear_cycles": 2, "turn_cycles": 1,
        "speeds_km_h": [0, 45, 90], "braking_m": [0, 100, 250], "circuits": circuits,
        "points": [{"name": "P", "detectors": ["1"]}], "segments": [],
        "routes": [{
            "name": "R", "heading": "right", "entry": ["0"], "approach": ["0"],
            "path": [{"circuits": ["1"], "points": {"P": "normal"}}, {"circuits": ["2"], "points": {}}],
            "overlap": {"circuits": [], "points": {}}, "beyond": ["3"], "continuing": [], "conflicts": [],
            "from": [], "to": [], "drive_cycles": 20, "release_cycles": 30, "stay_cycles": 10, "speed_code": 2,
        }],
    }});
    let mut device = Oracle::start("interlocking", &plan);
    let occupied = [1, 1, 1, 1, 1, 1, 1, 3, 3, 2, 6, 4, 4, 12, 8, 8, 8, 0, 0];
    let all = json!(["0", "1", "2", "3"]);
    let mut said = String::new();
    for (number, occupied) in (0..).zip(occupied) {
        let there: Vec<_> = (0..4).filter(|circuit| occupied >> circuit & 1 == 1).map(|one| one.to_string()).collect();
        let side = if number >= 5 { "normal" } else { "reverse" };
        let mut step = json!({"occupied": there, "detected": {"P": side}, "all_telegrams": true});
        if number == 0 {
            step["orders"] = json!({"unblock": all, "lift": all});
        }
        if number == 3 {
            step["request"] = json!({"set": "R"});
        }
        let output = device.step(&step);
        let (answer, phase, proceed) = of_route(&output, "R");
        let drives = u8::from(output["drives"].get("P") == Some(&json!("normal")));
        let telegram = &output["telegrams"]["0"];
        let code = [0, 45, 90].iter().position(|speed| telegram["speed_km_h"] == *speed).expect("one of these");
        let stop = telegram["stop"].as_str().expect("a name");
        let cycle = number + 1;
        writeln!(
            said,
            "cycle {cycle}: answer {answer}, phase {phase}, proceed {proceed}, drives {drives}, \
             from 0 to {stop} at code {code}"
        )
        .expect("a text takes it");
    }
    assert_eq!(printed, said);
}

#[test]
fn large_station() {
    let Some(printed) = printed("large_station") else { return };
    let circuits: Vec<_> = (0..100).map(|number| json!({"name": number.to_string(), "length_m": 200})).collect();
    let route = |number: usize| {
        let at = |number: usize| [number.to_string()];
        json!({
            "name": number.to_string(), "heading": "right", "entry": at(number), "approach": at(number),
            "path": [{"circuits": at(number + 1), "points": {}}], "overlap": {"circuits": [], "points": {}},
            "beyond": at(number + 2), "continuing": [], "conflicts": [], "from": [], "to": [],
            "drive_cycles": 20, "release_cycles": 30, "stay_cycles": 10, "speed_code": 1,
        })
    };
    let plan = json!({"plan": {
        "station": "Row", "cycle_ms": 100, "clear_cycles": 2, "turn_cycles": 1, "speeds_km_h": [0, 45],
        "braking_m": [0, 100], "circuits": circuits, "points": [], "segments": [],
        "routes": (0..98).map(route).collect::<Vec<_>>(),
    }});
    let mut device = Oracle::start("interlocking", &plan);
    let all: Vec<_> = (0..100).map(|number| number.to_string()).collect();
    let mut said = String::new();
    for cycle in 1..=8 {
        let there = if cycle > 6 { json!(["80", "81"]) } else { json!(["80"]) };
        let mut step = json!({"occupied": there, "detected": {}, "all_telegrams": true});
        if cycle == 1 {
            step["orders"] = json!({"unblock": all, "lift": all});
        }
        if cycle == 4 {
            step["request"] = json!({"set": "80"});
        }
        let output = device.step(&step);
        let (answer, phase, proceed) = of_route(&output, "80");
        let telegram = &output["telegrams"]["80"];
        let code = [0, 45].iter().position(|speed| telegram["speed_km_h"] == *speed).expect("one of these");
        let stop = telegram["stop"].as_str().expect("a name");
        let line = format!("answer {answer}, phase {phase}, proceed {proceed}, from 80 to {stop} at code {code}");
        writeln!(said, "cycle {cycle}: {line}").expect("a text takes it");
    }
    assert_eq!(printed, said);
    assert!(said.contains("from 80 to 81"), "{said}");
}
