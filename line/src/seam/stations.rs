//! The layouts of the stations, each by itself, and their names.

use super::judged::{NO_STATION, count, finding, judged};
use crate::check::DataCheck;
use crate::line::Line;
use crate::places::place;
use crate::rule::Rule;

/// The layouts themselves.
pub(super) fn layouts(line: &Line) -> DataCheck {
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
pub(super) fn names(line: &Line) -> DataCheck {
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
