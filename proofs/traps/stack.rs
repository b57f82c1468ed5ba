//! More stack than there is.

use super::{claim, cover};

#[unsafe(no_mangle)]
extern "C" fn stack() {
    let mut cells = [0_u32; 900];
    core::hint::black_box(&mut cells);
    claim(0, u32::from(cells[899] == 0));
    cover(0, 1);
}
