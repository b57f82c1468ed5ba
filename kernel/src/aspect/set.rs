//! Sets of aspects, and the one that is displayed.

use super::MAX_ASPECTS;

/// One aspect: its rank by permitted speed, 0 the lowest, at most 15.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct AspectId(u8);

impl AspectId {
    /// The aspect of rank `rank`; `None` from 16 on.
    pub const fn new(rank: u8) -> Option<Self> {
        if (rank as usize) < MAX_ASPECTS { Some(Self(rank)) } else { None }
    }

    /// The rank, 0 to 15.
    pub const fn rank(self) -> u8 {
        self.0
    }
}

/// A set of aspects, a bit for each rank.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub struct AspectSet(u16);

impl AspectSet {
    /// No aspect.
    pub const EMPTY: Self = Self(0);

    /// The set with bit `rank` standing for the aspect of that rank. Every value is a set.
    pub const fn from_bits(bits: u16) -> Self {
        Self(bits)
    }

    /// The bits, rank 0 the lowest.
    pub const fn bits(self) -> u16 {
        self.0
    }

    /// The set and `aspect`.
    #[must_use]
    pub const fn with(self, aspect: AspectId) -> Self {
        Self(self.0 | 1 << aspect.0)
    }

    /// Whether `aspect` is in the set.
    pub const fn contains(self, aspect: AspectId) -> bool {
        self.0 >> aspect.0 & 1 == 1
    }

    /// Whether no aspect is in the set.
    pub const fn is_empty(self) -> bool {
        self.0 == 0
    }

    /// The lowest aspect of the set, as a set of one; empty if the set is.
    #[must_use]
    #[cfg_attr(kani, kani::ensures(|low| low.0 & self.0 == low.0 && low.0.count_ones() <= 1))]
    #[cfg_attr(kani, kani::ensures(|low| low.0.wrapping_sub(1) & self.0 == 0 || self.0 == 0))]
    pub const fn lowest(self) -> Self {
        Self(self.0 & self.0.wrapping_neg())
    }

    /// Every aspect higher than the lowest of the set; empty if the set is.
    #[must_use]
    pub const fn above_lowest(self) -> Self {
        let low = self.lowest().0;
        Self(!(low | low.wrapping_sub(1)))
    }

    /// Every aspect lower than the highest of the set; empty if the set is.
    #[must_use]
    pub const fn below_highest(self) -> Self {
        let mut bits = self.0 >> 1;
        bits |= bits >> 1;
        bits |= bits >> 2;
        bits |= bits >> 4;
        bits |= bits >> 8;
        Self(bits)
    }

    /// What is in both.
    pub(super) const fn and(self, other: Self) -> Self {
        Self(self.0 & other.0)
    }

    /// What is in one or the other.
    pub(super) const fn or(self, other: Self) -> Self {
        Self(self.0 | other.0)
    }

    /// What is here and not in `other`.
    pub(super) const fn without(self, other: Self) -> Self {
        Self(self.0 & !other.0)
    }
}

/// What the cab signal shows: one aspect, or nothing, which means stop.
///
/// Ordered by what it permits: nothing is the lowest, and a lower display is the safer one. Kept as a set of at
/// most one, so that the order is the order of the bits.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Display(u16);

impl Display {
    /// Nothing is displayed: stop.
    pub const NOTHING: Self = Self(0);

    /// `aspect` is displayed.
    pub const fn of(aspect: AspectId) -> Self {
        Self(1 << aspect.0)
    }

    /// The aspect that is displayed, if one is.
    pub const fn aspect(self) -> Option<AspectId> {
        if self.0 == 0 {
            None
        } else {
            // At most 15, as the value is not 0.
            Some(AspectId(self.0.trailing_zeros().to_le_bytes()[0]))
        }
    }

    /// The lowest of `set`.
    pub(super) const fn lowest_of(set: AspectSet) -> Self {
        Self(set.lowest().0)
    }

    /// The display with these bits: a set of at most one is a display, anything else the trace of a fault.
    pub const fn from_bits(bits: u16) -> Self {
        Self(bits)
    }

    /// A bit for the aspect displayed.
    pub const fn bits(self) -> u16 {
        self.0
    }

    /// Whether at most one aspect is displayed.
    pub const fn is_valid(self) -> bool {
        self.0 & self.0.wrapping_sub(1) == 0
    }
}
