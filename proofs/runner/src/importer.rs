//! A wrong importer: a change of a line or two in what imports stations.

use crate::copied::{Files, rewrite, selector};
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

/// The forms of files that stations are imported from.
pub const FORMS: [&str; 2] = ["railml", "planpro"];

impl Importer {
    /// The forms whose import it changes.
    pub fn forms(&self) -> &'static [&'static str] {
        let [railml, planpro] = FORMS.each_ref().map(|form| self.file.starts_with(&format!("import/{form}/")));
        match (railml, planpro) {
            (true, _) => &FORMS[..1],
            (_, true) => &FORMS[1..],
            _ => &FORMS,
        }
    }
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
