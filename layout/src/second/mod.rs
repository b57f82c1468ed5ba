//! A second reading of a railML file, held against the layout that was made of it.
//!
//! The import makes circuits of the tracks and looks for a way through them. This reading shares nothing with it but the library that reads
//! XML: it lets a train run over the net elements of the file, in metres, from each route's signal to its exit, and asks whether the
//! layout's route is what the train has met: joints, sections in order, points and their positions, limits of speed, times. What differs
//! leaves the route out. It also holds a layout that was written by hand against a file.

mod compare;
mod file;
mod parts;
mod walk;

use std::fmt;

use crate::model::Model;
use crate::problem::{LineColumn, Source};

/// Something in which the layout is not what the file says.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Difference {
    /// The route of the layout, if it is of one.
    pub route: Option<String>,
    /// What the layout has, and what the file says.
    pub what: String,
    /// Where the file says it.
    pub place: Option<LineColumn>,
}

impl fmt::Display for Difference {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if let Some(route) = &self.route {
            write!(f, "route {route}: ")?;
        }
        f.write_str(&self.what)?;
        self.place.map_or(Ok(()), |place| write!(f, " (line {})", place.line))
    }
}

/// Everything in which `model` is not what the railML text says.
///
/// # Errors
/// That the text is no XML.
pub fn differences(text: &str, model: &Model) -> Result<Vec<Difference>, String> {
    let document = roxmltree::Document::parse(text).map_err(|error| error.to_string())?;
    let file = file::File::of(&document);
    let source = Source { name: String::new(), text: text.to_owned() };
    let mut found = parts::differences(&file, model, &source);
    found.extend(compare::differences(&file, model, &source));
    Ok(found)
}
