//! A shift by the width or more takes the distance modulo the width, in 32 and in 64 bits.

use super::{assume, claim, cover, word};
use core::hint::black_box;

#[unsafe(no_mangle)]
extern "C" fn shifts() {
    let (value, by) = (black_box(word() | 0x8000_0000), black_box(word()));
    assume(u32::from(by < 100));
    let left = value.wrapping_shl(by);
    claim(0, u32::from(by != 33 || left == value.wrapping_add(value)));
    claim(1, u32::from(by != 32 || left == value));
    claim(2, u32::from(by < 32 || left == 0)); // false
    claim(3, u32::from((value as i32).wrapping_shr(by) < 0));
    claim(4, u32::from(by != 63 || value.wrapping_shr(by) == 1));
    let long = black_box(u64::from(value) << 31).wrapping_shr(by);
    claim(5, u32::from(by != 95 || long == u64::from(value)));
    claim(6, u32::from(by < 64 || long == 0)); // false
    claim(
        7,
        u32::from(black_box(value).rotate_left(by) == left | black_box(value).wrapping_shr(32_u32.wrapping_sub(by))),
    );
    cover(0, u32::from(by == 99));
}
