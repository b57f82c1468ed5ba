//! What happens in a run.

use serde::Serialize;

use crate::fault::Kind;
use crate::line::Bound;

/// Something that happened, and when.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Event {
    /// The time since the start, in ms.
    pub at_ms: u64,
    /// What.
    #[serde(flatten)]
    pub what: What,
}

/// What happened.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(tag = "event", rename_all = "kebab-case")]
pub enum What {
    /// A train came to a stand at a track of a station.
    Arrived { train: usize, station: String, track: String },
    /// A train leaves a track of a station.
    Left { train: usize, station: String, bound: Bound },
    /// A route was accepted.
    Set { station: String, route: String },
    /// A signal went to proceed.
    Proceed { station: String, signal: String, route: String },
    /// A signal went to stop.
    Stop { station: String, signal: String, route: String },
    /// A line has a direction.
    Turned { line: usize, bound: Bound },
    /// The device of a train brakes, and the train moves.
    Braked { train: usize, emergency: bool, along_m: f64 },
    /// The same device without the interruption would not have braked.
    NeedlesslyBraked { train: usize, along_m: f64 },
    /// A fault begins.
    Fault { kind: Kind, at: String, lasts_ms: f64 },
    /// Two trains are on the same ground.
    Collision { train: usize, with: usize, circuit: String },
    /// A train ran over a point that did not stand for it.
    Derailment { train: usize, point: String },
    /// A point began to move under a train.
    MovedUnder { train: usize, point: String },
    /// A train ran into a circuit for which it had no authority.
    Overrun { train: usize, circuit: String },
    /// A train ran over the end of the track.
    EndOfTrack { train: usize },
}

impl What {
    /// Whether this is an accident, or a train past the point where it had to stop.
    pub const fn is_unsafe(&self) -> bool {
        matches!(
            self,
            Self::Collision { .. }
                | Self::Derailment { .. }
                | Self::MovedUnder { .. }
                | Self::Overrun { .. }
                | Self::EndOfTrack { .. }
        )
    }
}
