//! A level meter: from the samples under a train's receiver to the levels of two frequencies.
//!
//! Windows follow one another; in each, the samples are weighted with a Hann window and the two amplitudes are found with
//! Goertzel's recursion. Noise of power σ² adds to the level an error of about 8.69·√(1.5/(N·S)) dB (standard deviation), S
//! being the ratio of the signal's power to σ² and N the samples in a window ([`LevelMeter::expected_error`]).

use crate::rail::{DECIBELS_PER_NEPER, Decibels, Hertz};
use std::f64::consts::TAU;
use std::fmt;

/// A meter that cannot be built.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum MeterError {
    /// A frequency that is not between two periods in a window and half the sample rate.
    Frequency {
        /// The frequency.
        frequency: Hertz,
        /// The lowest that this window can tell from direct current.
        least: Hertz,
        /// Half the sample rate.
        most: Hertz,
    },
    /// Two frequencies closer than four times the reciprocal of the window.
    TooClose(Hertz, Hertz),
}

impl fmt::Display for MeterError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Frequency { frequency, least, most } => {
                write!(
                    f,
                    "a frequency of {} Hz; this window and sample rate allow {} to {} Hz",
                    frequency.0, least.0, most.0
                )
            }
            Self::TooClose(apart, least) => {
                write!(f, "the frequencies are {} Hz apart; this window tells {} Hz", apart.0, least.0)
            }
        }
    }
}

impl std::error::Error for MeterError {}

/// The meter. Levels are in dB against a sine of amplitude 1.
#[derive(Clone, Debug)]
pub struct LevelMeter {
    weights: Vec<f64>,
    /// 2·cos ω of both frequencies.
    factors: [f64; 2],
    /// The last two values of both recursions.
    past: [[f64; 2]; 2],
    next: usize,
}

impl LevelMeter {
    /// A meter of `frequencies` with windows of `window` samples.
    ///
    /// # Errors
    /// See [`MeterError`].
    pub fn new(frequencies: [Hertz; 2], sample_rate: Hertz, window: u32) -> Result<Self, MeterError> {
        let resolution = sample_rate.0 / f64::from(window);
        for frequency in frequencies {
            let (least, most) = (Hertz(2.0 * resolution), Hertz(sample_rate.0 / 2.0));
            if !(least.0..most.0).contains(&frequency.0) {
                return Err(MeterError::Frequency { frequency, least, most });
            }
        }
        let apart = (frequencies[0].0 - frequencies[1].0).abs();
        if apart < 4.0 * resolution {
            return Err(MeterError::TooClose(Hertz(apart), Hertz(4.0 * resolution)));
        }
        // The mean of a Hann window is one half: 2/N for the amplitude and 2 for the window.
        let scale = 4.0 / f64::from(window);
        let weight = |n: u32| scale * 0.5 * (1.0 - (TAU * (f64::from(n) + 0.5) / f64::from(window)).cos());
        let factors = frequencies.map(|f| 2.0 * (TAU * f.0 / sample_rate.0).cos());
        Ok(Self { weights: (0..window).map(weight).collect(), factors, past: [[0.0; 2]; 2], next: 0 })
    }

    /// Takes samples; `report` is called with both levels at the end of each window. Allocates nothing; blocks may have any
    /// size.
    pub fn push(&mut self, samples: &[f32], mut report: impl FnMut([Decibels; 2])) {
        for &sample in samples {
            let weighted = f64::from(sample) * self.weights[self.next];
            for (past, factor) in self.past.iter_mut().zip(self.factors) {
                *past = [weighted + factor * past[0] - past[1], past[0]];
            }
            self.next += 1;
            if self.next == self.weights.len() {
                report([0, 1].map(|signal| {
                    let [last, before] = self.past[signal];
                    let power = last * last + before * before - self.factors[signal] * last * before;
                    Decibels::of_power(power.max(f64::MIN_POSITIVE))
                }));
                (self.past, self.next) = ([[0.0; 2]; 2], 0);
            }
        }
    }

    /// Standard deviation of a level at this ratio of signal to noise power, the noise being white over half the sample rate.
    pub fn expected_error(signal_to_noise: Decibels, window: u32) -> Decibels {
        Decibels(DECIBELS_PER_NEPER * (1.5 / (f64::from(window) * signal_to_noise.power())).sqrt())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn tone(amplitude: f64, frequency: f64, count: u32) -> Vec<f64> {
        (0..count).map(|n| amplitude * (TAU * frequency * f64::from(n) / 8000.0 + 0.3).sin()).collect()
    }

    #[test]
    fn two_tones_are_measured_apart_whatever_the_blocks() {
        // 1234 Hz is no whole number of periods in a window.
        #[allow(clippy::cast_possible_truncation, reason = "the samples' type")]
        let samples: Vec<f32> =
            tone(0.5, 1234.0, 2400).iter().zip(tone(0.02, 3000.0, 2400)).map(|(a, b)| (a + b) as f32).collect();
        for size in [1, 13, 800, 2400] {
            let mut meter = LevelMeter::new([Hertz(1234.0), Hertz(3000.0)], Hertz(8000.0), 800).expect("a usual meter");
            let mut levels = Vec::new();
            samples.chunks(size).for_each(|block| meter.push(block, |pair| levels.push(pair)));
            assert_eq!(levels.len(), 3);
            for [first, second] in levels {
                assert!((first.0 - 20.0 * 0.5_f64.log10()).abs() < 0.001, "{first:?}");
                assert!((second.0 - 20.0 * 0.02_f64.log10()).abs() < 0.001, "{second:?}");
            }
        }
    }

    #[test]
    fn impossible_meters_are_refused() {
        let refused =
            |a, b| LevelMeter::new([Hertz(a), Hertz(b)], Hertz(8000.0), 800).expect_err("refused").to_string();
        assert_eq!(refused(1000.0, 4000.0), "a frequency of 4000 Hz; this window and sample rate allow 20 to 4000 Hz");
        assert_eq!(refused(1000.0, 1010.0), "the frequencies are 10 Hz apart; this window tells 40 Hz");
    }
}
