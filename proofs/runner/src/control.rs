//! The control of the wrong kernels: the right one, compiled as they are, must pass the harnesses that reject them.
//!
//! A wrong kernel is compiled with the harnesses that are to reject it alone, and some of them are smaller then. Those are judged here
//! at the size at which they reject; the others are the very harnesses of the proofs.

use std::path::Path;
use std::time::Instant;

use atc_proofs::Harness;

use crate::Options;
use crate::campaign::{HARD, in_parallel};
use crate::cbmc::{Answer, FIRST, Question, ask_in_turn};
use crate::compile::{Compiled, STACK, compile};
use crate::report::Control;
use crate::tools::Tools;

/// Judges the right kernel by those of the harnesses that are smaller for wrong kernels.
///
/// # Errors
/// It does not compile.
pub fn controls(
    tools: &Tools,
    root: &Path,
    options: &Options,
    harnesses: &[&'static Harness],
) -> Result<Vec<Control>, String> {
    let mut smaller: Vec<_> = harnesses.iter().copied().filter(|harness| is_smaller(harness)).collect();
    if smaller.is_empty() {
        return Ok(Vec::new());
    }
    smaller.sort_by_key(|harness| HARD.iter().position(|name| *name == harness.name).unwrap_or(HARD.len()));
    let names: Vec<String> = smaller.iter().map(|harness| harness.name.to_owned()).collect();
    let folder = root.join("target").join("proofs").join("control");
    let compiled = compile(tools, root, &folder, options.aspects, &names)?;
    Ok(in_parallel(options.jobs, smaller.len(), |index| {
        let started = Instant::now();
        let reason = judge(tools, &compiled, smaller[index], options).err();
        Control { harness: names[index].clone(), reason, seconds: started.elapsed().as_secs_f64() }
    }))
}

/// Whether the harness is smaller when it is compiled for wrong kernels.
pub fn is_smaller(harness: &Harness) -> bool {
    atc_proofs::interlocking::SMALLER.contains(&harness.bound)
}

fn judge(tools: &Tools, compiled: &Compiled, harness: &Harness, options: &Options) -> Result<(), String> {
    let folder = compiled.to_c(tools, harness.name, STACK)?;
    let first = (!HARD.contains(&harness.name)).then_some(FIRST);
    for case in 0..harness.cases {
        let case = (case, harness.cases);
        let question = Question { case, ..Question::proof(harness.name, options.solver, options.limit) };
        let answer = ask_in_turn(tools, &folder, &question, first);
        passes(harness, &answer.map_err(|silence| silence.of(harness.name))?.0)?;
    }
    Ok(())
}

/// Every claim holds, and nothing else fails.
fn passes(harness: &Harness, answer: &Answer) -> Result<(), String> {
    let broken = (0..harness.claims.len()).find(|number| answer.claim(*number) != Some(true));
    match (broken, answer.other_failure()) {
        (Some(number), _) => {
            Err(format!("{} of {} does not hold of the right kernel", harness.claims[number].name, harness.name))
        }
        (None, Some(failure)) => Err(format!("{failure} in {} with the right kernel", harness.name)),
        (None, None) => Ok(()),
    }
}
