//! A session: request lines in, reply lines out, one for one.

use serde_json::value::RawValue;

use crate::form::{self, Fault, Malformed, PROTOCOL, Rejected, Request, Stop, Stopped};
use crate::machine::{self, Case, KINDS, Kind, Refusal};

/// The longest line that is read, in bytes without its newline.
pub const MAX_LINE: usize = 1 << 20;

/// What the oracle remembers between lines: the open case, if there is one.
#[derive(Default)]
pub struct Session {
    line: u64,
    open: Option<Open>,
}

struct Open {
    case: Box<dyn Case>,
    kind: &'static Kind,
    steps: u64,
}

impl Session {
    /// A session with no case open.
    pub fn new() -> Self {
        Self::default()
    }

    /// Answers one line (without its newline): appends exactly one line of JSON, with its newline, to `reply`.
    /// A line that is not understood changes nothing but the count of lines.
    pub fn answer(&mut self, line: &[u8], reply: &mut Vec<u8>) {
        self.line += 1;
        let before = reply.len();
        let result = match std::str::from_utf8(line) {
            _ if line.len() > MAX_LINE => Err(overlong()),
            Ok(text) => self.request(text, reply),
            Err(error) => Err(Fault {
                column: Some(error.valid_up_to() + 1),
                what: "this is not UTF-8; a request is JSON in UTF-8".to_owned(),
            }),
        };
        if let Err(fault) = result {
            reply.truncate(before);
            self.malformed(&fault, reply);
        }
        reply.push(b'\n');
    }

    /// Answers a line that was too long to be kept.
    pub fn answer_overlong(&mut self, reply: &mut Vec<u8>) {
        self.line += 1;
        self.malformed(&overlong(), reply);
        reply.push(b'\n');
    }

    /// Answers a line that is text: appends one line of JSON without its newline, or says why there is none. What was appended before a
    /// fault is for the caller to take away.
    ///
    /// # Errors
    /// What in it is not understood.
    pub fn request(&mut self, line: &str, reply: &mut Vec<u8>) -> Result<(), Fault> {
        match form::request(line)? {
            Request::Step(body) => {
                let Some(open) = &mut self.open else {
                    return Err(Fault::whole(r#"a step before a start; begin with {"start":{…}}"#));
                };
                reply.extend_from_slice(br#"{"output":"#);
                open.case.step(line, body, reply)?;
                reply.push(b'}');
                open.steps = open.steps.saturating_add(1);
            }
            Request::Start(body) => self.start(line, body, reply)?,
            Request::Stop(body) => {
                let _: Stop = form::body(line, body)?;
                let Some(open) = self.open.take() else {
                    return Err(Fault::whole(r#"a stop without a start; begin with {"start":{…}}"#));
                };
                write(reply, "stopped", &Stopped { steps: open.steps })?;
            }
        }
        Ok(())
    }

    fn start(&mut self, line: &str, body: &RawValue, reply: &mut Vec<u8>) -> Result<(), Fault> {
        if let Some(open) = &self.open {
            let name = open.kind.name;
            return Err(Fault::whole(format!(
                r#"a start inside a case of {name}, which goes on; end it with {{"stop":{{}}}} first"#
            )));
        }
        let start = form::start(line, body).map_err(|fault| Fault {
            what: format!(r#"{}; a start is {{"start":{{"protocol":1,"machine":"…","config":{{…}}}}}}"#, fault.what),
            ..fault
        })?;
        let config = match start.config {
            Some(config) => config,
            None => serde_json::from_str("{}").map_err(|error| Fault::whole(error.to_string()))?,
        };
        let opened = if start.protocol != PROTOCOL {
            Err(Refusal::Rejected(format!("protocol {} is not spoken here; protocol {PROTOCOL} is", start.protocol)))
        } else if let Some(kind) = machine::find(&start.machine) {
            (kind.open)(line, config).map(|opened| (kind, opened))
        } else {
            let names: Vec<_> = KINDS.iter().map(|kind| kind.name).collect();
            let asked = crate::decimal::shorten(&start.machine);
            Err(Refusal::Rejected(format!("there is no machine {asked:?} here; there are {}", names.join(", "))))
        };
        match opened {
            Ok((kind, opened)) => {
                reply.extend_from_slice(br#"{"started":"#);
                reply.extend_from_slice(opened.started.as_bytes());
                reply.push(b'}');
                self.open = Some(Open { case: opened.case, kind, steps: 0 });
                Ok(())
            }
            Err(Refusal::Rejected(reason)) => write(reply, "rejected", &Rejected { reason }),
            Err(Refusal::Malformed(fault)) => Err(fault),
        }
    }

    fn malformed(&self, fault: &Fault, reply: &mut Vec<u8>) {
        let place = if fault.column.is_some() { ", " } else { ": " };
        let reason = format!("line {}{place}{fault}", self.line);
        let malformed = Malformed { reason, line: self.line };
        if write(reply, "malformed", &malformed).is_err() {
            // Writing plain data to memory does not fail; if it did, this line is still an answer.
            reply.extend_from_slice(br#"{"malformed":{"reason":"the reason could not be written","line":0}}"#);
        }
    }
}

fn overlong() -> Fault {
    Fault::whole(format!("the line is longer than {MAX_LINE} bytes; a request is shorter"))
}

/// Appends `{"key":body}`; nothing on an error.
fn write<T: serde::Serialize>(reply: &mut Vec<u8>, key: &str, body: &T) -> Result<(), Fault> {
    let body = serde_json::to_vec(body).map_err(|error| Fault::whole(error.to_string()))?;
    reply.extend_from_slice(b"{\"");
    reply.extend_from_slice(key.as_bytes());
    reply.extend_from_slice(b"\":");
    reply.extend_from_slice(&body);
    reply.push(b'}');
    Ok(())
}
