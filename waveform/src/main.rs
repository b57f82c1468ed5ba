//! `waveform bench`: measures the receivers, prints a table, writes the figures and the pictures.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

use atc_waveform::config::TransmitterConfig;
use atc_waveform::measure::{Bench, Extent, bench};
use atc_waveform::plot_signal;
use atc_waveform::position_measure::{self, PositionBench};
use atc_waveform::receiver::example_code_table;
use atc_waveform::units::Seed;
use clap::{Parser, Subcommand};
use serde::Serialize;

mod report;

/// The train control signal as a waveform.
#[derive(Parser)]
#[command(version)]
struct Arguments {
    #[command(subcommand)]
    command: Command,
}

#[derive(Subcommand)]
enum Command {
    /// Measures bit errors, detection times, false codes and throughput of the receivers, and error and width of the train's
    /// position.
    Bench {
        /// Measure less, in seconds instead of minutes.
        #[arg(long)]
        quick: bool,
        /// Seed of bits, phases and noise: the same seed, the same result.
        #[arg(long, default_value_t = 1)]
        seed: u64,
        /// Folder for bench.json and the pictures; made if it is not there.
        #[arg(long)]
        out: PathBuf,
    },
}

fn main() -> ExitCode {
    let Arguments { command: Command::Bench { quick, seed, out } } = Arguments::parse();
    let extent = if quick { Extent::Quick } else { Extent::Full };
    match run(extent, Seed(seed), &out) {
        Ok(()) => ExitCode::SUCCESS,
        Err(reason) => {
            eprintln!("waveform: {reason}");
            ExitCode::FAILURE
        }
    }
}

fn run(extent: Extent, seed: Seed, out: &Path) -> Result<(), String> {
    // Before the measurement, which takes long: a folder that cannot be written to is no reason to wait.
    fs::create_dir_all(out).map_err(|error| format!("{}: cannot be made: {error}", out.display()))?;
    let config = TransmitterConfig::default();
    let table = example_code_table().map_err(|error| format!("the code table: {error:?}"))?;
    let result = All { signal: bench(&config, &table, extent, seed), position: position_measure::bench(extent) };
    for line in report::table(&result.signal) {
        println!("{line}");
    }
    for (name, text) in files(&result, &config)? {
        write(&out.join(name), &text)?;
    }
    println!("\nbench.json and pictures are in {}", out.display());
    Ok(())
}

/// Everything that was measured.
#[derive(Serialize)]
struct All {
    signal: Bench,
    position: PositionBench,
}

/// All files of a run: all are made before the first is written.
fn files(result: &All, config: &TransmitterConfig) -> Result<Vec<(String, String)>, String> {
    let json = serde_json::to_string_pretty(result).map_err(|error| format!("bench.json: {error}"))?;
    let picture = serde_json::to_string(&result.signal.picture).map_err(|error| format!("picture.json: {error}"))?;
    let mut files = vec![("bench.json".to_owned(), json), ("picture.json".to_owned(), picture)];
    let plots = plot_signal::plots(&result.signal, config.params().depth, config.bit_rate());
    let plots = plots.map_err(|error| error.to_string())?;
    files.extend(plots.into_iter().map(|(name, svg)| (name.to_owned(), svg)));
    files.extend(position_measure::plots(&result.position).map_err(|error| error.to_string())?);
    Ok(files)
}

fn write(path: &Path, text: &str) -> Result<(), String> {
    fs::write(path, text).map_err(|error| format!("{}: cannot be written: {error}", path.display()))
}
