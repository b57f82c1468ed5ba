//! How large a station is: what a set of its circuits, points, routes and segments is made of.
//!
//! There are two sizes. Everything else of the kernel is written once for both, in terms of sets, and knows of no bits. A set of
//! a [`Small`] station is one word, which a processor and a prover take whole; one of a [`Large`] station is four.

use core::fmt::Debug;
use core::hash::Hash;

use crate::distance::Metres;

/// The words of a set of a large station.
const WORDS: usize = 4;

/// Plain data: it can be copied, compared, hashed, shown and sent.
pub trait Plain: Copy + Debug + Eq + Hash + Send + Sync + 'static {}

impl<T: Copy + Debug + Eq + Hash + Send + Sync + 'static> Plain for T {}

/// The bits of a set.
pub trait Bits: Plain {
    /// No bit.
    const NONE: Self;
    /// All bits.
    const ALL: Self;
    /// How many bits there are.
    const WIDTH: usize;

    /// The bit of this number alone; none if there is none of that number.
    fn nth(number: usize) -> Self;
    /// The bits of either.
    #[must_use]
    fn or(self, other: Self) -> Self;
    /// The bits of both.
    #[must_use]
    fn and(self, other: Self) -> Self;
    /// The bits that `other` has not.
    #[must_use]
    fn without(self, other: Self) -> Self;
    /// These bits if `wanted`, else none.
    #[must_use]
    fn only_if(self, wanted: bool) -> Self;
    /// Whether a bit is set in both.
    fn meets(self, other: Self) -> bool;
    /// Whether the bit of this number is set; not if there is none of that number.
    #[inline]
    fn has(self, number: usize) -> bool {
        self.meets(Self::nth(number))
    }
    /// Whether exactly one bit is set.
    fn is_one(self) -> bool;
    /// The lowest number of a bit that is set.
    fn first(self) -> Option<usize>;
    /// A check word with these bits in it: each changes exactly one bit of it.
    fn fold(self, check: u64) -> u64;
}

macro_rules! word {
    ($word:ident) => {
        impl Bits for $word {
            const NONE: Self = 0;
            const ALL: Self = $word::MAX;
            const WIDTH: usize = $word::BITS as usize;

            #[inline]
            fn nth(number: usize) -> Self {
                if number < Self::WIDTH { 1 << number } else { 0 }
            }

            #[inline]
            fn or(self, other: Self) -> Self {
                self | other
            }

            #[inline]
            fn and(self, other: Self) -> Self {
                self & other
            }

            #[inline]
            fn without(self, other: Self) -> Self {
                self & !other
            }

            #[inline]
            fn only_if(self, wanted: bool) -> Self {
                if wanted { self } else { 0 }
            }

            #[inline]
            fn meets(self, other: Self) -> bool {
                self & other != 0
            }

            #[inline]
            fn is_one(self) -> bool {
                self != 0 && self & (self - 1) == 0
            }

            #[inline]
            fn first(self) -> Option<usize> {
                if self == 0 { None } else { Some(self.trailing_zeros() as usize) }
            }

            #[inline]
            fn fold(self, check: u64) -> u64 {
                check.rotate_left(5) ^ u64::from(self)
            }
        }
    };
}

word!(u64);
word!(u32);
word!(u8);

/// The lowest numbers are in the first word.
//= spec/interlocking.md#lay-3-two-sizes
//# A set MUST have a number in it exactly if what it was made from has it, for every number that a station of its size has room for, and no other number.
impl<B: Bits> Bits for [B; WORDS] {
    const NONE: Self = [B::NONE; WORDS];
    const ALL: Self = [B::ALL; WORDS];
    const WIDTH: usize = WORDS * B::WIDTH;

    #[inline]
    fn nth(number: usize) -> Self {
        let mut words = Self::NONE;
        if let Some(word) = words.get_mut(number / B::WIDTH) {
            *word = B::nth(number % B::WIDTH);
        }
        words
    }

    #[inline]
    fn or(self, other: Self) -> Self {
        core::array::from_fn(|word| self[word].or(other[word]))
    }

    #[inline]
    fn and(self, other: Self) -> Self {
        core::array::from_fn(|word| self[word].and(other[word]))
    }

    #[inline]
    fn without(self, other: Self) -> Self {
        core::array::from_fn(|word| self[word].without(other[word]))
    }

    #[inline]
    fn only_if(self, wanted: bool) -> Self {
        core::array::from_fn(|word| self[word].only_if(wanted))
    }

    #[inline]
    fn meets(self, other: Self) -> bool {
        let mut meets = false;
        for (word, its) in self.iter().zip(other) {
            meets |= word.meets(its);
        }
        meets
    }

    #[inline]
    fn has(self, number: usize) -> bool {
        self.get(number / B::WIDTH).is_some_and(|word| word.has(number % B::WIDTH))
    }

    #[inline]
    fn is_one(self) -> bool {
        let (mut some, mut more) = (false, false);
        for word in self {
            let any = word != B::NONE;
            more |= any && (some || !word.is_one());
            some |= any;
        }
        some && !more
    }

    #[inline]
    fn first(self) -> Option<usize> {
        let mut first = None;
        for (place, word) in self.iter().enumerate() {
            first = first.or(word.first().map(|number| place * B::WIDTH + number));
        }
        first
    }

    /// As word after word, but each word is turned to its place by itself: none waits for the one before it.
    #[inline]
    fn fold(self, check: u64) -> u64 {
        let mut folded = check.rotate_left(20);
        for (word, turn) in self.into_iter().zip([15, 10, 5, 0]) {
            folded ^= word.fold(0).rotate_left(turn);
        }
        folded
    }
}

/// What there can be a value of for each circuit or point.
pub trait Value: Plain {
    /// The value before there is one: nothing.
    const NONE: Self;
}

impl Value for u8 {
    const NONE: Self = 0;
}

impl Value for Metres {
    const NONE: Self = Self(0);
}

impl<T: Plain> Value for Option<T> {
    const NONE: Self = None;
}

/// A fixed number of values.
pub trait Values<T: Value>: AsRef<[T]> + AsMut<[T]> + IntoIterator<Item = T> + Plain {
    /// No value.
    const NONE: Self;

    /// A value for each number.
    fn from_fn(value: impl FnMut(usize) -> T) -> Self;
}

impl<T: Value, const COUNT: usize> Values<T> for [T; COUNT] {
    const NONE: Self = [T::NONE; COUNT];

    #[inline]
    fn from_fn(value: impl FnMut(usize) -> T) -> Self {
        core::array::from_fn(value)
    }
}

/// What makes a size one of the two.
mod sealed {
    /// Nobody else can name it.
    pub trait Sealed {}

    impl Sealed for super::Small {}
    impl Sealed for super::Large {}
}

/// The size of a station. There are two, [`Small`] and [`Large`], whose sets are proved; nobody else can make one:
///
/// ```compile_fail,E0277
/// use atc_kernel::interlocking::Size;
///
/// #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
/// struct Mine;
///
/// impl Size for Mine {
///     type Wide = u8; // a set of 64 circuits in eight bits
///     type Middle = u8;
///     type Narrow = u8;
///     type PerCircuit<T: atc_kernel::interlocking::Value> = [T; 64];
///     type PerPoint<T: atc_kernel::interlocking::Value> = [T; 32];
/// }
/// ```
pub trait Size: Default + Plain + sealed::Sealed {
    /// A set of circuits, or of routes.
    type Wide: Bits;
    /// A set of points.
    type Middle: Bits;
    /// A set of segments.
    type Narrow: Bits;
    /// A value for each circuit.
    type PerCircuit<T: Value>: Values<T>;
    /// A value for each point.
    type PerPoint<T: Value>: Values<T>;

    /// The places of a list that are to be looked at, if the first `length` are in use: these at least, in their order. A large station has many
    /// lists with room for more than they hold; a small one looks at all, so that a prover knows how many there are.
    fn used<T>(places: &[T], length: u8) -> &[T];

    /// Whether what is repeated up to some number of times ends as soon as it changes nothing any more. A small station goes on, so that a prover knows
    /// how often.
    const RESTS: bool;
}

/// A station of up to 64 circuits, 64 routes, 32 points and 8 segments.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub struct Small;

impl Size for Small {
    type Wide = u64;
    type Middle = u32;
    type Narrow = u8;
    type PerCircuit<T: Value> = [T; 64];
    type PerPoint<T: Value> = [T; 32];

    #[inline]
    fn used<T>(places: &[T], _: u8) -> &[T] {
        places
    }

    const RESTS: bool = false;
}

/// A station of up to 256 circuits, 256 routes, 128 points and 32 segments.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub struct Large;

impl Size for Large {
    type Wide = [u64; WORDS];
    type Middle = [u32; WORDS];
    type Narrow = [u8; WORDS];
    type PerCircuit<T: Value> = [T; 256];
    type PerPoint<T: Value> = [T; 128];

    #[inline]
    fn used<T>(places: &[T], length: u8) -> &[T] {
        //= spec/interlocking.md#lay-4-places-in-use
        //# Of a list of places all those in use MUST be looked at, in their order.
        places.get(..usize::from(length)).unwrap_or(places)
    }

    const RESTS: bool = true;
}
