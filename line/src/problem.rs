//! What is wrong with a file that is not a line's, or whose values break a rule.

use std::fmt;

use crate::rule::Rule;

/// A rule that a file breaks, so that there is no line.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Problem {
    /// The rule.
    pub rule: Rule,
    /// File, line and column; the file alone if it stands nowhere.
    pub at: String,
    /// What is wrong, and what would be right.
    pub what: String,
}

impl fmt::Display for Problem {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.rule {
            Rule::Form | Rule::Range => write!(f, "{}: {}", self.at, self.what),
            rule => write!(f, "{}: rule {} is broken: {}", self.at, rule.id(), self.what),
        }
    }
}

/// Everything that keeps a file from being a line: never empty where it is an error.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Problems(pub Vec<Problem>);

impl Problems {
    /// Whether the file, or one that it names, cannot be read as what it should be: no rule on its values was looked at.
    pub fn is_unreadable(&self) -> bool {
        self.0.iter().any(|one| one.rule == Rule::Form)
    }
}

impl fmt::Display for Problems {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let all: Vec<_> = self.0.iter().map(Problem::to_string).collect();
        f.write_str(&all.join("\n"))
    }
}

impl std::error::Error for Problems {}
