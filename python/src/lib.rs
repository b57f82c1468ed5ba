//! The kernel as a Python module: the part in Rust, `atc._atc`. The package around it is in `python/atc`.
//!
//! * `Conversation`: any machine of the protocol, a line of JSON in and a line out, as over the pipe of `oracle serve`.
//! * `columns`: many cycles of one machine at once, from arrays of numbers into arrays of numbers.
//!
//! Nothing here decides anything. It calls the oracle and the kernel.
//!
//! # In the house
//!
//! Uses `atc-kernel`, `atc-line`, `atc-protocol`. Used by no other crate of the house. Begin with
//! `python/atc/__init__.py`.

use pyo3::prelude::*;

mod columns;
mod conversation;

use conversation::Conversation;

/// The module `atc._atc`.
#[pymodule]
mod _atc {
    #[pymodule_export]
    use super::Conversation;
    #[pymodule_export]
    use super::columns::{AspectColumns, BlockColumns, PatternColumns};
    #[pymodule_export]
    use super::conversation::{machines, schema};

    #[pymodule_export]
    const PROTOCOL: u32 = atc_protocol::form::PROTOCOL;
}
