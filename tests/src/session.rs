//! Sessions of protocol 1 in this process: request lines, the oracle's replies to them, and the pieces that the requests of several
//! tests have in common.

use serde_json::{Value, json};

/// The replies to these bytes, line by line.
///
/// # Panics
/// If the last reply has no end of line.
pub fn replies(input: &[u8]) -> Vec<String> {
    let mut output = Vec::new();
    atc_oracle::serve(input, &mut output).expect("memory can be read and written");
    assert!(output.is_empty() || output.ends_with(b"\n"), "a reply without an end");
    String::from_utf8(output).expect("UTF-8").lines().map(str::to_owned).collect()
}

/// The replies to these lines.
pub fn converse(lines: &[&str]) -> Vec<String> {
    replies(lines.join("\n").as_bytes())
}

/// The start of a case with a configuration as JSON.
pub fn start(machine: &str, config: &str) -> String {
    format!(r#"{{"start":{{"protocol":1,"machine":"{machine}","config":{config}}}}}"#)
}

/// A step as JSON.
pub fn step(body: &str) -> String {
    format!(r#"{{"step":{body}}}"#)
}

/// A case as lines: its start, and its steps, each given as JSON.
pub fn case(machine: &str, config: &Value, steps: impl Iterator<Item = String>) -> (String, String) {
    let start = json!({"start": {"protocol": 1, "machine": machine, "config": config}});
    (format!("{start}\n"), steps.map(|body| step(&body) + "\n").collect())
}

/// A case as lines from its start to its stop.
pub fn whole(case: &(String, String)) -> String {
    format!("{}{}{{\"stop\":{{}}}}\n", case.0, case.1)
}

/// Checks that a request line was refused as malformed, with its number and with a reason that contains the fragment.
///
/// # Panics
/// If it was not.
pub fn assert_malformed(reply: &str, number: u64, line: &str, fragment: &str) {
    let reply: Value = serde_json::from_str(reply).expect(reply);
    let malformed = &reply["malformed"];
    let reason = malformed["reason"].as_str().unwrap_or_else(|| panic!("{line} was answered by {reply}"));
    assert!(reason.contains(fragment), "{line} was answered by {reason:?}, without {fragment:?}");
    assert!(reason.starts_with(&format!("line {number}")), "{line} was answered by {reason:?}, without its number");
    assert_eq!(malformed["line"].as_u64(), Some(number));
}

/// A main telegram.
pub const MAIN: &str = r#"{"section":7,"counter":1,"beyond_exit_m":400,"speed_rank":4}"#;

/// Its frame.
pub const FRAME: &str =
    "0111111111111110010011010000000010000000000000001110000000010100100000111100000000001000000100110111101110";

/// A sub telegram of the same section.
pub const SUB: &str =
    r#"{"section":7,"counter":1,"length_m":250,"gradient_permille":-12,"curve_rank":6,"restriction_rank":7}"#;

/// An attenuation table: between 0.5 and 1 dB for each 25.6 m.
pub const TABLE: &str = r#"{"spacing_m":25.6,"lowest_db":[0,0.5,1,1.5,2,2.5,3,3.5,4,4.5,5,5.5,6,6.5,7,7.5,8],"highest_db":[0,1,2,3,4,5,6,7,8,9,10,11,12,13,14,15,16]}"#;

/// A configuration of `train-position` with that table, and with `more` behind its last field.
pub fn position_config(more: &str) -> String {
    format!(r#"{{"table":{TABLE},"tolerance_db":0.1,"floor_db":-60{more}}}"#)
}
