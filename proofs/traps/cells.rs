//! Through linear memory: what is stored is what is loaded.

use super::{claim, cover, word};

#[unsafe(no_mangle)]
extern "C" fn cells() {
    let mut cells = [0_u16; 8];
    let (place, value) = (word() as usize % 8, word() as u16);
    cells[place] = value;
    core::hint::black_box(&mut cells);
    claim(0, u32::from(cells[place] == value));
    claim(1, u32::from(cells[(place + 1) % 8] == value)); // false
    cover(0, u32::from(place == 7));
}
