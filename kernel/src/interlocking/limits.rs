//! Speed limits of circuits.

use super::code::{MAX_CODES, SpeedCode};
use super::set::{CircuitId, CircuitSet};
use super::size::{Size, Small};

/// The highest speed code on each circuit: for each code the circuits where none above it may be told.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub struct SpeedLimits<Z: Size = Small>([CircuitSet<Z>; MAX_CODES]);

impl<Z: Size> SpeedLimits<Z> {
    /// No circuit has a limit.
    pub const NONE: Self = Self([CircuitSet::EMPTY; MAX_CODES]);

    /// On every circuit trains stop.
    pub const STOP: Self = {
        let mut circuits = Self::NONE.0;
        circuits[0] = CircuitSet::ALL;
        Self(circuits)
    };

    /// The limits whose circuits for each code are these. Every value is a limit.
    pub const fn from_parts(circuits: [CircuitSet<Z>; MAX_CODES]) -> Self {
        Self(circuits)
    }

    /// For each code the circuits where none above it may be told.
    pub const fn parts(self) -> [CircuitSet<Z>; MAX_CODES] {
        self.0
    }

    /// The highest code for a train that is on any of `circuits`, or runs over them.
    #[inline]
    pub fn over(&self, circuits: CircuitSet<Z>) -> SpeedCode {
        let mut code = SpeedCode::MOST;
        for (number, limited) in (0_u8..).zip(&self.0) {
            if limited.meets(circuits) {
                code = code.or_lower(SpeedCode(number));
            }
        }
        code
    }

    /// The highest code on one circuit.
    #[inline]
    pub fn on(&self, circuit: CircuitId) -> SpeedCode {
        self.over(circuit.alone())
    }

    /// These limits, and `code` at most on `circuits`. A code above the highest is no limit.
    #[inline]
    #[must_use]
    pub fn and_at_most(mut self, code: SpeedCode, circuits: CircuitSet<Z>) -> Self {
        for (number, limited) in (0_u8..).zip(&mut self.0) {
            *limited = limited.or(circuits.only_if(number == code.0));
        }
        self
    }

    /// The limits that are in one or the other.
    #[inline]
    #[must_use]
    pub fn and(mut self, others: Self) -> Self {
        for (limited, more) in self.0.iter_mut().zip(others.0) {
            *limited = limited.or(more);
        }
        self
    }

    /// These limits without those on `circuits`.
    #[inline]
    #[must_use]
    pub fn without(mut self, circuits: CircuitSet<Z>) -> Self {
        for limited in &mut self.0 {
            *limited = limited.without(circuits);
        }
        self
    }
}
