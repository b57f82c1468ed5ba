//! The braking pattern: the highest speed from which a train still stops in a distance.
//!
//! In integers: with a deceleration of b mm/s² over d metres, the speed v in tenths of km/h satisfies
//! 125·v² ≤ 324·b·d < 125·(v + 1)². That is v² ≤ 2·b·d in these units: never above the real curve, and less than one unit
//! below it.
//!
//! Requirements: `spec/pattern.md`, PAT-1 to PAT-3.

use crate::distance::Metres;
use crate::speed::KmhTenths;
use crate::telegram::Gradient;
use atc_arithmetic::{energy, root};

/// The highest speed that the pattern gives: 409.5 km/h. Its square, and that of every lower speed, has 24 bits.
pub const MAX_SPEED: KmhTenths = KmhTenths(4095);

/// A deceleration in mm/s², 0 (no braking) to 65 535.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Deceleration(u16);

/// The highest deceleration that a brake may be given: 4095 mm/s².
const MAX_BRAKE: u16 = 4095;

impl Deceleration {
    /// The deceleration by a train's brake on the level: 1 to 4095 mm/s²; `None` for anything else.
    pub const fn brake(mm_s2: u16) -> Option<Self> {
        //= spec/pattern.md#pat-3-the-brake
        //# A brake of 0 or over 4095 mm/s² MUST be rejected.
        if mm_s2 == 0 || mm_s2 > MAX_BRAKE { None } else { Some(Self(mm_s2)) }
    }

    /// In mm/s².
    pub const fn mm_s2(self) -> u16 {
        self.0
    }

    /// What the brake achieves on a gradient; 0 if the train does not slow down.
    #[must_use]
    pub const fn on(self, gradient: Gradient) -> Self {
        //= spec/pattern.md#pat-2-the-gradient
        //# A falling gradient MUST take at least 9.84 mm/s² for each thousandth off the deceleration, and a rising one MUST add at most 9.69 mm/s² for each thousandth.
        let thousandths = gradient.0.unsigned_abs() as u16;
        if gradient.0 < 0 {
            // 9.84375 = 9 + 54/64, rounded up: at most 1260.
            Self(self.0.saturating_sub(thousandths * 9 + (thousandths * 54).div_ceil(64)))
        } else {
            // 9.6875 = 9 + 22/32, rounded down: at most 1230.
            Self(self.0.saturating_add(thousandths * 9 + thousandths * 22 / 32))
        }
    }
}

/// The highest speed from which a train stops within `distance`; at most [`MAX_SPEED`].
#[inline]
pub const fn pattern(deceleration: Deceleration, distance: Metres) -> KmhTenths {
    //= spec/pattern.md#pat-1-the-pattern
    //# The speed v MUST be the greatest, up to 409.5 km/h, with v² ≤ 2·b·d.
    KmhTenths(root(energy(deceleration.0, distance.0)))
}
