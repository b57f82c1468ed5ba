//! The code frequency of one carrier, from the magnitude of its envelope.
//!
//! A window of the envelope is compared with sine waves of all frequencies from 5 to 60 Hz, in steps of half the
//! window's resolution. The strongest is reported if it stands for enough of everything that varies, if it modulates
//! the carrier deeply enough, and if it lies where codes can lie; otherwise there is no code. Never the nearest code:
//! what a frequency means is the business of the kernel's table.
//!
//! A window that the carrier does not fill is not *settled*: the part without it bends the sine wave, and its frequency
//! would read up to 0.75 Hz wrong. So the carrier must be about as strong in each quarter of the window; until then
//! there is no code, after a start, after a gap, and where a section with another level begins.

use std::f64::consts::TAU;

use crate::config::{HIGHEST_CODE, LOWEST_CODE};
use crate::filter::{Recent, sinc};

/// The rate to which the envelope is averaged down before it is analysed, in hertz, about.
const RATE: f64 = 200.0;
/// The band in which everything that varies is counted, in hertz.
const BAND: (f64, f64) = (5.0, 60.0);

/// Parts of a window in each of which the carrier must be there. With the default window a part is as long as one
/// period of a code of 10 Hz, so that the code itself hardly shows in the means.
const PARTS: usize = 4;
/// How sure the detector must be. The default is the project's.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CodeConfidence {
    /// Length of the analysed window, in seconds.
    pub window: f64,
    /// Time from one report to the next, in seconds.
    pub hop: f64,
    /// Least depth of the modulation.
    pub least_depth: f64,
    /// Least part of all variation from 5 to 60 Hz that the code must account for.
    pub least_share: f64,
    /// Least amplitude of the carrier, as a part of full scale.
    pub least_level: f64,
    /// Least mean amplitude of a quarter of the window over the greatest of them; 0: a carrier that comes or goes is no
    /// reason to doubt the frequency. With the default a step of the level bends a frequency by 0.25 Hz at most, which
    /// is what a new code must be inside its band. A code of 8 or 12 Hz at a depth of 2/3 alone makes it 0.73.
    pub least_steadiness: f64,
}

impl Default for CodeConfidence {
    fn default() -> Self {
        Self { window: 0.4, hop: 0.05, least_depth: 0.4, least_share: 0.6, least_level: 0.001, least_steadiness: 0.65 }
    }
}

/// What one window says.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CodeReading {
    /// The code frequency in millihertz; nothing unless it is sure enough.
    pub millihertz: Option<u32>,
    /// The depth of the strongest modulation.
    pub depth: f64,
    /// The part of the variation that it accounts for.
    pub share: f64,
    /// The mean amplitude of the carrier in this window.
    pub level: f64,
}

/// One frequency that the window is compared with.
struct Bin {
    frequency: f64,
    cosine: Box<[f32]>,
    sine: Box<[f32]>,
}

/// A streaming detector; eats magnitudes of the envelope.
pub struct CodeDetector {
    confidence: CodeConfidence,
    bins: Vec<Bin>,
    step: f64,
    /// Powers of the bins, a work space.
    powers: Box<[f32]>,
    /// The window.
    history: Recent,
    averaged: usize,
    sum: f32,
    collected: usize,
    hop: usize,
    until_report: usize,
}

impl CodeDetector {
    /// A detector for an envelope of this many samples in a second.
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, clippy::cast_precision_loss)] // Small positive numbers.
    pub fn new(envelope_rate: f64, confidence: CodeConfidence) -> Self {
        let averaged = (envelope_rate / RATE).floor().max(1.0) as usize;
        let rate = envelope_rate / averaged as f64;
        let length = (confidence.window * rate).round().max(16.0) as usize;
        let hop = (confidence.hop * rate).round().max(1.0) as usize;
        let step = rate / length as f64 / 2.0;
        let count = ((BAND.1 - BAND.0) / step).floor() as usize + 1;
        let bin = |k: usize| {
            let frequency = BAND.0 + k as f64 * step;
            // A Hann window sums to half its length; averaging has weakened this frequency.
            let droop = sinc(frequency / rate);
            let weight = |i: usize| (1.0 - (TAU * (i as f64 + 0.5) / length as f64).cos()) / (length as f64 * droop);
            let phase = |i: usize| TAU * frequency * i as f64 / rate;
            Bin {
                frequency,
                cosine: (0..length).map(|i| (2.0 * weight(i) * phase(i).cos()) as f32).collect(),
                sine: (0..length).map(|i| (2.0 * weight(i) * phase(i).sin()) as f32).collect(),
            }
        };
        Self {
            confidence,
            bins: (0..count).map(bin).collect(),
            step,
            powers: vec![0.0; count].into(),
            history: Recent::new(length),
            averaged,
            sum: 0.0,
            collected: 0,
            hop,
            until_report: hop,
        }
    }

    /// Takes one magnitude; a reading comes out once a hop.
    #[allow(clippy::cast_precision_loss)]
    pub fn push(&mut self, magnitude: f32) -> Option<CodeReading> {
        self.sum += magnitude;
        self.collected += 1;
        if self.collected < self.averaged {
            return None;
        }
        self.history.push(self.sum / self.averaged as f32);
        self.sum = 0.0;
        self.collected = 0;
        self.until_report -= 1;
        if self.until_report > 0 {
            return None;
        }
        self.until_report = self.hop;
        Some(self.read())
    }

    #[allow(clippy::cast_precision_loss)]
    fn read(&mut self) -> CodeReading {
        let window = self.history.window();
        let mean = window.iter().sum::<f32>() / window.len() as f32;
        for (bin, power) in self.bins.iter().zip(&mut self.powers) {
            let mut cosine = 0.0;
            let mut sine = 0.0;
            for ((value, c), s) in window.iter().zip(&bin.cosine).zip(&bin.sine) {
                cosine += (value - mean) * c;
                sine += (value - mean) * s;
            }
            *power = cosine * cosine + sine * sine;
        }
        let mut reading = CodeReading { millihertz: None, depth: 0.0, share: 0.0, level: f64::from(mean) };
        let Some((peak, &power)) = self.powers.iter().enumerate().max_by(|a, b| a.1.total_cmp(b.1)) else {
            return reading;
        };
        if mean <= 0.0 || power <= 0.0 {
            return reading;
        }
        // A Hann window spreads a sine wave over two bins of the window's resolution to either side, here four.
        let near = self.powers[peak.saturating_sub(4)..(peak + 5).min(self.powers.len())].iter().sum::<f32>();
        let all = self.powers.iter().sum::<f32>();
        reading.depth = f64::from(power.sqrt() / mean);
        reading.share = f64::from(near / all);
        let sure = steadiness(window) >= self.confidence.least_steadiness
            && reading.depth >= self.confidence.least_depth
            && reading.share >= self.confidence.least_share
            && reading.level >= self.confidence.least_level;
        if sure {
            reading.millihertz = self.refine(peak);
        }
        reading
    }

    /// The frequency between the bins: the top of the parabola through the logarithms of the peak and its neighbours.
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // Checked to lie between the two limits.
    fn refine(&self, peak: usize) -> Option<u32> {
        if peak == 0 || peak + 1 == self.powers.len() {
            return None;
        }
        let log = |i: usize| f64::from(self.powers[i].max(f32::MIN_POSITIVE)).ln();
        let (before, top, after) = (log(peak - 1), log(peak), log(peak + 1));
        let curvature = before - 2.0 * top + after;
        let offset = if curvature < 0.0 { 0.5 * (before - after) / curvature } else { 0.0 };
        let frequency = self.bins[peak].frequency + offset.clamp(-0.5, 0.5) * self.step;
        (LOWEST_CODE.0..=HIGHEST_CODE.0).contains(&frequency).then(|| (frequency * 1000.0).round() as u32)
    }
}

/// How evenly the carrier fills a window: the least mean amplitude of its parts over the greatest, 0 to 1.
#[allow(clippy::cast_precision_loss)]
fn steadiness(window: &[f32]) -> f64 {
    let length = window.len().div_ceil(PARTS).max(1);
    let means = window.chunks(length).map(|part| part.iter().sum::<f32>() / part.len() as f32);
    let (least, most) = means.fold((f32::INFINITY, 0.0_f32), |(least, most), mean| (least.min(mean), most.max(mean)));
    if most > 0.0 { f64::from(least.max(0.0) / most) } else { 0.0 }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The last reading of two seconds of an envelope at 1 kHz.
    fn last(envelope: impl Fn(f64) -> f64) -> CodeReading {
        let mut detector = CodeDetector::new(1000.0, CodeConfidence::default());
        #[allow(clippy::cast_possible_truncation)]
        let readings = (0..2000).filter_map(|i| detector.push(envelope(f64::from(i) / 1000.0) as f32));
        readings.last().expect("forty hops")
    }

    #[test]
    fn one_code() {
        let reading = last(|t| 0.2 * (1.0 + 2.0 / 3.0 * (TAU * 15.0 * t).cos()));
        assert!(reading.millihertz.is_some_and(|millihertz| millihertz.abs_diff(15_000) < 20), "{reading:?}");
        assert!((reading.depth - 2.0 / 3.0).abs() < 0.02 && (reading.level - 0.2).abs() < 0.01, "{reading:?}");
    }

    /// Two codes at once, each deep enough: it is not for the detector to choose.
    #[test]
    fn two_codes() {
        let reading = last(|t| 0.2 * (1.0 + 0.5 * (TAU * 15.0 * t).cos() + 0.5 * (TAU * 29.0 * t).cos()));
        assert!(reading.millihertz.is_none() && reading.depth > 0.45, "{reading:?}");
    }

    /// From the first report on a frequency is near the true one: after a start, after a gap, and after a step of the
    /// level.
    #[test]
    fn what_is_reported_is_settled() {
        for frequency in [10.0, 12.0, 20.5, 29.0, 41.5] {
            for phase in [0.0, 0.25, 0.5, 0.75] {
                for before in [0.0, 0.3, 0.55, 0.7, 1.8] {
                    let mut detector = CodeDetector::new(1000.0, CodeConfidence::default());
                    let mut reports = 0;
                    for i in 0..2000 {
                        let t = f64::from(i) / 1000.0;
                        let level = if t < 0.613 { before } else { 1.0 };
                        #[allow(clippy::cast_possible_truncation)]
                        let sample = level * (1.0 + 2.0 / 3.0 * (TAU * (frequency * t + phase)).cos()) as f32;
                        let Some(reading) = detector.push(sample) else { continue };
                        let Some(millihertz) = reading.millihertz else { continue };
                        reports += 1;
                        let off = f64::from(millihertz) / 1000.0 - frequency;
                        assert!(off.abs() < 0.25, "{frequency} Hz, phase {phase}, {before} before, {t} s: {off:+} Hz");
                    }
                    assert!(reports > 15, "{reports}");
                }
            }
        }
    }

    /// Outside the range of codes there is none, however clear it is.
    #[test]
    fn beside_the_range() {
        for frequency in [6.0, 55.0] {
            let reading = last(|t| 1.0 + 0.6 * (TAU * frequency * t).cos());
            assert!(reading.millihertz.is_none() && reading.share > 0.6 && reading.depth > 0.5, "{reading:?}");
        }
    }
}
