//! The energy of a train that brakes, and the speed that belongs to it.

#[cfg(creusot)]
use creusot_std::prelude::{View, ensures, invariant, requires};

/// What is over the energy of every speed of the pattern: 125·4096².
pub const ENERGY_END: u32 = 2_097_152_000;

/// 250·b·d in squares of tenths of km/h, which is 125 times the square of the speed; at most [`ENERGY_END`] − 1. b is the
/// `deceleration` in mm/s², d the `distance` in metres.
///
/// 1 m/s is 36 tenths of km/h, so 2·b·d is 2 · 36² / 1000 · b · d = 324·b·d / 125.
#[cfg_attr(creusot, ensures(result@ < 2_097_152_000 && result@ <= 324 * deceleration@ * distance@))]
#[cfg_attr(creusot, ensures(result@ == 2_097_151_999 || result@ == 324 * deceleration@ * distance@))]
#[inline]
pub const fn energy(deceleration: u16, distance: u16) -> u32 {
    let product = deceleration as u32 * distance as u32;
    // 324 times a product under 2²³ has 32 bits, and 324 times 2²³ is over the end.
    let energy = if product < 8_388_608 { product * 324 } else { ENERGY_END };
    if energy < ENERGY_END { energy } else { ENERGY_END - 1 }
}

/// The greatest r with 125·r² ≤ `energy`, which is under [`ENERGY_END`]; so at most 4095.
#[cfg_attr(kani, kani::ensures(|root| *root < 4096 && 125 * u32::from(*root) * u32::from(*root) <= energy))]
#[cfg_attr(kani, kani::ensures(|root| energy >= ENERGY_END || 125 * (u32::from(*root) + 1) * (u32::from(*root) + 1) > energy))]
#[cfg_attr(creusot, requires(energy@ < 2_097_152_000))]
#[cfg_attr(creusot, ensures(125 * result@ * result@ <= energy@))]
#[cfg_attr(creusot, ensures(energy@ < 125 * (result@ + 1) * (result@ + 1)))]
#[allow(clippy::cast_possible_truncation, reason = "the root and its width are at most 4096")]
#[inline]
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
    root as u16
}
