//! Wide accesses at addresses that are no multiple of the width: the bytes that are there.
//!
//! The bytes that are expected never come from memory: the optimiser would read both sides of a claim the same way.

use super::{claim, cover, word};
use core::hint::black_box;

#[unsafe(no_mangle)]
extern "C" fn unaligned() {
    let mut cells = [0_u64; 3];
    let start = black_box(cells.as_mut_ptr().cast::<u8>());
    let bytes = [(); 4].map(|()| word() & 0xff);
    let [one, two, three, four] = bytes;
    for (place, byte) in bytes.into_iter().enumerate() {
        // SAFETY: 24 bytes start there, and all accesses are within them.
        unsafe { start.add(3 + place).write(byte as u8) };
    }
    let start = black_box(start);
    let expected = one | two << 8 | three << 16 | four << 24;
    // SAFETY: as above.
    let (wide, half, long) = unsafe {
        let half = start.add(5).cast::<u16>().read_unaligned();
        (start.add(3).cast::<u32>().read_unaligned(), half, start.add(1).cast::<u64>().read_unaligned())
    };
    claim(0, u32::from(wide == expected));
    claim(1, u32::from(u32::from(half) != three)); // false: where the fourth byte is 0
    claim(2, u32::from(long == u64::from(expected) << 16));
    // SAFETY: as above.
    unsafe {
        start.add(9).cast::<u32>().write_unaligned(expected);
        start.add(17).cast::<u16>().write_unaligned(expected as u16);
    }
    let start = black_box(start);
    // SAFETY: as above.
    let at = |place: usize| u32::from(unsafe { start.add(place).read() });
    claim(3, u32::from(at(8) == 0 && at(9) == one && at(12) == four && at(13) == 0));
    claim(4, u32::from(at(16) == 0 && at(17) == one && at(18) == two && at(19) == 0));
    cover(0, u32::from(wide == 0x0102_0304));
}
