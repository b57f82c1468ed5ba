//! What a rule of the seam came to, and how it is said.

use crate::check::{DataCheck, Finding, Outcome};
use crate::rule::Rule;

/// What a rule came to: its findings, or why there is nothing that it is about.
pub(super) type Judged = Result<Vec<Finding>, &'static str>;

pub(super) fn judged(rule: Rule, scope: impl Into<String>, judged: Judged) -> DataCheck {
    let outcome = match judged {
        Ok(findings) => Outcome::of(findings),
        Err(why) => Outcome::NotApplicable { why: why.to_owned() },
    };
    DataCheck::new(rule, scope, outcome)
}

pub(super) fn finding(at: String, against: String, what: String, right: impl Into<String>) -> Finding {
    Finding { at, against: Some(against), what, right: right.into() }
}

pub(super) const NO_STATION: &str = "the line names no station";
pub(super) const NO_SIGNAL: &str = "the line sends no telegrams";
pub(super) const NO_CODES: &str = "the file has no [codes]";
pub(super) const NO_TRAIN: &str = "the file has no [train]";

pub(super) fn count(number: usize, one: &str) -> String {
    format!("{number} {one}{}", if number == 1 { "" } else { "s" })
}
