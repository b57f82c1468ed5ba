//! Sections of a block, sets of them, and the two numbers that are passed about: trains and held sections.

/// The most sections that a block may have.
pub const MAX_SECTIONS: u8 = 16;

/// A set of sections, a bit for each: bit 0 is the section at the entry end.
///
/// As a report of what is occupied, a set that contains another is the safer one ([`SectionSet::contains_all`]).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub struct SectionSet(u16);

impl SectionSet {
    /// No section.
    pub const EMPTY: Self = Self(0);

    /// Every section that a block can have.
    pub const ALL: Self = Self(u16::MAX);

    /// The set with bit `i` standing for section `i`. Every value is a set.
    pub const fn from_bits(bits: u16) -> Self {
        Self(bits)
    }

    /// The bits, section 0 (at the entry end) the lowest.
    pub const fn bits(self) -> u16 {
        self.0
    }

    /// The `count` sections next to the entry end; all 16 from 16 on.
    #[cfg_attr(kani, kani::ensures(|set| set.0 & set.0.wrapping_add(1) == 0))]
    #[cfg_attr(kani, kani::ensures(|set| set.0.count_ones() == if count >= 16 { 16 } else { count as u32 }))]
    pub const fn first(count: u8) -> Self {
        // At most 16 bits are set, so the low half has them all.
        Self(if count >= MAX_SECTIONS { u16::MAX } else { (1 << count) - 1 })
    }

    /// Whether section `section` is in the set; false from 16 on.
    pub const fn contains(self, section: u8) -> bool {
        section < MAX_SECTIONS && self.0 >> section & 1 == 1
    }

    /// Whether every section of `other` is in this set: as a report, this one is at least as safe.
    pub const fn contains_all(self, other: Self) -> bool {
        other.0 & !self.0 == 0
    }

    /// How many sections are in the set, 0 to 16.
    pub const fn len(self) -> u8 {
        self.0.count_ones().to_le_bytes()[0]
    }

    /// Whether no section is in the set.
    pub const fn is_empty(self) -> bool {
        self.0 == 0
    }

    /// The section of the set that is next to the entry end; 16 if there is none.
    pub const fn nearest_to_entry(self) -> u8 {
        self.0.trailing_zeros().to_le_bytes()[0]
    }

    /// What is in one or the other.
    #[must_use]
    pub const fn or(self, other: Self) -> Self {
        Self(self.0 | other.0)
    }

    /// What is in both.
    #[must_use]
    pub const fn and(self, other: Self) -> Self {
        Self(self.0 & other.0)
    }

    /// What is here and not in `other`.
    #[must_use]
    pub const fn without(self, other: Self) -> Self {
        Self(self.0 & !other.0)
    }

    /// The set, and with each section the `hold` sections behind it, on the side of the entry.
    #[must_use]
    #[cfg_attr(kani, kani::ensures(|held| held.0 & self.0 == self.0 && held.0.leading_zeros() >= self.0.leading_zeros()))]
    #[cfg_attr(kani, kani::ensures(|held| hold.0 > 0 || held.0 == self.0))]
    pub const fn with_sections_behind(self, hold: Hold) -> Self {
        // Each round at most doubles what is held behind a section: 1, 3, 7, 15.
        let mut held = self.0;
        let mut left = hold.0;
        let mut most = 1;
        while most < MAX_SECTIONS {
            let more = if left < most { left } else { most };
            held |= held >> more;
            left = left.saturating_sub(more);
            most <<= 1;
        }
        Self(held)
    }

    /// The set seen from the other end of a block of `sections` sections: section `i` becomes `sections − 1 − i`.
    #[must_use]
    #[cfg_attr(kani, kani::ensures(|other| other.0.count_ones() <= self.0.count_ones()))]
    #[cfg_attr(kani, kani::ensures(|other| sections >= 16 || other.0 >> sections == 0))]
    pub const fn reversed(self, sections: u8) -> Self {
        let beyond = MAX_SECTIONS.saturating_sub(sections) as u32;
        Self(if beyond >= 16 { 0 } else { self.0.reverse_bits() >> beyond })
    }
}

/// A number of consecutive sections that are held occupied behind a head, 0 to 16.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Hold(u8);

impl Hold {
    /// No section is held.
    pub const NONE: Self = Self(0);

    /// The most that can be held: 16 sections.
    pub const MOST: Self = Self(MAX_SECTIONS);

    /// A hold of `sections` sections; `None` over 16.
    pub const fn new(sections: u8) -> Option<Self> {
        if sections <= MAX_SECTIONS { Some(Self(sections)) } else { None }
    }

    /// How many sections are held, 0 to 16.
    pub const fn sections(self) -> u8 {
        self.0
    }

    /// What is left of the hold `sections` sections further on; none if it does not reach so far.
    #[must_use]
    pub const fn beyond(self, sections: u8) -> Self {
        Self(self.0.saturating_sub(sections))
    }

    /// The longer of the two.
    #[must_use]
    pub const fn or_longer(self, other: Self) -> Self {
        if self.0 >= other.0 { self } else { other }
    }
}

/// A number of trains. Anything from 0 to 255 may be claimed; a block counts to 16 at most.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct TrainCount(pub u8);
