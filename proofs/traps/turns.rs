//! A loop of nine turns: the engine must say that it has unwound it, since a bound for Kani is held against that.

use super::{claim, cover, word};

#[unsafe(no_mangle)]
extern "C" fn turns() {
    let (mut left, mut odd) = (core::hint::black_box(9_u32), 0);
    while left > 0 {
        odd ^= word() & 1;
        left = core::hint::black_box(left) - 1;
    }
    claim(0, u32::from(left == 0));
    claim(1, odd); // false
    cover(0, odd);
}
