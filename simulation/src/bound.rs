//! The two directions along a line.

use serde::{Deserialize, Serialize};

/// West or east: the direction of a train along the line.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Bound {
    /// Towards the first station.
    West,
    /// Towards the last station.
    East,
}

impl Bound {
    /// The other one.
    #[must_use]
    pub const fn other(self) -> Self {
        match self {
            Self::West => Self::East,
            Self::East => Self::West,
        }
    }

    /// 0 for west, 1 for east.
    pub const fn side(self) -> usize {
        match self {
            Self::West => 0,
            Self::East => 1,
        }
    }
}
