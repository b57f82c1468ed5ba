//! The sets of C for each size of station, and back.

use atc_kernel::interlocking::{CircuitSet, Large, PointSet, RouteSet, SegmentSet, Size, Small};

use super::forms::{atc_set32, atc_set128, atc_set256};
use crate::memory::{Reader, Writer};

/// A set as C has it.
pub(crate) trait Set<K>: Bits {
    /// C's form of a set of the kernel.
    fn of(kernel: K) -> Self;
    /// The kernel's form of it.
    fn kernel(self) -> K;
}

/// The bits of a set as C has them.
pub(crate) trait Bits: Copy {
    /// Nothing.
    const NONE: Self;
    /// Everything that there can be.
    const ALL: Self;
    /// How many bytes it takes.
    const BYTES: usize = size_of::<Self>();
    /// Writes the bytes.
    fn put(self, to: &mut Writer<'_>);
    /// Reads them.
    fn take(from: &mut Reader<'_>) -> Option<Self>;
}

/// A size of station, and the sets that C has for it. Routes are in sets of as many bits as circuits.
pub(crate) trait InC: Size {
    /// Circuits, or routes.
    type Circuits: Set<CircuitSet<Self>> + Set<RouteSet<Self>>;
    /// Points.
    type Points: Set<PointSet<Self>>;
    /// Segments.
    type Segments: Set<SegmentSet<Self>>;
}

impl InC for Small {
    type Circuits = u64;
    type Points = u32;
    type Segments = u8;
}

impl InC for Large {
    type Circuits = atc_set256;
    type Points = atc_set128;
    type Segments = atc_set32;
}

macro_rules! set {
    ($word:ident $words:ident: $($kernel:ident)*) => {
        impl Bits for $word {
            const NONE: Self = 0;
            const ALL: Self = $word::MAX;

            fn put(self, to: &mut Writer<'_>) {
                to.$word(self);
            }

            fn take(from: &mut Reader<'_>) -> Option<Self> {
                from.$word()
            }
        }

        impl Bits for $words {
            const NONE: Self = Self { words: [0; 4] };
            const ALL: Self = Self { words: [$word::MAX; 4] };

            fn put(self, to: &mut Writer<'_>) {
                for word in self.words {
                    to.$word(word);
                }
            }

            fn take(from: &mut Reader<'_>) -> Option<Self> {
                Some(Self { words: [from.$word()?, from.$word()?, from.$word()?, from.$word()?] })
            }
        }

        $(
            impl Set<$kernel<Small>> for $word {
                fn of(kernel: $kernel<Small>) -> Self {
                    kernel.bits()
                }

                fn kernel(self) -> $kernel<Small> {
                    $kernel::from_bits(self)
                }
            }

            impl Set<$kernel<Large>> for $words {
                fn of(kernel: $kernel<Large>) -> Self {
                    Self { words: kernel.words() }
                }

                fn kernel(self) -> $kernel<Large> {
                    $kernel::from_words(self.words)
                }
            }
        )*
    };
}

set!(u64 atc_set256: CircuitSet RouteSet);
set!(u32 atc_set128: PointSet);
set!(u8 atc_set32: SegmentSet);
