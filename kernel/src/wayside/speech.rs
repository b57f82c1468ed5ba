//! From the movement that the ATC tells a train to what a transmitter sends: frames and codes, for each direction of travel.

use super::counters::Counters;
use super::signals::{Codes, Signals};
use crate::distance::Metres;
use crate::interlocking::{CircuitId, CircuitSet, Heading, Movement, PerCircuit, Size, Small, SpeedLimits};
use crate::telegram::{Frame, Main, Route, Sub, Telegram, encode};

/// What is told to trains of one direction of travel.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Speech {
    /// The main telegram.
    pub main: Main,
    /// The sub telegram.
    pub sub: Sub,
    /// The codes on both carriers.
    pub codes: Codes,
}

impl Speech {
    /// The same as it is sent. What trains decode of its frames are these telegrams (T-TEL-1).
    #[inline]
    #[must_use]
    pub fn feed(self) -> Feed {
        let Self { main, sub, codes } = self;
        Feed { main: encode(Telegram::Main(main)), sub: encode(Telegram::Sub(sub)), codes }
    }
}

/// What is sent to trains of one direction of travel.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Feed {
    /// The frame on the main carrier.
    pub main: Frame,
    /// The frame on the sub carrier.
    pub sub: Frame,
    /// The codes on both carriers.
    pub codes: Codes,
}

/// What a circuit's transmitter sends: the frames of both directions of travel in turn, and to each end of the circuit the codes of
/// the trains that travel towards it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Transmission {
    /// To trains that travel towards the left.
    pub left: Feed,
    /// To trains that travel towards the right.
    pub right: Feed,
}

impl Transmission {
    /// What trains of this direction of travel hear.
    pub const fn facing(&self, heading: Heading) -> Feed {
        match heading {
            Heading::Left => self.left,
            Heading::Right => self.right,
        }
    }
}

/// What is sent in a circuit.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Saying<Z: Size = Small> {
    /// The circuit.
    pub circuit: CircuitId,
    /// What its train is told.
    pub movement: Movement<Z>,
    /// The temporary restrictions of all circuits.
    pub restrictions: SpeedLimits<Z>,
    /// The numbers of its telegrams.
    pub counters: Counters,
}

impl<Z: Size> Signals<Z> {
    /// What is sent in a circuit whose train is told `movement`; none where the ATC is silent, and where there is nothing to be said of the circuit.
    #[inline]
    #[must_use]
    pub fn sent(
        &self,
        lengths: &PerCircuit<Metres, Z>,
        circuit: CircuitId,
        movement: Option<Movement<Z>>,
        restrictions: SpeedLimits<Z>,
        counters: Counters,
    ) -> Option<Transmission> {
        //= spec/wayside.md#way-21-silence
        //# A device MUST send nothing in a circuit in which its ATC is silent.
        self.transmission(lengths, Saying { circuit, movement: movement?, restrictions, counters })
    }

    /// What a circuit's transmitter sends; none if there is nothing to be said of the circuit. `lengths` are those of the layout.
    #[inline]
    #[must_use]
    pub fn transmission(&self, lengths: &PerCircuit<Metres, Z>, saying: Saying<Z>) -> Option<Transmission> {
        Some(Transmission {
            left: self.speech(lengths, saying, Heading::Left)?.feed(),
            right: self.speech(lengths, saying, Heading::Right)?.feed(),
        })
    }

    /// What is told to trains of one direction of travel; none if there is nothing to be said of the circuit. `lengths` are those of the layout.
    #[inline]
    #[must_use]
    pub fn speech(&self, lengths: &PerCircuit<Metres, Z>, saying: Saying<Z>, heading: Heading) -> Option<Speech> {
        let (fixed, length) = self.circuit(saying.circuit)?;
        let facing = fixed.facing(heading);
        let Saying { movement, counters, .. } = saying;
        //= spec/wayside.md#way-3-the-telegram
        //# A main telegram MUST be open only under the number that the circuit has for trains of the movement's direction of travel, and no farther beyond the exit than the lengths of the circuits that the movement grants.
        //= spec/wayside.md#way-5-stop
        //# Trains of a direction of travel for which there is no movement MUST be sent a closed telegram, the rank of speed 0 and its codes.
        let (route, word) = if movement.heading == Some(heading) {
            (Route::OpenFor(together(lengths, movement.hold)), self.word(movement.speed))
        } else {
            (Route::Closed, self.stop())
        };
        let main = Main { section: facing.section, counter: counters.main, route, speed: word.rank };
        //= spec/wayside.md#way-6-the-restriction
        //# The restriction in a sub telegram MUST NOT be above the temporary restriction of its circuit.
        let restriction = self.word(saying.restrictions.on(saying.circuit)).rank;
        let sub = Sub {
            section: facing.section,
            counter: counters.sub,
            length,
            gradient: facing.gradient,
            curve: facing.curve,
            restriction,
        };
        Some(Speech { main, sub, codes: word.codes })
    }
}

/// The length of `circuits` together; the longest that a telegram can tell if it is more.
#[inline]
fn together<Z: Size>(lengths: &PerCircuit<Metres, Z>, circuits: CircuitSet<Z>) -> Metres {
    let mut sum = Metres(0);
    for (number, length) in lengths.iter().enumerate() {
        if circuits.meets(CircuitSet::nth(number)) {
            sum = Metres(sum.0.saturating_add(length.0));
        }
    }
    sum
}
