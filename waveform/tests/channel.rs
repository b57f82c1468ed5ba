//! What a channel adds is what was asked for.

mod common;

use atc_waveform::channel::{Channel, Crosstalk, Gain, Harmonic, Interruption, Interruptions, Noise, Stage, Traction};
use atc_waveform::config::{Carrier, Codes, TransmitterConfig};
use atc_waveform::generator::Generator;
use atc_waveform::measure::spectrum;
use atc_waveform::units::{Decibels, Hertz, Level, Seconds, Seed};
use common::{codes, samples};

#[allow(clippy::cast_precision_loss)]
fn power(samples: &[f32]) -> f64 {
    samples.iter().map(|sample| f64::from(*sample).powi(2)).sum::<f64>() / samples.len() as f64
}

fn near(value: f64, expected: f64, tolerance: f64) {
    assert!((value / expected - 1.0).abs() < tolerance, "{value} instead of {expected}");
}

#[test]
fn noise_has_the_power_of_its_ratio() {
    let config = TransmitterConfig::default();
    for codes in [Codes::NONE, codes(3, 3)] {
        let mut signal = samples(&config, 20.0);
        Generator::analog(&config, codes).fill(&mut signal);
        let mut noise = samples(&config, 20.0);
        Noise::signal_to_noise(&config, codes, Decibels(6.0), Seed(1)).apply(&mut noise);
        near(power(&signal) / power(&noise), Decibels(6.0).power(), 0.03);
        // Half of the power is the main carrier's: a bit has a 200th of it, a hertz a 4000th of the noise.
        let mut noise = samples(&config, 20.0);
        Noise::eb_n0(&config, Carrier::Main, codes, Decibels(6.0), Seed(1)).apply(&mut noise);
        near(power(&signal) / 2.0 / 200.0 / (power(&noise) / 4000.0), Decibels(6.0).power(), 0.03);
    }
}

#[test]
fn noise_depends_on_its_seed_alone() {
    let config = TransmitterConfig::default();
    let noise = |seed| {
        let mut noise = samples(&config, 0.1);
        Noise::new(Level(0.1), Seed(seed)).apply(&mut noise);
        noise
    };
    assert_eq!(noise(1), noise(1));
    assert_ne!(noise(1), noise(2));
}

/// White: as much in every part of the band; and Gaussian: 4.6 % beyond two standard deviations.
#[test]
fn noise_is_white_and_gaussian() {
    let config = TransmitterConfig::default();
    let mut noise = samples(&config, 60.0);
    Noise::new(Level(0.1), Seed(3)).apply(&mut noise);
    let lines = spectrum(&noise, config.sample_rate());
    let expected = 10.0 * (0.01_f64 / 4000.0 / 0.5).log10();
    for part in lines[1..lines.len() - 1].chunks_exact(400) {
        let mean = part.iter().map(|(_, db)| Decibels(*db).power()).sum::<f64>() / 400.0;
        assert!((10.0 * mean.log10() - expected).abs() < 0.3, "{mean} {expected}");
    }
    let beyond = noise.iter().filter(|sample| sample.abs() > 0.2).count();
    near(f64::from(u32::try_from(beyond).expect("few")) / 480_000.0, 0.0455, 0.05);
}

#[test]
fn traction_stands_at_its_harmonics() {
    let config = TransmitterConfig::default();
    let mut signal = samples(&config, 10.0);
    let harmonics = [Harmonic { number: 7, level: Level(0.3) }, Harmonic { number: 16, level: Level(0.1) }];
    Traction::new(config.sample_rate(), Hertz(60.0), &harmonics).apply(&mut signal);
    near(power(&signal), 0.3_f64.powi(2) / 2.0 + 0.1_f64.powi(2) / 2.0, 0.01);
    let lines = spectrum(&signal, config.sample_rate());
    let at =
        |hertz: f64| lines.iter().filter(|line| (line.0 - hertz).abs() < 4.0).map(|line| line.1).fold(-999.0, f64::max);
    assert!((at(420.0) - at(960.0) - 9.54).abs() < 1.5, "{} {}", at(420.0), at(960.0));
    assert!(at(600.0) < at(960.0) - 60.0);
}

#[test]
fn crosstalk_has_its_level() {
    let config = TransmitterConfig::default();
    let mut signal = samples(&config, 1.0);
    Crosstalk::new(Generator::analog(&config, Codes::NONE), Decibels(-20.0)).apply(&mut signal);
    near(power(&signal), 0.25_f64.powi(2) * 0.01, 0.01);
}

/// Stages act in their order; an interruption begins and ends at its sample; a closure is a stage.
#[test]
fn stages_in_order() {
    let gap = |start, length| Interruption { start: Seconds(start), length: Seconds(length) };
    let gaps = Interruptions::new(Hertz(8000.0), &[gap(0.001, 0.0005), gap(0.00125, 0.0005)]);
    let plus = |block: &mut [f32]| block.iter_mut().for_each(|sample| *sample += 1.0);
    let mut channel = Channel::new().with(Gain(2.0)).with(gaps).with(plus);
    let mut block = [0.5; 20];
    channel.apply(&mut block);
    let expected: [f32; 20] = std::array::from_fn(|i| if (8..14).contains(&i) { 1.0 } else { 2.0 });
    assert_eq!(block.map(f32::to_bits), expected.map(f32::to_bits));
}
