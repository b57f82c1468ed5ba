//! Protocol 1, line by line: every form that is right, and every way to be wrong with the reason that is given.

use atc_tests::session::{assert_malformed, converse, replies};
use serde_json::Value;

const ASPECT: &str = r#"{"start":{"protocol":1,"machine":"aspect-acceptance","config":{"cycle_ms":10,"aspects_km_h":[25,44.9,65,90],"operate_ms":20,"recovery_ms":20,"mask_ms":20,"interruption_ms":30,"shortened_operate_ms":10}}}"#;
const SUPERVISION: &str =
    r#"{"start":{"protocol":1,"machine":"speed-supervision","config":{"maximum_km_h":400,"release_margin_km_h":2}}}"#;

#[test]
fn a_session_of_both_machines() {
    let replies = converse(&[
        ASPECT,
        r#"{"step":{"detected_km_h":[44.9,90]}}"#,
        r#" { "step" : { "detected_km_h" : [ 9e1 , 44.90 ] } } "#,
        "{\"step\":{\"detected_km_h\":[]}}\r",
        r#"{"stop":{}}"#,
        SUPERVISION,
        r#"{"step":{"speed_km_h":44.9,"permitted_km_h":45}}"#,
        r#"{"step":{"speed_km_h":44.9,"permitted_km_h":45,"previous":"release"}}"#,
        r#"{"step":{"speed_km_h":45.1,"permitted_km_h":45}}"#,
        r#"{"step":{"speed_km_h":45.1,"permitted_km_h":null}}"#,
        r#"{"step":{"speed_km_h":null,"permitted_km_h":45}}"#,
        r#"{"step":{"speed_km_h":-0.1,"permitted_km_h":45}}"#,
        r#"{"step":{"speed_km_h":400.1,"permitted_km_h":1e300}}"#,
        r#"{"step":{"speed_km_h":1e400,"permitted_km_h":45}}"#,
        r#"{"step":{"speed_km_h":0,"permitted_km_h":0}}"#,
        r#"{"stop":{}}"#,
    ]);
    let expected = [
        r#"{"started":{"protocol":1,"machine":"aspect-acceptance","config":{"cycle_ms":10,"aspects_km_h":[25,44.9,65,90],"operate_ms":20,"recovery_ms":20,"mask_ms":20,"interruption_ms":30,"shortened_operate_ms":10},"cycles":{"interruption":3,"operate":2,"recovery":2,"recovery_and_mask":4,"shortened_operate":1,"tolerated_interruption":3}}}"#,
        r#"{"output":{"display_km_h":null}}"#,
        r#"{"output":{"display_km_h":44.9}}"#,
        r#"{"output":{"display_km_h":44.9}}"#,
        r#"{"stopped":{"steps":3}}"#,
        r#"{"started":{"protocol":1,"machine":"speed-supervision","config":{"maximum_km_h":400,"release_margin_km_h":2}}}"#,
        r#"{"output":{"brake":"service"}}"#,
        r#"{"output":{"brake":"release"}}"#,
        r#"{"output":{"brake":"service"}}"#,
        r#"{"output":{"brake":"emergency"}}"#,
        r#"{"output":{"brake":"emergency"}}"#,
        r#"{"output":{"brake":"emergency"}}"#,
        r#"{"output":{"brake":"emergency"}}"#,
        r#"{"output":{"brake":"emergency"}}"#,
        r#"{"output":{"brake":"release"}}"#,
        r#"{"stopped":{"steps":9}}"#,
    ];
    assert_eq!(replies, expected);
}

#[test]
fn the_configuration_has_defaults() {
    let start = r#"{"start":{"protocol":1,"machine":"aspect-acceptance","config":{"aspects_km_h":[25]}}}"#;
    let full = r#""config":{"cycle_ms":10,"aspects_km_h":[25],"operate_ms":300,"recovery_ms":400,"mask_ms":400,"interruption_ms":800,"shortened_operate_ms":100}"#;
    assert!(converse(&[start])[0].contains(full));
    for config in ["", r#","config":{}"#] {
        let start = format!(r#"{{"start":{{"protocol":1,"machine":"speed-supervision"{config}}}}}"#);
        assert!(converse(&[&start])[0].contains(r#""config":{"maximum_km_h":400,"release_margin_km_h":0}"#));
    }
}

/// A line in a case, and what its reason must say. None of them changes anything: the step after it is as before.
#[test]
fn every_malformed_line_in_aspect_acceptance() {
    let cases = [
        ("", "the line is empty"),
        ("   ", "the line is empty"),
        ("{", "EOF while parsing"),
        ("hello", "column 1: expected value"),
        ("[]", r#"a request is {"start":{…}}, {"step":{…}} or {"stop":{}}"#),
        ("null", "a request is"),
        ("7", "a request is"),
        (r#""stop""#, "a request is"),
        ("{}", "a request is"),
        (r#"{"halt":{}}"#, "unknown variant `halt`"),
        (r#"{"step":{"detected_km_h":[]},"stop":{}}"#, "a request is"),
        (r#"{"step":{"detected_km_h":[]}}{"stop":{}}"#, "trailing characters"),
        (r#"{"step":{"detected_km_h":[]},"step":{"detected_km_h":[]}}"#, "a request is"),
        (r#"{"step":null}"#, "column 9: expected an object, found null"),
        (r#"{"step":[[45]]}"#, "expected an object, found [[45]]"),
        (r#"{"step":{}}"#, "missing field `detected_km_h`"),
        (r#"{"step":{"detected_km_h":[],"extra":1}}"#, "unknown field `extra`"),
        (r#"{"step":{"detected_km_h":[],"detected_km_h":[]}}"#, "duplicate field `detected_km_h`"),
        (r#"{"step":{"detected_km_h":45}}"#, "expected a sequence"),
        (r#"{"step":{"detected_km_h":null}}"#, "expected a sequence"),
        (r#"{"step":{"detected_km_h":["45"]}}"#, "expected a number of km/h, found \"45\""),
        (r#"{"step":{"detected_km_h":[null]}}"#, "expected a number of km/h, found null"),
        (r#"{"step":{"detected_km_h":[44.95]}}"#, "44.95 km/h is not a whole number of tenths"),
        (r#"{"step":{"detected_km_h":[045]}}"#, "invalid number"),
        (r#"{"step":{"detected_km_h":[NaN]}}"#, "expected"),
        (
            r#"{"step":{"detected_km_h":[55]}}"#,
            "detected_km_h[0] is 55 km/h, which is not one of this line's aspects: 25, 44.9, 65, 90 km/h",
        ),
        (r#"{"step":{"detected_km_h":[25,-25]}}"#, "detected_km_h[1] is -25 km/h, which is not one"),
        (r#"{"step":{"detected_km_h":[1e400]}}"#, "which is not one"),
        (r#"{"step":{"detected_km_h":[25,90,25.0]}}"#, "detected_km_h[2] is 25 km/h a second time"),
        (
            r#"{"step":{"speed_km_h":1,"permitted_km_h":1}}"#,
            r#"a step of aspect-acceptance is {"detected_km_h":[45,90]}"#,
        ),
        (r#"{"stop":null}"#, "expected an object, found null"),
        (r#"{"stop":[]}"#, "expected an object, found []"),
        (r#"{"stop":{"now":true}}"#, "unknown field `now`"),
        (ASPECT, "a start inside a case of aspect-acceptance, which goes on"),
        ("\u{feff}{\"stop\":{}}", "a byte order mark"),
    ];
    check_malformed(ASPECT, r#"{"step":{"detected_km_h":[25]}}"#, &cases);
}

#[test]
fn every_malformed_line_in_speed_supervision() {
    let cases = [
        (r#"{"step":{"speed_km_h":1}}"#, "missing field `permitted_km_h`"),
        (r#"{"step":{"permitted_km_h":1}}"#, "missing field `speed_km_h`"),
        (
            r#"{"step":{"speed_km_h":44.95,"permitted_km_h":45}}"#,
            "column 27: 44.95 km/h is not a whole number of tenths",
        ),
        (r#"{"step":{"speed_km_h":"fast","permitted_km_h":45}}"#, "expected a number of km/h, found \"fast\""),
        (r#"{"step":{"speed_km_h":true,"permitted_km_h":45}}"#, "expected a number of km/h, found true"),
        (
            r#"{"step":{"speed_km_h":1,"permitted_km_h":1,"previous":"off"}}"#,
            r#"unknown brake "off", expected "release", "service" or "emergency""#,
        ),
        (r#"{"step":{"speed_km_h":1,"permitted_km_h":1,"previous":null}}"#, "invalid type: null"),
        (r#"{"step":{"speed_km_h":1,"permitted_km_h":1,"previous":{"service":null}}}"#, "invalid type: map"),
        (r#"{"step":{"speed_km_h":1,"speed_km_h":1,"permitted_km_h":1}}"#, "duplicate field `speed_km_h`"),
        (
            r#"{"step":{"detected_km_h":[]}}"#,
            r#"a step of speed-supervision is {"speed_km_h":44.9,"permitted_km_h":45}"#,
        ),
    ];
    let step = r#"{"step":{"speed_km_h":44,"permitted_km_h":45}}"#;
    check_malformed(SUPERVISION, step, &cases);
}

/// Outside a case; the starts among them are of the wrong form, not against a rule.
#[test]
fn every_malformed_line_outside_a_case() {
    let cases = [
        (r#"{"step":{"detected_km_h":[]}}"#, "a step before a start"),
        (r#"{"stop":{}}"#, "a stop without a start"),
        (r#"{"start":null}"#, "expected an object, found null"),
        (r#"{"start":[1,"speed-supervision",{}]}"#, "expected an object, found [1,"),
        (r#"{"start":{"machine":"speed-supervision"}}"#, "missing field `protocol`"),
        (r#"{"start":{"protocol":1}}"#, "missing field `machine`"),
        (r#"{"start":{"protocol":"1","machine":"speed-supervision"}}"#, "invalid type: string \"1\", expected u32"),
        (r#"{"start":{"protocol":1,"machine":"speed-supervision","mode":1}}"#, "unknown field `mode`"),
        (r#"{"start":{"protocol":1,"protocol":1,"machine":"speed-supervision"}}"#, "duplicate field `protocol`"),
        (
            r#"{"start":{"protocol":1,"machine":"speed-supervision","config":[400,0]}}"#,
            "expected an object, found [400,0]",
        ),
        (r#"{"start":{"protocol":1,"machine":"speed-supervision","config":{"maximum":1}}}"#, "unknown field `maximum`"),
        (
            r#"{"start":{"protocol":1,"machine":"speed-supervision","config":{"maximum_km_h":null}}}"#,
            "expected a number of km/h",
        ),
        (
            r#"{"start":{"protocol":1,"machine":"speed-supervision","config":{"release_margin_km_h":0.25}}}"#,
            "0.25 km/h is not a whole number of tenths",
        ),
        (r#"{"start":{"protocol":1,"machine":"aspect-acceptance"}}"#, "missing field `aspects_km_h`"),
        (
            r#"{"start":{"protocol":1,"machine":"aspect-acceptance","config":{"aspects_km_h":[25],"operate":1}}}"#,
            "unknown field `operate`",
        ),
        (
            r#"{"start":{"protocol":1,"machine":"aspect-acceptance","config":{"aspects_km_h":[25],"operate_ms":1,"operate_ms":1}}}"#,
            "duplicate field `operate_ms`",
        ),
        (
            r#"{"start":{"protocol":1,"machine":"aspect-acceptance","config":{"aspects_km_h":[25],"operate_ms":-1}}}"#,
            "invalid value: integer `-1`, expected u32",
        ),
        (
            r#"{"start":{"protocol":1,"machine":"aspect-acceptance","config":{"aspects_km_h":[25],"operate_ms":1.5}}}"#,
            "floating point `1.5`, expected u32",
        ),
        (
            r#"{"start":{"protocol":1,"machine":"aspect-acceptance","config":{"aspects_km_h":[25],"operate_ms":4294967296}}}"#,
            "integer `4294967296`, expected u32",
        ),
        (
            r#"{"start":{"protocol":1,"machine":"aspect-acceptance","config":{"aspects_km_h":[25],"operate_ms":null}}}"#,
            "invalid type: null, expected u32",
        ),
        (
            r#"{"start":{"protocol":1,"machine":"aspect-acceptance","config":{"aspects_km_h":[25.05]}}}"#,
            "25.05 km/h is not a whole number of tenths",
        ),
        (
            r#"{"start":{"protocol":1,"machine":"aspect-acceptance","config":{"aspects_km_h":25}}}"#,
            "a config of aspect-acceptance is {",
        ),
    ];
    for (line, fragment) in cases {
        let replies = converse(&[line]);
        assert_eq!(replies.len(), 1, "{line}");
        assert_malformed(&replies[0], 1, line, fragment);
    }
}

fn check_malformed(start: &str, step: &str, cases: &[(&str, &str)]) {
    // Without the bad line between them, and with it: the outputs are the same.
    let undisturbed = converse(&[start, step, step, step]);
    for (line, fragment) in cases {
        let replies = converse(&[start, step, line, step, step]);
        assert_eq!(replies.len(), 5, "{line}");
        assert_malformed(&replies[2], 3, line, fragment);
        assert_eq!([&replies[..2], &replies[3..]].concat(), undisturbed, "{line}");
    }
}

/// A start that breaks a rule, and what its reason must say. No case is open after it, and the next start is taken.
#[test]
fn every_broken_rule_is_named_with_its_numbers() {
    let aspect =
        |config: &str| format!(r#"{{"start":{{"protocol":1,"machine":"aspect-acceptance","config":{config}}}}}"#);
    let times = |times: &str| aspect(&format!(r#"{{"aspects_km_h":[25],{times}}}"#));
    let supervision =
        |config: &str| format!(r#"{{"start":{{"protocol":1,"machine":"speed-supervision","config":{config}}}}}"#);
    let train = |config: &str| format!(r#"{{"start":{{"protocol":1,"machine":"train","config":{config}}}}}"#);
    let cases = [
        (times(r#""cycle_ms":0"#), "cycle_ms is 0"),
        (times(r#""operate_ms":0"#), "operate_ms (T1) is 0"),
        (times(r#""recovery_ms":9"#), "recovery_ms (T2) is 9 ms, less than one cycle of 10 ms"),
        (times(r#""shortened_operate_ms":0"#), "shortened_operate_ms (T5) is 0"),
        (
            times(r#""shortened_operate_ms":291"#),
            "(T5) is 291 ms, 30 cycles of 10 ms, and operate_ms (T1) is 300 ms, 30 cycles",
        ),
        (times(r#""operate_ms":600001"#), "operate_ms (T1) is 600001 ms; it must be at most 60000 cycles, 600000 ms"),
        (times(r#""recovery_ms":300000,"mask_ms":300010"#), "(T2 + T3) is 600010 ms"),
        (times(r#""mask_ms":4294967295"#), "(T2 + T3) is 4294967695 ms"),
        (times(r#""interruption_ms":600010"#), "interruption_ms (T4) is 600010 ms"),
        (aspect(r#"{"aspects_km_h":[]}"#), "aspects_km_h is empty"),
        (aspect(r#"{"aspects_km_h":[1,2,3,4,5,6,7,8,9,10,11,12,13,14,15,16,17]}"#), "aspects_km_h has 17 entries"),
        (aspect(r#"{"aspects_km_h":[25,45,44.9]}"#), "aspects_km_h[2] is 44.9 km/h after 45 km/h"),
        (aspect(r#"{"aspects_km_h":[25,25]}"#), "aspects_km_h[1] is 25 km/h after 25 km/h"),
        (aspect(r#"{"aspects_km_h":[-5]}"#), "aspects_km_h[0] is -5 km/h; a permitted speed is 0 to 6553.5 km/h"),
        (aspect(r#"{"aspects_km_h":[0,6553.6]}"#), "aspects_km_h[1] is 6553.6 km/h"),
        (supervision(r#"{"maximum_km_h":0}"#), "maximum_km_h is 0"),
        (supervision(r#"{"maximum_km_h":-1}"#), "maximum_km_h is -1 km/h"),
        (supervision(r#"{"maximum_km_h":7000}"#), "maximum_km_h is 7000 km/h; it must be 0 to 6553.5"),
        (supervision(r#"{"release_margin_km_h":-0.1}"#), "release_margin_km_h is -0.1 km/h"),
        (
            supervision(r#"{"maximum_km_h":5,"release_margin_km_h":5.1}"#),
            "release_margin_km_h is 5.1 km/h, above maximum_km_h, 5 km/h",
        ),
        (
            train(r#"{"supervision":{"maximum_km_h":89.9}}"#),
            "permitted.speeds_km_h has 90 km/h, above supervision.maximum_km_h, 89.9 km/h",
        ),
        (train(r#"{"supervision":{"maximum_km_h":0}}"#), "supervision.maximum_km_h is 0"),
        (train(r#"{"permitted":{"fresh_ms":9}}"#), "permitted.fresh_ms is 9 ms, less than one cycle"),
        (train(r#"{"acceptance":{"operate_ms":0}}"#), "acceptance.operate_ms (T1) is 0"),
        (train(r#"{"codes":{"pairs":[]}}"#), "codes.pairs is empty"),
        (
            train(r#"{"codes":{"pairs":[{"main_hz":10,"sub_hz":12,"speed_km_h":30}]}}"#),
            "codes.pairs names 30 km/h for 10 and 12 Hz; it must be one of permitted.speeds_km_h: 0, 15, 25, 45",
        ),
        (
            train(
                r#"{"codes":{"pairs":[{"main_hz":10,"sub_hz":12,"speed_km_h":25},{"main_hz":11.5,"sub_hz":15,"speed_km_h":45}]}}"#,
            ),
            "codes.pairs has main_hz 10 and 11.5 Hz; they must be more than twice codes.tolerance_hz, 1 Hz, apart",
        ),
        (SUPERVISION.replace("\"protocol\":1", "\"protocol\":2"), "protocol 2 is not spoken here; protocol 1 is"),
        (
            SUPERVISION.replace("speed-supervision", "kettle"),
            "there is no machine \"kettle\" here; there are aspect-acceptance, speed-supervision",
        ),
    ];
    for (start, fragment) in cases {
        let replies = converse(&[&start, r#"{"step":{"detected_km_h":[]}}"#, ASPECT]);
        let reply: Value = serde_json::from_str(&replies[0]).expect("JSON");
        let reason = reply["rejected"]["reason"].as_str().unwrap_or_else(|| panic!("{start} was answered by {reply}"));
        assert!(reason.contains(fragment), "{start} was answered by {reason:?}, without {fragment:?}");
        assert!(replies[1].contains("a step before a start"), "{start} left a case open");
        assert!(replies[2].starts_with("{\"started\""), "{start} closed the session");
    }
}

#[test]
fn bytes_that_are_not_text_are_malformed() {
    let replies = replies(b"{\"stop\":\xff{}}\n\x00\n\xed\xa0\x80\n");
    assert_eq!(replies.len(), 3);
    assert_malformed(&replies[0], 1, "invalid UTF-8", "column 9: this is not UTF-8");
    assert_malformed(&replies[1], 2, "a zero byte", "expected value");
    assert_malformed(&replies[2], 3, "a lone surrogate", "column 1: this is not UTF-8");
}

#[test]
fn a_line_that_is_too_long_is_passed_over() {
    let longest = atc_protocol::MAX_LINE;
    for length in [longest - 1, longest, longest + 1, longest + 2, 3 * longest] {
        let step = r#"{"step":{"detected_km_h":[25]}}"#;
        let padded = format!("{step}{}", " ".repeat(length - step.len()));
        let replies = converse(&[ASPECT, step, &padded, step]);
        assert_eq!(replies.len(), 4);
        let taken = length <= longest;
        assert_eq!(replies[2].starts_with("{\"output\""), taken, "{length} bytes: {}", replies[2]);
        if !taken {
            assert_malformed(&replies[2], 3, "a long line", "longer than 1048576 bytes");
        }
        assert_eq!(replies[3], r#"{"output":{"display_km_h":25}}"#);
        // The same as the last line, without its newline.
        assert_eq!(converse(&[ASPECT, step, &padded])[2].starts_with("{\"output\""), taken);
    }
}

#[test]
fn deep_nesting_is_an_answer_and_not_a_crash() {
    for (open, close) in [("[", "]"), ("{\"a\":", "}")] {
        let deep = format!("{}1{}", open.repeat(100_000), close.repeat(100_000));
        for line in [deep.clone(), format!("{{\"step\":{deep}}}"), format!("{{\"step\":{{\"detected_km_h\":{deep}}}}}")]
        {
            let replies = converse(&[ASPECT, &line]);
            assert!(replies[1].starts_with("{\"malformed\""), "{}", &replies[1][..200.min(replies[1].len())]);
        }
    }
}

#[test]
fn the_last_line_needs_no_newline_and_an_empty_input_has_no_reply() {
    assert_eq!(replies(b"").len(), 0);
    assert_eq!(replies(b"\n").len(), 1);
    assert_eq!(replies(b"{\"stop\":{}}").len(), 1);
    assert_eq!(replies(b"{\"stop\":{}}\n").len(), 1);
}
