//! The cbmc engine tests itself before it is believed: for each trap on the way from Rust to CBMC, a harness whose
//! verdict is known, true and false ones (`proofs/cbmc/selftest.rs`).

use crate::campaign::{Options, in_parallel};
use crate::cbmc::{Answer, Question, Silence, Solver, ask_both};
use crate::compile::{STACK, compile_one, write_c};
use crate::loops::one_way_back;
use crate::tools::Tools;
use std::path::Path;

/// What is expected of one harness of the self-test.
enum Expected {
    /// The claims that hold, the claims that fail, the reachable claims, the cover points that are hit.
    Verdicts(&'static [usize], &'static [usize], &'static [usize], &'static [usize]),
    /// An assertion of this description fails.
    Failure(&'static str),
    /// No answer, with this word in the reason.
    Silence(&'static str),
}

/// Harness, bytes of stack, expected verdict, what the trap is.
const CASES: [(&str, u32, Expected, &str); 9] = [
    ("cells", STACK, Expected::Verdicts(&[0], &[1], &[0, 1], &[0]), "loads and stores of linear memory"),
    (
        "unaligned",
        STACK,
        Expected::Verdicts(&[0, 2, 3], &[1], &[0, 1, 2, 3], &[0]),
        "wide accesses at addresses of any kind",
    ),
    ("constants", STACK, Expected::Verdicts(&[0], &[1], &[0, 1], &[0]), "constant tables in data segments"),
    ("stack", 1024, Expected::Failure("trap: out of bounds"), "a stack that is too small"),
    ("verdicts", STACK, Expected::Verdicts(&[0, 2, 3], &[1], &[0, 1], &[0]), "a verdict for each claim, and vacuity"),
    ("missing", STACK, Expected::Silence("no body"), "a function without a body"),
    ("unwinding", STACK, Expected::Failure("unwinding assertion"), "an unwinding bound that is too small"),
    ("overflow", STACK, Expected::Failure("trap: panic"), "an arithmetic overflow"),
    ("bounds", STACK, Expected::Failure("trap: panic"), "an index out of bounds"),
];

/// Runs the self-test.
///
/// # Errors
/// The first trap that the engine walked into.
pub fn check(tools: &Tools, options: &Options) -> Result<(), String> {
    let root = crate::root();
    let folder = root.join("target").join("proofs").join("selftest");
    let compiled = compile_one(tools, &root.join("proofs/cbmc/selftest.rs"), &folder)?;
    let failures = in_parallel(options.jobs, CASES.len(), |index| {
        let (name, stack, expected, trap) = &CASES[index];
        let found = compiled.to_c(tools, name, *stack).map_err(Silence::Broken).map_or_else(
            |silence| match_up(expected, &Err(silence)),
            |folder| both_ways(tools, &folder, (name, *stack), expected, options),
        );
        found.map_err(|reason| format!("the cbmc engine's self-test `{name}` ({trap}): {reason}"))
    });
    failures.into_iter().collect::<Result<(), String>>()?;
    loops(tools, &folder, options)
}

/// C by hand, since the compiler cannot be made to write this loop.
fn loops(tools: &Tools, folder: &Path, options: &Options) -> Result<(), String> {
    let folder = folder.join("loops");
    write_c(&folder, &one_way_back(include_str!("../../cbmc/loops.c"))?)?;
    let expected = Expected::Verdicts(&[0, 2], &[1], &[0, 1, 2], &[0]);
    both_ways(tools, &folder, ("loops", STACK), &expected, options)
        .map_err(|reason| format!("the cbmc engine's self-test `loops` (a path put aside at a jump back): {reason}"))
}

/// Asks in one run and in two: the verdicts must be those that are expected either way.
fn both_ways(
    tools: &Tools,
    folder: &Path,
    (name, stack): (&str, u32),
    expected: &Expected,
    options: &Options,
) -> Result<(), String> {
    for hard in [false, true] {
        // Kissat would take minutes for what MiniSat does at once.
        let solver = if hard && options.solver == Solver::Auto { Solver::Minisat } else { options.solver };
        let question = Question { stack, ..Question::proof(name, solver, options.limit) };
        let (proof, reach) = ask_both(tools, folder, &question, hard);
        let found = proof.and_then(|(proof, _)| Ok((proof, reach?.0)));
        match_up(expected, &found)
            .map_err(|reason| format!("{reason} (in {})", if hard { "two runs" } else { "one run" }))?;
    }
    Ok(())
}

fn match_up(expected: &Expected, found: &Result<(Answer, Answer), Silence>) -> Result<(), String> {
    match (expected, found) {
        (Expected::Silence(word), Err(Silence::Broken(reason))) if reason.contains(word) => Ok(()),
        (Expected::Failure(description), Ok((proof, _)))
            if proof.other_failure().is_some_and(|failure| failure.starts_with(description)) =>
        {
            Ok(())
        }
        (Expected::Verdicts(hold, fail, reachable, hit), Ok((proof, reach))) => {
            let numbers = |answer: &dyn Fn(usize) -> bool| (0..8).filter(|number| answer(*number)).collect::<Vec<_>>();
            // A claim that no path leads to may be gone altogether.
            let holding = numbers(&|number| proof.claim(number) != Some(false) && hold.contains(&number));
            let failing = numbers(&|number| proof.claim(number) == Some(false));
            let reached = numbers(&|number| reach.claim(number) == Some(false));
            let covered = numbers(&|number| reach.cover(number) == Some(false));
            let found = [holding, failing, reached, covered];
            let wanted = [*hold, *fail, *reachable, *hit];
            if found.iter().zip(wanted).all(|(found, wanted)| found == wanted) && proof.other_failure().is_none() {
                Ok(())
            } else {
                Err(format!("holding, failing, reachable, hit: expected {wanted:?}, found {found:?}"))
            }
        }
        (_, found) => Err(format!("found {found:?}")),
    }
}
