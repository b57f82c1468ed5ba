//! One trap under one engine: what the engine says, held against what is known.

use super::{Trap, native};
use crate::cbmc::{Answer, Question, Silence, Solver, ask_both};
use crate::compile::{Compiled, compile_one, write, write_c};
use crate::loops::one_way_back;
use crate::pool::in_parallel;
use crate::regions::apart;
use crate::tools::Tools;
use std::path::{Path, PathBuf};
use std::time::Duration;

/// Who is asked.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Engine {
    /// CBMC with this solver.
    Cbmc(Solver),
    /// The machine itself: the same C, compiled and run on drawn values. It tests the declaration, too.
    Native,
}

/// How an engine is asked.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Way {
    /// As a campaign asks about most harnesses: first of all everything in one run of MiniSat.
    Once(Solver),
    /// As it asks about those that are hard: what holds, and what can be reached, in two runs.
    Twice(Solver),
    /// As a program.
    Native,
}

impl Way {
    /// The engine that answers.
    pub const fn engine(self) -> Engine {
        match self {
            Self::Once(solver) | Self::Twice(solver) => Engine::Cbmc(solver),
            Self::Native => Engine::Native,
        }
    }
}

/// How each trap is to be asked.
pub type Ways<'a> = dyn Fn(&Trap) -> Vec<Way> + Sync + 'a;

/// How an engine did.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Outcome {
    /// It says what is known.
    Right,
    /// It says something else.
    Wrong(String),
    /// It has no answer where there is one.
    Silent(String),
    /// It was not asked, and why.
    NotRun(String),
}

/// A trap, how the engine was asked, and how it did.
#[derive(Clone, Debug)]
pub struct Trial {
    /// The trap's name.
    pub trap: String,
    /// How the engine was asked.
    pub way: Way,
    /// How it did.
    pub outcome: Outcome,
}

/// Tries the engines on the traps, in the order of the traps. `ways` says how the engines are asked about each.
///
/// # Errors
/// The folder cannot be written. (A trap that an engine walks into is a result.)
pub fn trials(
    tools: &Tools,
    root: &Path,
    folder: &Path,
    (traps, ways): (&[Trap], &Ways),
    (jobs, limit): (usize, Duration),
) -> Result<Vec<Trial>, String> {
    let sources = root.join("proofs/traps");
    let compiled = compile_one(tools, &sources.join("lib.rs"), folder)?;
    let found = in_parallel(jobs, traps.len(), |index| {
        let trap = &traps[index];
        let ready = to_c(tools, trap, &sources, &compiled, folder);
        let trial = |way| {
            let outcome = match &ready {
                Ok(ready) => outcome(tools, trap, ready, way, limit),
                Err(reason) => trap.judge(&Err(Silence::Broken(reason.clone()))),
            };
            Trial { trap: trap.name.clone(), way, outcome }
        };
        ways(trap).into_iter().map(trial).collect::<Vec<_>>()
    });
    Ok(found.into_iter().flatten().collect())
}

/// Bytes of memory of a trap in C: it uses none.
const LITTLE: u32 = 64;

/// The C of a trap, in a folder of its own with the driver.
fn to_c(tools: &Tools, trap: &Trap, sources: &Path, compiled: &Compiled, folder: &Path) -> Result<PathBuf, String> {
    if !trap.is_c() {
        return compiled.to_c(tools, &trap.name, trap.stack);
    }
    let read = |name: &str| {
        let path = sources.join(name);
        std::fs::read_to_string(&path).map_err(|error| format!("{}: {error}", path.display()))
    };
    let (folder, text) = (folder.join(&trap.name), read(&trap.file)?);
    if trap.direct {
        write_c(&folder, "", LITTLE)?;
        write(&folder.join("driver.c"), &(read("direct.h")? + &text))?;
    } else {
        write_c(&folder, &(read("trap.h")? + &apart(&one_way_back(&text)?)?), LITTLE)?;
    }
    Ok(folder)
}

fn outcome(tools: &Tools, trap: &Trap, folder: &Path, way: Way, limit: Duration) -> Outcome {
    let (solver, known) = match way {
        Way::Once(solver) => (solver, None),
        Way::Twice(solver) => (solver, Some(solver)),
        Way::Native => {
            return match &trap.not_native {
                Some(reason) => Outcome::NotRun(reason.clone()),
                None => trap.judge(&native::run(trap, folder, limit)),
            };
        }
    };
    let question = Question::proof(&trap.name, solver, limit);
    let (proof, reach) = ask_both(tools, folder, &question, known);
    let found = proof.and_then(|(proof, _)| Ok((proof, reach?.0)));
    let unwound = found.as_ref().map_or(0, |(proof, _)| proof.unwound);
    match (trap.judge(&found), trap.turns) {
        (Outcome::Right, Some(turns)) if unwound < turns => {
            Outcome::Wrong(format!("a loop of {turns} turns is told to be unwound {unwound} times"))
        }
        (outcome, _) => outcome,
    }
}

impl Trap {
    /// Holds an engine's answers (what holds, what can be reached) against what is known.
    fn judge(&self, found: &Result<(Answer, Answer), Silence>) -> Outcome {
        let (proof, reach) = match (found, &self.silence) {
            (Err(Silence::Broken(reason)), Some(word)) if reason.contains(word) => return Outcome::Right,
            (Err(silence), _) => return Outcome::Silent(format!("{silence:?}")),
            (Ok(_), Some(word)) => return Outcome::Wrong(format!("an answer, where `{word}` was to be said")),
            (Ok(answers), None) => answers,
        };
        let other = proof.other_failure();
        if let Some(failure) = &self.failure {
            return if other.is_some_and(|other| other.starts_with(failure)) {
                Outcome::Right
            } else {
                Outcome::Wrong(format!("`{failure}` is not found to fail ({other:?})"))
            };
        }
        if let Some(other) = other {
            return Outcome::Wrong(format!("`{other}` fails"));
        }
        let numbers = |answer: &dyn Fn(usize) -> bool| (0..8).filter(|number| answer(*number)).collect::<Vec<_>>();
        // The driver has a place for each number; those of no claim, or of one that no path leads to, say nothing.
        let reached = self.reached();
        let holding = numbers(&|number| proof.claim(number) == Some(true) && reached.contains(&number));
        let found = [
            ("holding", holding, self.hold.clone()),
            ("failing", numbers(&|number| proof.claim(number) == Some(false)), self.failing()),
            ("reachable", numbers(&|number| reach.claim(number) == Some(false)), reached.clone()),
            ("hit", numbers(&|number| reach.cover(number) == Some(false)), self.hit.clone()),
        ];
        let wrong: Vec<_> = found
            .iter()
            .filter(|(_, found, known)| found != known)
            .map(|(what, found, known)| format!("{what} {found:?}, not {known:?}"))
            .collect();
        if wrong.is_empty() { Outcome::Right } else { Outcome::Wrong(wrong.join("; ")) }
    }
}
