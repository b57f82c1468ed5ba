//! The commands.

mod budget;
mod engines;
mod merge;
mod render;
mod run;
mod suites;

use crate::build::Required;
use crate::error::Fault;
use crate::inputs::mutants;
use crate::line;
use crate::plan::{Plan, plan};
use crate::scope::{Scope, Shard};
use crate::station;
use clap::{Args, Parser, Subcommand, ValueEnum};
use std::path::{Path, PathBuf};

/// What is credited to a run that was started here.
pub(crate) const HERE: &str = "run here";

/// Exit code for a bad command line, configuration or source of the case.
pub const USAGE: u8 = 2;

/// Makes the safety case of the train control kernel from its proofs, models, tests and wrong kernels.
#[derive(Debug, Parser)]
#[command(name = "safety-case", version, about)]
pub struct Cli {
    #[command(subcommand)]
    command: Command,
}

#[derive(Debug, Subcommand)]
enum Command {
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
        /// A station's layout (TOML, railML 3 or OSRD): the case becomes that of the station, and no engine runs.
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
    require: Option<Require>,
    /// Only this part of the railway (aspect, supervision, block, …): its theorems, wrong kernels, models and tests.
    #[arg(long, conflicts_with = "shard")]
    part: Option<String>,
    /// Start nothing that would not end in so many seconds; the same command again goes on from there. A part has 150 by itself.
    #[arg(long, value_name = "SECONDS")]
    within: Option<u64>,
    /// Only this shard, such as 2/4; `safety-case merge` joins them.
    #[arg(long)]
    shard: Option<Shard>,
    /// A line's parameters (TOML); without this, the example of the patent.
    #[arg(long)]
    config: Option<PathBuf>,
    /// A station's layout (TOML, railML 3 or OSRD): its data checks, control table and track plan become part of the case.
    #[arg(long)]
    layout: Option<PathBuf>,
    /// Where to write the case; without this, target/safety-case in the checkout.
    #[arg(long)]
    out: Option<PathBuf>,
    /// How many provers at a time; without this, one for each core.
    #[arg(long)]
    jobs: Option<usize>,
    /// Seconds that one harness or one model may take.
    #[arg(long, default_value_t = 600)]
    time_limit: u64,
    /// Run everything, also what an earlier run in the same folder has found of the very same commit with the same tools.
    #[arg(long)]
    anew: bool,
    /// Do not run the provers.
    #[arg(long)]
    no_provers: bool,
    /// Do not run the harnesses natively.
    #[arg(long)]
    no_native: bool,
    /// Runs of each harness natively: such as meet its assumptions, on drawn values.
    #[arg(long, default_value_t = engines::NATIVE_RUNS)]
    native_runs: usize,
    /// Do not run the wrong kernels.
    #[arg(long)]
    no_mutants: bool,
    /// Do not search the models.
    #[arg(long)]
    no_models: bool,
    /// Do not measure signal and position.
    #[arg(long)]
    no_measurements: bool,
    /// The folder of a run of `waveform bench`, instead of running it.
    #[arg(long, conflicts_with = "no_measurements")]
    measurements: Option<PathBuf>,
    /// Do not run the tests.
    #[arg(long)]
    no_tests: bool,
    /// Run all tests of the workspace, as ci/test does; without this, those that the case names.
    #[arg(long, conflicts_with = "no_tests")]
    all_tests: bool,
    /// What `cargo test` printed (both streams in one file), instead of running it.
    #[arg(long, conflicts_with = "no_tests")]
    test_results: Option<PathBuf>,
    /// What the tests of `atc-models` have found of models, instead of searching those again: of this very commit, or it is not used.
    #[arg(long)]
    outcomes: Option<PathBuf>,
    /// A campaign of another engine or machine (JSON); may be given more than once.
    #[arg(long)]
    import: Vec<PathBuf>,
    /// The checkout; without this, the one that holds the current folder.
    #[arg(long)]
    root: Option<PathBuf>,
}

/// A part is for work on it: it ends within three minutes.
const PART_SECONDS: u64 = 150;

impl Run {
    /// The seconds in which it is to end, if there is a limit.
    fn limit(&self) -> Option<u64> {
        self.within.or(self.part.is_some().then_some(PART_SECONDS))
    }

    /// What it is about.
    fn scope(&self) -> Scope {
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
    shards: Vec<PathBuf>,
    /// Where to write the case.
    #[arg(long)]
    out: PathBuf,
    /// What must be so for the exit code 0, beyond nothing having gone wrong.
    #[arg(long)]
    require: Option<Require>,
    /// A line's parameters (TOML); without this, the example of the patent.
    #[arg(long)]
    config: Option<PathBuf>,
    /// A station's layout (TOML, railML 3 or OSRD).
    #[arg(long)]
    layout: Option<PathBuf>,
    /// The checkout; without this, the one that holds the current folder.
    #[arg(long)]
    root: Option<PathBuf>,
}

/// What the build of a case is told to require.
fn required(require: Option<Require>) -> Required {
    if require == Some(Require::Proved) { Required::Proved } else { Required::NoDefect }
}

/// The plan for this line and station.
fn planned(root: &Path, config: Option<&Path>, layout: Option<&Path>) -> Result<Plan, Vec<Fault>> {
    let one = |fault: Fault| vec![fault];
    let line = config.map_or_else(line::example, line::read)?;
    // Of the trains that run there only a line of one's own says anything; the example does not.
    let trains = config.and_then(|_| line.lives());
    let station = layout.map(station::read).transpose()?.map(|station| match trains {
        Some(trains) => station.with_trains(line.name(), trains),
        None => station,
    });
    plan(root, (line, station), mutants::catalogue(root).map_err(one)?)
}

/// What may be required.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Require {
    /// Every kernel claim proved by cbmc, every model as expected, every wrong kernel rejected.
    Proved,
}

/// Does what the command line says and returns the exit code: 0, 1 (the evidence says no) or 2 (bad input).
pub fn main(cli: Cli) -> u8 {
    let result = match cli.command {
        Command::Run(options) => run::run(&options),
        Command::Merge(options) => merge::merge(&options),
        Command::Compare { one, other } => merge::compare(&one, &other),
        Command::Render { from, layout, out, root } => {
            render::render(&from, layout.as_deref(), out.as_deref(), root.as_deref())
        }
        Command::Verify { folder, models, root } => render::verify(&folder, models, root.as_deref()),
        Command::Schema => {
            print!("{}", crate::output::schema());
            Ok(0)
        }
    };
    result.unwrap_or_else(|faults| {
        for fault in faults {
            eprintln!("error: {fault}");
        }
        USAGE
    })
}

/// The checkout: the given folder, or the nearest one above the current folder that has the kernel and the
/// specification.
fn checkout(given: Option<&Path>) -> Result<PathBuf, Fault> {
    let is_root =
        |path: &Path| path.join("kernel").is_dir() && path.join("spec").is_dir() && path.join("Cargo.lock").is_file();
    let start = match given {
        Some(path) => path.to_path_buf(),
        None => std::env::current_dir().map_err(|error| Fault::new(&"current folder", error))?,
    };
    let start = start.canonicalize().map_err(|error| Fault::new(&start.display(), error))?;
    let found = if given.is_some() {
        Some(start.as_path()).filter(|path| is_root(path))
    } else {
        start.ancestors().find(|path| is_root(path))
    };
    found.map(Path::to_path_buf).ok_or_else(|| {
        Fault::new(
            &start.display(),
            "this is not the checkout (a folder with kernel/, spec/ and Cargo.lock): give --root",
        )
    })
}
