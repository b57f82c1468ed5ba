//! Signed and unsigned: casts keep the bits or extend the sign, comparisons and right shifts know which they are.

use super::{claim, cover, word};
use core::hint::black_box;

#[unsafe(no_mangle)]
extern "C" fn casts() {
    let value = word();
    let (signed, narrow) = (black_box(value as u16 as i16), black_box(value as i8));
    claim(0, u32::from(i32::from(signed) == if value < 32_768 { value as i32 } else { value as i32 - 65_536 }));
    claim(1, u32::from(i64::from(signed) as u64 == u64::from(value))); // false
    claim(2, u32::from(signed as u16 == value as u16));
    claim(3, u32::from((signed < 0) == (value >= 32_768)));
    claim(4, u32::from((narrow as i32) < 128 && i32::from(narrow) >= -128));
    claim(5, u32::from(u32::from(narrow as u8) == (value & 0x7f))); // false
    claim(6, u32::from((i32::from(signed) >> 15) == if value < 32_768 { 0 } else { -1 }));
    claim(7, u32::from((i32::from(signed) as u32 >> 31) == 0)); // false
    cover(0, u32::from(signed == -32_768));
}
