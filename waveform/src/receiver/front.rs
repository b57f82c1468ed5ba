//! From samples to the complex envelope of one carrier, at about five samples for each bit.

use std::f64::consts::{PI, TAU};

use realfft::num_complex::{Complex32, Complex64};

use crate::config::{Carrier, TransmitterConfig};
use crate::filter::{Recent, dot, sinc};

/// Samples of the envelope in a bit, at least.
const PER_BIT: f64 = 5.0;
/// Length of the filter in bits, and its half bandwidth (where it has lost 6 dB) in bit rates. The main lobe of MSK and
/// the codes pass; the other carrier does not.
const LENGTH_BITS: f64 = 4.0;
const HALF_BAND_BIT_RATES: f64 = 1.15;
/// Shape of the Kaiser window: side lobes 60 dB down.
const KAISER: f64 = 5.65;

/// One band-pass filter that also moves its carrier to zero and thins the samples out.
pub struct Front {
    /// Taps, the one for the oldest sample first; real and imaginary parts apart.
    real: Box<[f32]>,
    imaginary: Box<[f32]>,
    history: Recent,
    decimation: usize,
    until_output: usize,
    /// Turns the output from the carrier to zero: cycles gone by and cycles for each output.
    turned: f64,
    turn: f64,
    delay: f64,
    rate: f64,
}

impl Front {
    /// The front of one carrier.
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, clippy::cast_precision_loss)] // Small positive numbers.
    pub fn new(config: &TransmitterConfig, carrier: Carrier) -> Self {
        let rate = config.sample_rate().0;
        let bit_rate = config.bit_rate().0;
        // At least 1: two carriers with their bands beside each other take more than six samples in a bit.
        let decimation = (rate / (PER_BIT * bit_rate)).floor() as usize;
        let length = (LENGTH_BITS * rate / bit_rate).round() as usize;
        let cut_off = HALF_BAND_BIT_RATES * bit_rate / rate;
        let frequency = config.carrier(carrier).0 / rate;

        let middle = (length - 1) as f64 / 2.0;
        let prototype: Vec<f64> = (0..length)
            .map(|i| {
                let x = i as f64 - middle;
                let window = bessel_i0(KAISER * (1.0 - (x / (middle + 0.5)).powi(2)).max(0.0).sqrt());
                window * sinc(2.0 * cut_off * x)
            })
            .collect();
        // A real carrier of amplitude 1 has half of it on either side of zero.
        let gain = 2.0 / prototype.iter().sum::<f64>();
        let tap = |(i, h): (usize, &f64)| Complex64::from_polar(gain * h, TAU * frequency * i as f64);
        let taps: Vec<Complex64> = prototype.iter().enumerate().rev().map(tap).collect();
        Self {
            real: taps.iter().map(|c| c.re as f32).collect(),
            imaginary: taps.iter().map(|c| c.im as f32).collect(),
            history: Recent::new(length),
            decimation,
            until_output: decimation,
            turned: 0.0,
            turn: (frequency * decimation as f64).fract(),
            delay: middle,
            rate: rate / decimation as f64,
        }
    }

    /// Outputs in a second.
    pub fn rate(&self) -> f64 {
        self.rate
    }

    /// Samples by which the output lags behind the input.
    pub fn delay(&self) -> f64 {
        self.delay
    }

    /// Input samples for each output.
    pub fn decimation(&self) -> usize {
        self.decimation
    }

    /// Takes one sample; now and then there is one of the envelope: its magnitude is the carrier's amplitude.
    pub fn push(&mut self, sample: f32) -> Option<Complex32> {
        // A recording may hold values that are no numbers; they must not stay in the filters behind.
        let sample = if sample.is_finite() { sample.clamp(-1e6, 1e6) } else { 0.0 };
        self.history.push(sample);
        self.until_output -= 1;
        if self.until_output > 0 {
            return None;
        }
        self.until_output = self.decimation;
        let window = self.history.window();
        let filtered = Complex32::new(dot(&self.real, window), dot(&self.imaginary, window));
        let turn = Complex64::from_polar(1.0, -TAU * self.turned);
        self.turned = (self.turned + self.turn).fract();
        #[allow(clippy::cast_possible_truncation)]
        Some(filtered * Complex32::new(turn.re as f32, turn.im as f32))
    }
}

/// The modified Bessel function of order zero, by its power series, which converges fast for the small arguments here.
fn bessel_i0(x: f64) -> f64 {
    let mut term = 1.0;
    let mut sum = 1.0;
    for k in 1..40 {
        term *= (x / (2.0 * f64::from(k))).powi(2);
        sum += term;
    }
    sum
}

/// The half cosine over two bits that MSK's matched filter weighs with; `bits` from −1 to 1.
pub(crate) fn pulse(bits: f64) -> f64 {
    if bits.abs() < 1.0 { (PI / 2.0 * bits).cos() } else { 0.0 }
}
