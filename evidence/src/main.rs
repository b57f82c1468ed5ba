//! `safety-case`: see `safety-case --help`.
#![forbid(unsafe_code)]

use clap::Parser;
use std::process::ExitCode;

fn main() -> ExitCode {
    if let Err(reason) = atc_prover::end_all_on_interrupt() {
        eprintln!("error: {reason}");
        return ExitCode::from(atc_evidence::cli::USAGE);
    }
    ExitCode::from(atc_evidence::cli::main(atc_evidence::cli::Cli::parse()))
}
