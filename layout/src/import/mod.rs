//! Layouts in the forms of others: railML 3 and OSRD infrastructures.

mod complete;
mod network;
mod only;
mod osrd;
mod railml;
mod report;
mod search;

use std::fs;
use std::io::{self, Read as _};
use std::path::Path;

use crate::description::Description;
use crate::problem::{Errors, Problem, Source};
use crate::rule::Rule;

pub use only::only;
pub use report::{Imported, Report};

/// The layout of a railML 3 file.
///
/// # Errors
/// That the text is no XML, no railML 3, or has nothing that a layout could be made of.
pub fn railml(name: &str, text: &str) -> Result<Imported, Errors> {
    railml::import(&Source { name: name.to_owned(), text: text.to_owned() })
}

/// The layout of an OSRD infrastructure.
///
/// # Errors
/// That the text is no JSON, no infrastructure, or has nothing that a layout could be made of.
pub fn osrd(name: &str, text: &str) -> Result<Imported, Errors> {
    osrd::import(&Source { name: name.to_owned(), text: text.to_owned() })
}

/// The layout of a file of any form: TOML, railML 3 (`.xml`, `.railml`) or an OSRD infrastructure (`.json`); of `-`, that of standard input,
/// whose form its first letter tells.
///
/// # Errors
/// That the file cannot be read, or is not of the form that its name says.
pub fn read_any(path: impl AsRef<Path>) -> Result<Imported, Errors> {
    let path = path.as_ref();
    let is_input = path == Path::new("-");
    let name = if is_input { "standard input".to_owned() } else { path.display().to_string() };
    let unread = |error: io::Error| broken(&name, format!("cannot be read: {error}"), "");
    let bytes = if is_input {
        let mut bytes = Vec::new();
        io::stdin().lock().read_to_end(&mut bytes).map_err(unread)?;
        bytes
    } else {
        fs::read(path).map_err(unread)?
    };
    let text = String::from_utf8(bytes).map_err(|error| {
        let valid = error.utf8_error().valid_up_to();
        broken(&name, format!("byte {valid} is not UTF-8"), "save the file as UTF-8")
    })?;
    let ending = path.extension().map(|ending| ending.to_string_lossy().to_lowercase()).unwrap_or_default();
    match (ending.as_str(), text.trim_start_matches('\u{feff}').trim_start().chars().next()) {
        ("toml", _) => of_toml(&name, &text),
        ("xml" | "railml" | "railmlx", _) => railml(&name, &text),
        ("json", _) => osrd(&name, &text),
        (_, Some('<')) if is_input => railml(&name, &text),
        (_, Some('{')) if is_input => osrd(&name, &text),
        _ if is_input => of_toml(&name, &text),
        _ => Err(broken(
            &name,
            "the name does not tell the form of the file".to_owned(),
            "it must end in .toml, .xml, .railml or .json",
        )),
    }
}

fn of_toml(name: &str, text: &str) -> Result<Imported, Errors> {
    Description::from_toml(name, text).map(|description| Imported { description, ..Imported::default() })
}

fn broken(name: &str, what: String, right: &str) -> Errors {
    let source = Source { name: name.to_owned(), text: String::new() };
    Errors::one(&source, Problem::new(Rule::Form, &(0..0), what, right))
}
