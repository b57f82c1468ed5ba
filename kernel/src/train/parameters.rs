//! The parameters of the on-board device, checked against each other.

use crate::aspect::{Acceptance, AspectTable};
use crate::code::{Code, CodeTable, MAX_CODES};
use crate::permitted::Permitted;
use crate::position::Position;
use crate::speed::KmhTenths;
use crate::supervision::Supervision;
use crate::time::Ticks;

/// The parts of the device as a configuration gives them: each is checked by itself, none against another.
///
/// There is one table of the line's speeds, that of `permitted`: it ranks the codes, the telegrams and the display.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Parts<const N: usize> {
    /// The speeds that pairs of codes name.
    pub codes: CodeTable,
    /// The times of aspect acceptance.
    pub acceptance: Acceptance<N>,
    /// The permitted speed, with the table of the line's speeds.
    pub permitted: Permitted,
    /// The brake.
    pub supervision: Supervision,
    /// The position; `None` for a train that does not measure it: every distance begins at the exit of its section.
    pub position: Option<Position>,
}

/// The on-board device of a train: its parts, checked against each other, for the `N` lowest ranks (1 to 16).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Train<const N: usize>(Parts<N>);

/// Which rule the parts break together. Source: `spec/train.md`, TRN-8.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TrainError {
    /// The line has more speeds than the acceptance has ranks, `N`: the highest would never be accepted.
    TooManyRanks,
    /// The highest speed of the line is above the highest plausible one: whoever ran at it would be stopped.
    ImplausibleSpeed(KmhTenths),
    /// The pair of these codes (places from 0, main then sub) names a speed that is not in the line's table.
    UnknownSpeed(Code, Code),
}

impl<const N: usize> Train<N> {
    /// Checks the parts against each other and keeps them.
    ///
    /// # Errors
    /// The first rule that is broken, in the order of [`TrainError`]; of several pairs of codes the first one.
    pub fn new(parts: Parts<N>) -> Result<Self, TrainError> {
        //= spec/train.md#trn-8-the-constructor
        //# The constructor MUST reject more speeds in the line's table than the acceptance has ranks, a speed there above the highest plausible one, and a pair of codes whose speed is not in that table.
        let speeds = parts.permitted.settings().speeds;
        if speeds.speeds().len() > N {
            return Err(TrainError::TooManyRanks);
        }
        if let Some(highest) = speeds.speeds().last() {
            if *highest > parts.supervision.maximum() {
                return Err(TrainError::ImplausibleSpeed(*highest));
            }
        }
        for main in 0..MAX_CODES {
            for sub in 0..MAX_CODES {
                let (Some(main), Some(sub)) = (code(main), code(sub)) else { continue };
                let named = parts.codes.speed(Some(main), Some(sub));
                if named.is_some_and(|speed| speeds.aspect(speed).is_none()) {
                    return Err(TrainError::UnknownSpeed(main, sub));
                }
            }
        }
        Ok(Self(parts))
    }

    /// The parts as they were given.
    pub const fn parts(&self) -> &Parts<N> {
        &self.0
    }

    /// The line's speeds: what a rank means to this train, in a code, in a telegram and in the cab.
    pub const fn speeds(&self) -> &AspectTable {
        &self.0.permitted.settings().speeds
    }

    /// The age in cycles of the oldest evidence that anything can be permitted by: T2 + T3 of a code since it was
    /// last detected, or the life of a main telegram since it was sent. The device is stopped when neither was renewed for
    /// so long (T-TRN-3).
    ///
    /// Sub telegrams permit nothing; what they restrict is kept for a life of its own
    /// ([`crate::permitted::Settings::fixed_life`]).
    pub const fn oldest(&self) -> Ticks {
        //= spec/train.md#trn-10-the-oldest-evidence
        //# The oldest evidence MUST be the greater of T2 + T3 and the life of a main telegram.
        let (code, telegram) = (self.0.acceptance.times.expiry(), self.0.permitted.settings().life);
        if code.0 > telegram.0 { code } else { telegram }
    }
}

/// The code at a place under [`MAX_CODES`].
fn code(place: usize) -> Option<Code> {
    Code::new(place.to_le_bytes()[0])
}
