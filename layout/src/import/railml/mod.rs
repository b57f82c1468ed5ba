//! railML 3 (3.1, 3.2 and what keeps to their names): infrastructure and interlocking.

mod circuits;
mod infrastructure;
mod interlocking;
mod limits;
mod machines;
mod places;
mod unread;
mod xml;

use std::collections::BTreeSet;

use super::complete::{complete, steepest};
use super::report::{Imported, Report};
use super::xml::other_root;
use crate::at::At;
use crate::description::Description;
use crate::form::Station;
use crate::problem::{Errors, Problem, Source};
use crate::rule::Rule;
use xml::Xml;

/// Reads a railML file.
pub fn import(source: &Source) -> Result<Imported, Errors> {
    let document = crate::import::xml::parse(source)?;
    let root = document.root_element();
    if root.tag_name().name() != "railML" {
        return Err(other_root(source, root, "railML", "a railML 3 file is expected"));
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
    let mut problems = twice(&document);
    let tracks = infrastructure::read(&xml, &mut report, &mut problems);
    if !problems.is_empty() {
        return Err(Errors::new(source, problems));
    }
    let mut station = Station { name: xml.title().unwrap_or_else(|| "railML".to_owned()), ..Station::default() };
    let mut placed = circuits::write(&xml, tracks, &mut station, &mut report);
    machines::write(&xml, &mut placed, &mut station, &mut report);
    clear_time(&xml, &mut station, &mut report);
    let gradients = document.descendants().filter_map(|node| Some((node, node.attribute("gradient")?)));
    // One that cannot be read may be any.
    let gradients = gradients.map(|(_, text)| text.trim().parse::<f64>().unwrap_or(f64::INFINITY));
    steepest(gradients, &mut station, &mut report).map_err(|problem| Errors::new(source, vec![problem]))?;
    interlocking::write(&xml, &placed, &mut station, &mut report);
    for name in ["times", "braking", "speed", "longest_train_m"] {
        report.defaulted.push(format!("[{name}]: the defaults of the layout form; the file says nothing of them"));
    }
    let (branches, stretches) = placed.limits.count();
    report.taken.push(format!("speeds of {branches} branches and {stretches} stretches of track"));
    xml.unused(&mut report);
    unread::tell(&xml, &mut report);
    super::read_again(&source.text, &mut station, &mut report);
    complete(&mut station, "railML", &mut report);
    super::line_speeds(&placed.limits, &placed.divided, &mut station, &mut report);
    super::read_again(&source.text, &mut station, &mut report);
    report.taken.push(format!("{} routes that a second reading of the file finds the same", station.routes.len()));
    Ok(Imported { description: Description { station, source: source.clone() }, report })
}

/// Ids that two elements have and that something refers to: it may mean either.
fn twice(document: &roxmltree::Document<'_>) -> Vec<Problem> {
    let mut seen = std::collections::BTreeMap::new();
    let mut problems = Vec::new();
    let named = document.root().descendants().flat_map(|node| node.attributes());
    let named: BTreeSet<&str> =
        named.filter(|at| at.name() == "ref" || at.name().ends_with("Ref")).map(|at| at.value()).collect();
    for node in document.root().descendants() {
        let Some(id) = node.attribute("id").filter(|id| named.contains(id)) else { continue };
        if let Some(first) = seen.insert(id, node) {
            let what = format!("two elements have the id {id}: {} and {}", Xml::at(first), Xml::at(node));
            let range = node.range().start..node.range().start + 1;
            problems.push(Problem::new(Rule::NameTwice, &range, what, "give each its own"));
        }
    }
    problems
}

/// A circuit counts as clear after the longest time that the file gives for one, if that is longer than the default.
fn clear_time(xml: &Xml<'_>, station: &mut Station, report: &mut Report) {
    let mut longest = station.times.clear_ms.value;
    for section in xml.all("tvdSection") {
        let Some(text) = section.attribute("partialRouteReleaseDelay") else { continue };
        match xml::duration(text) {
            Some(time) => longest = longest.max(time),
            None => report.lacking.push(format!(
                "a time of the {}: its partialRouteReleaseDelay {text:?} cannot be read",
                Xml::at(section)
            )),
        }
    }
    if longest > station.times.clear_ms.value {
        report.taken.push(format!("{longest} ms after which a circuit counts as clear: the longest of all sections"));
        station.times.clear_ms = At::derived(longest);
    }
}
