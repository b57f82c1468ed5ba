//! Numbers of circuits, points, routes and segments, sets of them, and what there is of each.

use super::size::{Bits, Large, Size, Small, Value, Values};

/// A numbered thing of a layout and a set of such things, a bit for each.
macro_rules! numbered {
    ($id:ident, $set:ident, $bits:ident, $small:ident, $most:literal, $thing:literal) => {
        #[doc = concat!("The number of a ", $thing, ", in the order of the layout.")]
        #[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
        pub struct $id(u8);

        impl $id {
            #[doc = concat!("The ", $thing, " number `number`; `None` from ", $most, " on.")]
            pub const fn new(number: u8) -> Option<Self> {
                if (number as u16) < $most { Some(Self(number)) } else { None }
            }

            #[doc = concat!("The first ", $thing, ".")]
            pub const ZERO: Self = Self(0);

            #[doc = concat!("The number, 0 to ", $most, " − 1.")]
            pub const fn number(self) -> u8 {
                self.0
            }

            #[doc = concat!("The set of this ", $thing, " alone; empty if a station of this size has none of its number.")]
            #[inline]
            pub fn alone<Z: Size>(self) -> $set<Z> {
                $set::nth(usize::from(self.0))
            }
        }

        #[doc = concat!("A set of ", $thing, "s of a station: bit `i` stands for ", $thing, " `i`.")]
        #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
        pub struct $set<Z: Size = Small>(Z::$bits);

        impl<Z: Size> Default for $set<Z> {
            fn default() -> Self {
                Self::EMPTY
            }
        }

        impl $set<Small> {
            /// The set with these bits. Every value is a set.
            pub const fn from_bits(bits: $small) -> Self {
                Self(bits)
            }

            /// The bits.
            pub const fn bits(self) -> $small {
                self.0
            }
        }

        impl $set<Large> {
            /// The set with these bits, the lowest numbers in the first word. Every value is a set.
            pub const fn from_words(words: [$small; 4]) -> Self {
                Self(words)
            }

            /// The bits, the lowest numbers in the first word.
            pub const fn words(self) -> [$small; 4] {
                self.0
            }
        }

        impl<Z: Size> $set<Z> {
            #[doc = concat!("No ", $thing, ".")]
            pub const EMPTY: Self = Self(<Z::$bits as Bits>::NONE);

            #[doc = concat!("Every ", $thing, " that there can be.")]
            pub const ALL: Self = Self(<Z::$bits as Bits>::ALL);

            #[doc = concat!("How many ", $thing, "s there can be.")]
            pub const MOST: usize = <Z::$bits as Bits>::WIDTH;

            /// Whether there is nothing in the set.
            #[inline]
            pub fn is_empty(self) -> bool {
                self == Self::EMPTY
            }

            #[doc = concat!("Whether there is exactly one ", $thing, " in the set.")]
            #[inline]
            pub fn is_one(self) -> bool {
                self.0.is_one()
            }

            #[doc = concat!("The set of ", $thing, " `number` alone; empty if there can be none of that number.")]
            #[inline]
            pub fn nth(number: usize) -> Self {
                Self(Z::$bits::nth(number))
            }

            /// Whether it is in the set.
            #[inline]
            pub fn has(self, id: $id) -> bool {
                self.has_number(usize::from(id.number()))
            }

            #[doc = concat!("Whether ", $thing, " `number` is in the set.")]
            #[inline]
            pub fn has_number(self, number: usize) -> bool {
                self.0.has(number)
            }

            /// Whether the two have something in common.
            #[inline]
            pub fn meets(self, other: Self) -> bool {
                self.0.meets(other.0)
            }

            /// Whether all of `other` is in this set.
            #[inline]
            pub fn contains(self, other: Self) -> bool {
                other.without(self).is_empty()
            }

            /// What is in one or the other.
            #[inline]
            #[must_use]
            pub fn or(self, other: Self) -> Self {
                Self(self.0.or(other.0))
            }

            /// What is in both.
            #[inline]
            #[must_use]
            pub fn and(self, other: Self) -> Self {
                Self(self.0.and(other.0))
            }

            /// What is here and not in `other`.
            #[inline]
            #[must_use]
            pub fn without(self, other: Self) -> Self {
                Self(self.0.without(other.0))
            }

            /// This set if `wanted`, else nothing.
            #[inline]
            #[must_use]
            pub fn only_if(self, wanted: bool) -> Self {
                Self(self.0.only_if(wanted))
            }

            /// The lowest number of the set; `None` if it is empty.
            #[inline]
            pub fn first(self) -> Option<$id> {
                self.0.first().and_then(|number| $id::new(short(number)))
            }
        }
    };
}

/// One value for each thing of a layout that is numbered.
macro_rules! each {
    ($each:ident, $most:literal, $thing:literal) => {
        #[doc = concat!("One value for each ", $thing, " that there can be, in the order of their numbers.")]
        #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
        pub struct $each<T: Value, Z: Size = Small>(Z::$each<T>);

        impl<T: Value, Z: Size> $each<T, Z> {
            /// No value for any.
            pub const NONE: Self = Self(<Z::$each<T> as Values<T>>::NONE);

            /// The same value for each.
            #[inline]
            pub fn all(value: T) -> Self {
                Self::from_fn(|_| value)
            }

            /// A value for each number.
            #[inline]
            pub fn from_fn(value: impl FnMut(usize) -> T) -> Self {
                Self(Z::$each::from_fn(value))
            }

            #[doc = concat!("The value of ", $thing, " `number`; `None` if there can be none of that number.")]
            #[inline]
            pub fn get(&self, number: usize) -> Option<&T> {
                self.0.as_ref().get(number)
            }

            #[doc = concat!("The value of ", $thing, " `number`; `None` if there can be none of that number.")]
            #[inline]
            pub fn get_mut(&mut self, number: usize) -> Option<&mut T> {
                self.0.as_mut().get_mut(number)
            }

            /// The values.
            #[inline]
            pub fn iter(&self) -> core::slice::Iter<'_, T> {
                self.0.as_ref().iter()
            }

            /// The values, to be changed.
            #[inline]
            pub fn iter_mut(&mut self) -> core::slice::IterMut<'_, T> {
                self.0.as_mut().iter_mut()
            }
        }

        impl<T: Value> From<[T; $most]> for $each<T, Small> {
            fn from(values: [T; $most]) -> Self {
                Self(values)
            }
        }

        impl<T: Value, Z: Size> IntoIterator for $each<T, Z> {
            type Item = T;
            type IntoIter = <Z::$each<T> as IntoIterator>::IntoIter;

            fn into_iter(self) -> Self::IntoIter {
                self.0.into_iter()
            }
        }

        impl<'a, T: Value, Z: Size> IntoIterator for &'a $each<T, Z> {
            type Item = &'a T;
            type IntoIter = core::slice::Iter<'a, T>;

            fn into_iter(self) -> Self::IntoIter {
                self.iter()
            }
        }

        impl<'a, T: Value, Z: Size> IntoIterator for &'a mut $each<T, Z> {
            type Item = &'a mut T;
            type IntoIter = core::slice::IterMut<'a, T>;

            fn into_iter(self) -> Self::IntoIter {
                self.iter_mut()
            }
        }

        impl<T: Value, I: core::slice::SliceIndex<[T]>, Z: Size> core::ops::Index<I> for $each<T, Z> {
            type Output = I::Output;

            /// # Panics
            /// If there can be none of such a number.
            fn index(&self, numbers: I) -> &I::Output {
                &self.0.as_ref()[numbers]
            }
        }

        impl<T: Value, I: core::slice::SliceIndex<[T]>, Z: Size> core::ops::IndexMut<I> for $each<T, Z> {
            fn index_mut(&mut self, numbers: I) -> &mut I::Output {
                &mut self.0.as_mut()[numbers]
            }
        }
    };
}

numbered!(CircuitId, CircuitSet, Wide, u64, 256, "track circuit");
numbered!(PointId, PointSet, Middle, u32, 128, "point");
numbered!(RouteId, RouteSet, Wide, u64, 256, "route");
numbered!(SegmentId, SegmentSet, Narrow, u8, 32, "segment");
each!(PerCircuit, 64, "track circuit");
each!(PerPoint, 32, "point");

/// The number of a thing from its place in a list, of which there are 256 at most.
#[inline]
pub(crate) const fn short(place: usize) -> u8 {
    place.to_le_bytes()[0]
}

impl<Z: Size> CircuitSet<Z> {
    /// A check word with these bits in it: each changes exactly one bit of it.
    #[inline]
    pub(super) fn fold(self, check: u64) -> u64 {
        self.0.fold(check)
    }
}

impl<Z: Size> SegmentSet<Z> {
    /// A check word with these bits in it: each changes exactly one bit of it.
    #[inline]
    pub(super) fn fold(self, check: u64) -> u64 {
        self.0.fold(check)
    }
}

/// Points, and the position that each is needed in or stands in.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub struct Positions<Z: Size = Small> {
    /// The points in normal position.
    pub normal: PointSet<Z>,
    /// The points in reverse position.
    pub reverse: PointSet<Z>,
}

/// A position of a point.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Position {
    /// The position that the plan calls normal.
    Normal,
    /// The other one.
    Reverse,
}

impl<Z: Size> Positions<Z> {
    /// No point.
    pub const NONE: Self = Self { normal: PointSet::EMPTY, reverse: PointSet::EMPTY };

    /// One point in one position.
    pub fn of(point: PointId, position: Position) -> Self {
        match position {
            Position::Normal => Self { normal: point.alone(), reverse: PointSet::EMPTY },
            Position::Reverse => Self { normal: PointSet::EMPTY, reverse: point.alone() },
        }
    }

    /// The points, whatever their position.
    pub fn points(self) -> PointSet<Z> {
        self.normal.or(self.reverse)
    }

    /// Those of both.
    #[must_use]
    pub fn or(self, other: Self) -> Self {
        Self { normal: self.normal.or(other.normal), reverse: self.reverse.or(other.reverse) }
    }

    /// These if `wanted`, else none.
    #[must_use]
    pub fn only_if(self, wanted: bool) -> Self {
        Self { normal: self.normal.only_if(wanted), reverse: self.reverse.only_if(wanted) }
    }

    /// These without the points of `points`.
    #[must_use]
    pub fn without(self, points: PointSet<Z>) -> Self {
        Self { normal: self.normal.without(points), reverse: self.reverse.without(points) }
    }

    /// These as far as their points are in `points`.
    #[must_use]
    pub fn only_among(self, points: PointSet<Z>) -> Self {
        Self { normal: self.normal.and(points), reverse: self.reverse.and(points) }
    }

    /// Those that are not in the same position in `other`.
    #[must_use]
    pub fn missing_in(self, other: Self) -> Self {
        Self { normal: self.normal.without(other.normal), reverse: self.reverse.without(other.reverse) }
    }

    /// Whether a point is here in one position and in `other` in the opposite one.
    pub fn opposes(self, other: Self) -> bool {
        self.normal.meets(other.reverse) || self.reverse.meets(other.normal)
    }

    /// Whether there is no point here.
    pub fn is_empty(self) -> bool {
        self.normal.is_empty() && self.reverse.is_empty()
    }
}
