//! Directed vectors: short traces, each found because a wrong kernel answers it otherwise, that the walks do not have.
//!
//! `oracle/vectors/directed.jsonl` has one a line: the case, and the mutants of `proofs/mutants.toml` that it catches. The replies are those of
//! the kernel in this program. A search found them (`cargo run --release -p atc-prover -- old-rules --program vectors -- --seconds 20`), and a
//! test holds every line against its mutants.

use serde::Deserialize;
use serde_json::Value;

use super::case::Case;

const LINES: &str = include_str!("../../vectors/directed.jsonl");

/// A case, and what it catches.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Directed {
    /// The machine.
    pub machine: String,
    /// Mutants that answer otherwise.
    pub catches: Vec<String>,
    /// The body of `config`.
    pub config: Value,
    /// The bodies of the steps; none if the start must be rejected.
    pub steps: Vec<Value>,
}

impl Directed {
    /// The case.
    pub fn case(&self) -> Case {
        Case { machine: self.machine.clone(), config: self.config.clone(), steps: self.steps.clone() }
    }
}

/// All of them.
pub fn all() -> Vec<Directed> {
    LINES.lines().filter_map(|line| serde_json::from_str(line).ok()).collect()
}

#[cfg(test)]
mod tests {
    use super::{LINES, all};

    #[test]
    fn every_line_is_a_case_that_the_kernel_takes() {
        let all = all();
        assert_eq!(all.len(), LINES.lines().count());
        for (number, directed) in (1..).zip(all) {
            assert!(!directed.catches.is_empty(), "line {number} catches nothing");
            let expected = directed.case().expected();
            let expected = expected.unwrap_or_else(|why| panic!("line {number}: {why}"));
            assert_eq!(expected.is_rejected(), directed.steps.is_empty(), "line {number}");
        }
    }
}
