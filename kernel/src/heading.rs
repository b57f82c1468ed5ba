//! The direction of travel, which the ground and a train must mean alike.

/// A direction of travel: towards the ends of circuits that the layout calls left, or right.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Heading {
    /// Towards the left.
    Left,
    /// Towards the right.
    Right,
}

impl Heading {
    /// The other direction.
    #[must_use]
    pub const fn opposite(self) -> Self {
        match self {
            Self::Left => Self::Right,
            Self::Right => Self::Left,
        }
    }
}
