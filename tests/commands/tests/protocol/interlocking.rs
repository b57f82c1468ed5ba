//! Machine `interlocking` of protocol 1: a session word by word, every way to be wrong with the reason that is given, the replies of
//! other implementations, and the chart.

use std::sync::LazyLock;

use atc_oracle::chart::{self, View};
use atc_oracle::trace::{Replies, Trace};
use atc_protocol::machine::Machine as _;
use atc_protocol::machine::interlocking::{Config, Output, Sizes};
use atc_tests::drawing::{self, titles};
use atc_tests::session::{self, assert_malformed, converse, replies, step};
use atc_tests::{device, session::start};
use jsonschema::Validator;
use serde_json::{Value, json};

const EXAMPLE: &str = include_str!("../../../../oracle/examples/interlocking.jsonl");

/// ```text
///   L ═ W │ A ──<─ B │ ═ E ┤    point P in A: normal to B, reverse to C, which ends
///               \─ C ┤
/// ```
fn layout() -> Value {
    let circuit =
        |name: &str, left: &str, right: &str| json!({"name": name, "length_m": 600, "left": left, "right": right});
    json!({
        "name": "Fork",
        "times": {
            "cycle_ms": 1000, "clear_ms": 2000, "drive_ms": 8000, "settle_ms": 0,
            "start_ms": 0, "start_protected": "no train has run before",
        },
        "speed": {"line_kmh": 45},
        "circuit": [
            circuit("L", "k", "l"), circuit("W", "l", "m"), {"name": "A", "length_m": 100},
            circuit("B", "n", "o"), circuit("C", "p", "q"), circuit("E", "o", "r"),
        ],
        "point": [{
            "name": "P", "circuit": "A", "toe": "m", "normal": "n", "reverse": "p",
            "normal_unprotected": "trains stop at B", "reverse_unprotected": "nothing is parked in C",
        }],
        "end": [{"joint": "k", "kind": "line"}, {"joint": "q", "kind": "buffer"}, {"joint": "r", "kind": "buffer"}],
        "segment": [{"name": "West", "circuits": ["W", "L"]}],
        "route": [
            {"name": "in", "entry": "W", "path": ["A", "B"], "overlap": ["E"]},
            {"name": "side", "entry": "W", "path": ["A", "C"], "short_overlap": "the buffer stop yields", "beyond": ["A"]},
            {"name": "out", "entry": "B", "path": ["A"]},
        ],
    })
}

fn begin() -> String {
    start("interlocking", &layout().to_string())
}

/// A step with the point in normal position and what else is said.
fn quiet(more: &str) -> String {
    let comma = if more.is_empty() { "" } else { "," };
    step(&format!(r#"{{"occupied":[],"detected":{{"P":"normal"}}{comma}{more}}}"#))
}

const ALL: &str = r#"["L","W","A","B","C","E"]"#;

/// The station in service: two cycles until all is clear.
fn service() -> [String; 2] {
    [quiet(&format!(r#""orders":{{"unblock":{ALL},"lift":{ALL}}}"#)), quiet("")]
}

fn output(reply: &str) -> Value {
    let reply: Value = serde_json::from_str(reply).expect(reply);
    assert!(reply["output"].is_object(), "{reply}");
    reply["output"].clone()
}

/// The replies to these steps of a station in service.
fn in_service(steps: &[String]) -> Vec<String> {
    let (begin, service) = (begin(), service());
    let lines: Vec<&str> = [&begin, &service[0], &service[1]].into_iter().chain(steps).map(String::as_str).collect();
    let said = converse(&lines);
    assert!(said[0].starts_with("{\"started\""), "{}", said[0]);
    said[3..].to_vec()
}

#[test]
fn a_session() {
    let waiting = r#"{"occupied":["W"],"detected":{"P":"normal"}"#;
    let said = in_service(&[
        quiet(r#""request":{"turn":"West","to":"toward"}"#),
        step(&format!("{waiting},\"request\":{{\"set\":\"in\"}}}}")),
        step(r#"{"occupied":["W"],"detected":{"P":null},"all_telegrams":true}"#),
        step(&format!("{waiting},\"orders\":{{\"restrict\":{{\"B\":26}},\"block\":[\"C\"]}}}}")),
        step(&format!("{waiting},\"request\":{{\"set\":\"side\"}},\"consent\":[\"West\"]}}")),
        step(&format!("{waiting},\"request\":{{\"withdraw\":\"in\"}}}}")),
    ]);
    let none = r#""drives":{},"telegrams":{},"permits":["West"],"confirmed":[]"#;
    let open = |speed: u16| {
        format!(
            r#""drives":{{}},"telegrams":{{"W":{{"stop":"B","speed_km_h":{speed},"open":true,"heading":"right"}}}},"permits":["West"]"#
        )
    };
    let stop =
        |circuit: &str| format!(r#""{circuit}":{{"stop":"{circuit}","speed_km_h":0,"open":false,"heading":null}}"#);
    let stops = ["A", "B", "C", "E", "L", "W"].map(stop).join(",");
    let expected = [
        format!(r#"{{"output":{{"routes":{{}},"proceed":[],{none},"answer":"accepted"}}}}"#),
        format!(
            r#"{{"output":{{"routes":{{"in":"set"}},"proceed":["in"],{},"confirmed":[],"answer":"accepted"}}}}"#,
            open(45)
        ),
        format!(
            r#"{{"output":{{"routes":{{"in":"set"}},"proceed":[],"drives":{{}},"telegrams":{{{stops}}},"permits":["West"],"confirmed":[],"answer":null}}}}"#
        ),
        format!(
            r#"{{"output":{{"routes":{{"in":"set"}},"proceed":["in"],{},"confirmed":["C"],"answer":null}}}}"#,
            open(25)
        ),
        format!(
            r#"{{"output":{{"routes":{{"in":"set"}},"proceed":["in"],{},"confirmed":["C"],"answer":{{"refused":"path-held","because":["in"]}}}}}}"#,
            open(25)
        ),
        r#"{"output":{"routes":{"in":"releasing"},"proceed":[],"drives":{},"telegrams":{},"permits":["West"],"confirmed":["C"],"answer":"accepted"}}"#.to_owned(),
    ];
    assert_eq!(said, expected);
}

/// Each reason with the names that go with it.
#[test]
fn refusals_and_what_is_in_the_way() {
    let toward = quiet(r#""request":{"turn":"West","to":"toward"}"#);
    let ask = |before: &[&str], asked: &str| {
        let steps: Vec<String> =
            [toward.as_str()].into_iter().chain(before.iter().copied()).chain([asked]).map(str::to_owned).collect();
        let said = in_service(&steps);
        output(said.last().expect("an answer"))["answer"].clone()
    };
    let set = |route: &str| quiet(&format!(r#""request":{{"set":"{route}"}}"#));
    let refused = |reason: &str, because: &[&str]| json!({"refused": reason, "because": because});
    assert_eq!(ask(&[&set("in")], &set("in")), refused("already-held", &["in"]));
    assert_eq!(ask(&[], &quiet(r#""request":{"withdraw":"in"}"#)), refused("not-held", &["in"]));
    assert_eq!(ask(&[&set("in")], &set("out")), refused("path-held", &["in"]));
    assert_eq!(
        ask(&[&set("in")], &quiet(r#""request":{"drive":"P","to":"reverse"}"#)),
        refused("point-locked", &["in"])
    );
    let at = |circuits: &str, more: &str| {
        step(&format!(r#"{{"occupied":[{circuits}],"detected":{{"P":"normal"}},{more}}}"#))
    };
    assert_eq!(ask(&[], &at(r#""E","B""#, r#""request":{"set":"in"}"#)), refused("occupied", &["B", "E"]));
    assert_eq!(ask(&[&quiet(r#""orders":{"block":["E"]}"#)], &set("in")), refused("blocked", &["E"]));
    assert_eq!(ask(&[], &set("out")), refused("direction", &["West"]));
    assert_eq!(
        ask(&[], &at(r#""A""#, r#""request":{"drive":"P","to":"reverse"}"#)),
        refused("point-under-train", &["P"])
    );
    let turn = r#""request":{"turn":"West","to":"away"}"#;
    assert_eq!(ask(&[], &at(r#""L""#, turn)), refused("direction", &["L"]));
    assert_eq!(ask(&[&set("in")], &quiet(turn)), refused("direction", &["in"]));
    assert_eq!(ask(&[], &quiet(turn)), refused("waiting", &["West"]));
}

/// A block on plain line: what leads to it and what turns it is told the blocked circuits. A train in the throat is named as well.
#[test]
fn what_is_in_the_way_on_plain_line() {
    let turn = |to: &str| quiet(&format!(r#""request":{{"turn":"West","to":"{to}"}},"consent":["West"]"#));
    let block = quiet(r#""orders":{"block":["L","W"]}"#);
    // The turn time of this layout is 35 cycles: a telegram's life, the time to a stand, and the loss of a shunt.
    let mut outward = vec![turn("toward"), turn("away")];
    outward.extend(vec![quiet(""); 34]);
    outward.push(turn("away"));
    let ask = |before: &[String], asked: &str| {
        let steps: Vec<String> = before.iter().cloned().chain([asked.to_owned()]).collect();
        output(in_service(&steps).last().expect("an answer"))["answer"].clone()
    };
    let refused = |reason: &str, because: &[&str]| json!({"refused": reason, "because": because});
    assert_eq!(ask(&outward[..36], &outward[36]), "accepted");
    assert_eq!(ask(&outward[..35], &outward[36]), refused("waiting", &["West"]));
    let blocked = [outward.as_slice(), std::slice::from_ref(&block)].concat();
    assert_eq!(ask(&blocked, &quiet(r#""request":{"set":"out"}"#)), refused("blocked", &["L", "W"]));
    assert_eq!(ask(&blocked, &turn("toward")), refused("blocked", &["L", "W"]));
    assert_eq!(ask(&[outward[0].clone(), block], &turn("away")), refused("waiting", &["L", "W"]));
    let throat = step(
        r#"{"occupied":["A"],"detected":{"P":"normal"},"request":{"turn":"West","to":"toward"},"consent":["West"]}"#,
    );
    assert_eq!(ask(&outward, &throat), refused("direction", &["A"]));
}

/// A route that would have to move a point in a block, beside its path, is told the blocked circuit.
#[test]
fn a_point_in_a_block_is_in_the_way() {
    let mut fork = plan();
    fork["plan"]["routes"][0]["path"] = json!([{"circuits": ["B"], "points": {"P": "normal"}}]);
    let at = |more: &str| step(&format!(r#"{{"occupied":[],"detected":{{"P":"reverse"}}{more}}}"#));
    let unblock = at(r#","orders":{"unblock":["W","B","E"],"lift":["W","A","B","E"]}"#);
    let set = at(r#","request":{"set":"in"}"#);
    let lines = [start("interlocking", &fork.to_string()), unblock, at(""), at(""), set];
    let said = converse(&lines.each_ref().map(String::as_str));
    let refused = json!({"refused": "blocked", "because": ["A"]});
    assert_eq!(output(said.last().expect("an answer"))["answer"], refused);
}

/// A start that is not understood or breaks a rule of layouts, and what its reason must say.
#[test]
fn wrong_starts() {
    let with = |change: &dyn Fn(&mut Value)| {
        let mut layout = layout();
        change(&mut layout);
        start("interlocking", &layout.to_string())
    };
    let malformed = [
        (with(&|it| it["circuits"] = json!([])), "unknown field `circuits`"),
        (with(&|it| it["circuit"][0]["length_m"] = json!("far")), "expected u16"),
        (with(&|it| it["circuit"][0]["length_m"] = json!(null)), "null, expected a value of a layout"),
        (begin().replacen("\"name\":\"Fork\"", "\"name\":\"Fork\",\"name\":\"Fork\"", 1), "duplicate field `name`"),
        (start("interlocking", "[]"), "expected an object"),
        (start("interlocking", r#""layouts/passing-loop.toml""#), "expected an object"),
        (start("interlocking", "{}"), "missing field `name`; a config of interlocking is a layout"),
    ];
    for (line, fragment) in malformed {
        assert_malformed(&converse(&[&line])[0], 1, &line, fragment);
    }
    let rejected = [
        (with(&|it| it["route"][0]["path"] = json!(["A", "E"])), "in"),
        (with(&|it| it["route"][0]["entry"] = json!("nowhere")), "nowhere"),
        (with(&|it| it["times"]["cycle_ms"] = json!(0)), "cycle"),
    ];
    for (line, fragment) in rejected {
        let reply: Value = serde_json::from_str(&converse(&[&line])[0]).expect("JSON");
        let reason = reply["rejected"]["reason"].as_str().unwrap_or_else(|| panic!("{line} was answered by {reply}"));
        assert!(reason.contains(fragment) && !reason.contains('\n'), "{reason:?}, without {fragment:?}");
    }
}

/// The fork in the kernel's own terms, without the line.
fn plan() -> Value {
    let circuits = ["W", "A", "B", "E"].map(|name| json!({"name": name, "length_m": 600}));
    json!({"plan": {
        "station": "Fork", "cycle_ms": 1000, "clear_cycles": 2, "turn_cycles": 3, "start_cycles": 0,
        "settle_cycles": 0, "loss_cycles": 0, "residual_cycles": 0, "standstill_cycles": 0,
        "speeds_km_h": [0, 45], "braking_m": [0, 300],
        "circuits": circuits,
        "points": [{"name": "P", "detectors": ["A"]}],
        "segments": [],
        "routes": [{
            "name": "in", "heading": "right", "entry": ["W"], "approach": ["W"],
            "path": [{"circuits": ["A"], "points": {"P": "normal"}}, {"circuits": ["B"], "points": {}}],
            "overlap": {"circuits": ["E"], "points": {}}, "beyond": ["E"], "continuing": [], "conflicts": [],
            "from": [], "to": [], "drive_cycles": 8, "release_cycles": 60, "stay_cycles": 30, "speed_code": 1,
            "cab_signalled": false, "calling_on": false,
        }],
    }})
}

/// What is done to a plan.
type Change<'a> = &'a dyn Fn(&mut Value);

/// What the machine says to a start on the plan with a change.
fn on_plan(change: Change<'_>) -> Value {
    let mut plan = plan();
    change(&mut plan["plan"]);
    let line = start("interlocking", &plan.to_string());
    serde_json::from_str(&converse(&[&line])[0]).expect("JSON")
}

#[test]
fn a_plan_in_the_kernels_own_terms_is_run_as_it_stands() {
    let circuits = r#"["W","A","B","E"]"#;
    let serve = quiet(&format!(r#""orders":{{"unblock":{circuits},"lift":{circuits}}}"#));
    let begin = start("interlocking", &plan().to_string());
    let waits = step(r#"{"occupied":["W"],"detected":{"P":"normal"}}"#);
    let set = step(r#"{"occupied":["W"],"detected":{"P":"normal"},"request":{"set":"in"}}"#);
    let said = converse(&[&begin, &serve, &quiet(""), &waits, &set]);
    let last = output(&said[4]);
    assert_eq!(last["proceed"], json!(["in"]));
    assert_eq!(last["telegrams"], json!({"W": {"stop": "B", "speed_km_h": 45, "open": true, "heading": "right"}}));
    // Engineering asks for an approach that covers braking, the theorems do not: this is for the traces of accidents.
    assert!(on_plan(&|it| it["routes"][0]["approach"] = json!([]))["started"].is_object());
    let config: Config = serde_json::from_value(plan()).expect("a plan");
    assert_eq!(serde_json::to_value(&config).expect("JSON"), plan());
}

#[test]
fn wrong_plans() {
    let wrong: [(Change<'_>, &str); 15] = [
        (&|it| it["speeds_km_h"] = json!([45, 90]), "speeds_km_h must begin with 0"),
        (&|it| it["speeds_km_h"] = json!([0, 90, 45]), "and not fall"),
        (&|it| it["routes"][0]["speed_code"] = json!(8), "route in: speed_code is 8; it is 0 to 7"),
        (&|it| it["routes"] = json!(vec![it["routes"][0].clone(); 257]), "routes has more than 256 entries"),
        (
            &|it| it["routes"][0]["path"] = json!(vec![it["routes"][0]["path"][1].clone(); 33]),
            "route in: path has more than 32 entries",
        ),
        (&|it| it["cycle_ms"] = json!(0), "cycle_ms is 0"),
        (
            &|it| it["segments"] = json!([{"name": "S", "circuits": [], "throat": [], "outward": "left"}]),
            "segment S: circuits has 0 circuits",
        ),
        (&|it| it["clear_cycles"] = json!(0), "the layout breaks a rule: "),
        (&|it| it["routes"][0]["path"][0]["points"] = json!({}), "A of route in breaks a rule: "),
        (&|it| it["routes"][0]["path"] = json!([]), "route in: path has 0 circuits; it has 1 to 16"),
        (
            &|it| it["routes"][0]["entry"] = json!(["X"]),
            "route in: entry names circuit \"X\"; the circuits of this layout are W, A",
        ),
        (&|it| it["routes"][0]["path"][0]["points"] = json!({"Q": "normal"}), "route in: path names point \"Q\""),
        (&|it| it["circuits"][1]["name"] = json!("W"), "two circuits have the name \"W\""),
        (&|it| it["braking_m"] = json!([0, 1, 2, 3, 4, 5, 6, 7, 8]), "braking_m has more than 8 entries"),
        (&|it| it["points"] = json!(vec![json!({"name": "P", "detectors": []}); 2]), "two points have the name"),
    ];
    for (change, fragment) in wrong {
        let reply = on_plan(change);
        let reason = reply["rejected"]["reason"].as_str().unwrap_or_else(|| panic!("{reply}, without {fragment:?}"));
        assert!(reason.contains(fragment) && !reason.contains('\n'), "{reason:?}, without {fragment:?}");
    }
    let formless: [(Change<'_>, &str); 3] = [
        (&|it| drop(it.as_object_mut().map(|it| it.remove("routes"))), "missing field `routes`"),
        (&|it| it["clear_cycles"] = json!(256), "256"),
        (&|it| it["also"] = json!(1), "unknown field `also`"),
    ];
    for (change, fragment) in formless {
        let mut plan = plan();
        change(&mut plan["plan"]);
        let line = start("interlocking", &plan.to_string());
        assert_malformed(&converse(&[&line])[0], 1, &line, fragment);
    }
}

/// A large station: a hundred routes, 77 circuits, 48 points. Trains are told of circuits in both words of a set.
#[test]
fn a_large_station_is_served() {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../../layouts/station-100.toml");
    let description = atc_layout::read(path).unwrap_or_else(|errors| panic!("{errors}"));
    let all: Vec<String> = description.station.circuits.iter().map(|circuit| circuit.name.value.clone()).collect();
    let points: Vec<String> = description.station.points.iter().map(|point| point.name.value.clone()).collect();
    let config = serde_json::to_value(Config::from(description)).expect("JSON");
    let begin = start("interlocking", &config.to_string());
    let say = |occupied: &[&str], to: &str, more: Value| {
        let mut detected = serde_json::Map::new();
        for point in &points {
            // To track 20 the first 19 points of a ladder lie normal, and the 20th reverse; so do those of its overlap.
            detected.insert(point.clone(), json!(if point.ends_with(to) { "reverse" } else { "normal" }));
        }
        let mut body = json!({"occupied": occupied, "detected": detected, "consent": ["East"]});
        for (field, value) in more.as_object().into_iter().flatten() {
            body[field] = value.clone();
        }
        step(&body.to_string())
    };
    let mut lines = vec![begin, say(&[], "none", json!({"orders": {"unblock": all, "lift": all}}))];
    // The start time, in which every circuit comes to count as clear.
    lines.extend((0..800).map(|_| say(&[], "none", json!({}))));
    lines.push(say(&[], "none", json!({"request": {"turn": "East", "to": "toward"}})));
    lines.push(say(&["E1"], "20", json!({"request": {"set": "E-20"}})));
    lines.extend((0..60).map(|_| say(&["E1"], "20", json!({}))));
    let said = converse(&lines.iter().map(String::as_str).collect::<Vec<_>>());
    let last = output(said.last().expect("an answer"));
    assert_eq!(last["proceed"], json!(["E-20"]), "{last}");
    assert_eq!(last["telegrams"]["E1"]["stop"], json!("20T"), "{last}");
    assert_eq!(last["routes"]["E-20"], json!("set"), "{last}");
}

/// A step that is not understood changes nothing.
#[test]
fn wrong_steps() {
    let body = |more: &str| format!(r#"{{"occupied":[],"detected":{{}}{more}}}"#);
    let request = |request: &str| body(&format!(r#","request":{request}"#));
    let cases = [
        (r#"{"detected":{}}"#.to_owned(), "missing field `occupied`"),
        (r#"{"occupied":[]}"#.to_owned(), "missing field `detected`"),
        (body(r#","train":1"#), "unknown field `train`"),
        (
            r#"{"occupied":["X"],"detected":{}}"#.to_owned(),
            r#"occupied names circuit "X"; the circuits of this layout are L, W, A, B, C, E"#,
        ),
        (r#"{"occupied":["A","B","A"],"detected":{}}"#.to_owned(), r#"occupied names circuit "A" a second time"#),
        (r#"{"occupied":"A","detected":{}}"#.to_owned(), "expected a sequence"),
        (
            r#"{"occupied":[],"detected":{"Q":"normal"}}"#.to_owned(),
            r#"detected names point "Q"; the points of this layout are P"#,
        ),
        (
            r#"{"occupied":[],"detected":{"P":"left"}}"#.to_owned(),
            r#"unknown position "left", expected one of "normal", "reverse""#,
        ),
        (
            r#"{"occupied":[],"detected":{"P":"normal","P":"reverse"}}"#.to_owned(),
            "\"P\" a second time; each is named once",
        ),
        (body(r#","consent":["East"]"#), r#"consent names segment "East"; the segments of this layout are West"#),
        (body(r#","orders":{"close":["A"]}"#), "unknown field `close`"),
        (body(r#","orders":{"block":["X"]}"#), "block names circuit \"X\""),
        (
            body(r#","orders":{"restrict":{"A":25,"B":45}}"#),
            "restrict has 25 and 45 km/h; the circuits of one cycle are restricted to one speed",
        ),
        (body(r#","orders":{"restrict":{"A":-1}}"#), "-1"),
        (request(r#"{"set":"up"}"#), r#"set names route "up"; the routes of this layout are in, side, out"#),
        (request(r#"{"withdraw":"up"}"#), "withdraw names route"),
        (request(r#"{"drive":"Q","to":"normal"}"#), "drive names point"),
        (request(r#"{"drive":"P"}"#), "a request is {\"set\":route}"),
        (request(r#"{"drive":"P","to":"toward"}"#), "unknown position \"toward\""),
        (
            request(r#"{"turn":"West","to":"normal"}"#),
            "unknown direction \"normal\", expected one of \"toward\", \"away\"",
        ),
        (request(r#"{"turn":"East","to":"away"}"#), "turn names segment"),
        (request(r#"{"set":"in","withdraw":"in"}"#), "a request is"),
        (request(r#"{"set":null}"#), "null"),
        (request("{}"), "a request is"),
        (body(r#","all_telegrams":1"#), "expected a boolean"),
    ];
    let before = quiet(r#""request":{"turn":"West","to":"toward"}"#);
    let after = quiet(r#""request":{"set":"in"}"#);
    let expected = in_service(&[before.clone(), after.clone()]);
    assert!(expected[1].contains("\"accepted\""));
    for (body, fragment) in cases {
        let line = step(&body);
        let said = in_service(&[before.clone(), line.clone(), after.clone()]);
        assert_malformed(&said[1], 5, &line, fragment);
        assert_eq!([&said[..1], &said[2..]].concat(), expected, "{line}");
    }
}

/// What another implementation may leave out, and what it may not say.
#[test]
fn replies_of_other_implementations() {
    let read = |body: &str| serde_json::from_str::<Output>(body);
    let body = |answer: &str| {
        format!(
            r#"{{"routes":{{}},"proceed":[],"drives":{{}},"telegrams":{{}},"permits":[],"confirmed":[],"answer":{answer}}}"#
        )
    };
    let ours = read(&body(r#"{"refused":"occupied","because":["A"]}"#)).expect("an output");
    assert_eq!(read(&body(r#"{"refused":"occupied"}"#)).expect("an output"), ours, "the names are not compared");
    assert_ne!(read(&body(r#"{"refused":"blocked","because":["A"]}"#)).expect("an output"), ours);
    assert_ne!(read(&body("\"accepted\"")).expect("an output"), read(&body("null")).expect("an output"));
    assert!(read(&body("\"yes\"")).is_err() && read(&body(r#"{"refused":"tired"}"#)).is_err());
    assert!(read(&body("null").replace(",\"answer\":null", "")).is_err(), "an answer may be null, not missing");
}

static SCHEMA: LazyLock<Validator> =
    LazyLock::new(|| jsonschema::validator_for(&atc_protocol::schema::schema()).expect("a schema"));

/// The example through the real process: the same replies as in process, and every line of both sides fits the schema.
#[test]
fn the_example_through_the_process() {
    let said = device::converse(device::oracle(), EXAMPLE.as_bytes().to_vec()).expect("a session");
    assert_eq!(said, replies(EXAMPLE.as_bytes()));
    assert_eq!(said.len(), EXAMPLE.lines().count());
    for line in EXAMPLE.lines().chain(said.iter().map(String::as_str)) {
        assert!(!line.starts_with("{\"malformed\"") && !line.starts_with("{\"rejected\""), "{line}");
        assert!(SCHEMA.is_valid(&serde_json::from_str(line).expect("JSON")), "{line}");
    }
    for line in [
        quiet(r#""request":{"set":"in","withdraw":"in"}"#),
        quiet(r#""request":{"turn":"West","to":"normal"}"#),
        quiet(r#""orders":{"restrict":["A"]}"#),
        step(r#"{"occupied":[],"detected":{"P":"left"}}"#),
        r#"{"output":{"routes":{"in":"gone"},"proceed":[],"drives":{},"telegrams":{},"permits":[],"confirmed":[],"answer":null}}"#.to_owned(),
    ] {
        assert!(!SCHEMA.is_valid(&serde_json::from_str(&line).expect("JSON")), "{line}");
    }
}

/// The layouts of the repository are layouts of this machine.
#[test]
fn every_sample_opens() {
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/../../layouts");
    let (mut opened, mut large) = (0, 0);
    for entry in std::fs::read_dir(folder).expect(folder) {
        let path = entry.expect("an entry").path();
        if path.extension().is_some_and(|extension| extension == "toml") {
            let description = atc_layout::read(&path).unwrap_or_else(|errors| panic!("{errors}"));
            let config = Config::from(description);
            // The same from JSON, with what it says of itself.
            let again: Config = serde_json::from_value(serde_json::to_value(&config).expect("JSON")).expect("a layout");
            let opened_as = |config: &Config| Sizes::open(config).unwrap_or_else(|reason| panic!("{reason}"));
            match (opened_as(&config), opened_as(&again)) {
                (Sizes::Small(one), Sizes::Small(other)) => {
                    assert_eq!((one.layout(), one.names()), (other.layout(), other.names()));
                }
                (Sizes::Large(one), Sizes::Large(other)) => {
                    assert!(one.layout() == other.layout() && one.names() == other.names());
                    large += 1;
                }
                both => panic!("two sizes: {both:?}"),
            }
            opened += 1;
        }
    }
    assert!(opened >= 3 && large == 2, "{opened} samples, {large} large");
}

/// The chart of the example: what stands in it, against times that are known from its requests.
#[test]
fn the_chart_of_the_example() {
    let bars = titles(&drawing::draw(EXAMPLE, Replies::MustAgree, None));
    for bar in [
        "set W-1: 10000 to 11000 ms",
        "set E-2, refused: path-held W-1: 14000 to 15000 ms",
        "P1 reverse, refused: point-locked W-1: 22000 to 23000 ms",
        "set 1-W, refused: direction West: 56000 to 57000 ms",
        "provisional: 11000 to 16000 ms",
        "set: 16000 to 40000 ms",
        "in-use: 40000 to 100000 ms",
        "overlap of W-1: 11000 to 77000 ms",
        "to normal: 10000 to 15000 ms",
        "occupied: 46000 to 100000 ms",
        "▶ to 1T at 75 km/h: 27000 to 40000 ms",
        "▶ to E2 at 25 km/h: 77000 to 95000 ms",
        "away: 61000 to 132000 ms",
    ] {
        assert!(bars.contains(&bar.to_owned()), "{bar} is not among {bars:#?}");
    }
    let signals = chart::vcd(&Trace::parse(EXAMPLE).expect("a trace"), Replies::MustAgree).expect("signals");
    for name in ["occupied_1T", "telegram_W1", "route_W-1", "proceed_1-E", "drive_P1"] {
        assert!(signals.contains(name), "{name}");
    }
}

/// Wrong replies: refused, or drawn in red where they are.
#[test]
fn a_difference_is_refused_or_drawn() {
    let mut lines = session::replies(EXAMPLE.as_bytes());
    assert!(lines[16].contains(r#""proceed":["W-1"]"#), "{}", lines[16]);
    lines[16] = lines[16].replace(r#""proceed":["W-1"]"#, r#""proceed":[]"#);
    lines[30] = lines[30].replace("\"1T\"", "\"P1T\"");
    let text = format!("{EXAMPLE}{}", lines.join("\n"));
    let trace = Trace::parse(&text).expect("a trace");
    let error = chart::svg(&trace, Replies::MustAgree, &View::default()).expect_err("a difference");
    assert_eq!(error.line, EXAMPLE.lines().count() + 17);
    let svg = drawing::draw(&text, Replies::AsRecorded, None);
    assert!(svg.contains("THE RECORD DIFFERS FROM THE KERNEL, first at 16000 ms."));
    let bars = titles(&svg);
    assert!(bars.contains(&"proceed []: 16000 to 17000 ms".to_owned()), "{bars:#?}");
    assert!(bars.iter().any(|bar| bar.starts_with("telegrams {") && bar.ends_with(": 30000 to 31000 ms")), "{bars:#?}");
}

/// A train slides over a point in reverse into a sand drag, changes ends and goes back, with its tail there. Found by the seventeenth attack: it
/// was told the speed of the routes over that point, which lay for the other way then.
#[test]
fn a_train_that_goes_back_from_a_sand_drag_keeps_the_speed_of_its_point() {
    let mut session = atc_protocol::Session::new();
    let (mut open, mut reply) = (0, Vec::new());
    for line in include_str!("sand-drag.jsonl").lines() {
        reply.clear();
        session.answer(line.as_bytes(), &mut reply);
        let step: Value = serde_json::from_str(line).expect("JSON");
        let output: Value = serde_json::from_slice(&reply).expect("JSON");
        let telegrams = output["output"]["telegrams"].as_object().into_iter().flatten();
        for (circuit, telegram) in telegrams.filter(|(_, telegram)| telegram["heading"] == "left") {
            let tail = step["step"]["occupied"].as_array().into_iter().flatten().any(|name| name == "P2T");
            if tail && telegram["open"] == true {
                open += 1;
                assert_eq!(telegram["speed_km_h"], 25, "{circuit}: {telegram}");
            }
        }
    }
    assert!(open >= 3, "it may go");
}
