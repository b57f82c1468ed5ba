//! What the generator sends: frequencies, phase, depth; and configurations that it refuses.

mod common;

use atc_waveform::config::{Carrier, Codes, ConfigError, TransmitterConfig, TransmitterParams};
use atc_waveform::generator::{AnalogGenerator, Generator};
use atc_waveform::measure::{envelope, spectrum};
use atc_waveform::units::{Hertz, Level};
use common::{codes, samples};

/// The strongest line between two frequencies.
fn strongest(spectrum: &[(f64, f64)], from: f64, to: f64) -> f64 {
    let lines = spectrum.iter().filter(|(hertz, _)| (from..to).contains(hertz));
    lines.max_by(|a, b| a.1.total_cmp(&b.1)).expect("some line").0
}

/// A one is 50 Hz above the carrier, a zero 50 Hz below, no bit is the carrier itself.
#[test]
fn bits_are_frequencies() {
    let config = TransmitterConfig::default();
    let constant = |bit: Option<bool>| std::iter::from_fn(move || bit);
    for (main, sub, expected) in [(Some(true), Some(false), (800.0, 1150.0)), (None, Some(true), (750.0, 1250.0))] {
        let mut signal = samples(&config, 4.0);
        Generator::new(&config, Codes::NONE, constant(main), constant(sub)).fill(&mut signal);
        let spectrum = spectrum(&signal, config.sample_rate());
        // The spectrum's own resolution is 2 Hz.
        assert!((strongest(&spectrum, 500.0, 975.0) - expected.0).abs() < 2.0);
        assert!((strongest(&spectrum, 975.0, 1500.0) - expected.1).abs() < 2.0);
    }
}

/// The keyed wave never jumps: its second difference stays that of a sine wave of the highest frequency.
#[test]
fn the_phase_is_continuous() {
    let config = TransmitterConfig::default();
    let mut n = 0_u32;
    let bits = std::iter::from_fn(move || {
        n += 1;
        Some(n * n % 7 < 3)
    });
    let mut signal = samples(&config, 2.0);
    Generator::new(&config, Codes::NONE, bits, std::iter::empty()).fill(&mut signal);
    // The sub carrier is not keyed: take it away as it is known.
    let mut bare = samples(&config, 2.0);
    AnalogGenerator::analog(&config, Codes::NONE).fill(&mut bare);
    let mut keyed_alone = signal.clone();
    for ((keyed, bare), n) in keyed_alone.iter_mut().zip(&bare).zip(0_u32..) {
        let main = 0.25 * (std::f64::consts::TAU * 750.0 * f64::from(n) / 8000.0).cos();
        #[allow(clippy::cast_possible_truncation)]
        let main = main as f32;
        *keyed -= bare - main;
    }
    let limit = 0.25 * (std::f32::consts::TAU * 800.0 / 8000.0).powi(2) * 1.05;
    for three in keyed_alone.windows(3) {
        assert!((three[0] - 2.0 * three[1] + three[2]).abs() < limit, "{three:?}");
    }
}

/// The envelope swings between 1 − 2/3 and 1 + 2/3 of the level, and the sum stays inside full scale.
#[test]
fn the_depth_is_two_thirds() {
    let config = TransmitterConfig::default();
    let mut signal = samples(&config, 2.0);
    Generator::analog(&config, codes(0, 0)).fill(&mut signal);
    assert!(signal.iter().all(|sample| sample.abs() <= 0.25 * 2.0 * 5.0 / 3.0 + 1e-6));
    for carrier in [Carrier::Main, Carrier::Sub] {
        let swing = envelope(&signal, &config, carrier);
        let least = swing.iter().map(|point| point.1).fold(f64::INFINITY, f64::min);
        let most = swing.iter().map(|point| point.1).fold(0.0, f64::max);
        assert!((least / (0.25 / 3.0) - 1.0).abs() < 0.05, "{least}");
        assert!((most / (0.25 * 5.0 / 3.0) - 1.0).abs() < 0.02, "{most}");
    }
}

#[test]
fn configurations_that_cannot_be() {
    let good = TransmitterParams::default();
    assert!(TransmitterConfig::new(good.clone()).is_ok());
    let message = |params| TransmitterConfig::new(params).expect_err("refused").to_string();
    let changed = |change: fn(&mut TransmitterParams)| {
        let mut params = TransmitterParams::default();
        change(&mut params);
        message(params)
    };
    assert_eq!(changed(|p| p.depth = 1.2), "depth is 1.2; it must be from 0 to 1");
    assert_eq!(changed(|p| p.depth = f64::NAN), "depth is NaN; it must be from 0 to 1");
    assert_eq!(changed(|p| p.sample_rate = Hertz(0.0)), "sample_rate is 0; it must be from 4000 to 192000");
    assert_eq!(changed(|p| p.bit_rate = Hertz(-1.0)), "bit_rate is -1; it must be from 50 to 1200");
    assert_eq!(changed(|p| p.main_level = Level(0.0)), "main_level is 0; it must be from 0.001 to 1");
    assert_eq!(changed(|p| p.sub_level = Level(2.0)), "sub_level is 2; it must be from 0.001 to 1");
    assert!(changed(|p| p.sub_carrier = Hertz(3900.0)).contains("Sub carrier with its sidebands reaches 4100 Hz"));
    assert!(
        changed(|p| p.main_carrier = Hertz(150.0)).contains("Main carrier with its sidebands reaches down to -50 Hz")
    );
    assert!(
        changed(|p| p.sub_carrier = Hertz(1000.0))
            .contains("250 Hz apart; with this bit rate they must be at least 400 Hz")
    );
    assert!(changed(|p| p.main_level = Level(0.5)).contains("reaches 1.250 of full scale"));
}

#[test]
fn codes_that_cannot_be() {
    for (main, sub, field) in [(Some(7.9), None, "main code"), (Some(10.0), Some(50.1), "sub code")] {
        let error = Codes::new(main.map(Hertz), sub.map(Hertz)).expect_err("refused");
        assert!(matches!(error, ConfigError::OutOfRange { field: found, .. } if found == field), "{error}");
    }
}
