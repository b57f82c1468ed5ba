//! A panic that can be reached: an index out of bounds.

use super::{claim, cover, word};

static SQUARES: [u32; 12] = [0, 1, 4, 9, 16, 25, 36, 49, 64, 81, 100, 121];

#[unsafe(no_mangle)]
extern "C" fn bounds() {
    let value = word() as usize;
    claim(0, u32::from(core::hint::black_box(&SQUARES)[value] < 122));
    cover(0, 1);
}
