//! A recorded session: its request lines, and its replies if they were kept.
//!
//! The lines stand in the order of the session; replies follow their requests at any distance, as they do for a
//! client that sends ahead. Empty lines are passed over. Every case is run through the kernel again.

use std::collections::VecDeque;
use std::fmt;

use serde::Deserialize;
use serde::de::IgnoredAny;
use serde_json::Value;
use serde_json::value::RawValue;

use atc_film::Film;

use crate::chart::Scene;
use crate::drawn::{self, Cycle, DRAWINGS, Drawing, Drawn};
use crate::film::{self, Setting, Take};
use atc_protocol::form::{self, Fault, Rejected, Stop};
use atc_protocol::machine::{self, Machine};

/// What a recorded reply that differs from the kernel's means.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Replies {
    /// The record is wrong: an error.
    MustAgree,
    /// The record is of another implementation: the difference is drawn.
    AsRecorded,
}

/// What is wrong with a trace, and in which of its lines.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct TraceError {
    /// The line, from 1; 0 for the trace as a whole.
    pub line: usize,
    /// What is wrong there.
    pub fault: Fault,
}

impl fmt::Display for TraceError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match (self.line, self.fault.column) {
            (0, _) => write!(f, "{}", self.fault),
            (line, Some(_)) => write!(f, "line {line}, {}", self.fault),
            (line, None) => write!(f, "line {line}: {}", self.fault),
        }
    }
}

impl std::error::Error for TraceError {}

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
    line: usize,
    config: Box<RawValue>,
    steps: Vec<RecordedStep>,
}

impl Record {
    /// The machine that it is of.
    pub(crate) const fn drawing(&self) -> &'static Drawing {
        self.drawing
    }
}

/// A step and what was answered to it.
#[derive(Clone, Debug)]
struct RecordedStep {
    line: usize,
    text: String,
    reply: Option<Answer>,
}

#[derive(Clone, Debug)]
enum Answer {
    Output(usize, Box<RawValue>),
    Malformed,
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
        self.cases.iter().map(|record| (record.drawing.chart)(record, replies)).collect()
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
                    case.steps.push(RecordedStep { line: number, text: text.to_owned(), reply: None });
                    let step = case.steps.len() - 1;
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
        self.cases.push(Record { drawing, line, config, steps: Vec::new() });
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
                    self.cases[case].steps[step].reply = Some(answer);
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

/// Runs a record through the kernel, compares, and lays out the chart.
pub(crate) fn chart<M: Drawn>(record: &Record, replies: Replies) -> Result<Scene, TraceError> {
    let Run { config, cycles, .. } = run::<M>(record, replies)?;
    Ok(M::chart(&config, &cycles))
}

/// Runs a record through the kernel, compares, and lays out the film.
pub(crate) fn film<M: Drawn>(record: &Record, setting: &Setting) -> Result<Film, TraceError> {
    let Run { config, cycles, steps } = run::<M>(record, setting.replies)?;
    let take = Take { config: &config, cycles: &cycles, steps: &steps, setting };
    film::made(&take).map_err(|what| TraceError { line: record.line, fault: Fault::whole(what) })
}

/// A case that was run through the kernel.
struct Run<M: Machine> {
    config: M::Config,
    cycles: Vec<Cycle<M>>,
    /// The body of the step of each cycle, as it was recorded.
    steps: Vec<Value>,
}

/// Runs a record through the kernel and compares.
fn run<M: Machine>(record: &Record, replies: Replies) -> Result<Run<M>, TraceError> {
    let at = |line: usize| move |fault: Fault| TraceError { line, fault };
    let config: M::Config = machine::config_of::<M>("", &record.config).map_err(|fault| TraceError {
        line: record.line,
        // The column would count from the config.
        fault: Fault::whole(fault.what),
    })?;
    let mut machine = M::open(&config).map_err(|reason| TraceError {
        line: record.line,
        fault: Fault::whole(format!("a start to reject: {reason}")),
    })?;
    let mut cycles = Vec::with_capacity(record.steps.len());
    let mut steps = Vec::with_capacity(record.steps.len());
    for recorded in &record.steps {
        let step = read_step::<M>(&recorded.text);
        let result = step.and_then(|step| match machine.step(&step) {
            Ok(output) => Ok((step, output)),
            Err(what) => Err(Fault::whole(what)),
        });
        let (step, output) = match (result, &recorded.reply) {
            (Ok(done), _) => done,
            (Err(_), Some(Answer::Malformed)) => continue,
            (Err(fault), _) => return Err(at(recorded.line)(fault)),
        };
        let said = match &recorded.reply {
            None => None,
            Some(Answer::Malformed) => {
                let fault = Fault::whole("recorded as malformed, but the kernel takes this step");
                return Err(at(recorded.line)(fault));
            }
            Some(Answer::Output(line, body)) => {
                let said: M::Output = form::body("", body).map_err(|fault| {
                    at(*line)(Fault::whole(format!("an output of {} cannot be read: {}", M::NAME, fault.what)))
                })?;
                if said != output && replies == Replies::MustAgree {
                    let kernel = serde_json::to_string(&output).unwrap_or_default();
                    return Err(at(*line)(Fault::whole(format!(
                        "the record says {}, the kernel {kernel} (cycle {} of the case); draw the record with --as-recorded",
                        body.get(),
                        cycles.len(),
                    ))));
                }
                Some(said)
            }
        };
        cycles.push(Cycle { step, output, recorded: said });
        let whole: Value = serde_json::from_str(&recorded.text).unwrap_or_default();
        steps.push(whole.get("step").cloned().unwrap_or_default());
    }
    if cycles.is_empty() {
        return Err(TraceError {
            line: record.line,
            fault: Fault::whole("the case has no step, so there is nothing to draw"),
        });
    }
    Ok(Run { config, cycles, steps })
}

fn read_step<M: Machine>(text: &str) -> Result<M::Step, Fault> {
    match form::request(text)? {
        form::Request::Step(body) => machine::step_of::<M>(text, body),
        _ => Err(Fault::whole("not a step")),
    }
}
