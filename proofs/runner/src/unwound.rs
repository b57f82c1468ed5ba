//! How far CBMC unwound the loops of a harness, held against the bound that Kani is given.
//!
//! CBMC sees what is left of the loops in optimised code, Kani all of them: a bound that is too small here is too small there.

use atc_proofs::Harness;

/// What the compiler makes of moving and filling memory, and the driver's loop over constant data: no loops of the source.
const NOT_OURS: [&str; 4] = ["load_bytes", "memcpy", "memmove", "memset"];

/// The largest number of turns of a loop of the source by CBMC's messages; 0 if none was unwound. CBMC counts how often a loop is gone back
/// to: it has one turn more.
pub fn largest<'a>(messages: impl Iterator<Item = &'a str>) -> usize {
    let iterations = messages.filter_map(|text| {
        let (name, rest) = text.strip_prefix("Unwinding loop ")?.split_once(" iteration ")?;
        let ours = !NOT_OURS.iter().any(|function| name.contains(function));
        let back: usize = rest.split(' ').next()?.parse().ok()?;
        ours.then_some(back + 1)
    });
    iterations.max().unwrap_or(0)
}

/// Why the harness's bound is wrong, if it is: a loop of n turns needs a bound above n.
pub fn beyond(harness: &Harness, unwound: usize) -> Option<String> {
    let bound = harness.unwind;
    let what = format!("a loop has {unwound} turns, and the bound that the harness gives Kani is {bound}");
    (unwound >= bound).then_some(what)
}
