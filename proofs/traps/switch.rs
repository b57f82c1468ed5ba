//! A switch: every arm is followed, each with its own value, and one that falls to the others.

use super::{claim, cover, word};

#[unsafe(no_mangle)]
extern "C" fn switch() {
    let value = word();
    let mut sum = value & 0xff;
    match value >> 8 {
        0 => claim(0, u32::from(value < 256)),
        1 => {
            sum += 7;
            claim(1, u32::from(value != 300)); // false
        }
        2 => cover(0, u32::from(value == 515)),
        3 => {
            sum += word() % 2;
            claim(2, u32::from(sum != 256)); // false: 255 and one more
        }
        4 => claim(3, u32::from(value >> 10 == 1)),
        5 => sum = 1000,
        _ => claim(4, u32::from(value > 1535)),
    }
    claim(5, u32::from(sum <= 262 || sum == 1000));
    claim(6, u32::from(sum != 1000)); // false
}
