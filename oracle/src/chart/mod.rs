//! Timing charts: what a case looks like over time, and how that is written out.
//!
//! A machine lays its case out as a [`Scene`]; [`svg()`] draws scenes and [`vcd()`] writes them for waveform viewers.
//! Time is counted in logic cycles. An input is drawn over the cycle in which it was read, `[k, k+1)`; an output
//! stands from the end of that cycle on, `[k+1, k+2)`. So every drawn span has its true length.

pub mod aspect;
pub mod block;
mod distance;
mod draw;
pub mod figure;
mod ink;
pub mod interlocking;
pub mod pattern;
pub mod permitted;
mod plot;
pub mod position;
mod record;
pub(crate) mod scene;
mod series;
pub mod supervision;
pub mod telegram;
pub mod train;
mod value;
mod view;
mod wave;
pub mod wayside;

use crate::trace::Trace;
use crate::trace::error::{Replies, TraceError};

pub use scene::{Lane, Mark, Scale, Scene, Sign, Signal, Tone, Unit, Values};
pub use view::{Part, View};

/// The timing chart of a trace as an SVG document, its cases one below the other.
///
/// # Errors
/// As [`Trace::scenes`], and if the view shows no cycle of some case.
pub fn svg(trace: &Trace, replies: Replies, view: &View) -> Result<String, TraceError> {
    draw::svg(&trace.scenes(replies)?, view)
}

/// The signals of a trace in the Value Change Dump format, a scope for each case; the states carry their names.
///
/// # Errors
/// As [`Trace::scenes`].
pub fn vcd(trace: &Trace, replies: Replies) -> Result<String, TraceError> {
    wave::vcd(&trace.scenes(replies)?)
}
