//! The aspects of a line: which permitted speeds they name.

use super::{AspectId, MAX_ASPECTS};
use crate::speed::KmhTenths;

/// One to 16 permitted speeds, strictly rising: the aspect of rank `i` permits speed `i`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct AspectTable {
    speeds: [KmhTenths; MAX_ASPECTS],
    count: u8,
}

/// Which rule a table of aspects breaks. Source: `spec/aspect.md`, TIME-4.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TableError {
    /// The table names no aspect.
    Empty,
    /// The table names more than 16 aspects.
    TooMany,
    /// The speed at this place (from 0) is not above the one before it.
    NotRising(usize),
}

impl AspectTable {
    /// Checks and keeps the permitted speeds, the lowest first.
    ///
    /// # Errors
    /// The first rule that is broken, in the order of [`TableError`].
    pub fn new(speeds: &[KmhTenths]) -> Result<Self, TableError> {
        //= spec/aspect.md#time-4-the-aspect-table
        //# An aspect table that is empty, has more than 16 entries or is not strictly rising MUST be rejected.
        if speeds.is_empty() {
            return Err(TableError::Empty);
        }
        if speeds.len() > MAX_ASPECTS {
            return Err(TableError::TooMany);
        }
        let mut table = Self { speeds: [KmhTenths(0); MAX_ASPECTS], count: 0 };
        for (place, speed) in speeds.iter().enumerate() {
            if place > 0 && *speed <= speeds[place - 1] {
                return Err(TableError::NotRising(place));
            }
            table.speeds[place] = *speed;
            table.count += 1;
        }
        Ok(table)
    }

    /// The aspect that permits exactly `speed`; `None` if the table has none: such a code is no signal.
    pub fn aspect(&self, speed: KmhTenths) -> Option<AspectId> {
        self.speeds().iter().position(|known| *known == speed).and_then(|rank| AspectId::new(u8::try_from(rank).ok()?))
    }

    /// The speed that `aspect` permits; `None` if the table has no such aspect.
    pub const fn speed(&self, aspect: AspectId) -> Option<KmhTenths> {
        let mut speed = None;
        // Compared, not indexed: a prover takes a constant place for each.
        let mut rank = 0;
        while rank < MAX_ASPECTS {
            if rank == aspect.rank() as usize && rank < self.count as usize {
                speed = Some(self.speeds[rank]);
            }
            rank += 1;
        }
        speed
    }

    /// The permitted speeds, the lowest first: 1 to 16 of them.
    pub fn speeds(&self) -> &[KmhTenths] {
        &self.speeds[..usize::from(self.count)]
    }
}
