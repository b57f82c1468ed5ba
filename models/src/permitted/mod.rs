//! Models of the train control signal on board: a train, two kinds of line, telegrams that are lost, late or repeated, and the
//! kernel's permitted speed (`atc_kernel::permitted`, with `telegram::Sequence` inside) against what the ground allows.
//!
//! | module | what is in it |
//! |---|---|
//! | [`layout`] | sections, stopping points, and what the ground allows: arithmetic of its own, none of the kernel's |
//! | [`device`] | the train's device: the kernel's, a conventional one, and a wrong one |
//! | [`ride`] | the model: ground, channel and train |
//! | `state` | what it remembers |
//! | `environment` | what may happen in it |
//! | `purpose` | what it is there to show |
//! | `claims` | what is claimed of it |
//! | `trace` | a path as a run of the kernel |

mod claims;
pub mod device;
mod environment;
pub mod layout;
mod purpose;
pub mod ride;
mod state;
mod trace;

pub use purpose::{Purpose, Sight};
