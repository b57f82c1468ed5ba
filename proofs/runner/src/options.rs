//! How a run of provers, mutants or native tests is to go.

use crate::cbmc::Solver;
use crate::root;
use std::path::PathBuf;
use std::time::Duration;

/// How to run.
#[derive(Clone, Debug)]
pub struct Options {
    /// Harnesses, or mutants, at a time.
    pub jobs: usize,
    /// CPU time for each run of the prover.
    pub limit: Duration,
    /// Which solver.
    pub solver: Solver,
    /// Ranks of the aspect machine; only the compiled engines can change it.
    pub aspects: usize,
    /// Accepted runs for each harness of the native engine.
    pub tests: usize,
    /// Of which mutants the prover is asked.
    pub asking: Asking,
    /// Where all of it is compiled, by one run at a time.
    pub folder: PathBuf,
}

/// Of which mutants the prover is asked.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Asking {
    /// Of those that no kept counterexample rejects, and of a sample that the hash of the sources draws.
    Some,
    /// Of all.
    All,
    /// Of all, each compiled alone, to check those that are compiled together.
    Alone,
    /// Of all, with the harnesses as large as they prove: for counterexamples to keep.
    Record,
}

impl Default for Options {
    fn default() -> Self {
        Self {
            jobs: std::thread::available_parallelism().map_or(2, usize::from),
            limit: Duration::from_mins(10),
            solver: Solver::Auto,
            aspects: atc_proofs::ASPECTS,
            tests: 20_000,
            asking: Asking::Some,
            folder: root().join("target").join("proofs"),
        }
    }
}
