//! What changes from frame to frame, stored as changes.

use serde::{Deserialize, Serialize};

/// Words over time: those of one thing, and what of it they say.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Channel {
    /// The kind of thing: "circuit", "route", …
    pub kind: String,
    /// Its name.
    pub name: String,
    /// What of it.
    pub what: String,
    /// The frames of the changes, the first one 0: each as the distance from the one before.
    pub at: Vec<u32>,
    /// The word from there on, by its number.
    pub is: Vec<u32>,
}

/// Whole numbers over time, one for each frame.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Curve {
    /// The kind of thing.
    pub kind: String,
    /// Its name.
    pub name: String,
    /// What of it.
    pub what: String,
    /// The unit, for people.
    pub unit: String,
    /// By what a number is divided for people: 1 or more.
    pub per: u32,
    /// Each number as the distance from the last one that was there; null where there is none.
    pub by: Vec<Option<i64>>,
}
