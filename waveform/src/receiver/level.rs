//! The mean amplitude of a carrier.

/// A moving mean over a fixed time.
pub struct LevelMeter {
    window: Box<[f32]>,
    at: usize,
    sum: f64,
}

impl LevelMeter {
    /// The mean over `seconds` of an envelope with this many samples in a second. Before so much has come in, the rest
    /// counts as silence.
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // Small positive numbers.
    pub fn new(envelope_rate: f64, seconds: f64) -> Self {
        Self { window: vec![0.0; (envelope_rate * seconds).round().max(1.0) as usize].into(), at: 0, sum: 0.0 }
    }

    /// Takes one magnitude.
    pub fn push(&mut self, magnitude: f32) {
        let gone = std::mem::replace(&mut self.window[self.at], magnitude);
        self.sum += f64::from(magnitude) - f64::from(gone);
        self.at = (self.at + 1) % self.window.len();
    }

    /// The mean amplitude, as a part of full scale.
    #[allow(clippy::cast_precision_loss)]
    pub fn level(&self) -> f64 {
        (self.sum / self.window.len() as f64).max(0.0)
    }
}
