//! How many times faster than the signal itself one core is.

use std::time::Instant;

use atc_kernel::code::CodeTable;
use atc_kernel::telegram::SectionId;
use serde::Serialize;

use super::detection::standard_transmitter;
use crate::channel::{Noise, Stage};
use crate::config::{Codes, TransmitterConfig};
use crate::receiver::{CodeConfidence, Conventional, OnBoard, TrackCircuit, TrackCircuitParams};
use crate::units::{Decibels, Level, Seconds, Seed};

/// Samples handed over at once.
const BLOCK: usize = 1024;
/// The signal is timed in so many parts and the fastest counts: the machine may be busy with other things.
const PARTS: usize = 10;

/// Seconds of signal for each second of computing, on one core of this machine.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Throughput {
    /// Length of the signal, in seconds.
    pub signal_s: f64,
    /// Transmitter of both carriers.
    pub transmitter: f64,
    /// Conventional receiver.
    pub conventional: f64,
    /// Receiver of codes and telegrams.
    pub on_board: f64,
    /// Track circuit receiver.
    pub track_circuit: f64,
}

/// Measures with a signal of this length, in noise of 10 dB.
pub fn throughput(config: &TransmitterConfig, table: &CodeTable, length: Seconds) -> Throughput {
    let mut result =
        Throughput { signal_s: length.0, transmitter: 0.0, conventional: 0.0, on_board: 0.0, track_circuit: 0.0 };
    let Some(mut transmitter) = standard_transmitter(config) else { return result };
    let samples = usize::try_from(length.samples(config.sample_rate())).unwrap_or(0);
    let mut signal = vec![0.0; samples];
    let mut fastest = 0.0;
    for part in signal.chunks_mut(samples.div_ceil(PARTS).max(1)) {
        let started = Instant::now();
        part.chunks_mut(BLOCK).for_each(|block| transmitter.fill(block));
        fastest = f64::max(fastest, speed(config, part, started));
    }
    result.transmitter = fastest;
    Noise::signal_to_noise(config, Codes::NONE, Decibels(10.0), Seed(1)).apply(&mut signal);

    // What was heard is summed up and looked at, so that the compiler cannot leave anything out.
    let mut heard = 0_u64;
    let mut receiver = Conventional::new(config, *table, CodeConfidence::default());
    result.conventional = fastest_part(config, &signal, |block| receiver.process(block, |event| heard += event.at.0));

    let mut receiver = OnBoard::new(config, *table);
    result.on_board = fastest_part(config, &signal, |block| receiver.process(block, |event| heard += event.at.0));

    let params = TrackCircuitParams {
        own: Some(SectionId(1234)),
        pick_up: Level(0.1),
        drop_away: Level(0.05),
        telegram_lifetime: Seconds(1.5),
    };
    if let Ok(mut receiver) = TrackCircuit::new(config, params) {
        result.track_circuit = fastest_part(config, &signal, |block| receiver.process(block, |at, _| heard += at.0));
    }
    std::hint::black_box(heard);
    result
}

fn fastest_part(config: &TransmitterConfig, signal: &[f32], mut process: impl FnMut(&[f32])) -> f64 {
    let parts = signal.chunks(signal.len().div_ceil(PARTS).max(1)).map(|part| {
        let started = Instant::now();
        part.chunks(BLOCK).for_each(&mut process);
        speed(config, part, started)
    });
    parts.fold(0.0, f64::max)
}

/// Seconds of signal for each second since the start.
#[allow(clippy::cast_precision_loss)]
fn speed(config: &TransmitterConfig, part: &[f32], started: Instant) -> f64 {
    part.len() as f64 / config.sample_rate().0 / started.elapsed().as_secs_f64().max(f64::MIN_POSITIVE)
}
