//! What the command line may say.

use crate::judge::build::Required;
use crate::judge::scope::{Scope, Shard};
use clap::{Args, Parser, Subcommand, ValueEnum};
use std::path::PathBuf;

/// Runs of each harness natively, in the tests as here.
pub const NATIVE_RUNS: usize = 4000;

/// Makes the safety case of the train control kernel from its proofs, models, tests and wrong kernels.
#[derive(Debug, Parser)]
#[command(name = "safety-case", version, about)]
pub struct Cli {
    #[command(subcommand)]
    pub(super) command: Command,
}

#[derive(Debug, Subcommand)]
pub(super) enum Command {
    /// Run the engines and write the case.
    Run(Box<Run>),
    /// Join the shards of one run into one case.
    Merge(Box<Merge>),
    /// Compare two cases without their times: exit code 1 and what differs, if anything does.
    Compare {
        /// The folder of a case.
        one: PathBuf,
        /// The folder of another.
        other: PathBuf,
    },
    /// Write a case again from its case.json, for a station if a layout is given; results of other sources become stale.
    Render {
        /// The folder of a case.
        #[arg(long)]
        from: PathBuf,
        /// A station's layout (TOML, railML 3, PlanPro or OSRD): the case becomes that of the station, and no engine runs.
        #[arg(long, requires = "out")]
        layout: Option<PathBuf>,
        /// Where to write it; without this, in place.
        #[arg(long)]
        out: Option<PathBuf>,
        /// The checkout; without this, the one that holds the current folder.
        #[arg(long)]
        root: Option<PathBuf>,
    },
    /// Check a case: hash its files and its sources again, and search a random model once more.
    Verify {
        /// The folder of a case.
        folder: PathBuf,
        /// How many models to search again.
        #[arg(long, default_value_t = 1)]
        models: usize,
        /// The checkout; without this, the one that holds the current folder.
        #[arg(long)]
        root: Option<PathBuf>,
    },
    /// Print the JSON Schema of case.json.
    Schema,
}

/// What `run` takes.
#[derive(Clone, Debug, Args)]
// Each switch leaves out one kind of evidence, which the case then calls not run.
#[allow(clippy::struct_excessive_bools)]
pub struct Run {
    /// What must be so for the exit code 0, beyond nothing having gone wrong.
    #[arg(long)]
    pub(super) require: Option<Require>,
    /// Only this part of the railway (aspect, supervision, block, …): its theorems, wrong kernels, models and tests.
    #[arg(long, conflicts_with = "shard")]
    pub(super) part: Option<String>,
    /// Start nothing that would not end in so many seconds; the same command again goes on from there. A part has 150 by itself.
    #[arg(long, value_name = "SECONDS")]
    pub(super) within: Option<u64>,
    /// Only this shard, such as 2/4; `safety-case merge` joins them.
    #[arg(long)]
    pub(super) shard: Option<Shard>,
    /// A line's parameters (TOML); without this, the example of the patent.
    #[arg(long)]
    pub(super) config: Option<PathBuf>,
    /// A station's layout (TOML, railML 3, PlanPro or OSRD): its data checks, control table and track plan become part of the case.
    #[arg(long)]
    pub(super) layout: Option<PathBuf>,
    /// Where to write the case; without this, target/safety-case in the checkout.
    #[arg(long)]
    pub(super) out: Option<PathBuf>,
    /// How many provers at a time; without this, one for each core.
    #[arg(long)]
    pub(super) jobs: Option<usize>,
    /// Seconds that one harness or one model may take.
    #[arg(long, default_value_t = 600)]
    pub(super) time_limit: u64,
    /// Run everything, also what an earlier run in the same folder has found of the very same commit with the same tools.
    #[arg(long)]
    pub(super) anew: bool,
    /// Do not run the provers.
    #[arg(long)]
    pub(super) no_provers: bool,
    /// Do not run the harnesses natively.
    #[arg(long)]
    pub(super) no_native: bool,
    /// Runs of each harness natively: such as meet its assumptions, on drawn values.
    #[arg(long, default_value_t = NATIVE_RUNS)]
    pub(super) native_runs: usize,
    /// Do not run the wrong kernels.
    #[arg(long)]
    pub(super) no_mutants: bool,
    /// Do not search the models.
    #[arg(long)]
    pub(super) no_models: bool,
    /// Do not measure signal and position.
    #[arg(long)]
    pub(super) no_measurements: bool,
    /// The folder of a run of `waveform bench`, instead of running it.
    #[arg(long, conflicts_with = "no_measurements")]
    pub(super) measurements: Option<PathBuf>,
    /// Do not run the tests.
    #[arg(long)]
    pub(super) no_tests: bool,
    /// Run all tests of the workspace, as ci/test does; without this, those that the case names.
    #[arg(long, conflicts_with = "no_tests")]
    pub(super) all_tests: bool,
    /// What `cargo test` printed (both streams in one file), instead of running it.
    #[arg(long, conflicts_with = "no_tests")]
    pub(super) test_results: Option<PathBuf>,
    /// What the tests of `atc-models` have found of models, instead of searching those again: of this very commit, or it is not used.
    #[arg(long)]
    pub(super) outcomes: Option<PathBuf>,
    /// A campaign of another engine or machine (JSON); may be given more than once.
    #[arg(long)]
    pub(super) import: Vec<PathBuf>,
    /// The checkout; without this, the one that holds the current folder.
    #[arg(long)]
    pub(super) root: Option<PathBuf>,
}

/// A part is for work on it: it ends within three minutes.
const PART_SECONDS: u64 = 150;

impl Run {
    /// The seconds in which it is to end, if there is a limit.
    pub(super) fn limit(&self) -> Option<u64> {
        self.within.or(self.part.is_some().then_some(PART_SECONDS))
    }

    /// What it is about.
    pub(super) fn scope(&self) -> Scope {
        match (&self.part, self.shard) {
            (Some(part), _) => Scope::Part(part.clone()),
            (None, Some(shard)) => Scope::Shard(shard),
            (None, None) => Scope::Whole,
        }
    }
}

/// What `merge` takes.
#[derive(Clone, Debug, Args)]
pub struct Merge {
    /// The folders that the shards were written to.
    #[arg(required = true)]
    pub(super) shards: Vec<PathBuf>,
    /// Where to write the case.
    #[arg(long)]
    pub(super) out: PathBuf,
    /// What must be so for the exit code 0, beyond nothing having gone wrong.
    #[arg(long)]
    pub(super) require: Option<Require>,
    /// A line's parameters (TOML); without this, the example of the patent.
    #[arg(long)]
    pub(super) config: Option<PathBuf>,
    /// A station's layout (TOML, railML 3, PlanPro or OSRD).
    #[arg(long)]
    pub(super) layout: Option<PathBuf>,
    /// The checkout; without this, the one that holds the current folder.
    #[arg(long)]
    pub(super) root: Option<PathBuf>,
}

/// What may be required.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Require {
    /// Every kernel claim proved by cbmc, every model as expected, every wrong kernel rejected.
    Proved,
}

/// What the build of a case is told to require.
pub(super) fn required(require: Option<Require>) -> Required {
    if require == Some(Require::Proved) { Required::Proved } else { Required::NoDefect }
}
