//! The table: engine × version × right or wrong.

use super::{Engine, Outcome, SCHEMA, Trap, Trial, Way, list, trials};
use crate::Options;
use crate::cbmc::Solver;
use crate::tools::Tools;
use serde::Serialize;
use std::collections::BTreeMap;
use std::fmt::Write;
use std::process::Command;

/// All engines on all traps.
#[derive(Clone, Debug, Serialize)]
pub struct Table {
    /// The schema of the reports.
    pub schema: u32,
    /// Trap → its language and what it is about, in order.
    pub traps: Vec<(String, String, String)>,
    /// One for each engine.
    pub rows: Vec<Row>,
}

/// One engine.
#[derive(Clone, Debug, Serialize)]
pub struct Row {
    /// Its name.
    pub engine: String,
    /// Its version.
    pub version: String,
    /// Trap → how it did: `right`, `wrong`, `known wrong`, `silent` or `not run`, and what it said otherwise.
    pub outcomes: BTreeMap<String, (String, String)>,
}

/// Tries CBMC with each of its solvers, and the machine itself, on every trap.
///
/// # Errors
/// The declarations cannot be read, or the traps not be compiled.
pub fn table(tools: &Tools, options: &Options) -> Result<Table, String> {
    let (root, traps) = (crate::root(), list(&crate::root())?);
    let folder = root.join("target/proofs/traps");
    let solvers = [Solver::Minisat, Solver::Kissat, Solver::Z3];
    let ways = |_: &Trap| solvers.map(Way::Twice).into_iter().chain([Way::Native]).collect();
    let found = trials(tools, &root, &folder, (&traps, &ways), (options.jobs, options.limit))?;
    let engines = solvers.map(Engine::Cbmc).into_iter().chain([Engine::Native]);
    let rows = engines.map(|engine| row(tools, engine, &traps, &found)).collect();
    let named = |trap: &Trap| (trap.name.clone(), trap.language().to_owned(), trap.about.clone());
    Ok(Table { schema: SCHEMA, traps: traps.iter().map(named).collect(), rows })
}

fn row(tools: &Tools, engine: Engine, traps: &[Trap], found: &[Trial]) -> Row {
    let version = |tool: &str| {
        let version = tools.versions.get(tool).and_then(|version| version.split(' ').next());
        version.unwrap_or("unknown").to_owned()
    };
    let (name, version) = match engine {
        Engine::Cbmc(Solver::Kissat) => ("cbmc with kissat", format!("{}, {}", version("cbmc"), version("kissat"))),
        Engine::Cbmc(Solver::Z3) => ("cbmc with z3", format!("{}, {}", version("cbmc"), version("z3"))),
        Engine::Cbmc(_) => ("cbmc with minisat", version("cbmc")),
        Engine::Native => ("cc, as a program", compiler()),
    };
    let is_known = |trap: &Trap| {
        let known = |wrong: &String| wrong.split_once(' ') == name.split(' ').next().zip(version.split(',').next());
        trap.known_wrong.iter().any(known)
    };
    let judged = |trap: &Trap| {
        let trial = found.iter().find(|trial| trial.trap == trap.name && trial.way.engine() == engine);
        let (word, said) = match trial.map(|trial| &trial.outcome) {
            Some(Outcome::Right) => ("right", String::new()),
            Some(Outcome::Wrong(said)) if is_known(trap) => ("known wrong", said.clone()),
            Some(Outcome::Wrong(said)) => ("wrong", said.clone()),
            Some(Outcome::Silent(said)) => ("silent", said.clone()),
            Some(Outcome::NotRun(said)) => ("not run", said.clone()),
            None => ("not run", String::new()),
        };
        (trap.name.clone(), (word.to_owned(), said))
    };
    Row { engine: name.to_owned(), outcomes: traps.iter().map(judged).collect(), version }
}

/// The version of the machine's C compiler.
fn compiler() -> String {
    let output = Command::new("cc").arg("--version").output();
    let text = output.map(|output| String::from_utf8_lossy(&output.stdout).into_owned()).unwrap_or_default();
    text.lines().next().unwrap_or("unknown").to_owned()
}

impl Table {
    /// Whether no engine is wrong where it is not known to be, and none is silent.
    pub fn is_right(&self) -> bool {
        let mut outcomes = self.rows.iter().flat_map(|row| row.outcomes.values());
        outcomes.all(|(word, _)| word != "wrong" && word != "silent")
    }

    /// The table in Markdown, and below it what was said where it was not right.
    pub fn markdown(&self) -> String {
        let mut text = "| trap | language |".to_owned();
        let mut rule = "|---|---|".to_owned();
        for row in &self.rows {
            let _ = write!(text, " {} {} |", row.engine, row.version);
            rule += "---|";
        }
        let _ = writeln!(text, "\n{rule}");
        let mut said = String::new();
        for (name, language, _) in &self.traps {
            let _ = write!(text, "| {name} | {language} |");
            for row in &self.rows {
                let (word, reason) = &row.outcomes[name];
                let _ = write!(text, " {word} |");
                if !reason.is_empty() {
                    let _ = writeln!(said, "- {name}, {}: {word}: {reason}", row.engine);
                }
            }
            text.push('\n');
        }
        format!("{text}\n{said}")
    }
}
