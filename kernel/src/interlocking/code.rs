//! Speed codes of the ATC telegrams.

/// The most speed codes: 0 is stop, 1 to 7 are speeds.
pub const MAX_CODES: usize = 8;

/// A speed code of the ATC telegrams: 0 is stop, a higher one is a higher speed.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct SpeedCode(pub u8);

impl SpeedCode {
    /// No speed.
    pub const STOP: Self = Self(0);

    /// The highest code that there can be.
    pub const MOST: Self = Self(7);

    /// The lower of the two.
    #[must_use]
    pub const fn or_lower(self, other: Self) -> Self {
        if other.0 < self.0 { other } else { self }
    }
}
