//! Track circuit tracking: which circuits count as occupied. Computed once a cycle and shared by interlocking and ATC.

use super::set::{CircuitSet, PerCircuit};
use super::size::{Size, Small};

/// What is remembered of each circuit: for how many cycles in a row it has been reported clear, up to the layout's number.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Track<Z: Size = Small> {
    pub(super) clear_for: PerCircuit<u8, Z>,
}

impl<Z: Size> Track<Z> {
    /// No circuit has been reported clear yet.
    pub const INITIAL: Self = Self { clear_for: PerCircuit::NONE };

    /// A state for proofs and models; not every value is valid.
    pub const fn from_parts(clear_for: PerCircuit<u8, Z>) -> Self {
        Self { clear_for }
    }

    /// For how many cycles in a row each circuit has been reported clear.
    pub const fn clear_for(&self) -> PerCircuit<u8, Z> {
        self.clear_for
    }

    /// Whether no count is over `clear`, the layout's number.
    pub fn is_valid(&self, clear: u8) -> bool {
        let mut valid = true;
        for count in &self.clear_for {
            valid &= *count <= clear;
        }
        valid
    }

    /// One cycle: `reported` are the circuits that are reported occupied; the answer is the circuits that count as occupied.
    #[inline]
    #[must_use]
    pub fn step(mut self, clear: u8, reported: CircuitSet<Z>) -> (Self, CircuitSet<Z>) {
        //= spec/interlocking.md#trk-1-occupancy
        //# A circuit MUST count as occupied as soon as it is reported occupied, and as clear only once it has been reported clear for the layout's number of cycles in a row.
        let mut occupied = CircuitSet::EMPTY;
        for (number, count) in self.clear_for.iter_mut().enumerate() {
            let circuit = CircuitSet::nth(number);
            let more = if *count < clear { *count + 1 } else { clear };
            *count = if reported.meets(circuit) { 0 } else { more };
            occupied = occupied.or(circuit.only_if(*count < clear));
        }
        (self, occupied)
    }
}
