//! What a machine behind the protocol is: its names, the forms of its messages, and how it opens and steps.

use schemars::JsonSchema;
use serde::Serialize;
use serde::de::DeserializeOwned;
use serde_json::value::RawValue;

use crate::form::{self, Fault};

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
    type Step: DeserializeOwned + Serialize + JsonSchema;
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
