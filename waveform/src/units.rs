//! The units at the public faces of this crate.

use serde::{Deserialize, Serialize};

/// A frequency in hertz.
#[derive(Clone, Copy, Debug, PartialEq, PartialOrd, Serialize, Deserialize)]
#[serde(transparent)]
pub struct Hertz(pub f64);

/// A ratio of powers in decibels; of amplitudes: 20 dB for a factor of ten.
#[derive(Clone, Copy, Debug, PartialEq, PartialOrd, Serialize, Deserialize)]
#[serde(transparent)]
pub struct Decibels(pub f64);

/// A time or a duration in seconds.
#[derive(Clone, Copy, Debug, PartialEq, PartialOrd, Serialize, Deserialize)]
#[serde(transparent)]
pub struct Seconds(pub f64);

/// An amplitude as a part of full scale: 1 is the largest sample that a WAV file can hold.
#[derive(Clone, Copy, Debug, PartialEq, PartialOrd, Serialize, Deserialize)]
#[serde(transparent)]
pub struct Level(pub f64);

/// A seed: the same seed gives the same noise, on every machine.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(transparent)]
pub struct Seed(pub u64);

/// A position in a stream of samples, counted from its beginning.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(transparent)]
pub struct SampleIndex(pub u64);

impl Decibels {
    /// The ratio of powers.
    pub fn power(self) -> f64 {
        10f64.powf(self.0 / 10.0)
    }

    /// The ratio of amplitudes.
    pub fn amplitude(self) -> f64 {
        10f64.powf(self.0 / 20.0)
    }

    /// The decibels of a ratio of powers; −∞ for nothing.
    pub fn of_power(ratio: f64) -> Self {
        Self(10.0 * ratio.log10())
    }
}

impl Seconds {
    /// The number of whole samples in this time, rounded; nothing for a negative time.
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // A cast from float saturates.
    pub fn samples(self, rate: Hertz) -> u64 {
        (self.0 * rate.0).round() as u64
    }
}

impl SampleIndex {
    /// The time of this sample from the beginning of the stream.
    #[allow(clippy::cast_precision_loss)] // 2^53 samples at 8 kHz are 35 000 years.
    pub fn time(self, rate: Hertz) -> Seconds {
        Seconds(self.0 as f64 / rate.0)
    }
}
