//! A recorded session against the kernel: each request goes to the kernel at once, and each recorded reply is held against what the kernel
//! said to the oldest request that waits for one. Nothing is kept but what waits.

use std::collections::VecDeque;

use crate::conform::fields;
use crate::conform::play::{Agreed, Finding, Judge, Opened, shorten};
use crate::conform::side::Broken;
use crate::trace;
use atc_protocol::MAX_LINE;
use atc_protocol::Session;
use atc_protocol::form::{self, Fault, PROTOCOL, Request, Stop};
use atc_protocol::machine::{self, KINDS, Kind};

use super::lines::{Line, key};

/// How many requests may wait for their replies, and how many bytes of the kernel's replies: what a session may need of memory.
const MOST_AHEAD: usize = 1 << 16;
const MOST_BYTES: usize = 1 << 24;

/// Why a session is not read on.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Why {
    /// What is wrong, and what would be right.
    pub(super) what: String,
    /// The number of another line that has to do with it.
    pub(super) about: Option<u64>,
}

impl Why {
    fn about(line: u64, what: impl Into<String>) -> Self {
        Self { what: what.into(), about: Some(line) }
    }
}

impl<T: Into<String>> From<T> for Why {
    fn from(what: T) -> Self {
        Self { what: what.into(), about: None }
    }
}

/// The first difference of a session.
#[derive(Clone, Debug)]
pub(super) struct FirstFound {
    /// Where: "start", "step" or "stop".
    pub(super) at: &'static str,
    /// Which step, from 1.
    pub(super) step: Option<u64>,
    /// The line of the request and of the reply.
    pub(super) lines: (u64, u64),
    /// All fields that differ.
    pub(super) fields: Vec<fields::Difference>,
    /// What stands there in place of a reply that can be compared.
    pub(super) broken: Option<String>,
    /// From this line on replies come later than they did: one may be lost there.
    pub(super) late: Option<u64>,
}

/// A session that is being read.
pub(super) struct Play {
    kernel: Session,
    kind: &'static Kind,
    state: State,
    awaiting: VecDeque<Awaiting>,
    /// How many bytes wait.
    bytes: usize,
    /// The memory of replies that wait no more.
    spare: Vec<Vec<u8>>,
    /// How many steps were asked, how many replies to them were as they should be, and how many not.
    pub(super) steps: u64,
    pub(super) same: u64,
    pub(super) differing: u64,
    pub(super) agreed: Agreed,
    pub(super) first: Option<FirstFound>,
    /// The first step that was asked while another one waited.
    late: Option<u64>,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum State {
    /// Steps may come.
    Open,
    /// The kernel rejects the start.
    Rejected,
    /// It was stopped: replies may come.
    Stopped,
    /// One side has not opened it: what follows says nothing.
    Over,
}

/// What a request is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Asked {
    Start,
    Step(u64),
    Stop,
}

/// A request whose reply may still come.
struct Awaiting {
    asked: Asked,
    /// The line that it stands in.
    line: u64,
    /// What the kernel says to it.
    expected: Vec<u8>,
    /// Why the kernel does not take it.
    refused: Option<Fault>,
}

/// What a start line leads to.
pub(super) enum Begun {
    /// A session.
    Session(Box<Play>),
    /// A machine that the profile leaves out.
    Skipped(&'static Kind),
}

impl Play {
    /// Begins a session with its start line.
    pub(super) fn begin(line: &Line<'_>, judge: Judge<'_>) -> Result<Begun, Why> {
        let text = text(line)?;
        let Request::Start(body) = form::request(text).map_err(|fault| unreadable(line, &fault))? else {
            return Err("a start that is none".into());
        };
        let start = form::start(text, body).map_err(|fault| unreadable(line, &fault))?;
        if start.protocol != PROTOCOL {
            return Err(format!("protocol {} is not spoken here; protocol {PROTOCOL} is", start.protocol).into());
        }
        let Some(kind) = machine::find(&start.machine) else {
            let names: Vec<_> = KINDS.iter().map(|kind| kind.name).collect();
            return Err(format!("there is no machine {:?} here; there are {}", start.machine, names.join(", ")).into());
        };
        if judge.profile.skips(kind.name).is_some() {
            return Ok(Begun::Skipped(kind));
        }
        let (mut kernel, mut expected) = (Session::new(), Vec::new());
        kernel.request(text, &mut expected).map_err(|fault| unreadable(line, &fault))?;
        let state = if expected.starts_with(br#"{"started""#) { State::Open } else { State::Rejected };
        let start = Awaiting { asked: Asked::Start, line: line.number, expected, refused: None };
        Ok(Begun::Session(Box::new(Self {
            kernel,
            kind,
            state,
            bytes: start.expected.len(),
            awaiting: VecDeque::from([start]),
            spare: Vec::new(),
            steps: 0,
            same: 0,
            differing: 0,
            agreed: Agreed::default(),
            first: None,
            late: None,
        })))
    }

    pub(super) const fn kind(&self) -> &'static Kind {
        self.kind
    }

    /// Whether it had its stop, or was rejected and needs none.
    pub(super) fn is_ended(&self) -> bool {
        self.state != State::Open
    }

    /// Takes a line.
    pub(super) fn line(&mut self, line: &Line<'_>, judge: Judge<'_>) -> Result<(), Why> {
        let bytes = bytes(line)?;
        if self.state == State::Over || bytes.is_empty() {
            return Ok(());
        }
        match key(bytes) {
            Some(b"step") => self.step(line),
            Some(b"stop") => self.stop(line),
            Some(b"output") => self.output(line, judge),
            Some(b"started") => self.started(line, judge, "started"),
            Some(b"rejected") => self.started(line, judge, "rejected"),
            Some(b"malformed") => self.malformed(line),
            Some(b"stopped") => self.stopped(line, judge),
            _ => Err(neither(line)),
        }
    }

    /// Looks at what is left when the session is over: at the next start, or at the end of the file (then `cut`).
    pub(super) fn end(&self, cut: bool) -> Result<(), Why> {
        if self.state == State::Over {
            return Ok(());
        }
        let lost = self.awaiting.iter().find(|request| matches!(request.asked, Asked::Step(_)));
        if let Some(request) = lost {
            let place = if cut { "the end of the file" } else { "the next start" };
            let refused = request.refused.as_ref().map(|fault| format!("; it is no step: {fault}")).unwrap_or_default();
            let late = if self.late.is_some() { "; a reply is lost, or the log ends before it" } else { "" };
            let what = format!("a step has no reply before {place}{refused}{late}");
            return Err(Why::about(self.late.unwrap_or(request.line), what));
        }
        if self.state == State::Rejected && !self.awaiting.is_empty() {
            return Err("the start has no reply, and the kernel rejects it".into());
        }
        if !cut && self.state == State::Open {
            return Err("a start inside a session, which has no stop; it is read as a new one".into());
        }
        Ok(())
    }

    fn ask(&mut self, asked: Asked, line: &Line<'_>, expected: Vec<u8>, refused: Option<Fault>) -> Result<(), Why> {
        self.bytes += expected.len();
        if self.awaiting.len() >= MOST_AHEAD || self.bytes > MOST_BYTES {
            let first = self.awaiting.front().map_or(line.number, |request| request.line);
            let what = format!("no reply to the last {} requests; a log has its replies", self.awaiting.len());
            return Err(Why::about(first, what));
        }
        let waits = self.awaiting.iter().find(|request| matches!(request.asked, Asked::Step(_)));
        if let (Asked::Step(_), Some(waits)) = (asked, waits) {
            self.late.get_or_insert(waits.line);
        }
        self.awaiting.push_back(Awaiting { asked, line: line.number, expected, refused });
        Ok(())
    }

    fn step(&mut self, line: &Line<'_>) -> Result<(), Why> {
        match self.state {
            State::Open => {}
            State::Rejected => return Err("a step, and the kernel rejects the start".into()),
            State::Stopped | State::Over => return Err(outside("step").into()),
        }
        let mut expected = self.spare.pop().unwrap_or_default();
        expected.clear();
        let refused = match text(line) {
            Ok(text) => self.kernel.request(text, &mut expected).err(),
            Err(why) => return Err(why),
        };
        if refused.is_some() {
            expected.clear();
            // Half a line is the end of the log, not a request of somebody.
            if !line.ended && serde_json::from_slice::<serde::de::IgnoredAny>(bytes(line)?).is_err() {
                return Err(neither(line));
            }
        }
        self.steps += 1;
        self.ask(Asked::Step(self.steps), line, expected, refused)
    }

    fn stop(&mut self, line: &Line<'_>) -> Result<(), Why> {
        let text = text(line)?;
        let Request::Stop(body) = form::request(text).map_err(|fault| unreadable(line, &fault))? else {
            return Err(neither(line));
        };
        let _: Stop = form::body(text, body).map_err(|fault| unreadable(line, &fault))?;
        match self.state {
            State::Open => self.state = State::Stopped,
            // Some recorders stop what was rejected.
            State::Rejected => {}
            State::Stopped | State::Over => return Err(outside("stop").into()),
        }
        self.ask(Asked::Stop, line, Vec::new(), None)
    }

    /// The oldest request that a reply can be to. The replies to starts and stops may be missing, as in [`trace`].
    fn answered(&mut self, reply: &str, fits: impl Fn(Asked, bool) -> bool) -> Result<Awaiting, Why> {
        while let Some(request) = self.awaiting.pop_front() {
            self.bytes -= request.expected.len();
            if fits(request.asked, self.awaiting.is_empty()) {
                return Ok(request);
            }
            if matches!(request.asked, Asked::Step(_)) {
                let what = format!("a reply {reply:?}, and a step still waits for its output; a reply is lost");
                return Err(Why::about(self.late.unwrap_or(request.line), what));
            }
            if self.state == State::Rejected && request.asked == Asked::Start {
                return Err("the start has no reply, and the kernel rejects it".into());
            }
        }
        Err(format!("a reply {reply:?} to no request; a request is lost, or the two stand in the wrong order").into())
    }

    fn output(&mut self, line: &Line<'_>, judge: Judge<'_>) -> Result<(), Why> {
        let request = self.answered("output", |asked, _| matches!(asked, Asked::Step(_)))?;
        let found = match &request.refused {
            Some(fault) => {
                let text = text(line)?;
                object(line)?;
                Err(Finding::Broken(Broken::WrongReply("malformed", format!("{} ({fault})", shorten(text)))))
            }
            None if bytes(line)? == request.expected => Ok(()),
            None => {
                let expected = std::str::from_utf8(&request.expected).unwrap_or_default();
                judge.output(self.kind.name, expected, text(line)?, &mut self.agreed)
            }
        };
        self.judged(&request, line, found)
    }

    fn malformed(&mut self, line: &Line<'_>) -> Result<(), Why> {
        let rejected = self.state == State::Rejected;
        // To a start only if nothing else waits: the reply to the start may be missing.
        let request = self.answered("malformed", |asked, alone| match asked {
            Asked::Step(_) => true,
            Asked::Start => alone,
            Asked::Stop => rejected,
        })?;
        object(line)?;
        // There is nothing to stop after a start that was rejected.
        if request.refused.is_some() || request.asked == Asked::Stop {
            return self.judged(&request, line, Ok(()));
        }
        let due = if request.asked == Asked::Start { "started" } else { "output" };
        let found = Finding::Broken(Broken::WrongReply(due, shorten(text(line)?)));
        self.judged(&request, line, Err(found))
    }

    fn started(&mut self, line: &Line<'_>, judge: Judge<'_>, reply: &str) -> Result<(), Why> {
        let request = self.answered(reply, |asked, _| asked == Asked::Start)?;
        let expected = std::str::from_utf8(&request.expected).unwrap_or_default();
        let opened = judge.start(self.kind.name, expected, text(line)?, &mut self.agreed);
        let over = match &opened {
            Ok(opened) => matches!(opened, Opened::Ours | Opened::Theirs),
            Err(Finding::Differs(differences)) => differences.iter().any(|difference| difference.field == "start"),
            Err(Finding::Broken(_)) => false,
        };
        self.judged(&request, line, opened.map(drop))?;
        if over {
            self.state = State::Over;
        }
        Ok(())
    }

    fn stopped(&mut self, line: &Line<'_>, judge: Judge<'_>) -> Result<(), Why> {
        let request = self.answered("stopped", |asked, _| asked == Asked::Stop)?;
        let found = judge.stop(text(line)?);
        self.judged(&request, line, found)
    }

    fn judged(&mut self, request: &Awaiting, line: &Line<'_>, found: Result<(), Finding>) -> Result<(), Why> {
        let step = match request.asked {
            Asked::Step(number) => Some(number),
            Asked::Start | Asked::Stop => None,
        };
        let (fields, broken) = match found {
            Ok(()) => {
                self.same += u64::from(step.is_some());
                return Ok(());
            }
            // Half a line, or what is no reply at all.
            Err(Finding::Broken(Broken::Garbage(_))) => return Err(neither(line)),
            Err(Finding::Broken(broken)) => (Vec::new(), Some(broken.to_string())),
            Err(Finding::Differs(fields)) => (fields, None),
        };
        self.differing += u64::from(step.is_some());
        if self.first.is_none() {
            let at = match request.asked {
                Asked::Start => "start",
                Asked::Step(_) => "step",
                Asked::Stop => "stop",
            };
            let lines = (request.line, line.number);
            self.first = Some(FirstFound { at, step, lines, fields, broken, late: self.late });
        }
        Ok(())
    }
}

/// The bytes of a line without the whitespace around them.
fn bytes<'a>(line: &Line<'a>) -> Result<&'a [u8], Why> {
    match line.text {
        Some(text) => Ok(text.trim_ascii()),
        None => Err(format!("the line is longer than {MAX_LINE} bytes; a line of protocol 1 is shorter").into()),
    }
}

fn text<'a>(line: &Line<'a>) -> Result<&'a str, Why> {
    std::str::from_utf8(bytes(line)?).map_err(|error| {
        Why::from(format!("column {}: this is not UTF-8; a log is JSON lines in UTF-8", error.valid_up_to() + 1))
    })
}

/// Refuses a line that is no JSON object.
fn object(line: &Line<'_>) -> Result<(), Why> {
    serde_json::from_slice::<serde::de::IgnoredAny>(bytes(line)?).map(drop).map_err(|_| neither(line))
}

fn unreadable(line: &Line<'_>, fault: &Fault) -> Why {
    let cut = if line.ended { "" } else { "; the file ends in this line" };
    format!("{fault}{cut}").into()
}

fn outside(what: &str) -> String {
    format!(r#"a {what} outside a session; a session begins with {{"start":{{…}}}}, as its state does"#)
}

/// What a line that has no place in a log is.
fn neither(line: &Line<'_>) -> Why {
    let text = match text(line) {
        Ok(text) => text,
        Err(why) => return why,
    };
    let what = match serde_json::from_str::<trace::Line<'_>>(text) {
        Ok(_) => "its name is written in another way".to_owned(),
        Err(error) => error.to_string(),
    };
    let cut = if line.ended { "" } else { "; the file ends in this line" };
    format!("neither a request nor a reply of protocol 1: {what}{cut}").into()
}

/// What is wrong with a line that stands before the first start of a file.
pub(super) fn before(line: &Line<'_>) -> Option<Why> {
    let bytes = match bytes(line) {
        Ok([]) => return None,
        Ok(bytes) => bytes,
        Err(why) => return Some(why),
    };
    if bytes.starts_with("\u{feff}".as_bytes()) {
        return Some("a byte order mark; save the log as UTF-8 without it".into());
    }
    if bytes.starts_with(&[0xff, 0xfe]) || bytes.starts_with(&[0xfe, 0xff]) {
        return Some("this is UTF-16; a log is JSON lines in UTF-8".into());
    }
    Some(match key(bytes) {
        Some(b"step" | b"stop" | b"output" | b"started" | b"rejected" | b"malformed" | b"stopped") => {
            "the file begins in the middle of a session. A machine has state: without its start nothing says what is right here".into()
        }
        _ => neither(line),
    })
}
