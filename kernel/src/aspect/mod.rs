//! On-board aspect acceptance: which of the received cab-signal aspects is displayed (JP3886280B2).
//!
//! The receiver says each logic cycle which aspects it has heard throughout the cycle. An aspect is *accepted* once
//! it has been heard for the operate time; it may then be lost for a while (recovery, then the no-signal mask)
//! before it is gone; and an aspect that was accepted, and interrupted only shortly, is accepted again after a
//! shorter operate time. Of all that stand, the lowest is displayed; no display means stop.
//!
//! Requirements: `spec/aspect.md`, ACC-1 to ACC-9 and TIME-1 to TIME-4. Read in this order: [`Times`] (parameters),
//! [`AspectSet`] and [`Display`] (input and output), [`State`] with its `is_valid`, and [`step`].

mod acceptance;
mod set;
mod table;
mod times;

pub use acceptance::{Acceptance, MAX_ASPECTS, Parts, State, step};
pub use set::{AspectId, AspectSet, Display};
pub use table::{AspectTable, TableError};
pub use times::{Times, TimesError, TimesMs};
