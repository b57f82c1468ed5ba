//! What a model of the train control signal is there to show.

/// What a model is there to show.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Purpose {
    /// The permitted speed is never above what the ground allows; and these are seen.
    Safe(&'static [Sight]),
    /// It is, and each of these assumptions or requirements excludes it.
    Hazard(&'static [&'static str]),
}

/// What must be seen, so that a model is not empty.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Sight {
    /// The train runs on the pattern, faster than the worst limit and gradient would let it.
    Pattern,
    /// Telegrams are missing, and the last pattern runs down.
    RunsDown,
    /// Telegrams are missing for too long, and the train stands.
    Starved,
    /// It runs on the pattern again after that.
    Recovers,
    /// It runs on codes alone again, after an analog line and a digital one.
    Crosses,
    /// It runs at the restriction, after it was faster in the same section.
    Restricted,
    /// It still runs on a point that was withdrawn as long ago as the ground allows for.
    OldPoint,
    /// It uses a telegram that the transmitter repeats.
    Repeated,
    /// It uses one whose number is the counter's range further on than that of the next one.
    Wrapped,
    /// It still runs on a limit that was restricted as long ago as the ground allows for.
    OldLimit,
    /// It runs to the stopping point and stands there.
    Arrives,
    /// The conventional train runs at the highest speed.
    Conventional,
}
