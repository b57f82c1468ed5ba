//! The seam of a line: what stations and blocks count on, held against what trains do and against each other.
//!
//! Each finding names two places: `at` is the one to change, `against` the one that it disagrees with. Approach distances, residual running
//! and the time after a start are not looked at again: the layout's own rules derive them from its telegram age, its brake and its release
//! and turn times, and those are held against the trains here.

mod borders;
mod ranks;
mod telegrams;
mod trains;

use std::collections::BTreeSet;
use std::ops::Range;
use std::path::Path;

use atc_kernel::interlocking::Heading;
use atc_layout::form::Circuit;
use atc_layout::import::read_any;
use atc_layout::model::Model;
use atc_layout::{Description, Errors};

use crate::check::{DataCheck, Finding, Outcome};
use crate::form;
use crate::kmh::Kmh;
use crate::line::Line;
use crate::places::place;
use crate::rule::Rule;

pub use borders::{Between, Borders, Counted};
pub use telegrams::Telegram;

/// A station of a line.
#[derive(Clone, Debug)]
pub struct Station {
    description: Description,
    /// With everything derived; nothing if the layout breaks a rule that it needs.
    model: Option<Model>,
    /// What is wrong with the layout.
    problems: Vec<atc_layout::Problem>,
    code_speeds: Option<Vec<Kmh>>,
}

impl Station {
    /// Reads the layout of a station, in any form that layouts have.
    ///
    /// # Errors
    /// The file cannot be read, or is not of the form that its name says.
    pub(crate) fn read(given: &form::Station, code_speeds: Option<Vec<Kmh>>, folder: &Path) -> Result<Self, Errors> {
        let path = folder.join(&given.file);
        // A file of that name, and not standard input.
        let path = if path == Path::new("-") { Path::new(".").join(path) } else { path };
        let mut description = read_any(path)?.description;
        if let Some(name) = &given.name {
            description.station.name.clone_from(name);
        }
        let problems = description.compile().err().map(|errors| errors.problems).unwrap_or_default();
        let model = if problems.is_empty() { description.model().ok() } else { None };
        Ok(Self { description, model, problems, code_speeds })
    }

    /// The circuits that a train in `circuit` may be granted, its own among them; the own one alone of a layout that breaks a rule.
    fn ahead(&self, circuit: &Circuit, heading: Heading) -> BTreeSet<usize> {
        let number = self.description.station.circuits.iter().position(|other| other.name == circuit.name);
        let Some(number) = number else { return BTreeSet::new() };
        self.model.as_ref().map_or_else(|| [number].into(), |model| model.ahead(number, heading))
    }

    /// The highest speed of a train in `circuit`, in km/h; 0 of a layout that breaks a rule.
    fn fastest_kmh(&self, circuit: &Circuit, heading: Heading) -> u16 {
        let number = self.description.station.circuits.iter().position(|other| other.name == circuit.name);
        self.model.as_ref().zip(number).map_or(0, |(model, number)| model.fastest_kmh(number, heading))
    }

    /// What it is called.
    pub fn name(&self) -> &str {
        &self.description.station.name
    }

    /// Its layout, as its file has it.
    pub const fn description(&self) -> &Description {
        &self.description
    }

    /// Its layout with everything derived; none if it breaks a rule.
    pub const fn model(&self) -> Option<&Model> {
        self.model.as_ref()
    }

    /// Where something stands in its file; that it is not given, where it is a default or derived.
    fn at(&self, span: &Range<usize>) -> String {
        let source = &self.description.source;
        let at = place(source, span);
        if at == source.name { format!("{at} (not given)") } else { at }
    }
}

/// A station whose layout keeps every rule, with its number in the file of the line.
#[derive(Clone, Copy)]
struct Sound<'a> {
    number: usize,
    station: &'a Station,
    model: &'a Model,
}

impl Sound<'_> {
    fn name(&self) -> &str {
        self.station.name()
    }
}

impl Line {
    /// The stations whose layout keeps every rule.
    fn sound(&self) -> Vec<Sound<'_>> {
        let all = self.stations().iter().enumerate();
        all.filter_map(|(number, station)| Some(Sound { number, station, model: station.model.as_ref()? })).collect()
    }

    fn station(&self, name: &str) -> Option<(usize, &Station)> {
        self.stations().iter().enumerate().find(|(_, station)| station.name() == name)
    }
}

/// What a rule came to: its findings, or why there is nothing that it is about.
type Judged = Result<Vec<Finding>, &'static str>;

fn judged(rule: Rule, scope: impl Into<String>, judged: Judged) -> DataCheck {
    let outcome = match judged {
        Ok(findings) => Outcome::of(findings),
        Err(why) => Outcome::NotApplicable { why: why.to_owned() },
    };
    DataCheck::new(rule, scope, outcome)
}

fn finding(at: String, against: String, what: String, right: impl Into<String>) -> Finding {
    Finding { at, against: Some(against), what, right: right.into() }
}

const NO_STATION: &str = "the line names no station";
const NO_SIGNAL: &str = "the line sends no telegrams";
const NO_TRAIN: &str = "the file has no [train]";

fn count(number: usize, one: &str) -> String {
    format!("{number} {one}{}", if number == 1 { "" } else { "s" })
}

/// Every rule of the seam.
pub fn checks(line: &Line) -> Vec<DataCheck> {
    let mut checks = vec![layouts(line), names(line)];
    checks.extend(trains::checks(line));
    checks.extend(ranks::checks(line));
    checks.extend(telegrams::checks(line));
    checks.extend(borders::checks(line));
    // Of a station that is refused nothing was looked at.
    let refused = line.stations().len() > line.sound().len();
    for check in checks.iter_mut().skip(2).filter(|check| refused && check.outcome == Outcome::Met) {
        check.outcome = Outcome::NotChecked;
    }
    checks
}

/// The layouts themselves.
fn layouts(line: &Line) -> DataCheck {
    let mut findings = Vec::new();
    for (number, station) in line.stations().iter().enumerate() {
        findings.extend(station.problems.iter().map(|problem| {
            let what = format!("{} [{}]", problem.what, problem.rule.name());
            let from = line.places().at(&format!("station[{number}].file"));
            finding(place(&station.description.source, &problem.span), from, what, problem.right.clone())
        }));
    }
    let found = if line.stations().is_empty() { Err(NO_STATION) } else { Ok(findings) };
    judged(Rule::Station, count(line.stations().len(), "station"), found)
}

/// One name for one station.
fn names(line: &Line) -> DataCheck {
    let all = line.stations();
    let mut findings = Vec::new();
    for (number, station) in all.iter().enumerate() {
        if let Some(first) = all[..number].iter().position(|other| other.name() == station.name()) {
            let at = |number: usize| line.places().at(&format!("station[{number}].name"));
            let at_file = |number: usize| line.places().at(&format!("station[{number}].file"));
            let named = |number: usize| line.places().has(&format!("station[{number}].name"));
            let at = |number: usize| if named(number) { at(number) } else { at_file(number) };
            let what = format!("two stations are called {}", station.name());
            findings.push(finding(at(number), at(first), what, "give one of them another name"));
        }
    }
    judged(Rule::StationTwice, count(all.len(), "station"), if all.is_empty() { Err(NO_STATION) } else { Ok(findings) })
}
