//! Each claim and each cover point has a verdict of its own, whatever becomes of the others.

use super::{claim, cover, word};

#[unsafe(no_mangle)]
extern "C" fn verdicts() {
    let value = word();
    claim(0, u32::from(value < 65_536));
    claim(1, u32::from(value != 4711)); // false
    claim(2, u32::from(value != 4711 || value % 2 == 1));
    claim(3, u32::from(value != 4712)); // false
    claim(4, u32::from(value <= 65_535));
    cover(0, u32::from(value == 4711));
    cover(1, u32::from(value == 65_536)); // unreachable
}
