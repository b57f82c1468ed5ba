//! What is wrong with a trace, and what is asked of its replies.

use std::fmt;

use atc_protocol::form::Fault;

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
