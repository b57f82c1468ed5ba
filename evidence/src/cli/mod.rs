//! The commands.

mod budget;
mod checkout;
mod engines;
mod imported;
pub mod live;
mod merge;
mod options;
pub mod progress;
pub mod prover;
mod render;
mod run;
mod suites;
pub mod times;

pub use options::Cli;
use options::Command;

/// Exit code for a bad command line, configuration or source of the case.
pub const USAGE: u8 = 2;

/// Does what the command line says and returns the exit code: 0, 1 (the evidence says no) or 2 (bad input).
pub fn main(cli: Cli) -> u8 {
    let result = match cli.command {
        Command::Run(options) => run::run(&options),
        Command::Merge(options) => merge::merge(&options),
        Command::Compare { one, other } => merge::compare(&one, &other),
        Command::Render { from, layout, out, root } => {
            render::render(&from, layout.as_deref(), out.as_deref(), root.as_deref())
        }
        Command::Verify { folder, models, root } => render::verify(&folder, models, root.as_deref()),
        Command::Schema => {
            print!("{}", crate::render::output::schema());
            Ok(0)
        }
    };
    result.unwrap_or_else(|faults| {
        for fault in faults {
            eprintln!("error: {fault}");
        }
        USAGE
    })
}
