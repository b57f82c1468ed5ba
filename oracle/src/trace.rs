//! A recorded session: its request lines, and its replies if they were kept.
//!
//! The lines stand in the order of the session; replies follow their requests at any distance, as they do for a
//! client that sends ahead. Empty lines are passed over. Every case is run through the kernel again.

use std::collections::VecDeque;

use serde::Deserialize;
use serde::de::IgnoredAny;
use serde_json::value::RawValue;

use atc_film::Film;

use crate::chart::scene::Scene;
use crate::drawn::{self, DRAWINGS, Drawing};
use crate::film::take::Setting;
use atc_protocol::form::{self, Fault, Rejected, Stop};

pub(crate) mod error;
pub(crate) mod run;

use run::{Answer, Recorded, RecordedStep};

pub use error::{Replies, TraceError};

/// A recorded session: one record for each start.
#[derive(Clone, Debug)]
pub struct Trace {
    /// The cases, in their order.
    pub cases: Vec<Record>,
}

/// A recorded case.
#[derive(Clone, Debug)]
pub struct Record {
    drawing: &'static Drawing,
    case: Recorded,
}

impl Record {
    /// Runs it through the kernel and lays out its film.
    ///
    /// # Errors
    /// As [`Trace::scenes`]; and what the film is to be made with does not fit.
    pub(crate) fn film(&self, setting: &Setting) -> Result<Film, TraceError> {
        (self.drawing.film)(&self.case, setting)
    }
}

/// Any line of a trace.
#[derive(Deserialize)]
#[serde(rename_all = "snake_case")]
pub(crate) enum Line<'a> {
    #[serde(borrow)]
    Start(&'a RawValue),
    Step(IgnoredAny),
    Stop(&'a RawValue),
    Started(IgnoredAny),
    Rejected(&'a RawValue),
    Output(&'a RawValue),
    Stopped(IgnoredAny),
    Malformed(IgnoredAny),
}

/// A request whose reply may still come.
enum Awaiting {
    Start,
    Step { case: usize, step: usize },
    Stop,
}

impl Trace {
    /// Reads a trace.
    ///
    /// # Errors
    /// The first line that is neither a request nor a reply, a request or reply that is out of place, or a trace
    /// without a start.
    pub fn parse(text: &str) -> Result<Self, TraceError> {
        let mut reader = Reader { cases: Vec::new(), open: false, awaiting: VecDeque::new() };
        for (number, line) in text.lines().enumerate() {
            if !line.trim_ascii().is_empty() {
                reader.line(number + 1, line).map_err(|fault| TraceError { line: number + 1, fault })?;
            }
        }
        if reader.cases.is_empty() {
            let fault = Fault::whole(r#"the trace has no {"start":{…}}, so there is nothing to draw"#);
            return Err(TraceError { line: 0, fault });
        }
        Ok(Self { cases: reader.cases })
    }

    /// Runs every case through the kernel and lays out its chart.
    ///
    /// # Errors
    /// A configuration or step that the kernel does not take, a reply that cannot be read, or, if replies must
    /// agree, the first that does not.
    pub fn scenes(&self, replies: Replies) -> Result<Vec<Scene>, TraceError> {
        self.cases.iter().map(|record| (record.drawing.chart)(&record.case, replies)).collect()
    }
}

struct Reader {
    cases: Vec<Record>,
    open: bool,
    awaiting: VecDeque<Awaiting>,
}

impl Reader {
    fn line(&mut self, number: usize, text: &str) -> Result<(), Fault> {
        let line: Line<'_> = serde_json::from_str(text)
            .map_err(|error| Fault::whole(format!("neither a request nor a reply of protocol 1: {error}")))?;
        match line {
            Line::Start(body) => self.start(number, text, body)?,
            Line::Step(_) => match self.cases.last_mut() {
                Some(case) if self.open => {
                    case.case.steps.push(RecordedStep { line: number, text: text.to_owned(), reply: None });
                    let step = case.case.steps.len() - 1;
                    self.awaiting.push_back(Awaiting::Step { case: self.cases.len() - 1, step });
                }
                _ => return Err(Fault::whole("a step outside a case")),
            },
            Line::Stop(body) if self.open => {
                let _: Stop = form::body(text, body)?;
                self.open = false;
                self.awaiting.push_back(Awaiting::Stop);
            }
            Line::Stop(_) => return Err(Fault::whole("a stop outside a case")),
            Line::Started(_) => self.reply("started", None, |request| matches!(request, Awaiting::Start))?,
            Line::Stopped(_) => self.reply("stopped", None, |request| matches!(request, Awaiting::Stop))?,
            Line::Output(body) => self.reply("output", Some(Answer::Output(number, body.to_owned())), |request| {
                matches!(request, Awaiting::Step { .. })
            })?,
            Line::Malformed(_) => self.reply("malformed", Some(Answer::Malformed), |request| {
                // The starts and stops of a trace are right, or it is refused.
                matches!(request, Awaiting::Step { .. })
            })?,
            Line::Rejected(body) => {
                let rejected: Rejected = serde_json::from_str(body.get()).unwrap_or(Rejected { reason: String::new() });
                return Err(Fault::whole(format!(
                    "the start was rejected, there is no case to draw: {}",
                    rejected.reason
                )));
            }
        }
        Ok(())
    }

    fn start(&mut self, line: usize, text: &str, body: &RawValue) -> Result<(), Fault> {
        if self.open {
            return Err(Fault::whole("a start inside a case"));
        }
        let start = form::start(text, body)?;
        if start.protocol != form::PROTOCOL {
            return Err(Fault::whole(format!("protocol {} is not spoken here", start.protocol)));
        }
        let Some(drawing) = drawn::find(&start.machine) else {
            let names: Vec<_> = DRAWINGS.iter().map(|drawing| drawing.name).collect();
            return Err(Fault::whole(format!(
                "there is no machine {:?}; there are {}",
                start.machine,
                names.join(", ")
            )));
        };
        let config = match start.config {
            Some(config) => config.to_owned(),
            None => RawValue::from_string("{}".to_owned()).map_err(|error| Fault::whole(error.to_string()))?,
        };
        self.cases.push(Record { drawing, case: Recorded { line, config, steps: Vec::new() } });
        self.open = true;
        self.awaiting.push_back(Awaiting::Start);
        Ok(())
    }

    /// Gives a reply to the oldest request that waits for one. The replies to starts and stops may be missing: some
    /// implementations say nothing to a stop, and a record may hold no more than the steps.
    fn reply(&mut self, name: &str, answer: Option<Answer>, answers: impl Fn(&Awaiting) -> bool) -> Result<(), Fault> {
        while let Some(request) = self.awaiting.pop_front() {
            if answers(&request) {
                if let (Awaiting::Step { case, step }, Some(answer)) = (request, answer) {
                    self.cases[case].case.steps[step].reply = Some(answer);
                }
                return Ok(());
            }
            if matches!(request, Awaiting::Step { .. }) {
                break;
            }
        }
        Err(Fault::whole(format!("a reply {name:?} to no request")))
    }
}
