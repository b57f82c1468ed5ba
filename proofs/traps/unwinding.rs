//! A loop longer than the bound.

use super::{claim, cover, word};

#[unsafe(no_mangle)]
extern "C" fn unwinding() {
    let mut left = word();
    while left > 0 {
        left = core::hint::black_box(left) - 1;
    }
    claim(0, u32::from(left == 0));
    cover(0, 1);
}
