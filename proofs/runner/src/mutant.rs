//! A named mutant: a change of a line or two in the kernel or its arithmetic, and the harnesses that must reject it.

use crate::schemata::{Change, is_selectable};
use crate::select;
use serde::Deserialize;
use std::path::Path;

/// A mutant, as `proofs/mutants.toml` has it.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Mutant {
    /// Its name, unique.
    pub name: String,
    /// What is wrong with it, in a sentence.
    pub what: String,
    /// The requirements that it breaks.
    pub requirements: Vec<String>,
    /// The file: from the kernel's `src`, or from the checkout if it begins with `arithmetic/src/`.
    pub file: String,
    /// The text to replace; it stands in the file exactly once.
    pub find: String,
    /// What replaces it.
    pub replace: String,
    /// The harnesses that must reject it: each one on its own.
    pub killed_by: Vec<String>,
    /// Whether the prover needs it in a copy of the kernel of its own: where what it changes is computed when the kernel is compiled, and
    /// the harness has no answer otherwise.
    #[serde(default)]
    pub alone: bool,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct File {
    mutant: Vec<Mutant>,
}

/// The mutants of `proofs/mutants.toml`, checked against the kernel and the harnesses of this checkout.
///
/// # Errors
/// What is wrong with the file: a text that does not stand in the kernel exactly once, an unknown harness.
pub fn list(root: &Path) -> Result<Vec<Mutant>, String> {
    let path = root.join("proofs").join("mutants.toml");
    let text = std::fs::read_to_string(&path).map_err(|error| format!("{}: {error}", path.display()))?;
    let file: File = toml::from_str(&text).map_err(|error| format!("{}: {error}", path.display()))?;
    for (place, mutant) in file.mutant.iter().enumerate() {
        let wrong = |reason: String| Err(format!("proofs/mutants.toml: mutant `{}`: {reason}", mutant.name));
        if file.mutant[..place].iter().any(|other| other.name == mutant.name) {
            return wrong("the name is taken".to_owned());
        }
        if mutant.killed_by.is_empty() {
            return wrong("no harness is to reject it".to_owned());
        }
        if let Err(reason) = select(&mutant.killed_by).map(drop).and(changed(root, mutant).map(drop)) {
            return wrong(reason);
        }
    }
    Ok(file.mutant)
}

impl Mutant {
    /// The file that it changes, from the checkout.
    pub fn path(&self) -> String {
        if self.file.starts_with("arithmetic/src/") { self.file.clone() } else { format!("kernel/src/{}", self.file) }
    }
}

/// The text of the file that the mutant changes, changed.
pub(crate) fn changed(root: &Path, mutant: &Mutant) -> Result<String, String> {
    let path = root.join(mutant.path());
    let text = std::fs::read_to_string(&path).map_err(|error| format!("{}: {error}", path.display()))?;
    match text.matches(&mutant.find).count() {
        1 => Ok(text.replacen(&mutant.find, &mutant.replace, 1)),
        count => Err(format!("`{}` stands {count} times in {}, not once", mutant.find, mutant.file)),
    }
}

/// Whether the mutant can be selected at run time.
pub(crate) fn is_together(root: &Path, mutant: &Mutant) -> bool {
    let change = Change { number: 1, find: &mutant.find, replace: &mutant.replace };
    let text = std::fs::read_to_string(root.join(mutant.path())).unwrap_or_default();
    is_selectable(&text, &change)
}
