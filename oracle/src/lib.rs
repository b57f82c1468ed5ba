//! The kernel as a reference oracle.
//!
//! * [`serve`]: JSON lines, protocol 1 — somebody else's implementation is stepped beside the kernel
//!   ([`protocol`] for the forms, [`machine`] for what each machine reads and puts out).
//! * [`trace`] and [`chart`]: the timing chart (SVG, VCD) of a recorded session, checked against the kernel.
//! * [`film`]: a recorded session, or a trace of a model, as a page that plays it.
//! * [`conform`]: another implementation against the kernel, down to the first difference; and vectors.
//! * [`replay`]: the logs of recorders against the kernel, in bulk.
//! * [`signal`]: the train control signal as a WAV file, made and read back.
//! * [`schema`]: the JSON Schema of the protocol, generated from the types.

pub mod chart;
pub mod conform;
pub mod film;
pub mod machine;
mod names;
pub mod protocol;
pub mod replay;
pub mod schema;
mod sections;
mod serve;
mod session;
pub mod signal;
pub mod telegrams;
pub mod trace;

pub use atc_line::decimal::{self, Decibels, Metres};
pub use atc_line::kmh::{self, Kmh, KmhError};
pub use sections::Sections;
pub use serve::serve;
pub use session::{MAX_LINE, Session};
