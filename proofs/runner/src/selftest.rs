//! The cbmc engine tests itself before it is believed: on each trap (`proofs/traps`) it must say what is known.

use crate::cbmc::Solver;
use crate::options::Options;
use crate::pool::lock;
use crate::tools::Tools;
use crate::traps::{Outcome, Trap, Trial, Way, list, trials};
use std::path::Path;
use std::sync::Mutex;

/// The tools that have passed since this program began, each with the solver.
static PASSED: Mutex<Vec<(Tools, Solver)>> = Mutex::new(Vec::new());

/// Runs the self-test, once for all campaigns of this program with the same tools.
///
/// # Errors
/// The traps that the engine walked into.
pub fn check(tools: &Tools, options: &Options) -> Result<(), String> {
    let asked = (tools.clone(), options.solver);
    if lock(&PASSED).contains(&asked) {
        return Ok(());
    }
    let found = run(tools, options, &options.folder.join("selftest"))?;
    let wrong: Vec<_> = found
        .iter()
        .filter(|trial| trial.outcome != Outcome::Right)
        .map(|trial| format!("`{}` ({:?}): {:?}", trial.trap, trial.way, trial.outcome))
        .collect();
    if !wrong.is_empty() {
        return Err(format!("the cbmc engine fails its self-test: {}", wrong.join("; ")));
    }
    lock(&PASSED).push(asked);
    Ok(())
}

/// Every trial of the self-test. `folder` is where the traps are compiled.
///
/// # Errors
/// As [`trials`].
pub fn run(tools: &Tools, options: &Options, folder: &Path) -> Result<Vec<Trial>, String> {
    let root = crate::root();
    let mut traps = list(&root)?;
    traps.retain(|trap| trap.known_wrong.is_empty());
    let ways = |trap: &Trap| ways(tools, options.solver, trap);
    trials(tools, &root, folder, (&traps, &ways), (options.jobs, options.limit))
}

/// A campaign asks most about most harnesses once. What depends on the way, or on the solver, is tried in all of them.
fn ways(tools: &Tools, solver: Solver, trap: &Trap) -> Vec<Way> {
    match (solver, trap.every_way) {
        (Solver::Auto, false) => vec![Way::Once(Solver::Auto)],
        (Solver::Auto, true) => {
            // Two runs of MiniSat, and of the other solvers that a campaign takes.
            let others = [Solver::Minisat, Solver::Kissat, Solver::Z3].into_iter().filter(|other| other.is_here(tools));
            std::iter::once(Way::Once(Solver::Auto)).chain(others.map(Way::Twice)).collect()
        }
        (solver, _) => vec![Way::Twice(solver)],
    }
}
