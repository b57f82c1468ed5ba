//! What a harness is: its theorem, its claims and cover points by name, and its body.

use crate::Engine;

/// One harness, as the provers, the mutants and the safety case know it.
#[derive(Clone, Copy)]
pub struct Harness {
    /// The function's name, unique in the crate.
    pub name: &'static str,
    /// The theorem that it proves or is part of, as in `spec/`.
    pub theorem: &'static str,
    /// The theorem in plain English.
    pub statement: &'static str,
    /// The requirements that it proves, as in `spec/`.
    pub requirements: &'static [&'static str],
    /// What it assumes, by the ids of `spec/assumptions.toml`: what its run supposes, what is built in, and what carries its bound.
    pub assumptions: &'static [&'static str],
    /// Those of the assumptions that no line supposes, each with how they come in: the scene has nothing else, or a claim begins with them.
    pub built_in: &'static [(&'static str, &'static str)],
    /// The bound of the proof in words; empty if there is none.
    pub bound: &'static str,
    /// The same as far as Kani proves it, which may be less.
    pub bound_kani: &'static str,
    /// How many cases [`Engine::choose`] splits it into; 1 if it does not.
    pub cases: usize,
    /// How often Kani unwinds each loop: once more than the longest one needs.
    pub unwind: usize,
    /// The same, derived from the sizes of the harness. Kani takes a number only, so the two stand side by side and are compared.
    pub derived: usize,
    /// The cases that Kani proves one by one, each in a proof of its own; none if one proof has them all.
    pub apart: &'static [usize],
    /// The module in which Kani's proofs of it stand.
    pub module: &'static str,
    /// The file in which it stands, from the root of the checkout.
    pub file: &'static str,
    /// The line of the file at which it begins.
    pub line: u32,
    /// Its claims, by number.
    pub claims: &'static [Point],
    /// Its cover points, by number.
    pub covers: &'static [Point],
    /// The body, for engines that are chosen at run time.
    pub run: fn(&mut dyn Engine),
}

/// A claim or a cover point.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Point {
    /// Its name in the source of the harness.
    pub name: &'static str,
    /// What it says.
    pub text: &'static str,
}

/// Nothing is built in.
pub(crate) const NOTHING: &[(&str, &str)] = &[];

/// Defines a harness as a module with `run` (its body), `HARNESS` and, for the provers, an entry point.
///
/// Claims and cover points are enums: one that the body never names is a compiler warning (an error in `ci/test`).
///
/// `assumptions` has every assumption about the world: the ids that the body supposes ([`Engine::suppose`]), and those that are `built_in`.
///
/// For Kani: `unwind 17 = 1 + SECTIONS;` is how often it unwinds loops. It works on MIR, where every loop over an array is one, and every
/// comparison of arrays of numbers is one over their bytes. `solver kissat;` is a solver that is known to be better than the default one,
/// `apart [0 1 2];` has the cases proved one by one, the last one with all that follow it, and `under_kani "…";` is the bound where sizes are
/// smaller under `cfg(kani)`.
macro_rules! harness {
    (
        $(#[doc = $statement:literal])+
        $name:ident($engine:ident)
        theorem $theorem:literal;
        requirements [$($requirement:literal),* $(,)?];
        assumptions [$($assumption:literal),* $(,)?];
        $(built_in $built_in:expr;)?
        bound $bound:expr;
        cases $cases:expr;
        unwind $unwind:literal = $derived:expr;
        $(solver $solver:ident;)?
        $(apart [$($apart:tt)+];)?
        $(under_kani $bound_kani:expr;)?
        claims { $($claim:ident: $claim_text:literal,)+ }
        covers { $($cover:ident: $cover_text:literal,)+ }
        $body:block
    ) => {
        $(#[doc = $statement])+
        #[allow(unexpected_cfgs, reason = "a harness is chosen by a cfg of its name")]
        pub mod $name {
            // All of them, or the ones that are chosen: a wrong kernel needs one or two.
            #[cfg(any(not(chosen), $name))]
            pub use body::*;

            #[cfg(any(not(chosen), $name))]
            mod body {
                use super::super::*;
                use $crate::harness::{Harness, Point};

                #[derive(Clone, Copy)]
                enum Claim { $($claim,)+ }

                #[derive(Clone, Copy)]
                enum Cover { $($cover,)+ }

                /// What this harness is.
                pub const HARNESS: Harness = Harness {
                    name: stringify!($name),
                    theorem: $theorem,
                    statement: concat!($($statement),+),
                    requirements: &[$($requirement),*],
                    assumptions: &[$($assumption),*],
                    built_in: {
                        let built_in = [$crate::harness::NOTHING $(, $built_in)?];
                        built_in[built_in.len() - 1]
                    },
                    bound: $bound,
                    bound_kani: {
                        let bounds = [$bound $(, $bound_kani)?];
                        bounds[bounds.len() - 1]
                    },
                    cases: $cases,
                    unwind: $unwind,
                    derived: $derived,
                    apart: $crate::harness::counting_up(&[$($($apart),+)?]),
                    module: module_path!(),
                    file: file!(),
                    line: line!(),
                    claims: &[$(Point { name: stringify!($claim), text: $claim_text }),+],
                    covers: &[$(Point { name: stringify!($cover), text: $cover_text }),+],
                    run: |engine| run(engine),
                };

                /// The body, for any engine.
                #[inline(always)]
                pub fn run<E: $crate::Engine + ?Sized>($engine: &mut E) $body

                // Sizes may be smaller than those of which the number is derived, never greater.
                #[allow(clippy::int_plus_one, reason = "the bound is one more than a size")]
                const _: () = assert!($unwind >= $derived, "loops are not unwound far enough");

                #[cfg(kani)]
                kani_proofs!([$unwind $($solver)?] [$($($apart)+)?]);

                #[cfg(engine = "cbmc")]
                #[unsafe(no_mangle)]
                extern "C" fn $name() {
                    run(&mut $crate::engine::cbmc::Cbmc::start());
                }
            }
        }
    };
}

/// The numbers, which are 0, 1, 2, …; anything else stops the compiler.
pub(crate) const fn counting_up(numbers: &'static [usize]) -> &'static [usize] {
    let mut place = 0;
    while place < numbers.len() {
        assert!(numbers[place] == place, "the cases that are proved apart are 0 1 2 and so on");
        place += 1;
    }
    numbers
}

/// A decimal number of one or two digits; anything else stops the compiler.
pub(crate) const fn decimal(text: &str) -> usize {
    let digits = text.as_bytes();
    assert!(!digits.is_empty() && digits.len() <= 2, "a number of one or two digits");
    let mut number = 0;
    let mut place = 0;
    while place < digits.len() {
        assert!(digits[place].is_ascii_digit(), "a decimal number");
        number = number * 10 + (digits[place] - b'0') as usize;
        place += 1;
    }
    number
}
