//! The proof campaign and the wrong kernels, run by `atc-prover`.

use crate::error::Fault;
use crate::judge::scope::Scope;
use atc_proofs::Harness;
use atc_prover::Options;
use atc_prover::report::{Campaign, HarnessResult, MutantResult, Mutants};
use std::collections::BTreeMap;
use std::path::Path;
use std::time::Duration;

/// The hash of what the provers see.
///
/// # Errors
/// A source cannot be read.
pub fn sources(root: &Path) -> Result<String, Fault> {
    atc_prover::provenance::sources_sha256(root).map_err(|error| Fault::new(&root.display(), error))
}

/// The versions of the provers that are here; none, if they are not.
pub fn versions(root: &Path) -> BTreeMap<String, String> {
    atc_prover::tools::Tools::find(root).map(|tools| tools.versions).unwrap_or_default()
}

/// How the provers are run: so many at a time, each for so many seconds at most.
///
/// A shard compiles in a folder of its own: several may run in one checkout.
pub fn options(jobs: usize, seconds: u64, scope: &Scope) -> Options {
    let mut options = Options { jobs, limit: Duration::from_secs(seconds), ..Options::default() };
    if let Scope::Shard(shard) = scope {
        options.folder.push(format!("shard-{}-of-{}", shard.number, shard.of));
    }
    options
}

/// The harnesses of these names, in this order.
///
/// # Errors
/// There is none of such a name.
pub fn harnesses(names: &[String]) -> Result<Vec<&'static Harness>, Fault> {
    let known = atc_prover::harnesses();
    let find = |name: &String| {
        let found = known.iter().copied().find(|harness| harness.name == name);
        found.ok_or_else(|| Fault::new(&"harnesses", format!("there is none of the name {name}")))
    };
    names.iter().map(find).collect()
}

/// Runs the cbmc engine on these harnesses.
///
/// # Errors
/// The sources cannot be read. Tools that are missing are no error: every harness is not run then.
pub fn campaign(
    options: &Options,
    harnesses: &[&Harness],
    progress: &(dyn Fn(&HarnessResult) + Sync),
) -> Result<Campaign, Fault> {
    atc_prover::campaign(options, harnesses, progress).map_err(|error| Fault::new(&"the provers", error))
}

/// Tests these harnesses natively.
///
/// # Errors
/// The sources cannot be read.
pub fn native(options: &Options, harnesses: &[&Harness]) -> Result<Campaign, Fault> {
    atc_prover::campaign::native_campaign(options, harnesses).map_err(|error| Fault::new(&"the native engine", error))
}

/// Proves the algebra of those that have any.
///
/// # Errors
/// The sources cannot be read.
pub fn reals(options: &Options, harnesses: &[&Harness]) -> Result<Campaign, Fault> {
    atc_prover::reals::campaign(options, harnesses).map_err(|error| Fault::new(&"the algebra", error))
}

/// Runs these wrong kernels, at least one: the runner takes no name for all.
///
/// # Errors
/// The sources cannot be read, or no name is given.
pub fn mutants(
    options: &Options,
    names: &[String],
    progress: &(dyn Fn(&MutantResult) + Sync),
) -> Result<Mutants, Fault> {
    let fault = |error: String| Fault::new(&"the wrong kernels", error);
    if names.is_empty() {
        return Err(fault("none is named".to_owned()));
    }
    atc_prover::mutants(options, names, progress).map_err(fault)
}

#[cfg(test)]
mod tests {
    use super::options;
    use crate::judge::scope::Scope;
    use std::collections::BTreeSet;

    #[test]
    fn shards_in_one_checkout_do_not_wait_for_each_other() {
        let whole = Scope::Whole;
        let shards = ["1/4", "2/4", "1/2"].map(|text| Scope::Shard(text.parse().expect("a shard")));
        let folder = |scope: &Scope| options(1, 60, scope).folder;
        let folders: BTreeSet<_> = shards.iter().chain([&whole]).map(folder).collect();
        assert_eq!(folders.len(), 4);
        assert!(folder(&whole).ends_with("target/proofs"));
    }
}
