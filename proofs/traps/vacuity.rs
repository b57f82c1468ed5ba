//! A claim that no path leads to, and one after an assumption that nothing meets, prove nothing.

use super::{assume, claim, cover, word};

#[unsafe(no_mangle)]
extern "C" fn vacuity() {
    let value = word();
    claim(0, u32::from(value < 65_536));
    if value > 65_535 {
        claim(1, 0); // unreachable
    }
    assume(u32::from(value & 1 == 1));
    claim(2, u32::from(value != 0));
    cover(0, u32::from(value == 1));
    cover(1, u32::from(value == 2)); // unreachable
    assume(u32::from(value % 2 == 0));
    claim(3, u32::from(value == 0)); // vacuous
    cover(2, 1); // unreachable
}
