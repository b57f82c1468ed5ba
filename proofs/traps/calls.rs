//! A call of a function that has loops of its own, from two places and in a loop.

use super::{claim, cover, word};
use core::hint::black_box;

/// How often 3 fits, by counting. The limit keeps the compiler from unrolling the loop: it does not know it.
#[inline(never)]
fn thirds(mut value: u32) -> u32 {
    let (mut count, limit) = (0, black_box(12));
    while count < limit && value >= 3 {
        value -= 3;
        if value == 20 {
            return 100 + count;
        }
        count += 1;
    }
    count
}

#[unsafe(no_mangle)]
extern "C" fn calls() {
    let (first, second) = (word() % 32, word() % 4);
    let many = thirds(first);
    claim(0, u32::from(first >= 23 || many == first / 3));
    claim(1, u32::from(many < 100)); // false: 23, 26, 29
    claim(2, u32::from(first % 3 == 2 || many <= 10));
    let mut sum = 0;
    for round in 0..3 {
        sum += thirds(second + round);
    }
    claim(3, u32::from(sum <= 3));
    claim(4, u32::from(sum < 3)); // false
    cover(0, u32::from(many == 101));
}
