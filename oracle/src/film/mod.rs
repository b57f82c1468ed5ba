//! Films of recorded sessions and of the traces of models: [`film`] runs a case through the kernel and lays out its
//! frames.
//!
//! Every machine gets the rows of its chart and the values of each step. The interlocking gets a track plan: from the
//! layout of its configuration, from one that is given, or a schematic after the paths of its routes.

mod inside;
pub(crate) mod interlocking;
mod lanes;
pub(crate) mod made;
mod plain;
mod schematic;
mod stage;
pub(crate) mod take;
mod traced;
mod words;

use atc_film::Film;

use crate::trace::{Record, TraceError};

pub use take::{Setting, Take, Words};
pub use traced::{Traced, TracedError, read};

/// The film of a recorded case.
///
/// # Errors
/// As [`crate::trace::Trace::scenes`]; and a layout that does not fit.
pub fn film(record: &Record, setting: &Setting) -> Result<Film, TraceError> {
    record.film(setting)
}
