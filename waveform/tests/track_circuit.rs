//! The track circuit's receiver: free only while it hears its own signal.

mod common;

use atc_kernel::telegram::SectionId;
use atc_waveform::channel::{Gain, Harmonic, Noise, Stage, Traction};
use atc_waveform::config::{Codes, TransmitterConfig};
use atc_waveform::generator::Generator;
use atc_waveform::receiver::{TrackCircuit, TrackCircuitParams, TrackState};
use atc_waveform::transmitter::Transmitter;
use atc_waveform::units::{Decibels, Hertz, Level, Seconds, Seed};
use common::{OWN, codes, main_telegram, samples, sub_telegram};

fn params(own: Option<SectionId>) -> TrackCircuitParams {
    TrackCircuitParams { own, pick_up: Level(0.15), drop_away: Level(0.12), telegram_lifetime: Seconds(1.5) }
}

/// When and to what the circuit changes, in seconds.
fn changes(config: &TransmitterConfig, params: TrackCircuitParams, signal: &[f32]) -> Vec<(f64, TrackState)> {
    let mut circuit = TrackCircuit::new(config, params).expect("in range");
    assert_eq!(circuit.state(), TrackState::Occupied);
    let mut changes = Vec::new();
    circuit.process(signal, |at, state| changes.push((at.time(config.sample_rate()).0, state)));
    changes
}

fn digital(config: &TransmitterConfig, section: SectionId, seconds: f64) -> Vec<f32> {
    let mut signal = samples(config, seconds);
    Transmitter::new(config, codes(1, 1), main_telegram(section), sub_telegram(section)).fill(&mut signal);
    Noise::signal_to_noise(config, codes(1, 1), Decibels(15.0), Seed(3)).apply(&mut signal);
    signal
}

/// ```text
/// signal     ████████████████          ████████████████
/// train      ················██████████················
/// s          0               3         5               8
/// ```
#[test]
fn a_train_passes() {
    let config = TransmitterConfig::default();
    let mut signal = digital(&config, OWN, 8.0);
    // The axles leave a tenth of the signal.
    Gain(0.1).apply(&mut signal[24_000..40_000]);
    let changes = changes(&config, params(Some(OWN)), &signal);
    let [(free, TrackState::Free), (occupied, TrackState::Occupied), (again, TrackState::Free)] = changes[..] else {
        panic!("{changes:?}");
    };
    assert!(free < 1.3, "{free}");
    assert!((3.0..3.25).contains(&occupied), "{occupied}");
    // Loud again within 0.2 s; free only once a telegram has ended after that, here at 10 × 0.53 s.
    assert!((5.3..5.6).contains(&again), "{again}");
}

#[test]
fn another_sections_signal_leaves_it_occupied() {
    let config = TransmitterConfig::default();
    assert_eq!(changes(&config, params(Some(OWN)), &digital(&config, SectionId(322), 4.0)), []);
}

/// Its own signal is replaced by the neighbour's, as loud: occupied with one of the first foreign telegrams, long before the
/// last one of its own has lost its worth.
#[test]
fn another_sections_signal_ends_it() {
    let config = TransmitterConfig::default();
    let mut signal = digital(&config, OWN, 3.0);
    signal.extend(digital(&config, SectionId(322), 4.0));
    let params = TrackCircuitParams { telegram_lifetime: Seconds(10.0), ..params(Some(OWN)) };
    let changes = changes(&config, params, &signal);
    assert_eq!(changes.len(), 2, "{changes:?}");
    assert!(changes[1].1 == TrackState::Occupied && changes[1].0 < 5.5, "{changes:?}");
}

/// Nothing but the codes goes on: its telegrams count for their lifetime, and then no more.
#[test]
fn telegrams_lose_their_worth() {
    let config = TransmitterConfig::default();
    let mut signal = digital(&config, OWN, 3.0);
    let mut analog = samples(&config, 4.0);
    Generator::analog(&config, codes(1, 1)).fill(&mut analog);
    signal.extend(analog);
    let changes = changes(&config, params(Some(OWN)), &signal);
    let [(_, TrackState::Free), (occupied, TrackState::Occupied)] = changes[..] else { panic!("{changes:?}") };
    // The last telegram ended within 0.53 s before the third second.
    assert!((3.9..4.8).contains(&occupied), "{occupied}");
}

/// On a digital line a signal without telegrams is not enough, on an analog-only line it is.
#[test]
fn analog_signal() {
    let config = TransmitterConfig::default();
    let mut signal = samples(&config, 3.0);
    Generator::analog(&config, codes(3, 3)).fill(&mut signal);
    assert_eq!(changes(&config, params(Some(OWN)), &signal), []);
    let analog = changes(&config, params(None), &signal);
    assert!(matches!(analog[..], [(time, TrackState::Free)] if time < 0.7), "{analog:?}");
    // A lifetime of telegrams means nothing there, whatever it is.
    let endless = TrackCircuitParams { telegram_lifetime: Seconds(f64::INFINITY), ..params(None) };
    assert_eq!(changes(&config, endless, &signal), analog);
    // The codes of a signal that is too faint are heard, and not enough.
    Gain(0.4).apply(&mut signal);
    assert_eq!(changes(&config, params(None), &signal), []);
}

/// Harmonics of the traction current on both carriers, as loud as the signal, are not the signal; nor is noise, nor a
/// carrier without its code.
#[test]
fn what_is_not_a_signal() {
    let config = TransmitterConfig::default();
    let mut harmonics = samples(&config, 3.0);
    let on_carriers = [15, 24].map(|number| Harmonic { number, level: Level(0.25) });
    Traction::new(config.sample_rate(), Hertz(50.0), &on_carriers).apply(&mut harmonics);
    let mut noise = samples(&config, 10.0);
    Noise::new(Level(1.0), Seed(6)).apply(&mut noise);
    let mut bare = samples(&config, 3.0);
    Generator::analog(&config, Codes::NONE).fill(&mut bare);
    for signal in [harmonics, noise, bare] {
        assert_eq!(changes(&config, params(None), &signal), []);
        assert_eq!(changes(&config, params(Some(OWN)), &signal), []);
    }
}

/// Between the two thresholds it stays what it is.
#[test]
fn levels_have_a_hysteresis() {
    let config = TransmitterConfig::default();
    let mut between = digital(&config, OWN, 3.0);
    Gain(0.54).apply(&mut between);
    assert_eq!(changes(&config, params(Some(OWN)), &between), []);
    let mut falling = digital(&config, OWN, 6.0);
    Gain(0.54).apply(&mut falling[24_000..]);
    let falling = changes(&config, params(Some(OWN)), &falling);
    assert!(matches!(falling[..], [(_, TrackState::Free)]), "{falling:?}");
}

#[test]
fn parameters_that_cannot_be() {
    let config = TransmitterConfig::default();
    let message = |params| TrackCircuit::new(&config, params).err().expect("refused").to_string();
    let good = params(Some(OWN));
    let levels = "pick_up is 0.15 and drop_away 0.2; both must be above 0 and finite, and drop_away at most pick_up";
    assert_eq!(message(TrackCircuitParams { drop_away: Level(0.2), ..good }), levels);
    assert!(message(TrackCircuitParams { drop_away: Level(0.0), ..good }).contains("above 0"));
    assert!(message(TrackCircuitParams { pick_up: Level(f64::NAN), ..good }).contains("NaN"));
    assert!(message(TrackCircuitParams { pick_up: Level(f64::INFINITY), ..good }).contains("finite"));
    let lifetime = "telegram_lifetime is 0.5 s; it must be from 0.53 s, one telegram, to 60 s";
    assert_eq!(message(TrackCircuitParams { telegram_lifetime: Seconds(0.5), ..good }), lifetime);
}
