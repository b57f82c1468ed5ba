//! All harnesses, in parallel over the cores.

use crate::cbmc::{Answer, CBMC, Halves, PROOF, Question, Silence, Solver, ask_both};
use crate::compile::{Compiled, Kernel, RUSTC, compile};
use crate::native::{self, blank};
use crate::options::Options;
use crate::pool::{in_parallel, lock};
use crate::process::only_run;
use crate::report::{Campaign, HarnessResult, SCHEMA, Verdict};
use crate::tools::Tools;
use crate::{provenance, root, selftest};
use atc_proofs::Harness;
use std::collections::BTreeSet;
use std::path::Path;
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::{Duration, Instant};

/// The name of the engine.
const ENGINE: &str = "cbmc";

/// Proves `harnesses` with CBMC. `progress` hears of every result as it comes.
///
/// Without the provers every harness is *not run*. If the engine fails its own self-test, every harness is an error.
///
/// # Errors
/// The sources cannot be read. (A harness that does not prove is a result, not an error.)
pub fn campaign(
    options: &Options,
    harnesses: &[&Harness],
    progress: &(dyn Fn(&HarnessResult) + Sync),
) -> Result<Campaign, String> {
    let root = root();
    let _lock = only_run(&options.folder)?;
    let started = Instant::now();
    let tools = Tools::find(&root);
    let versions = tools.as_ref().map(|tools| tools.versions.clone()).unwrap_or_default();
    let mut provenance = provenance::of(&root, versions, flags(options.solver))?;
    provenance.aspects = options.aspects;
    let folder = options.folder.join("kernel");
    let ready = tools.map_err(|reason| (Verdict::NotRun, reason)).and_then(|tools| {
        let failed = |reason| (Verdict::Error, reason);
        selftest::check(&tools, options).map_err(failed)?;
        // The compiler has one thread for what is optimised as a whole: as many parts as there are jobs.
        let parts = options.jobs.clamp(1, harnesses.len().max(1));
        let names = |part: usize| {
            harnesses.iter().skip(part).step_by(parts).map(|harness| harness.name.to_owned()).collect::<Vec<_>>()
        };
        let compiled = in_parallel(parts, parts, |part| {
            compile(&tools, &root, &folder.join(part.to_string()), options.aspects, &names(part), Kernel::AsItIs)
        });
        Ok((tools, compiled.into_iter().collect::<Result<Vec<_>, _>>().map_err(failed)?))
    });
    let results = match ready {
        Ok((tools, compiled)) => prove_all(&tools, &compiled, options, harnesses, progress),
        Err((verdict, reason)) => harnesses
            .iter()
            .map(|harness| {
                let result = unproven(harness, ENGINE, verdict, reason.clone());
                progress(&result);
                result
            })
            .collect(),
    };
    provenance.seconds = started.elapsed().as_secs_f64();
    Ok(Campaign { schema: SCHEMA, engine: ENGINE.to_owned(), provenance, harnesses: results })
}

/// Tests `harnesses` natively.
///
/// # Errors
/// The sources cannot be read.
pub fn native_campaign(options: &Options, harnesses: &[&Harness]) -> Result<Campaign, String> {
    let started = Instant::now();
    let mut provenance = provenance::of(&root(), std::collections::BTreeMap::new(), Vec::new())?;
    let results = in_parallel(options.jobs, harnesses.len(), |index| native::test(harnesses[index], options.tests));
    provenance.seconds = started.elapsed().as_secs_f64();
    Ok(Campaign { schema: SCHEMA, engine: "native".to_owned(), provenance, harnesses: results })
}

/// The options of compiler and prover, for the record.
pub(crate) fn flags(solver: Solver) -> Vec<String> {
    let flags = RUSTC.iter().chain(&CBMC).chain([&PROOF]).map(ToString::to_string);
    flags.chain([format!("solver={}", solver.name())]).collect()
}

/// A result of this verdict, claim by claim.
pub(crate) fn unproven(harness: &Harness, engine: &str, verdict: Verdict, reason: String) -> HarnessResult {
    let mut result = blank(harness, engine);
    result.verdict = verdict;
    result.reason = Some(reason);
    for claim in &mut result.claims {
        claim.verdict = verdict;
    }
    result
}

fn prove_all(
    tools: &Tools,
    compiled: &[Compiled],
    options: &Options,
    harnesses: &[&Harness],
    progress: &(dyn Fn(&HarnessResult) + Sync),
) -> Vec<HarnessResult> {
    // A job is one case of one harness; those that take longest first.
    let folders = in_parallel(options.jobs, harnesses.len(), |index| {
        compiled[index % compiled.len()].to_c(tools, harnesses[index].name, None)
    });
    let cases = |harness: &Harness| cases_of(harness, options.aspects);
    let mut jobs: Vec<(usize, usize)> =
        (0..harnesses.len()).flat_map(|index| (0..cases(harnesses[index])).map(move |case| (index, case))).collect();
    let weight = |index: usize| {
        HARD.iter().rev().position(|(name, _)| *name == harnesses[index].name).map_or(0, |place| place + 1)
    };
    jobs.sort_by_key(|(index, _)| std::cmp::Reverse((weight(*index), cases(harnesses[*index]))));
    let pending: Vec<_> = harnesses.iter().map(|harness| AtomicUsize::new(cases(harness))).collect();
    let collected: Vec<_> = harnesses.iter().map(|_| Mutex::new(Vec::new())).collect();
    let results: Vec<_> = harnesses.iter().map(|_| Mutex::new(None)).collect();
    in_parallel(options.jobs, jobs.len(), |job| {
        let (index, case) = jobs[job];
        let harness = harnesses[index];
        let answer = match &folders[index] {
            Ok(folder) => case_of(tools, folder, harness, (case, cases(harness)), options),
            Err(reason) => {
                let silence = || Err(Silence::Broken(reason.clone()));
                (silence(), silence())
            }
        };
        lock(&collected[index]).push((case, answer));
        if pending[index].fetch_sub(1, Ordering::AcqRel) == 1 {
            let mut all = std::mem::take(&mut *lock(&collected[index]));
            all.sort_by_key(|(case, _)| *case);
            let result = conclude(harness, options, &all.into_iter().map(|(_, answer)| answer).collect::<Vec<_>>());
            progress(&result);
            *lock(&results[index]) = Some(result);
        }
    });
    let missing =
        |harness: &Harness| unproven(harness, ENGINE, Verdict::Error, "the runner lost this result".to_owned());
    results
        .into_iter()
        .zip(harnesses)
        .map(|(result, harness)| lock(&result).take().unwrap_or_else(|| missing(harness)))
        .collect()
}

/// The harnesses for which MiniSat is known to have no answer in the time that it is given, or takes twice as long, those that take longest
/// first; each with the solver that has one. Found by running them, and a matter of time only.
pub const HARD: [(&str, Solver); 20] = [
    ("t_atc_1_apart", Solver::Kissat),
    ("t_per_5_speed", Solver::Z3),
    ("t_trn_1_distance", Solver::Kissat),
    ("carry_away", Solver::Z3),
    ("t_per_4", Solver::Kissat),
    ("per_machine", Solver::Kissat),
    ("pos_part_rounds", Solver::Z3),
    ("t_per_7", Solver::Kissat),
    ("t_per_4_fix", Solver::Kissat),
    ("t_per_5_behind", Solver::Kissat),
    ("t_per_6_announced", Solver::Kissat),
    ("t_blk_4_geometry", Solver::Z3),
    ("way_join", Solver::Kissat),
    ("t_pos_1_levels", Solver::Kissat),
    ("t_pos_2", Solver::Kissat),
    ("t_way_1_joint", Solver::Kissat),
    ("pos_machine", Solver::Kissat),
    ("t_code_3", Solver::Kissat),
    ("t_pos_1_step", Solver::Kissat),
    ("t_code_1", Solver::Kissat),
];

/// Which solver to ask at once, if MiniSat is known to have no answer.
pub(crate) fn known(harness: &str) -> Option<Solver> {
    HARD.iter().find(|(name, _)| *name == harness).map(|(_, solver)| *solver)
}

/// Whether the size of the harness is a parameter.
fn is_sized(harness: &Harness) -> bool {
    harness.bound == atc_proofs::bound(atc_proofs::ASPECTS)
}

/// The harness's cases at this size: a sized one that is split is split over the aspects, or over one more of them.
fn cases_of(harness: &Harness, aspects: usize) -> usize {
    if is_sized(harness) && harness.cases > 1 {
        (aspects + harness.cases - atc_proofs::ASPECTS).min(atc_kernel::aspect::MAX_ASPECTS)
    } else {
        harness.cases
    }
}

fn case_of(tools: &Tools, folder: &Path, harness: &Harness, case: (usize, usize), options: &Options) -> Halves {
    let question = Question { case, ..Question::proof(harness.name, options.solver, options.limit) };
    ask_both(tools, folder, &question, known(harness.name))
}

/// The result of a harness from its cases: every claim must hold and be reachable in every case, every cover point must be hit in one.
fn conclude(harness: &Harness, options: &Options, cases: &[Halves]) -> HarnessResult {
    let mut result = unproven(harness, ENGINE, Verdict::Error, String::new());
    result.reason = None;
    if is_sized(harness) {
        atc_proofs::bound(options.aspects).clone_into(&mut result.bound);
    }
    let took =
        |answer: &Result<(Answer, Duration), Silence>| answer.as_ref().map_or(0.0, |(_, took)| took.as_secs_f64());
    result.seconds = cases.iter().map(|(proof, reach)| took(proof) + took(reach)).sum();
    let mut answers = Vec::new();
    for (proof, reach) in cases {
        match (proof, reach) {
            (Ok((proof, _)), Ok((reach, _))) => answers.push((proof, reach)),
            (Err(Silence::Late), _) | (_, Err(Silence::Late)) => {
                let reason = format!("no answer within {} s of CPU time", options.limit.as_secs());
                return unproven(harness, ENGINE, Verdict::Timeout, reason);
            }
            (Err(Silence::Broken(reason)), _) | (_, Err(Silence::Broken(reason))) => {
                return unproven(harness, ENGINE, Verdict::Error, reason.clone());
            }
        }
    }
    let solvers: BTreeSet<_> = answers.iter().filter_map(|(proof, _)| proof.solver).map(Solver::name).collect();
    result.solver = solvers.into_iter().collect::<Vec<_>>().join(", ");
    result.unwound = answers.iter().map(|(proof, _)| proof.unwound).max().unwrap_or(0);
    for (number, claim) in result.claims.iter_mut().enumerate() {
        let verdict = |(proof, reach): &(&Answer, &Answer)| match (proof.claim(number), reach.claim(number)) {
            (Some(false), _) => Verdict::Failed,
            (Some(true), Some(false)) => Verdict::Proved,
            // Also if the assertion is not there at all: no code path leads to it.
            _ => Verdict::Vacuous,
        };
        claim.verdict = answers.iter().map(verdict).max().unwrap_or(Verdict::Vacuous);
    }
    for (number, cover) in result.covers.iter_mut().enumerate() {
        cover.hit = answers.iter().any(|(_, reach)| reach.cover(number) == Some(false));
    }
    let tape = |case: usize, values: &[u16]| {
        native::replay_case(harness, case, values).drawn.into_iter().map(|(_, value)| value).collect::<Vec<_>>()
    };
    let is_claim = |(what, _): &(&String, &Vec<u16>)| what.starts_with("claim ");
    let failed = |proof: &Answer| proof.values.iter().find(is_claim).map(|(_, values)| values.clone());
    let mut each = answers.iter().enumerate();
    result.counterexample = each.find_map(|(case, (proof, _))| Some(tape(case, &failed(proof)?)));
    if let Some(trap) = answers.iter().find_map(|(proof, _)| proof.other_failure()) {
        // What comes after a trap is cut off, so nothing is proved.
        let mut each = answers.iter().enumerate();
        let values = each.find_map(|(case, (proof, _))| Some(tape(case, proof.values.get(trap)?)));
        result.reason = Some(format!("{trap} can be reached"));
        result.counterexample = result.counterexample.or(values);
        for claim in &mut result.claims {
            claim.verdict = claim.verdict.max(Verdict::Error);
        }
        let is_trap = trap.starts_with("trap: ");
        result.verdict = if is_trap { Verdict::Failed } else { Verdict::Error };
        return result;
    }
    let worst = result.claims.iter().map(|claim| claim.verdict).max().unwrap_or(Verdict::Vacuous);
    let missed: Vec<_> = result.covers.iter().filter(|cover| !cover.hit).map(|cover| cover.name.as_str()).collect();
    if worst == Verdict::Proved && !missed.is_empty() {
        result.reason = Some(format!("cover points that are not reached: {}", missed.join(", ")));
        result.verdict = Verdict::Vacuous;
    } else {
        let which: Vec<_> =
            result.claims.iter().filter(|claim| claim.verdict == worst).map(|claim| claim.name.as_str()).collect();
        // A bound that is too small for Kani takes nothing from what is proved here: it is told beside it.
        let beyond = crate::unwound::beyond(harness, result.unwound);
        result.reason = if worst == Verdict::Proved { beyond } else { Some(format!("claims: {}", which.join(", "))) };
        result.verdict = worst;
    }
    result
}
