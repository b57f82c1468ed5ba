//! What happens in a run.

use serde::Serialize;

use crate::bound::Bound;
use crate::fault::Kind;

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
    Arrived {
        /// The number of the train.
        train: usize,
        /// The name of the station.
        station: String,
        /// The name of the track.
        track: String,
    },
    /// A train leaves a track of a station.
    Left {
        /// The number of the train.
        train: usize,
        /// The name of the station.
        station: String,
        /// The direction.
        bound: Bound,
    },
    /// A route was accepted.
    Set {
        /// The name of the station.
        station: String,
        /// The name of the route.
        route: String,
    },
    /// A signal went to proceed.
    Proceed {
        /// The name of the station.
        station: String,
        /// The name of the signal.
        signal: String,
        /// The name of the route.
        route: String,
    },
    /// A signal went to stop.
    Stop {
        /// The name of the station.
        station: String,
        /// The name of the signal.
        signal: String,
        /// The name of the route.
        route: String,
    },
    /// A line has a direction.
    Turned {
        /// The number of the line, from the west.
        line: usize,
        /// The direction.
        bound: Bound,
    },
    /// The device of a train brakes, and the train moves.
    Braked {
        /// The number of the train.
        train: usize,
        /// Whether by the emergency brake.
        emergency: bool,
        /// Where the front is along the line, in m.
        along_m: f64,
    },
    /// The same device without the interruption would not have braked.
    NeedlesslyBraked {
        /// The number of the train.
        train: usize,
        /// Where the front is along the line, in m.
        along_m: f64,
    },
    /// A fault begins.
    Fault {
        /// What fails.
        kind: Kind,
        /// Where.
        at: String,
        /// For how long, in ms.
        lasts_ms: f64,
    },
    /// Two trains are on the same ground.
    Collision {
        /// The number of the train.
        train: usize,
        /// The number of the other train.
        with: usize,
        /// The circuit.
        circuit: String,
    },
    /// A train ran over a point that did not stand for it.
    Derailment {
        /// The number of the train.
        train: usize,
        /// The point.
        point: String,
    },
    /// A point began to move under a train.
    MovedUnder {
        /// The number of the train.
        train: usize,
        /// The point.
        point: String,
    },
    /// A train ran into a circuit for which it had no authority.
    Overrun {
        /// The number of the train.
        train: usize,
        /// The circuit.
        circuit: String,
    },
    /// A train runs faster than the track under it allows.
    Overspeed {
        /// The number of the train.
        train: usize,
        /// The circuit.
        circuit: String,
        /// Its speed in km/h.
        kmh: f64,
    },
    /// A train ran over the end of the track.
    EndOfTrack {
        /// The number of the train.
        train: usize,
    },
}

impl What {
    /// Whether this is an accident, or a train past the point where it had to stop or faster than it may be.
    pub const fn is_unsafe(&self) -> bool {
        matches!(
            self,
            Self::Collision { .. }
                | Self::Derailment { .. }
                | Self::MovedUnder { .. }
                | Self::Overrun { .. }
                | Self::Overspeed { .. }
                | Self::EndOfTrack { .. }
        )
    }
}
