//! Starts the runner of the proofs. It lives in `proofs/runner` (package `atc-prover`), so that this package, which the
//! provers compile, has no dependency.

use std::process::{Command, ExitCode};

fn main() -> ExitCode {
    let cargo = std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into());
    let runner = ["run", "--quiet", "--release", "--package", "atc-prover", "--"];
    match Command::new(cargo).args(runner).args(std::env::args_os().skip(1)).status() {
        Ok(status) => ExitCode::from(status.code().and_then(|code| u8::try_from(code).ok()).unwrap_or(1)),
        Err(error) => {
            eprintln!("cannot start cargo to run the runner of the proofs: {error}");
            ExitCode::FAILURE
        }
    }
}
