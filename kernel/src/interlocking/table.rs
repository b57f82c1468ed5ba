//! The table that interlocking and ATC share: written once a cycle by the one, read by the other.

use super::set::{CircuitSet, SegmentSet};
use super::signal::Grant;
use super::size::{Size, Small};
use super::standing::Standing;
use crate::heading::Heading;

/// The number of a cycle, modulo 2^32: at 100 ms the same comes again after 13 years, at 10 ms after 497 days.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub struct Epoch(pub u32);

impl Epoch {
    /// The next cycle.
    #[must_use]
    pub const fn next(self) -> Self {
        Self(self.0.wrapping_add(1))
    }
}

/// What the interlocking tells the ATC.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Contents<const R: usize, Z: Size = Small> {
    /// The circuits that count as occupied.
    pub occupied: CircuitSet<Z>,
    /// The circuits that are blocked.
    pub blocked: CircuitSet<Z>,
    /// What each route grants.
    pub grants: [Grant<Z>; R],
    /// The segments towards the station.
    pub toward: SegmentSet<Z>,
    /// The segments away from the station, as far as the neighbour permits this one to send.
    pub away: SegmentSet<Z>,
    /// Where trains may stand, and the speed limits there.
    pub standing: Standing<R, Z>,
}

/// The contents of one cycle, with what tells a stale or damaged table.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Table<const R: usize, Z: Size = Small> {
    epoch: Epoch,
    check: u64,
    contents: Contents<R, Z>,
}

impl<const R: usize, Z: Size> Table<R, Z> {
    /// A table that nobody can read: its check is wrong whatever the epoch.
    pub const UNREADABLE: Self = Self {
        epoch: Epoch(0),
        check: 0,
        contents: Contents {
            occupied: CircuitSet::ALL,
            blocked: CircuitSet::ALL,
            grants: [Grant::NONE; R],
            toward: SegmentSet::EMPTY,
            away: SegmentSet::EMPTY,
            standing: Standing::UNKNOWN,
        },
    };

    /// The table of one cycle.
    #[inline]
    pub fn write(epoch: Epoch, contents: Contents<R, Z>) -> Self {
        Self { epoch, check: fold(epoch, &contents), contents }
    }

    /// A table as it may be after damage: for proofs and fault injection.
    pub const fn from_parts(epoch: Epoch, check: u64, contents: Contents<R, Z>) -> Self {
        Self { epoch, check, contents }
    }

    /// The table's parts: epoch, check word and contents, for proofs and fault injection.
    pub const fn parts(&self) -> (Epoch, u64, Contents<R, Z>) {
        (self.epoch, self.check, self.contents)
    }

    /// The contents, if they are of this cycle and undamaged.
    #[inline]
    pub fn read(&self, epoch: Epoch) -> Option<Contents<R, Z>> {
        //= spec/interlocking.md#atc-5-shared-table
        //# The contents of the shared table MUST be reachable only if its epoch is that of the cycle and its check is right.
        if self.epoch == epoch && self.check == fold(self.epoch, &self.contents) { Some(self.contents) } else { None }
    }
}

/// The check word: every bit of the table goes into exactly one bit of it, at a place that depends on where it stands, so that one
/// wrong bit always shows.
#[inline]
fn fold<const R: usize, Z: Size>(epoch: Epoch, contents: &Contents<R, Z>) -> u64 {
    let mut check = contents.away.fold(contents.toward.fold(u64::from(epoch.0).rotate_left(16)));
    check = contents.blocked.fold(contents.occupied.fold(check));
    for grant in &contents.grants {
        check = grant.last.fold(grant.circuits.fold(grant.train.fold(check)));
        let right = u64::from(grant.heading == Heading::Right);
        check = check.rotate_left(5) ^ (u64::from(grant.complete) | right << 1 | u64::from(grant.speed.0) << 8);
    }
    for limited in contents.standing.limits.parts() {
        check = limited.fold(check);
    }
    for body in contents.standing.bodies {
        check = body.fold(check);
    }
    !contents.standing.loose.fold(check)
}
