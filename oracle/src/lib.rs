//! The kernel as a reference oracle.
//!
//! * [`serve`]: JSON lines, protocol 1 — somebody else's implementation is stepped beside the kernel
//!   ([`atc_protocol`] has the forms, and what each machine reads and puts out).
//! * [`trace`] and [`chart`]: the timing chart (SVG, VCD) of a recorded session, checked against the kernel;
//!   [`drawn`] has the machines that are drawn.
//! * [`film`]: a recorded session, or a trace of a model, as a page that plays it.
//! * [`conform`]: another implementation against the kernel, down to the first difference; and vectors.
//! * [`replay`]: the logs of recorders against the kernel, in bulk.
//! * [`signal`]: the train control signal as a WAV file, made and read back.
//!
//! # In the house
//!
//! Uses `atc-files`, `atc-film`, `atc-film-kernel`, `atc-kernel`, `atc-layout`, `atc-line`, `atc-protocol`,
//! `atc-simulation`, `atc-waveform`. Used by `atc-adversary`, `atc-commands`, `atc-evidence`, `atc-tests`. Begin
//! with [`serve`].

pub mod chart;
pub mod conform;
pub mod drawn;
pub mod film;
pub mod replay;
mod serve;
pub mod signal;
pub mod trace;

pub use serve::serve;
