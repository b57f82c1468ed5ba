//! Distance: metres in plans and telegrams, decimetres in tables, millimetres from the odometer.

/// A length in metres, 0 to 65 535.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Metres(pub u16);

/// A length in millimetres, 0 to 4 294 967 295 (4295 km).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Millimetres(pub u32);

impl Metres {
    /// The same length in millimetres.
    pub const fn millimetres(self) -> Millimetres {
        Millimetres(self.0 as u32 * 1000)
    }
}

impl Millimetres {
    /// The whole metres in it; 65 535 if there are more.
    #[inline]
    pub const fn whole_metres(self) -> Metres {
        let metres = self.0 / 1000;
        if metres > 0xFFFF {
            return Metres(0xFFFF);
        }
        let bytes = metres.to_le_bytes();
        Metres(u16::from_le_bytes([bytes[0], bytes[1]]))
    }

    /// What is left after `other` is taken off; 0 if `other` is longer.
    #[must_use]
    pub const fn less(self, other: Self) -> Self {
        Self(self.0.saturating_sub(other.0))
    }

    /// The sum; the longest length if it does not fit.
    #[must_use]
    pub const fn and(self, other: Self) -> Self {
        Self(self.0.saturating_add(other.0))
    }
}
