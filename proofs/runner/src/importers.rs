//! Wrong importers: each must be found out, or leave out what it would have wrong.

use crate::old_rules::{Files, Program, Programs, rewrite, selector};
use crate::schemata::{Change, instrument, with_cells};
use serde::Deserialize;
use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

/// A wrong importer, as `layout/mutants.toml` has it.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Importer {
    /// Its name.
    pub name: String,
    /// What is wrong with it.
    pub what: String,
    /// The file that it changes, below `layout/src`.
    file: String,
    find: String,
    replace: String,
}

#[derive(Deserialize)]
struct File {
    mutant: Vec<Importer>,
}

/// The wrong importers of `layout/mutants.toml`.
///
/// # Errors
/// The file cannot be read, or two have one name.
pub fn list(root: &Path) -> Result<Vec<Importer>, String> {
    let path = root.join("layout/mutants.toml");
    let failed = |error: &dyn std::fmt::Display| format!("{}: {error}", path.display());
    let text = std::fs::read_to_string(&path).map_err(|error| failed(&error))?;
    let File { mutant: all } = toml::from_str(&text).map_err(|error| failed(&error))?;
    let names: BTreeSet<&str> = all.iter().map(|one| one.name.as_str()).collect();
    if names.len() < all.len() { Err(failed(&"two mutants have one name")) } else { Ok(all) }
}

/// Puts them into the copy of the importer, and what selects them.
pub(crate) fn put_in(all: &[Importer], files: &mut Files) -> Result<(), String> {
    let mut changes: BTreeMap<String, Vec<Change>> = BTreeMap::new();
    for (number, one) in all.iter().enumerate() {
        let change = Change { number, find: &one.find, replace: &one.replace };
        changes.entry(format!("layout/src/{}", one.file)).or_default().push(change);
    }
    for (path, changes) in changes {
        rewrite(files, &path, |text| instrument(text, &changes))?;
    }
    let names: Vec<&str> = all.iter().map(|one| one.name.as_str()).collect();
    rewrite(files, "layout/src/lib.rs", |text| with_cells(text, names.len(), &selector(&names, "return Err(())")))
}

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

/// The routes of the importer with these mutants: lines of what each is, holds and excludes.
///
/// # Errors
/// The program fails.
pub fn routes(programs: &Programs, mutants: &[&str]) -> Result<BTreeSet<String>, String> {
    let output = programs.with(Program::Importers, mutants)?.output().map_err(|error| error.to_string())?;
    if !output.status.success() {
        return Err(format!("{mutants:?}: {}: {}", output.status, String::from_utf8_lossy(&output.stderr)));
    }
    Ok(String::from_utf8_lossy(&output.stdout).lines().map(ToOwned::to_owned).collect())
}

/// Holds a wrong importer against the right one.
///
/// # Errors
/// The program fails.
pub fn tried(programs: &Programs, mutant: &str, right: &BTreeSet<String>) -> Result<Tried, String> {
    let found = routes(programs, &[mutant])?;
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
    let longer = |line: &&String| {
        let (about, metres) = line.rsplit_once('\t').unwrap_or_default();
        let before = right.iter().find_map(|other| other.strip_prefix(about)?.strip_prefix('\t')?.parse::<u32>().ok());
        line.starts_with("length\t") && before.is_some_and(|before| metres.parse::<u32>().is_ok_and(|now| now > before))
    };
    let new = found.difference(right).filter(|line| is_route(line) || longer(line));
    let wrong = new.chain(right.difference(&found).filter(lost)).cloned().collect();
    let differs = |line: &&String| line.starts_with("second\t");
    let left_out = right.difference(&found).filter(is_route).count();
    Ok(Tried { wrong, left_out, found_out: found.difference(right).filter(differs).count() })
}
