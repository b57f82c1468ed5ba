//! What is at the lowest address of the stack is somewhere: an address of 0 would be nowhere.

use super::{claim, cover, word};

#[unsafe(no_mangle)]
extern "C" fn lowest() {
    // With the one word that hides where they are these are 16 bytes: a whole frame, without a gap below.
    let mut words = [0_u32; 3];
    let value = word();
    words[2] = value;
    let known = core::hint::black_box(Some(&mut words));
    claim(0, u32::from(known.as_ref().is_some_and(|words| words[2] == value)));
    claim(1, u32::from(known.is_none())); // false
    cover(0, u32::from(value == 9));
}
