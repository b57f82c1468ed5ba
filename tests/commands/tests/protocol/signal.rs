//! Machines `telegram-codec`, `braking-pattern`, `permitted-speed` and `train-position` of protocol 1: sessions, the outputs
//! of other implementations, and the schema of what was said.

use std::sync::LazyLock;

use atc_protocol::machine::{permitted, position, telegram};
use atc_tests::session::{FRAME, MAIN, SUB, converse, position_config, replies, start, step};
use atc_tests::{approach, device, ground};
use jsonschema::Validator;
use serde_json::Value;

#[test]
fn a_session_with_the_codec() {
    let decode = |bits: &str| step(&format!(r#"{{"decode":"{bits}"}}"#));
    let bits = |bits: &str| step(&format!(r#"{{"bits":"{bits}"}}"#));
    let flipped = |place: usize| {
        let mut bits = FRAME.as_bytes().to_vec();
        bits[place] ^= 1;
        String::from_utf8(bits).expect("ASCII")
    };
    let replies = converse(&[
        r#"{"start":{"protocol":1,"machine":"telegram-codec"}}"#,
        &step(&format!(r#"{{"encode":{{"main":{MAIN}}}}}"#)),
        &decode(FRAME),
        &decode(&flipped(0)),
        &decode(&flipped(24)),
        &decode(&flipped(90)),
        &bits(&format!("10.{FRAME}")),
        &bits(&FRAME[..50]),
        &bits(""),
        &bits(&format!("{}{FRAME}.", &FRAME[50..])),
        &bits(&format!("{}.{}", &FRAME[..50], &FRAME[50..])),
        &step(
            r#"{"encode":{"sub":{"section":65535,"counter":255,"length_m":1,"gradient_permille":-128,"curve_rank":15,"restriction_rank":0}}}"#,
        ),
        r#"{"stop":{}}"#,
    ]);
    let found = |last: u32| format!(r#"{{"last_bit":{last},"telegram":{{"main":{MAIN}}}}}"#);
    let expected = [
        r#"{"started":{"protocol":1,"machine":"telegram-codec","config":{}}}"#.to_owned(),
        format!(r#"{{"output":{{"frame":"{FRAME}"}}}}"#),
        format!(r#"{{"output":{{"telegram":{{"main":{MAIN}}}}}}}"#),
        r#"{"output":{"error":"synchronisation"}}"#.to_owned(),
        r#"{"output":{"error":"guard"}}"#.to_owned(),
        r#"{"output":{"error":"check"}}"#.to_owned(),
        format!(r#"{{"output":{{"telegrams":[{}]}}}}"#, found(108)),
        r#"{"output":{"telegrams":[]}}"#.to_owned(),
        r#"{"output":{"telegrams":[]}}"#.to_owned(),
        format!(r#"{{"output":{{"telegrams":[{},{}]}}}}"#, found(214), found(320)),
        r#"{"output":{"telegrams":[]}}"#.to_owned(),
    ];
    assert_eq!(replies[..11], expected);
    assert!(replies[11].starts_with(r#"{"output":{"frame":"0111111111111110010100110"#), "{}", replies[11]);
    assert_eq!(replies[12], r#"{"stopped":{"steps":11}}"#);
    // A frame whose check fits and that says nothing: eight bytes of 0.
    let [high, low] = atc_kernel::telegram::check([0; 8]).to_be_bytes();
    let nothing = format!("{}{}{high:08b}0{low:08b}0", &FRAME[..16], "0".repeat(72));
    let replies = converse(&[r#"{"start":{"protocol":1,"machine":"telegram-codec"}}"#, &decode(&nothing)]);
    assert_eq!(replies[1], r#"{"output":{"error":"content"}}"#);
}

#[test]
fn a_session_with_the_pattern() {
    let replies = converse(&[
        r#"{"start":{"protocol":1,"machine":"braking-pattern"}}"#,
        &step(r#"{"distance_m":250}"#),
        &step(r#"{"distance_m":249,"gradient_permille":0}"#),
        &step(r#"{"distance_m":250,"gradient_permille":-12}"#),
        &step(r#"{"distance_m":65535,"gradient_permille":127}"#),
        &step(r#"{"distance_m":65535,"gradient_permille":-128}"#),
    ]);
    let speeds = ["72", "71.8", "66.4", "409.5", "0"].map(|speed| format!(r#"{{"output":{{"speed_km_h":{speed}}}}}"#));
    assert_eq!(replies[0], r#"{"started":{"protocol":1,"machine":"braking-pattern","config":{"brake_mm_s2":800}}}"#);
    assert_eq!(replies[1..], speeds);
}

#[test]
fn a_session_with_the_permitted_speed() {
    let main = |counter: u32| MAIN.replace("\"counter\":1", &format!("\"counter\":{counter}"));
    let sub = |counter: u32| SUB.replace("\"counter\":1", &format!("\"counter\":{counter}"));
    let replies = converse(&[
        &start("permitted-speed", r#"{"cycle_ms":500,"margin_m":0}"#),
        &step(r#"{"analog_km_h":75,"moved_m":0}"#),
        &step(&format!(r#"{{"analog_km_h":75,"moved_m":1.5,"main":{},"sub":{}}}"#, main(1), sub(1))),
        &step(r#"{"analog_km_h":75,"moved_m":1.5,"to_exit_m":101.5,"main":null,"sub":null,"line":null}"#),
        &step(&format!(r#"{{"analog_km_h":75,"moved_m":1.5,"main":{}}}"#, main(2))),
        &step(&format!(r#"{{"analog_km_h":75,"moved_m":0.001,"sub":{}}}"#, sub(2))),
        &step(r#"{"analog_km_h":null,"moved_m":0}"#),
        &step(r#"{"analog_km_h":15,"moved_m":0}"#),
        &step(r#"{"analog_km_h":75,"moved_m":0}"#),
        &step(r#"{"analog_km_h":75,"moved_m":0,"line":"analog"}"#),
        &step(r#"{"analog_km_h":null,"moved_m":0,"speed_km_h":12.3}"#),
    ]);
    let empty = r#"{"line":"digital","section":null,"to_stop_m":null,"main_age_ms":null,"sub":[]}"#;
    let after = |to_stop: &str, age: u32, sub: &str| {
        format!(r#"{{"line":"digital","section":7,"to_stop_m":{to_stop},"main_age_ms":{age},"sub":[{sub}]}}"#)
    };
    let known = |age: u32| format!(r#"{{"section":7,"age_ms":{age}}}"#);
    let expected = [
        format!(r#"{{"output":{{"speed_km_h":0,"basis":"nothing","state":{empty}}}}}"#),
        format!(r#"{{"output":{{"speed_km_h":0,"basis":"nothing","state":{empty}}}}}"#),
        format!(r#"{{"output":{{"speed_km_h":0,"basis":"nothing","state":{empty}}}}}"#),
        format!(r#"{{"output":{{"speed_km_h":25,"basis":"both","state":{}}}}}"#, after("500", 1000, "")),
        // The rank of the main telegram is 55 km/h.
        format!(r#"{{"output":{{"speed_km_h":55,"basis":"both","state":{}}}}}"#, after("499.999", 1500, &known(1500))),
        format!(
            r#"{{"output":{{"speed_km_h":55,"basis":"pattern","state":{}}}}}"#,
            after("499.999", 2000, &known(2000))
        ),
        format!(
            r#"{{"output":{{"speed_km_h":15,"basis":"running-down","state":{}}}}}"#,
            after("499.999", 2500, &known(2500))
        ),
        format!(
            r#"{{"output":{{"speed_km_h":55,"basis":"running-down","state":{}}}}}"#,
            after("499.999", 3000, &known(3000))
        ),
        format!(
            r#"{{"output":{{"speed_km_h":75,"basis":"analog","state":{}}}}}"#,
            after("499.999", 3500, &known(3500))
        )
        .replace("\"digital\"", "\"analog\""),
        format!(
            r#"{{"output":{{"speed_km_h":null,"basis":"nothing","state":{}}}}}"#,
            after("499.999", 4000, &known(4000))
        )
        .replace("\"digital\"", "\"analog\""),
    ];
    assert!(replies[0].ends_with(r#""cycles":{"fixed_life":20,"fresh":4,"life":10,"memory":4}}}"#), "{}", replies[0]);
    assert_eq!(replies[1..], expected);
}

#[test]
fn a_session_with_the_position() {
    let replies = converse(&[
        &start("train-position", &position_config("")),
        &step(r#"{"first_db":-21.5,"second_db":-24.25,"moved_m":[0,0]}"#),
        &step(r#"{"first_db":-21.5,"second_db":-24.25,"moved_m":[1.4,1.6],"truth_m":80}"#),
        &step(r#"{"first_db":-21.5,"second_db":null,"moved_m":[1.4,1.6]}"#),
        &step(r#"{"first_db":-61,"second_db":-62,"moved_m":[-1,0.001]}"#),
    ]);
    assert!(replies[0].ends_with(r#""tolerance_db":0.1,"floor_db":-60,"correction_db":[0,0]}}}"#), "{}", replies[0]);
    let expected = ["[65.2,151.1]", "[65.2,149.7]", "null", "null"];
    assert_eq!(replies[1..], expected.map(|interval| format!(r#"{{"output":{{"interval_m":{interval}}}}}"#)));
}

/// The output of another implementation: in its order, without what is not asked for, and not with something wrong.
#[test]
fn the_outputs_of_another_implementation_are_read() {
    let permitted = |text: &str| serde_json::from_str::<permitted::Output>(text);
    let ours = r#"{"speed_km_h":45,"basis":"both","state":{"line":"digital","section":7,"to_stop_m":1.5,"main_age_ms":0,"sub":[]}}"#;
    let ours = permitted(ours).expect("an output");
    let theirs = r#"{"basis":"both","brake":false,"speed_km_h":45.0}"#;
    assert_eq!(permitted(theirs).expect("an output"), ours);
    for (right, wrong) in [("45.0", "44.9"), ("45.0", "null"), ("both", "pattern")] {
        assert_ne!(permitted(&theirs.replace(right, wrong)).expect("an output"), ours, "{wrong}");
    }
    for (right, wrong) in [("\"both\"", "\"neither\""), ("\"both\"", "{\"both\":null}"), (",\"speed_km_h\":45.0", "")] {
        assert!(permitted(&theirs.replace(right, wrong)).is_err(), "{wrong}");
    }
    let position = |text: &str| serde_json::from_str::<position::Output>(text);
    assert_eq!(
        position(r#"{"interval_m":[1.0,2],"since":3}"#).expect("one"),
        position(r#"{"interval_m":[1,2]}"#).expect("one")
    );
    assert!(position("{}").is_err() && position(r#"{"interval_m":[1]}"#).is_err());
    let codec = |text: &str| serde_json::from_str::<telegram::Output>(text);
    assert!(codec(r#"{"error":"check","bits":106}"#).is_ok());
    assert!(
        codec(r#"{"error":{"check":null}}"#).is_err()
            && codec(r#"{"error":"parity"}"#).is_err()
            && codec("{}").is_err()
    );
}

static SCHEMA: LazyLock<Validator> =
    LazyLock::new(|| jsonschema::validator_for(&atc_protocol::schema::schema()).expect("a schema"));

/// Long sessions through the real process: the same replies as in process, and every line of both sides fits the schema.
#[test]
fn long_sessions_through_the_process() {
    let codec = include_str!("../../../../oracle/examples/telegram-codec.jsonl");
    let pattern = include_str!("../../../../oracle/examples/braking-pattern.jsonl");
    let both = format!("{}{}", ground::lines(ground::Train::New), ground::lines(ground::Train::Conventional));
    for requests in [codec, pattern, &both, &approach::lines()] {
        let said = device::converse(device::oracle(), requests.as_bytes().to_vec()).expect("a session");
        assert_eq!(said, replies(requests.as_bytes()));
        assert_eq!(said.len(), requests.lines().count());
        for line in requests.lines().chain(said.iter().map(String::as_str)) {
            assert!(!line.starts_with("{\"malformed\"") && !line.starts_with("{\"rejected\""), "{line}");
            let value: Value = serde_json::from_str(line).expect("JSON");
            assert!(SCHEMA.is_valid(&value), "{line}");
        }
    }
}

/// What the schema refuses.
#[test]
fn the_schema_refuses() {
    for line in [
        step(r#"{"encode":{"main":{"section":7,"counter":256,"beyond_exit_m":400,"speed_rank":4}}}"#),
        step(r#"{"encode":{"main":{"section":7,"counter":1,"speed_rank":4}}}"#),
        step(r#"{"bits":"012"}"#),
        step(r#"{"decode":"01"}"#),
        step(r#"{"distance_m":65536}"#),
        step(r#"{"analog_km_h":45}"#),
        step(r#"{"analog_km_h":45,"moved_m":1,"line":"mixed"}"#),
        step(r#"{"first_db":1,"second_db":2,"moved_m":[1]}"#),
        start("train-position", &position_config("").replacen("0,0.5,", "0.5,", 1)),
        start("braking-pattern", r#"{"brake_mm_s2":0}"#),
        r#"{"output":{"error":"parity"}}"#.to_owned(),
    ] {
        assert!(!SCHEMA.is_valid(&serde_json::from_str(&line).expect("JSON")), "{line}");
    }
}
