//! A panic that can be reached: a division by zero.

use super::{claim, cover, word};

#[unsafe(no_mangle)]
extern "C" fn division() {
    let (value, by) = (word(), word());
    claim(0, u32::from(value / by <= value));
    cover(0, 1);
}
