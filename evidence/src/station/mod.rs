//! The specific application on the ground: one station's layout, held against every rule, and what it instantiates.
//!
//! The theorems of the interlocking hold for every layout that the kernel accepts. What is new for a station is its data:
//! [`rules`] lists every rule, [`read`] holds the file against them, [`parameters`] and [`figures`] say what somebody must
//! confirm, [`needed`] shows for each rule of the theorems that one of them fails without it.

pub mod figures;
pub mod needed;
pub mod parameters;
pub mod rules;

use crate::case::{
    Asked, Conclusion, Condition, DataCheck, Evidence, Finding, Kind, Outcome, Station, StationCondition,
};
use crate::error::Fault;
use crate::judge::verdict::Verdict;
use crate::sources::provenance::sha256;
use atc_layout::import::{Imported, read_any};
use atc_layout::lives::{self, TrainLives};
use atc_layout::model::Model;
use atc_layout::{Description, Errors, Rule, draw, table};
use parameters::place;
use rules::{Scope, Stage};
use std::path::Path;

/// The hazards of the interlocking and the ATC: their conditions are the station's.
pub const HAZARDS: [&str; 4] = ["H-12", "H-13", "H-14", "H-15"];

/// The assumption that what is proved of small layouts holds of large ones.
const CARRIES: &str = "small-layouts-for-large";

/// Where the harnesses of the interlocking stand.
const HARNESSES: &str = "proofs/src/interlocking";

/// A station that was read and held against every rule. It may break some.
#[derive(Clone, Debug)]
pub struct Checked {
    station: Station,
    description: Description,
    /// Everything derived; nothing if the layout breaks a rule.
    model: Option<Model>,
    /// The assumptions with figures of this station.
    figures: Vec<(&'static str, String)>,
}

/// Reads a layout in any form and holds it against every rule.
///
/// # Errors
/// The file cannot be read, or is not of the form that its name says; with the first place. A broken rule is no error here:
/// the case says so.
pub fn read(path: &Path) -> Result<Checked, Vec<Fault>> {
    let imported = read_any(path).map_err(faults)?;
    let bytes = std::fs::read(path).map_err(|error| vec![Fault::new(&path.display(), error)])?;
    Ok(check(&path.display().to_string(), &sha256(&bytes), &imported))
}

fn faults(errors: Errors) -> Vec<Fault> {
    let source = errors.source;
    let one = |problem: atc_layout::Problem| {
        let right = if problem.right.is_empty() { String::new() } else { format!("; {}", problem.right) };
        Fault::new(&place(&source, problem.place), format!("{}{right} [{}]", problem.what, problem.rule.name()))
    };
    errors.problems.into_iter().map(one).collect()
}

fn finding(source: &str, problem: atc_layout::Problem) -> Finding {
    Finding { at: place(source, problem.place), against: None, what: problem.what, right: problem.right }
}

/// Holds a layout against every rule; `source` is the file's name and `sha256` its hash.
pub fn check(source: &str, sha256: &str, imported: &Imported) -> Checked {
    let Imported { description, .. } = imported;
    let sound = description.check();
    let problems = match &sound {
        Ok(_) => Vec::new(),
        Err(errors) => errors.problems.clone(),
    };
    // What can be said of the tracks is said also where a route breaks a rule.
    let sound = description.model().ok();
    let tracks = description.tracks().ok();
    let model = sound.as_ref().or(tracks.as_ref());
    let table_of = |model: &Model| {
        let drawing = draw::svg(&description.station, model);
        (rows(model), table::html(&description.station.name, model, &drawing))
    };
    let (columns_and_rows, table_page) = sound.as_ref().map(table_of).unwrap_or_default();
    let (columns, table) = columns_and_rows;
    let station = Station {
        name: description.station.name.clone(),
        source: source.to_owned(),
        sha256: sha256.to_owned(),
        parameters: model.map(|model| parameters::parameters(description, model)).unwrap_or_default(),
        checks: checks(source, description, model, &problems),
        confirm: parameters::confirm(imported, model),
        conditions: Vec::new(),
        theorems: Vec::new(),
        drawing: model.map(|model| draw::svg(&description.station, model)).unwrap_or_default(),
        columns,
        table,
        table_page,
        layout: description.to_toml(),
    };
    let figures = model.map(|model| figures::figures(&description.station, model)).unwrap_or_default();
    Checked { station, description: description.clone(), model: sound, figures }
}

impl Checked {
    /// Holds the layout against what the trains of a line do with telegrams; `line` is that line's name.
    #[must_use]
    pub fn with_trains(mut self, line: &str, train: TrainLives) -> Self {
        let Some(model) = &self.model else { return self };
        let broken = match lives::compare(&self.description, model, train) {
            Ok(()) => Vec::new(),
            Err(errors) => {
                let source = self.description.source.name.clone();
                errors.problems.into_iter().map(|problem| finding(&source, problem)).collect()
            }
        };
        self.station.checks.push(DataCheck {
            rule: Rule::TelegramLives.name(),
            text: Rule::TelegramLives.text().to_owned(),
            asked: Asked::Engineering,
            scope: format!("the trains of “{line}”"),
            outcome: Outcome::of(broken),
        });
        self
    }
}

/// The control table, from its own form for spreadsheets.
fn rows(model: &Model) -> (Vec<String>, Vec<Vec<String>>) {
    let text = table::csv(model);
    let mut reader = csv::ReaderBuilder::new().has_headers(true).from_reader(text.as_bytes());
    let columns = reader.headers().map(|heads| heads.iter().map(str::to_owned).collect()).unwrap_or_default();
    let rows = reader.records().filter_map(Result::ok);
    (columns, rows.map(|row| row.iter().map(str::to_owned).collect()).collect())
}

fn checks(
    source: &str,
    description: &Description,
    model: Option<&Model>,
    problems: &[atc_layout::Problem],
) -> Vec<DataCheck> {
    let stage_of =
        |rule: Rule| rules::all().find(|(one, ..)| *one == rule).map_or(Stage::Form, |(_, _, stage, _)| stage);
    let first = problems.iter().map(|problem| stage_of(problem.rule)).min();
    rules::all()
        .map(|(rule, asked, stage, scope)| {
            let mine = problems.iter().filter(|problem| problem.rule == rule);
            let broken: Vec<_> = mine.map(|problem| finding(source, problem.clone())).collect();
            let outcome = match first {
                // A route without a way is not looked at any further, and neither is anything after its stage.
                Some(first) if broken.is_empty() && stage >= first => Outcome::NotChecked,
                _ => Outcome::of(broken),
            };
            let scope = number(scope, description, model);
            DataCheck { rule: rule.name(), text: rule.text().to_owned(), asked, scope, outcome }
        })
        .collect()
}

fn number(scope: Scope, description: &Description, model: Option<&Model>) -> String {
    let station = &description.station;
    let routes = station.routes.len();
    let count = |number: usize, one: &str| format!("{number} {one}{}", if number == 1 { "" } else { "s" });
    match scope {
        Scope::File => "the whole layout".to_owned(),
        Scope::Circuits => count(station.circuits.len(), "circuit"),
        Scope::Points => count(station.points.len(), "point"),
        Scope::Segments => count(station.segments.len(), "segment"),
        Scope::Routes => count(routes, "route"),
        Scope::Pairs => count(routes * routes.saturating_sub(1) / 2, "pair"),
        Scope::Places => {
            count(model.map_or(0, |model| model.routes.iter().map(|route| route.path.len()).sum()), "place")
        }
    }
}

impl Checked {
    /// The station as part of a case: the theorems that it instantiates, and the conditions that it must fulfil.
    pub fn case(&self, evidence: &[Evidence], conditions: &[Condition]) -> Station {
        let ours = |condition: &&Condition| condition.hazards.iter().any(|id| HAZARDS.contains(&id.as_str()));
        let here = |id: &str| self.figures.iter().find(|(known, _)| *known == id).map(|(_, text)| text.clone());
        let mut station = self.station.clone();
        station.conditions = conditions
            .iter()
            .filter(ours)
            .map(|one| StationCondition {
                number: one.number.clone(),
                id: one.id.clone(),
                here: here(&one.id).unwrap_or_default(),
            })
            .collect();
        if station.is_sound() {
            let of_interlocking = |one: &&Evidence| {
                one.kind == Kind::Harness && one.at.as_deref().is_some_and(|at| at.contains(HARNESSES))
            };
            station.theorems =
                evidence.iter().filter(of_interlocking).map(|one| (one.id.clone(), one.verdict)).collect();
        }
        station
    }
}

/// What the case concludes on a station: no more than its data checks and the theorems allow.
pub fn conclusion(station: &Station) -> Conclusion {
    let node = "STATION".to_owned();
    let name = format!("The interlocking of “{}”", station.name);
    let broken: Vec<_> = station.broken().map(|one| one.rule.clone()).collect();
    if !station.is_sound() {
        let sentence = format!(
            "{name} is refused: the layout breaks {} ({}). No theorem holds for it.",
            if broken.len() == 1 { "one rule".to_owned() } else { format!("{} rules", broken.len()) },
            crate::judge::verdict::list(&broken, 4)
        );
        return Conclusion { node, verdict: Verdict::Failed, sentence };
    }
    let verdict = Verdict::worst(station.theorems.iter().map(|(_, verdict)| *verdict)).unwrap_or(Verdict::NotRun);
    let worst: Vec<_> = station.theorems.iter().filter(|(_, one)| *one == verdict).map(|(id, _)| id.clone()).collect();
    let worst = if worst.is_empty() { vec!["every theorem on the interlocking".to_owned()] } else { worst };
    let mut said = verdict.conclusion("What is claimed of every layout", &worst, &[]);
    if verdict == Verdict::ProvedBounded {
        let condition = station.conditions.iter().find(|one| one.id == CARRIES);
        let condition = condition.map_or(String::new(), |one| format!(", and a condition ({})", one.number));
        let routes = station.table.len();
        said = format!(
            "{said} That it carries to the {routes} routes of this station is an argument on paper{condition}."
        );
    }
    let sentence = format!(
        "{name}: the layout keeps all {} rules, so it is one of those that the theorems speak of. {said} {} values and reasons \
         are to be confirmed, and {} conditions to be fulfilled.",
        station.checks.len(),
        station.confirm.len(),
        station.conditions.len()
    );
    Conclusion { node, verdict, sentence }
}

#[cfg(test)]
mod tests;
