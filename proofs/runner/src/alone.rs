//! One mutant in a copy of the kernel of its own: for what cannot be selected at run time, and to check the other way by.

use crate::asked::Asked;
use crate::compile::{Kernel, compile, copy, write};
use crate::judged::Judged;
use crate::mutant::{Mutant, changed};
use crate::options::{Asking, Options};
use crate::tools::Tools;
use std::collections::BTreeSet;
use std::path::Path;

/// Compiles the mutant, and asks each of its harnesses.
///
/// # Errors
/// It does not compile.
pub fn attempt(
    tools: &Tools,
    root: &Path,
    mutant: &Mutant,
    options: &Options,
) -> Result<Vec<(&'static str, Judged)>, String> {
    let folder = options.folder.join("mutants").join(&mutant.name);
    let sources = folder.join("sources");
    copy(root, &sources)?;
    write(&sources.join(mutant.path()), &changed(root, mutant)?)?;
    let kernel = Kernel::Wrong { whole: options.asking == Asking::Record };
    let compiled = compile(tools, &sources, &folder.join("build"), options.aspects, &mutant.killed_by, kernel)?;
    let judge = |harness: &'static atc_proofs::Harness| {
        let asked = Asked::new(tools, &compiled, harness, options);
        // Nothing can be selected: it is what it is.
        let judged = asked.map(|asked| asked.judge(&BTreeSet::from([0])).remove(&0));
        let judged = judged.map_or_else(Judged::Error, |judged| judged.unwrap_or(Judged::Passes));
        (harness.name, judged.or_error(harness.name))
    };
    Ok(crate::select(&mutant.killed_by)?.into_iter().map(judge).collect())
}
