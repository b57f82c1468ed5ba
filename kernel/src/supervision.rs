//! Speed supervision: the brake from the train's speed and the permitted one (JP3886280B2 \[0009\]).
//!
//! Requirements: `spec/supervision.md`, SUP-1 to SUP-3. The only thing remembered is the previous brake command,
//! and only a release margin makes it matter.

use crate::Machine;
use crate::speed::{KmhTenths, RawKmhTenths};

/// The parameters, checked: `margin ≤ maximum`, `1 ≤ maximum`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Supervision {
    maximum: KmhTenths,
    margin: KmhTenths,
}

/// Which rule the parameters break. Source: `spec/supervision.md`, SUP-3.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SupervisionError {
    /// The highest plausible speed is 0.
    NoMaximum,
    /// The release margin is above the highest plausible speed.
    MarginAboveMaximum,
}

/// What is read each cycle. `None`: there is no such value.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Speeds {
    /// The measured speed; missing, negative or above the maximum is implausible.
    pub measured: Option<RawKmhTenths>,
    /// The permitted speed; missing while nothing is displayed.
    pub permitted: Option<RawKmhTenths>,
}

/// The brake command, ordered by what it does: more braking is the safer one.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Brake {
    /// No braking by this device.
    Release,
    /// Service brake.
    Service,
    /// Emergency brake.
    Emergency,
}

impl Supervision {
    /// Checks the highest plausible speed and the release margin, both in tenths of km/h.
    ///
    /// # Errors
    /// The first rule that is broken, in the order of [`SupervisionError`].
    pub const fn new(maximum: KmhTenths, margin: KmhTenths) -> Result<Self, SupervisionError> {
        //= spec/supervision.md#sup-3-the-constructor
        //# A highest plausible speed of 0 and a release margin above it MUST be rejected.
        if maximum.0 == 0 {
            Err(SupervisionError::NoMaximum)
        } else if margin.0 > maximum.0 {
            Err(SupervisionError::MarginAboveMaximum)
        } else {
            Ok(Self { maximum, margin })
        }
    }

    /// The highest plausible speed.
    pub const fn maximum(&self) -> KmhTenths {
        self.maximum
    }

    /// How far below the permitted speed the train must be before a brake that is on is released.
    pub const fn margin(&self) -> KmhTenths {
        self.margin
    }
}

impl Default for Supervision {
    /// 400 km/h and no margin.
    fn default() -> Self {
        Self { maximum: KmhTenths(4000), margin: KmhTenths(0) }
    }
}

/// The brake command for these speeds, given the previous command.
pub fn step(parameters: Supervision, previous: Brake, speeds: Speeds) -> Brake {
    //= spec/supervision.md#sup-2-implausible
    //# A missing, negative or too high measured speed, and a missing or negative permitted speed, MUST command the emergency brake.
    let (Some(RawKmhTenths(measured)), Some(RawKmhTenths(permitted))) = (speeds.measured, speeds.permitted) else {
        return Brake::Emergency;
    };
    if measured < 0 || measured > i32::from(parameters.maximum.0) || permitted < 0 {
        return Brake::Emergency;
    }
    //= spec/supervision.md#sup-1-the-brake
    //# The service brake MUST be commanded when the measured speed is above the permitted speed, and released when it is not, except that a configured release margin may delay the release while the previous command is a brake.
    let braking = previous != Brake::Release;
    // At or above 0, so that a train at a stand is always released.
    let threshold = if braking { permitted.saturating_sub(i32::from(parameters.margin.0)).max(0) } else { permitted };
    if measured > threshold { Brake::Service } else { Brake::Release }
}

impl Machine for Supervision {
    type State = Brake;
    type Input = Speeds;
    type Output = Brake;

    const SAFE: Brake = Brake::Emergency;

    fn initial(&self) -> Brake {
        Brake::Emergency
    }

    fn step(&self, previous: Brake, speeds: Speeds) -> (Brake, Brake) {
        let brake = step(*self, previous, speeds);
        (brake, brake)
    }
}
