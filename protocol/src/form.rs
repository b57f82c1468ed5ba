//! Protocol 1: the forms of a line.
//!
//! A client writes one request a line and reads one reply a line, in the same order.
//!
//! | request | replies |
//! |---|---|
//! | `{"start":{"protocol":1,"machine":…,"config":{…}}}` | `{"started":{…}}`, `{"rejected":{"reason":…}}` |
//! | `{"step":{…}}` | `{"output":{…}}` |
//! | `{"stop":{}}` | `{"stopped":{…}}` |
//! | anything else | `{"malformed":{"reason":…}}` |
//!
//! What stands in `config`, `step` and `output` is the machine's: see [`crate::machine`]. A reply may have more fields
//! than a client knows; a request may not.
//!
//! Decisions:
//! * Every line is answered by exactly one line, an empty one too: it is malformed. So is a line of more than 1 MiB,
//!   whose rest is passed over, and one that is not UTF-8. The session goes on behind it, the case as it was.
//! * A start inside a case, a step or stop outside one, a field twice and an unknown field are malformed.
//! * A configuration that can be read and breaks a rule, an unknown machine and an unknown protocol are rejected.
//! * An aspect that the line does not have, or one named twice, is malformed and not stepped. A receiver takes an
//!   unknown code for no signal; here that would hide that two implementations read different tables.
//! * A speed is read from its digits. It must be whole tenths of km/h; how large it is, and whether it is negative, is
//!   for the machine to judge.

use std::borrow::Cow;
use std::fmt;

use schemars::JsonSchema;
use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};
use serde_json::value::RawValue;

use crate::decimal::shorten;

/// The version of the protocol.
pub const PROTOCOL: u32 = 1;

/// A request, as far as it can be read without knowing the machine.
#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Request<'a> {
    /// Begins a case; the body is a [`Start`].
    #[serde(borrow)]
    Start(&'a RawValue),
    /// One logic cycle; the body is the machine's.
    Step(&'a RawValue),
    /// Ends the case; the body is a [`Stop`].
    Stop(&'a RawValue),
}

/// The body of a start.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Start<'a> {
    /// The version of the protocol that the client speaks.
    pub protocol: u32,
    /// The machine's name.
    #[serde(borrow)]
    pub machine: Cow<'a, str>,
    /// The machine's configuration. Absent is the same as `{}`.
    #[serde(borrow)]
    pub config: Option<&'a RawValue>,
}

/// The body of a stop: no field.
#[derive(Clone, Copy, Debug, Default, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Stop {}

/// The reply to a stop.
#[derive(Clone, Copy, Debug, Serialize, JsonSchema)]
pub struct Stopped {
    /// How many steps the case had.
    pub steps: u64,
}

/// The reply to a start that breaks a rule. No case is open.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
pub struct Rejected {
    /// The rule that is broken, with the numbers that break it.
    pub reason: String,
}

/// The reply to a line that is not understood. Nothing has changed.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
pub struct Malformed {
    /// Where, what, and what would be right.
    pub reason: String,
    /// The number of the line in the input, from 1.
    #[serde(default)]
    pub line: u64,
}

/// What is wrong in a text.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Fault {
    /// The column in bytes from 1, if it is known.
    pub column: Option<usize>,
    /// What is wrong there.
    pub what: String,
}

impl Fault {
    /// A fault of the text as a whole.
    pub fn whole(what: impl Into<String>) -> Self {
        Self { column: None, what: what.into() }
    }
}

impl fmt::Display for Fault {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.column {
            Some(column) => write!(f, "column {column}: {}", self.what),
            None => f.write_str(&self.what),
        }
    }
}

/// Reads the form of a request. Its bodies borrow from `line`.
///
/// # Errors
/// If `line` is not JSON, or not an object with exactly one of the three keys.
pub fn request(line: &str) -> Result<Request<'_>, Fault> {
    const FORMS: &str = r#"a request is {"start":{…}}, {"step":{…}} or {"stop":{}}"#;
    if line.starts_with('\u{feff}') {
        return Err(Fault { column: Some(1), what: format!("a byte order mark; save the text without it; {FORMS}") });
    }
    if line.trim_ascii().is_empty() {
        return Err(Fault::whole(format!("the line is empty; {FORMS}")));
    }
    read(line, 0).map_err(|fault| Fault { what: format!("{}; {FORMS}", fault.what), ..fault })
}

/// Reads a body, which must be an object. `line` is the text that it stands in, for the column of a fault.
///
/// # Errors
/// If it is not an object of this type.
pub fn body<T: DeserializeOwned>(line: &str, body: &RawValue) -> Result<T, Fault> {
    let offset = offset(line, body);
    object(body, offset)?;
    read(body.get(), offset).or_else(|fault| {
        // JSON has one kind of number: 10.0 is the whole number 10, and JSON Schema takes it for one.
        let text = body.get();
        let whole = text.contains(".0").then(|| without_fractions(text)).filter(|whole| whole != text);
        whole.and_then(|whole| read(&whole, offset).ok()).ok_or(fault)
    })
}

/// The text with every number like `10.0` outside strings as `10`.
fn without_fractions(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    let (mut in_string, mut escaped) = (false, false);
    let mut rest = text;
    while let Some(letter) = rest.chars().next() {
        let after_digit = out.ends_with(|before: char| before.is_ascii_digit());
        if !in_string && letter == '.' && after_digit {
            let digits = &rest[1..];
            let zeros = digits.len() - digits.trim_start_matches('0').len();
            let next = digits[zeros..].chars().next();
            let ends = next.is_none_or(|next| !next.is_ascii_digit() && next != 'e' && next != 'E');
            if zeros > 0 && ends {
                rest = &digits[zeros..];
                continue;
            }
        }
        in_string ^= letter == '"' && !escaped;
        escaped = in_string && letter == '\\' && !escaped;
        out.push(letter);
        rest = &rest[letter.len_utf8()..];
    }
    out
}

/// Reads the body of a start, which borrows from `line`.
///
/// # Errors
/// If it is not an object of this type.
pub fn start<'a>(line: &str, body: &'a RawValue) -> Result<Start<'a>, Fault> {
    let offset = offset(line, body);
    object(body, offset)?;
    read(body.get(), offset)
}

/// Serde reads a struct from an array as well: here it is an object or a fault.
fn object(body: &RawValue, offset: usize) -> Result<(), Fault> {
    if body.get().starts_with('{') {
        Ok(())
    } else {
        let what = format!("expected an object, found {}", shorten(body.get()));
        Err(Fault { column: Some(offset + 1), what })
    }
}

/// Where `body` begins in the line that it was read from, in bytes; 0 if it is not part of it.
fn offset(line: &str, body: &RawValue) -> usize {
    let offset = (body.get().as_ptr() as usize).wrapping_sub(line.as_ptr() as usize);
    if offset < line.len() { offset } else { 0 }
}

/// Reads JSON; a fault's column counts from `offset`.
fn read<'a, T: Deserialize<'a>>(text: &'a str, offset: usize) -> Result<T, Fault> {
    serde_json::from_str(text).map_err(|error| {
        let place = format!(" at line {} column {}", error.line(), error.column());
        let said = error.to_string();
        let what = said.strip_suffix(&place).unwrap_or(&said).to_owned();
        // A text of one line; only whitespace could make it more.
        Fault { column: (error.line() == 1).then_some(error.column() + offset), what }
    })
}

#[cfg(test)]
mod tests {
    use super::{request, without_fractions};

    #[test]
    fn a_fraction_of_nothing_is_left_out_and_no_other() {
        let text = r#"{"a":10.0,"b":[1.00,2.5,3.0e2],"c":"4.0 \" 5.0","d":-7.0}"#;
        assert_eq!(without_fractions(text), r#"{"a":10,"b":[1,2.5,3.0e2],"c":"4.0 \" 5.0","d":-7}"#);
    }

    #[test]
    fn a_byte_order_mark_is_named() {
        let fault = request("\u{feff}{\"stop\":{}}").expect_err("it is no JSON");
        assert!(fault.what.starts_with("a byte order mark"), "{fault}");
    }
}
