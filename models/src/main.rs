//! The `models` command: checks the models, lists them, or explores one in a browser.

use atc_models::{Entry, Outcome, catalogue, check, explore};
use clap::{Parser, Subcommand};
use std::collections::BTreeSet;
use std::net::{SocketAddr, ToSocketAddrs};
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Mutex, PoisonError};
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
        Command::Check { json, jobs, names } => check_all(json.as_deref(), jobs.map(usize::from), &names),
        Command::List => {
            list();
            Ok(true)
        }
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

fn list() {
    for entry in catalogue() {
        println!("{}\n  {}\n  {}", entry.name, entry.statement, entry.parameters);
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

fn check_all(json: Option<&Path>, jobs: Option<usize>, names: &[String]) -> Result<bool, String> {
    let entries = chosen(names)?;
    let jobs = jobs.or_else(|| thread::available_parallelism().ok().map(usize::from)).unwrap_or(1);
    let next = AtomicUsize::new(0);
    let outcomes: Mutex<Vec<(usize, Outcome)>> = Mutex::new(Vec::new());
    println!("{:<30} {:>10} {:>10} {:>6} {:>8}  verdict", "model", "states", "generated", "depth", "seconds");
    thread::scope(|scope| {
        for _ in 0..jobs.min(entries.len()) {
            scope.spawn(|| {
                loop {
                    let place = next.fetch_add(1, Ordering::Relaxed);
                    let Some(entry) = entries.get(place) else { return };
                    let outcome = check(entry, 1);
                    let mut done = outcomes.lock().unwrap_or_else(PoisonError::into_inner);
                    print(&outcome);
                    done.push((place, outcome));
                }
            });
        }
    });
    let mut outcomes = outcomes.into_inner().unwrap_or_else(PoisonError::into_inner);
    outcomes.sort_by_key(|(place, _)| *place);
    let outcomes: Vec<_> = outcomes.into_iter().map(|(_, outcome)| outcome).collect();
    if let Some(file) = json {
        write(file, &outcomes).map_err(|error| format!("cannot write {}: {error}", file.display()))?;
    }
    let met = outcomes.iter().filter(|outcome| outcome.ok()).count();
    println!("{met} of {} models as expected", entries.len());
    Ok(met == entries.len())
}

fn print(outcome: &Outcome) {
    println!(
        "{:<30} {:>10} {:>10} {:>6} {:>8.2}  {}",
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

fn write(file: &Path, outcomes: &[Outcome]) -> std::io::Result<()> {
    let mut name = file.file_name().unwrap_or_default().to_owned();
    name.push(".part");
    let part = file.with_file_name(name);
    let mut text = serde_json::to_string_pretty(outcomes)?;
    text.push('\n');
    let done = fs::write(&part, text).and_then(|()| fs::rename(&part, file));
    if done.is_err() {
        let _ = fs::remove_file(&part);
    }
    done
}
