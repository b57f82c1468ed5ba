//! Layouts in the forms of others: railML 3, PlanPro and OSRD infrastructures.

mod complete;
mod joints;
mod limits;
mod network;
mod only;
mod osrd;
mod planpro;
mod railml;
mod report;
mod search;
mod way;
mod xml;

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::io::{self, Read as _};
use std::path::Path;

use crate::at::At;
use crate::derive;
use crate::description::Description;
use crate::form::Station;
use crate::problem::{Errors, Problem, Source};
use crate::rule::Rule;
use crate::second;
use crate::text;
use limits::Limits;
use network::Divided;

pub use only::only;
pub use report::{Imported, Report};

/// The layout of a railML 3 file.
///
/// # Errors
/// That the text is no XML, no railML 3, or has nothing that a layout could be made of.
pub fn railml(name: &str, text: &str) -> Result<Imported, Errors> {
    railml::import(&Source { name: name.to_owned(), text: text.to_owned() })
}

/// The layout of a PlanPro file.
///
/// # Errors
/// That the text is no XML, no PlanPro, or has nothing that a layout could be made of.
pub fn planpro(name: &str, text: &str) -> Result<Imported, Errors> {
    planpro::import(&Source { name: name.to_owned(), text: text.to_owned() })
}

/// The layout of an OSRD infrastructure.
///
/// # Errors
/// That the text is no JSON, no infrastructure, or has nothing that a layout could be made of.
pub fn osrd(name: &str, text: &str) -> Result<Imported, Errors> {
    osrd::import(&Source { name: name.to_owned(), text: text.to_owned() })
}

/// The layout of a file of any form: TOML, railML 3 (`.xml`, `.railml`), PlanPro (`.xml`, `.ppxml`) or an OSRD infrastructure (`.json`); of
/// `-`, that of standard input, whose form its first letter tells. Which form an XML file has, its root element says.
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
    let ending = path.extension().map(|ending| ending.to_string_lossy().to_lowercase()).unwrap_or_default();
    if ending == "planpro" {
        let right = "unpack it, and give its content.xml or the .ppxml that the planning tool writes";
        return Err(broken(&name, "a .planpro file is a zip archive".to_owned(), right));
    }
    let text = text::utf8(bytes).map_err(|place| broken(&name, place, "save the file as UTF-8"))?;
    match (ending.as_str(), text.trim_start_matches('\u{feff}').trim_start().chars().next()) {
        ("toml", _) => of_toml(&name, &text),
        ("ppxml", _) => planpro(&name, &text),
        ("railml" | "railmlx", _) => railml(&name, &text),
        ("xml", _) => of_xml(&name, &text),
        ("json", _) => osrd(&name, &text),
        (_, Some('<')) if is_input => of_xml(&name, &text),
        (_, Some('{')) if is_input => osrd(&name, &text),
        _ if is_input => of_toml(&name, &text),
        _ => Err(broken(
            &name,
            "the name does not tell the form of the file".to_owned(),
            "it must end in .toml, .xml, .railml, .ppxml or .json",
        )),
    }
}

/// What is no PlanPro is taken for railML, whose import says what is wrong with it.
fn of_xml(name: &str, text: &str) -> Result<Imported, Errors> {
    let is_planpro =
        roxmltree::Document::parse(text).is_ok_and(|file| file.root_element().tag_name().name() == planpro::ROOT);
    if is_planpro { planpro(name, text) } else { railml(name, text) }
}

fn of_toml(name: &str, text: &str) -> Result<Imported, Errors> {
    Description::from_toml(name, text).map(|description| Imported { description, ..Imported::default() })
}

fn broken(name: &str, what: String, right: &str) -> Errors {
    let source = Source { name: name.to_owned(), text: String::new() };
    Errors::one(&source, Problem::new(Rule::Form, &(0..0), what, right))
}

/// Leaves out the routes that another reading of the file does not find as they are.
fn read_again(text: &str, station: &mut Station, report: &mut Report) {
    let model = derive::model(station, &mut Vec::new());
    let found = second::differences(text, &model).unwrap_or_default();
    for difference in &found {
        report.lacking.push(match difference.route {
            Some(_) => format!("{difference}; so says a second reading of the file, and it is left out"),
            None => format!("{difference}; so says a second reading of the file"),
        });
    }
    let wrong: BTreeSet<&String> = found.iter().filter_map(|difference| difference.route.as_ref()).collect();
    station.routes.retain(|route| !wrong.contains(&route.name.value));
    for route in &mut station.routes {
        route.conflicts.retain(|other| !wrong.contains(&other.value));
    }
}

/// Plain line is as fast as the slowest of its circuits. A route's speed that is no lower than the station's is left out.
fn line_speeds(limits: &Limits, divided: &Divided, station: &mut Station, report: &mut Report) {
    let numbers: BTreeMap<String, usize> =
        station.circuits.iter().enumerate().map(|(number, circuit)| (circuit.name.value.clone(), number)).collect();
    let highest = station.braking.speeds_kmh.iter().max().copied().unwrap_or(0);
    for segment in &mut station.segments {
        let circuits = segment.circuits.iter().filter_map(|name| numbers.get(&name.value).copied()).collect();
        let limit = limits.in_circuits(&circuits, divided).filter(|limit| *limit < highest);
        if let Some(limit) = limit {
            report.taken.push(format!("segment {}: {limit} km/h", segment.name));
            segment.speed_kmh = Some(At::derived(limit));
        }
    }
}
