//! Named mutants. Each is a change of a line or two in a copy of the kernel and its arithmetic; a theorem that is proved of the kernel must fail on it.
//!
//! Each is run on the counterexamples that are kept of it (`recorded.rs`). The prover is asked of what they do not reject, and of a sample: most are
//! compiled together and selected at run time (`together.rs`); those that cannot be are compiled alone (`alone.rs`).

use crate::alone::attempt;
use crate::campaign::flags;
use crate::judged::Judged;
use crate::mutant::is_together;
use crate::options::{Asking, Options};
use crate::pool::{in_parallel, lock};
use crate::process::only_run;
use crate::recorded::{self, Recorded};
use crate::report::{Control, MutantResult, MutantVerdict, Mutants, SCHEMA};
use crate::tools::Tools;
use crate::{provenance, root, together};
use sha2::{Digest, Sha256};
use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;
use std::sync::Mutex;
use std::time::Instant;

pub use crate::asked::SLOW;
pub use crate::mutant::{Mutant, list};

/// Judges the named mutants (all of them, if no name is given). `progress` hears of every result.
///
/// # Errors
/// A name that no mutant has, or a broken `proofs/mutants.toml`.
pub fn mutants(
    options: &Options,
    names: &[String],
    progress: &(dyn Fn(&MutantResult) + Sync),
) -> Result<Mutants, String> {
    let root = root();
    let _lock = only_run(&options.folder)?;
    let started = Instant::now();
    let all = list(&root)?;
    if let Some(name) = names.iter().find(|name| !all.iter().any(|mutant| mutant.name == **name)) {
        let known: Vec<_> = all.iter().map(|mutant| mutant.name.as_str()).collect();
        return Err(format!("there is no mutant `{name}`; the mutants are {}", known.join(", ")));
    }
    let chosen: Vec<_> = all.iter().filter(|mutant| names.is_empty() || names.contains(&mutant.name)).collect();
    let tools = Tools::find(&root);
    let versions = tools.as_ref().map(|tools| tools.versions.clone()).unwrap_or_default();
    let mut provenance = provenance::of(&root, versions, flags(options.solver))?;
    let tally = Tally::new(&chosen, progress);
    let kept = kept(&root, options, &chosen);
    let is_asked = |place: usize, name: &str| match kept.get(&(place, name.to_owned())) {
        Some(Judged::Rejects(_)) => is_drawn(&provenance.sources_sha256, name),
        other => other.is_none(),
    };
    for ((place, name), judged) in kept.iter().filter(|((place, name), _)| !is_asked(*place, name)) {
        tally.judge(*place, name, judged.clone());
    }
    // What the prover is asked of.
    let (mut places, mut asked) = (Vec::new(), Vec::new());
    for (place, mutant) in chosen.iter().enumerate() {
        let killed_by: Vec<_> = mutant.killed_by.iter().filter(|name| is_asked(place, name)).cloned().collect();
        if !killed_by.is_empty() {
            places.push(place);
            asked.push(Mutant { killed_by, ..(*mutant).clone() });
        }
    }
    let tell = |index: usize, name: &str, judged: Judged| {
        let place = places[index];
        let judged = match (judged, kept.contains_key(&(place, name.to_owned()))) {
            (Judged::Passes, true) => {
                Judged::Error(format!("{name}: the prover does not reject what a kept counterexample does"))
            }
            (judged, _) => judged,
        };
        tally.judge(place, name, judged);
    };
    let controls = match &tools {
        Ok(tools) => ask(tools, &root, options, &asked, &tell),
        Err(reason) => {
            for (index, mutant) in asked.iter().enumerate() {
                for name in &mutant.killed_by {
                    let kill = kept.get(&(places[index], name.clone())).cloned();
                    tally.judge(places[index], name, kill.unwrap_or_else(|| Judged::NotRun(reason.clone())));
                }
            }
            Vec::new()
        }
    };
    let results = tally.results();
    provenance.seconds = started.elapsed().as_secs_f64();
    Ok(Mutants { schema: SCHEMA, provenance, mutants: results, controls })
}

/// What the counterexamples that are kept say of these mutants, by place and harness.
fn kept(root: &Path, options: &Options, mutants: &[&Mutant]) -> BTreeMap<(usize, String), Judged> {
    // They are of the harnesses at their own size.
    if options.asking != Asking::Some || options.aspects != atc_proofs::ASPECTS {
        return BTreeMap::new();
    }
    let found = Recorded::read(root).and_then(|recorded| recorded::replay(root, options, mutants, &recorded));
    found.unwrap_or_else(|reason| {
        // As with a group that does not compile: an error for each of them, and nothing else of the run is lost.
        let names = mutants
            .iter()
            .enumerate()
            .flat_map(|(place, mutant)| mutant.killed_by.iter().map(move |name| (place, name)));
        names.map(|(place, name)| ((place, name.clone()), Judged::Error(reason.clone()))).collect()
    })
}

/// Asks the prover of these mutants, together where that can be. Returns the controls.
fn ask(
    tools: &Tools,
    root: &Path,
    options: &Options,
    mutants: &[Mutant],
    tell: &(dyn Fn(usize, &str, Judged) + Sync),
) -> Vec<Control> {
    let (together, alone): (Vec<_>, Vec<_>) =
        (0..mutants.len()).partition(|index| options.asking != Asking::Alone && goes_together(root, &mutants[*index]));
    let picked: Vec<_> = together.iter().map(|index| &mutants[*index]).collect();
    let open = Mutex::new(BTreeSet::new());
    let controls = together::judge(tools, root, options, &picked, &|index, name, judged| {
        if judged.is_final() {
            tell(together[index], name, judged);
        } else {
            lock(&open).insert(together[index]);
        }
    });
    // What has no answer together may have one alone.
    let open = open.into_inner().unwrap_or_else(std::sync::PoisonError::into_inner);
    let alone: Vec<_> = alone.into_iter().chain(open).collect();
    in_parallel(options.jobs, alone.len(), |job| {
        let mutant = &mutants[alone[job]];
        match attempt(tools, root, mutant, options) {
            Ok(judged) => judged.into_iter().for_each(|(name, kill)| tell(alone[job], name, kill)),
            Err(reason) => {
                mutant.killed_by.iter().for_each(|name| tell(alone[job], name, Judged::Error(reason.clone())));
            }
        }
    });
    controls
}

/// One in this many mutants that a kept counterexample rejects is asked of the prover all the same. Those that share a harness are drawn
/// together: they have one symbolic execution.
const ONE_IN: u8 = 32;

/// Whether the sample of these sources has the harness in it.
fn is_drawn(sources: &str, harness: &str) -> bool {
    Sha256::digest(format!("{sources} {harness}"))[0] % ONE_IN == 0
}

/// Whether the mutant is compiled with others, and selected at run time.
fn goes_together(root: &Path, mutant: &Mutant) -> bool {
    !mutant.alone && is_together(root, mutant)
}

/// What the harnesses have said of the mutants so far.
struct Tally<'a> {
    mutants: &'a [&'a Mutant],
    progress: &'a (dyn Fn(&MutantResult) + Sync),
    started: Instant,
    /// By mutant and harness.
    judged: Mutex<BTreeMap<(usize, String), Judged>>,
}

impl<'a> Tally<'a> {
    fn new(mutants: &'a [&'a Mutant], progress: &'a (dyn Fn(&MutantResult) + Sync)) -> Self {
        Self { mutants, progress, started: Instant::now(), judged: Mutex::default() }
    }

    fn judge(&self, mutant: usize, harness: &str, judged: Judged) {
        let result = {
            let mut all = lock(&self.judged);
            all.insert((mutant, harness.to_owned()), judged);
            let of_it = |name: &String| all.get(&(mutant, name.clone()));
            let whole = self.mutants[mutant].killed_by.iter().all(|name| of_it(name).is_some_and(Judged::is_final));
            whole.then(|| self.result(mutant, &all))
        };
        if let Some(result) = result {
            (self.progress)(&result);
        }
    }

    fn result(&self, index: usize, all: &BTreeMap<(usize, String), Judged>) -> MutantResult {
        let mutant = self.mutants[index];
        let mut killed_by = Vec::new();
        let (mut survived, mut errors, mut not_run) = (Vec::new(), Vec::new(), Vec::new());
        let mut seconds = 0.0;
        for name in &mutant.killed_by {
            match all.get(&(index, name.clone())) {
                Some(Judged::Rejects(kill)) => killed_by.push(kill.clone()),
                Some(Judged::Passes) => survived.push(format!("{name} does not reject it")),
                Some(Judged::Error(reason)) => errors.push(reason.clone()),
                Some(Judged::NotRun(reason)) => not_run.push(reason.clone()),
                Some(Judged::Unanswered) | None => errors.push(format!("{name}: no answer")),
            }
        }
        seconds += self.started.elapsed().as_secs_f64();
        // Every harness that is named must reject it: a theorem that no longer does has become weaker.
        let (verdict, reasons) = match (errors.is_empty(), not_run.is_empty(), survived.is_empty()) {
            (false, ..) => (MutantVerdict::Error, errors),
            (true, false, _) => (MutantVerdict::NotRun, not_run),
            (true, true, false) => (MutantVerdict::Survived, survived),
            (true, true, true) => (MutantVerdict::Killed, Vec::new()),
        };
        MutantResult {
            name: mutant.name.clone(),
            what: mutant.what.clone(),
            requirements: mutant.requirements.clone(),
            file: mutant.path(),
            change: [mutant.find.clone(), mutant.replace.clone()],
            verdict,
            killed_by: if matches!(verdict, MutantVerdict::Error | MutantVerdict::NotRun) {
                Vec::new()
            } else {
                killed_by
            },
            reason: (!reasons.is_empty()).then(|| reasons.join("; ")),
            seconds,
        }
    }

    fn results(&self) -> Vec<MutantResult> {
        let all = lock(&self.judged);
        (0..self.mutants.len()).map(|index| self.result(index, &all)).collect()
    }
}
