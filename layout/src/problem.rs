//! What is wrong with a layout: the rule, the place in the file, what was found and what would be right.

use std::fmt;
use std::ops::Range;

use crate::rule::Rule;

/// A text and where it came from.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Source {
    /// The file, as the caller named it; empty for a text that is no file.
    pub name: String,
    /// Its text; empty where places in it are not known.
    pub text: String,
}

/// A place in a text, both numbers from 1; columns are characters.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct LineColumn {
    /// The line.
    pub line: usize,
    /// The column.
    pub column: usize,
}

impl Source {
    /// The place of a byte of the text; `None` if the text is not known.
    pub fn place(&self, span: &Range<usize>) -> Option<LineColumn> {
        if span.is_empty() {
            return None;
        }
        let before = self.text.get(..span.start)?;
        let line = before.matches('\n').count() + 1;
        let column = before.rsplit('\n').next().map_or(0, |last| last.chars().count()) + 1;
        Some(LineColumn { line, column })
    }
}

/// A rule that a layout breaks.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Problem {
    /// The rule.
    pub rule: Rule,
    /// Where in the source; empty if it stands nowhere.
    pub span: Range<usize>,
    /// The same as line and column.
    pub place: Option<LineColumn>,
    /// What is wrong, with the names of the things concerned.
    pub what: String,
    /// What would be right.
    pub right: String,
}

impl Problem {
    /// A problem at `span`, whose line is not yet known.
    pub fn new(rule: Rule, span: &Range<usize>, what: impl Into<String>, right: impl Into<String>) -> Self {
        Self { rule, span: span.clone(), place: None, what: what.into(), right: right.into() }
    }
}

/// Everything that is wrong with a layout, in the order of the file: never empty where it is an error.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Errors {
    /// The file, as the caller named it.
    pub source: String,
    /// The broken rules.
    pub problems: Vec<Problem>,
}

impl Errors {
    /// The problems of `source`, with their lines, sorted by place.
    pub fn new(source: &Source, mut problems: Vec<Problem>) -> Self {
        for problem in &mut problems {
            problem.place = source.place(&problem.span);
        }
        problems.sort_by(|a, b| (a.place, &a.what).cmp(&(b.place, &b.what)));
        problems.dedup();
        Self { source: source.name.clone(), problems }
    }

    /// A single problem.
    pub fn one(source: &Source, problem: Problem) -> Self {
        Self::new(source, vec![problem])
    }

    /// Whether the rule is among those that are broken.
    pub fn breaks(&self, rule: Rule) -> bool {
        self.problems.iter().any(|problem| problem.rule == rule)
    }
}

impl fmt::Display for Errors {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let name = if self.source.is_empty() { "layout" } else { &self.source };
        for (number, problem) in self.problems.iter().enumerate() {
            if number > 0 {
                f.write_str("\n")?;
            }
            f.write_str(name)?;
            if let Some(LineColumn { line, column }) = problem.place {
                write!(f, ":{line}:{column}")?;
            }
            write!(f, ": {}", problem.what)?;
            if !problem.right.is_empty() {
                write!(f, "; {}", problem.right)?;
            }
            write!(f, " [{}]", problem.rule.name())?;
        }
        Ok(())
    }
}

impl std::error::Error for Errors {}
