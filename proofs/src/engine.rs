//! What a harness may ask of a prover.

use core::ops::RangeInclusive;

/// A prover, or a tester that stands in for one.
pub trait Engine {
    /// An arbitrary value: all 65 536. `what` names it for whoever reads a counterexample, and `likely` hints to
    /// testers where interesting values lie; no prover looks at either.
    fn word(&mut self, what: &'static str, likely: RangeInclusive<u16>) -> u16;

    /// An arbitrary value below `cases`, asked for at most once: a prover may take one after the other, each as a
    /// constant, which is much less work where the value is an index.
    fn choose(&mut self, what: &'static str, cases: usize) -> usize;

    /// Goes on only with valid values: what a constructor accepts, a state that is valid (GEN-1), a number in its range, and what the theorem itself
    /// says of its case. Nothing about the world.
    fn assume(&mut self, holds: bool);

    /// Goes on only with values for which this holds of the world: of trains, neighbours, detectors, odometers, times. `id` is that of an assumption in
    /// `spec/assumptions.toml`, and the harness lists it. No prover looks at it.
    #[inline]
    fn suppose(&mut self, _id: &'static str, holds: bool) {
        self.assume(holds);
    }

    /// Claim number `number` of the harness: must hold for all values.
    fn claim(&mut self, number: u32, holds: bool);

    /// Cover point number `number` of the harness: must be reached for some values.
    fn cover(&mut self, number: u32, reached: bool);
}

/// An arbitrary 32-bit value: its high half, then its low half. `likely` is for the low half.
pub fn any_u32<E: Engine + ?Sized>(engine: &mut E, what: &'static str, likely: RangeInclusive<u16>) -> u32 {
    let high = engine.word(what, 0..=0);
    u32::from(high) << 16 | u32::from(engine.word(what, likely))
}

/// An arbitrary number of up to 8 bits.
pub fn any_byte<E: Engine + ?Sized>(engine: &mut E, what: &'static str, likely: RangeInclusive<u16>) -> u8 {
    let word = engine.word(what, likely);
    engine.assume(word <= 0xFF);
    word.to_le_bytes()[0]
}

/// An arbitrary yes (an odd word) or no.
pub fn any_flag<E: Engine + ?Sized>(engine: &mut E, what: &'static str) -> bool {
    engine.word(what, 0..=1) & 1 == 1
}

/// CBMC, on the crate compiled to WebAssembly: the four primitives are imports.
#[cfg(engine = "cbmc")]
#[allow(unsafe_code)]
pub(crate) mod cbmc {
    use super::{Engine, RangeInclusive};

    mod import {
        #[link(wasm_import_module = "prover")]
        unsafe extern "C" {
            pub safe fn word() -> u32;
            pub safe fn choose(cases: u32) -> u32;
            pub safe fn assume(holds: u32);
            pub safe fn claim(number: u32, holds: u32);
            pub safe fn cover(number: u32, reached: u32);
        }
    }

    pub struct Cbmc;

    impl Cbmc {
        /// The prover, at the start of a harness.
        #[inline(always)]
        pub fn start() -> Self {
            // A copy of the kernel that has mutants in it asks which of them it is to be.
            #[cfg(mutants)]
            atc_kernel::select();
            Self
        }
    }

    impl Engine for Cbmc {
        #[inline(always)]
        fn word(&mut self, _: &'static str, _: RangeInclusive<u16>) -> u16 {
            // The import returns 16 bits; the cast says so to the optimiser.
            (import::word() & 0xFFFF) as u16
        }

        #[inline(always)]
        fn choose(&mut self, _: &'static str, cases: usize) -> usize {
            import::choose(cases as u32) as usize
        }

        #[inline(always)]
        fn assume(&mut self, holds: bool) {
            import::assume(u32::from(holds));
            // Nothing is behind an assumption that does not hold. The optimiser learns it here; if it were wrong, this would be a trap.
            if !holds {
                core::arch::wasm32::unreachable()
            }
        }

        #[inline(always)]
        fn claim(&mut self, number: u32, holds: bool) {
            import::claim(number, u32::from(holds));
        }

        #[inline(always)]
        fn cover(&mut self, number: u32, reached: bool) {
            import::cover(number, u32::from(reached));
        }
    }

    #[panic_handler]
    fn panic(_: &core::panic::PanicInfo) -> ! {
        core::arch::wasm32::unreachable()
    }
}

/// Kani, on MIR.
#[cfg(kani)]
pub(crate) mod model {
    use super::{Engine, RangeInclusive};

    /// One case, or any.
    pub struct Kani {
        /// The least case.
        first: usize,
        /// The case behind the greatest; as many as there are, if this is greater.
        end: usize,
    }

    impl Kani {
        /// Any case.
        pub const ANY: Self = Self { first: 0, end: usize::MAX };

        /// Case `number` of those that are proved apart; the last of them has all that follow it.
        pub const fn case(number: usize, apart: &[usize]) -> Self {
            Self { first: number, end: if number + 1 < apart.len() { number + 1 } else { usize::MAX } }
        }
    }

    /// A constant place for each number, so that each has a verdict of its own.
    macro_rules! each {
        ($number:ident: $($constant:literal)* => $check:ident!($holds:ident, $kind:literal)) => {
            match $number {
                $($constant => kani_check!($check, $holds, concat!($kind, " ", $constant)),)*
                _ => unreachable!("a harness has at most 8 claims and 8 cover points"),
            }
        };
    }

    macro_rules! kani_check {
        (assert, $holds:ident, $text:expr) => {
            kani::assert($holds, $text)
        };
        (cover, $reached:ident, $text:expr) => {
            kani::cover($reached, $text)
        };
    }

    impl Engine for Kani {
        fn word(&mut self, _: &'static str, _: RangeInclusive<u16>) -> u16 {
            kani::any()
        }

        fn choose(&mut self, _: &'static str, cases: usize) -> usize {
            // A smaller size may have fewer cases than are named: then the last one is proved more than once.
            let first = if self.first < cases { self.first } else { cases - 1 };
            let end = if first < self.end && self.end < cases { self.end } else { cases };
            if first + 1 == end {
                return first;
            }
            let choice: usize = kani::any();
            kani::assume(first <= choice && choice < end);
            choice
        }

        fn assume(&mut self, holds: bool) {
            kani::assume(holds);
        }

        fn claim(&mut self, number: u32, holds: bool) {
            each!(number: 0 1 2 3 4 5 6 7 => assert!(holds, "claim"));
        }

        fn cover(&mut self, number: u32, reached: bool) {
            each!(number: 0 1 2 3 4 5 6 7 => cover!(reached, "cover"));
        }
    }
}
