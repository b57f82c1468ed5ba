//! Runs the theorems of `atc-proofs` and reports what happened.
//!
//! Three engines are here. `native` *tests*: it draws values and replays counterexamples. `cbmc` *proves*, on the
//! compiled, optimised code: Rust → WebAssembly → C → CBMC. `reals` proves the algebra of motion, by Z3. Kani is run by `cargo kani` itself. A result is only ever
//! what a run said: a prover that is missing, was killed or was silent is never a pass.
//!
//! # In the house
//!
//! Uses `atc-kernel`, `atc-proofs`. Used by `atc-evidence`. Begin with [`select`] and [`mod@campaign`].

mod alone;
mod asked;
pub mod campaign;
mod cbmc;
mod compile;
mod control;
mod copied;
mod copies;
mod importer;
pub mod importers;
mod judged;
pub mod kani;
mod loops;
mod mutant;
pub mod mutants;
pub mod native;
pub mod old_rules;
mod options;
mod pool;
mod process;
mod program;
pub mod provenance;
pub mod reals;
pub mod recorded;
mod regions;
pub mod report;
mod schemata;
pub mod selftest;
mod together;
pub mod tools;
pub mod traps;
mod twin;
pub mod twins;
pub mod unwound;

use std::path::{Path, PathBuf};

pub use campaign::campaign;
pub use cbmc::{Answer, Solver, parse as parse_cbmc};
pub use control::is_smaller;
pub use mutants::mutants;
pub use options::{Asking, Options};
pub use pool::in_parallel;
pub use process::end_all_on_interrupt;
pub use tools::Tools;

use atc_proofs::Harness;

/// The checkout that this program was built from.
pub fn root() -> PathBuf {
    let runner = Path::new(env!("CARGO_MANIFEST_DIR"));
    runner.ancestors().nth(2).unwrap_or(runner).to_path_buf()
}

/// All harnesses, module by module, in the order of the sources.
pub fn harnesses() -> Vec<&'static Harness> {
    atc_proofs::HARNESSES.iter().copied().flatten().collect()
}

/// The harnesses of these names; all of them if none is named.
///
/// # Errors
/// A name that no harness has: a filter that matches nothing must not pass.
pub fn select(names: &[String]) -> Result<Vec<&'static Harness>, String> {
    if names.is_empty() {
        return Ok(harnesses());
    }
    let find = |name: &String| {
        harnesses().into_iter().find(|harness| harness.name == name).ok_or_else(|| {
            let known: Vec<_> = harnesses().iter().map(|harness| harness.name).collect();
            format!("there is no harness `{name}`; the harnesses are {}", known.join(", "))
        })
    };
    names.iter().map(find).collect()
}
