//! The machines that are behind the protocol: each is one file here, and one line in [`KINDS`].

pub mod aspect;
pub mod block;
pub mod interlocking;
pub mod pattern;
pub mod permitted;
pub mod position;
pub mod supervision;
pub mod telegram;
pub mod train;
pub mod wayside;

use schemars::{JsonSchema, Schema, SchemaGenerator};
use serde::Serialize;
use serde::de::DeserializeOwned;
use serde_json::value::RawValue;

use crate::form::{self, Fault, PROTOCOL};

/// A machine behind the protocol: a kernel machine, its state, and the forms of its messages.
pub trait Machine: Sized + Send + Sync + 'static {
    /// The name in `{"start":{"machine":…}}`.
    const NAME: &'static str;
    /// A step that is right, for messages.
    const STEP: &'static str;
    /// A configuration that is right, for messages.
    const CONFIG: &'static str;

    /// The body of `config`. Unknown fields must be denied.
    type Config: DeserializeOwned + Serialize + JsonSchema;
    /// The body of a step. Unknown fields must be denied.
    type Step: DeserializeOwned + JsonSchema;
    /// The body of an output. Unknown fields are let pass: another implementation may say more.
    type Output: DeserializeOwned + Serialize + JsonSchema + Clone + PartialEq;

    /// The machine in its initial state.
    ///
    /// # Errors
    /// The rule that the configuration breaks, in a sentence with its numbers.
    fn open(config: &Self::Config) -> Result<Self, String>;

    /// One logic cycle.
    ///
    /// # Errors
    /// What in the step has no meaning for this configuration; the state is as before.
    fn step(&mut self, step: &Self::Step) -> Result<Self::Output, String>;

    /// The parameters in logic cycles, after rounding, by name; none if the machine counts no time.
    fn cycles(&self) -> Vec<(&'static str, u16)> {
        Vec::new()
    }
}

/// The body of a started reply.
#[derive(Serialize)]
struct Started<'a, C> {
    protocol: u32,
    machine: &'static str,
    config: &'a C,
    #[serde(skip_serializing_if = "serde_json::Map::is_empty")]
    cycles: serde_json::Map<String, serde_json::Value>,
}

/// Why no case was opened.
pub enum Refusal {
    /// The configuration cannot be read.
    Malformed(Fault),
    /// The configuration breaks this rule.
    Rejected(String),
}

/// An open case. Plain data: it may be handed from one thread to another.
pub trait Case: Send + Sync {
    /// One logic cycle: reads `body`, which stands in `line`, and appends the body of the output to `reply`.
    ///
    /// # Errors
    /// If it is not a step of this machine; nothing has changed and nothing is appended.
    fn step(&mut self, line: &str, body: &RawValue, reply: &mut Vec<u8>) -> Result<(), Fault>;
}

/// A case just opened, and the body of the reply that says so.
pub struct Opened {
    /// The case.
    pub case: Box<dyn Case>,
    /// The body of the started reply.
    pub started: String,
}

/// A machine, as the session and the schema know it.
#[derive(Clone, Copy, Debug)]
pub struct Kind {
    /// Its name.
    pub name: &'static str,
    /// Opens a case with a configuration that stands in the given line.
    pub open: fn(&str, &RawValue) -> Result<Opened, Refusal>,
    /// The schema of its configuration.
    pub config: fn(&mut SchemaGenerator) -> Schema,
    /// The schema of its step.
    pub step: fn(&mut SchemaGenerator) -> Schema,
    /// The schema of its output.
    pub output: fn(&mut SchemaGenerator) -> Schema,
}

/// Every machine.
pub const KINDS: &[Kind] = &[
    kind::<aspect::Aspect>(),
    kind::<supervision::Supervised>(),
    kind::<block::Counted>(),
    kind::<telegram::Codec>(),
    kind::<pattern::Braking>(),
    kind::<permitted::Permitting>(),
    kind::<position::Positioned>(),
    kind::<interlocking::Interlocked>(),
    kind::<train::OnBoard>(),
    kind::<wayside::Ground>(),
];

/// The machine of that name.
pub fn find(name: &str) -> Option<&'static Kind> {
    KINDS.iter().find(|kind| kind.name == name)
}

const fn kind<M: Machine>() -> Kind {
    Kind {
        name: M::NAME,
        open: open::<M>,
        config: SchemaGenerator::subschema_for::<M::Config>,
        step: SchemaGenerator::subschema_for::<M::Step>,
        output: SchemaGenerator::subschema_for::<M::Output>,
    }
}

fn open<M: Machine>(line: &str, config: &RawValue) -> Result<Opened, Refusal> {
    let config: M::Config = config_of::<M>(line, config).map_err(Refusal::Malformed)?;
    let machine = M::open(&config).map_err(Refusal::Rejected)?;
    let cycles = machine.cycles().into_iter().map(|(name, cycles)| (name.to_owned(), cycles.into())).collect();
    let started = Started { protocol: PROTOCOL, machine: M::NAME, config: &config, cycles };
    let started = serde_json::to_string(&started).map_err(|error| Refusal::Rejected(error.to_string()))?;
    Ok(Opened { case: Box::new(machine), started })
}

/// Reads a configuration; a fault says what would be right.
///
/// # Errors
/// It is none of this machine.
pub fn config_of<M: Machine>(line: &str, body: &RawValue) -> Result<M::Config, Fault> {
    form::body(line, body)
        .map_err(|fault| Fault { what: format!("{}; a config of {} is {}", fault.what, M::NAME, M::CONFIG), ..fault })
}

/// Reads a step; a fault says what would be right.
///
/// # Errors
/// It is none of this machine.
pub fn step_of<M: Machine>(line: &str, body: &RawValue) -> Result<M::Step, Fault> {
    form::body(line, body)
        .map_err(|fault| Fault { what: format!("{}; a step of {} is {}", fault.what, M::NAME, M::STEP), ..fault })
}

impl<M: Machine> Case for M {
    fn step(&mut self, line: &str, body: &RawValue, reply: &mut Vec<u8>) -> Result<(), Fault> {
        let step = step_of::<M>(line, body)?;
        let output = Machine::step(self, &step).map_err(Fault::whole)?;
        // Writing to memory cannot fail, and the outputs are plain data.
        serde_json::to_writer(reply, &output).map_err(|error| Fault::whole(error.to_string()))
    }
}
