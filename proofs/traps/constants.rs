//! Constant tables are there.

use super::{assume, claim, cover, word};

static SQUARES: [u32; 12] = [0, 1, 4, 9, 16, 25, 36, 49, 64, 81, 100, 121];

#[unsafe(no_mangle)]
extern "C" fn constants() {
    let index = word();
    assume(u32::from(index < 12));
    let square = core::hint::black_box(&SQUARES)[index as usize];
    claim(0, u32::from(square == index * index));
    claim(1, u32::from(square != 121)); // false
    cover(0, u32::from(square == 121));
}
