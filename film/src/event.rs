//! What happens in a film.

use serde::{Deserialize, Serialize};

/// What an event is about.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Class {
    /// An accident, or a difference between a record and the kernel.
    Harm,
    /// A fault begins.
    Fault,
    /// What a device answers has changed.
    Output,
    /// What is read has changed.
    Input,
}

/// Something that happens.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Event {
    /// The frame.
    pub at: u32,
    /// What it is about.
    pub class: Class,
    /// What, by the number of its text.
    pub text: u32,
}
