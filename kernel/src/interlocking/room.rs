//! How long the distance of a code must be: the room that a train by codes alone needs to stop.
//!
//! It goes on at a code until that is too old, and it may brake in steps, from one code to the next. A brake of b, an age of a
//! and a code of speed c take (c + b·a)² / 2b; T-ATC-8 shows that this is enough for every order of codes.
//!
//! Requirements: `spec/interlocking.md`, ATC-16.

use crate::distance::Metres;
use crate::pattern::Deceleration;

/// 1 km/h in the unit of speed that is used here, a ninth of a mm/s.
const KMH: u32 = 2_500;

/// The square of the speed from which a train stops within the distance of a code. The `code` and what the train `loses` of its speed
/// in the time for which it goes on at an old code are in one unit of speed, any; the result is in its square. `None` if their sum is 2^32 or more.
#[inline]
pub const fn needed_room(code: u32, loses: u32) -> Option<u64> {
    match code.checked_add(loses) {
        Some(sum) => Some(sum as u64 * sum as u64),
        None => None,
    }
}

/// The square of the speed from which a train stops within `distance`, in (1/9 mm/s)²: 2·b·d, with 1000 mm a metre.
const fn room(brake: Deceleration, distance: Metres) -> u64 {
    2 * 81 * 1_000 * brake.mm_s2() as u64 * distance.0 as u64
}

/// What a train loses of its speed in `age_ms` with its brake, in ninths of a mm/s, rounded up.
const fn loses(brake: Deceleration, age_ms: u32) -> u64 {
    (9 * brake.mm_s2() as u64 * age_ms as u64).div_ceil(1_000)
}

/// Whether `distance` is long enough for a code of `kmh` (0 to 65 535), where trains have `brake` of their brake on the steepest fall, and go on
/// at a code for up to `age_ms` after it was told.
pub fn code_stops_within(brake: Deceleration, kmh: u16, age_ms: u32, distance: Metres) -> bool {
    let Ok(loses) = u32::try_from(loses(brake, age_ms)) else { return false };
    //= spec/interlocking.md#atc-16-distance-of-a-code
    //# A distance MUST be taken for that of a code only if it is at least (c + b·a)² / 2b, with the speed c of the code, the brake b and the age a up to which it is obeyed.
    needed_room(KMH * u32::from(kmh), loses).is_some_and(|needed| needed <= room(brake, distance))
}
