//! A second reading of a railML or PlanPro file, held against the layout that was made of it.
//!
//! The import makes circuits of the tracks and looks for a way through them. This reading shares nothing with it but the library that reads
//! XML: it lets a train run over the net elements of the file, in metres, from each route's signal to its exit, and asks whether the
//! layout's route is what the train has met: joints, sections in order, points and their positions, limits of speed, times. What differs
//! leaves the route out. It also holds a layout that was written by hand against a file.

mod compare;
mod difference;
mod file;
mod held;
mod parts;
mod planpro;
mod positions;
mod readings;
mod walk;

use crate::model::Model;
use crate::problem::Source;

pub use difference::Difference;

/// Everything in which `model` is not what the text of a railML or PlanPro file says.
///
/// # Errors
/// That the text is no XML.
pub fn differences(text: &str, model: &Model) -> Result<Vec<Difference>, String> {
    let document = roxmltree::Document::parse(text).map_err(|error| error.to_string())?;
    let source = Source { name: String::new(), text: text.to_owned() };
    if document.root_element().tag_name().name() == "PlanPro_Schnittstelle" {
        return Ok(planpro::differences(&document, model, &source));
    }
    let file = file::File::of(&document);
    let mut found = parts::differences(&file, model, &source);
    found.extend(compare::differences(&file, model, &source));
    Ok(found)
}
