//! The engines of a run, one after the other; every result is entered as it comes.
//!
//! The cheap theorems come first, so that the page says something soon; then the models, as a cut set that nobody owns ends
//! the run; then the wrong kernels, and what takes long. Where all tests are run, they run beside that, and the models come last: the
//! tests have searched most of them. Where the time is limited, what takes long comes before the wrong kernels: a
//! theorem says more than that one more mutant is rejected by it.

use super::budget::Budget;
use super::options::Run;
use crate::cli::live::Live;
use crate::cli::progress::Work;
use crate::cli::prover;
use crate::cli::times::Watch;
use crate::error::Fault;
use crate::judge::again::{self, Kept};
use crate::judge::plan::Plan;
use crate::judge::scope::{Chosen, Scope, Tests};
use crate::render::output::Folder;
use crate::sources::faults;
use crate::sources::measured::{self, HERE};
use crate::sources::proofs::Campaigned;
use crate::sources::second::{self, Opinion};
use atc_models::spin::opinions_on;
use atc_models::{Entry, Limits, Outcome};
use atc_prover::Options;
use atc_prover::reals;
use atc_prover::report::{Campaign, HarnessResult, Mutants, Provenance, SCHEMA};
use std::collections::BTreeSet;
use std::convert::Infallible;
use std::panic::resume_unwind;
use std::path::Path;
use std::sync::{Mutex, PoisonError};
use std::time::Duration;

const NATIVE: &str = "native tests of theorems";
const CHEAP: &str = "proofs, the short ones";
const MODELS: &str = "models";
const SPIN: &str = "second opinions";
const MUTANTS: &str = "wrong kernels";
const HARD: &str = "proofs, the long ones";
const MEASURED: &str = "measurements";

/// What measures, as an item of a phase.
const BENCH: &str = "waveform bench";
/// The tests, as a phase.
pub(super) const TESTS: &str = "tests";

/// A theorem that takes more seconds than an ordinary one belongs to the second pass.
const LONG: f64 = 1.5;
type Items = Vec<(String, f64)>;

/// The engines of a run, and what they are about.
pub struct Engines<'a> {
    /// The command line.
    pub options: &'a Run,
    /// The checkout.
    pub root: &'a Path,
    /// What there is.
    pub plan: &'a Plan,
    /// What of it is run.
    pub chosen: &'a Chosen,
    /// The scope that this was chosen by.
    pub scope: &'a Scope,
    /// The folder of the run.
    pub folder: &'a Folder,
    /// How many at a time.
    pub jobs: usize,
    /// The hash of what the provers see.
    pub sources: &'a str,
    /// What an earlier run has concluded.
    pub kept: &'a Kept,
    /// The time that it has.
    pub budget: Budget,
    /// What the tests of this run have found besides: as in [`Kept::has`].
    pub found: Mutex<BTreeSet<String>>,
}

impl Engines<'_> {
    /// The phases to come, with their items and about how long each takes.
    pub fn works(&self) -> Vec<Work> {
        let costs = &self.plan.data.costs;
        let work = |name: &str, items: Items| Work { name: name.to_owned(), items };
        let of = |kind: &str, names: Vec<String>| -> Items {
            names.into_iter().map(|name| (name.clone(), costs.of(&format!("{kind}:{name}")))).collect()
        };
        let single = |name: &str, cost: f64| vec![(name.to_owned(), cost)];
        let mut works = Vec::new();
        if !self.options.no_native && !self.tests_beside() {
            let all = self.native_names().into_iter();
            works.push(work(NATIVE, all.map(|name| (name, costs.each.native)).collect()));
        }
        if !self.options.no_provers {
            works.push(work(CHEAP, of("harness", self.pass(false))));
            works.push(work(HARD, of("harness", self.pass(true))));
            if !self.options.no_mutants {
                works.push(work(MUTANTS, of("mutant", self.mutants())));
            }
        }
        let measured = if self.measures_here() { single(BENCH, costs.each.measured) } else { Vec::new() };
        if !self.options.no_models && !self.tests_beside() {
            let models = of("model", self.entries("model").iter().map(|entry| entry.name.to_owned()).collect());
            works.push(work(MODELS, if self.is_beside() { [models, measured.clone()].concat() } else { models }));
        }
        if !measured.is_empty() && !self.is_beside() {
            works.push(work(MEASURED, measured));
        }
        let tested = self.options.no_tests || self.options.test_results.is_some() || self.tests_stand();
        if self.chosen.tests != Tests::None && !tested {
            works.push(work(TESTS, single("cargo test", costs.each.test)));
        }
        works
    }

    /// Runs all that is asked for.
    ///
    /// # Errors
    /// A source cannot be read, or the models have found what nobody owns.
    pub fn run(&self, live: &Live) -> Result<(), Vec<Fault>> {
        let one = |fault: Fault| vec![fault];
        let mut provers = prover::options(self.jobs, self.options.time_limit, self.scope);
        provers.tests = self.options.native_runs;
        let beside = self.tests_beside();
        if !beside {
            self.native(live, &provers).map_err(one)?;
        }
        if !self.options.no_provers {
            self.theorems(live, &provers, CHEAP, &self.pass(false)).map_err(one)?;
        }
        if !beside {
            self.models(live)?;
        }
        std::thread::scope(|scope| {
            let tests = beside.then(|| scope.spawn(|| self.run_tests(live)));
            self.long(live, &provers)?;
            tests.map_or(Ok(()), |tests| {
                // All that they ran beside is over.
                live.progress.begin(TESTS);
                live.progress.watch(&self.files().log);
                let done = tests.join().unwrap_or_else(|panic| resume_unwind(panic));
                live.progress.end();
                done
            })
        })
        .map_err(one)?;
        if beside {
            self.take(live);
            self.native(live, &provers).map_err(one)?;
            self.models(live)?;
        }
        self.measurements(live);
        if beside { Ok(()) } else { self.suites(live).map_err(one) }
    }

    /// The wrong kernels, and the theorems that take long.
    fn long(&self, live: &Live, provers: &Options) -> Result<(), Fault> {
        if self.options.no_provers {
            return Ok(());
        }
        let limited = self.budget.is_limited();
        if limited {
            self.theorems(live, provers, HARD, &self.pass(true))?;
        }
        if !self.options.no_mutants {
            self.wrong_kernels(live, provers)?;
        }
        if limited { Ok(()) } else { self.theorems(live, provers, HARD, &self.pass(true)) }
    }

    /// The names of the harnesses of the run, the cheapest first.
    fn harnesses(&self, wanted: impl Fn(f64) -> bool) -> Vec<String> {
        let costs = &self.plan.data.costs;
        let all = self.plan.harnesses.iter().map(|harness| harness.name.clone());
        let mut names = self.chosen.names("harness", all);
        let cost = |name: &String| costs.of(&format!("harness:{name}"));
        names.retain(|name| wanted(cost(name)));
        names.sort_by(|one, other| cost(one).total_cmp(&cost(other)));
        names
    }

    /// Whether there is a result already: of an earlier run, or of the tests of this one.
    pub(super) fn has(&self, id: &str) -> bool {
        self.kept.has(id) || self.found.lock().unwrap_or_else(PoisonError::into_inner).contains(id)
    }

    /// Those of them of which there is no result of this kind.
    fn open(&self, kind: &str, mut names: Vec<String>) -> Vec<String> {
        names.retain(|name| !self.has(&format!("{kind}:{name}")));
        names
    }

    /// Those of them that end in the time that the run has.
    fn in_time(&self, kind: &str, names: Vec<String>) -> Vec<String> {
        let costs = &self.plan.data.costs;
        let each =
            |name: &String| if kind == "native" { costs.each.native } else { costs.of(&format!("{kind}:{name}")) };
        self.budget.affordable(names, self.jobs, each)
    }

    fn native_names(&self) -> Vec<String> {
        self.open("native", self.harnesses(|_| true))
    }

    fn pass(&self, long: bool) -> Vec<String> {
        let limit = LONG * self.plan.data.costs.each.harness;
        self.open("harness", self.harnesses(|cost| (cost > limit) == long))
    }

    fn mutants(&self) -> Vec<String> {
        self.open("mutant", self.chosen.names("mutant", self.plan.mutants.iter().map(|mutant| mutant.name.clone())))
    }

    fn entries(&self, kind: &str) -> Vec<Entry> {
        let mut entries = atc_models::catalogue();
        entries.retain(|entry| self.chosen.has(&format!("model:{}", entry.name)));
        entries.retain(|entry| !self.has(&format!("{kind}:{}", entry.name)));
        entries
    }

    fn measures(&self) -> bool {
        measured::TARGETS.iter().any(|target| self.chosen.has(&measured::id(target.name)))
            && !self.kept.has(again::MEASURED)
    }

    /// Whether the waveform package is to measure, here and now.
    fn measures_here(&self) -> bool {
        self.measures() && !self.options.no_measurements && self.options.measurements.is_none()
    }

    /// Whether it measures beside the search of models: it has one thread, and the models leave some of the others idle.
    fn is_beside(&self) -> bool {
        self.measures_here() && !self.options.no_models && !self.entries("model").is_empty()
    }

    /// One phase: its progress, and where its time went.
    pub(super) fn phase<E>(live: &Live, name: &str, work: impl FnOnce() -> Result<Items, E>) -> Result<(), E> {
        live.progress.begin(name);
        let watch = Watch::start(name);
        let items = work()?;
        live.progress.end();
        live.with(|results| results.phases.push(watch.end(items)));
        Ok(())
    }

    /// A campaign without a result, to enter some.
    fn empty(&self, engine: &str) -> Campaigned {
        let provenance = Provenance { sources_sha256: self.sources.to_owned(), ..Provenance::default() };
        let campaign = Campaign { schema: SCHEMA, engine: engine.to_owned(), provenance, harnesses: Vec::new() };
        Campaigned { campaign, source: HERE.to_owned(), stale: false }
    }

    /// Enters results of an engine that runs here; those of the same harnesses that were entered before go.
    pub(super) fn enter(&self, live: &Live, engine: &str, new: &[HarnessResult], said: Option<&Provenance>) {
        live.with(|results| {
            let mine = |one: &Campaigned| one.campaign.engine == engine && one.source == HERE;
            if !results.campaigns.iter().any(mine) {
                results.campaigns.push(self.empty(engine));
            }
            let Some(one) = results.campaigns.iter_mut().find(|one| mine(one)) else { return };
            one.campaign.harnesses.retain(|old| !new.iter().any(|new| new.name == old.name));
            one.campaign.harnesses.extend(new.iter().cloned());
            if let Some(said) = said {
                one.stale |= said.sources_sha256 != self.sources;
                let seconds = one.campaign.provenance.seconds + said.seconds;
                one.campaign.provenance = Provenance { seconds, ..said.clone() };
                results.provenance.tools.extend(said.tools.clone());
                if !said.flags.is_empty() {
                    results.provenance.flags.clone_from(&said.flags);
                }
            }
        });
    }

    fn native(&self, live: &Live, provers: &Options) -> Result<(), Fault> {
        if self.options.no_native {
            return Ok(());
        }
        let names = self.in_time("native", self.native_names());
        self.enter(live, "native", &[], None);
        if names.is_empty() {
            return Ok(());
        }
        Self::phase(live, NATIVE, || {
            let mut items = Vec::new();
            for some in names.chunks(provers.jobs.max(1) * 4) {
                let campaign = prover::native(provers, &prover::harnesses(some)?)?;
                self.enter(live, "native", &campaign.harnesses, Some(&campaign.provenance));
                for result in &campaign.harnesses {
                    live.progress.done(&result.name);
                    items.push((result.name.clone(), result.seconds));
                }
            }
            Ok(items)
        })
    }

    fn theorems(&self, live: &Live, provers: &Options, name: &str, names: &[String]) -> Result<(), Fault> {
        self.enter(live, "cbmc", &[], None);
        let names = &self.in_time("harness", names.to_vec());
        if names.is_empty() {
            return Ok(());
        }
        Self::phase(live, name, || {
            let entered = |result: &HarnessResult| {
                live.progress.done(&result.name);
                self.enter(live, "cbmc", std::slice::from_ref(result), None);
            };
            // First the algebra, which takes no time: whoever has the one result has the other.
            let algebra = prover::reals(provers, &prover::harnesses(names)?)?;
            if !algebra.harnesses.is_empty() {
                self.enter(live, reals::ENGINE, &algebra.harnesses, Some(&algebra.provenance));
            }
            let campaign = prover::campaign(provers, &prover::harnesses(names)?, &entered)?;
            self.enter(live, "cbmc", &campaign.harnesses, Some(&campaign.provenance));
            Ok(campaign.harnesses.iter().map(|one| (one.name.clone(), one.seconds)).collect())
        })
    }

    fn wrong_kernels(&self, live: &Live, provers: &Options) -> Result<(), Fault> {
        let names = self.in_time("mutant", self.mutants());
        if names.is_empty() {
            return Ok(());
        }
        Self::phase(live, MUTANTS, || {
            let provenance = self.empty("cbmc").campaign.provenance;
            let none = Mutants { schema: SCHEMA, provenance, mutants: Vec::new(), controls: Vec::new() };
            let before = live.with(|results| results.mutants.get_or_insert((none, false)).0.clone());
            let mut found = prover::mutants(provers, &names, &|result| {
                live.progress.done(&result.name);
                live.with(|results| results.mutants.iter_mut().for_each(|(all, _)| all.mutants.push(result.clone())));
            })?;
            let items = found.mutants.iter().map(|one| (one.name.clone(), one.seconds)).collect();
            let stale = found.provenance.sources_sha256 != self.sources;
            let anew = |harness: &str| found.controls.iter().any(|control| control.harness == harness);
            let controls: Vec<_> = before.controls.into_iter().filter(|old| !anew(&old.harness)).collect();
            found.controls.extend(controls);
            found.mutants.extend(before.mutants);
            live.with(|results| results.mutants = Some((found, stale)));
            Ok(items)
        })
    }

    /// Searches every model, the largest first, as many at a time as there are cores; then asks another checker.
    fn models(&self, live: &Live) -> Result<(), Vec<Fault>> {
        if self.options.no_models {
            live.with(|results| "left out by --no-models".clone_into(&mut results.no_outcome));
            return Ok(());
        }
        let cost = |entry: &Entry| self.plan.data.costs.of(&format!("model:{}", entry.name));
        let mut entries = self.budget.affordable(self.entries("model"), self.jobs, cost);
        entries.sort_by(|one, other| cost(other).total_cmp(&cost(one)));
        let limits = Limits { time: Duration::from_secs(self.options.time_limit), ..Limits::default() };
        let beside = self.is_beside();
        let searched = || {
            let items = std::thread::scope(|scope| {
                let measured = beside.then(|| scope.spawn(|| self.measure(live, &|_| ())));
                let search = |entry: &Entry| {
                    live.progress.running(entry.name);
                    atc_models::check_within(entry, 1, limits)
                };
                let searched = |outcome: &Outcome| {
                    live.progress.done(&outcome.model);
                    live.with(|results| results.outcomes.push(outcome.clone()));
                };
                let found = atc_models::in_parallel(&entries, self.jobs, search, searched);
                let mut items: Items = found.into_iter().map(|outcome| (outcome.model, outcome.seconds)).collect();
                if measured.is_some() {
                    live.progress.running(BENCH);
                }
                items.extend(measured.map(|thread| thread.join().unwrap_or_else(|panic| resume_unwind(panic))));
                items
            });
            let requirements: Vec<_> = self.plan.requirements.iter().map(|one| one.id.clone()).collect();
            faults::check(&live.with(|results| results.outcomes.clone()), &self.plan.data.assumptions, &requirements)?;
            Ok::<_, Vec<Fault>>(items)
        };
        if !entries.is_empty() {
            Self::phase(live, MODELS, searched)?;
        }
        let entries = self.entries("opinion");
        let names: Vec<_> = self.plan.models.iter().map(|model| model.name.clone()).collect();
        if !entries.iter().any(|entry| entry.twin.is_some()) {
            return Ok(());
        }
        Self::phase(live, SPIN, || {
            let said = |(_, one): &(atc_models::Outcome, atc_models::SecondOpinion)| live.progress.done(&one.model);
            let known = live.with(|results| results.outcomes.clone());
            let found = opinions_on(&entries, &known, self.jobs, said);
            let found: Vec<_> = found.into_iter().map(Opinion::from).collect();
            let before = live.with(|results| results.opinions.clone());
            second::check(&[before, found.clone()].concat(), &names)?;
            let items = found.iter().map(|one| (one.model.clone(), one.seconds)).collect();
            live.with(|results| {
                // What the provers' tools say of it says more, and comes before or after.
                for one in found.iter().filter(|one| !one.version.is_empty()) {
                    results.provenance.tools.entry(one.tool.clone()).or_insert_with(|| one.version.clone());
                }
                results.opinions.extend(found);
            });
            Ok(items)
        })
    }

    /// Signal and position, measured by the waveform package.
    fn measurements(&self, live: &Live) {
        if !self.measures() {
            return;
        }
        let enter = |run: measured::Run| live.with(|results| results.measured = Some(run));
        if let Some(path) = &self.options.measurements {
            return enter(measured::read(path, &format!("read from {}", path.display())));
        }
        if self.options.no_measurements {
            return enter(measured::Run::NotRun("left out by --no-measurements".to_owned()));
        }
        // Else it was done beside the models.
        if !self.is_beside() {
            let work = || Ok::<_, Infallible>(vec![self.measure(live, &|log| live.progress.watch(log))]);
            let Ok(()) = Self::phase(live, MEASURED, work);
        }
    }

    /// Runs the waveform package. Its time.
    fn measure(&self, live: &Live, watch: &(dyn Fn(&Path) + Sync)) -> (String, f64) {
        let raw = self.folder.stage().join("waveform");
        let limit = Duration::from_secs(self.options.time_limit);
        let run = measured::run(self.root, &raw, limit, &|log| watch(log));
        measured::tidy(&raw);
        let seconds = if let measured::Run::Ran(ran) = &run { ran.seconds } else { 0.0 };
        live.with(|results| results.measured = Some(run));
        live.progress.done(BENCH);
        (BENCH.to_owned(), seconds)
    }
}
