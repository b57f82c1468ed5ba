//! Rows over time. Spans are in frames, the end not included.

use serde::{Deserialize, Serialize};

/// A row.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Lane {
    /// What the row shows.
    pub label: String,
    /// The first row of a group has a line above it.
    pub first: bool,
    /// Its height, in pixels at the usual size.
    pub height: u32,
    /// The range of the row's values, if it has lines.
    pub scale: Option<(f64, f64)>,
    /// What is drawn in it.
    pub marks: Vec<Mark>,
}

/// Something in a row.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Mark {
    /// A two-valued signal: high in these spans.
    Wave(Vec<(u64, u64)>),
    /// Filled spans.
    Bars(Vec<Bar>),
    /// A value over time.
    Line(Line),
    /// Between two values over time: tone, and steps of frame and pair.
    Band(String, Vec<(u64, Option<(f64, f64)>)>),
    /// Letters, one for each frame from the first on.
    Letters(u64, String),
    /// Signs at instants: a letter each.
    Signs(Vec<(u64, String)>),
}

/// A filled span: from, to, tone, text.
pub type Bar = (u64, u64, String, String);

/// A value over time.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Line {
    /// Its tone.
    pub tone: String,
    /// The values, each from its frame on; null where there is none.
    pub points: Vec<(u64, Option<f64>)>,
}

/// What a tone means.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Legend {
    /// The tone.
    pub tone: String,
    /// What it means.
    pub text: String,
}
