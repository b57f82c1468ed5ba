//! What is proved against what was written: each harness is run three ways on the same values.
//!
//! As a Rust program; as the C that wasm2c wrote; and as the C that was rewritten for CBMC. Each must make the same claims with the same
//! result, reach the same cover points, and give up at an assumption, or not, alike. It tests the compiler for WebAssembly, wasm2c and our
//! rewriting on each harness, and no prover has a part in it.

use crate::cbmc::Question;
use crate::compile::{Compiled, Kernel, compile};
use crate::native::{Run, drawn};
use crate::options::Options;
use crate::pool::in_parallel;
use crate::process::only_run;
use crate::root;
use crate::tools::Tools;
use crate::twin::{Tape, build, happens};
use atc_proofs::Harness;
use std::path::Path;

/// The C before it is rewritten, and behind it.
const SOURCES: [&str; 2] = ["original.c", "harness.c"];

/// How one harness did.
#[derive(Clone, Debug)]
pub struct Twins {
    /// The harness.
    pub name: &'static str,
    /// The runs that were compared, and how many of them no assumption ended; or the first difference, or why nothing was compared.
    pub outcome: Result<(usize, usize), String>,
}

/// Compares the three ways on `runs` drawn inputs of each harness. `progress` hears of each as it comes.
///
/// # Errors
/// The provers' tools are not there, or the harnesses do not compile.
pub fn twins(
    options: &Options,
    harnesses: &[&'static Harness],
    runs: usize,
    progress: &(dyn Fn(&Twins) + Sync),
) -> Result<Vec<Twins>, String> {
    let (root, tools) = (root(), Tools::find(&root())?);
    let folder = root.join("target").join("proofs").join("twins");
    let _lock = only_run(&folder)?;
    let names: Vec<String> = harnesses.iter().map(|harness| harness.name.to_owned()).collect();
    let compiled = compile(&tools, &root, &folder.join("kernel"), atc_proofs::ASPECTS, &names, Kernel::AsItIs)?;
    Ok(in_parallel(options.jobs, harnesses.len(), |index| {
        let harness = harnesses[index];
        let twins = Twins { name: harness.name, outcome: of(&tools, &compiled, harness, runs) };
        progress(&twins);
        twins
    }))
}

fn of(tools: &Tools, compiled: &Compiled, harness: &Harness, runs: usize) -> Result<(usize, usize), String> {
    let folder = compiled.to_c(tools, harness.name, None)?;
    compare(tools, &folder, harness, &drawn(harness, runs))
}

/// Runs the C in the folder on these values, and holds what happens against the runs in Rust.
fn compare(tools: &Tools, folder: &Path, harness: &Harness, runs: &[Run]) -> Result<(usize, usize), String> {
    let tapes: Vec<Tape> = runs.iter().map(tape).collect();
    let question = Question::proof(harness.name, crate::Solver::Auto, std::time::Duration::from_mins(1));
    for source in SOURCES {
        let program = build(tools, folder, &question, source, &[])?;
        for (run, said) in runs.iter().zip(happens(&program, &tapes)?) {
            let (expected, found) = (expected(run), meant(&said));
            if expected != found {
                let values: Vec<u16> = run.drawn.iter().map(|(_, value)| *value).collect();
                return Err(format!("{source} does {found:?}, and not {expected:?}, on {values:?}"));
            }
        }
    }
    Ok((runs.len(), runs.iter().filter(|run| run.accepted).count()))
}

/// The values of a run as a prover has them: the case apart.
fn tape(run: &Run) -> Tape {
    let case = run.picked.map_or(0, |place| usize::from(run.drawn[place].1));
    let others = run.drawn.iter().enumerate().filter(|(place, _)| Some(*place) != run.picked);
    Tape { mutant: 0, case, values: others.map(|(_, (_, value))| *value).collect() }
}

/// What must happen. Behind an assumption that does not hold nothing does; of what is before it only C says which is which.
fn expected(run: &Run) -> Vec<String> {
    if !run.accepted {
        return vec!["assumed away".to_owned()];
    }
    let mut claims: Vec<String> =
        run.claims.iter().map(|(number, holds)| format!("claim {number} {}", u8::from(*holds))).collect();
    claims.extend(run.covered.iter().map(|number| format!("cover {number}")));
    claims.push("end".to_owned());
    claims
}

/// What happened, in the same words: claims, then the cover points that were reached.
fn meant(said: &[String]) -> Vec<String> {
    if said.last().is_some_and(|last| last == "assumed away") && !said.iter().any(|line| line.starts_with("trap")) {
        return vec!["assumed away".to_owned()];
    }
    let covers = said.iter().filter_map(|line| line.strip_prefix("cover ")?.strip_suffix(" 1"));
    let (end, others): (Vec<_>, Vec<_>) =
        said.iter().skip(1).filter(|line| !line.starts_with("cover ")).cloned().partition(|line| line == "end");
    [others, covers.map(|number| format!("cover {number}")).collect(), end].concat()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Loops, jumps out of nested places, tables and a case: small enough for a test.
    const SAMPLE: [&str; 4] = ["t_acc_1", "t_code_2_wrong", "t_trk_1", "t_ilk_2"];

    #[test]
    fn what_is_proved_does_what_was_written_and_a_wrong_rewriting_is_seen() {
        let Ok(tools) = Tools::find(&root()) else {
            println!("not run: the provers are not installed (ci/install-provers)");
            return;
        };
        let harnesses = crate::select(&SAMPLE.map(ToOwned::to_owned)).unwrap();
        for twins in twins(&Options::default(), &harnesses, 4096, &|_| ()).unwrap() {
            let (runs, accepted) = twins.outcome.unwrap();
            assert!(runs >= 4096 && accepted > 0, "{}: {accepted} of {runs} runs say something", twins.name);
        }
        // A jump that is forgotten, in each of the two texts.
        let harness = harnesses[1];
        let folder = root().join("target/proofs/twins/kernel").join(harness.name);
        for source in SOURCES {
            let path = folder.join(source);
            let right = std::fs::read_to_string(&path).unwrap();
            let wrong = right.replace(") {goto ", " && 0) {goto ");
            assert_ne!(right, wrong, "{source} has no such jump");
            crate::compile::write(&path, &wrong).unwrap();
            let said = compare(&tools, &folder, harness, &drawn(harness, 4096));
            assert!(said.as_ref().is_err_and(|said| said.contains(source)), "{source}: {said:?}");
            crate::compile::write(&path, &right).unwrap();
        }
    }
}
