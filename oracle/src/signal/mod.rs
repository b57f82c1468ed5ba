//! `oracle signal`: the train control signal as a WAV file, made from a configuration and read back to telegrams and
//! speeds; and the link budget of a line.

mod budget;
mod config;
mod decode;
mod generate;

pub use budget::{BudgetReport, Link, Parameter, SectionMargin, budget};
pub use config::{Config, Line};
pub use decode::decode;
pub use generate::generate;

/// Why a signal is not made or read.
#[derive(Debug)]
pub enum SignalError {
    /// The configuration breaks a rule: in a sentence.
    Config(String),
    /// The recording cannot be read or written: the file, and why.
    Recording(String),
    /// The lines cannot be written.
    Output(std::io::Error),
}
