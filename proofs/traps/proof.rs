//! For the solvers: everything holds, so that the answer is one of no counterexample at all.

use super::{claim, cover, word};
use core::hint::black_box;

#[unsafe(no_mangle)]
extern "C" fn proof() {
    let (left, right) = (black_box(word()), black_box(word()));
    claim(0, u32::from((left | right) + (left & right) == left + right));
    claim(1, u32::from(left * left % 4 != 2));
    cover(0, u32::from((left | right) == 65_535));
}
