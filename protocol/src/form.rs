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
use serde::de::{DeserializeOwned, Unexpected, Visitor};
use serde::{Deserialize, Deserializer, Serialize};
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
    #[serde(deserialize_with = "version")]
    pub protocol: u32,
    /// The machine's name.
    #[serde(borrow)]
    pub machine: Cow<'a, str>,
    /// The machine's configuration. Absent is the same as `{}`.
    #[serde(borrow)]
    pub config: Option<&'a RawValue>,
}

/// A version: a whole number, however it is written.
fn version<'de, D: Deserializer<'de>>(deserializer: D) -> Result<u32, D::Error> {
    struct Version;

    impl Visitor<'_> for Version {
        type Value = u32;

        fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
            f.write_str("u32")
        }

        fn visit_u64<E: serde::de::Error>(self, number: u64) -> Result<u32, E> {
            u32::try_from(number).map_err(|_| E::invalid_value(Unexpected::Unsigned(number), &self))
        }

        fn visit_i64<E: serde::de::Error>(self, number: i64) -> Result<u32, E> {
            u32::try_from(number).map_err(|_| E::invalid_value(Unexpected::Signed(number), &self))
        }

        fn visit_f64<E: serde::de::Error>(self, number: f64) -> Result<u32, E> {
            let digits = whole(&format!("{number:?}")).and_then(|digits| digits.parse().ok());
            digits.ok_or_else(|| E::invalid_type(Unexpected::Float(number), &self))
        }
    }

    deserializer.deserialize_u32(Version)
}

/// A line of a record, as it is written: a request, or the reply to a step.
#[derive(Clone, Copy, Debug, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Line<'a, T> {
    /// Begins a case.
    Start {
        /// The version of the protocol.
        protocol: u32,
        /// The machine's name.
        machine: &'a str,
        /// The machine's configuration.
        config: &'a T,
    },
    /// One logic cycle.
    Step(&'a T),
    /// What came of it.
    Output(&'a T),
}

impl<'a, T: Serialize> Line<'a, T> {
    /// A start in this version of the protocol.
    pub const fn start(machine: &'a str, config: &'a T) -> Self {
        Self::Start { protocol: PROTOCOL, machine, config }
    }

    /// The line without its newline.
    ///
    /// # Panics
    /// If the body is no JSON; the messages of the machines are.
    pub fn text(&self) -> String {
        serde_json::to_string(self).expect("a message is plain data")
    }
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
        // JSON has one kind of number: 10.0 and 1e1 are the whole number 10, and JSON Schema takes them for one.
        let text = body.get();
        let whole = with_whole_numbers(text);
        if whole == text { Err(fault) } else { read(&whole, offset).map_err(|_| fault) }
    })
}

/// The text with every number outside strings that is a whole one, such as `10.0` or `1e1`, in digits alone.
fn with_whole_numbers(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    let (mut in_string, mut escaped) = (false, false);
    let mut rest = text;
    while let Some(letter) = rest.chars().next() {
        let length = match letter {
            '-' | '0'..='9' if !in_string => {
                let of_number = |letter: char| letter.is_ascii_digit() || matches!(letter, '-' | '+' | '.' | 'e' | 'E');
                rest.find(|letter| !of_number(letter)).unwrap_or(rest.len())
            }
            _ => letter.len_utf8(),
        };
        let (token, after) = rest.split_at(length);
        in_string ^= letter == '"' && !escaped;
        escaped = in_string && letter == '\\' && !escaped;
        match whole(token) {
            Some(digits) if !in_string => out.push_str(&digits),
            _ => out.push_str(token),
        }
        rest = after;
    }
    out
}

/// The digits of a number with a fraction or an exponent that is a whole one of at most twenty digits.
fn whole(number: &str) -> Option<String> {
    let (sign, unsigned) = number.strip_prefix('-').map_or(("", number), |rest| ("-", rest));
    let (mantissa, exponent) = unsigned.split_once(['e', 'E']).unwrap_or((unsigned, "0"));
    let (before, behind) = mantissa.split_once('.').unwrap_or((mantissa, ""));
    let exponent: i32 = exponent.parse().ok().filter(|exponent| (-40..=40).contains(exponent))?;
    let all = format!("{before}{behind}");
    let point = i32::try_from(before.len()).ok()?.checked_add(exponent)?;
    if unsigned == before
        || before.is_empty()
        || mantissa.ends_with('.')
        || !all.bytes().all(|digit| digit.is_ascii_digit())
    {
        return None;
    }
    let point = usize::try_from(point.max(0)).ok()?;
    let (kept, lost) = all.split_at(point.min(all.len()));
    let digits = format!("{kept}{}", "0".repeat(point - kept.len()));
    let digits = digits.trim_start_matches('0');
    let fits = digits.len() <= 20 && lost.bytes().all(|digit| digit == b'0');
    fits.then(|| if digits.is_empty() { "0".to_owned() } else { format!("{sign}{digits}") })
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
    use super::{request, with_whole_numbers};

    #[test]
    fn a_whole_number_is_one_however_it_is_written() {
        for (text, right) in [
            (
                r#"{"a":10.0,"b":[1.00,2.5,3.0e2],"c":"4.0 \" 5.0","d":-7.0}"#,
                r#"{"a":10,"b":[1,2.5,300],"c":"4.0 \" 5.0","d":-7}"#,
            ),
            ("[1e0,1E1,100e-1,-2e+2,0e5,0.0,-0.0,12.50e1,1e19]", "[1,10,10,-200,0,0,0,125,10000000000000000000]"),
            // Neither whole nor numbers: as they are.
            (
                "[1e-1,1.5,12.5e0,1e20,1e999,1.,.5,1e,--1,1e1e1,01]",
                "[1e-1,1.5,12.5e0,1e20,1e999,1.,.5,1e,--1,1e1e1,01]",
            ),
        ] {
            assert_eq!(with_whole_numbers(text), right);
        }
    }

    #[test]
    fn a_byte_order_mark_is_named() {
        let fault = request("\u{feff}{\"stop\":{}}").expect_err("it is no JSON");
        assert!(fault.what.starts_with("a byte order mark"), "{fault}");
    }
}
