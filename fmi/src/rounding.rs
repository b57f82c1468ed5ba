//! Numbers of a simulation as whole parts of a unit, rounded to the safe side.
//!
//! A number is compared with the double that is nearest to so many parts. So `44.9` is 449 tenths whichever way it is
//! rounded, and a number that is greater by the least bit is 450 when it is rounded up.

/// The least whole number of parts that is no less than the number. `parts` make one unit. The number must be finite and
/// at most 2⁵² parts in size: beyond that the end of a range is returned.
pub fn up(number: f64, parts: f64) -> i64 {
    let near = whole((number * parts).ceil());
    // The product may have been rounded across a whole number, either way.
    if value(near, parts) < number {
        near.saturating_add(1)
    } else if value(near.saturating_sub(1), parts) >= number {
        near.saturating_sub(1)
    } else {
        near
    }
}

/// The greatest whole number of parts that is no greater than the number. As for [`up`].
pub fn down(number: f64, parts: f64) -> i64 {
    up(-number, parts).saturating_neg()
}

/// The nearest whole number of parts; of two that are as near the one that is greater in size.
pub fn nearest(number: f64, parts: f64) -> i64 {
    whole((number * parts).round())
}

/// So many parts in the unit: the nearest double.
#[expect(clippy::cast_precision_loss, reason = "all ranges end below 2⁵²")]
pub fn value(count: i64, parts: f64) -> f64 {
    count as f64 / parts
}

#[expect(
    clippy::cast_possible_truncation,
    reason = "a cast of a double ends at the range, and 0 is for what is no number"
)]
fn whole(number: f64) -> i64 {
    number as i64
}
