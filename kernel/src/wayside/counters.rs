//! The numbers of the telegrams: one for each transmitter and carrier.

use crate::interlocking::{CircuitSet, Size, Small, Value};
use crate::telegram::Counter;

/// The circuits whose transmitters have taken the frames of the last cycle, those for both directions of travel; by carrier.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Framed<Z: Size = Small> {
    /// On the main carrier.
    pub main: CircuitSet<Z>,
    /// On the sub carrier.
    pub sub: CircuitSet<Z>,
}

/// The numbers of a circuit's next telegrams.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Counters {
    /// Of the main telegrams.
    pub main: Counter,
    /// Of the sub telegrams.
    pub sub: Counter,
}

impl Value for Counters {
    const NONE: Self = Self::START;
}

impl Counters {
    /// Where counting begins.
    pub const START: Self = Self { main: Counter(0), sub: Counter(0) };

    /// One cycle of the transmitter of `circuit`; `sent` are the circuits for which there were frames to take.
    #[inline]
    #[must_use]
    pub fn step<Z: Size>(self, circuit: CircuitSet<Z>, sent: CircuitSet<Z>, framed: Framed<Z>) -> Self {
        //= spec/wayside.md#way-7-the-counter
        //# The number of a circuit's telegrams on a carrier MUST advance by one in a cycle if its transmitter has taken those of the last cycle, and stay otherwise.
        let main = circuit.meets(sent.and(framed.main));
        let sub = circuit.meets(sent.and(framed.sub));
        Self {
            main: Counter(self.main.0.wrapping_add(u8::from(main))),
            sub: Counter(self.sub.0.wrapping_add(u8::from(sub))),
        }
    }
}
