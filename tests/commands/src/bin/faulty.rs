//! An implementation with a fault, for the conformance kit: `faulty NAME` speaks protocol 1. Names that are no fault of a rule break the
//! conversation: `crash`, `abort`, `leave`, `hang`, `garbage`, `silent`, `wrong-start`, `missing-field`, `malformed`,
//! `keeps-state`, `flaky`; each but the first replies to a few requests as it should.

use std::io::{self, BufRead as _, Write as _};
use std::process::ExitCode;
use std::time::Duration;

use atc_commands::faulty::{Faulty, fault};

/// After so many requests the conversation breaks.
const AFTER: u64 = 5;

fn main() -> ExitCode {
    let name = std::env::args().nth(1).unwrap_or_default();
    let mut machine = Faulty::new(fault(&name));
    let mut output = io::stdout();
    let (mut last, mut first) = (String::new(), true);
    for (number, line) in (1_u64..).zip(io::stdin().lock().lines()) {
        let Ok(line) = line else { break };
        let mut reply = machine.answer(&line);
        let (start, step) = (line.starts_with(r#"{"start""#), line.starts_with(r#"{"step""#));
        let broken = number > AFTER;
        match name.as_str() {
            "crash" => {
                eprintln!("out of order");
                return ExitCode::from(3);
            }
            "abort" if broken => std::process::abort(),
            "leave" if broken => return ExitCode::SUCCESS,
            "hang" if broken => std::thread::sleep(Duration::from_mins(10)),
            "garbage" if broken => reply = "Segmentation fault (not)".into(),
            "silent" if broken => continue,
            "wrong-start" if start => reply = reply.replace(r#""protocol":1"#, r#""protocol":2"#),
            "missing-field" if step => reply = reply.replace("display_km_h", "display"),
            "malformed" if step && broken => reply = r#"{"malformed":{"reason":"what?","line":1}}"#.into(),
            // The first output of a case is the last one of the case before.
            "keeps-state" if step => {
                let now = reply.clone();
                if first && !last.is_empty() {
                    reply = last;
                }
                (last, first) = (now, false);
            }
            "keeps-state" if start => first = true,
            "flaky" if step && number % 1009 == 1008 => reply = r#"{"output":{"brake":"release"}}"#.into(),
            _ => {}
        }
        if writeln!(output, "{reply}").and_then(|()| output.flush()).is_err() {
            break;
        }
    }
    ExitCode::SUCCESS
}
