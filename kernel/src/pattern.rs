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
#[cfg(creusot)]
use creusot_std::prelude::{View, ensures, invariant, requires};

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
    KmhTenths(root(energy(deceleration, distance)))
}

/// What is over the energy of every speed of the pattern: 125·4096².
pub const ENERGY_END: u32 = 125 << 24;

/// 250·b·d in squares of tenths of km/h, which is 125 times the square of the speed; at most [`ENERGY_END`] − 1.
///
/// 1 m/s is 36 tenths of km/h, so 2·b·d is 2 · 36² / 1000 · b · d = 324·b·d / 125.
#[cfg_attr(creusot, ensures(result@ < 2_097_152_000 && result@ <= 324 * deceleration.0@ * distance.0@))]
#[cfg_attr(creusot, ensures(result@ == 2_097_151_999 || result@ == 324 * deceleration.0@ * distance.0@))]
#[inline]
pub const fn energy(deceleration: Deceleration, distance: Metres) -> u32 {
    let product = deceleration.0 as u32 * distance.0 as u32;
    // 324 times a product under 2²³ has 32 bits, and 324 times 2²³ is over the end.
    let energy = if product < 1 << 23 { product * 324 } else { ENERGY_END };
    if energy < ENERGY_END { energy } else { ENERGY_END - 1 }
}

/// The greatest r with 125·r² ≤ `energy`, which is under [`ENERGY_END`]; so at most 4095.
#[cfg_attr(kani, kani::ensures(|root| *root < 4096 && 125 * u32::from(*root) * u32::from(*root) <= energy))]
#[cfg_attr(kani, kani::ensures(|root| energy >= ENERGY_END || 125 * (u32::from(*root) + 1) * (u32::from(*root) + 1) > energy))]
#[cfg_attr(creusot, requires(energy@ < 2_097_152_000))]
#[cfg_attr(creusot, ensures(125 * result@ * result@ <= energy@))]
#[cfg_attr(creusot, ensures(energy@ < 125 * (result@ + 1) * (result@ + 1)))]
#[inline]
#[allow(clippy::cast_possible_truncation, reason = "at most 4095")]
pub const fn root(energy: u32) -> u16 {
    let mut root = 0_u32;
    // 125 times its square.
    let mut spent = 0_u32;
    // The root is in root .. root + width. The width halves twelve times.
    let mut width = 4096_u32;
    #[cfg_attr(creusot, invariant(width@ >= 1 && root@ + width@ <= 4096))]
    #[cfg_attr(creusot, invariant(spent@ == 125 * root@ * root@ && spent@ <= energy@))]
    #[cfg_attr(creusot, invariant(energy@ < 125 * (root@ + width@) * (root@ + width@)))]
    while width > 1 {
        let half = width / 2;
        let more = 125 * (2 * root + half) * half;
        if spent + more <= energy {
            root += half;
            spent += more;
        }
        width -= half;
    }
    // At most 4095.
    root as u16
}
