//! Products of 64 bits: no half of them is lost.

use super::{claim, cover, word};
use core::hint::black_box;

#[unsafe(no_mangle)]
extern "C" fn products() {
    let low = u64::from(black_box(word()));
    let wide = black_box(low << 16 | 0xabcd);
    let twice = wide.wrapping_mul(0x1_0000_0001);
    claim(0, u32::from((twice >> 32) as u32 == (twice as u32).wrapping_add((wide >> 32) as u32)));
    claim(1, u32::from(twice >> 32 == 0)); // false: only the low half
    claim(2, u32::from(black_box(low).wrapping_mul(low) >> 32 == 0));
    claim(3, u32::from(black_box(low).wrapping_mul(low) != 0xfffe_0001)); // false: 65535²
    claim(4, u32::from(black_box(wide).wrapping_mul(black_box(1 << 40)) == wide << 40));
    cover(0, u32::from(black_box(low).wrapping_mul(3) == 0x2_fffd));
}
