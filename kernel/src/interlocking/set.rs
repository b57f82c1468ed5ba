//! Numbers of circuits, points, routes and segments, and sets of them.

/// A numbered thing of a layout and a set of such things, a bit for each.
macro_rules! numbered {
    ($id:ident, $set:ident, $bits:ident, $width:literal, $thing:literal) => {
        #[doc = concat!("The number of a ", $thing, ", in the order of the layout.")]
        #[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
        pub struct $id(u8);

        impl $id {
            #[doc = concat!("The ", $thing, " number `number`; `None` from ", stringify!($width), " on.")]
            pub const fn new(number: u8) -> Option<Self> {
                if number < $width { Some(Self(number)) } else { None }
            }

            #[doc = concat!("The first ", $thing, ".")]
            pub const ZERO: Self = Self(0);

            #[doc = concat!("The number, 0 to ", stringify!($width), " − 1.")]
            pub const fn number(self) -> u8 {
                self.0
            }

            #[doc = concat!("The set of this ", $thing, " alone.")]
            pub const fn alone(self) -> $set {
                $set(1 << (self.0 & ($width - 1)))
            }
        }

        #[doc = concat!("A set of ", $thing, "s: bit `i` stands for ", $thing, " `i`. Up to ", stringify!($width), ".")]
        #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
        pub struct $set($bits);

        impl $set {
            #[doc = concat!("No ", $thing, ".")]
            pub const EMPTY: Self = Self(0);

            #[doc = concat!("Every ", $thing, " that there can be.")]
            pub const ALL: Self = Self($bits::MAX);

            /// The set with these bits. Every value is a set.
            pub const fn from_bits(bits: $bits) -> Self {
                Self(bits)
            }

            /// The bits.
            pub const fn bits(self) -> $bits {
                self.0
            }

            /// Whether there is nothing in the set.
            pub const fn is_empty(self) -> bool {
                self.0 == 0
            }

            #[doc = concat!("Whether there is exactly one ", $thing, " in the set.")]
            pub const fn is_one(self) -> bool {
                self.0 != 0 && self.0 & (self.0 - 1) == 0
            }

            #[doc = concat!("The set of ", $thing, " `number` alone; empty if there can be none of that number.")]
            pub const fn nth(number: usize) -> Self {
                Self(if number < $width { 1 << number } else { 0 })
            }

            /// Whether it is in the set.
            pub const fn has(self, id: $id) -> bool {
                self.meets(id.alone())
            }

            /// Whether the two have something in common.
            pub const fn meets(self, other: Self) -> bool {
                self.0 & other.0 != 0
            }

            /// Whether all of `other` is in this set.
            pub const fn contains(self, other: Self) -> bool {
                other.0 & !self.0 == 0
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

            /// This set if `wanted`, else nothing.
            #[must_use]
            pub const fn only_if(self, wanted: bool) -> Self {
                if wanted { self } else { Self(0) }
            }

            /// The lowest number of the set; `None` if it is empty.
            pub const fn first(self) -> Option<$id> {
                $id::new(self.0.trailing_zeros().to_le_bytes()[0])
            }
        }
    };
}

numbered!(CircuitId, CircuitSet, u64, 64, "track circuit");
numbered!(PointId, PointSet, u32, 32, "point");
numbered!(RouteId, RouteSet, u64, 64, "route");
numbered!(SegmentId, SegmentSet, u8, 8, "segment");

/// Points, and the position that each is needed in or stands in.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub struct Positions {
    /// The points in normal position.
    pub normal: PointSet,
    /// The points in reverse position.
    pub reverse: PointSet,
}

/// A position of a point.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Position {
    /// The position that the plan calls normal.
    Normal,
    /// The other one.
    Reverse,
}

impl Positions {
    /// No point.
    pub const NONE: Self = Self { normal: PointSet::EMPTY, reverse: PointSet::EMPTY };

    /// One point in one position.
    pub const fn of(point: PointId, position: Position) -> Self {
        match position {
            Position::Normal => Self { normal: point.alone(), reverse: PointSet::EMPTY },
            Position::Reverse => Self { normal: PointSet::EMPTY, reverse: point.alone() },
        }
    }

    /// The points, whatever their position.
    pub const fn points(self) -> PointSet {
        self.normal.or(self.reverse)
    }

    /// Those of both.
    #[must_use]
    pub const fn or(self, other: Self) -> Self {
        Self { normal: self.normal.or(other.normal), reverse: self.reverse.or(other.reverse) }
    }

    /// These if `wanted`, else none.
    #[must_use]
    pub const fn only_if(self, wanted: bool) -> Self {
        Self { normal: self.normal.only_if(wanted), reverse: self.reverse.only_if(wanted) }
    }

    /// These without the points of `points`.
    #[must_use]
    pub const fn without(self, points: PointSet) -> Self {
        Self { normal: self.normal.without(points), reverse: self.reverse.without(points) }
    }

    /// These as far as their points are in `points`.
    #[must_use]
    pub const fn only_among(self, points: PointSet) -> Self {
        Self { normal: self.normal.and(points), reverse: self.reverse.and(points) }
    }

    /// Those that are not in the same position in `other`.
    #[must_use]
    pub const fn missing_in(self, other: Self) -> Self {
        Self { normal: self.normal.without(other.normal), reverse: self.reverse.without(other.reverse) }
    }

    /// Whether a point is here in one position and in `other` in the opposite one.
    pub const fn opposes(self, other: Self) -> bool {
        self.normal.meets(other.reverse) || self.reverse.meets(other.normal)
    }

    /// Whether there is no point here.
    pub const fn is_empty(self) -> bool {
        self.normal.is_empty() && self.reverse.is_empty()
    }
}
