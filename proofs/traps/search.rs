//! For the solvers: claims that hold, and claims that fail, where nothing but a search can tell.

use super::{assume, claim, cover, word};
use core::hint::black_box;

#[unsafe(no_mangle)]
extern "C" fn search() {
    let (left, right) = (black_box(word()), black_box(word()));
    // A sum from its carries: no one rewrites it.
    claim(0, u32::from((left ^ right) + 2 * (left & right) == left + right));
    claim(1, u32::from((left ^ right) + 2 * (left & right) != 77_777)); // false
    assume(u32::from(left > 1 && left < 256 && right > 1 && right < 256));
    claim(2, u32::from(left * right != 62_499)); // false: 249 · 251
    claim(3, u32::from(left * right != 63_001)); // false: 251² is the only way
    claim(4, u32::from(left * right != 60_899)); // a prime
    cover(0, u32::from(left * right == 62_250));
}
