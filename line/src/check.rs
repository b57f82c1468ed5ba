//! A rule and what it came to, for lines and for stations. What decides is [`Outcome`], never a word of a text.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::rule::{Asked, Rule};

/// One rule and its verdict.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct DataCheck {
    /// Its name, as in messages.
    pub rule: String,
    /// What it demands.
    pub text: String,
    /// Who asks for it.
    pub asked: Asked,
    /// What it was held against: `30 routes`.
    pub scope: String,
    /// What it came to.
    pub outcome: Outcome,
}

/// What a data check came to.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case", tag = "is", deny_unknown_fields)]
pub enum Outcome {
    /// The rule is kept everywhere.
    Met,
    /// The rule is broken.
    Broken {
        /// Where, what was found, and what would be right: at least one.
        why: Vec<Finding>,
    },
    /// Other rules are broken, so this one could not be looked at everywhere.
    NotChecked,
    /// There is nothing that it could be held against.
    NotApplicable {
        /// What is not there.
        why: String,
    },
}

/// A place where a rule is broken.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Finding {
    /// File, line and column; the file alone if it stands nowhere.
    pub at: String,
    /// The place that it disagrees with, in the same form; none if it is wrong by itself.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub against: Option<String>,
    /// What is wrong.
    pub what: String,
    /// What would be right; empty if `what` says it.
    pub right: String,
}

impl Outcome {
    /// Met if there are no findings.
    pub fn of(why: Vec<Finding>) -> Self {
        if why.is_empty() { Self::Met } else { Self::Broken { why } }
    }

    /// Whether nothing speaks against the data: the rule is met, or there is nothing that it is about.
    pub const fn holds(&self) -> bool {
        matches!(self, Self::Met | Self::NotApplicable { .. })
    }
}

impl DataCheck {
    /// A rule of lines.
    pub fn new(rule: Rule, scope: impl Into<String>, outcome: Outcome) -> Self {
        let (id, text) = (rule.id().to_owned(), rule.text().to_owned());
        Self { rule: id, text, asked: rule.asked(), scope: scope.into(), outcome }
    }

    /// Where it is broken.
    pub fn findings(&self) -> &[Finding] {
        if let Outcome::Broken { why } = &self.outcome { why } else { &[] }
    }
}

impl std::fmt::Display for Finding {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{}: {}", self.at, self.what)?;
        if !self.right.is_empty() {
            write!(f, "; {}", self.right)?;
        }
        self.against.as_ref().map_or(Ok(()), |against| write!(f, " (against {against})"))
    }
}
