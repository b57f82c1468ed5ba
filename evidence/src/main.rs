//! `safety-case`: see `safety-case --help`.
#![forbid(unsafe_code)]

use clap::Parser;
use std::process::ExitCode;

fn main() -> ExitCode {
    ExitCode::from(atc_evidence::cli::main(atc_evidence::cli::Cli::parse()))
}
