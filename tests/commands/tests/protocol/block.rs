//! Machine `block-count` of protocol 1: every form that is right, every way to be wrong with the reason that is given, and the
//! kernel's outputs through it, in process and through the real process.

use std::sync::LazyLock;

use atc_kernel::block::{Block, Hold, Input, SectionSet, State, TrainCount, step};
use atc_protocol::machine::block::{Config, Output};
use atc_tests::session::{self, assert_malformed, converse};
use atc_tests::{block_chart, device};
use jsonschema::Validator;
use proptest::prelude::*;
use serde_json::{Value, json};

fn start(config: &str) -> String {
    session::start("block-count", config)
}

/// A step with everything off and silent but what is said.
fn quiet(more: &str) -> String {
    let comma = if more.is_empty() { "" } else { "," };
    format!(r#"{{"step":{{"check_in":false,"check_out":false,"present":[]{comma}{more}}}}}"#)
}

const CONFIG: &str = r#"{"sections":3,"max_trains":3,"tail_hold_sections":0,"cycle_ms":10,"pass_ms":10000}"#;

#[test]
fn a_session() {
    let replies = converse(&[
        &start(r#"{"sections":3,"max_trains":3,"tail_hold_sections":1}"#),
        r#"{"step":{"check_in":false,"check_out":false,"present":[0,2],"reset":null,"ahead_hold_sections":0,"ahead_entered":true}}"#,
        r#"{"step":{"check_in":false,"check_out":false,"present":[2],"reset":1}}"#,
        r#" { "step" : { "present" : [ 2 , 0 ] , "check_out" : false , "check_in" : true } } "#,
        r#"{"step":{"check_in":false,"check_out":true,"present":[1],"ahead_entered":false,"ahead_hold_sections":16}}"#,
        r#"{"step":{"check_in":false,"check_out":false,"present":[1],"ahead_hold_sections":1}}"#,
        r#"{"step":{"check_in":false,"check_out":true,"present":[]}}"#,
        r#"{"step":{"check_in":false,"check_out":false,"present":[]}}"#,
        r#"{"step":{"check_in":false,"check_out":true,"present":[]}}"#,
        &quiet(r#""reset":1"#),
        &quiet(r#""reset":0"#),
        r#"{"stop":{}}"#,
    ]);
    let expected = [
        r#"{"started":{"protocol":1,"machine":"block-count","config":{"sections":3,"max_trains":3,"tail_hold_sections":1,"cycle_ms":10,"pass_ms":10000},"cycles":{"pass":1000}}}"#,
        r#"{"output":{"occupied":[0,1,2],"behind_hold_sections":1,"agree":false,"count":0,"fault":null,"counting":false}}"#,
        r#"{"output":{"occupied":[1,2],"behind_hold_sections":0,"agree":true,"count":1,"fault":null,"counting":true}}"#,
        r#"{"output":{"occupied":[0,1,2],"behind_hold_sections":1,"agree":true,"count":2,"fault":null,"counting":true}}"#,
        r#"{"output":{"occupied":[0,1,2],"behind_hold_sections":13,"agree":false,"count":2,"fault":null,"counting":true}}"#,
        r#"{"output":{"occupied":[0,1,2],"behind_hold_sections":0,"agree":true,"count":1,"fault":null,"counting":true}}"#,
        r#"{"output":{"occupied":[],"behind_hold_sections":0,"agree":true,"count":0,"fault":null,"counting":true}}"#,
        r#"{"output":{"occupied":[],"behind_hold_sections":0,"agree":true,"count":0,"fault":null,"counting":true}}"#,
        r#"{"output":{"occupied":[0,1,2],"behind_hold_sections":1,"agree":false,"count":0,"fault":"check-out-at-zero","counting":false}}"#,
        r#"{"output":{"occupied":[0,1,2],"behind_hold_sections":1,"agree":false,"count":0,"fault":null,"counting":false}}"#,
        r#"{"output":{"occupied":[],"behind_hold_sections":0,"agree":true,"count":0,"fault":null,"counting":true}}"#,
        r#"{"stopped":{"steps":10}}"#,
    ];
    assert_eq!(replies, expected);
}

#[test]
fn the_other_faults_by_name() {
    let entering = r#"{"step":{"check_in":true,"check_out":false,"present":[0]}}"#;
    let replies = converse(&[
        &start(r#"{"sections":2,"max_trains":1,"tail_hold_sections":0,"pass_ms":20}"#),
        &quiet(r#""reset":0"#),
        entering,
        entering,
        entering,
        &quiet(r#""reset":0"#),
        entering,
        &quiet(""),
        entering,
    ]);
    assert!(replies[4].contains(r#""count":1,"fault":"check-in-stays-on","counting":false"#), "{}", replies[4]);
    assert!(replies[8].contains(r#""count":1,"fault":"check-in-at-maximum","counting":false"#), "{}", replies[8]);
}

/// A start that breaks a rule, and what its reason must say. No case is open after it.
#[test]
fn every_rejected_start() {
    let cases = [
        ("sections", "0", "sections is 0; a block has 1 to 16 sections"),
        ("sections", "17", "sections is 17; a block has 1 to 16 sections"),
        ("sections", "4294967295", "sections is 4294967295; a block has"),
        ("max_trains", "0", "max_trains is 0; it must be 1 to the number of sections, 3"),
        ("max_trains", "4", "max_trains is 4; it must be 1 to the number of sections, 3"),
        ("max_trains", "259", "max_trains is 259; it must be"),
        ("tail_hold_sections", "17", "tail_hold_sections is 17; it must be 0 to 16 sections"),
        ("tail_hold_sections", "256", "tail_hold_sections is 256; it must be"),
        ("cycle_ms", "0", "cycle_ms is 0; a logic cycle is 1 ms or more"),
        ("pass_ms", "9", "pass_ms is 9 ms, less than one cycle of 10 ms; it must be 10 ms or more"),
        ("pass_ms", "600010", "pass_ms is 600010 ms; it must be at most 60000 cycles, 600000 ms"),
        ("pass_ms", "4294967295", "at most 60000 cycles"),
    ];
    for (field, value, fragment) in cases {
        let mut config: Value = serde_json::from_str(CONFIG).expect("JSON");
        config[field] = serde_json::from_str(value).expect("JSON");
        let replies = converse(&[&start(&config.to_string()), &quiet(""), &start(CONFIG)]);
        let reply: Value = serde_json::from_str(&replies[0]).expect("JSON");
        let reason = reply["rejected"]["reason"].as_str().unwrap_or_else(|| panic!("{config} was answered by {reply}"));
        assert!(reason.contains(fragment), "{config} was rejected with {reason:?}, without {fragment:?}");
        assert!(replies[1].contains("a step before a start") && replies[2].starts_with("{\"started\""));
    }
    for config in [
        r#"{"sections":16,"max_trains":16,"tail_hold_sections":16,"pass_ms":600009}"#,
        r#"{"sections":1,"max_trains":1,"tail_hold_sections":0,"cycle_ms":4294967295,"pass_ms":4294967295}"#,
    ] {
        assert!(converse(&[&start(config)])[0].starts_with("{\"started\""), "{config}");
    }
}

#[test]
fn every_malformed_start() {
    let cases = [
        ("{}", "missing field `sections`"),
        (r#"{"sections":3}"#, "missing field `max_trains`"),
        (r#"{"sections":3,"max_trains":3}"#, "missing field `tail_hold_sections`"),
        (r#"{"sections":-1,"max_trains":3,"tail_hold_sections":0}"#, "integer `-1`, expected u32"),
        (r#"{"sections":2.5,"max_trains":3,"tail_hold_sections":0}"#, "floating point `2.5`, expected u32"),
        (r#"{"sections":"3","max_trains":3,"tail_hold_sections":0}"#, "string \"3\", expected u32"),
        (r#"{"sections":null,"max_trains":3,"tail_hold_sections":0}"#, "null, expected u32"),
        (r#"{"sections":3,"sections":3}"#, "duplicate field `sections`"),
        (r#"{"sections":3,"max_trains":3,"tail_hold_sections":0,"hold":1}"#, "unknown field `hold`"),
        (r#"{"sections":3,"max_trains":3,"tail_hold_sections":0,"pass_ms":null}"#, "null, expected u32"),
        ("[3,3,0]", "expected an object, found [3,3,0]"),
    ];
    for (config, fragment) in cases {
        assert_malformed(&converse(&[&start(config)])[0], 1, config, fragment);
    }
    // And each says what would be right.
    assert_malformed(&converse(&[&start("{}")])[0], 1, "{}", &format!("a config of block-count is {CONFIG}"));
}

/// A line in a case, and what its reason must say. None of them changes anything: the outputs after it are as before.
#[test]
fn every_malformed_step() {
    let body = |body: &str| format!(r#"{{"step":{body}}}"#);
    let present = |list: &str| format!(r#"{{"step":{{"check_in":false,"check_out":false,"present":{list}}}}}"#);
    let cases = [
        (body("{}"), "missing field `check_in`"),
        (body(r#"{"check_in":false,"check_out":false}"#), "missing field `present`"),
        (body(r#"{"check_in":false,"present":[]}"#), "missing field `check_out`"),
        (body(r#"{"check_in":0,"check_out":false,"present":[]}"#), "integer `0`, expected a boolean"),
        (body(r#"{"check_in":null,"check_out":false,"present":[]}"#), "null, expected a boolean"),
        (body("[false,false,[]]"), "expected an object, found [false,"),
        (quiet(r#""train":1"#), "unknown field `train`"),
        (quiet(r#""present":[]"#), "duplicate field `present`"),
        (present("[3]"), "present names section 3; the sections of this block are 0 to 2"),
        (present("[0,15]"), "present names section 15; the sections"),
        (present("[16]"), "there is no section 16; sections are numbered 0 to 15"),
        (present("[-1]"), "there is no section -1"),
        (present("[9223372036854775807]"), "there is no section 9223372036854775807"),
        // 1e1 is the number 10.
        (present("[1e1]"), "present names section 10; the sections of this block are 0 to 2"),
        (present("[15e-1]"), "expected i64"),
        (present("[0,2,0]"), "section 0 a second time; each section is named once"),
        (present("[true]"), "boolean `true`"),
        (present("null"), "null, expected a list of section numbers"),
        (present("{}"), "map, expected a list of section numbers"),
        (present("2"), "integer `2`, expected a list of section numbers"),
        (quiet(r#""reset":256"#), "reset is 256; a verified number of trains is 0 to 255, or null"),
        (quiet(r#""reset":-1"#), "integer `-1`, expected u32"),
        (quiet(r#""reset":1.5"#), "floating point `1.5`, expected u32"),
        (quiet(r#""reset":"0""#), "string \"0\", expected u32"),
        (quiet(r#""reset":false"#), "boolean `false`, expected u32"),
        (quiet(r#""ahead_hold_sections":17"#), "ahead_hold_sections is 17; it must be 0 to 16 sections"),
        (quiet(r#""ahead_hold_sections":272"#), "ahead_hold_sections is 272; it must be"),
        (quiet(r#""ahead_hold_sections":-1"#), "integer `-1`, expected u32"),
        (quiet(r#""ahead_hold_sections":null"#), "null, expected u32"),
        (quiet(r#""ahead_entered":null"#), "null, expected a boolean"),
        (quiet(r#""ahead_entered":1"#), "integer `1`, expected a boolean"),
        (r#"{"step":{"detected_km_h":[]}}"#.to_owned(), "a step of block-count is {\"check_in\":false,"),
    ];
    let (start, reset) = (start(CONFIG), quiet(r#""reset":0"#));
    let enter = r#"{"step":{"check_in":true,"check_out":false,"present":[0]}}"#;
    let undisturbed = converse(&[&start, &reset, enter, enter, &quiet("")]);
    for (line, fragment) in cases {
        let replies = converse(&[&start, &reset, enter, &line, enter, &quiet("")]);
        assert_malformed(&replies[3], 4, &line, fragment);
        assert_eq!([&replies[..3], &replies[4..]].concat(), undisturbed, "{line}");
    }
}

/// The output of another implementation: in its order, without the field that is not asked for, and not with a wrong one.
#[test]
fn the_outputs_of_another_implementation_are_read() {
    let read = |text: &str| serde_json::from_str::<Output>(text);
    let ours =
        read(r#"{"occupied":[0,2],"behind_hold_sections":0,"agree":true,"count":2,"fault":null,"counting":true}"#);
    let ours = ours.expect("an output");
    let theirs = r#"{"occupied":[2,0],"behind_hold_sections":0,"agree":true,"count":2,"fault":null,"since":7}"#;
    assert_eq!(read(theirs).expect("an output"), ours);
    for (right, wrong) in [
        ("[2,0]", "[2]"),
        ("\"behind_hold_sections\":0", "\"behind_hold_sections\":1"),
        ("true", "false"),
        (":2,", ":1,"),
        ("null", "\"check-out-at-zero\""),
        ("\"since\":7", "\"counting\":false"),
    ] {
        assert_ne!(read(&theirs.replace(right, wrong)).expect("an output"), ours, "{wrong}");
    }
    for (right, wrong) in [
        ("[2,0]", "[2,2]"),
        ("[2,0]", "[16]"),
        ("null", "\"fault\""),
        ("null", "{\"check-out-at-zero\":null}"),
        (",\"fault\":null", ""),
    ] {
        assert!(read(&theirs.replace(right, wrong)).is_err(), "{wrong}");
    }
}

static SCHEMA: LazyLock<Validator> =
    LazyLock::new(|| jsonschema::validator_for(&atc_protocol::schema::schema()).expect("a schema"));

prop_compose! {
    fn case()(sections in 1..=16_u8)(
        max in 1..=sections,
        hold in 0..=16_u8,
        (cycle, pass) in (1..50_u32, 1..8_u32),
        cycles in prop::collection::vec((
            prop::bool::weighted(0.2), prop::bool::weighted(0.15), any::<[u16; 2]>(),
            prop::option::weighted(0.2, prop_oneof![5 => 0..3_u8, 1 => any::<u8>()]), 0..=16_u8, any::<bool>(),
        ), 1..60),
        sections in Just(sections),
    ) -> (Config, Vec<Input>) {
        let config = Config {
            sections: sections.into(), max_trains: max.into(), tail_hold_sections: hold.into(),
            cycle_ms: cycle, pass_ms: cycle * pass + cycle - 1,
        };
        let all = SectionSet::first(sections).bits();
        let inputs = cycles.into_iter().map(|(check_in, check_out, [one, other], reset, asked, ahead_entered)| {
            // Few detections at a time, and a right number as often as a wrong one.
            let present = one & other & one.rotate_left(5) & all;
            let right = u8::try_from(present.count_ones()).unwrap();
            Input {
                check_in, check_out, ahead_entered,
                present: SectionSet::from_bits(present),
                reset: reset.map(|number| TrainCount(if number == 2 { right } else { number })),
                ahead_hold: Hold::new(asked).unwrap(),
            }
        });
        (config, inputs.collect())
    }
}

/// What the kernel puts out, as it must stand on the wire; written without the oracle's own forms.
fn expected(config: &Config, inputs: &[Input]) -> Vec<Value> {
    let narrow = |number: u32| u8::try_from(number).unwrap();
    let hold = Hold::new(narrow(config.tail_hold_sections)).unwrap();
    let pass = atc_kernel::time::Ticks(u16::try_from(config.pass_ms / config.cycle_ms).unwrap());
    let block = Block::new(narrow(config.sections), narrow(config.max_trains), hold, pass).unwrap();
    let mut state = State::INITIAL;
    let outputs = inputs.iter().map(|input| {
        let (next, output) = step(block, state, *input);
        state = next;
        let status = format!("{:?}", output.status);
        let fault = match status.as_str() {
            "Fault(CheckOutAtZero)" => json!("check-out-at-zero"),
            "Fault(CheckInAtMaximum)" => json!("check-in-at-maximum"),
            "Fault(CheckInStaysOn)" => json!("check-in-stays-on"),
            _ => Value::Null,
        };
        json!({ "output": {
            "occupied": (0..16_u8).filter(|section| output.occupied.contains(*section)).collect::<Vec<_>>(),
            "behind_hold_sections": output.behind_hold.sections(),
            "agree": output.agree,
            "count": output.count.0,
            "fault": fault,
            "counting": status == "Counting",
        }})
    });
    outputs.collect()
}

proptest! {
    #[test]
    fn the_oracle_says_what_the_kernel_reports((config, inputs) in case()) {
        let lines = block_chart::lines(&config, &inputs);
        let lines: Vec<_> = lines.iter().map(|line| line.trim_end()).collect();
        let replies = converse(&lines);
        for line in lines.iter().copied().chain(replies.iter().map(String::as_str)) {
            let value: Value = serde_json::from_str(line).unwrap();
            prop_assert!(SCHEMA.is_valid(&value), "{}", value);
        }
        let replies: Vec<Value> = replies[1..].iter().map(|reply| serde_json::from_str(reply).unwrap()).collect();
        prop_assert_eq!(replies, expected(&config, &inputs));
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 12, ..ProptestConfig::default() })]

    /// The same through the real process and its pipes.
    #[test]
    fn the_process_says_what_the_kernel_reports((config, inputs) in case()) {
        let outputs = block_chart::process(device::oracle(), &config, &inputs);
        let outputs = outputs.map_err(|refused| TestCaseError::fail(refused.to_string()))?;
        let outputs: Vec<_> = outputs.iter().map(|output| json!({ "output": output })).collect();
        prop_assert_eq!(outputs, expected(&config, &inputs));
    }
}
