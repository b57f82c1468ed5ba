//! Wider than a byte, at addresses that are no multiple of the width: the bytes that are there.

use super::{claim, cover, word};

#[unsafe(no_mangle)]
extern "C" fn unaligned() {
    let mut bytes = [0_u64; 2].map(u64::to_le_bytes);
    for byte in bytes.as_flattened_mut() {
        *byte = word() as u8;
    }
    let before = bytes;
    let at = |place: usize| before.as_flattened()[place];
    let start = core::hint::black_box(bytes.as_mut_ptr().cast::<u8>());
    // SAFETY: 16 bytes start there, and the accesses are within them.
    let (wide, long) = unsafe { (start.add(1).cast::<u32>().read_unaligned(), start.add(3).cast::<u64>().read_unaligned()) };
    claim(0, u32::from(wide == u32::from_le_bytes([at(1), at(2), at(3), at(4)])));
    claim(1, u32::from(long.to_le_bytes()[0] != at(3))); // false
    claim(2, u32::from((long >> 32) as u32 == u32::from_le_bytes([at(7), at(8), at(9), at(10)])));
    // SAFETY: as above.
    unsafe { start.add(6).cast::<u32>().write_unaligned(wide) };
    // SAFETY: as above.
    claim(3, u32::from(unsafe { start.add(9).read() } == at(4)));
    cover(0, u32::from(wide == 0x0102_0304));
}
