//! What a model of ground, channel and train is there to show.

/// What a reception model is there to show.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Purpose {
    /// The exposure to a stale aspect keeps a bound, and reaches it.
    Exposure(Bound),
    /// The exposure outlives a bound that holds under the assumptions named.
    Outlives {
        /// The bound.
        bound: Bound,
        /// Each of these excludes it.
        excluded_by: &'static [&'static str],
        /// In the display of which, and how.
        text: &'static str,
        /// The bound that still holds, if there is one.
        still: Option<Bound>,
    },
    /// The lowest aspect is sent all the time, and nothing higher is displayed once it has been.
    Restrictive,
    /// The lowest aspect is sent all the time, and a higher one that is misread is displayed.
    Misread,
}

/// A bound on the exposure: whole cycles in which an aspect may be displayed without the ground sending it or a
/// higher one. One cycle more, and the display has changed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Bound {
    /// A change to another aspect is heard at once, for T1: min(T1, T2+T3) − 1.
    Heard,
    /// Bursts shorter than T5: T2+T3 − 1, and a burst more: T2+T3 + T5 − 2.
    ShortBursts,
    /// Bursts shorter than T1, more than T4 apart: one may re-accept the aspect: T4 + (T1 − 1) + T2+T3 − 1.
    SpacedBursts,
}
