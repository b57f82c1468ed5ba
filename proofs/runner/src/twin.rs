//! The C of a harness, run on this machine: on values that are given, and no others.
//!
//! Two things are held against what CBMC is given and what it says. The C that is rewritten for CBMC must do the same as what wasm2c wrote,
//! on the same values (`twins.rs`). And a counterexample that is said to reject a mutant must do so when it is run, and must not without the mutant.

use crate::cbmc::{Question, defines};
use crate::process::{End, Job, Limits, errors_of, run};
use crate::tools::Tools;
use std::fmt::Write;
use std::path::{Path, PathBuf};
use std::time::Duration;

const LIMITS: Limits = Limits { cpu: Duration::from_mins(2), memory_kib: 4 << 20 };

/// One run.
#[derive(Clone, Debug)]
pub struct Tape {
    /// The number of a mutant; 0: none.
    pub mutant: usize,
    /// The case.
    pub case: usize,
    /// The arbitrary values, in order.
    pub values: Vec<u16>,
}

/// The harness of `question` as a program, with `source` as its C and `more` options of the compiler.
///
/// # Errors
/// What the compiler said.
pub fn build(
    tools: &Tools,
    folder: &Path,
    question: &Question,
    source: &str,
    more: &[&str],
) -> Result<PathBuf, String> {
    let program = folder.join(format!("{source}.run"));
    let mut arguments: Vec<String> = ["-O0", "-w", "-DNATIVE"].iter().chain(more).map(ToString::to_string).collect();
    arguments.extend(defines(question));
    arguments.push(format!("-DHARNESS_C=\"{source}\""));
    for include in [folder, &tools.include] {
        arguments.extend(["-I".to_owned(), include.display().to_string()]);
    }
    arguments.extend(["-o".to_owned(), program.display().to_string(), "driver.c".to_owned(), "-lm".to_owned()]);
    let output = folder.join("gcc.out");
    let job = Job {
        program: Path::new("gcc"),
        arguments: &arguments,
        variables: &[],
        folder,
        output: &output,
        limits: LIMITS,
    };
    match run(&job)?.0 {
        End::Code(0) => Ok(program),
        end => {
            let said = std::fs::read_to_string(errors_of(&output)).unwrap_or_default();
            Err(format!("gcc: {end:?}: {}", said.lines().take(4).collect::<Vec<_>>().join(" / ")))
        }
    }
}

/// What happens in each of the runs, line by line.
///
/// # Errors
/// The program does not end as it should.
pub fn happens(program: &Path, tapes: &[Tape]) -> Result<Vec<Vec<String>>, String> {
    happens_with(program, &[], program, tapes)
}

/// The same of a program that has arguments; what it reads and prints is in files beside `files`.
///
/// # Errors
/// The program does not end as it should.
pub fn happens_with(
    program: &Path,
    arguments: &[String],
    files: &Path,
    tapes: &[Tape],
) -> Result<Vec<Vec<String>>, String> {
    let mut input = String::new();
    for tape in tapes {
        let _ = write!(input, "{} {}", tape.mutant, tape.case);
        for value in &tape.values {
            let _ = write!(input, " {value}");
        }
        input.push('\n');
    }
    let (folder, beside) = (program.parent().unwrap_or(program), |ending: &str| format!("{}{ending}", files.display()));
    let (tape, output) = (PathBuf::from(beside(".in")), PathBuf::from(beside(".out")));
    crate::compile::write(&tape, &input)?;
    let script = "tape=$1; shift; exec \"$0\" \"$@\" <\"$tape\"";
    let arguments: Vec<String> = ["-c", script, &program.display().to_string(), &tape.display().to_string()]
        .map(ToOwned::to_owned)
        .into_iter()
        .chain(arguments.iter().cloned())
        .collect();
    let shell = Path::new("sh");
    let job = Job { program: shell, arguments: &arguments, variables: &[], folder, output: &output, limits: LIMITS };
    let (end, _) = run(&job)?;
    if end != End::Code(0) {
        return Err(format!("{}: {end:?}", program.display()));
    }
    let text = std::fs::read_to_string(&output).map_err(|error| format!("{}: {error}", output.display()))?;
    let mut runs: Vec<Vec<String>> = Vec::new();
    for line in text.lines() {
        if line.starts_with("run ") {
            runs.push(Vec::new());
        }
        match runs.last_mut() {
            Some(run) => run.push(line.to_owned()),
            None => return Err(format!("{}: `{line}` before any run", program.display())),
        }
    }
    if runs.len() == tapes.len() {
        Ok(runs)
    } else {
        Err(format!("{}: {} runs of {}", program.display(), runs.len(), tapes.len()))
    }
}

/// The numbers of the claims that fail in a run.
pub fn failed(run: &[String]) -> Vec<usize> {
    let number = |line: &String| line.strip_prefix("claim ")?.strip_suffix(" 0")?.parse().ok();
    run.iter().filter_map(number).collect()
}

/// Whether a run ends in a panic.
pub fn panics(run: &[String]) -> bool {
    run.iter().any(|line| line == "trap: panic 0")
}
