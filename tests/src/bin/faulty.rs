//! An implementation with a fault, for the conformance kit: `faulty NAME` speaks protocol 1. Names that are no fault of a rule break the
//! conversation: `crash`, `abort`, `leave`, `hang`, `garbage`, `silent`, `wrong-start`, `missing-field`, `malformed`,
//! `keeps-state`, `flaky`; each but the first replies to a few requests as it should.

use std::io::{self, BufRead as _, Write as _};
use std::process::ExitCode;
use std::time::Duration;

use atc_tests::faulty::{Faulty, fault};
use serde_json::Value;

/// After so many requests the conversation breaks.
const AFTER: u64 = 5;

fn main() -> ExitCode {
    let name = std::env::args().nth(1).unwrap_or_default();
    let mut machine = Faulty::new(fault(&name));
    let mut output = io::stdout();
    let mut last = Value::Null;
    for (number, line) in (1_u64..).zip(io::stdin().lock().lines()) {
        let Ok(line) = line else { break };
        let mut reply = machine.answer(&line);
        let step = line.starts_with(r#"{"step""#);
        let broken = number > AFTER;
        match name.as_str() {
            "crash" => {
                eprintln!("out of order");
                return ExitCode::from(3);
            }
            "abort" if broken => std::process::abort(),
            "leave" if broken => return ExitCode::SUCCESS,
            "hang" if broken => std::thread::sleep(Duration::from_secs(600)),
            "garbage" if broken => reply = "Segmentation fault (not)".to_owned(),
            "silent" if broken => continue,
            "wrong-start" if line.starts_with(r#"{"start""#) => reply = reply.replace(r#""protocol":1"#, r#""protocol":2"#),
            "missing-field" if step => reply = reply.replace("display_km_h", "display"),
            "malformed" if step && broken => reply = r#"{"malformed":{"reason":"what?","line":1}}"#.to_owned(),
            // The first output of a case is the last one of the case before.
            "keeps-state" if step => {
                let now: Value = serde_json::from_str(&reply).unwrap_or_default();
                if !last.is_null() {
                    reply = last.to_string();
                }
                last = Value::Null;
                if now["output"]["brake"] == "release" {
                    last = now;
                }
            }
            "flaky" if step && number % 1009 == 1008 => reply = r#"{"output":{"brake":"release"}}"#.to_owned(),
            _ => {}
        }
        if writeln!(output, "{reply}").and_then(|()| output.flush()).is_err() {
            break;
        }
    }
    ExitCode::SUCCESS
}
