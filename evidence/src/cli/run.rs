//! `safety-case run`.

use super::budget::Budget;
use super::checkout::{checkout, planned};
use super::engines::Engines;
use super::imported::{import, outcomes, searched_by_tests};
use super::options::{Run, required};
use crate::case::Provenance;
use crate::cli::live::Live;
use crate::cli::progress::Progress;
use crate::cli::prover;
use crate::error::Fault;
use crate::judge::again::{self, Kept};
use crate::judge::build::{Results, build};
use crate::judge::scope::{Chosen, Scope};
use crate::judge::{results, stale};
use crate::render::files::PAGE;
use crate::render::output::Folder;
use crate::render::terminal;
use crate::sources::proofs::Campaigned;
use crate::sources::{faults, provenance};
use atc_models::Outcome;
use std::sync::Mutex;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

/// Runs everything, or what is asked for, and writes the case. Nothing is written if the line or the case's sources are bad.
///
/// # Errors
/// The command line, the line's parameters or a source of the case is bad, or the folder cannot be written.
pub fn run(options: &Run) -> Result<u8, Vec<Fault>> {
    let one = |fault: Fault| vec![fault];
    let start = Instant::now();
    let root = checkout(options.root.as_deref()).map_err(one)?;
    let plan = planned(&root, options.config.as_deref(), options.layout.as_deref())?;
    let scope = options.scope();
    let mut chosen = Chosen::of(&plan, &scope).map_err(one)?;
    if options.all_tests {
        chosen = chosen.with_all_tests();
    }
    let sources = prover::sources(&root).map_err(one)?;
    let campaigns =
        options.import.iter().map(|path| import(path, &sources)).collect::<Result<Vec<_>, _>>().map_err(one)?;
    let mut provenance = provenance::collect(&root, sources.clone()).map_err(one)?;
    provenance.aspects = atc_proofs::ASPECTS;
    let outcomes =
        options.outcomes.as_deref().map_or(Ok(Vec::new()), |path| outcomes(path, &plan, &chosen, &provenance));
    let outcomes = outcomes.map_err(one)?;
    let requirements: Vec<_> = plan.requirements.iter().map(|one| one.id.clone()).collect();
    faults::check(&outcomes, &plan.data.assumptions, &requirements)?;
    let before = provenance.clone();

    let out = options.out.clone().unwrap_or_else(|| root.join("target/safety-case"));
    let versions = prover::versions(&root);
    let mut kept = if options.anew { Kept::default() } else { again::kept(&out, &provenance, &scope, &versions) };
    kept.take(&outcomes);
    let folder = Folder::begin(&out).map_err(one)?;
    let jobs = options.jobs.unwrap_or_else(|| std::thread::available_parallelism().map_or(1, usize::from)).max(1);
    let engines = Engines {
        options,
        root: &root,
        plan: &plan,
        chosen: &chosen,
        scope: &scope,
        folder: &folder,
        jobs,
        sources: &sources,
        kept: &kept,
        budget: Budget::new(options.limit(), start),
        found: Mutex::default(),
    };
    if kept.count() > 0 {
        eprintln!("{} results stand from an earlier run of this commit; run all again with --anew", kept.count());
    }
    let progress = Progress::new(engines.works(), jobs);
    let nothing = beginning(nothing(provenance), &scope, &kept, (campaigns, outcomes));
    let live = Live::begin(&plan, required(options.require), &folder, progress, nothing).map_err(one)?;
    eprintln!("the page, incomplete until the end: {}", out.join(PAGE).display());
    ticking(&live, || engines.run(&live))?;
    live.with(|results| results.open.extend(engines.budget.open_item()));
    let mut results = live.end();

    // What changed while the engines ran is not what they saw.
    let after = provenance::collect(&root, sources).map_err(one)?;
    let changed = provenance::differences(&before, &after);
    results.provenance.generated_unix = provenance::now();
    results.provenance.seconds = start.elapsed().as_secs_f64();
    results.provenance.tools.insert("safety-case".to_owned(), env!("CARGO_PKG_VERSION").to_owned());
    // Shards of sources that changed would be taken for shards of these.
    let said = changed.is_empty().then(|| results::json(&results)).transpose().map_err(one)?;
    let mut case = build(&plan, results, required(options.require)).map_err(one)?;
    if !changed.is_empty() {
        stale::mark(&mut case, &changed);
    }
    folder.finish(&case, said).map_err(one)?;
    println!("{}", terminal::summary(&case));
    println!("open {}", out.join(PAGE).display());
    Ok(case.status.exit_code)
}

/// Results that say nothing yet.
fn nothing(provenance: Provenance) -> Results {
    Results {
        scope: Scope::Whole,
        running: true,
        joined: Vec::new(),
        kept_since: None,
        campaigns: Vec::new(),
        mutants: None,
        outcomes: Vec::new(),
        no_outcome: "no outcome".to_owned(),
        opinions: Vec::new(),
        measured: None,
        tests: None,
        provenance,
        open: Vec::new(),
        phases: Vec::new(),
    }
}

/// The results at the start of a run: what stands of an earlier one, and what was imported.
fn beginning(
    nothing: Results,
    scope: &Scope,
    kept: &Kept,
    (imported, given): (Vec<Campaigned>, Vec<Outcome>),
) -> Results {
    let mut first = Results { scope: scope.clone(), ..nothing };
    if let Some(old) = kept.results.clone() {
        first.provenance.tools.extend(old.provenance.tools);
        first.provenance.flags = old.provenance.flags;
        let kept_since = Some(old.kept_since.unwrap_or(old.provenance.generated_unix));
        let Results { campaigns, mutants, outcomes, no_outcome, opinions, measured, tests, .. } = old;
        first = Results { kept_since, campaigns, mutants, outcomes, no_outcome, opinions, measured, tests, ..first };
    }
    first.campaigns.extend(imported);
    first.open.extend(searched_by_tests(given.len()));
    first.outcomes.retain(|old| !given.iter().any(|new| new.model == old.model));
    first.outcomes.extend(given);
    first
}

/// Does the work while line and page are kept up to date beside it.
fn ticking<T>(live: &Live, work: impl FnOnce() -> T) -> T {
    /// Ends the thread also when the work panics.
    struct End<'a>(&'a AtomicBool);
    impl Drop for End<'_> {
        fn drop(&mut self) {
            self.0.store(true, Ordering::Relaxed);
        }
    }
    let over = AtomicBool::new(false);
    std::thread::scope(|scope| {
        scope.spawn(|| {
            while !over.load(Ordering::Relaxed) {
                live.tick();
                std::thread::sleep(Duration::from_millis(200));
            }
        });
        let _end = End(&over);
        work()
    })
}
