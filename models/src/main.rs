//! The `models` command: checks the models, lists them, asks SPIN for a second opinion, or explores one in a browser.

use atc_models::bench::{Row, bench, model};
use atc_models::spin::opinions_on;
use atc_models::{Agreement, Entry, Outcome, SecondOpinion, catalogue, check, explore, in_parallel};
use clap::{Parser, Subcommand};
use serde::Serialize;
use std::collections::BTreeSet;
use std::io::{self, Write};
use std::net::{SocketAddr, ToSocketAddrs};
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::{fs, thread};

/// Stateright models of the train control system, over the real kernel.
#[derive(Parser)]
#[command(version)]
struct Arguments {
    #[command(subcommand)]
    command: Command,
}

#[derive(Subcommand)]
enum Command {
    /// Check models, all of them if none is named. Exit code 1 if an expectation is not met.
    Check {
        /// Write the outcomes to this file as JSON.
        #[arg(long, value_name = "FILE")]
        json: Option<PathBuf>,
        /// Models to check at the same time; as many as there are cores if absent.
        #[arg(long, value_name = "COUNT", value_parser = clap::value_parser!(u16).range(1..=256))]
        jobs: Option<u16>,
        /// Names, as `models list` prints them.
        #[arg(value_name = "NAME")]
        names: Vec<String>,
    },
    /// List the models.
    List,
    /// Ask SPIN for a second opinion on the models that are written in Promela too. Exit code 1 if it differs.
    Spin {
        /// Write the opinions to this file as JSON.
        #[arg(long, value_name = "FILE")]
        json: Option<PathBuf>,
        /// Models to look at, at the same time; as many as there are cores if absent.
        #[arg(long, value_name = "COUNT", value_parser = clap::value_parser!(u16).range(1..=256))]
        jobs: Option<u16>,
        /// Exit code 1 also if SPIN is not here.
        #[arg(long)]
        require: bool,
        /// Names, as `models list` prints them.
        #[arg(value_name = "NAME")]
        names: Vec<String>,
    },
    /// Measure states per second: Stateright over the kernel against SPIN's compiled checker.
    Bench {
        /// The cores of the runs on several; all of the machine if absent.
        #[arg(long, value_name = "COUNT", value_parser = clap::value_parser!(u16).range(2..=64))]
        cores: Option<u16>,
        /// Runs of each checker, of which the shortest counts.
        #[arg(long, value_name = "COUNT", default_value_t = 3, value_parser = clap::value_parser!(u16).range(1..=100))]
        runs: u16,
    },
    /// Serve Stateright's Explorer for one model.
    Explore {
        /// The name, as `models list` prints it.
        name: String,
        /// Where to listen.
        #[arg(default_value = "localhost:3000")]
        address: String,
    },
}

fn main() -> ExitCode {
    let done = match Arguments::parse().command {
        Command::Check { json, jobs, names } => check_all(json.as_deref(), threads(jobs), &names),
        Command::Spin { json, jobs, require, names } => second(json.as_deref(), threads(jobs), require, &names),
        Command::Bench { cores, runs } => {
            measure(threads(cores), usize::from(runs));
            Ok(true)
        }
        Command::List => list().map(|()| true),
        Command::Explore { name, address } => serve(&name, &address).map(|()| true),
    };
    match done {
        Ok(true) => ExitCode::SUCCESS,
        Ok(false) => ExitCode::from(1),
        Err(message) => {
            eprintln!("models: {message}");
            ExitCode::from(2)
        }
    }
}

/// Prints the models. A reader that has read enough is no error.
fn list() -> Result<(), String> {
    let mut out = io::stdout().lock();
    let print = |entry: Entry| writeln!(out, "{}\n  {}\n  {}", entry.name, entry.statement, entry.parameters);
    match catalogue().into_iter().try_for_each(print) {
        Err(error) if error.kind() != io::ErrorKind::BrokenPipe => Err(format!("cannot print: {error}")),
        _ => Ok(()),
    }
}

fn serve(name: &str, address: &str) -> Result<(), String> {
    let entry = chosen(&[name.to_owned()])?.remove(0);
    let resolved: Option<SocketAddr> = address
        .to_socket_addrs()
        .map_err(|error| format!("{address} is no address to listen on: {error}; give HOST:PORT"))?
        .next();
    let resolved = resolved.ok_or_else(|| format!("{address} resolves to no address; give HOST:PORT"))?;
    println!("exploring {name} on http://{resolved}/; end with Ctrl-C");
    explore(&entry, resolved).map_err(|error| format!("cannot listen on {address}: {error}"))
}

/// The entries with these names in the order of the catalogue; all of them for no name.
fn chosen(names: &[String]) -> Result<Vec<Entry>, String> {
    let all = catalogue();
    if let Some(unknown) = names.iter().find(|name| !all.iter().any(|entry| entry.name == name.as_str())) {
        let known: Vec<_> = all.iter().map(|entry| entry.name).collect();
        return Err(format!("there is no model {unknown}; there are {}", known.join(", ")));
    }
    let wanted: BTreeSet<_> = names.iter().map(String::as_str).collect();
    Ok(all.into_iter().filter(|entry| wanted.is_empty() || wanted.contains(entry.name)).collect())
}

/// As many as asked for, or as there are cores.
fn threads(asked: Option<u16>) -> usize {
    asked.map_or_else(|| thread::available_parallelism().map_or(1, usize::from), usize::from)
}

fn check_all(json: Option<&Path>, jobs: usize, names: &[String]) -> Result<bool, String> {
    let entries = chosen(names)?;
    println!("{:<40} {:>10} {:>10} {:>6} {:>8}  verdict", "model", "states", "generated", "depth", "seconds");
    let outcomes = in_parallel(&entries, jobs, |entry| check(entry, 1), print);
    write_to(json, &outcomes)?;
    let met = outcomes.iter().filter(|outcome| outcome.ok()).count();
    println!("{met} of {} models as expected", entries.len());
    Ok(met == entries.len())
}

fn second(json: Option<&Path>, jobs: usize, require: bool, names: &[String]) -> Result<bool, String> {
    let mut entries = chosen(names)?;
    if let Some(single) = entries.iter().find(|entry| !names.is_empty() && entry.twin.is_none()) {
        let twins: Vec<_> =
            catalogue().into_iter().filter(|entry| entry.twin.is_some()).map(|entry| entry.name).collect();
        return Err(format!("{} is not written in Promela; there are {}", single.name, twins.join(", ")));
    }
    entries.retain(|entry| entry.twin.is_some());
    println!("{:<40} {:>10} {:>10} {:>8}  verdict", "model", "states", "spin", "seconds");
    let opinions = opinions_on(&entries, &[], jobs, |(outcome, second)| {
        let states = second.states.map_or_else(|| "-".to_owned(), |states| states.to_string());
        let verdict = match second.verdict {
            Agreement::Agrees => "agrees",
            Agreement::Differs => "DIFFERS",
            Agreement::NotRun if second.is_wrong() => "NO RESULT",
            Agreement::NotRun => "not run",
        };
        let reason = second.reason.as_ref().map_or_else(String::new, |reason| format!(": {reason}"));
        let (model, own) = (&second.model, outcome.unique_states);
        println!("{model:<40} {own:>10} {states:>10} {:>8.2}  {verdict}{reason}", second.seconds);
    });
    write_to(json, &opinions)?;
    let agree = opinions.iter().filter(|second| second.verdict == Agreement::Agrees).count();
    println!("spin agrees on {agree} of {} models", opinions.len());
    Ok(!opinions.iter().any(SecondOpinion::is_wrong) && (!require || agree == opinions.len()))
}

fn measure(cores: usize, runs: usize) {
    println!("{}; the shortest of {runs} runs", model());
    println!("{:<60} {:>5} {:>10} {:>10} {:>8} {:>12}", "checker", "cores", "states", "steps", "seconds", "states/s");
    for Row { checker, cores, figures } in bench(cores, runs) {
        match figures {
            Ok((states, steps, seconds)) => {
                // Whole states per second; the loss of precision is of no interest.
                #[expect(clippy::cast_precision_loss)]
                let rate = states as f64 / seconds;
                println!("{checker:<60} {cores:>5} {states:>10} {steps:>10} {seconds:>8.2} {rate:>12.0}");
            }
            Err(why) => println!("{checker:<60} {cores:>5} {why}"),
        }
    }
}

fn print(outcome: &Outcome) {
    println!(
        "{:<40} {:>10} {:>10} {:>6} {:>8.2}  {}",
        outcome.model,
        outcome.unique_states,
        outcome.generated_states,
        outcome.max_depth,
        outcome.seconds,
        if outcome.ok() {
            "as expected"
        } else if outcome.complete {
            "NOT AS EXPECTED"
        } else {
            "INCOMPLETE"
        },
    );
    for property in outcome.properties.iter().filter(|property| !property.ok()) {
        println!("    {} ({:?}, {:?}): {}", property.name, property.expectation, property.verdict, property.text);
        if let Some(trace) = &property.trace {
            print!("{}", trace.trace_jsonl());
        }
    }
}

fn write_to<T: Serialize>(json: Option<&Path>, what: &[T]) -> Result<(), String> {
    let Some(file) = json else { return Ok(()) };
    write(file, what).map_err(|error| format!("cannot write {}: {error}", file.display()))
}

fn write<T: Serialize>(file: &Path, what: &[T]) -> std::io::Result<()> {
    let mut name = file.file_name().unwrap_or_default().to_owned();
    name.push(".part");
    let part = file.with_file_name(name);
    let mut text = serde_json::to_string_pretty(what)?;
    text.push('\n');
    let done = fs::write(&part, text).and_then(|()| fs::rename(&part, file));
    if done.is_err() {
        let _ = fs::remove_file(&part);
    }
    done
}
