//! Two channels: every machine runs twice on the same inputs, and the two are compared each cycle
//! (JP3886280B2 \[0007\], the two CPUs and the bus comparator).
//!
//! Requirements: `spec/duplex.md`, DUP-1 and DUP-2. States are compared as well as outputs: a fault that does not
//! show in the output yet is found in the same cycle.

use crate::Machine;

/// An output on which two channels agree. Only [`Duplex::step`] makes one, out of the outputs of both channels, so that
/// the comparison cannot be left out or be made of one channel with itself:
///
/// ```compile_fail,E0423
/// let forged = atc_kernel::duplex::Agreed(7_u8); // the field is private
/// ```
///
/// ```compile_fail,E0624
/// let forged = atc_kernel::duplex::Agreed::compare(7_u8, 7_u8); // and so is the comparison
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Agreed<T>(T);

impl<T: Copy + Eq> Agreed<T> {
    /// The common value of the two channels; `None` if they differ.
    fn compare(a: T, b: T) -> Option<Self> {
        //= spec/duplex.md#dup-2-no-way-round-the-comparison
        //# An agreed output MUST be constructible only from two equal channel outputs.
        if a == b { Some(Self(a)) } else { None }
    }

    /// The agreed value.
    pub fn get(self) -> T {
        self.0
    }
}

/// One of the two channels.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Channel<S> {
    /// The machine's state in this channel.
    pub state: S,
    /// 0 while this channel has seen no difference; any other value is tripped, so that no single bit clears it.
    pub trip: u8,
}

/// The value of a channel's trip word once it has seen a difference.
pub const TRIPPED: u8 = 0xFF;

/// A machine in two channels. Its state is open to fault injection; what it puts out is not.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Duplex<S> {
    /// Channel A.
    pub a: Channel<S>,
    /// Channel B.
    pub b: Channel<S>,
}

impl<S: Copy + Eq> Duplex<S> {
    /// Both channels in the machine's initial state, no difference seen. Also what a maintenance reset returns to.
    pub fn initial<M: Machine<State = S>>(machine: &M) -> Self {
        let channel = Channel { state: machine.initial(), trip: 0 };
        Self { a: channel, b: channel }
    }

    /// Whether a difference has been seen and no maintenance reset has been made since.
    pub fn is_tripped(&self) -> bool {
        self.a.trip != 0 || self.b.trip != 0
    }

    /// One logic cycle in both channels. `None` is the safe output: it stays until a maintenance reset.
    pub fn step<M: Machine<State = S>>(self, machine: &M, input: M::Input) -> (Self, Option<Agreed<M::Output>>) {
        let (state_a, output_a) = machine.step(self.a.state, input);
        let (state_b, output_b) = machine.step(self.b.state, input);
        //= spec/duplex.md#dup-1-comparison
        //# A difference between the two channels in the state before the cycle, in the state after it, or in the output MUST latch the safe output until a maintenance reset.
        let agree = self.a.state == self.b.state && state_a == state_b && !self.is_tripped();
        let output = if agree { Agreed::compare(output_a, output_b) } else { None };
        let trip = if output.is_some() { 0 } else { TRIPPED };
        (Self { a: Channel { state: state_a, trip }, b: Channel { state: state_b, trip } }, output)
    }
}

/// What the device commands: the agreed output, or the machine's safe one.
pub fn output<M: Machine>(agreed: Option<Agreed<M::Output>>) -> M::Output {
    match agreed {
        Some(agreed) => agreed.get(),
        None => M::SAFE,
    }
}
