//! One run of CBMC, and what it says.

use crate::process::{End, Job, Limits, errors_of, run};
use crate::tools::Tools;
use std::collections::BTreeMap;
use std::path::Path;
use std::time::Duration;

/// The options of every run. `--no-standard-checks`: what can go wrong in the wasm2c code is an assertion in the
/// driver, and the C it writes relies on wrapping.
/// Memory up to 16 KB, in words, is followed cell by cell: as a whole it would be an array, which costs far more.
/// The report is text: as JSON it has how every assertion fails, asked for or not, in up to 100 MB.
pub const CBMC: [&str; 10] = [
    "--no-standard-checks",
    // How far each loop is unwound is told from here on.
    "--verbosity",
    "8",
    "--object-bits",
    "14",
    "--unwind",
    crate::unwound::MOST,
    "--slice-formula",
    "--max-field-sensitivity-array-size",
    "4096",
];

/// The options of a proof: a bound that is too small fails. (What rejects a mutant does so within the bound.)
pub const PROOF: &str = "--unwinding-assertions";

/// How long [`Solver::Auto`] waits for the first solver.
pub const FIRST: Duration = Duration::from_secs(45);

/// Which solver.
#[derive(Clone, Copy, Debug, PartialEq, Eq, clap::ValueEnum)]
pub enum Solver {
    /// MiniSat, and where that has no answer in 45 s, Kissat; of some harnesses Z3 first. Each is fast where another is slow.
    Auto,
    /// MiniSat, in CBMC.
    Minisat,
    /// Kissat, as a program of its own.
    Kissat,
    /// Z3, as a program of its own.
    Z3,
}

impl Solver {
    fn options(self, tools: &Tools, ask: Ask) -> Vec<String> {
        // What holds has no counterexample, which is what this way of searching is for: a quarter less time.
        let way = if matches!(ask, Ask::Proof | Ask::Control) { "--unsat" } else { "--default" };
        match self {
            Self::Auto | Self::Minisat => vec!["--sat-solver".to_owned(), "minisat2".to_owned()],
            Self::Kissat => {
                vec!["--external-sat-solver".to_owned(), tools.guarded("kissat", way).display().to_string()]
            }
            Self::Z3 => vec!["--smt2".to_owned(), "--z3".to_owned()],
        }
    }

    /// CBMC calls Z3 by its name: it must find the one that was installed, wherever it was.
    fn path(self, tools: &Tools) -> Option<(&'static str, String)> {
        if self != Self::Z3 {
            return None;
        }
        let own = tools.guarded("z3", "").parent()?.display().to_string();
        let others = std::env::var("PATH").unwrap_or_default();
        Some(("PATH", format!("{own}:{others}")))
    }

    /// The one for what the first solver is known to have no answer to in its time.
    #[must_use]
    pub fn at_once(self, tools: &Tools) -> Self {
        if self == Self::Auto && Self::Kissat.is_here(tools) { Self::Kissat } else { self }
    }

    /// Whether it was installed. MiniSat is a part of CBMC.
    pub(crate) fn is_here(self, tools: &Tools) -> bool {
        !matches!(self, Self::Kissat | Self::Z3) || tools.versions.contains_key(self.name())
    }

    /// Its name.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Auto => "minisat2, kissat or z3",
            Self::Minisat => "minisat2",
            Self::Kissat => "kissat",
            Self::Z3 => "z3",
        }
    }
}

/// What to ask.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Ask {
    /// What holds.
    Proof,
    /// Which claims and cover points can be reached.
    Reach,
    /// Both in one run.
    Both,
    /// Which of the mutants that `mutants.h` lists fail a claim.
    Mutants,
    /// Which of them fail a claim or panic.
    Panics,
    /// What holds with none of them selected: mutant 0, which is all that `mutants.h` lists then.
    Control,
}

/// What to ask in one run.
#[derive(Clone, Copy, Debug)]
pub struct Question<'a> {
    /// The exported function.
    pub harness: &'a str,
    /// The case, of how many.
    pub case: (usize, usize),
    /// What of it.
    pub ask: Ask,
    /// Which solver.
    pub solver: Solver,
    /// CPU time, for each run.
    pub limit: Duration,
    /// The only mutant that `mutants.h` lists.
    pub only: Option<usize>,
}

impl<'a> Question<'a> {
    /// Does every claim of `harness` hold?
    pub fn proof(harness: &'a str, solver: Solver, limit: Duration) -> Self {
        Self { harness, case: (0, 1), ask: Ask::Proof, solver, limit, only: None }
    }
}

/// What CBMC says of every assertion in the driver, by its description.
#[derive(Clone, Debug, Default)]
pub struct Answer {
    /// Description → whether it holds.
    pub holds: BTreeMap<String, bool>,
    /// Description of a failed assertion → the arbitrary values that make it fail, in order.
    pub values: BTreeMap<String, Vec<u16>>,
    /// The most iterations of a loop.
    pub unwound: usize,
    /// Who gave it.
    pub solver: Option<Solver>,
}

impl Answer {
    /// Whether the assertion of this description holds; `None` if there is no such assertion.
    pub fn claim(&self, number: usize) -> Option<bool> {
        self.holds.get(&format!("claim {number}")).copied()
    }

    /// The same for a cover point.
    pub fn cover(&self, number: usize) -> Option<bool> {
        self.holds.get(&format!("cover {number}")).copied()
    }

    /// The same for a mutant: whether the claims hold if it is selected.
    pub fn mutant(&self, number: usize) -> Option<bool> {
        self.holds.get(&format!("mutant {number}")).copied()
    }

    /// The answer to [`Ask::Both`] as those to the proof and to what can be reached.
    fn apart(self) -> (Self, Self) {
        let (mut proof, mut reach) = (
            Self { unwound: self.unwound, solver: self.solver, ..Self::default() },
            Self { solver: self.solver, ..Self::default() },
        );
        for (description, holds) in self.holds {
            if let Some(number) = description.strip_prefix("reach ") {
                reach.holds.insert(format!("claim {number}"), holds);
            } else if description.starts_with("cover ") {
                reach.holds.insert(description, holds);
            } else {
                proof.holds.insert(description, holds);
            }
        }
        proof.values =
            self.values.into_iter().filter(|(description, _)| proof.holds.contains_key(description)).collect();
        (proof, reach)
    }

    /// The first failed assertion that is neither a claim nor a cover point: a trap or a bound that is too small.
    pub fn other_failure(&self) -> Option<&str> {
        let mut failures = self.holds.iter().filter(|(_, holds)| !**holds).map(|(description, _)| description.as_str());
        failures.find(|description| !["claim ", "cover ", "mutant "].iter().any(|kind| description.starts_with(kind)))
    }
}

/// Why there is no answer.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Silence {
    /// The time limit.
    Late,
    /// Anything else: killed, out of memory, not understood, a function without a body.
    Broken(String),
}

impl Silence {
    /// It in words, of this harness.
    pub fn of(self, harness: &str) -> String {
        match self {
            Self::Late => format!("{harness}: no answer in time"),
            Self::Broken(reason) => format!("{harness}: {reason}"),
        }
    }
}

/// What holds in one case of a harness, and what can be reached; each with the time that it took.
pub type Halves = (Result<(Answer, Duration), Silence>, Result<(Answer, Duration), Silence>);

/// Asks CBMC both what holds and what can be reached: in one run if that has an answer in time, and otherwise one after the other.
/// Of a harness that is known to be hard, one after the other at once, and what holds of the solver that is `known` to find it.
pub fn ask_both(tools: &Tools, folder: &Path, question: &Question, known: Option<Solver>) -> Halves {
    let mut waited = Duration::ZERO;
    if question.solver == Solver::Auto && known.is_none() {
        let limit = question.limit.min(FIRST);
        let both = Question { ask: Ask::Both, solver: Solver::Minisat, limit, ..*question };
        if let Ok((answer, took)) = ask(tools, folder, &both) {
            let (proof, reach) = answer.apart();
            return (Ok((proof, took)), Ok((reach, Duration::ZERO)));
        }
        waited = limit;
    }
    let proof = ask_knowing(tools, folder, question, known);
    // An incremental solver finds the many reachable points fastest.
    let reach = ask(tools, folder, &Question { ask: Ask::Reach, solver: Solver::Minisat, ..*question });
    (proof.map(|(answer, took)| (answer, took + waited)), reach)
}

/// Asks CBMC what holds, of a harness of which another solver than Kissat may be known to find it in a short time. That one may be missing,
/// or have no answer this time: then Kissat.
fn ask_knowing(
    tools: &Tools,
    folder: &Path,
    question: &Question,
    known: Option<Solver>,
) -> Result<(Answer, Duration), Silence> {
    let last = question.solver.at_once(tools);
    if let Some(solver) =
        known.filter(|known| question.solver == Solver::Auto && known.is_here(tools) && *known != last)
    {
        let limit = question.limit.min(FIRST);
        match ask(tools, folder, &Question { solver, limit, ..*question }) {
            Err(Silence::Late) => {}
            answer => return answer,
        }
    }
    ask(tools, folder, &Question { solver: last, ..*question })
}

/// Asks CBMC what holds: of MiniSat within `first`, and of Kissat if that has no answer by then; of Kissat at once without `first`. A
/// solver that is named is asked alone.
///
/// # Errors
/// As [`ask`].
pub fn ask_in_turn(
    tools: &Tools,
    folder: &Path,
    question: &Question,
    first: Option<Duration>,
) -> Result<(Answer, Duration), Silence> {
    if let Some(first) = first.filter(|_| question.solver == Solver::Auto) {
        let quick = Question { solver: Solver::Minisat, limit: question.limit.min(first), ..*question };
        match ask(tools, folder, &quick) {
            Err(Silence::Late) => {}
            answer => return answer,
        }
    }
    ask(tools, folder, &Question { solver: question.solver.at_once(tools), ..*question })
}

/// What the C of a harness is compiled with, for CBMC and natively.
pub fn defines(question: &Question) -> Vec<String> {
    let (case, cases) = question.case;
    vec![
        format!("-DHARNESS={}", question.harness),
        format!("-DCASE={case}"),
        format!("-DCASES={cases}"),
        "-DWASM_RT_USE_MMAP=0".to_owned(),
        "-DWASM_RT_NONCONFORMING_UNCHECKED_STACK_EXHAUSTION=1".to_owned(),
    ]
}

/// Asks CBMC once; [`Solver::Auto`] is MiniSat here. `folder` is what [`Compiled::to_c`] made.
///
/// # Errors
/// No answer, and why. Only an answer that is complete is one.
pub fn ask(tools: &Tools, folder: &Path, question: &Question) -> Result<(Answer, Duration), Silence> {
    let proves = matches!(question.ask, Ask::Proof | Ask::Both);
    // Writing down how each assertion fails takes longer than finding it out: only for what should not.
    let rejects = matches!(question.ask, Ask::Mutants | Ask::Panics);
    let (answer, took) = ask_for(tools, folder, question, rejects)?;
    let wrong = |(description, holds): (&String, &bool)| !holds && !description.starts_with("reach ");
    let fails = answer.holds.iter().filter(|(description, _)| !description.starts_with("cover ")).any(wrong);
    if !proves || !fails {
        return Ok((answer, took));
    }
    let (traced, again) = ask_for(tools, folder, &Question { ask: Ask::Proof, ..*question }, true)?;
    Ok((Answer { values: traced.values, ..answer }, took + again))
}

/// Asks CBMC once, with or without the values that make assertions fail.
fn ask_for(tools: &Tools, folder: &Path, question: &Question, values: bool) -> Result<(Answer, Duration), Silence> {
    let case = question.case.0;
    let mut arguments: Vec<String> = vec![folder.join("driver.c").display().to_string()];
    arguments.extend(defines(question));
    arguments.extend([
        "-I".to_owned(),
        folder.display().to_string(),
        "-I".to_owned(),
        tools.include.display().to_string(),
    ]);
    let (more, name): (&[&str], _) = match question.ask {
        Ask::Proof => (&[PROOF], ""),
        Ask::Reach => (&[PROOF, "-DREACH"], "-reach"),
        Ask::Both => (&[PROOF, "-DBOTH"], "-both"),
        Ask::Mutants => (&["--no-unwinding-assertions", "-DMUTANTS"], "-mutants"),
        Ask::Panics => (&["--no-unwinding-assertions", "-DMUTANTS", "-DTRAPS"], "-panics"),
        Ask::Control => (&[PROOF, "-DMUTANTS", "-DTRAPS", "-DCONTROL"], "-control"),
    };
    arguments.extend(more.iter().chain(&CBMC).map(ToString::to_string));
    arguments.extend(question.only.map(|number| format!("-DONLY={number}")));
    arguments.extend(values.then(|| "--trace".to_owned()));
    arguments.extend(question.solver.options(tools, question.ask));
    let output = folder.join(format!("cbmc-{case}{name}.txt"));
    let limits = Limits { cpu: question.limit, memory_kib: 8 << 20 };
    let program = tools.path("cbmc");
    // CBMC puts the problem of an external solver into a file.
    let temporary = ("TMPDIR", folder.display().to_string());
    let variables: Vec<_> = question.solver.path(tools).into_iter().chain([temporary]).collect();
    let job = Job { program: &program, arguments: &arguments, variables: &variables, folder, output: &output, limits };
    let (end, took) = run(&job).map_err(Silence::Broken)?;
    match end {
        End::Late => return Err(Silence::Late),
        End::Killed => return Err(Silence::Broken("cbmc was killed (out of memory?)".to_owned())),
        // 0: all hold; 10: some fail.
        End::Code(0 | 10) => {}
        End::Code(code) => {
            return Err(Silence::Broken(format!("cbmc ended with code {code}; see {}", output.display())));
        }
    }
    // Its warnings are among the errors.
    let read = |path: &Path| std::fs::read_to_string(path).map_err(|error| Silence::Broken(error.to_string()));
    let text = read(&errors_of(&output))? + &read(&output)?;
    let answer = parse(&text).map_err(Silence::Broken)?;
    let all_hold = answer.holds.values().all(|holds| *holds);
    if all_hold == (end == End::Code(0)) {
        let solver = if question.solver == Solver::Auto { Solver::Minisat } else { question.solver };
        Ok((Answer { solver: Some(solver), ..answer }, took))
    } else {
        Err(Silence::Broken("cbmc's exit code and its results disagree".to_owned()))
    }
}

/// Reads CBMC's report. An unfinished text, a warning about a missing body or an unknown status is an error.
///
/// # Errors
/// What is wrong with the text.
pub fn parse(text: &str) -> Result<Answer, String> {
    if let Some(warning) = text.lines().find(|line| line.contains("no body for")) {
        return Err(format!("cbmc does not see all the code: {warning}"));
    }
    if !text.lines().any(|line| matches!(line, "VERIFICATION SUCCESSFUL" | "VERIFICATION FAILED")) {
        return Err(format!("cbmc gave no status: {}", text.lines().next_back().unwrap_or_default()));
    }
    let mut answer = Answer { unwound: crate::unwound::largest(text.lines()), ..Answer::default() };
    let mut names = BTreeMap::new();
    let mut failed = 0;
    for (name, description, status) in text.lines().filter_map(property) {
        let holds = match status {
            "SUCCESS" => true,
            "FAILURE" => false,
            other => return Err(format!("cbmc says {other:?} of `{description}`")),
        };
        failed += usize::from(!holds);
        names.insert(name, description);
        // The same description at several places: it holds if it holds at all of them.
        let known = answer.holds.entry(description.to_owned()).or_insert(true);
        *known = *known && holds;
    }
    if names.is_empty() {
        return Err("cbmc checked nothing".to_owned());
    }
    let tally = format!("** {failed} of {} failed", names.len());
    if !text.lines().any(|line| line.starts_with(&tally)) {
        return Err(format!("cbmc's results are not those that it has counted; they are `{tally}`"));
    }
    for trace in text.split("\nTrace for ").skip(1) {
        let name = trace.lines().next().and_then(|line| line.strip_suffix(':'));
        let description = name.and_then(|name| names.get(name)).ok_or("cbmc's trace is of no property")?;
        answer.values.entry((*description).to_owned()).or_insert_with(|| drawn(trace));
    }
    Ok(answer)
}

/// Name, description and status of a property, if the line is one: `[name] line 7 description: STATUS`.
fn property(line: &str) -> Option<(&str, &str, &str)> {
    let (name, rest) = line.strip_prefix('[')?.split_once("] ")?;
    let (description, status) = rest.rsplit_once(": ")?;
    let place = description.strip_prefix("line ").and_then(|rest| rest.split_once(' '));
    let placed = place.filter(|(number, _)| number.parse::<usize>().is_ok());
    Some((name, placed.map_or(description, |(_, description)| description), status))
}

/// The arbitrary values of a trace, in order. One that is not in it may be any: 0.
fn drawn(trace: &str) -> Vec<u16> {
    let number = |line: &str| line.strip_prefix("  drawn=")?.split_once('u')?.0.parse::<u32>().ok();
    let mut values = Vec::new();
    for word in trace.lines().filter_map(number) {
        let (value, place) = (word & 0xFFFF, (word >> 16) as usize);
        // Number 0 is what it was before anything was drawn.
        if let (Some(place), Ok(value)) = (place.checked_sub(1), u16::try_from(value)) {
            values.resize(values.len().max(place + 1), 0);
            values[place] = value;
        }
    }
    values
}
