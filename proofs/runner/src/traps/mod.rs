//! The traps: small programs whose verdicts are known, on which an engine is tried before it is believed.
//!
//! `proofs/traps/traps.toml` declares each of them: its file, and what every engine must say of it. The self-test tries
//! the engine that is about to be used; the table tries all of them. `proofs/SOUNDNESS.md` says which way to a false
//! proof each trap guards.

mod native;
mod table;
mod trial;

use crate::report;
use serde::Deserialize;
use std::collections::BTreeMap;
use std::path::Path;

pub use table::{Row, Table, table};
pub use trial::{Engine, Outcome, Trial, Way, trials};

/// A small program whose verdict is known.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Trap {
    /// Its name, and that of its function.
    pub name: String,
    /// Its source in `proofs/traps`: Rust, or C.
    pub file: String,
    /// What it is about.
    pub about: String,
    /// About CBMC alone: neither the driver nor the rewriting of wasm2c's C is in the way.
    #[serde(default)]
    pub direct: bool,
    /// Bytes of stack, or as many as its frames need, like a harness.
    pub stack: Option<u32>,
    /// The claims that hold.
    #[serde(default)]
    pub hold: Vec<usize>,
    /// The claims that fail → arbitrary values with which they do.
    #[serde(default)]
    pub fail: BTreeMap<String, Vec<u16>>,
    /// More arbitrary values to run it with as a program: cover points that drawn values do not hit.
    #[serde(default)]
    pub values: Vec<Vec<u16>>,
    /// The claims that no path leads to.
    #[serde(default)]
    pub vacuous: Vec<usize>,
    /// The cover points that are hit; others are not.
    #[serde(default)]
    pub hit: Vec<usize>,
    /// How often CBMC must say that it has unwound some loop, at least.
    pub turns: Option<usize>,
    /// In place of verdicts: an assertion that fails begins so.
    pub failure: Option<String>,
    /// In place of verdicts: there is no answer, and the reason has this word.
    pub silence: Option<String>,
    /// The self-test asks each solver that a campaign uses, and in one run as well as in two.
    #[serde(default)]
    pub every_way: bool,
    /// It says nothing when it is run as a program, and why.
    pub not_native: Option<String>,
    /// Engines with their version that are known to be wrong here. The self-test passes it over: another trap tests
    /// the guard.
    #[serde(default)]
    pub known_wrong: Vec<String>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Declarations {
    trap: Vec<Trap>,
}

/// All traps, in the order of their declarations.
///
/// # Errors
/// The declarations cannot be read, or contradict themselves.
pub fn list(root: &Path) -> Result<Vec<Trap>, String> {
    let path = root.join("proofs/traps/traps.toml");
    let text = std::fs::read_to_string(&path).map_err(|error| format!("{}: {error}", path.display()))?;
    let declared: Declarations = toml::from_str(&text).map_err(|error| format!("{}: {error}", path.display()))?;
    for trap in &declared.trap {
        trap.check().map_err(|reason| format!("{}: `{}`: {reason}", path.display(), trap.name))?;
    }
    Ok(declared.trap)
}

impl Trap {
    /// The numbers of the claims that fail.
    pub fn failing(&self) -> Vec<usize> {
        // `check` has seen that they are numbers.
        self.fail.keys().filter_map(|number| number.parse().ok()).collect()
    }

    /// The numbers of the claims that some path leads to.
    pub fn reached(&self) -> Vec<usize> {
        let mut reached = [self.hold.clone(), self.failing()].concat();
        reached.sort_unstable();
        reached
    }

    fn check(&self) -> Result<(), String> {
        let verdicts = !self.hold.is_empty() || !self.fail.is_empty();
        let kinds = [verdicts, self.failure.is_some(), self.silence.is_some()];
        if kinds.into_iter().filter(|kind| *kind).count() != 1 {
            return Err("verdicts, a failure or a silence: one of them".to_owned());
        }
        if self.fail.keys().any(|number| number.parse::<usize>().is_err()) {
            return Err("a claim that fails has a number".to_owned());
        }
        let mut all = [self.reached(), self.vacuous.clone()].concat();
        all.sort_unstable();
        if verdicts && all != (0..all.len()).collect::<Vec<_>>() {
            return Err(format!("a verdict for each claim, and one only: {all:?}"));
        }
        if self.direct && !self.is_c() {
            return Err("only C goes to CBMC directly".to_owned());
        }
        Ok(())
    }

    fn is_c(&self) -> bool {
        Path::new(&self.file).extension().is_some_and(|extension| extension == "c")
    }

    /// Its language, in words.
    pub fn language(&self) -> &'static str {
        match (self.is_c(), self.direct) {
            (false, _) => "Rust",
            (true, false) => "C, as wasm2c writes it",
            (true, true) => "C, to CBMC directly",
        }
    }
}

/// The schema of the table's JSON: that of the other reports.
const SCHEMA: u32 = report::SCHEMA;
