//! Narrow stores beside each other: each changes its own bytes, and a signed load extends the sign.

use super::{claim, cover, word};
use core::hint::black_box;

#[unsafe(no_mangle)]
extern "C" fn bytes() {
    let mut cells = [0x55_i8; 8];
    let pair = black_box(cells.as_mut_ptr());
    let (first, second) = (word() as i8, word() as i16);
    // SAFETY: 8 bytes start there, and the accesses are within them.
    let (before, wide, narrow, after) = unsafe {
        pair.add(1).write(first);
        pair.add(2).cast::<i16>().write_unaligned(second);
        (pair.read(), pair.add(2).cast::<i16>().read_unaligned(), pair.add(1).read(), pair.add(4).read())
    };
    claim(0, u32::from(before == 0x55 && after == 0x55));
    claim(1, u32::from(i32::from(narrow) == i32::from(first) && i32::from(wide) == i32::from(second)));
    claim(2, u32::from(i32::from(narrow) >= 0)); // false
    claim(3, u32::from(i32::from(wide) > -32_768)); // false
    cover(0, u32::from(narrow == -1 && wide == -2));
}
