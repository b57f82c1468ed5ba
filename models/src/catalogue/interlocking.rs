//! The models of the interlocking.

use crate::check::Entry;

mod beside;
mod between;
mod called;
mod counted;
mod counted_between;
mod line;
mod others;
mod passing_loop;
mod reversal;
mod shared;
mod wrong;

/// Stations with trains, and what happens where a condition is not kept.
pub(super) fn entries() -> Vec<Entry> {
    let mut entries = passing_loop::entries();
    entries.extend(others::entries());
    entries.extend(called::entries());
    entries.extend(reversal::entries());
    entries.extend(beside::entries());
    entries.extend(line::entries());
    entries.extend(between::entries());
    entries.extend(counted::entries());
    entries.extend(counted_between::entries());
    entries.extend(wrong::entries());
    entries
}
