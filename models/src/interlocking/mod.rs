//! Models of the interlocking: trains, points, dispatchers and staff on small stations, with the kernel's machine
//! `atc_kernel::interlocking` against the ground truth.
//!
//! | module | what is in it |
//! |---|---|
//! | [`ground`] | the tracks as they really are: circuits, points, signals; arithmetic of its own, none of the kernel's |
//! | `sizes` | how large a station may be |
//! | [`stations`] | a passing loop, a junction, a crossing, a terminus, and their layouts |
//! | [`device`] | the machine in a model |
//! | [`environment`] | what may happen |
//! | [`train`] | how trains move |
//! | [`yard`] | the model: trains, points, requests, and the kernel |
//! | `state` | what it remembers |
//! | `purpose` | what a model is there to show |
//! | `claims` | what is claimed of it |
//! | `progress` | the states from which not every train can arrive any more |
//! | `trace` | a path as a run of the kernel |
//! | [`between`] | two stations, the line between them, and trains that go to and fro |
//! | [`neighbours`] | two stations that turn the line between them |
//! | [`counted`] | a station whose line is counted: block counting in front of the interlocking |
//! | [`counted_between`] | a counted line between two stations |

pub mod between;
mod claims;
pub mod counted;
pub mod counted_between;
pub mod device;
pub mod environment;
pub mod ground;
pub mod neighbours;
mod progress;
mod purpose;
mod sizes;
mod state;
pub mod stations;
pub(crate) mod trace;
pub mod train;
pub mod yard;

pub use purpose::{Purpose, Sight};
