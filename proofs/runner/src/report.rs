//! What a run of the proofs reports, as JSON.

use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// The version of the JSON form.
pub const SCHEMA: u32 = 2;

/// What was found out about a claim, a harness or a mutant. From here on down each is worse than the one before.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Verdict {
    /// Holds for all values.
    Proved,
    /// Held for all values that were drawn.
    Tested,
    /// Nothing was run.
    NotRun,
    /// The prover did not end in its time.
    Timeout,
    /// The prover ended without an answer: killed, out of memory, a bound too small, an internal failure.
    Error,
    /// It holds because it is never reached, or a cover point is not.
    Vacuous,
    /// There is a counterexample.
    Failed,
}

impl Verdict {
    /// As it is written in JSON.
    pub const fn as_str(self) -> &'static str {
        match self {
            Self::Proved => "proved",
            Self::Tested => "tested",
            Self::NotRun => "not-run",
            Self::Timeout => "timeout",
            Self::Error => "error",
            Self::Vacuous => "vacuous",
            Self::Failed => "failed",
        }
    }
}

/// What exactly was checked, and with what.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Provenance {
    /// The commit that is checked out; absent outside a git checkout.
    pub commit: Option<String>,
    /// Whether the work tree differs from it.
    pub dirty: Option<bool>,
    /// SHA-256 of `Cargo.lock`, in hexadecimal.
    pub cargo_lock_sha256: String,
    /// SHA-256 over the paths and texts of the sources of kernel and proofs.
    pub sources_sha256: String,
    /// Tool → version, as the tool or its installer says.
    pub tools: BTreeMap<String, String>,
    /// The options of the compiler and the prover.
    pub flags: Vec<String>,
    /// Ranks of the aspect machine in the harnesses whose size is a parameter.
    pub aspects: usize,
    /// Start of the run, seconds since 1970 (UTC).
    pub started_unix: u64,
    /// Wall time of the run.
    pub seconds: f64,
}

/// All harnesses under one engine.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Campaign {
    /// [`SCHEMA`].
    pub schema: u32,
    /// `cbmc`, `native` or `kani`.
    pub engine: String,
    /// What was checked.
    pub provenance: Provenance,
    /// One for each harness that was asked for.
    pub harnesses: Vec<HarnessResult>,
}

/// One harness under one engine.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct HarnessResult {
    /// As in `atc_proofs`, which says what it is.
    pub name: String,
    /// The bound of this run in words, as engines prove different sizes; empty if there is none.
    pub bound: String,
    /// The engine.
    pub engine: String,
    /// The worst of its claims and cover points.
    pub verdict: Verdict,
    /// Why it is not proved.
    pub reason: Option<String>,
    /// Wall time, all cases together.
    pub seconds: f64,
    /// The solver, or how many values were drawn.
    pub solver: String,
    /// The most iterations of a loop that the prover unwound; 0 if there was no loop, or nobody looked.
    #[serde(default)]
    pub unwound: usize,
    /// By number.
    pub claims: Vec<ClaimResult>,
    /// By number.
    pub covers: Vec<CoverResult>,
    /// The arbitrary values of a counterexample, in order.
    pub counterexample: Option<Vec<u16>>,
}

/// One claim.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct ClaimResult {
    /// Its name in the source, which says what it is.
    pub name: String,
    /// What was found out.
    pub verdict: Verdict,
}

/// One cover point.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct CoverResult {
    /// Its name in the source, which says what it is.
    pub name: String,
    /// Whether some values reach it.
    pub hit: bool,
}

/// All named wrong kernels.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Mutants {
    /// [`SCHEMA`].
    pub schema: u32,
    /// What was checked.
    pub provenance: Provenance,
    /// One for each mutant that was asked for.
    pub mutants: Vec<MutantResult>,
    /// How the right kernel fares, compiled as the wrong ones are: one for each harness that was to reject some and is
    /// smaller than in its proof.
    #[serde(default)]
    pub controls: Vec<Control>,
}

/// The right kernel before a harness that is to reject wrong ones.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Control {
    /// The harness.
    pub harness: String,
    /// Why it does not pass; none if it does.
    pub reason: Option<String>,
    /// Wall time.
    pub seconds: f64,
}

/// What became of a mutant.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum MutantVerdict {
    /// A claim of a harness that is proved of the kernel fails.
    Killed,
    /// No claim fails.
    Survived,
    /// It cannot be made, compiled or decided.
    Error,
    /// Nothing was run.
    NotRun,
}

/// One wrong kernel.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct MutantResult {
    /// Its name in `proofs/mutants.toml`.
    pub name: String,
    /// What is wrong with it.
    pub what: String,
    /// The requirements that it breaks.
    pub requirements: Vec<String>,
    /// The file that is changed.
    pub file: String,
    /// The text that is replaced, and what by.
    pub change: [String; 2],
    /// What became of it.
    pub verdict: MutantVerdict,
    /// Which claims failed.
    pub killed_by: Vec<Kill>,
    /// Why it is not killed.
    pub reason: Option<String>,
    /// Wall time.
    pub seconds: f64,
}

/// The claims of one harness that a mutant fails.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Kill {
    /// The harness.
    pub harness: String,
    /// The names of the claims.
    pub claims: Vec<String>,
    /// The case of the counterexample.
    #[serde(default)]
    pub case: usize,
    /// Its other arbitrary values, in order, if the prover gave them.
    pub counterexample: Option<Vec<u16>>,
    /// Whether the prover was asked in this very run, and found one. If not, the one that is kept was run.
    #[serde(default)]
    pub asked: bool,
}
