//! A stand-in for Kani's own library, with the part of its face that this project uses.
//!
//! It lets a plain compiler check the *types* of the code that only Kani sees (`cfg(kani)`), on machines where Kani
//! cannot be set up. It runs nothing and proves nothing. Face: the library of Kani 0.68.
#![no_std]

pub use kani_macros::{ensures, proof, proof_for_contract, requires, solver, unwind};

/// The types that `any` can make up.
pub trait Arbitrary {
    /// A value; here always the same one, as nothing runs.
    fn any() -> Self;
}

macro_rules! arbitrary {
    ($($type:ty)*) => {
        $(impl Arbitrary for $type {
            fn any() -> Self {
                Self::default()
            }
        })*
    };
}

arbitrary!(bool u8 u16 u32 u64 u128 usize i8 i16 i32 i64 i128 isize);

/// An arbitrary value.
pub fn any<T: Arbitrary>() -> T {
    T::any()
}

/// Goes on only where the condition holds.
pub fn assume(_cond: bool) {}

/// A check; Kani wants its message to be a literal in the end.
pub const fn assert(_cond: bool, _msg: &'static str) {}

/// A cover point, as a function.
pub const fn cover(_cond: bool, _msg: &'static str) {}

/// A cover point, as a macro. The message must be one literal token, as with Kani.
#[macro_export]
macro_rules! cover {
    () => {
        $crate::cover(true, "cover location")
    };
    ($cond:expr $(,)?) => {
        $crate::cover($cond, concat!("cover condition: ", stringify!($cond)))
    };
    ($cond:expr, $msg:literal) => {
        $crate::cover($cond, $msg)
    };
}

/// What the expansion of the attributes calls.
pub mod internal {
    /// Gives a postcondition's closure the type of the result.
    pub fn apply_closure<T, F: Fn(&T) -> bool>(condition: F, result: &T) -> bool {
        condition(result)
    }

    /// The first statement of a proof for a contract.
    pub fn init_contracts() {}
}
