//! White Gaussian noise.

use rand::{Rng, SeedableRng};
use rand_distr::StandardNormal;
use rand_pcg::Pcg64Mcg;

use super::Stage;
use crate::config::{Carrier, Codes, TransmitterConfig};
use crate::units::{Decibels, Level, Seed};

/// White Gaussian noise from zero to half the sample rate, added to the samples.
pub struct Noise {
    random: Pcg64Mcg,
    deviation: f32,
}

impl Noise {
    /// Noise of a given effective value (standard deviation of a sample).
    #[allow(clippy::cast_possible_truncation)]
    pub fn new(effective: Level, seed: Seed) -> Self {
        Self { random: Pcg64Mcg::seed_from_u64(seed.0), deviation: effective.0 as f32 }
    }

    /// Noise with which one carrier, at its level of transmission, has the stated energy of a bit over noise density.
    ///
    /// The energy of a bit includes what the code's modulation adds to the power of the carrier. Noise of the
    /// density N0 (one-sided, in power for each hertz) has the power N0 × half the sample rate.
    pub fn eb_n0(config: &TransmitterConfig, carrier: Carrier, codes: Codes, ratio: Decibels, seed: Seed) -> Self {
        let bit_energy = carrier_power(config, carrier, codes) / config.bit_rate().0;
        let density = bit_energy / ratio.power();
        Self::new(Level((density * config.sample_rate().0 / 2.0).sqrt()), seed)
    }

    /// Noise with which both carriers together have the stated power over the power of the noise from zero to half the
    /// sample rate.
    pub fn signal_to_noise(config: &TransmitterConfig, codes: Codes, ratio: Decibels, seed: Seed) -> Self {
        let power = carrier_power(config, Carrier::Main, codes) + carrier_power(config, Carrier::Sub, codes);
        Self::new(Level((power / ratio.power()).sqrt()), seed)
    }

    /// The standard deviation of a sample.
    pub fn effective(&self) -> Level {
        Level(f64::from(self.deviation))
    }
}

/// The mean power of one carrier: half the square of its amplitude, and what its code adds.
fn carrier_power(config: &TransmitterConfig, carrier: Carrier, codes: Codes) -> f64 {
    let depth = if codes.of(carrier).is_some() { config.params().depth } else { 0.0 };
    config.level(carrier).0.powi(2) / 2.0 * (1.0 + depth * depth / 2.0)
}

impl Stage for Noise {
    fn apply(&mut self, block: &mut [f32]) {
        for sample in block {
            let normal: f32 = self.random.sample(StandardNormal);
            *sample += self.deviation * normal;
        }
    }
}
