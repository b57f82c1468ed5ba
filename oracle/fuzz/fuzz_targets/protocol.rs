//! Any bytes through a session: no panic, and exactly one reply line, in one of the five forms, for each line.
//!
//! `cargo +nightly fuzz run protocol` in `oracle/`, with `fuzz/protocol.dict` as the dictionary.
#![no_main]

use libfuzzer_sys::fuzz_target;
use serde_json::Value;

fuzz_target!(|input: &[u8]| {
    let mut output = Vec::new();
    atc_oracle::serve(input, &mut output).expect("memory can be read and written");
    let lines = input.split_inclusive(|byte| *byte == b'\n').count();
    let replies = std::str::from_utf8(&output).expect("replies are UTF-8");
    assert!(replies.is_empty() || replies.ends_with('\n'));
    assert_eq!(replies.lines().count(), lines);
    for reply in replies.lines() {
        let reply: Value = serde_json::from_str(reply).expect("a reply is JSON");
        let body = reply.as_object().expect("a reply is an object");
        assert_eq!(body.len(), 1, "{reply}");
        let form = body.keys().next().map(String::as_str);
        assert!(matches!(form, Some("started" | "rejected" | "output" | "stopped" | "malformed")), "{reply}");
        if let Some(malformed) = body.get("malformed") {
            assert!(malformed["reason"].as_str().is_some_and(|reason| reason.starts_with("line ")), "{reply}");
        }
    }
});
