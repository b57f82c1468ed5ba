//! Machines `telegram-codec`, `braking-pattern`, `permitted-speed` and `train-position` of protocol 1: every way to be wrong, with the
//! reason that is given, and that nothing is disturbed by it.

use atc_tests::session::{FRAME, MAIN, SUB, TABLE, assert_malformed, converse, position_config, start, step};
use serde_json::{Value, json};

/// A start that breaks a rule, and what its reason must say. No case is open after it.
#[test]
fn every_rejected_start() {
    let permitted = |config: &str| start("permitted-speed", config);
    let position = |right: &str, wrong: &str| start("train-position", &position_config("").replacen(right, wrong, 1));
    let flat = format!(r#"{{"spacing_m":25.6,"lowest_db":{0},"highest_db":{0}}}"#, json!(vec![1; 17]));
    let cases = [
        (start("braking-pattern", r#"{"brake_mm_s2":0}"#), "brake_mm_s2 is 0; it must be 1 to 4095 mm/s²"),
        (start("braking-pattern", r#"{"brake_mm_s2":4096}"#), "brake_mm_s2 is 4096; it must be 1 to"),
        (permitted(r#"{"cycle_ms":0}"#), "cycle_ms is 0; a logic cycle is 1 ms or more"),
        (permitted(r#"{"speeds_km_h":[]}"#), "speeds_km_h is empty; it must name 1 to 16 speeds"),
        (permitted(r#"{"speeds_km_h":[1,2,3,4,5,6,7,8,9,10,11,12,13,14,15,16,17]}"#), "speeds_km_h has 17 entries"),
        (
            permitted(r#"{"speeds_km_h":[15,15]}"#),
            "speeds_km_h[1] is 15 km/h after 15 km/h; the speeds must rise strictly",
        ),
        (permitted(r#"{"speeds_km_h":[-1]}"#), "speeds_km_h[0] is -1 km/h; it must be 0 to 6553.5 km/h"),
        (
            permitted(r#"{"speeds_km_h":[15,90]}"#),
            "lowest_limit_km_h is 25 km/h; it must be one of speeds_km_h: 15, 90 km/h",
        ),
        (permitted(r#"{"lowest_limit_km_h":-25}"#), "lowest_limit_km_h is -25 km/h; it must be one of"),
        (permitted(r#"{"brake_mm_s2":70000}"#), "brake_mm_s2 is 70000"),
        (
            permitted(r#"{"worst_gradient_permille":-129}"#),
            "worst_gradient_permille is -129; it must be -128 to 127 thousandths",
        ),
        (permitted(r#"{"margin_m":65536}"#), "margin_m is 65536; it must be 0 to 65535 m"),
        (permitted(r#"{"fresh_ms":9}"#), "fresh_ms is 9 ms, less than one cycle of 10 ms; it must be 10 ms or more"),
        (
            permitted(r#"{"life_ms":2190}"#),
            "life_ms is 2190 ms and fresh_ms 2200 ms, 219 and 220 cycles of 10 ms; life_ms must not be shorter",
        ),
        (permitted(r#"{"fixed_life_ms":9}"#), "fixed_life_ms is 9 ms, less than one cycle"),
        (permitted(r#"{"memory_ms":0}"#), "memory_ms is 0 ms, less than one cycle"),
        (permitted(r#"{"life_ms":600010}"#), "life_ms is 600010 ms; it must be at most 60000 cycles, 600000 ms"),
        (permitted(r#"{"fresh_ms":4294967295}"#), "fresh_ms is 4294967295 ms; it must be at most"),
        (permitted(r#"{"fixed_life_ms":600010}"#), "fixed_life_ms is 600010 ms; it must be at most"),
        (permitted(r#"{"memory_ms":600010}"#), "memory_ms is 600010 ms; it must be at most"),
        (
            permitted(r#"{"memory_ms":5010}"#),
            "memory_ms is 5010 ms, longer than life_ms, 5000 ms, or fixed_life_ms, 10000 ms; it must not be longer than either",
        ),
        (permitted(r#"{"window":0}"#), "window is 0; the counter may advance by at least 1 and at most 127"),
        (permitted(r#"{"window":128}"#), "window is 128; the counter"),
        (permitted(r#"{"window":257}"#), "window is 257; the counter"),
        (permitted(r#"{"run":0}"#), "run is 0; 1 to 15 telegrams in a row must have advanced"),
        (permitted(r#"{"run":16}"#), "run is 16; 1 to 15"),
        (
            position("25.6", "25"),
            "table.spacing_m is 25 m; it must be 1.6, 3.2, 6.4, 12.8, 25.6, 51.2, 102.4 or 204.8 m",
        ),
        (position("[0,0.5,", "[0.5,"), "table.lowest_db has 16 values; it must have 17"),
        (position("15,16]", "15,16,17]"), "table.highest_db has 18 values; it must have 17"),
        (
            position("0.5", "1.01"),
            "table.lowest_db[1] is 1.01 dB and table.highest_db[1] 1 dB; the lowest must not be above",
        ),
        (position("0.5", "-400"), "table.lowest_db[1] is -400 dB; it must be -327.68 to 327.67 dB"),
        (position(TABLE, &flat), "in table no two neighbours rise both in lowest_db and in highest_db"),
        (position("0.1", "-0.1"), "tolerance_db is -0.1 dB; it must be 0 or more"),
        (position("-60", "-60000"), "floor_db is -60000 dB; it must be"),
        (
            position("-60}", r#"-60,"correction_db":[1,0]}"#),
            "correction_db is [1, 0]; the least must stand before the most",
        ),
        (position("-60}", r#"-60,"correction_db":[0,400]}"#), "correction_db[1] is 400 dB; it must be"),
    ];
    for (line, fragment) in cases {
        let replies = converse(&[&line, &step("{}")]);
        let reply: Value = serde_json::from_str(&replies[0]).expect("JSON");
        let reason = reply["rejected"]["reason"].as_str().unwrap_or_else(|| panic!("{line} was answered by {reply}"));
        assert!(reason.contains(fragment), "{line} was rejected with {reason:?}, without {fragment:?}");
        assert!(replies[1].contains("a step before a start"));
    }
}

#[test]
fn every_malformed_start() {
    let position = |config: &str| start("train-position", config);
    let cases = [
        (start("telegram-codec", r#"{"carrier":1}"#), "unknown field `carrier`"),
        (start("telegram-codec", "[]"), "expected an object, found []"),
        (start("braking-pattern", r#"{"brake_mm_s2":-1}"#), "integer `-1`, expected u32"),
        (start("braking-pattern", r#"{"gradient":0}"#), "unknown field `gradient`"),
        (start("permitted-speed", r#"{"speeds_km_h":null}"#), "null, expected a sequence"),
        (start("permitted-speed", r#"{"speeds_km_h":[0.05]}"#), "0.05 km/h is not a whole number of tenths"),
        (start("permitted-speed", r#"{"run":1,"run":1}"#), "duplicate field `run`"),
        (start("permitted-speed", r#"{"speed":1}"#), "unknown field `speed`"),
        (position("{}"), "missing field `table`"),
        (position(&format!(r#"{{"table":{TABLE}}}"#)), "missing field `tolerance_db`"),
        (position(&format!(r#"{{"table":{TABLE},"tolerance_db":0}}"#)), "missing field `floor_db`"),
        (position(&position_config(r#","correction_db":[0]"#)), "invalid length 1"),
        (position(&position_config(r#","correction_db":[0,0,0]"#)), "trailing characters"),
        (position(&position_config(r#","knots":17"#)), "unknown field `knots`"),
        (
            position(&position_config("").replace("0.5", "0.505")),
            "0.505 is not a whole number of hundredths of a decibel",
        ),
        (position(&position_config("").replace("25.6", "\"25.6\"")), "expected a number of metres, found"),
    ];
    for (line, fragment) in cases {
        assert_malformed(&converse(&[&line])[0], 1, &line, fragment);
    }
    assert_malformed(
        &converse(&[&position("{}")])[0],
        1,
        "{}",
        "a config of train-position is {\"table\":{\"spacing_m\":25.6",
    );
}

/// A line in a case, and what its reason must say. None of them changes anything: the outputs after it are as before.
#[test]
fn every_malformed_step() {
    let main = |right: &str, wrong: &str| format!(r#"{{"encode":{{"main":{}}}}}"#, MAIN.replacen(right, wrong, 1));
    let sub = |right: &str, wrong: &str| format!(r#"{{"encode":{{"sub":{}}}}}"#, SUB.replacen(right, wrong, 1));
    let codec = (start("telegram-codec", "{}"), step(&format!(r#"{{"bits":"{}"}}"#, &FRAME[..53])));
    let codec_after = step(&format!(r#"{{"bits":"{}"}}"#, &FRAME[53..]));
    let codec_cases = [
        ("{}".to_owned(), "a step of telegram-codec is {\"encode\":"),
        (r#"{"encode":{}}"#.to_owned(), "expected value"),
        (r#"{"encode":{"aux":{}}}"#.to_owned(), "unknown variant `aux`, expected `main` or `sub`"),
        (r#"{"send":1}"#.to_owned(), "unknown variant `send`"),
        (r#"{"bits":"0","decode":"0"}"#.to_owned(), "expected value"),
        (r#"{"bits":[0,1]}"#.to_owned(), "expected a string"),
        (format!(r#"{{"bits":"{}2"}}"#, &FRAME[53..]), "bits has '2' at place 53; a bit time is 0, 1, or \".\""),
        (r#"{"bits":"0 1"}"#.to_owned(), "bits has ' ' at place 1"),
        (r#"{"decode":"01"}"#.to_owned(), "decode has 2 characters; a frame has 106, each 0 or 1"),
        (format!(r#"{{"decode":"{FRAME}0"}}"#), "decode has 107 characters"),
        (
            format!(r#"{{"decode":"{}"}}"#, FRAME.replacen('1', ".", 1)),
            "decode has '.' at place 1; a bit of a frame is 0 or 1",
        ),
        (main("\"section\":7", "\"section\":65536"), "main.section is 65536; it must be 0 to 65535"),
        (main("\"counter\":1", "\"counter\":256"), "main.counter is 256; it must be 0 to 255"),
        (main("400", "65536"), "main.beyond_exit_m is 65536; it must be 0 to 65535 m"),
        (main("400", "0.5"), "floating point `0.5`, expected u32"),
        (main("\"beyond_exit_m\":400,", ""), "missing field `beyond_exit_m`"),
        (main("\"speed_rank\":4", "\"speed_rank\":16"), "main.speed_rank is 16; a rank is 0 to 15"),
        (main("}", ",\"route\":1}"), "unknown field `route`"),
        (sub("\"section\":7", "\"section\":65536"), "sub.section is 65536"),
        (sub("\"counter\":1", "\"counter\":-1"), "integer `-1`, expected u32"),
        (sub("250", "0"), "sub.length_m is 0; it must be 1 to 65535 m"),
        (sub("250", "65536"), "sub.length_m is 65536; it must be"),
        (sub("-12", "-129"), "sub.gradient_permille is -129; it must be -128 to 127 thousandths"),
        (sub("\"curve_rank\":6", "\"curve_rank\":16"), "sub.curve_rank is 16; a rank is 0 to 15"),
        (sub("\"restriction_rank\":7", "\"restriction_rank\":99"), "sub.restriction_rank is 99; a rank"),
    ];
    undisturbed(&codec.0, &codec.1, &codec_after, &codec_cases);

    let pattern_cases = [
        ("{}".to_owned(), "missing field `distance_m`"),
        (r#"{"distance_m":65536}"#.to_owned(), "distance_m is 65536; it must be 0 to 65535 m"),
        (r#"{"distance_m":-1}"#.to_owned(), "integer `-1`, expected u32"),
        (r#"{"distance_m":1,"gradient_permille":128}"#.to_owned(), "gradient_permille is 128; it must be -128 to 127"),
        (r#"{"distance_m":1,"gradient_permille":null}"#.to_owned(), "null, expected i32"),
        (r#"{"distance":1}"#.to_owned(), "unknown field `distance`"),
    ];
    let question = step(r#"{"distance_m":250}"#);
    undisturbed(&start("braking-pattern", "{}"), &question, &question, &pattern_cases);

    let heard = |more: &str| format!(r#"{{"analog_km_h":45,"moved_m":1{more}}}"#);
    let telegram = |kind: &str, body: &str| heard(&format!(r#","{kind}":{body}"#));
    let permitted_cases = [
        (r#"{"moved_m":1}"#.to_owned(), "missing field `analog_km_h`"),
        (r#"{"analog_km_h":45}"#.to_owned(), "missing field `moved_m`"),
        (r#"{"analog_km_h":6553.6,"moved_m":1}"#.to_owned(), "analog_km_h is 6553.6 km/h; it must be 0 to 6553.5 km/h"),
        (r#"{"analog_km_h":-1,"moved_m":1}"#.to_owned(), "analog_km_h is -1 km/h"),
        (r#"{"analog_km_h":45,"moved_m":-0.001}"#.to_owned(), "moved_m is -0.001 m; it must be 0 to 4294967.295 m"),
        (r#"{"analog_km_h":45,"moved_m":4294967.296}"#.to_owned(), "moved_m is 4294967.296 m; it must be"),
        (r#"{"analog_km_h":45,"moved_m":null}"#.to_owned(), "expected a number of metres, found null"),
        (r#"{"analog_km_h":45,"moved_m":0.0005}"#.to_owned(), "0.0005 is not a whole number of millimetres"),
        (heard(r#","to_exit_m":-5"#), "to_exit_m is -5 m; it must be 0 to 4294967.295 m"),
        (heard(r#","line":"mixed""#), "unknown kind of line \"mixed\", expected one of \"analog\", \"digital\""),
        (heard(r#","line":{"analog":null}"#), "map, expected a string"),
        (heard(r#","exit":1"#), "unknown field `exit`"),
        (telegram("main", &MAIN.replace(":1,", ":256,")), "main.counter is 256"),
        (telegram("sub", &SUB.replace("250", "0")), "sub.length_m is 0"),
        (telegram("main", "{}"), "missing field `section`"),
    ];
    undisturbed(&start("permitted-speed", "{}"), &step(&telegram("main", MAIN)), &step(&heard("")), &permitted_cases);

    let levels = |levels: &str| format!(r#"{{{levels},"moved_m":[0,1]}}"#);
    let moved = |moved: &str| format!(r#"{{"first_db":-20,"second_db":-22,"moved_m":{moved}}}"#);
    let position_cases = [
        (levels(r#""first_db":-20"#), "missing field `second_db`"),
        (r#"{"first_db":-20,"second_db":-22}"#.to_owned(), "missing field `moved_m`"),
        (levels(r#""first_db":-327.69,"second_db":0"#), "first_db is -327.69 dB; it must be -327.68 to 327.67 dB"),
        (levels(r#""first_db":0,"second_db":327.68"#), "second_db is 327.68 dB; it must be"),
        (levels(r#""first_db":0.001,"second_db":0"#), "0.001 is not a whole number of hundredths of a decibel"),
        (moved("[2,1]"), "moved_m is [2, 1]; the least must stand before the most"),
        (moved("[0,32.768]"), "moved_m has 32.768 m; in one cycle a train moves by -32.768 to 32.767 m"),
        (moved("[-32.769,0]"), "moved_m has -32.769 m"),
        (moved("[0]"), "invalid length 1"),
        (moved("1"), "integer `1`, expected"),
        (moved("[0,1],\"truth\":1"), "unknown field `truth`"),
    ];
    let measured = step(&moved("[0.5,1]"));
    undisturbed(&start("train-position", &position_config("")), &measured, &measured, &position_cases);
}

fn undisturbed(start: &str, before: &str, after: &str, cases: &[(String, &str)]) {
    let expected = converse(&[start, before, after]);
    assert!(expected[1..].iter().all(|reply| reply.starts_with("{\"output\"")), "{expected:?}");
    for (body, fragment) in cases {
        let line = step(body);
        let replies = converse(&[start, before, &line, after]);
        assert_malformed(&replies[2], 3, &line, fragment);
        assert_eq!([&replies[..2], &replies[3..]].concat(), expected, "{line}");
    }
}
