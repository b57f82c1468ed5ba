//! However a signal is cut into blocks, it is the same signal and the same events; and no block costs an allocation.

mod common;

use atc_waveform::channel::{Channel, Crosstalk, Harmonic, Interruption, Interruptions, Noise, Stage, Traction};
use atc_waveform::config::{TransmitterConfig, TransmitterParams};
use atc_waveform::generator::Generator;
use atc_waveform::receiver::{CodeConfidence, Conventional, OnBoard, TrackCircuit, TrackCircuitParams, TrackState};
use atc_waveform::transmitter::Transmitter;
use atc_waveform::units::{Decibels, Hertz, Level, SampleIndex, Seconds, Seed};
use common::{Log, OWN, codes, main_telegram, samples, sub_telegram, table};
use proptest::prelude::*;

/// Everything that a channel can do.
fn channel(config: &TransmitterConfig) -> Channel {
    let gap = Interruption { start: Seconds(1.2), length: Seconds(0.1) };
    let harmonics = [Harmonic { number: 13, level: Level(0.05) }, Harmonic { number: 15, level: Level(0.01) }];
    Channel::new()
        .with(Interruptions::new(config.sample_rate(), &[gap]))
        .with(Crosstalk::new(Generator::analog(config, codes(4, 1)), Decibels(-25.0)))
        .with(Traction::new(config.sample_rate(), Hertz(50.0), &harmonics))
        .with(Noise::signal_to_noise(config, codes(2, 2), Decibels(12.0), Seed(9)))
}

fn track_circuit(config: &TransmitterConfig) -> TrackCircuit {
    let params = TrackCircuitParams {
        own: Some(OWN),
        pick_up: Level(0.1),
        drop_away: Level(0.08),
        telegram_lifetime: Seconds(1.5),
    };
    TrackCircuit::new(config, params).expect("in range")
}

/// Sends, disturbs and receives in blocks of these lengths, again and again.
fn run(lengths: &[usize]) -> (Vec<f32>, Log, Vec<(SampleIndex, TrackState)>) {
    let config = TransmitterConfig::default();
    let mut transmitter = Transmitter::new(&config, codes(2, 2), main_telegram(OWN), sub_telegram(OWN));
    let mut channel = channel(&config);
    let mut receiver = OnBoard::new(&config, table());
    let mut circuit = track_circuit(&config);
    let (mut log, mut states) = (Log::default(), Vec::new());
    let mut signal = samples(&config, 2.5);
    let mut rest = signal.as_mut_slice();
    for length in lengths.iter().cycle() {
        if rest.is_empty() {
            break;
        }
        let (block, after) = rest.split_at_mut((*length).min(rest.len()));
        transmitter.fill(block);
        channel.apply(block);
        receiver.process(block, |event| log.note(&config, event));
        circuit.process(block, |at, state| states.push((at, state)));
        rest = after;
    }
    (signal, log, states)
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 12, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn blocks_do_not_matter(lengths in prop::collection::vec(1..=4096_usize, 1..8)) {
        let whole = run(&[usize::MAX]);
        prop_assert!(whole.1.main.len() >= 2 && !whole.2.is_empty());
        prop_assert!(run(&lengths) == whole, "{lengths:?}");
    }
}

#[test]
fn single_samples() {
    assert!(run(&[1]) == run(&[4096]));
}

#[test]
fn nothing_is_allocated_in_the_loop() {
    let config = TransmitterConfig::default();
    let mut transmitter = Transmitter::new(&config, codes(2, 2), main_telegram(OWN), sub_telegram(OWN));
    let mut channel = channel(&config);
    let mut receiver = OnBoard::new(&config, table());
    let mut conventional = Conventional::new(&config, table(), CodeConfidence::default());
    let mut circuit = track_circuit(&config);
    let mut block = [0.0; 500];
    let mut heard = 0_u32;
    let counted = allocation_counter::measure(|| {
        for _ in 0..40 {
            transmitter.fill(&mut block);
            channel.apply(&mut block);
            receiver.process(&block, |_| heard += 1);
            conventional.process(&block, |_| heard += 1);
            circuit.process(&block, |_, _| heard += 1);
        }
    });
    assert!(heard > 500, "{heard}");
    assert_eq!(counted.count_total, 0);
}

/// Sample rates that are no multiple of the bit rate, other carriers and bit rates: heard all the same.
#[test]
fn other_signals() {
    let standard = TransmitterParams::default();
    let other = |sample_rate, main, sub, bit_rate| TransmitterParams {
        sample_rate: Hertz(sample_rate),
        main_carrier: Hertz(main),
        sub_carrier: Hertz(sub),
        bit_rate: Hertz(bit_rate),
        ..standard.clone()
    };
    for params in [
        other(11_025.0, 750.0, 1200.0, 200.0),
        other(44_100.0, 750.0, 1200.0, 200.0),
        other(8000.0, 1300.0, 700.0, 150.0),
        other(16_000.0, 2000.0, 3000.0, 500.0),
    ] {
        let config = TransmitterConfig::new(params.clone()).expect("a signal that can be");
        let (main, sub) = (main_telegram(OWN), sub_telegram(OWN));
        let mut signal = samples(&config, 3.0);
        Transmitter::new(&config, codes(1, 1), main, sub).fill(&mut signal);
        Noise::signal_to_noise(&config, codes(1, 1), Decibels(15.0), Seed(1)).apply(&mut signal);
        let log = Log::of(&config, &signal);
        assert!(log.main.len() >= 3 && log.sub.len() >= 3, "{params:?}: {:?}", log.main);
        assert!(log.says_only(main, sub));
        assert!(log.speeds.last().is_some_and(|(_, speed)| speed.is_some()), "{params:?}");
    }
}

/// What is no number in a recording costs the samples around it and nothing after.
#[test]
fn samples_that_are_no_numbers() {
    let config = TransmitterConfig::default();
    let mut signal = samples(&config, 4.0);
    Transmitter::new(&config, codes(1, 1), main_telegram(OWN), sub_telegram(OWN)).fill(&mut signal);
    signal[100] = f32::NAN;
    signal[5000] = f32::INFINITY;
    signal[5001] = f32::MAX;
    let log = Log::of(&config, &signal);
    assert!(log.main.iter().any(|(time, _)| *time > 2.0));
    assert!(log.speeds.last().is_some_and(|(_, speed)| speed.is_some()));
}
