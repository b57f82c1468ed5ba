//! `fmu --config CONFIG.json -o onboard.fmu`: packs the on-board device with a configuration.

use std::fmt::Display;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

use atc_fmi::{config, package};
use clap::Parser;

/// Packs the on-board device as an FMI 3.0 co-simulation unit.
///
/// The library is the one that was built with this program and lies beside it.
#[derive(Parser)]
#[command(name = "fmu", version)]
struct Args {
    /// The configuration: that of the machine `train` of protocol 1, as JSON. `{}` takes every default.
    #[arg(long, value_name = "FILE")]
    config: PathBuf,
    /// The unit to write.
    #[arg(short, long, value_name = "FILE")]
    output: PathBuf,
    /// The library to pack, in place of the one beside this program.
    #[arg(long, value_name = "FILE")]
    library: Option<PathBuf>,
}

fn main() -> ExitCode {
    match pack(&Args::parse()) {
        Ok(()) => ExitCode::SUCCESS,
        Err(what) => {
            eprintln!("fmu: {what}");
            ExitCode::from(2)
        }
    }
}

fn pack(args: &Args) -> Result<(), String> {
    let said = |path: &Path, error: &dyn Display| format!("{}: {error}", path.display());
    let size = fs::metadata(&args.config).map_err(|error| said(&args.config, &error))?.len();
    if size > config::LONGEST {
        let longest = config::LONGEST;
        return Err(said(&args.config, &format!("it has {size} bytes; a config has at most {longest}")));
    }
    let text = fs::read(&args.config).map_err(|error| said(&args.config, &error))?;
    let (_, cycle_ms) = config::device(&text).map_err(|what| said(&args.config, &what))?;
    let library = if let Some(library) = &args.library {
        library.clone()
    } else {
        let program = std::env::current_exe().map_err(|error| format!("where this program lies: {error}"))?;
        program.with_file_name(package::library())
    };
    let bytes = fs::read(&library).map_err(|error| {
        said(&library, &format!("{error}; it is built with this program: cargo build --release -p atc-fmi"))
    })?;
    let unit = package::archive(&text, cycle_ms, &bytes).map_err(|error| said(&args.output, &error))?;
    atc_files::write(&args.output, &unit).map_err(|error| said(&args.output, &error))
}
