//! The line as a filter of audio samples: attenuation and phase over a distance, fixed or changing while a train runs.
//!
//! The filter is designed by frequency sampling: the response e^(−γx) is taken at many frequencies, transformed back, cut to
//! [`TAPS`] samples and windowed. A constant delay of [`Track::LATENCY`] samples makes it causal. Between 5 % and 80 % of half the
//! sample rate, at 8 kHz, the error stays under 0.005 dB and 0.0005 rad (tested on 2, 10 and 50 Ω·km, at six distances up to a
//! kilometre); above, towards half the sample rate, it grows.

use super::{Hertz, Line, Metres};
use crate::channel::Stage;
use crate::filter::{Recent, dot};
use realfft::RealFftPlanner;
use realfft::num_complex::Complex64;
use std::f64::consts::PI;
use std::fmt;

/// Length of the filters, in samples.
pub const TAPS: usize = 257;
/// Samples of the response that is designed.
const DESIGN: usize = 4096;
/// Metres between the filters of a [`MovingTrack`]: blending two of them is wrong by 0.0015 dB at most (3 kHz, 2 Ω·km).
const BANK_SPACING: f64 = 10.0;
/// The longest distance that a filter is built for, in metres.
const LONGEST: f64 = 5000.0;

/// A filter that cannot be built.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum TrackError {
    /// A distance that is negative, not a number or over 5 km.
    Distance(Metres),
    /// A sample rate that is not within 1 kHz to 1 MHz.
    SampleRate(Hertz),
}

impl fmt::Display for TrackError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Distance(Metres(m)) => write!(f, "a track of {m} m; a filter covers 0 to {LONGEST} m"),
            Self::SampleRate(Hertz(hz)) => write!(f, "a sample rate of {hz} Hz; 1000 to 1000000 Hz are supported"),
        }
    }
}

impl std::error::Error for TrackError {}

/// A piece of track of fixed length that samples pass through.
#[derive(Clone, Debug)]
pub struct Track {
    taps: Vec<f32>,
    past: Recent,
}

impl Track {
    /// Samples by which everything comes out later than over the line itself.
    pub const LATENCY: usize = TAPS / 2;

    /// The filter of `distance` on `line`.
    ///
    /// # Errors
    /// See [`TrackError`].
    pub fn new(line: &Line, distance: Metres, sample_rate: Hertz) -> Result<Self, TrackError> {
        check(distance, sample_rate)?;
        Ok(Self { taps: Designer::new(sample_rate).taps(line, distance), past: Recent::new(TAPS) })
    }

    /// Replaces every sample by the one that arrives at the far end. Allocates nothing; blocks may have any size.
    pub fn process(&mut self, block: &mut [f32]) {
        for sample in block {
            self.past.push(*sample);
            *sample = dot(self.past.window(), &self.taps);
        }
    }
}

impl Stage for Track {
    fn apply(&mut self, block: &mut [f32]) {
        self.process(block);
    }
}

/// A track whose far end moves: the receiver of a train that runs.
#[derive(Clone, Debug)]
pub struct MovingTrack {
    bank: Vec<Vec<f32>>,
    past: Recent,
}

impl MovingTrack {
    /// Filters for every distance from 0 to `longest` on `line`.
    ///
    /// # Errors
    /// See [`TrackError`].
    pub fn new(line: &Line, longest: Metres, sample_rate: Hertz) -> Result<Self, TrackError> {
        check(longest, sample_rate)?;
        let mut designer = Designer::new(sample_rate);
        let mut bank = vec![designer.taps(line, Metres(0.0))];
        let mut distance = 0.0;
        while distance < longest.0 {
            distance += BANK_SPACING;
            bank.push(designer.taps(line, Metres(distance)));
        }
        bank.push(designer.taps(line, Metres(distance + BANK_SPACING)));
        Ok(Self { bank, past: Recent::new(TAPS) })
    }

    /// Replaces every sample by the one that arrives, while the distance goes evenly from `from` to `to`. Distances outside
    /// the filters' range are taken as its nearest end. Allocates nothing; blocks may have any size.
    pub fn process(&mut self, block: &mut [f32], from: Metres, to: Metres) {
        #[allow(clippy::cast_precision_loss, reason = "block lengths are far under 2^52")]
        let (count, last) = (block.len() as f64, (self.bank.len() - 2) as f64);
        for (sample, step) in block.iter_mut().zip(0_u32..) {
            self.past.push(*sample);
            let distance = from.0 + (to.0 - from.0) * f64::from(step) / count;
            let place = (distance / BANK_SPACING).clamp(0.0, last);
            #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "clamped to the bank's indices")]
            let (index, part) = (place as usize, place.fract() as f32);
            let near = dot(self.past.window(), &self.bank[index]);
            let far = dot(self.past.window(), &self.bank[index + 1]);
            *sample = near + (far - near) * part;
        }
    }
}

fn check(distance: Metres, sample_rate: Hertz) -> Result<(), TrackError> {
    if !(0.0..=LONGEST).contains(&distance.0) {
        return Err(TrackError::Distance(distance));
    }
    if !(1000.0..=1_000_000.0).contains(&sample_rate.0) {
        return Err(TrackError::SampleRate(sample_rate));
    }
    Ok(())
}

struct Designer {
    sample_rate: Hertz,
    inverse: std::sync::Arc<dyn realfft::ComplexToReal<f64>>,
}

impl Designer {
    fn new(sample_rate: Hertz) -> Self {
        Self { sample_rate, inverse: RealFftPlanner::new().plan_fft_inverse(DESIGN) }
    }

    /// The filter's taps, the one for the oldest sample first.
    #[allow(
        clippy::cast_precision_loss,
        clippy::cast_possible_truncation,
        reason = "design sizes; f32 is the samples' type"
    )]
    fn taps(&mut self, line: &Line, distance: Metres) -> Vec<f32> {
        let half = DESIGN / 2;
        let kilometres = distance.0 / 1000.0;
        let mut spectrum: Vec<Complex64> = (0..=half)
            .map(|bin| {
                let part = bin as f64 / half as f64;
                let gamma = line.propagation(Hertz(part * self.sample_rate.0 / 2.0)) * kilometres;
                Complex64::from_polar((-gamma.re).exp(), -gamma.im - PI * part * Track::LATENCY as f64)
            })
            .collect();
        spectrum[0].im = 0.0;
        spectrum[half].im = 0.0;
        let mut response = vec![0.0; DESIGN];
        self.inverse
            .process(&mut spectrum, &mut response)
            .expect("lengths and end points are as the transform needs them");
        let centre = Track::LATENCY as f64;
        (0..TAPS)
            .rev()
            .map(|n| {
                // A window that is flat over the inner half and falls to zero at the ends.
                let outside = ((n as f64 - centre).abs() / (centre + 1.0) * 2.0 - 1.0).max(0.0);
                (response[n] / DESIGN as f64 * f64::midpoint(1.0, (PI * outside).cos())) as f32
            })
            .collect()
    }
}

#[cfg(test)]
mod tests {
    use super::super::{OhmKilometres, Rails};
    use super::*;

    const RATE: f64 = 8000.0;

    fn line(ballast: f64) -> Line {
        Line::new(Rails::default(), OhmKilometres(ballast)).expect("a usual track")
    }

    #[allow(clippy::cast_precision_loss, reason = "a few taps")]
    fn response(taps: &[f32], frequency: f64) -> Complex64 {
        let shifted = taps.iter().rev().zip(0_u32..).map(|(&tap, n)| {
            let angle = -2.0 * PI * frequency / RATE * (f64::from(n) - Track::LATENCY as f64);
            Complex64::from_polar(f64::from(tap), angle)
        });
        shifted.sum()
    }

    #[test]
    fn the_filter_is_the_line_over_the_whole_band() {
        let mut designer = Designer::new(Hertz(RATE));
        for ballast in [2.0, 10.0, 50.0] {
            for distance in [0.0, 1.0, 37.0, 150.0, 400.0, 1000.0] {
                let taps = designer.taps(&line(ballast), Metres(distance));
                for step in 20..=320 {
                    let frequency = f64::from(step) * 10.0;
                    let wanted = line(ballast).response(Hertz(frequency), Metres(distance));
                    let ratio = response(&taps, frequency) / wanted;
                    let (error, phase) = (20.0 * ratio.norm().log10(), ratio.arg());
                    let place = format!("{ballast} Ω·km, {distance} m, {frequency} Hz");
                    assert!(error.abs() < 0.005, "{place}: {error} dB");
                    assert!(phase.abs() < 0.0005, "{place}: {phase} rad");
                }
            }
        }
    }

    fn noise(count: usize) -> Vec<f32> {
        let mut seed = 1_u32;
        let next = || {
            seed = seed.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            let [.., low, high] = seed.to_le_bytes();
            f32::from(i16::from_le_bytes([low, high])) / 32768.0
        };
        std::iter::repeat_with(next).take(count).collect()
    }

    #[test]
    fn the_size_of_the_blocks_changes_nothing() {
        let input = noise(2000);
        let whole = {
            let mut samples = input.clone();
            Track::new(&line(5.0), Metres(220.0), Hertz(RATE)).expect("a usual track").process(&mut samples);
            samples
        };
        for size in [1, 7, 64, 1000] {
            let mut track = Track::new(&line(5.0), Metres(220.0), Hertz(RATE)).expect("a usual track");
            let mut samples = input.clone();
            samples.chunks_mut(size).for_each(|block| track.process(block));
            assert_eq!(samples, whole, "blocks of {size}");
        }
    }

    #[test]
    fn a_channel_may_have_a_track() {
        let track = || Track::new(&line(5.0), Metres(220.0), Hertz(RATE)).expect("a usual track");
        let (mut alone, mut channel) = (noise(2000), noise(2000));
        track().process(&mut alone);
        crate::channel::Channel::new().with(track()).apply(&mut channel);
        assert_eq!(
            alone.iter().map(|x| x.to_bits()).collect::<Vec<_>>(),
            channel.iter().map(|x| x.to_bits()).collect::<Vec<_>>()
        );
    }

    #[test]
    fn a_moving_track_that_stands_still_is_a_fixed_one() {
        // 123.4 m lies between two filters of the bank.
        let (mut moving, mut fixed) = (noise(2000), noise(2000));
        let distance = Metres(123.4);
        let mut track = MovingTrack::new(&line(2.0), Metres(400.0), Hertz(RATE)).expect("a usual track");
        moving.chunks_mut(80).for_each(|block| track.process(block, distance, distance));
        Track::new(&line(2.0), distance, Hertz(RATE)).expect("a usual track").process(&mut fixed);
        let (mut error, mut power) = (0.0, 0.0);
        for (a, b) in moving.iter().zip(&fixed) {
            error += f64::from(a - b).powi(2);
            power += f64::from(*b).powi(2);
        }
        assert!(10.0 * (error / power).log10() < -60.0, "{} dB", 10.0 * (error / power).log10());
    }

    #[test]
    fn a_train_that_runs_hears_the_signal_grow() {
        let mut track = MovingTrack::new(&line(2.0), Metres(400.0), Hertz(RATE)).expect("a usual track");
        let mut samples: Vec<f32> =
            (0..8000_u16).map(|n| (f32::from(n % 8) * std::f32::consts::FRAC_PI_4).sin()).collect();
        let blocks = samples.chunks_mut(80).zip(0_u32..);
        let mut power = Vec::new();
        for (block, step) in blocks {
            let at = |steps: u32| Metres(400.0 - 4.0 * f64::from(steps));
            track.process(block, at(step), at(step + 1));
            power.push(block.iter().map(|x| x * x).sum::<f32>() / 40.0);
        }
        // 13 dB/km at 1 kHz on wet ballast; 16 ms of latency are 6.5 m.
        let grown = 10.0 * (power[99] / power[9]).log10();
        let expected = line(2.0).attenuation(Hertz(1000.0), Metres(360.0)).0;
        assert!((f64::from(grown) - expected).abs() < 0.05, "{grown} dB, expected {expected}");
    }

    #[test]
    fn impossible_tracks_are_refused() {
        let error = Track::new(&line(2.0), Metres(-1.0), Hertz(RATE)).expect_err("negative");
        assert_eq!(error.to_string(), "a track of -1 m; a filter covers 0 to 5000 m");
        assert!(MovingTrack::new(&line(2.0), Metres(f64::NAN), Hertz(RATE)).is_err());
        assert!(Track::new(&line(2.0), Metres(1.0), Hertz(10.0)).is_err());
    }
}
