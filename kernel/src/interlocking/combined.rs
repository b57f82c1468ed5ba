//! Interlocking and ATC as one machine: its output is everything that leaves the device, telegrams included.

use super::atc::Movement;
use super::layout::Layout;
use super::set::PerCircuit;
use super::size::{Size, Small};
use super::state::State;
use super::table::{Epoch, Table};
use super::{Input, Output};
use crate::Machine;

/// The device with its ATC. Its two channels are compared over all that it puts out ([`crate::duplex`]).
#[derive(Clone, Copy, Debug)]
pub struct Combined<'a, const R: usize, const P: usize, const N: usize, const S: usize, Z: Size = Small>(
    pub &'a Layout<R, P, N, S, Z>,
);

/// What the device remembers.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Memory<const R: usize, const S: usize, Z: Size = Small> {
    /// The interlocking.
    pub interlocking: State<R, S, Z>,
    /// The ATC's own count of the cycles: a table is read by it, and never by the number that stands in the table.
    pub cycle: Epoch,
}

impl<const R: usize, const S: usize, Z: Size> Memory<R, S, Z> {
    /// The most restrictive memory.
    pub const INITIAL: Self = Self { interlocking: State::INITIAL, cycle: Epoch(0) };

    /// Whether the device can have this memory.
    pub fn is_valid<const P: usize, const N: usize>(&self, layout: &Layout<R, P, N, S, Z>) -> bool {
        self.interlocking.is_valid(layout) && self.interlocking.epoch == self.cycle
    }
}

/// Everything that leaves the device in one logic cycle.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Commands<const R: usize, Z: Size = Small> {
    /// What the interlocking commands.
    pub interlocking: Output<R, Z>,
    /// The telegram of each circuit. `None`: nothing is sent there.
    pub telegrams: PerCircuit<Option<Movement<Z>>, Z>,
}

impl<const R: usize, const P: usize, const N: usize, const S: usize, Z: Size> Combined<'_, R, P, N, S, Z> {
    /// One logic cycle of the ATC: its count of the cycles, and the telegrams from the table.
    #[inline]
    #[must_use]
    pub fn speak(&self, cycle: Epoch, table: &Table<R, Z>) -> (Epoch, PerCircuit<Option<Movement<Z>>, Z>) {
        //= spec/interlocking.md#atc-15-count-of-its-own
        //# The ATC MUST read the table by a count of the cycles of its own, which is the same again after 2^32 cycles at the earliest.
        let cycle = cycle.next();
        (cycle, self.0.telegrams(table, cycle))
    }
}

impl<const R: usize, const P: usize, const N: usize, const S: usize, Z: Size> Machine for Combined<'_, R, P, N, S, Z> {
    type State = Memory<R, S, Z>;
    type Input = Input<Z>;
    type Output = Commands<R, Z>;

    //= spec/interlocking.md#atc-14-what-is-compared
    //# What the two channels compare MUST include every telegram, and a device whose channels differ MUST send none.
    const SAFE: Self::Output = Commands { interlocking: Layout::<R, P, N, S, Z>::SAFE, telegrams: PerCircuit::NONE };

    fn initial(&self) -> Self::State {
        Memory::INITIAL
    }

    fn step(&self, memory: Self::State, input: Self::Input) -> (Self::State, Self::Output) {
        let (state, output) = self.0.cycle(memory.interlocking, input);
        let (cycle, telegrams) = self.speak(memory.cycle, &output.table);
        (Memory { interlocking: state, cycle }, Commands { interlocking: output, telegrams })
    }
}
