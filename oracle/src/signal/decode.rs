//! From a WAV file to telegrams and speeds, as JSON lines.

use std::io::{self, Write};
use std::path::Path;

use atc_kernel::code::Millihertz;
use atc_waveform::config::Carrier;
use atc_waveform::receiver::{Heard, OnBoard};
use atc_waveform::wav;
use serde::Serialize;

use super::SignalError;
use super::config::Config;
use atc_protocol::kmh::Kmh;
use atc_protocol::telegrams::{MainTelegram, SubTelegram};

/// Samples that are decoded at once.
const BLOCK: usize = 4096;

/// One line.
#[derive(Serialize)]
#[serde(rename_all = "snake_case")]
enum Said {
    /// A main telegram.
    Main(MainTelegram),
    /// A sub telegram.
    Sub(SubTelegram),
    /// The codes name another speed than before; null: none.
    Code { main_hz: Option<f64>, sub_hz: Option<f64>, speed_km_h: Option<Kmh> },
    /// The end of the recording, and how many telegrams there were.
    End { main: u64, sub: u64 },
}

/// A line with its time from the beginning of the recording.
#[derive(Serialize)]
struct Timed {
    time_s: f64,
    #[serde(flatten)]
    said: Said,
}

/// Writes what a receiver hears in a recording: one line for each telegram and each change of the speed that the codes name.
///
/// # Errors
/// If the file is no recording of this signal's sample rate, or the lines cannot be written.
pub fn decode(config: &Config, path: &Path, mut output: impl Write) -> Result<(), SignalError> {
    let line = config.line().map_err(SignalError::Config)?;
    let recording = wav::read(path).map_err(|error| SignalError::Recording(error.to_string()))?;
    let (rate, expected) = (recording.sample_rate.0, line.signal.sample_rate().0);
    if (rate - expected).abs() > 0.5 {
        let path = path.display();
        return Err(SignalError::Recording(format!(
            "{path}: has {rate} samples a second, and signal.sample_rate_hz is {expected}; they must be the same"
        )));
    }
    let mut receiver = OnBoard::new(&line.signal, line.codes);
    let mut lines: Vec<Timed> = Vec::new();
    let (mut mains, mut subs, mut codes) = (0, 0, [None; 2]);
    // No speed at the beginning is nothing to tell.
    let mut speed = None;
    for block in recording.samples.chunks(BLOCK) {
        receiver.process(block, |event| {
            let said = match event.heard {
                Heard::Bit(..) => None,
                Heard::Main(main) => {
                    mains += 1;
                    Some(Said::Main(main.into()))
                }
                Heard::Sub(sub) => {
                    subs += 1;
                    Some(Said::Sub(sub.into()))
                }
                Heard::Code(carrier, reading) => {
                    let place = usize::from(carrier == Carrier::Sub);
                    codes[place] = reading.millihertz.map(Millihertz);
                    None
                }
                Heard::Speed(now) if speed == now => None,
                Heard::Speed(now) => {
                    speed = now;
                    let [main_hz, sub_hz] = codes.map(|code| code.map(|code| f64::from(code.0) / 1000.0));
                    Some(Said::Code { main_hz, sub_hz, speed_km_h: now.map(|now| Kmh(now.0.into())) })
                }
            };
            let time = event.at.time(line.signal.sample_rate()).0;
            lines.extend(said.map(|said| Timed { time_s: milliseconds(time), said }));
        });
        for line in lines.drain(..) {
            write(&mut output, &line)?;
        }
    }
    #[expect(clippy::cast_precision_loss, reason = "a recording that fits into memory")]
    let length = recording.samples.len() as f64 / rate;
    write(&mut output, &Timed { time_s: milliseconds(length), said: Said::End { main: mains, sub: subs } })?;
    output.flush().map_err(SignalError::Output)
}

/// To whole milliseconds.
fn milliseconds(seconds: f64) -> f64 {
    (seconds * 1000.0).round() / 1000.0
}

fn write(output: &mut impl Write, line: &Timed) -> Result<(), SignalError> {
    let text = serde_json::to_string(line).map_err(|error| SignalError::Output(io::Error::other(error)))?;
    writeln!(output, "{text}").map_err(SignalError::Output)
}
