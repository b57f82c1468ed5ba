//! How far CBMC unwound the loops of a harness, held against the bound that Kani is given.
//!
//! CBMC sees what is left of the loops in optimised code, Kani all of them: a bound that is too small here is too small there.

use atc_proofs::Harness;
use std::collections::HashMap;

/// What the compiler makes of moving and filling memory: no loops of the source.
const NOT_OURS: [&str; 3] = ["memcpy", "memmove", "memset"];

/// CBMC unwinds no loop further, and proves that none goes further. Where the end of a loop depends on a value, it unwinds as far as this, and
/// says nothing about the turns that the loop can have.
pub const MOST: &str = "66";

/// The largest number of turns of a loop of the source by CBMC's messages; 0 if it says of none how many it has. CBMC counts how often a
/// loop is gone back to: it has one turn more.
pub fn largest<'a>(messages: impl Iterator<Item = &'a str>) -> usize {
    let mut turns = HashMap::new();
    for text in messages {
        let Some((name, rest)) = text.strip_prefix("Unwinding loop ").and_then(|text| text.split_once(" iteration "))
        else {
            continue;
        };
        let back: Option<usize> = rest.split(' ').next().and_then(|number| number.parse().ok());
        let ours = !NOT_OURS.iter().any(|function| name.contains(function));
        if let (Some(back), true) = (back, ours) {
            let most = turns.entry(name).or_insert(0);
            *most = back.max(*most);
        }
    }
    let most: usize = MOST.parse().unwrap_or(usize::MAX);
    turns.into_values().map(|back| back + 1).filter(|turns| *turns < most).max().unwrap_or(0)
}

/// Why the harness's bound is wrong, if it is: a loop of n turns needs a bound above n.
pub fn beyond(harness: &Harness, unwound: usize) -> Option<String> {
    let bound = harness.unwind;
    let what = format!("a loop has {unwound} turns, and the bound that the harness gives Kani is {bound}");
    (unwound >= bound).then_some(what)
}
