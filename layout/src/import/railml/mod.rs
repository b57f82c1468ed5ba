//! railML 3 (3.1, 3.2 and what keeps to their names): infrastructure and interlocking.

mod circuits;
mod infrastructure;
mod interlocking;
mod xml;

use super::complete::complete;
use super::{Imported, Report};
use crate::description::Description;
use crate::form::Station;
use crate::problem::{Errors, Problem, Source};
use crate::rule::Rule;
use xml::Xml;

/// Reads a railML file.
pub fn import(source: &Source) -> Result<Imported, Errors> {
    let document = roxmltree::Document::parse(&source.text).map_err(|error| {
        let place = error.pos();
        let lines = source.text.split_inclusive('\n').take(place.row as usize - 1);
        let start = lines.map(str::len).sum::<usize>() + place.col as usize - 1;
        let mut start = start.min(source.text.len().saturating_sub(1));
        while !source.text.is_char_boundary(start) {
            start -= 1;
        }
        Errors::one(
            source,
            Problem::new(Rule::Form, &(start..start + 1), format!("this is no XML: {error}"), "mend the file"),
        )
    })?;
    let root = document.root_element();
    if root.tag_name().name() != "railML" {
        let what = format!("the root element is {}, not railML", root.tag_name().name());
        return Err(Errors::one(source, Problem::new(Rule::Form, &root.range(), what, "a railML 3 file is expected")));
    }
    let namespace = root.tag_name().namespace().unwrap_or_default().to_owned();
    let version = root.attribute("version").unwrap_or_default();
    if namespace.contains("/schemas/2") || version.starts_with('2') || version.starts_with('1') {
        let what = format!("this is railML {version} ({namespace})");
        return Err(Errors::one(
            source,
            Problem::new(Rule::Form, &root.range(), what, "railML 3.1 or later is expected"),
        ));
    }
    let mut report = Report::default();
    match namespace.rsplit_once("/schemas/").map(|(_, version)| version) {
        Some("3.1" | "3.2") => report.taken.push(format!("railML {version} of the namespace {namespace}")),
        _ => report.defaulted.push(format!("the namespace {namespace:?} is read as railML 3.2")),
    }
    let xml = Xml::new(&document);
    let mut problems = Vec::new();
    let tracks = infrastructure::read(&xml, &mut report, &mut problems);
    if !problems.is_empty() {
        return Err(Errors::new(source, problems));
    }
    let mut station = Station { name: xml.title().unwrap_or_else(|| "railML".to_owned()), ..Station::default() };
    let placed = circuits::write(&xml, tracks, &mut station, &mut report);
    interlocking::write(&xml, &placed, &mut station, &mut report);
    for name in ["times", "braking", "speed", "longest_train_m"] {
        report.defaulted.push(format!("[{name}]: the defaults of the layout form; the file says nothing of them"));
    }
    xml.unused(&mut report);
    complete(&mut station, "railML", &mut report);
    Ok(Imported { description: Description { station, source: source.clone() }, report })
}
