//! One case of one machine, in lines of JSON.

use atc_protocol::machine::KINDS;
use atc_protocol::{Session, schema as protocol_schema};
use pyo3::exceptions::PyRuntimeError;
use pyo3::prelude::*;

/// A conversation with the oracle, in the words of protocol 1.
#[pyclass(module = "atc._atc")]
#[derive(Default)]
pub struct Conversation {
    session: Session,
    reply: Vec<u8>,
}

#[pymethods]
impl Conversation {
    #[new]
    fn new() -> Self {
        Self::default()
    }

    /// The reply to one line. A line that is not understood has a reply, too, and changes nothing.
    fn answer(&mut self, line: &str) -> PyResult<String> {
        self.reply.clear();
        self.session.answer(line.replace('\n', " ").as_bytes(), &mut self.reply);
        // The newline at the end is for the pipe.
        let text = self.reply.strip_suffix(b"\n").unwrap_or(&self.reply);
        let text = std::str::from_utf8(text).map_err(|error| PyRuntimeError::new_err(error.to_string()))?;
        Ok(text.to_owned())
    }
}

/// The names of the machines.
#[pyfunction]
pub fn machines() -> Vec<&'static str> {
    KINDS.iter().map(|kind| kind.name).collect()
}

/// The JSON Schema of the protocol.
#[pyfunction]
pub fn schema() -> String {
    protocol_schema::text()
}
