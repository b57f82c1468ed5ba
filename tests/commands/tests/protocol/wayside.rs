//! Machine `wayside` of protocol 1: the example session cycle by cycle (an ordinary train, consent at its limit, a missed detection, a
//! restart), every way to be wrong with the reason that is given, and the chart.

use std::sync::LazyLock;

use atc_oracle::chart::{self};
use atc_oracle::conform::walk::{Sizes, case};
use atc_oracle::trace::{Replies, Trace};
use atc_tests::device;
use atc_tests::drawing::{self, titles};
use atc_tests::session::{assert_malformed, converse, replies, start, step};
use jsonschema::Validator;
use serde_json::{Value, json};

const EXAMPLE: &str = include_str!("../../../../oracle/examples/wayside.jsonl");

static SCHEMA: LazyLock<Validator> =
    LazyLock::new(|| jsonschema::validator_for(&atc_protocol::schema::schema()).expect("a schema"));

/// The outputs of the example; number 1 is that of the first cycle.
fn outputs() -> Vec<Value> {
    replies(EXAMPLE.as_bytes())
        .iter()
        .map(|line| serde_json::from_str::<Value>(line).expect("JSON")["output"].clone())
        .collect()
}

fn config() -> Value {
    let first: Value = serde_json::from_str(EXAMPLE.lines().next().expect("a start")).expect("JSON");
    first["start"]["config"].clone()
}

/// The replies to steps behind a start with the example's configuration.
fn run(steps: &[Value]) -> Vec<Value> {
    let begin = start("wayside", &config().to_string());
    let steps: Vec<String> = steps.iter().map(|body| step(&body.to_string())).collect();
    let lines: Vec<&str> = std::iter::once(begin.as_str()).chain(steps.iter().map(String::as_str)).collect();
    let said = converse(&lines);
    assert!(said[0].starts_with("{\"started\""), "{}", said[0]);
    said[1..].iter().map(|line| serde_json::from_str(line).expect("JSON")).collect()
}

fn block(low: bool, high: bool, head: bool) -> Value {
    json!({"low_check": low, "high_check": high, "present": if head { vec![0] } else { Vec::new() }})
}

const ALL: [&str; 6] = ["A", "W1", "W2", "B", "E1", "E2"];

/// How far the train in a circuit may go beyond it to the right; none if it must stay.
fn told(output: &Value, circuit: &str) -> Option<u64> {
    output["transmissions"][circuit]["right"]["main"]["beyond_exit_m"].as_u64()
}

/// A circuit that has just become clear still counts as occupied, and is named as what is in the way.
#[test]
fn what_is_not_clear_for_long_enough_is_in_the_way() {
    let quiet = |occupied: &[&str]| {
        let blocks = [block(false, false, false), block(false, false, false)];
        json!({"occupied": occupied, "detected": {"P": "normal"}, "blocks": blocks})
    };
    let mut first = quiet(&[]);
    first["orders"] = json!({"unblock": ALL, "lift": ALL});
    let mut reset = quiet(&[]);
    for block in reset["blocks"].as_array_mut().expect("blocks") {
        block["reset"] = json!(0);
    }
    let mut turn = quiet(&[]);
    turn["request"] = json!({"turn": "East", "to": "away"});
    let mut steps = vec![first, reset];
    steps.extend((0..8).map(|_| quiet(&[])));
    steps.extend([quiet(&["E2"]), turn]);
    let said = run(&steps);
    let answer = &said[said.len() - 1]["output"]["answer"];
    assert_eq!(*answer, json!({"refused": "direction", "because": ["E2"]}));
}

/// An ordinary train: from the line over both counted sections into the station, and out of it.
///
/// ```text
///  W2 ══ W1 │ A ── B │ E1 ══ E2      W2 and W1 are counted
/// ```
#[test]
fn an_ordinary_train() {
    let outputs = outputs();
    let phase = |cycle: usize| outputs[cycle]["routes"]["in-out"].as_str().unwrap_or("idle");
    assert_eq!(outputs[5]["answer"]["refused"], "direction", "the counted line is not turned");
    assert_eq!(outputs[16]["answer"], "accepted");
    assert_eq!((phase(17), phase(27), phase(37), phase(38)), ("set", "in-use", "in-use", "idle"));
    // What is granted beyond the circuit: the others of 220, 210, 240, 250 and 260 m.
    let way = [(18, "W2", 1180), (22, "W1", 960), (27, "A", 750), (31, "B", 510), (35, "E1", 260)];
    for (cycle, circuit, metres) in way {
        assert_eq!(told(&outputs[cycle], circuit), Some(metres), "cycle {cycle}");
        let sent = &outputs[cycle]["transmissions"][circuit];
        // A train that faces the other way is told to stop, under another number.
        assert_eq!(sent["left"]["main"]["beyond_exit_m"], Value::Null, "cycle {cycle}");
        assert_eq!(sent["left"]["main"]["speed_rank"], 0, "cycle {cycle}");
        assert_ne!(sent["left"]["main"]["section"], sent["right"]["main"]["section"], "cycle {cycle}");
    }
    // The signal shows stop as soon as the train is in its path.
    assert_eq!(outputs[26]["proceed"], json!(["in-out"]));
    assert_eq!(outputs[27]["proceed"], json!([]));
    // While it is on A, the last section is held for its tail.
    assert_eq!(outputs[29]["line"]["blocks"][1]["occupied"], json!([0]));
    assert_eq!(outputs[32]["line"]["blocks"][1]["occupied"], json!([]));
}

/// The neighbour's messages stop at cycle 46. The last one, at 45, echoes cycle 44, and counts until 48: 4 cycles.
#[test]
fn consent_ends_at_its_age() {
    let outputs = outputs();
    for (cycle, proceeds) in [(45, true), (48, true), (49, false), (52, false), (53, true)] {
        assert_eq!(outputs[cycle]["proceed"] == json!(["in-out"]), proceeds, "cycle {cycle}");
    }
}

/// While the head in W1 is missed, the section is reported by disagreement: its train is told what it was told, and nothing is released.
#[test]
fn a_missed_detection() {
    let quiet = json!({"occupied": [], "detected": {"P": "normal"}, "blocks": [block(false, false, false), block(false, false, false)]});
    let mut steps = vec![quiet.clone(); 24];
    let verified = json!({"low_check": false, "high_check": false, "present": [], "reset": 0});
    steps[0]["orders"] = json!({"unblock": ALL, "lift": ALL});
    steps[1]["blocks"] = json!([verified, verified]);
    steps[4]["request"] = json!({"turn": "West", "to": "toward"});
    steps[10]["request"] = json!({"turn": "East", "to": "away"});
    for (cycle, step) in steps.iter_mut().enumerate().skip(1) {
        // The neighbour in the east answers every cycle with the one before it.
        let echo = json!({"session": 7, "cycle": cycle});
        step["messages"] =
            json!({"East": {"permission": "granted", "sent": {"session": 1, "cycle": cycle}, "echo": echo}});
    }
    steps[11]["request"] = json!({"set": "in-out"});
    steps[14]["blocks"] = json!([block(true, false, true), block(false, false, false)]);
    steps[15]["blocks"] = json!([block(false, false, true), block(true, false, false)]);
    steps[16]["blocks"] = json!([block(false, false, false), block(true, false, true)]);
    steps[17]["blocks"] = json!([block(false, true, false), block(false, false, true)]);
    // Missed from here on.
    let replies = run(&steps);
    for (cycle, reply) in replies.iter().enumerate() {
        assert!(reply["output"].is_object(), "cycle {cycle}: {reply}");
    }
    let after = &replies[18..];
    for (cycle, reply) in after.iter().enumerate() {
        let (output, line) = (&reply["output"], &reply["output"]["line"]["blocks"][1]);
        assert_eq!(
            (&line["agree"], &line["count"], &line["occupied"]),
            (&json!(false), &json!(1), &json!([0])),
            "{cycle}"
        );
        assert_eq!(output["routes"]["in-out"], "set", "{cycle}");
        assert_eq!(told(output, "W1"), Some(960), "{cycle}");
    }
    let agrees = &replies[17]["output"]["line"]["blocks"][1]["agree"];
    assert_eq!(agrees, &json!(true), "heard once more");
}

/// After a restart nothing shows proceed or is told to go, nothing is permitted, messages begin anew, and one that answers the start before
/// does not count.
#[test]
fn a_restart() {
    let outputs = outputs();
    assert_eq!(outputs[57]["proceed"], json!(["in-out"]));
    for (cycle, output) in outputs.iter().enumerate().skip(58) {
        assert_eq!((&output["proceed"], &output["routes"]), (&json!([]), &json!({})), "cycle {cycle}");
        assert!(ALL.iter().all(|circuit| told(output, circuit).is_none()), "cycle {cycle}");
        let message = &output["messages"]["West"];
        assert_eq!(message["permission"], "withheld", "cycle {cycle}");
        assert_eq!(message["sent"], json!({"session": 8, "cycle": cycle - 57}), "cycle {cycle}");
        assert_eq!(output["line"]["blocks"][0]["counting"], false, "cycle {cycle}");
    }
    // An answer to the start before does not let the line be turned; one to this start does.
    let quiet = json!({"occupied": [], "detected": {"P": "normal"}, "blocks": [block(false, false, false), block(false, false, false)]});
    let mut steps = vec![quiet; 24];
    for (cycle, step) in steps.iter_mut().enumerate() {
        let session = if cycle < 16 { 7 } else { 8 };
        let echo = json!({"session": session, "cycle": cycle});
        step["messages"] =
            json!({"East": {"permission": "granted", "sent": {"session": 1, "cycle": cycle}, "echo": echo}});
    }
    steps[0]["restart"] = 8.into();
    steps[0]["orders"] = json!({"unblock": ALL, "lift": ALL});
    (steps[15]["request"], steps[22]["request"]) =
        (json!({"turn": "East", "to": "away"}), json!({"turn": "East", "to": "away"}));
    let replies = run(&steps);
    assert_eq!(replies[15]["output"]["answer"]["refused"], "waiting", "{}", replies[15]);
    assert_eq!(replies[22]["output"]["answer"], "accepted", "{}", replies[22]);
}

/// Frames are numbered as they are taken, each carrier for itself.
#[test]
fn telegrams_are_numbered_as_they_are_taken() {
    let body = |framed: Value| json!({"occupied": [], "detected": {}, "blocks": [block(false, false, false), block(false, false, false)], "framed": framed, "all_telegrams": true});
    let replies = run(&[
        body(json!({})),
        body(json!({})),
        body(json!({"main": ["A"], "sub": []})),
        body(json!({"main": [], "sub": null})),
    ]);
    let numbers = |cycle: usize, circuit: &str| {
        let sent = &replies[cycle]["output"]["transmissions"][circuit]["right"];
        (sent["main"]["counter"].as_u64(), sent["sub"]["counter"].as_u64())
    };
    let expected = [("A", [0, 1, 2, 2], [0, 1, 1, 2]), ("B", [0, 1, 1, 1], [0, 1, 1, 2])];
    for (circuit, main, sub) in expected {
        for cycle in 0..4 {
            assert_eq!(numbers(cycle, circuit), (Some(main[cycle]), Some(sub[cycle])), "{circuit} {cycle}");
        }
    }
}

/// A start with the line of the trains that leave, counted from B on; before it is A, of 210 m.
fn counted_away(train_m: u32) -> String {
    let mut config = config();
    let block = json!({"circuits": ["E1", "B"], "max_trains": 2, "tail_hold_sections": 1});
    config["counted"] =
        json!({"segment": "East", "travel": "away", "direction": "down", "train_m": train_m, "blocks": [block]});
    start("wayside", &config.to_string())
}

/// A line that leads away, over the throat, with its low end outside.
#[test]
fn a_line_may_lead_away() {
    let said = converse(&[&counted_away(210)]);
    assert!(said[0].starts_with("{\"started\""), "{}", said[0]);
}

/// A start that breaks a rule, and what its reason must say.
#[test]
fn every_broken_rule_is_named() {
    let with = |change: &dyn Fn(&mut Value)| {
        let mut config = config();
        change(&mut config);
        start("wayside", &config.to_string())
    };
    let counted = |field: &'static str, value: Value| with(&move |config| config["counted"][field] = value.clone());
    let block = |number: usize, field: &'static str, value: Value| {
        with(&move |config| config["counted"]["blocks"][number][field] = value.clone())
    };
    let b = |field: &'static str, value: Value| {
        with(&move |config| config["signals"]["circuits"]["B"]["left"][field] = value.clone())
    };
    let cases = [
        (with(&|config| config["life_ms"] = 0.into()), "life_ms is 0 ms; it must be one cycle at least"),
        (
            with(&|config| config["life_ms"] = 5000.into()),
            "life_ms is 5000 ms; it must be less than the layout's turn time",
        ),
        (with(&|config| config["life_ms"] = 60_001_000.into()), "it must be at most 60000 cycles"),
        (with(&|config| config["session"] = 65_536.into()), "session is 65536; it must be 0 to 65535"),
        (with(&|config| config["layout"]["plan"]["clear_cycles"] = 0.into()), "layout: "),
        (
            counted("segment", "North".into()),
            "counted.segment names segment \"North\"; the segments of this layout are West, East",
        ),
        (counted("travel", "away".into()), "route in-out needs segment West against counted.travel"),
        (
            counted("direction", "down".into()),
            "counted.blocks[1].circuits[0] is W1; it must be the circuit that follows",
        ),
        (
            counted_away(211),
            "tail_hold_sections is too small at the line's entry; the places that are held must be as long as counted.train_m, 211 m",
        ),
        (counted("train_m", 221.into()), "what is held from section"),
        (counted("blocks", json!([])), "counted.blocks is empty"),
        (
            block(1, "circuits", json!(["E1"])),
            "counted.blocks[1].circuits[0] is E1; it must be a circuit of segment West",
        ),
        (block(1, "circuits", json!(["W3"])), "counted.blocks[1].circuits[0] names circuit \"W3\""),
        (block(1, "circuits", json!([])), "counted.blocks[1].sections is 0; a block has 1 to 16 sections"),
        (block(1, "max_trains", 2.into()), "counted.blocks[1].max_trains is 2"),
        (
            block(1, "tail_hold_sections", 2.into()),
            "counted.blocks[1].tail_hold_sections is not that of counted.blocks[0]",
        ),
        (block(1, "pass_ms", 999.into()), "counted.blocks[1].pass_ms is 999 ms"),
        (
            with(&|config| config["signals"]["speeds_km_h"] = json!([0, 25, 75])),
            "signals.speeds_km_h has not 45 km/h, as which code 2",
        ),
        (
            with(&|config| config["signals"]["speeds_km_h"] = json!([25, 0])),
            "signals.speeds_km_h must have 1 to 16 speeds",
        ),
        (
            with(&|config| config["signals"]["codes"]["pairs"][0]["speed_km_h"] = 15.into()),
            "signals.codes.pairs has no pair for 0 km/h, as which code 0",
        ),
        (with(&|config| config["signals"]["codes"]["pairs"] = json!([])), "signals.codes.pairs is empty"),
        (b("section", 101.into()), "signals.circuits.B has a section number that stands for another circuit"),
        (
            b("section", 206.into()),
            "signals.circuits.B has a section number of the other direction of travel; left.section must be odd",
        ),
        (b("curve_km_h", 74.into()), "signals.circuits.B.left.curve_km_h is 74; it must be one of signals.speeds_km_h"),
        (b("gradient_permille", 128.into()), "signals.circuits.B.left.gradient_permille is 128"),
        (
            with(&|config| {
                config["signals"]["circuits"].as_object_mut().expect("circuits").remove("E2");
            }),
            "signals.circuits has not E2",
        ),
        (
            with(&|config| config["signals"]["circuits"]["X"] = config["signals"]["circuits"]["B"].clone()),
            "signals.circuits names circuit \"X\"",
        ),
    ];
    for (start, fragment) in cases {
        let reply: Value = serde_json::from_str(&converse(&[&start])[0]).expect("JSON");
        let reason = reply["rejected"]["reason"].as_str().unwrap_or_else(|| panic!("{start} was answered by {reply}"));
        assert!(reason.contains(fragment), "{start} was answered by {reason:?}, without {fragment:?}");
    }
}

/// A step that has no meaning, and what its reason must say. Nothing has changed by it.
#[test]
fn every_step_without_a_meaning_is_named() {
    let begin = start("wayside", &config().to_string());
    let body = |more: Value| {
        let mut body = json!({"occupied": [], "detected": {"P": "normal"}, "blocks": [block(false, false, false), block(false, false, false)]});
        for (name, value) in more.as_object().expect("fields") {
            body[name] = value.clone();
        }
        step(&body.to_string())
    };
    let message = |permission: &str, session: u32, echo: Value| json!({"messages": {"East": {"permission": permission, "sent": {"session": session, "cycle": 1}, "echo": echo}}});
    let cases = [
        (body(json!({"occupied": ["X"]})), "occupied names circuit \"X\""),
        (body(json!({"blocks": []})), "blocks has 0 blocks; the counted line has 2"),
        (
            body(
                json!({"blocks": [block(false, false, false), {"low_check": false, "high_check": false, "present": [1]}]}),
            ),
            "blocks[1].present names section 1; the sections of this block are 0 to 0",
        ),
        (
            body(
                json!({"blocks": [{"low_check": false, "high_check": false, "present": [], "reset": 256}, block(false, false, false)]}),
            ),
            "blocks[0].reset is 256",
        ),
        (body(message("granted", 65_536, Value::Null)), "messages.East.sent.session is 65536"),
        (body(message("granted", 1, json!({"session": 65_536, "cycle": 0}))), "messages.East.echo.session is 65536"),
        (
            body(message("given", 1, Value::Null)),
            "unknown permission \"given\", expected one of \"withheld\", \"granted\"",
        ),
        (
            body(json!({"messages": {"East": {"permission": "granted", "sent": {"session": 1, "cycle": 1}}}})),
            "missing field `echo`",
        ),
        (
            body(
                json!({"messages": {"North": {"permission": "granted", "sent": {"session": 1, "cycle": 1}, "echo": null}}}),
            ),
            "messages names segment \"North\"",
        ),
        (body(json!({"framed": {"main": ["A", "A"]}})), "framed.main names circuit \"A\" a second time"),
        (body(json!({"framed": {"both": []}})), "unknown field `both`"),
        (body(json!({"restart": 65_536})), "restart is 65536; it must be 0 to 65535"),
        (body(json!({"consent": ["East"]})), "unknown field `consent`"),
    ];
    let quiet = body(json!({}));
    let undisturbed = converse(&[&begin, &quiet, &quiet]);
    for (line, fragment) in cases {
        let said = converse(&[&begin, &quiet, &line, &quiet]);
        assert_malformed(&said[2], 3, &line, fragment);
        assert_eq!([&said[..2], &said[3..]].concat(), undisturbed, "{line}");
    }
}

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
    assert!(said[0].contains(r#""cycles":{"clear":3,"life":4,"turn":5}"#), "{}", said[0]);
}

#[test]
fn the_chart_of_the_example() {
    let bars = titles(&drawing::draw(EXAMPLE, Replies::MustAgree, None));
    for bar in [
        "West away: 4000 to 5000 ms",
        "set in-out: 15000 to 16000 ms",
        "start 8: 57000 to 58000 ms",
        "counted: 17000 to 27000 ms",
        "▶ 1180 m: 18000 to 22000 ms",
        "unverified: 58000 to 63000 ms",
    ] {
        assert!(bars.contains(&bar.to_owned()), "{bar} is not among {bars:#?}");
    }
    let signals = chart::vcd(&Trace::parse(EXAMPLE).expect("a trace"), Replies::MustAgree).expect("signals");
    for name in ["occupied_W1", "telegram_W1", "proceed_in-out", "consent_East"] {
        assert!(signals.contains(name), "{name}");
    }
}

/// The border check holds a layout's `telegram_age_ms` against the neighbour's turn time, so no permission may count for longer.
#[test]
fn a_permission_counts_for_no_longer_than_the_layout_says_of_telegrams() {
    let mut config = config();
    let layout = include_str!("../../../../layouts/passing-loop.toml");
    let layout = layout.replace("[speed]", "[times]\nturn_ms = 300000\nstart_ms = 300000\n\n[speed]");
    let description = atc_layout::Description::from_toml("", &layout).expect("a layout");
    config["layout"] = serde_json::to_value(&description.station).expect("JSON");
    config.as_object_mut().expect("an object").remove("counted");
    // The last thing that is looked at: with a life that is right only the signals are of another station.
    for (life, reason) in
        [(1000, "signals"), (1001, "at most the layout's telegram_age_ms, 1000 ms"), (200_000, "at most")]
    {
        config["life_ms"] = life.into();
        let said = converse(&[&start("wayside", &config.to_string())]);
        assert!(said[0].starts_with("{\"rejected\"") && said[0].contains(reason), "{life}: {}", said[0]);
    }
}

/// What the device says is held against the layout's file: the twelfth attack gave it a shorter train and a rise, and both were taken.
#[test]
fn the_device_counts_on_what_the_layout_says() {
    let mut config = config();
    let layout = include_str!("../../../../line/examples/westham.toml");
    let description = atc_layout::Description::from_toml("", layout).expect("a layout");
    let station = &description.station;
    let fall = |name: &str| {
        let circuit = station.circuits.iter().find(|circuit| circuit.name.value == name).expect("a circuit");
        circuit.gradient.as_ref().map_or(0, |given| i16::from(given.value).abs())
    };
    assert_eq!((fall("W2"), fall("1T")), (10, 0));
    config["layout"] = serde_json::to_value(station).expect("JSON");
    let blocks = json!([{"circuits": ["W2"], "max_trains": 1, "tail_hold_sections": 1}, {"circuits": ["W1"], "max_trains": 1, "tail_hold_sections": 1}]);
    let told = |train_m: i64, circuit: &str, gradient_permille: i16, curve_km_h: i16| {
        let mut config = config.clone();
        config["counted"] =
            json!({"segment": "West", "travel": "toward", "direction": "up", "train_m": train_m, "blocks": blocks});
        let facing = |section: u16| json!({"section": section, "gradient_permille": gradient_permille, "curve_km_h": curve_km_h});
        config["signals"]["circuits"] = json!({circuit: {"left": facing(1), "right": facing(2)}});
        converse(&[&start("wayside", &config.to_string())])[0].clone()
    };
    let reason = |train_m: i64, circuit: &str, gradient_permille: i16| told(train_m, circuit, gradient_permille, 75);
    let short = reason(199, "W2", -10);
    assert!(
        short.contains("counted.train_m is 199 m; it must be at least the layout's longest_train_m, 200 m"),
        "{short}"
    );
    for (circuit, gradient, most) in [("W2", -9, "-10"), ("W2", 10, "-10"), ("1T", -9, "-10")] {
        let steep = reason(200, circuit, gradient);
        let says =
            format!("signals.circuits.{circuit}.left.gradient_permille is {gradient}; it must be at most {most}");
        assert!(steep.contains(&says), "{steep}");
    }
    // Trains run there at 75 km/h, and those by codes hear nothing of a lower limit in the sub telegrams.
    let slow = told(200, "1T", -10, 45);
    assert!(slow.contains("signals.circuits.1T.left.curve_km_h is 45; it must be at least 75 km/h"), "{slow}");
    // What is looked at next: the station has routes out to that line.
    for (circuit, gradient) in [("W2", -10), ("1T", -10)] {
        let right = reason(200, circuit, gradient);
        assert!(right.contains("route 1-W needs segment West against counted.travel"), "{right}");
    }
}

/// Without a number each start would be the first: what the neighbour said to the one before would count.
#[test]
fn a_start_has_a_number() {
    let mut config = config();
    config.as_object_mut().expect("an object").remove("session");
    let said = converse(&[&start("wayside", &config.to_string())]);
    assert!(said[0].contains("missing field `session`"), "{}", said[0]);
}

/// An output without the names that only the larger station has. A list of silent circuits that is empty is not written.
fn without_more(mut output: Value) -> Value {
    let said = output["output"].as_object_mut().expect("an object");
    for list in ["silent", "confirmed"] {
        let its = said.get_mut(list).and_then(Value::as_array_mut).unwrap_or_else(|| panic!("{list}"));
        its.retain(|name| !name.as_str().is_some_and(|name| name.starts_with("more ")));
    }
    said.retain(|list, its| list != "silent" || *its != json!([]));
    output
}

/// A station of more circuits than a small one has room for, the others with nothing on them, does what the small one does: its counted line,
/// its telegrams and its neighbours, over walks at random.
#[test]
fn a_large_station_does_what_a_small_one_does() {
    let (mut compared, mut counted, mut sent) = (0, 0, 0);
    for number in 0..60 {
        let expected = case("wayside", 7, number, Sizes::Small, None).expect("a case");
        if expected.outputs.is_empty() || expected.case.config["layout"].get("plan").is_none() {
            continue;
        }
        let mut config = expected.case.config.clone();
        let circuits = config["layout"]["plan"]["circuits"].as_array_mut().expect("circuits");
        // In front of them, so that every number is another one.
        let more = (0..200).map(|number| json!({"name": format!("more {number}"), "length_m": 100}));
        let others = std::mem::take(circuits);
        circuits.extend(more.chain(others));
        let begin = start("wayside", &config.to_string());
        let steps: Vec<String> = expected.case.steps.iter().map(|body| step(&body.to_string())).collect();
        let lines: Vec<&str> = std::iter::once(begin.as_str()).chain(steps.iter().map(String::as_str)).collect();
        let said = converse(&lines);
        assert!(said[0].starts_with("{\"started\""), "{}", said[0]);
        for (large, small) in said[1..].iter().zip(&expected.outputs) {
            let read = |line: &str| serde_json::from_str::<Value>(line).expect("JSON");
            let (large, same) = (without_more(read(large)), read(small));
            assert_eq!(large, same, "case {number}");
            compared += 1;
            counted += u32::from(!read(small)["output"]["line"].is_null());
            sent += u32::from(read(small)["output"]["transmissions"].as_object().is_some_and(|sent| !sent.is_empty()));
        }
    }
    assert!(
        compared > 400 && counted > 100 && sent > 40,
        "{compared} cycles, {counted} counted, {sent} with telegrams"
    );
}
