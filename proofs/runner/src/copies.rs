//! Mutants put into a copy of the sources, each with a cell that selects it at run time.

use crate::compile::write;
use crate::mutant::Mutant;
use crate::schemata::{Change, instrument, with_cells};
use std::collections::BTreeMap;
use std::path::Path;

/// Puts the mutants, by number from 1, into the copy `sources`, with `rest`, which selects them.
///
/// # Errors
/// A mutant that cannot be selected, or a file that cannot be read or written.
pub(crate) fn put_in<'a>(
    sources: &Path,
    mutants: impl Iterator<Item = (usize, &'a Mutant)>,
    rest: &str,
) -> Result<(), String> {
    let (mut files, mut most): (BTreeMap<String, Vec<Change>>, usize) = (BTreeMap::new(), 0);
    for (number, mutant) in mutants {
        most = most.max(number);
        let change = Change { number, find: &mutant.find, replace: &mutant.replace };
        files.entry(mutant.path()).or_default().push(change);
    }
    for (file, changes) in files {
        rewrite(&sources.join(file), |text| instrument(text, &changes))?;
    }
    // The selector is in the kernel's arithmetic, and the kernel has it from there: both ask `crate::selected`.
    rewrite(&sources.join("arithmetic/src/lib.rs"), |text| with_cells(text, most + 1, rest))?;
    rewrite(&sources.join("kernel/src/lib.rs"), |text| Ok(format!("{text}\n{FROM_ARITHMETIC}")))
}

/// What the kernel has from its arithmetic where it has mutants.
const FROM_ARITHMETIC: &str =
    "pub use atc_arithmetic::select;\n#[allow(unused_imports)]\npub(crate) use atc_arithmetic::selected;\n";

fn rewrite(path: &Path, change: impl FnOnce(&str) -> Result<String, String>) -> Result<(), String> {
    let text = std::fs::read_to_string(path).map_err(|error| format!("{}: {error}", path.display()))?;
    write(path, &change(&text)?)
}
