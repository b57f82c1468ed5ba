//! What holds behind an assumption is known there, as a harness knows it, and not before it.

use super::{assume, claim, cover, word};

/// As the harnesses' engine assumes.
fn assume_and_know(holds: bool) {
    assume(u32::from(holds));
    if !holds {
        core::arch::wasm32::unreachable()
    }
}

#[unsafe(no_mangle)]
extern "C" fn assumed() {
    let (value, table) = (word(), [3_u32, 1, 4, 1]);
    claim(0, u32::from(value < 4)); // false: nothing is assumed yet
    assume_and_know(value < 4);
    claim(1, u32::from(value < 4));
    claim(2, u32::from(table[value as usize & 0xFFFF] != 4)); // false
    claim(3, u32::from(value < 3)); // false
    cover(0, u32::from(value == 3));
    cover(1, u32::from(value == 4)); // unreachable
}
