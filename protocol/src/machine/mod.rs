//! The machines that are behind the protocol: each is one file here, and one line in [`KINDS`].

pub mod aspect;
pub mod block;
mod contract;
pub mod interlocking;
pub mod pattern;
pub mod permitted;
pub mod position;
pub mod sizes;
pub mod supervision;
pub mod telegram;
pub mod train;
pub mod wayside;

use schemars::{Schema, SchemaGenerator};
use serde::Serialize;
use serde_json::value::RawValue;

use crate::form::{Fault, PROTOCOL};

pub use contract::{Machine, config_of, step_of};

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
    kind::<interlocking::Sizes>(),
    kind::<train::OnBoard>(),
    kind::<wayside::Sizes>(),
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

impl<M: Machine> Case for M {
    fn step(&mut self, line: &str, body: &RawValue, reply: &mut Vec<u8>) -> Result<(), Fault> {
        let step = step_of::<M>(line, body)?;
        let output = Machine::step(self, &step).map_err(Fault::whole)?;
        // Writing to memory cannot fail, and the outputs are plain data.
        serde_json::to_writer(reply, &output).map_err(|error| Fault::whole(error.to_string()))
    }
}
