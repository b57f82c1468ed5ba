//! One run of CBMC, and what it says.

use crate::compile::STACK;
use crate::process::{End, Job, Limits, run};
use crate::tools::Tools;
use serde_json::Value;
use std::collections::BTreeMap;
use std::path::Path;
use std::time::Duration;

/// The options of every run. `--no-standard-checks`: what can go wrong in the wasm2c code is an assertion in the
/// driver, and the C it writes relies on wrapping. Unwinding assertions stay on: a bound that is too small fails.
/// Memory up to 16 KB, in words, is followed cell by cell: as a whole it would be an array, which costs far more.
pub const CBMC: [&str; 11] = [
    "--no-standard-checks",
    "--object-bits",
    "14",
    "--unwind",
    "66",
    "--unwinding-assertions",
    "--slice-formula",
    "--max-field-sensitivity-array-size",
    "4096",
    "--json-ui",
    "--trace",
];

/// How long [`Solver::Auto`] waits for the first solver.
pub const FIRST: Duration = Duration::from_secs(20);

/// Bytes of constant data that a harness may have.
const DATA: u32 = 768;

/// Which solver.
#[derive(Clone, Copy, Debug, PartialEq, Eq, clap::ValueEnum)]
pub enum Solver {
    /// MiniSat, and where that has no answer in 20 s, Kissat: each is fast where the other is slow.
    Auto,
    /// MiniSat, in CBMC.
    Minisat,
    /// Kissat, as a program of its own.
    Kissat,
    /// Z3, as a program of its own.
    Z3,
}

impl Solver {
    fn options(self, tools: &Tools) -> Vec<String> {
        match self {
            Self::Auto | Self::Minisat => vec!["--sat-solver".to_owned(), "minisat2".to_owned()],
            Self::Kissat => vec!["--external-sat-solver".to_owned(), tools.path("kissat").display().to_string()],
            Self::Z3 => vec!["--smt2".to_owned(), "--z3".to_owned()],
        }
    }

    /// CBMC calls Z3 by its name: it must find the one that was installed, wherever it was.
    fn path(self, tools: &Tools) -> Option<(&'static str, String)> {
        let own = tools.path("z3").parent()?.display().to_string();
        let others = std::env::var("PATH").unwrap_or_default();
        (self == Self::Z3).then(|| ("PATH", format!("{own}:{others}")))
    }

    /// The one for what the first solver is known to have no answer to in its time.
    #[must_use]
    pub fn at_once(self, tools: &Tools) -> Self {
        if self == Self::Auto && tools.versions.contains_key("kissat") { Self::Kissat } else { self }
    }

    /// Its name.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Auto => "minisat2 or kissat",
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
    /// Bytes of the stack.
    pub stack: u32,
    /// Which solver.
    pub solver: Solver,
    /// Wall time, for each run.
    pub limit: Duration,
}

impl<'a> Question<'a> {
    /// Does every claim of `harness` hold?
    pub fn proof(harness: &'a str, solver: Solver, limit: Duration) -> Self {
        Self { harness, case: (0, 1), ask: Ask::Proof, stack: STACK, solver, limit }
    }
}

/// What CBMC says of every assertion in the driver, by its description.
#[derive(Clone, Debug, Default)]
pub struct Answer {
    /// Description → whether it holds.
    pub holds: BTreeMap<String, bool>,
    /// Description of a failed assertion → the arbitrary values that make it fail, in order.
    pub values: BTreeMap<String, Vec<u16>>,
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

    /// The answer to [`Ask::Both`] as those to the proof and to what can be reached.
    fn apart(self) -> (Self, Self) {
        let (mut proof, mut reach) = (Self::default(), Self::default());
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
        failures.find(|description| !description.starts_with("claim ") && !description.starts_with("cover "))
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
/// Of a harness that is known to be `hard`, one after the other at once.
pub fn ask_both(tools: &Tools, folder: &Path, question: &Question, hard: bool) -> Halves {
    let mut waited = Duration::ZERO;
    if question.solver == Solver::Auto && !hard {
        let limit = question.limit.min(FIRST);
        let both = Question { ask: Ask::Both, solver: Solver::Minisat, limit, ..*question };
        if let Ok((answer, took)) = ask(tools, folder, &both) {
            let (proof, reach) = answer.apart();
            return (Ok((proof, took)), Ok((reach, Duration::ZERO)));
        }
        waited = limit;
    }
    let proof = ask(tools, folder, &Question { solver: question.solver.at_once(tools), ..*question });
    // An incremental solver finds the many reachable points fastest.
    let reach = ask(tools, folder, &Question { ask: Ask::Reach, solver: Solver::Minisat, ..*question });
    (proof.map(|(answer, took)| (answer, took + waited)), reach)
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

/// Asks CBMC once; [`Solver::Auto`] is MiniSat here. `folder` is what [`Compiled::to_c`] made.
///
/// # Errors
/// No answer, and why. Only an answer that is complete is one.
pub fn ask(tools: &Tools, folder: &Path, question: &Question) -> Result<(Answer, Duration), Silence> {
    let (case, cases) = question.case;
    let mut arguments: Vec<String> = vec![
        folder.join("driver.c").display().to_string(),
        format!("-DHARNESS={}", question.harness),
        format!("-DCASE={case}"),
        format!("-DCASES={cases}"),
        format!("-DMEMORY={}", question.stack + DATA),
        "-DWASM_RT_USE_MMAP=0".to_owned(),
        "-DWASM_RT_NONCONFORMING_UNCHECKED_STACK_EXHAUSTION=1".to_owned(),
        "-I".to_owned(),
        folder.display().to_string(),
        "-I".to_owned(),
        tools.include.display().to_string(),
        "--unwindset".to_owned(),
        format!("load_bytes.0:{}", DATA + 1),
    ];
    let (define, name) = match question.ask {
        Ask::Proof => (None, ""),
        Ask::Reach => (Some("-DREACH"), "-reach"),
        Ask::Both => (Some("-DBOTH"), "-both"),
    };
    arguments.extend(define.map(ToOwned::to_owned));
    arguments.extend(CBMC.iter().map(ToString::to_string));
    arguments.extend(question.solver.options(tools));
    let output = folder.join(format!("cbmc-{case}{name}.json"));
    let limits = Limits { time: question.limit, memory_kib: 8 << 20 };
    let program = tools.path("cbmc");
    let job = Job {
        program: &program,
        arguments: &arguments,
        variable: question.solver.path(tools),
        folder,
        output: &output,
        limits,
    };
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
    let text = std::fs::read_to_string(&output).map_err(|error| Silence::Broken(error.to_string()))?;
    let answer = parse(&text).map_err(Silence::Broken)?;
    let all_hold = answer.holds.values().all(|holds| *holds);
    if all_hold == (end == End::Code(0)) {
        Ok((answer, took))
    } else {
        Err(Silence::Broken("cbmc's exit code and its results disagree".to_owned()))
    }
}

/// Reads CBMC's JSON. An unfinished text, a warning about a missing body or an unknown status is an error.
///
/// # Errors
/// What is wrong with the text.
pub fn parse(text: &str) -> Result<Answer, String> {
    let document: Vec<Value> = serde_json::from_str(text).map_err(|error| format!("cbmc's JSON is broken: {error}"))?;
    let messages = document.iter().filter_map(|item| item["messageText"].as_str());
    if let Some(warning) = messages.clone().find(|text| text.contains("no body for")) {
        return Err(format!("cbmc does not see all the code: {warning}"));
    }
    if !document.iter().any(|item| item["cProverStatus"].is_string()) {
        let errors = document.iter().filter(|item| item["messageType"] == "ERROR");
        let said: Vec<_> = errors.filter_map(|item| item["messageText"].as_str()).collect();
        return Err(format!("cbmc gave no status: {}", said.join("; ")));
    }
    let mut answer = Answer::default();
    for property in document.iter().filter_map(|item| item["result"].as_array()).flatten() {
        let description = property["description"].as_str().unwrap_or_default().to_owned();
        let holds = match property["status"].as_str() {
            Some("SUCCESS") => true,
            Some("FAILURE") => false,
            other => return Err(format!("cbmc says {other:?} of `{description}`")),
        };
        if description.contains("no body for") {
            return Err(format!("cbmc does not see all the code: {description}"));
        }
        if !holds {
            let values = values(&property["trace"]);
            answer.values.entry(description.clone()).or_insert(values);
        }
        // The same description at several places: it holds if it holds at all of them.
        let known = answer.holds.entry(description).or_insert(true);
        *known = *known && holds;
    }
    if answer.holds.is_empty() { Err("cbmc checked nothing".to_owned()) } else { Ok(answer) }
}

/// The arbitrary values of a trace, in order.
fn values(trace: &Value) -> Vec<u16> {
    let steps = trace.as_array().map(Vec::as_slice).unwrap_or_default();
    let drawn = steps.iter().filter(|step| step["stepType"] == "assignment" && step["lhs"] == "drawn");
    let number = |step: &Value| u32::from_str_radix(step["value"]["binary"].as_str()?, 2).ok();
    drawn.filter_map(number).map(u32::to_le_bytes).map(|bytes| u16::from_le_bytes([bytes[0], bytes[1]])).collect()
}
