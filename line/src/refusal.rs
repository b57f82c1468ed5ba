//! Why a parameter is refused: said once, for a session of the oracle and for a file.

use crate::rule::Rule;
use atc_kernel::distance::Metres;
use atc_kernel::pattern::Deceleration;
use atc_kernel::telegram::Gradient;

/// A rule that a group of parameters breaks.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Refusal {
    /// The rule.
    pub rule: Rule,
    /// The field that breaks it, as its group names it: `life_ms`, `aspects_km_h[2]`.
    pub field: String,
    /// What is wrong and what would be right, in a sentence that names the field.
    pub what: String,
}

impl Refusal {
    /// A refusal of `field`.
    pub fn new(rule: Rule, field: impl Into<String>, what: impl Into<String>) -> Self {
        Self { rule, field: field.into(), what: what.into() }
    }
}

/// A session has no places: the sentence is all.
impl From<Refusal> for String {
    fn from(refusal: Refusal) -> Self {
        refusal.what
    }
}

/// A number that must fit its field.
///
/// # Errors
/// If it does not fit: `range` says what would be right.
pub fn fit<T: TryFrom<i64>>(field: &str, number: impl Into<i64>, range: &str) -> Result<T, Refusal> {
    let number = number.into();
    let what = || Refusal::new(Rule::Range, field, format!("{field} is {number}; it must be {range}"));
    T::try_from(number).map_err(|_| what())
}

/// A gradient in thousandths.
///
/// # Errors
/// If it does not fit, with the name of its field.
pub fn gradient(field: &str, permille: i32) -> Result<Gradient, Refusal> {
    fit(field, permille, "-128 to 127 thousandths").map(Gradient)
}

/// Whole metres.
///
/// # Errors
/// If they do not fit, with the name of their field.
pub fn metres(field: &str, metres: u32) -> Result<Metres, Refusal> {
    fit(field, metres, "0 to 65535 m").map(Metres)
}

/// The brake of a train on the level.
///
/// # Errors
/// If it is out of its range.
pub fn brake(field: &str, mm_s2: u32) -> Result<Deceleration, Refusal> {
    let brake = u16::try_from(mm_s2).ok().and_then(Deceleration::brake);
    let what = || Refusal::new(Rule::Pat3, field, format!("{field} is {mm_s2}; it must be 1 to 4095 mm/s²"));
    brake.ok_or_else(what)
}

/// That a time that must be one cycle or more rounds down to none.
pub(crate) fn short(rule: Rule, field: &str, ms: u32, cycle: u32) -> Refusal {
    let what = format!("{field} is {ms} ms, less than one cycle of {cycle} ms; it must be {cycle} ms or more");
    Refusal::new(rule, field, what)
}

/// That there is no logic cycle.
pub(crate) fn no_cycle(rule: Rule) -> Refusal {
    Refusal::new(rule, "cycle_ms", "cycle_ms is 0; a logic cycle is 1 ms or more")
}
