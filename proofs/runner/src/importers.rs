//! Wrong importers: each must be found out, or leave out what it would have wrong.

use crate::old_rules::{Program, Programs};
use crate::pool::in_parallel;
use std::collections::{BTreeMap, BTreeSet};

pub use crate::importer::{FORMS, Importer, list};

/// What became of a wrong importer.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Tried {
    /// Routes that the right importer does not make, and what its routes hold and exclude and these do not.
    pub wrong: Vec<String>,
    /// How many of the right importer's routes are not there.
    pub left_out: usize,
    /// In how many stations the second reading finds something else than it does with the right importer.
    pub found_out: usize,
}

/// The lines of the right importer, for each form of file.
pub type Right = BTreeMap<&'static str, BTreeSet<String>>;

/// What the right importer makes of each form.
///
/// # Errors
/// The program fails.
pub fn right(programs: &Programs) -> Result<Right, String> {
    FORMS.iter().map(|form| Ok((*form, routes(programs, &[], &[form])?))).collect()
}

/// The routes of files in these forms by the importer with these mutants: lines of what each is, holds and excludes.
fn routes(programs: &Programs, mutants: &[&str], forms: &[&str]) -> Result<BTreeSet<String>, String> {
    let output = programs.with(Program::Importers, mutants)?.args(forms).output().map_err(|error| error.to_string())?;
    if !output.status.success() {
        return Err(format!("{mutants:?}: {}: {}", output.status, String::from_utf8_lossy(&output.stderr)));
    }
    Ok(String::from_utf8_lossy(&output.stdout).lines().map(ToOwned::to_owned).collect())
}

/// Holds each wrong importer against the right one, on all cores, in the forms that it reads. In the order of `all`.
///
/// # Errors
/// The program fails.
pub fn all_tried(programs: &Programs, all: &[Importer], right: &Right) -> Result<Vec<Tried>, String> {
    let jobs = std::thread::available_parallelism().map_or(1, std::num::NonZero::get);
    in_parallel(jobs, all.len(), |number| tried(programs, &all[number], right)).into_iter().collect()
}

/// Holds a wrong importer against the right one.
///
/// # Errors
/// The program fails.
fn tried(programs: &Programs, mutant: &Importer, right: &Right) -> Result<Tried, String> {
    let forms = mutant.forms();
    let found = routes(programs, &[&mutant.name], forms)?;
    let right: BTreeSet<String> = forms.iter().filter_map(|form| right.get(form)).flatten().cloned().collect();
    let right = &right;
    let is_route = |line: &&String| line.starts_with("route\t");
    // A station and a route of it.
    let named = |line: &str, field: usize| -> Option<(String, String)> {
        let fields: Vec<&str> = line.split('\t').collect();
        Some(((*fields.get(1)?).to_owned(), (*fields.get(field)?).to_owned()))
    };
    let there: BTreeSet<_> = found.iter().filter(is_route).filter_map(|line| named(line, 2)).collect();
    let is_there = |line: &str, field: usize| named(line, field).is_some_and(|route| there.contains(&route));
    let lost = |line: &&String| match line.split('\t').next() {
        Some("holds") => is_there(line, 2),
        Some("excludes") => is_there(line, 2) && is_there(line, 3),
        _ => false,
    };
    let length = |line: &str| -> Option<(String, u32)> {
        let (about, metres) = line.strip_prefix("length\t")?.rsplit_once('\t')?;
        Some((about.to_owned(), metres.parse().ok()?))
    };
    let lengths: BTreeMap<String, u32> = right.iter().filter_map(|line| length(line)).collect();
    let longer = |line: &&String| {
        length(line).is_some_and(|(about, now)| lengths.get(&about).is_some_and(|before| now > *before))
    };
    let new = found.difference(right).filter(|line| is_route(line) || longer(line));
    let wrong = new.chain(right.difference(&found).filter(lost)).cloned().collect();
    let differs = |line: &&String| line.starts_with("second\t");
    let left_out = right.difference(&found).filter(is_route).count();
    Ok(Tried { wrong, left_out, found_out: found.difference(right).filter(differs).count() })
}
