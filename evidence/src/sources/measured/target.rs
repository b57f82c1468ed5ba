//! A target that figures must meet, and its id.

/// A target that figures must meet.
#[derive(Clone, Copy, Debug)]
pub struct Target {
    /// Its name: evidence `measured:` and this.
    pub name: &'static str,
    /// The part of the railway that it is about.
    pub part: &'static str,
    /// What is shown when it is met.
    pub statement: &'static str,
}

pub(super) const fn target(name: &'static str, part: &'static str, statement: &'static str) -> Target {
    Target { name, part, statement }
}

/// The evidence id of a target.
pub fn id(name: &str) -> String {
    format!("measured:{name}")
}
