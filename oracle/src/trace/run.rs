//! A recorded case, run through the kernel again and compared.

use serde_json::Value;
use serde_json::value::RawValue;

use super::error::{Replies, TraceError};
use atc_protocol::form::{self, Fault};
use atc_protocol::machine::{self, Machine};

/// A recorded case, of whichever machine.
#[derive(Clone, Debug)]
pub struct Recorded {
    pub(super) line: usize,
    pub(super) config: Box<RawValue>,
    pub(super) steps: Vec<RecordedStep>,
}

impl Recorded {
    /// What is wrong with the case as a whole.
    pub(crate) fn error(&self, what: impl Into<String>) -> TraceError {
        TraceError { line: self.line, fault: Fault::whole(what) }
    }
}

/// A step and what was answered to it.
#[derive(Clone, Debug)]
pub(super) struct RecordedStep {
    pub(super) line: usize,
    pub(super) text: String,
    pub(super) reply: Option<Answer>,
}

#[derive(Clone, Debug)]
pub(super) enum Answer {
    Output(usize, Box<RawValue>),
    Malformed,
}

/// One logic cycle of a recorded case.
pub struct Cycle<M: Machine> {
    /// What was read.
    pub step: M::Step,
    /// What the kernel puts out.
    pub output: M::Output,
    /// What the record says was put out, if it says anything.
    pub recorded: Option<M::Output>,
}

/// A case that was run through the kernel.
pub(crate) struct Run<M: Machine> {
    pub config: M::Config,
    pub cycles: Vec<Cycle<M>>,
    /// The body of the step of each cycle, as it was recorded.
    pub steps: Vec<Value>,
}

/// Runs a record through the kernel and compares.
pub(crate) fn run<M: Machine>(record: &Recorded, replies: Replies) -> Result<Run<M>, TraceError> {
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
