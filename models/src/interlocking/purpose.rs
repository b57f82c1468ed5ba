//! What a model of a station with trains is there to show.

use super::state::Harm;

/// What a model is there to show.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Purpose {
    /// There is no accident and no wrong output; and these are seen.
    Safe(&'static [Sight]),
    /// The same, and from every state all trains can still arrive.
    Finishes(&'static [Sight]),
    /// There is this accident, and each of these assumptions or requirements excludes it.
    Accident(Harm, &'static [&'static str]),
}

/// What must be seen, so that a model is not empty.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Sight {
    /// Every train arrives.
    Arrived,
    /// Two trains of opposite ways stand at their signals in the station.
    Meet,
    /// A route fails: a point does not arrive in its time.
    Failed,
    /// The release time of a withdrawn route runs while a train is on its approach.
    Releasing,
    /// A train runs past a signal that has fallen, into a route that is being released.
    RunsPast,
    /// A part of a route is released behind its train and held by the next route.
    BehindTheFirst,
    /// An overlap is given up while the train stands before it.
    OverlapGivenUp,
    /// A segment is turned away after a train has come in from it.
    Turned,
    /// A train slides past its signal.
    Slides,
    /// A circuit with a train is not reported.
    Unheard,
    /// A circuit is blocked under a train.
    BlockedUnderTrain,
    /// A block is confirmed while a train is in the station.
    ConfirmedAhead,
    /// A restriction lowers the speed code of a telegram.
    Restricted,
    /// A train has a telegram over two circuits or more.
    Telegram,
    /// Not every train can arrive any more, whatever is requested.
    Filled,
    /// A train is on plain line that has no direction.
    NoDirection,
    /// A train that was called on is in a circuit with another one.
    Shared,
}
