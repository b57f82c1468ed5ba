//! A case: a configuration and steps, and what the kernel answers to them.

use serde_json::Value;

use atc_protocol::Session;
use atc_protocol::form::Line;

/// A case of one machine, as it goes over the wire.
#[derive(Clone, Debug, PartialEq)]
pub struct Case {
    /// The machine's name.
    pub machine: String,
    /// The body of `config`.
    pub config: Value,
    /// The bodies of the steps.
    pub steps: Vec<Value>,
}

/// A case with the kernel's replies to its start and its steps.
#[derive(Clone, Debug)]
pub struct Expected {
    /// The case.
    pub case: Case,
    /// The reply to the start: started or rejected.
    pub start: String,
    /// The replies to the steps: each an output.
    pub outputs: Vec<String>,
    /// Steps of a walk that the kernel did not take, which are left out: a mistake of the walk. A test says that there is none.
    pub left_out: usize,
}

/// The line that ends a case.
pub const STOP: &str = r#"{"stop":{}}"#;

/// The line of a step.
pub fn step_line(step: &Value) -> String {
    Line::Step(step).text()
}

impl Case {
    /// The line of the start.
    pub fn start_line(&self) -> String {
        Line::start(&self.machine, &self.config).text()
    }

    /// The request lines, from the start to the stop. A case that is to be rejected has its start alone.
    pub fn lines(&self, rejected: bool) -> Vec<String> {
        let mut lines = vec![self.start_line()];
        lines.extend(self.steps.iter().map(step_line));
        if !rejected {
            lines.push(STOP.to_owned());
        }
        lines
    }

    /// The case with the kernel's replies.
    ///
    /// # Errors
    /// What the kernel says to a start or a step that it does not take.
    pub fn expected(self) -> Result<Expected, String> {
        let mut kernel = Kernel::new();
        let start = kernel.start(&self)?;
        let mut outputs = Vec::with_capacity(self.steps.len());
        if is_rejected(&start) && !self.steps.is_empty() {
            return Err(start);
        }
        for step in &self.steps {
            outputs.push(kernel.step(step)?);
        }
        Ok(Expected { case: self, start, outputs, left_out: 0 })
    }
}

impl Expected {
    /// Whether the configuration breaks a rule.
    pub fn is_rejected(&self) -> bool {
        is_rejected(&self.start)
    }

    /// The request lines, each with the kernel's reply below it: what `oracle chart` reads.
    pub fn session(&self) -> Vec<String> {
        let mut lines = vec![self.case.start_line(), self.start.clone()];
        for (step, output) in self.case.steps.iter().zip(&self.outputs) {
            lines.extend([step_line(step), output.clone()]);
        }
        lines.push(STOP.to_owned());
        lines
    }
}

/// Whether a reply rejects a start.
pub(super) fn is_rejected(reply: &str) -> bool {
    reply.starts_with(r#"{"rejected""#)
}

/// The kernel in this process, a case open or not.
pub(super) struct Kernel {
    session: Session,
    reply: Vec<u8>,
}

impl Kernel {
    pub(super) fn new() -> Self {
        Self { session: Session::new(), reply: Vec::new() }
    }

    fn ask(&mut self, line: &str) -> String {
        self.reply.clear();
        self.session.answer(line.as_bytes(), &mut self.reply);
        String::from_utf8_lossy(&self.reply).trim_end().to_owned()
    }

    /// The reply to a start: started or rejected.
    pub(super) fn start(&mut self, case: &Case) -> Result<String, String> {
        let reply = self.ask(&case.start_line());
        if reply.starts_with(r#"{"started""#) || is_rejected(&reply) { Ok(reply) } else { Err(reply) }
    }

    /// The output line of a step.
    pub(super) fn step(&mut self, step: &Value) -> Result<String, String> {
        let reply = self.ask(&step_line(step));
        if reply.starts_with(r#"{"output""#) { Ok(reply) } else { Err(reply) }
    }
}
