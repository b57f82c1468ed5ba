//! Bit error rates in white Gaussian noise, from theory.
//!
//! Sources: J. G. Proakis, *Digital Communications*, 4th edition, chapter 5, for coherent MSK and for differential detection
//! of binary signals; the averages over the envelope are ours.

use std::f64::consts::{PI, SQRT_2, TAU};

use crate::filter::sinc;
use crate::units::{Decibels, Hertz};

/// Phases of a code over which is averaged.
const STEPS: u32 = 720;

/// The probability that a standard normal value exceeds `x`.
pub fn q_function(x: f64) -> f64 {
    erfc(x / SQRT_2) / 2.0
}

/// The complementary error function: by its series near zero, by its continued fraction elsewhere; relative error under 10⁻¹⁰.
fn erfc(x: f64) -> f64 {
    if x < 0.0 {
        return 2.0 - erfc(-x);
    }
    if x < 2.0 {
        let mut term = x;
        let mut sum = x;
        for n in 1..60 {
            let n = f64::from(n);
            term *= -x * x / n;
            sum += term / (2.0 * n + 1.0);
        }
        return 1.0 - 2.0 / PI.sqrt() * sum;
    }
    let mut fraction = x;
    for n in (1..=80).rev() {
        fraction = x + f64::from(n) / 2.0 / fraction;
    }
    (-x * x).exp() / (PI.sqrt() * fraction)
}

/// Coherent MSK whose data are the signs themselves: Q(√(2 Eb/N0)).
pub fn coherent(ratio: Decibels) -> f64 {
    q_function((2.0 * ratio.power()).sqrt())
}

/// Coherent MSK whose data are the changes of the frequency, as here: two signs decide one bit, and one of them is wrong.
pub fn differentially_decoded(ratio: Decibels) -> f64 {
    let p = coherent(ratio);
    2.0 * p * (1.0 - p)
}

/// Detection of the phase change over one bit without a carrier reference, the simplest receiver, without intersymbol
/// interference: ½ exp(−Eb/N0). For comparison; no receiver here is of this kind.
pub fn one_bit_differential(ratio: Decibels) -> f64 {
    (-ratio.power()).exp() / 2.0
}

/// [`differentially_decoded`] under amplitude modulation: averaged over the phase of the code. `ratio` is of the mean energy of
/// a bit, the modulation included.
pub fn differentially_decoded_under_code(ratio: Decibels, depth: f64, code: Hertz, bit_rate: Hertz) -> f64 {
    let cycles = code.0 / bit_rate.0;
    let wrong = sign_under_code(ratio, depth, cycles);
    (0..STEPS)
        .map(|step| {
            let phase = f64::from(step) / f64::from(STEPS);
            let (first, second) = (wrong(phase), wrong(phase + cycles));
            first * (1.0 - second) + second * (1.0 - first)
        })
        .sum::<f64>()
        / f64::from(STEPS)
}

/// The probability that the sign at this phase of the code (0 to 1) is wrong; `cycles` of the code go by in a bit.
fn sign_under_code(ratio: Decibels, depth: f64, cycles: f64) -> impl Fn(f64) -> f64 {
    // What the matched filter, a half cosine squared over two bits, leaves of the code.
    let kept = sinc(2.0 * cycles) + 0.5 * (sinc(2.0 * cycles - 1.0) + sinc(2.0 * cycles + 1.0));
    move |phase: f64| {
        let envelope = 1.0 + depth * kept * (TAU * phase).cos();
        q_function(envelope * (2.0 * ratio.power() / (1.0 + depth * depth / 2.0)).sqrt())
    }
}

/// The part of frames of so many bits that have an error: one sign more than bits, each wrong by itself, averaged over the phase of
/// the code at which the frame begins. `ratio` is of the mean energy of a bit, the modulation included. Without a code the depth is 0.
///
/// Under a code it is far more than the mean bit error rate tells: every frame crosses the places where the envelope is low.
pub fn frames_lost(ratio: Decibels, depth: f64, code: Hertz, bit_rate: Hertz, bits: u32) -> f64 {
    /// Phases over which is averaged: what a frame crosses is nearly the same for each.
    const PHASES: u32 = 48;
    let cycles = code.0 / bit_rate.0;
    let wrong = sign_under_code(ratio, depth, cycles);
    let whole = |phase: f64| -> f64 {
        (0..=bits).map(|bit| (-wrong(phase + cycles * f64::from(bit))).ln_1p()).sum::<f64>().exp()
    };
    1.0 - (0..PHASES).map(|step| whole(f64::from(step) / f64::from(PHASES))).sum::<f64>() / f64::from(PHASES)
}

/// The ratio at which a falling curve has this error rate, from −20 to 30 dB; the end of that range if it has it nowhere there.
pub fn ratio_for(curve: impl Fn(Decibels) -> f64, rate: f64) -> Decibels {
    let (mut low, mut high) = (-20.0, 30.0);
    for _ in 0..60 {
        let middle = f64::midpoint(low, high);
        if curve(Decibels(middle)) > rate { low = middle } else { high = middle }
    }
    Decibels(f64::midpoint(low, high))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn near(value: f64, expected: f64) {
        assert!((value / expected - 1.0).abs() < 1e-5, "{value} instead of {expected}");
    }

    /// Values of tables of the normal distribution.
    #[test]
    fn tail_of_the_normal_distribution() {
        near(q_function(0.0), 0.5);
        near(q_function(1.0), 0.158_655_25);
        near(q_function(-1.0), 0.841_344_75);
        near(q_function(2.7), 3.466_97e-3);
        near(q_function(3.0), 1.349_898e-3);
        near(q_function(5.0), 2.866_516e-7);
    }

    /// The relative error that [`erfc`] states, on both sides of where its formula changes.
    #[test]
    fn complementary_error_function() {
        for (x, expected) in [
            (0.5, 0.479_500_122_186_953_5),
            (1.0, 0.157_299_207_050_285_13),
            (2.0, 4.677_734_981_047_266e-3),
            (3.0, 2.209_049_699_858_544e-5),
            (5.0, 1.537_459_794_428_035e-12),
        ] {
            assert!((erfc(x) / expected - 1.0).abs() < 1e-10, "{x}: {} instead of {expected}", erfc(x));
        }
    }

    /// The textbook's 9.6 dB for one error in 100 000.
    #[test]
    fn textbook_point() {
        let ratio = ratio_for(coherent, 1e-5);
        assert!((ratio.0 - 9.59).abs() < 0.01, "{ratio:?}");
    }

    #[test]
    fn no_depth_is_no_modulation() {
        let ratio = Decibels(5.0);
        near(differentially_decoded_under_code(ratio, 0.0, Hertz(10.0), Hertz(200.0)), differentially_decoded(ratio));
    }

    /// A frame of one bit is lost with the error of two signs; of many bits without a code with that of each of them.
    #[test]
    fn frames_are_lost_as_their_signs_are() {
        let ratio = Decibels(6.0);
        let sign = coherent(ratio);
        near(frames_lost(ratio, 0.0, Hertz(10.0), Hertz(200.0), 1), 1.0 - (1.0 - sign).powi(2));
        near(frames_lost(ratio, 0.0, Hertz(10.0), Hertz(200.0), 106), 1.0 - (1.0 - sign).powi(107));
    }

    /// A slow deep modulation costs: errors come where the envelope is low.
    #[test]
    fn modulation_costs() {
        let ratio = Decibels(8.0);
        let slow = differentially_decoded_under_code(ratio, 2.0 / 3.0, Hertz(10.0), Hertz(200.0));
        assert!(slow > 10.0 * differentially_decoded(ratio));
    }
}
