//! A model that is written once more, by hand, in Promela.

use std::borrow::Cow;

/// A model in Promela.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Twin {
    /// The text. Its properties are named as ours, with `_` for `-`: `always` ones as they are, those to be reached `never_…`.
    pub promela: Cow<'static, str>,
    /// What its macros are defined as.
    pub parameters: Vec<(&'static str, u8)>,
    /// Whether it starts in one state and then chooses the faulty components, where ours has an initial state for each choice. The
    /// choice of none leads from that state to itself: one step more than we have.
    pub chooses: bool,
}
