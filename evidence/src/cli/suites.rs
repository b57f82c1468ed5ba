//! The tests of a run: after all else, or beside the theorems that take long.

use super::engines::{Engines, TESTS};
use super::imported;
use super::options::NATIVE_RUNS;
use crate::case::Phase;
use crate::cli::live::Live;
use crate::cli::times::Watch;
use crate::error::{Fault, read};
use crate::judge::again;
use crate::judge::scope::{Scope, Tests};
use crate::sources::proofs::Campaigned;
use crate::sources::tests;
use std::collections::BTreeSet;
use std::sync::PoisonError;
use std::time::Instant;

/// About how many seconds some of the tests take, where they are built.
const PART_OF_TESTS: f64 = 20.0;

impl Engines<'_> {
    /// Whether an earlier run's tests stand. Those that are given are looked at in any case, and it may not have had all.
    pub(super) fn tests_stand(&self) -> bool {
        self.kept.has(again::TESTS) && self.options.test_results.is_none() && !self.options.all_tests
    }

    /// Whether the tests run beside the theorems that take long. Alone, they leave processors idle; and what they find of theorems
    /// and models is not sought twice.
    pub(super) fn tests_beside(&self) -> bool {
        let here = !self.options.no_tests && self.options.test_results.is_none() && !self.tests_stand();
        let whole = *self.scope == Scope::Whole && self.chosen.tests != Tests::None && !self.budget.is_limited();
        here && whole && self.root.join(tests::SCRIPT).is_file()
    }

    pub(super) fn files(&self) -> tests::Files {
        let file = |name: &str| self.folder.stage().join(name);
        tests::Files { log: file("tests.log"), outcomes: file("outcomes.json"), native: file("native.json") }
    }

    /// Runs the tests, beside other work.
    pub(super) fn run_tests(&self, live: &Live) -> Result<(), Fault> {
        let started = Instant::now();
        let programs = if let Tests::Named(programs) = &self.chosen.tests { Some(programs) } else { None };
        let (run, cpu_seconds) =
            tests::run_beside(self.root, &self.files(), programs).map_err(|error| Fault::new(&tests::SCRIPT, error))?;
        let wall_seconds = started.elapsed().as_secs_f64();
        let slowest = vec![("cargo test".to_owned(), wall_seconds)];
        let name = format!("{TESTS}, beside what is long");
        live.with(|results| {
            results.tests = Some(run);
            results.phases.push(Phase { name, items: 1, wall_seconds, cpu_seconds, slowest });
        });
        Ok(())
    }

    /// Takes what the tests have found of theorems and models: of these very sources, or nothing. What cannot be read is sought here.
    pub(super) fn take(&self, live: &Live) {
        let (files, mut found) = (self.files(), BTreeSet::new());
        if files.native.is_file() && !self.options.no_native && self.options.native_runs == NATIVE_RUNS {
            let taken = imported::import(&files.native, self.sources).map_err(|fault| eprintln!("not used: {fault}"));
            if let Some(Campaigned { campaign, .. }) = taken.ok().filter(|one| !one.stale) {
                self.enter(live, "native", &campaign.harnesses, Some(&campaign.provenance));
                found.extend(campaign.harnesses.iter().map(|one| format!("native:{}", one.name)));
            }
        }
        if files.outcomes.is_file() && !self.options.no_models {
            let now = live.with(|results| results.provenance.clone());
            let taken = imported::outcomes(&files.outcomes, self.plan, self.chosen, &now)
                .map_err(|fault| eprintln!("not used: {fault}"));
            let mut new = taken.unwrap_or_default();
            new.retain(|one| !self.has(&format!("model:{}", one.model)));
            found.extend(new.iter().map(|one| format!("model:{}", one.model)));
            live.with(|results| {
                results.open.extend(imported::searched_by_tests(new.len()));
                results.outcomes.extend(new);
            });
        }
        self.found.lock().unwrap_or_else(PoisonError::into_inner).extend(found);
    }

    pub(super) fn suites(&self, live: &Live) -> Result<(), Fault> {
        let enter = |run: tests::Run| live.with(|results| results.tests = Some(run));
        if self.tests_stand() {
            return Ok(());
        }
        if let Some(path) = &self.options.test_results {
            let text = read(path)?;
            // A record has no exit code: a failure in it is seen by its own lines.
            enter(tests::parse(&text, !text.contains("error: ")));
            return Ok(());
        }
        if self.chosen.tests == Tests::None {
            return Ok(());
        }
        if self.options.no_tests {
            enter(tests::Run::NotRun("left out by --no-tests".to_owned()));
            return Ok(());
        }
        let Some(arguments) = self.chosen.tests.arguments() else {
            enter(tests::Run::NotRun(self.scope.why()));
            return Ok(());
        };
        if self.budget.affordable(vec![()], self.jobs, |()| PART_OF_TESTS).is_empty() {
            return Ok(());
        }
        Self::phase(live, TESTS, || {
            let log = self.folder.stage().join("tests.log");
            live.progress.watch(&log);
            let watch = Watch::start(TESTS);
            let run = tests::run(self.root, &log, &arguments).map_err(|error| Fault::new(&"cargo test", error))?;
            enter(run);
            Ok(vec![("cargo test".to_owned(), watch.end(Vec::new()).wall_seconds)])
        })
    }
}
