//! A calibration as text: TOML with the plan and the table's values.
//!
//! The table in a file need not be the computed one: a railway may have measured that it must be wider. It must contain the
//! computed one; a file whose table is narrower, by a slip or because the plan was edited, is refused.

use super::{Calibration, KNOTS, Plan, PlanError, spacing};
use atc_kernel::position::{Millibels, Table};
use serde::{Deserialize, Serialize};
use std::fmt;

/// The form that this version writes and reads.
const FORMAT: u32 = 1;

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct File {
    format: u32,
    plan: Plan,
    table: Values,
}

/// Level differences at the knots, 0.01 dB.
#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct Values {
    lowest: [i16; KNOTS],
    highest: [i16; KNOTS],
}

/// A text that is no calibration.
#[derive(Clone, Debug, PartialEq)]
pub enum TextError {
    /// It is no TOML of this form; the message has line, place and reason.
    Form(String),
    /// Another format number.
    Format(u32),
    /// The plan is none.
    Plan(PlanError),
    /// The table is narrower than the plan requires.
    Narrow {
        /// Which list.
        list: &'static str,
        /// The knot, 0 to 16.
        knot: usize,
        /// What the text has, 0.01 dB.
        found: i16,
        /// What the plan requires, 0.01 dB.
        bound: i16,
    },
}

impl fmt::Display for TextError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Form(message) => write!(f, "no calibration: {}", message.trim_end()),
            Self::Format(format) => write!(f, "format is {format}; this version reads {FORMAT}"),
            Self::Plan(error) => write!(f, "plan: {error}"),
            Self::Narrow { list, knot, found, bound } => {
                let side = if *list == "lowest" { "at most" } else { "at least" };
                write!(f, "table.{list}[{knot}] is {found}; by the plan it must be {side} {bound}")
            }
        }
    }
}

impl std::error::Error for TextError {}

impl Calibration {
    /// The calibration as TOML.
    ///
    /// # Panics
    /// Never: every value of a calibration has a form in TOML.
    pub fn to_toml(&self) -> String {
        let levels = |curve: &[Millibels; KNOTS]| curve.map(|level| level.0);
        let values = Values { lowest: levels(self.table.lowest()), highest: levels(self.table.highest()) };
        let file = File { format: FORMAT, plan: self.plan, table: values };
        toml::to_string(&file).expect("numbers, names and lists")
    }

    /// Reads what [`Self::to_toml`] writes.
    ///
    /// # Errors
    /// See [`TextError`]; every message says where and what would be right.
    pub fn from_toml(text: &str) -> Result<Self, TextError> {
        let file: File = toml::from_str(text).map_err(|error| TextError::Form(error.to_string()))?;
        if file.format != FORMAT {
            return Err(TextError::Format(file.format));
        }
        let computed = Self::new(file.plan).map_err(TextError::Plan)?;
        for knot in 0..KNOTS {
            let (found, bound) = (file.table.lowest[knot], computed.table.lowest()[knot].0);
            if found > bound {
                return Err(TextError::Narrow { list: "lowest", knot, found, bound });
            }
            let (found, bound) = (file.table.highest[knot], computed.table.highest()[knot].0);
            if found < bound {
                return Err(TextError::Narrow { list: "highest", knot, found, bound });
            }
        }
        let spacing = spacing(&file.plan).map_err(TextError::Plan)?;
        let table = Table::new(spacing, file.table.lowest.map(Millibels), file.table.highest.map(Millibels));
        Ok(Self { plan: file.plan, table: table.map_err(|error| TextError::Plan(PlanError::Table(error)))? })
    }
}
