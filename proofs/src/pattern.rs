//! The braking pattern: theorem T-PAT-1 to T-PAT-3.

use crate::{Engine, Harness, any_byte, any_u32};
use atc_arithmetic::{ENERGY_END, energy, root};
use atc_kernel::distance::Metres;
use atc_kernel::pattern::{Deceleration, MAX_SPEED, pattern};
use atc_kernel::speed::KmhTenths;
use atc_kernel::telegram::Gradient;

/// The harnesses of this module.
#[cfg(not(chosen))]
pub const ALL: &[Harness] =
    &[t_pat_1::HARNESS, t_pat_1_root::HARNESS, t_pat_2::HARNESS, t_pat_3::HARNESS, pat_3::HARNESS];

/// How often the search for a root halves what is left of 4096 numbers: the longest loop.
pub(crate) const HALVINGS: usize = 4096_u32.ilog2() as usize;

/// An arbitrary brake.
pub(crate) fn any_brake<E: Engine + ?Sized>(e: &mut E) -> Option<Deceleration> {
    let brake = Deceleration::brake(e.word("brake (mm/s²)", 600..=1200));
    e.assume(brake.is_some());
    brake
}

/// An arbitrary gradient.
pub(crate) fn any_gradient<E: Engine + ?Sized>(e: &mut E, what: &'static str) -> Gradient {
    Gradient(i8::from_le_bytes([any_byte(e, what, 0..=255)]))
}

harness! {
    /// The pattern is exact over the whole range: with b mm/s² over d metres, v tenths of km/h is the greatest speed up
    /// to 409.5 km/h with 125·v² ≤ 324·b·d, that is v² ≤ 2·b·d in metres and seconds. `t_pat_1_root` proves it of every number in the
    /// place of 324·b·d; here that number is found to be the right one.
    t_pat_1(e)
    theorem "T-PAT-1";
    requirements ["PAT-1"];
    assumptions [];
    bound "";
    cases 1;
    unwind 13 = 1 + crate::pattern::HALVINGS;
    solver kissat;
    claims {
        Energy: "the number of which the root is taken is 324·b·d, or 125·4096² − 1 where that is less",
        Root: "the speed of the pattern is the root of that number",
    }
    covers {
        Whole: "324·b·d is less",
        Capped: "125·4096² − 1 is less",
    }
    {
        let Some(brake) = any_brake(e) else { return };
        let deceleration = brake.on(any_gradient(e, "gradient (‰, two's complement)"));
        let distance = e.word("distance (m)", 0..=10_000);
        let number = energy(deceleration.mm_s2(), distance);
        let product = u32::from(deceleration.mm_s2()) * u32::from(distance);
        // The least product of which 324 times is not under 125·4096² = 2 097 152 000.
        let over = 6_472_692;
        let expected = if product < over { product * 324 } else { 2_097_151_999 };
        e.claim(Claim::Energy as u32, number == expected && (over - 1) * 324 < 2_097_152_000 && over * 324 >= 2_097_152_000);
        e.claim(Claim::Root as u32, pattern(deceleration, Metres(distance)).0 == root(number));
        e.cover(Cover::Whole as u32, 0 < product && product < over);
        e.cover(Cover::Capped as u32, product >= over);
    }
}

harness! {
    /// The root is exact for every number under 125·4096²: r is the greatest with 125·r² not above it.
    t_pat_1_root(e)
    theorem "T-PAT-1";
    requirements ["PAT-1"];
    assumptions [];
    bound "";
    cases 1;
    unwind 13 = 1 + crate::pattern::HALVINGS;
    solver kissat;
    claims {
        NeverAbove: "125·r² ≤ n: never above the real curve",
        NoLower: "n < 125·(r + 1)²: one unit more would be above it",
        Range: "r is at most 4095, which is the highest speed of the pattern",
    }
    covers {
        Exactly: "n is 125 times the square of a number above 1000",
        Below: "n is one less than that",
        Highest: "the highest speed",
    }
    {
        let n = match e.word("n (0: a square, 1: one less, 2: the highest, else any)", 0..=3) {
            0 => square(e.word("its root", 1001..=4095) & 4095),
            1 => square(e.word("its root", 1001..=4095) & 4095).saturating_sub(1),
            2 => ENERGY_END - 1,
            _ => any_u32(e, "n", 0..=1000) & 0x7FFF_FFFF,
        };
        e.assume(n < ENERGY_END);
        let r = root(n);
        e.claim(Claim::NeverAbove as u32, square(r) <= n);
        e.claim(Claim::Range as u32, r <= 4095 && MAX_SPEED == KmhTenths(4095) && ENERGY_END == 125 * 4096 * 4096);
        e.claim(Claim::NoLower as u32, n < square((r & 4095) + 1));
        e.cover(Cover::Exactly as u32, r > 1000 && square(r) == n);
        e.cover(Cover::Below as u32, r > 1000 && square((r & 4095) + 1) == n + 1);
        e.cover(Cover::Highest as u32, r == 4095);
    }
}

/// 125 times the square of a number up to 4096.
fn square(root: u16) -> u32 {
    let root = u32::from(root & 0x1FFF);
    125 * root * root
}

harness! {
    /// A falling gradient takes at least 9.84 mm/s² for each thousandth off the deceleration, and less than 9.85 and one;
    /// a rising one adds at most 9.69, and more than 9.68 less one.
    t_pat_2(e)
    theorem "T-PAT-2";
    requirements ["PAT-2"];
    assumptions ["gravity"];
    built_in &[("gravity", "the claims have the acceleration of gravity in their numbers")];
    bound "";
    cases 1;
    unwind 13 = 1 + crate::pattern::HALVINGS;
    claims {
        Falling: "falling: at least 9.84 mm/s² per thousandth less, or no deceleration",
        Rising: "rising: at most 9.69 mm/s² per thousandth more",
        Close: "no more than that and one unit is given away",
        Level: "on the level the brake alone counts",
    }
    covers {
        TooSteep: "a gradient on which the train does not slow down",
        Falls: "a falling gradient",
        Rises: "a rising gradient",
    }
    {
        let Some(brake) = any_brake(e) else { return };
        let Gradient(gradient) = any_gradient(e, "gradient (‰, two's complement)");
        let (level, result) = (i32::from(brake.mm_s2()), i32::from(brake.on(Gradient(gradient)).mm_s2()));
        let g = i32::from(gradient);
        let change = (result - level) * 100;
        e.claim(Claim::Falling as u32, g >= 0 || result == 0 || change <= 984 * g);
        e.claim(Claim::Rising as u32, g < 0 || change <= 969 * g);
        let close = if g < 0 { change > 985 * g - 100 } else { change > 968 * g - 100 };
        e.claim(Claim::Close as u32, close || (result == 0 && level * 100 + 984 * g <= 0));
        e.claim(Claim::Level as u32, g != 0 || result == level);
        e.cover(Cover::TooSteep as u32, result == 0);
        e.cover(Cover::Falls as u32, g < 0 && result > 0);
        e.cover(Cover::Rises as u32, g > 0);
    }
}

harness! {
    /// A weaker brake, and a gradient that falls more or rises less, never give a higher deceleration. So, the pattern being
    /// exact (T-PAT-1), they never permit more speed, nor does a shorter distance.
    t_pat_3(e)
    theorem "T-PAT-3";
    requirements ["PAT-1", "PAT-2"];
    assumptions [];
    bound "";
    cases 1;
    unwind 13 = 1 + crate::pattern::HALVINGS;
    claims {
        Gradient: "a worse gradient never gives a higher deceleration",
        Brake: "nor does a weaker brake",
    }
    covers {
        Steeper: "two gradients with two decelerations",
    }
    {
        let (Some(weaker), Some(stronger)) = (any_brake(e), any_brake(e)) else { return };
        let worse = any_gradient(e, "worse gradient (‰, two's complement)");
        let better = any_gradient(e, "better gradient (‰, two's complement)");
        e.claim(Claim::Gradient as u32, worse > better || weaker.on(worse) <= weaker.on(better));
        e.claim(Claim::Brake as u32, weaker > stronger || weaker.on(worse) <= stronger.on(worse));
        e.cover(Cover::Steeper as u32, worse < better && weaker.on(worse) < weaker.on(better));
    }
}

harness! {
    /// A brake is 1 to 4095 mm/s².
    pat_3(e)
    theorem "T-PAT-1";
    requirements ["PAT-3"];
    assumptions [];
    bound "";
    cases 1;
    unwind 13 = 1 + crate::pattern::HALVINGS;
    claims {
        Exact: "accepted if and only if it is 1 to 4095 mm/s², and kept as it is",
    }
    covers {
        Accepted: "a brake is accepted",
        Refused: "a brake is refused",
    }
    {
        let asked = e.word("brake (mm/s²)", 0..=4200);
        let brake = Deceleration::brake(asked);
        let right = (1..=4095).contains(&asked);
        e.claim(Claim::Exact as u32, brake.is_some() == right && brake.is_none_or(|brake| brake.mm_s2() == asked));
        e.cover(Cover::Accepted as u32, right);
        e.cover(Cover::Refused as u32, !right);
    }
}
