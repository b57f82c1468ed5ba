//! A panic that can be reached: an overflow.

use super::{claim, cover, word};

#[unsafe(no_mangle)]
extern "C" fn overflow() {
    let value = word() as u16;
    claim(0, u32::from(value + 1 > 0));
    cover(0, 1);
}
