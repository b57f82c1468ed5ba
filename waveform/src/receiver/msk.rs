//! The bits of one carrier: coherent detection of MSK, differential decoding.
//!
//! *Synchronisation.* The square of MSK has two spectral lines, half the bit rate above and below twice the carrier: a run
//! of ones feeds the upper, a run of zeros the lower. The phase between them is the bit clock, their common phase is
//! twice the carrier's (R. de Buda, "Coherent demodulation of frequency-shift keying with low deviation ratio", IEEE
//! Transactions on Communications, June 1972). Both lines are summed over a window of 40 bits centred on the bit that is
//! being decided, so there is no carrier loop to pull in or to hang: a carrier 1 Hz off turns by 72° in the window, which costs
//! amplitude but, by symmetry, no phase. The clock, which never changes much, is smoothed over another 80 bits: a long run
//! of equal bits feeds one line only, and then the clock must coast.
//!
//! *Detection.* At every bit boundary the phase of MSK stands at 0° or 180° against a reference that itself turns by
//! 90° a bit. A half cosine over the two adjacent bits is the matched filter of that decision. Two equal decisions in
//! a row are a one, two different ones a zero, so that it does not matter which of the two phases is which; hence each wrong
//! decision costs two bits and the error rate is 2Q(1−Q), Q = Q(√(2Eb/N0)).
//!
//! The code's amplitude modulation multiplies both lines and every decision by the same positive number: it moves none of
//! the phases.

use std::f64::consts::{FRAC_PI_2, PI, TAU};

use realfft::num_complex::{Complex32, Complex64};

use super::front::pulse;

/// Window of the carrier's phase, in bits.
const WINDOW_BITS: f64 = 40.0;
/// Time constant of the clock, in bits.
const CLOCK_BITS: f64 = 80.0;
/// The part of the clock's error that is corrected at each bit.
const CLOCK_GAIN: f64 = 0.1;

/// One decided bit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DecidedBit {
    /// One or zero.
    pub value: bool,
    /// When the bit ended, in samples of the envelope.
    pub end: f64,
    /// How much of the amplitude in the window belongs to a signal that is keyed like this: 1 for a clean signal, about
    /// 0.1 for noise.
    pub lock: f64,
}

/// What one sample of the envelope adds to the two lines and to the amplitude.
#[derive(Clone, Copy, Default)]
struct Share {
    upper: Complex64,
    lower: Complex64,
    amplitude: f64,
}

/// A streaming demodulator of one carrier; eats the complex envelope.
pub struct MskDemodulator {
    per_bit: f64,
    /// The envelope, newest at `pushed − 1`, and what each sample added to the sums; both are rings.
    envelope: Box<[Complex32]>,
    shares: Box<[Share]>,
    sums: Share,
    pushed: u64,
    clock: Complex64,
    clock_gain: f64,
    boundary: f64,
    reference: f64,
    last: Option<bool>,
}

impl MskDemodulator {
    /// A demodulator for an envelope with this many samples in a bit (at least 4).
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // Small positive numbers.
    pub fn new(per_bit: f64) -> Self {
        let window = (WINDOW_BITS * per_bit).round() as usize;
        // The decision looks back half a window and one bit.
        let ring = window.next_power_of_two();
        Self {
            per_bit,
            envelope: vec![Complex32::default(); ring].into(),
            shares: vec![Share::default(); window].into(),
            sums: Share::default(),
            pushed: 0,
            clock: Complex64::default(),
            clock_gain: 1.0 / (CLOCK_BITS * per_bit),
            boundary: 2.0 * per_bit,
            reference: 0.0,
            last: None,
        }
    }

    /// Takes one sample of the envelope; there is at most one decided bit for each.
    #[allow(clippy::cast_precision_loss, clippy::cast_possible_truncation)] // Indices stay far below 2^53.
    pub fn push(&mut self, sample: Complex32) -> Option<DecidedBit> {
        let index = self.pushed as usize & (self.envelope.len() - 1);
        self.envelope[index] = sample;
        self.add(sample);
        let newest = self.pushed as f64;
        self.pushed += 1;

        let centre = newest - (self.shares.len() - 1) as f64 / 2.0;
        if centre < self.boundary { None } else { self.decide() }
    }

    #[allow(clippy::cast_precision_loss, clippy::cast_possible_truncation)]
    fn add(&mut self, sample: Complex32) {
        let z = Complex64::new(f64::from(sample.re), f64::from(sample.im));
        let amplitude = z.norm();
        // The square, scaled back to the amplitude: one strong disturbance must not outweigh the whole window.
        let square = if amplitude > 0.0 { z * z / amplitude } else { z };
        let half_cycle = Complex64::from_polar(1.0, PI * (self.pushed as f64 / self.per_bit % 2.0));
        let share = Share { upper: square * half_cycle.conj(), lower: square * half_cycle, amplitude };
        let index = (self.pushed % self.shares.len() as u64) as usize;
        let gone = std::mem::replace(&mut self.shares[index], share);
        self.sums.upper += share.upper - gone.upper;
        self.sums.lower += share.lower - gone.lower;
        self.sums.amplitude += share.amplitude - gone.amplitude;
        if self.sums.amplitude > 0.0 {
            let between = self.sums.upper * self.sums.lower.conj() / self.sums.amplitude.powi(2);
            self.clock += self.clock_gain * (between - self.clock);
        }
    }

    #[allow(clippy::cast_precision_loss, clippy::cast_possible_truncation, clippy::cast_sign_loss)]
    fn decide(&mut self) -> Option<DecidedBit> {
        let boundary = self.boundary;
        let half_cycle = Complex64::from_polar(1.0, PI * (boundary / self.per_bit % 2.0));
        let twice = self.sums.upper * half_cycle + self.sums.lower * half_cycle.conj();
        let expected = self.reference + FRAC_PI_2;
        self.reference = (expected + nearest(twice.arg() / 2.0 - expected, PI)).rem_euclid(TAU);

        let mut sum = Complex64::default();
        for i in (boundary - self.per_bit).ceil() as u64..=(boundary + self.per_bit).floor() as u64 {
            let z = self.envelope[i as usize & (self.envelope.len() - 1)];
            let weight = pulse((i as f64 - boundary) / self.per_bit);
            sum += Complex64::new(f64::from(z.re), f64::from(z.im)) * weight;
        }
        let decision = (sum * Complex64::from_polar(1.0, -self.reference)).re > 0.0;

        let error = nearest(-self.clock.arg() / TAU * self.per_bit - boundary, self.per_bit);
        self.boundary += self.per_bit + CLOCK_GAIN * error;
        let last = self.last.replace(decision)?;
        let lock = if self.sums.amplitude > 0.0 { twice.norm() / self.sums.amplitude } else { 0.0 };
        Some(DecidedBit { value: decision == last, end: boundary, lock: lock.min(1.0) })
    }
}

/// The value that differs from this one by a multiple of the period and lies nearest to zero.
fn nearest(value: f64, period: f64) -> f64 {
    value - period * (value / period).round()
}
