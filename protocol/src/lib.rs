//! Protocol 1: the machines of the kernel as values on a wire.
//!
//! * [`form`]: the forms of a line, requests and replies.
//! * [`machine`]: what each machine reads and puts out, how that becomes the kernel's own types, and the other way round.
//! * [`devices`]: the devices of a line's file, each as the configuration of its machine; whether the kernel takes them.
//! * [`Session`]: request lines in, reply lines out, one for one.
//! * [`schema`]: the JSON Schema of all of it, generated from the types.
//!
//! Nothing here reads a file, a clock or a socket: it also runs where there is none of them, in a browser.
//!
//! # In the house
//!
//! Uses `atc-kernel`, `atc-layout`, `atc-line`. Used by `atc-adversary`, `atc-commands`, `atc-evidence`, `atc-fmi`,
//! `atc-models`, `atc-oracle`, `atc-python`, `atc-tests`, `atc-wasm`. Begin with [`Session`] and [`machine`].

pub mod devices;
pub mod form;
pub mod machine;
pub mod names;
pub mod schema;
mod sections;
mod session;
pub mod telegrams;

pub use atc_line::decimal::{self, Decibels, Metres};
pub use atc_line::kmh::{self, Kmh, KmhError};
pub use sections::Sections;
pub use session::{MAX_LINE, Session};
