//! Faults in what the case is made of: where, and what would be right.

use std::fmt::{self, Display};
use std::path::Path;

/// One fault in an input. It stops the build of the case.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Fault {
    /// A file, with its line where that is known.
    pub at: String,
    /// What is wrong, and what would be right.
    pub text: String,
}

impl Fault {
    /// A fault at a place.
    pub fn new(at: &impl Display, text: impl Display) -> Self {
        Self { at: at.to_string(), text: text.to_string() }
    }
}

impl Display for Fault {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}: {}", self.at, self.text)
    }
}

impl std::error::Error for Fault {}

/// The text of a file.
///
/// # Errors
/// It cannot be read.
pub fn read(path: &Path) -> Result<String, Fault> {
    std::fs::read_to_string(path).map_err(|error| Fault::new(&path.display(), error))
}

/// The line (from 1) of a byte offset.
pub fn line_of(text: &str, offset: usize) -> usize {
    text.bytes().take(offset).filter(|byte| *byte == b'\n').count() + 1
}
