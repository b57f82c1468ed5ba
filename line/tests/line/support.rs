//! Lines for tests: the example of the patent, and the example with two stations.

use atc_line::{Line, Problems};
use std::path::Path;

/// The patent's example.
pub const EXAMPLE: &str = include_str!("../../../evidence/examples/my-line.toml");

/// The line of a text without stations.
pub fn parse(name: &str, text: &str) -> Result<Line, Problems> {
    atc_line::parse(name, text, Path::new("."))
}

/// A figure that follows from a line's parameters, by the beginning of its name.
pub fn value(text: &str, name: &str) -> String {
    let line = parse("l.toml", text).expect("good");
    line.derived().iter().find(|one| one.name.starts_with(name)).map(|one| one.value.clone()).unwrap_or_default()
}
