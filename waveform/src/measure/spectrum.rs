//! Spectrum and envelope of a signal, for pictures.

use std::f64::consts::TAU;

use realfft::RealFftPlanner;
use serde::Serialize;

use super::detection::{STANDARD_CODES, standard_transmitter};
use crate::config::{Carrier, TransmitterConfig};
use crate::receiver::Front;
use crate::units::{Hertz, SampleIndex, Seconds};

/// Resolution of the spectrum, as a part of the sample rate.
const LENGTH: usize = 4096;

/// What a signal looks like.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Picture {
    /// Main and sub carrier in hertz.
    pub carriers_hz: (f64, f64),
    /// Their codes in hertz.
    pub codes_hz: (f64, f64),
    /// Power density over frequency: hertz, and decibels over the power of a full-scale sine wave in one hertz.
    pub spectrum: Vec<(f64, f64)>,
    /// Amplitude of the main carrier over time: seconds, and parts of full scale.
    pub main_envelope: Vec<(f64, f64)>,
    /// Amplitude of the sub carrier over time.
    pub sub_envelope: Vec<(f64, f64)>,
    /// The samples themselves over the first part of that time.
    pub samples: Vec<(f64, f64)>,
}

/// The picture of this crate's standard signal: telegrams, codes of 15 and 16.5 Hz.
pub fn picture(config: &TransmitterConfig) -> Option<Picture> {
    let rate = config.sample_rate();
    let mut transmitter = standard_transmitter(config)?;
    let mut signal = vec![0.0; usize::try_from(Seconds(30.0).samples(rate)).ok()?];
    transmitter.fill(&mut signal);
    let half_second = &signal[..signal.len() / 60];
    let samples = half_second.iter().zip(0..);
    Some(Picture {
        carriers_hz: (config.carrier(Carrier::Main).0, config.carrier(Carrier::Sub).0),
        codes_hz: (STANDARD_CODES.0.0, STANDARD_CODES.1.0),
        spectrum: spectrum(&signal, rate),
        main_envelope: envelope(half_second, config, Carrier::Main),
        sub_envelope: envelope(half_second, config, Carrier::Sub),
        samples: samples.map(|(&x, i)| (SampleIndex(i).time(rate).0, f64::from(x))).collect(),
    })
}

/// The power density of a signal, averaged over half-overlapping Hann windows of 4096 samples (Welch); empty if it is
/// shorter than one.
#[allow(clippy::cast_precision_loss)]
pub fn spectrum(samples: &[f32], rate: Hertz) -> Vec<(f64, f64)> {
    let transform = RealFftPlanner::<f64>::new().plan_fft_forward(LENGTH);
    let mut input = transform.make_input_vec();
    let mut output = transform.make_output_vec();
    let window: Vec<f64> = (0..LENGTH).map(|i| 0.5 - 0.5 * (TAU * i as f64 / LENGTH as f64).cos()).collect();
    let mut power = vec![0.0; output.len()];
    let mut windows = 0.0;
    for start in (0..).step_by(LENGTH / 2).take_while(|start| start + LENGTH <= samples.len()) {
        for ((place, &sample), weight) in input.iter_mut().zip(&samples[start..]).zip(&window) {
            *place = f64::from(sample) * weight;
        }
        // Both buffers come from the plan itself, so their lengths fit.
        if transform.process(&mut input, &mut output).is_err() {
            return Vec::new();
        }
        for (sum, line) in power.iter_mut().zip(&output) {
            *sum += line.norm_sqr();
        }
        windows += 1.0;
    }
    if windows == 0.0 {
        return Vec::new();
    }
    // One side, in power for each hertz, against the ½ of a full-scale sine wave.
    let scale = 2.0 / (windows * rate.0 * window.iter().map(|w| w * w).sum::<f64>()) / 0.5;
    let decibels = |p: f64| 10.0 * (p * scale).max(1e-20).log10();
    power.iter().enumerate().map(|(i, &p)| (i as f64 * rate.0 / LENGTH as f64, decibels(p))).collect()
}

/// The amplitude of one carrier over time, as the receivers see it, its delay taken off.
#[allow(clippy::cast_precision_loss)]
pub fn envelope(samples: &[f32], config: &TransmitterConfig, carrier: Carrier) -> Vec<(f64, f64)> {
    let mut front = Front::new(config, carrier);
    let delay = front.delay();
    samples
        .iter()
        .enumerate()
        .filter_map(|(i, &sample)| {
            let time = (i as f64 - delay) / config.sample_rate().0;
            front.push(sample).map(|z| (time, f64::from(z.norm()))).filter(|_| time >= delay / config.sample_rate().0)
        })
        .collect()
}
