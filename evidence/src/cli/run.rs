//! `safety-case run`.

use super::{Require, Run, checkout};
use crate::build::{Required, Results, build};
use crate::config;
use crate::error::{Fault, read};
use crate::inputs::proofs::{Campaigned, ENGINES};
use crate::inputs::second::Opinion;
use crate::inputs::{faults, measured, mutants, provenance, second, tests};
use crate::output::Folder;
use crate::plan::{Plan, plan};
use crate::prover;
use crate::stale;
use crate::station;
use crate::terminal;
use atc_models::{Limits, Outcome};
use atc_prover::report::{Campaign, SCHEMA};
use indicatif::{ProgressBar, ProgressStyle};
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

/// Runs everything and writes the case. Nothing is written if the line or the case's sources are bad.
///
/// # Errors
/// The command line, the line's parameters or a source of the case is bad, or the folder cannot be written.
pub fn run(options: &Run) -> Result<u8, Vec<Fault>> {
    let one = |fault: Fault| vec![fault];
    let start = Instant::now();
    let root = checkout(options.root.as_deref()).map_err(one)?;
    let line = match &options.config {
        Some(path) => config::parse(&path.display().to_string(), &read(path).map_err(one)?),
        None => config::parse("evidence/examples/my-line.toml", config::EXAMPLE),
    }
    .map_err(one)?;
    let station = options.layout.as_deref().map(station::read).transpose()?;
    let plan = plan(&root, (line, station), mutants::catalogue(&root).map_err(one)?)?;
    let sources = prover::sources(&root).map_err(one)?;
    let imported =
        options.import.iter().map(|path| import(path, &sources)).collect::<Result<Vec<_>, _>>().map_err(one)?;
    let mut provenance = provenance::collect(&root, sources.clone()).map_err(one)?;

    let out = options.out.clone().unwrap_or_else(|| root.join("target/safety-case"));
    let folder = Folder::begin(&out).map_err(one)?;
    let jobs = options.jobs.unwrap_or_else(|| std::thread::available_parallelism().map_or(1, usize::from)).max(1);

    // The models first: a cut set that nobody owns ends the run before the provers have taken their time.
    let (outcomes, no_outcome) = if options.no_models {
        (Vec::new(), "left out by --no-models".to_owned())
    } else {
        (models(&plan, jobs, options.time_limit), "no outcome".to_owned())
    };
    let requirements: Vec<_> = plan.requirements.iter().map(|one| one.id.clone()).collect();
    faults::check(&outcomes, &plan.data.assumptions, &requirements)?;
    let opinions = if options.no_models { Vec::new() } else { opinions(jobs) };
    let names: Vec<_> = plan.models.iter().map(|model| model.name.clone()).collect();
    second::check(&opinions, &names)?;

    let mut campaigns = imported;
    let mut killed = None;
    let provers = prover::options(jobs, options.time_limit);
    let here = |campaign: Campaign| {
        let stale = campaign.provenance.sources_sha256 != sources;
        Campaigned { campaign, source: "run here".to_owned(), stale }
    };
    if !options.no_native {
        campaigns.push(here(prover::native(&provers).map_err(one)?));
    }
    if !options.no_provers {
        let bar = bar(plan.harnesses.len(), "theorems");
        let campaign = prover::campaign(&provers, &bar).map_err(one)?;
        bar.finish_and_clear();
        provenance.tools.extend(campaign.provenance.tools.clone());
        provenance.flags.clone_from(&campaign.provenance.flags);
        campaigns.push(here(campaign));
    }
    if !options.no_provers && !options.no_mutants {
        let bar = bar(plan.mutants.len(), "mutants");
        let results = prover::mutants(&provers, &bar).map_err(one)?;
        bar.finish_and_clear();
        let stale = results.provenance.sources_sha256 != sources;
        killed = Some((results, stale));
    }
    let measured = measurements(options, &root, &folder);
    let tests = suites(options, &root, &folder).map_err(one)?;
    // What changed while the engines ran is not what they saw.
    let after = provenance::collect(&root, sources).map_err(one)?;
    let changed = provenance::differences(&provenance, &after);
    for one in opinions.iter().filter(|one| !one.version.is_empty()) {
        provenance.tools.insert(one.tool.clone(), one.version.clone());
    }
    provenance.aspects = atc_proofs::ASPECTS;
    provenance.generated_unix = provenance::now();
    provenance.seconds = start.elapsed().as_secs_f64();
    provenance.tools.insert("safety-case".to_owned(), env!("CARGO_PKG_VERSION").to_owned());

    let required = if options.require == Some(Require::Proved) { Required::Proved } else { Required::NoDefect };
    let mut case = build(
        &plan,
        Results { campaigns, mutants: killed, outcomes, no_outcome, opinions, measured, tests, provenance },
        required,
    );
    if !changed.is_empty() {
        stale::mark(&mut case, &changed);
    }
    folder.finish(&case).map_err(one)?;
    println!("{}", terminal::summary(&case));
    println!("{}", out.join("index.html").display());
    Ok(case.status.exit_code)
}

/// A campaign of another engine or machine.
fn import(path: &Path, sources: &str) -> Result<Campaigned, Fault> {
    let campaign: Campaign = serde_json::from_str(&read(path)?)
        .map_err(|error| Fault::new(&path.display(), format!("no campaign: {error}")))?;
    if campaign.schema != SCHEMA {
        return Err(Fault::new(&path.display(), format!("schema {} is not known; {SCHEMA} is", campaign.schema)));
    }
    if !ENGINES.iter().any(|(name, ..)| *name == campaign.engine) {
        let known = ENGINES.iter().map(|(name, ..)| *name).collect::<Vec<_>>().join(", ");
        return Err(Fault::new(
            &path.display(),
            format!("the engine \"{}\" is not known; known are {known}", campaign.engine),
        ));
    }
    let stale = campaign.provenance.sources_sha256 != sources;
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    Ok(Campaigned { campaign, source: format!("imported from {name}"), stale })
}

/// Searches every model, one after the other, each with all cores.
fn models(plan: &Plan, jobs: usize, limit: u64) -> Vec<Outcome> {
    let entries = atc_models::catalogue();
    let bar = bar(plan.models.len(), "models");
    let limits = Limits { time: Duration::from_secs(limit), ..Limits::default() };
    let outcomes = entries
        .iter()
        .map(|entry| {
            bar.set_message(entry.name.to_owned());
            let outcome = atc_models::check_within(entry, jobs, limits);
            bar.inc(1);
            outcome
        })
        .collect();
    bar.finish_and_clear();
    outcomes
}

/// What another checker says of the models.
fn opinions(threads: usize) -> Vec<Opinion> {
    let bar = bar(1, "spin");
    bar.enable_steady_tick(Duration::from_millis(200));
    let found = atc_models::second_opinions(threads).into_iter().map(Opinion::from).collect();
    bar.finish_and_clear();
    found
}

/// Signal and position, measured by the waveform package.
fn measurements(options: &Run, root: &Path, folder: &Folder) -> measured::Run {
    if let Some(path) = &options.measurements {
        return measured::read(path, &format!("read from {}", path.display()));
    }
    if options.no_measurements {
        return measured::Run::NotRun("left out by --no-measurements".to_owned());
    }
    let bar = bar(1, "waveform");
    bar.enable_steady_tick(Duration::from_millis(200));
    let raw = folder.stage().join("waveform");
    let run = measured::run(root, &raw, Duration::from_secs(options.time_limit));
    measured::tidy(&raw);
    bar.finish_and_clear();
    run
}

fn suites(options: &Run, root: &Path, folder: &Folder) -> Result<tests::Run, Fault> {
    if let Some(path) = &options.test_results {
        let text = read(path)?;
        // A record has no exit code: a failure in it is seen by its own lines.
        return Ok(tests::parse(&text, !text.contains("error: ")));
    }
    if options.no_tests {
        return Ok(tests::Run::NotRun("left out by --no-tests".to_owned()));
    }
    let bar = bar(1, "tests");
    bar.enable_steady_tick(Duration::from_millis(200));
    let log: PathBuf = folder.stage().join("tests.log");
    let result = tests::run(root, &log).map_err(|error| Fault::new(&"cargo test", error));
    bar.finish_and_clear();
    result
}

fn bar(length: usize, prefix: &'static str) -> ProgressBar {
    let style = ProgressStyle::with_template("{prefix:>8} {bar:30} {pos}/{len} {elapsed} {msg}");
    ProgressBar::new(u64::try_from(length).unwrap_or(u64::MAX))
        .with_prefix(prefix)
        .with_style(style.unwrap_or_else(|_| ProgressStyle::default_bar()))
}
