//! XML: what all forms of it have in common.

use roxmltree::{Document, Node};

use crate::problem::{Errors, Problem, Source};
use crate::rule::Rule;

/// The document of a text.
///
/// # Errors
/// It is no XML.
pub fn parse(source: &Source) -> Result<Document<'_>, Errors> {
    Document::parse(&source.text).map_err(|error| {
        let place = error.pos();
        let lines = source.text.split_inclusive('\n').take(place.row as usize - 1);
        let start = lines.map(str::len).sum::<usize>() + place.col as usize - 1;
        let mut start = start.min(source.text.len().saturating_sub(1));
        while !source.text.is_char_boundary(start) {
            start -= 1;
        }
        let what = format!("this is no XML: {error}");
        Errors::one(source, Problem::new(Rule::Form, &(start..start + 1), what, "mend the file"))
    })
}

/// That the root element is another one than this form has.
pub fn other_root(source: &Source, root: Node<'_, '_>, own: &str, right: &str) -> Errors {
    let what = format!("the root element is {}, not {own}", root.tag_name().name());
    Errors::one(source, Problem::new(Rule::Form, &root.range(), what, right))
}
