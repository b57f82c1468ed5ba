//! `cargo run -p atc-prover -- list | prove | mutants | old-rules | replay | twins | selftest | traps`.

use atc_prover::old_rules::{self, Program};
use atc_prover::recorded::{self, Recorded};
use atc_prover::report::{Campaign, HarnessResult, MutantVerdict, Mutants, Verdict};
use atc_prover::traps::table;
use atc_prover::twins::twins;
use atc_prover::{
    Asking, Options, Tools, campaign, end_all_on_interrupt, harnesses, kani, mutants, native, root, select, selftest,
};
use clap::{Parser, Subcommand, ValueEnum};
use indicatif::{ProgressBar, ProgressStyle};
use std::io;
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::time::Duration;

/// Runs the theorems of the train control kernel.
#[derive(Parser)]
#[command(name = "atc-proofs", version)]
struct Cli {
    #[command(subcommand)]
    command: Command,
}

#[derive(Subcommand)]
enum Command {
    /// Lists the harnesses: theorem, claims, cover points, assumptions.
    List,
    /// Proves (or tests) the harnesses and writes the result as JSON.
    Prove {
        /// The harnesses; all of them if none is named.
        names: Vec<String>,
        /// What runs them.
        #[arg(long, value_enum, default_value = "cbmc")]
        engine: EngineName,
        /// Where the JSON goes [default: target/proofs/campaign.json, native.json or reals.json].
        #[arg(long)]
        json: Option<PathBuf>,
        #[command(flatten)]
        run: Run,
    },
    /// Breaks the kernel in named ways and expects the named theorems to fail.
    Mutants {
        /// The mutants; all of them if none is named.
        names: Vec<String>,
        /// Where the JSON goes [default: target/proofs/mutants.json].
        #[arg(long)]
        json: Option<PathBuf>,
        /// Asks the prover of every mutant, and not only of a sample and of those that no kept counterexample rejects.
        #[arg(long)]
        afresh: bool,
        /// The same, and compiles each mutant alone: slow, and to check the usual way by.
        #[arg(long, conflicts_with = "afresh")]
        alone: bool,
        /// The same, with the harnesses as large as they prove, and keeps the counterexamples: proofs/counterexamples.tsv.
        #[arg(long, conflicts_with_all = ["afresh", "alone"])]
        record: bool,
        #[command(flatten)]
        run: Run,
    },
    /// Runs the adversary, or the models, on a kernel that is wrong in named ways: old rules put back.
    OldRules {
        /// The mutants, with commas; none of them is the kernel as it is.
        #[arg(value_delimiter = ',')]
        mutants: Vec<String>,
        /// What runs on it.
        #[arg(long, value_enum, default_value = "adversary")]
        program: ProgramName,
        /// The table of the known faults instead: what finds each of them with the old rule put back.
        #[arg(long, conflicts_with_all = ["mutants", "program", "arguments"])]
        table: bool,
        /// What the program is told.
        #[arg(last = true)]
        arguments: Vec<String>,
    },
    /// Runs one harness natively on given values, and says in words what they are.
    Replay {
        /// The harness.
        harness: String,
        /// The values in order, with commas; without them those of the last campaign's counterexample.
        #[arg(long, value_delimiter = ',')]
        values: Option<Vec<u16>>,
        /// Keeps them as a regression test: proofs/runner/regressions/NAME.json.
        #[arg(long, value_name = "NAME")]
        keep: Option<String>,
    },
    /// Kani's names of the harnesses, and what Kani says of them.
    Kani {
        #[command(subcommand)]
        what: Kani,
    },
    /// Runs harnesses as Rust, as wasm2c's C and as the C that is proved, on the same values, and compares.
    Twins {
        /// The harnesses; all of them if none is named.
        names: Vec<String>,
        /// Inputs that are drawn for each.
        #[arg(long, default_value_t = 4096)]
        runs: usize,
        #[command(flatten)]
        run: Run,
    },
    /// Tests the cbmc engine on small programs whose verdicts are known.
    Selftest {
        #[command(flatten)]
        run: Run,
    },
    /// Tries every engine on those programs: engine, version, right or wrong (target/proofs/traps.json and traps.md).
    Traps {
        #[command(flatten)]
        run: Run,
    },
}

#[derive(Subcommand)]
enum Kani {
    /// Lists Kani's names: harnesses, then contracts.
    Names,
    /// Compares the list that `cargo kani list --format json` has written with ours.
    Compare {
        /// kani-list.json
        list: PathBuf,
    },
    /// Turns the export of `cargo kani --export-json` of this very checkout into results for the case.
    Import {
        /// The export.
        export: PathBuf,
        /// Where the JSON goes [default: target/proofs/kani.json].
        #[arg(long)]
        json: Option<PathBuf>,
    },
}

#[derive(Clone, Copy, ValueEnum)]
enum EngineName {
    /// Proves, on the compiled code.
    Cbmc,
    /// Tests, with drawn values.
    Native,
    /// Proves the algebra of motion, over all real numbers.
    Reals,
}

#[derive(Clone, Copy, ValueEnum)]
enum ProgramName {
    /// Hunts for accidents, episode by episode.
    Adversary,
    /// Goes through all states of small stations.
    Models,
    /// Looks which mutants the test vectors catch.
    Vectors,
}

#[derive(clap::Args)]
struct Run {
    /// Runs of the prover at a time [default: the cores].
    #[arg(long)]
    jobs: Option<usize>,
    /// Seconds of CPU time for each run of the prover.
    #[arg(long, default_value_t = 600)]
    time_limit: u64,
    /// Which solver.
    #[arg(long, value_enum, default_value = "auto")]
    solver: atc_prover::Solver,
    /// Ranks of the aspect machine, 1 to 16.
    #[arg(long, default_value_t = atc_proofs::ASPECTS, value_parser = aspects)]
    aspects: usize,
}

fn aspects(text: &str) -> Result<usize, String> {
    text.parse().ok().filter(|number| (1..=16).contains(number)).ok_or_else(|| "a number from 1 to 16".to_owned())
}

impl Run {
    fn options(&self) -> Options {
        let default = Options::default();
        Options {
            jobs: self.jobs.unwrap_or(default.jobs).max(1),
            limit: Duration::from_secs(self.time_limit),
            solver: self.solver,
            aspects: self.aspects,
            ..default
        }
    }
}

fn main() -> ExitCode {
    match end_all_on_interrupt().and_then(|()| run(Cli::parse().command)) {
        Ok(true) => ExitCode::SUCCESS,
        Ok(false) => ExitCode::FAILURE,
        Err(reason) => {
            eprintln!("error: {reason}");
            ExitCode::from(2)
        }
    }
}

fn run(command: Command) -> Result<bool, String> {
    match command {
        Command::List => list().map(|()| true),
        Command::Prove { names, engine: EngineName::Cbmc, json, run } => prove(&names, json, &run.options()),
        Command::Prove { names, engine: EngineName::Native, json, run } => {
            let result = atc_prover::campaign::native_campaign(&run.options(), &select(&names)?)?;
            result.harnesses.iter().for_each(|harness| println!("{}", line(harness)));
            save(&json.unwrap_or_else(|| default("native.json")), &result)?;
            Ok(result.harnesses.iter().all(|harness| harness.verdict == Verdict::Tested))
        }
        Command::Prove { names, engine: EngineName::Reals, json, run } => {
            let result = atc_prover::reals::campaign(&run.options(), &select(&names)?)?;
            result.harnesses.iter().for_each(|harness| println!("{}", line(harness)));
            save(&json.unwrap_or_else(|| default("reals.json")), &result)?;
            Ok(result.harnesses.iter().all(|harness| harness.verdict == Verdict::Proved))
        }
        Command::Mutants { names, json, afresh, alone, record, run } => {
            let asking = match (afresh, alone, record) {
                (true, ..) => Asking::All,
                (_, true, _) => Asking::Alone,
                (.., true) => Asking::Record,
                (false, false, false) => Asking::Some,
            };
            try_mutants(&names, json, &Options { asking, ..run.options() })
        }
        Command::OldRules { table: true, .. } => table_of_old_rules(),
        Command::OldRules { mutants, program, arguments, .. } => with_old_rules(&mutants, program, &arguments),
        Command::Replay { harness, values, keep } => replay(&harness, values, keep),
        Command::Twins { names, runs, run } => compare_twins(&names, runs, &run.options()),
        Command::Kani { what } => of_kani(what),
        Command::Selftest { run } => {
            selftest::check(&Tools::find(&root())?, &run.options())?;
            println!("the cbmc engine passes its self-test");
            Ok(true)
        }
        Command::Traps { run } => try_traps(&run.options()),
    }
}

fn of_kani(what: Kani) -> Result<bool, String> {
    let read = |path: &Path| std::fs::read_to_string(path).map_err(|error| format!("{}: {error}", path.display()));
    match what {
        Kani::Names => {
            let names = harnesses().into_iter().flat_map(kani::names).chain(kani::contracts());
            names.for_each(|name| println!("{name}"));
            Ok(true)
        }
        Kani::Compare { list } => {
            println!("{}", kani::compare(&read(&list)?)?);
            Ok(true)
        }
        Kani::Import { export, json } => {
            let result = kani::import(&read(&export)?)?;
            result.harnesses.iter().for_each(|harness| println!("{}", line(harness)));
            save(&json.unwrap_or_else(|| default("kani.json")), &result)?;
            let proved = result.harnesses.iter().filter(|harness| harness.verdict == Verdict::Proved).count();
            println!("{proved} of {} harnesses proved", result.harnesses.len());
            Ok(proved == result.harnesses.len())
        }
    }
}

/// Prints the harnesses. A reader that has read enough is no error.
fn list() -> Result<(), String> {
    match write_list(&mut io::stdout().lock()) {
        Err(error) if error.kind() != io::ErrorKind::BrokenPipe => Err(format!("cannot print: {error}")),
        _ => Ok(()),
    }
}

fn write_list(out: &mut impl io::Write) -> io::Result<()> {
    for harness in harnesses() {
        writeln!(out, "{} ({}): {}", harness.name, harness.theorem, harness.statement.trim())?;
        for claim in harness.claims {
            writeln!(out, "    claim  {}: {}", claim.name, claim.text)?;
        }
        for cover in harness.covers {
            writeln!(out, "    cover  {}: {}", cover.name, cover.text)?;
        }
        let requirements = harness.requirements.join(", ");
        writeln!(out, "    proves {requirements}; assumes {:?}; {}", harness.assumptions, harness.bound)?;
    }
    Ok(())
}

fn prove(names: &[String], json: Option<PathBuf>, options: &Options) -> Result<bool, String> {
    let chosen = select(names)?;
    let bar = bar(chosen.len());
    let result = campaign(options, &chosen, &|harness| {
        bar.suspend(|| println!("{}", line(harness)));
        bar.inc(1);
    })?;
    bar.finish_and_clear();
    let proved = result.harnesses.iter().filter(|harness| harness.verdict == Verdict::Proved).count();
    let claims: usize = result.harnesses.iter().map(|harness| harness.claims.len()).sum();
    println!("{proved} of {} harnesses proved ({claims} claims), {:.1} s", chosen.len(), result.provenance.seconds);
    save(&json.unwrap_or_else(|| default("campaign.json")), &result)?;
    Ok(proved == chosen.len())
}

fn try_mutants(names: &[String], json: Option<PathBuf>, options: &Options) -> Result<bool, String> {
    let bar = bar(atc_prover::mutants::list(&root())?.len());
    let result: Mutants = mutants(options, names, &|mutant| {
        let by: Vec<_> =
            mutant.killed_by.iter().map(|kill| format!("{} ({})", kill.harness, kill.claims.join(", "))).collect();
        let reason = mutant.reason.as_deref().unwrap_or_default();
        let verdict = format!("{:?}", mutant.verdict).to_lowercase();
        bar.suspend(|| println!("{verdict:9} {:32} {:6.1} s  {} {reason}", mutant.name, mutant.seconds, by.join("; ")));
        bar.inc(1);
    })?;
    bar.finish_and_clear();
    let killed = result.mutants.iter().filter(|mutant| mutant.verdict == MutantVerdict::Killed).count();
    let passed = result.controls.iter().filter(|control| control.reason.is_none()).count();
    println!(
        "{passed} of {} controls passed: no mutant selected, where a harness is smaller than in its proof",
        result.controls.len()
    );
    let kills = || result.mutants.iter().flat_map(|mutant| &mutant.killed_by);
    let (all, asked) = (kills().count(), kills().filter(|kill| kill.asked).count());
    println!(
        "{asked} of {all} rejections found by the prover in this run, the others by a counterexample that is kept"
    );
    println!("{killed} of {} mutants killed, {:.1} s", result.mutants.len(), result.provenance.seconds);
    if options.asking == Asking::Record {
        let new = Recorded::read(&root())?.record(&root(), &atc_prover::mutants::list(&root())?, &result.mutants)?;
        println!("{new} counterexamples kept anew in {}", recorded::FILE);
        // The sample of a later run asks the harnesses at their smaller size: what is not rejected there would be an error then.
        let smaller = mutants(&Options { asking: Asking::All, ..options.clone() }, names, &|_| ())?.mutants;
        let passed = smaller.iter().filter(|mutant| mutant.verdict != MutantVerdict::Killed);
        let passed: Vec<_> = passed.map(|mutant| mutant.name.as_str()).collect();
        if !passed.is_empty() {
            return Err(format!("not rejected at the size that the sample asks: {}", passed.join(", ")));
        }
    }
    save(&json.unwrap_or_else(|| default("mutants.json")), &result)?;
    Ok(killed == result.mutants.len())
}

fn compare_twins(names: &[String], runs: usize, options: &Options) -> Result<bool, String> {
    let all = twins(options, &select(names)?, runs, &|twins| match &twins.outcome {
        Ok((runs, accepted)) => println!("same     {:32} {accepted} of {runs} runs meet its assumptions", twins.name),
        Err(reason) => println!("differs  {:32} {reason}", twins.name),
    })?;
    let (same, silent) = all.iter().fold((0, 0), |(same, silent), twins| match twins.outcome {
        Ok((_, accepted)) => (same + 1, silent + usize::from(accepted == 0)),
        Err(_) => (same, silent),
    });
    println!("{same} of {} harnesses are the same in Rust, in wasm2c's C and as they are proved", all.len());
    println!("{silent} of these say nothing: no drawn value met their assumptions");
    Ok(same == all.len())
}

fn with_old_rules(mutants: &[String], program: ProgramName, arguments: &[String]) -> Result<bool, String> {
    let program = match program {
        ProgramName::Adversary => Program::Adversary,
        ProgramName::Models => Program::Models,
        ProgramName::Vectors => Program::Vectors,
    };
    let names: Vec<&str> = mutants.iter().map(String::as_str).collect();
    let programs = old_rules::build(&root(), &[program])?;
    let mut command =
        if program == Program::Vectors { programs.vectors(&names)? } else { programs.with(program, &names)? };
    let status = command.args(arguments).status().map_err(|error| format!("{}: {error}", program.name()))?;
    Ok(status.success())
}

/// Hunts for each known fault with the old rule put back and without, for as many cycles, and asks the model that is said to find it.
fn table_of_old_rules() -> Result<bool, String> {
    let programs = old_rules::build(&root(), &[Program::Adversary, Program::Models])?;
    let mut ok = true;
    println!(
        "| fault | mutants | cycles | accident | model | what fails with the old rule alone |\n|---|---|---|---|---|---|"
    );
    for fault in programs.known()? {
        let hunted = programs.hunt(&fault, &fault.mutants)?.found;
        let (after, mut accident) = hunted.clone().unwrap_or((fault.cycles, "NOT FOUND".to_owned()));
        let control = programs.hunt(&fault, &[])?.found;
        if let Some((_, accident_of_control)) = &control {
            accident = format!("FOUND IN THE KERNEL AS IT IS, TOO: {accident_of_control}");
        }
        let (red, green) =
            (programs.unexpected(&fault.model, &fault.mutants)?, programs.unexpected(&fault.model, &[])?);
        let claims = match (red.is_empty(), green.is_empty()) {
            (_, false) => format!("RED WITHOUT THE OLD RULE, TOO: {}", green.join(", ")),
            (true, true) => "NOT RED".to_owned(),
            (false, true) => red.join(", "),
        };
        ok &= hunted.is_some() && control.is_none() && !red.is_empty() && green.is_empty();
        let (name, mutants, model) = (&fault.name, fault.mutants.join(", "), &fault.model);
        println!("| {name} | {mutants} | {after} | {accident} | {model} | {claims} |");
    }
    Ok(ok)
}

fn try_traps(options: &Options) -> Result<bool, String> {
    let table = table(&Tools::find(&root())?, options)?;
    let (text, path) = (table.markdown(), default("traps.md"));
    println!("{text}");
    std::fs::write(&path, text).map_err(|error| format!("{}: {error}", path.display()))?;
    save(&default("traps.json"), &table)?;
    Ok(table.is_right())
}

fn replay(name: &str, values: Option<Vec<u16>>, keep: Option<String>) -> Result<bool, String> {
    let names = [name.to_owned()];
    let harness = select(&names)?[0];
    let values = match values {
        Some(values) => values,
        None => last_counterexample(name)?,
    };
    let run = native::replay(harness, &values);
    run.drawn.iter().for_each(|(what, value)| println!("    {value:6}  {value:#018b}  {what}"));
    let failed: Vec<_> = run.failed().iter().filter_map(|number| harness.claims.get(*number as usize)).collect();
    for claim in &failed {
        println!("fails: {}: {}", claim.name, claim.text);
    }
    if !run.accepted {
        println!("these values do not meet the assumptions of {name}: nothing is claimed of them");
    } else if failed.is_empty() {
        println!("every claim of {name} holds for these values");
    }
    if let Some(keep) = keep {
        let plain = !keep.is_empty() && keep.chars().all(|letter| letter.is_ascii_alphanumeric() || letter == '_');
        if !plain {
            return Err(format!("`{keep}` is no name for a test: letters, digits and _ only"));
        }
        let path = root().join("proofs/runner/regressions").join(format!("{keep}.json"));
        save(&path, &serde_json::json!({ "harness": name, "values": values }))?;
    }
    Ok(run.accepted && failed.is_empty())
}

fn last_counterexample(name: &str) -> Result<Vec<u16>, String> {
    let path = default("campaign.json");
    let text = std::fs::read_to_string(&path).map_err(|error| format!("{}: {error}; give --values", path.display()))?;
    let last: Campaign = serde_json::from_str(&text).map_err(|error| format!("{}: {error}", path.display()))?;
    let result = last.harnesses.into_iter().find(|harness| harness.name == name);
    result
        .and_then(|harness| harness.counterexample)
        .ok_or_else(|| format!("the last campaign has no counterexample of {name}; give --values"))
}

fn line(harness: &HarnessResult) -> String {
    let verdict = harness.verdict.as_str();
    let covers = harness.covers.iter().filter(|cover| cover.hit).count();
    let bound = if harness.bound.is_empty() { String::new() } else { format!(", {}", harness.bound) };
    let reason = harness.reason.as_ref().map_or_else(String::new, |reason| format!(": {reason}"));
    format!(
        "{verdict:8} {:20} {:7.1} s  {} claims, {covers} of {} cover points{bound}{reason}",
        harness.name,
        harness.seconds,
        harness.claims.len(),
        harness.covers.len(),
    )
}

fn bar(length: usize) -> ProgressBar {
    let bar = ProgressBar::new(u64::try_from(length).unwrap_or(0));
    let style = ProgressStyle::with_template("{bar:40} {pos}/{len} {elapsed}");
    bar.with_style(style.unwrap_or_else(|_| ProgressStyle::default_bar()))
}

fn default(name: &str) -> PathBuf {
    root().join("target").join("proofs").join(name)
}

/// Writes JSON: first under another name, so that a killed run leaves no half of it.
fn save(path: &Path, result: &impl serde::Serialize) -> Result<(), String> {
    let failed = |error: &dyn std::fmt::Display| format!("{}: {error}", path.display());
    if let Some(folder) = path.parent() {
        std::fs::create_dir_all(folder).map_err(|error| failed(&error))?;
    }
    let text = serde_json::to_string_pretty(result).map_err(|error| failed(&error))?;
    let unfinished = path.with_extension("json.part");
    std::fs::write(&unfinished, text + "\n").map_err(|error| failed(&error))?;
    std::fs::rename(&unfinished, path).map_err(|error| failed(&error))
}
