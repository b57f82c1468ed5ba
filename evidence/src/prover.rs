//! The proof campaign and the wrong kernels, run by `atc-prover`.

use crate::error::Fault;
use atc_prover::Options;
use atc_prover::report::{Campaign, Mutants};
use indicatif::ProgressBar;
use std::path::Path;
use std::time::Duration;

/// The hash of what the provers see.
///
/// # Errors
/// A source cannot be read.
pub fn sources(root: &Path) -> Result<String, Fault> {
    atc_prover::provenance::sources_sha256(root).map_err(|error| Fault::new(&root.display(), error))
}

/// How the provers are run: so many at a time, each for so many seconds at most.
pub fn options(jobs: usize, seconds: u64) -> Options {
    // The native engine is not what the case rests on: fewer values than `atc-prover` draws by itself.
    Options { jobs, limit: Duration::from_secs(seconds), tests: 4_000, ..Options::default() }
}

/// Runs the cbmc engine on every harness.
///
/// # Errors
/// The sources cannot be read. Tools that are missing are no error: every harness is not run then.
pub fn campaign(options: &Options, bar: &ProgressBar) -> Result<Campaign, Fault> {
    let progress = |result: &atc_prover::report::HarnessResult| {
        bar.set_message(format!("{} {}", result.name, result.verdict.as_str()));
        bar.inc(1);
    };
    let all = atc_prover::harnesses();
    atc_prover::campaign(options, &all, &progress).map_err(|error| Fault::new(&"the provers", error))
}

/// Tests every harness natively.
///
/// # Errors
/// The sources cannot be read.
pub fn native(options: &Options) -> Result<Campaign, Fault> {
    let all = atc_prover::harnesses();
    atc_prover::campaign::native_campaign(options, &all).map_err(|error| Fault::new(&"the native engine", error))
}

/// Runs the wrong kernels.
///
/// # Errors
/// The sources cannot be read.
pub fn mutants(options: &Options, bar: &ProgressBar) -> Result<Mutants, Fault> {
    let progress = |result: &atc_prover::report::MutantResult| {
        bar.set_message(result.name.clone());
        bar.inc(1);
    };
    atc_prover::mutants(options, &[], &progress).map_err(|error| Fault::new(&"the wrong kernels", error))
}
