//! From a configuration to a WAV file.

use std::path::Path;

use atc_kernel::aspect::AspectId;
use atc_kernel::code::Code as KernelCode;
use atc_kernel::distance::Metres;
use atc_kernel::telegram::{Counter, Gradient, Length, Main, Route, SectionId, Sub};
use atc_waveform::channel::{Channel, Gain, Interruption, Interruptions, Noise, Stage as _};
use atc_waveform::config::{Carrier, Codes};
use atc_waveform::generator::Generator;
use atc_waveform::transmitter::Transmitter;
use atc_waveform::units::{Decibels, Hertz, Seconds, Seed};
use atc_waveform::wav::{self, Coding, Recording};

use super::SignalError;
use super::config::{Config, Line, Samples};
use atc_line::code::speed;

/// The longest recording, in seconds.
const LONGEST: f64 = 3600.0;

/// Writes the signal of a configuration as a WAV file, which appears complete or not at all.
///
/// # Errors
/// The rule that the configuration breaks, or why the file cannot be written.
pub fn generate(config: &Config, path: &Path) -> Result<(), SignalError> {
    let (recording, coding) = made(config).map_err(SignalError::Config)?;
    wav::write(path, &recording, coding).map_err(|error| SignalError::Recording(error.to_string()))
}

/// The samples, and how they are written.
fn made(config: &Config) -> Result<(Recording, Coding), String> {
    let line = config.line()?;
    let codes = codes(config, &line)?;
    let (main, sub) = telegrams(config, &line)?;
    let duration = within("recording.duration_s", config.recording.duration_s, 0.001, LONGEST)?;
    let mut channel = channel(config, &line, codes)?;
    let count = usize::try_from(Seconds(duration).samples(line.signal.sample_rate())).unwrap_or(0);
    let mut samples = vec![0.0_f32; count];
    if config.section.telegrams {
        Transmitter::new(&line.signal, codes, main, sub).fill(&mut samples);
    } else {
        Generator::analog(&line.signal, codes).fill(&mut samples);
    }
    channel.apply(&mut samples);
    let coding = match config.recording.samples {
        Samples::Pcm16 => Coding::Pcm16,
        Samples::Float32 => Coding::Float32,
    };
    if coding == Coding::Pcm16 && samples.iter().any(|sample| sample.abs() > 1.0) {
        return Err(
            "the noise takes the samples over full scale: lower signal.main_level and signal.sub_level, or set \
                    recording.samples = \"float32\""
                .to_owned(),
        );
    }
    Ok((Recording { sample_rate: line.signal.sample_rate(), samples }, coding))
}

/// A value in its range; NaN is in none.
fn within(field: &str, value: f64, least: f64, most: f64) -> Result<f64, String> {
    if (least..=most).contains(&value) {
        Ok(value)
    } else {
        Err(format!("{field} is {value}; it must be {least} to {most}"))
    }
}

/// The code frequencies: of a speed in the table, or as they are given.
fn codes(config: &Config, line: &Line) -> Result<Codes, String> {
    let code = &config.code;
    let (main, sub) = match (code.speed_km_h, code.main_hz, code.sub_hz) {
        (Some(km_h), None, None) => {
            let wanted = speed("code.speed_km_h", km_h)?;
            let places = || (0..8).filter_map(KernelCode::new);
            let pair = places().flat_map(|main| places().map(move |sub| (main, sub)));
            let pair = pair.into_iter().find(|(main, sub)| line.codes.speed(Some(*main), Some(*sub)) == Some(wanted));
            let (main, sub) =
                pair.ok_or_else(|| format!("code.speed_km_h is {km_h}; line.codes has no pair for that speed"))?;
            let hz = |codes: &atc_kernel::code::CodeFrequencies, code: KernelCode| {
                codes.nominal().get(usize::from(code.place())).map(|code| Hertz(f64::from(code.0) / 1000.0))
            };
            (hz(line.codes.main(), main), hz(line.codes.sub(), sub))
        }
        (None, main, sub) => (main.map(Hertz), sub.map(Hertz)),
        _ => return Err("[code] has speed_km_h and frequencies; it must have the one or the others".to_owned()),
    };
    Codes::new(main, sub).map_err(|error| format!("[code]: {error}"))
}

fn telegrams(config: &Config, line: &Line) -> Result<(Main, Sub), String> {
    let section = &config.section;
    let rank = |field: &str, km_h: f64| -> Result<AspectId, String> {
        let known = line.speeds.aspect(speed(field, km_h)?);
        known.ok_or_else(|| {
            format!("{field} is {km_h}; it must be one of line.speeds_km_h: {:?}", config.line.speeds_km_h)
        })
    };
    let number = SectionId(section.number);
    let main = Main {
        section: number,
        counter: Counter(0),
        route: section.beyond_exit_m.map_or(Route::Closed, |beyond| Route::OpenFor(Metres(beyond))),
        speed: rank("section.speed_km_h", section.speed_km_h)?,
    };
    let sub = Sub {
        section: number,
        counter: Counter(0),
        length: Length::new(Metres(section.length_m)).ok_or("section.length_m is 0; it must be 1 to 65535")?,
        gradient: Gradient(section.gradient_permille),
        curve: rank("section.curve_km_h", section.curve_km_h)?,
        restriction: rank("section.restriction_km_h", section.restriction_km_h)?,
    };
    Ok((main, sub))
}

/// Interruptions, then noise, then the loss of both: the ratio of signal to noise is that at the receiver.
#[expect(clippy::cast_possible_truncation, reason = "a gain of 10⁻¹⁰ to 1")]
fn channel(config: &Config, line: &Line, codes: Codes) -> Result<Channel, String> {
    let given = &config.channel;
    let mut gaps = Vec::new();
    for (place, gap) in given.interruptions.iter().enumerate() {
        let start = within(&format!("channel.interruptions[{place}].start_s"), gap.start_s, 0.0, LONGEST)?;
        let length = within(&format!("channel.interruptions[{place}].length_s"), gap.length_s, 0.0, LONGEST)?;
        gaps.push(Interruption { start: Seconds(start), length: Seconds(length) });
    }
    let mut channel = Channel::new().with(Interruptions::new(line.signal.sample_rate(), &gaps));
    if let Some(ratio) = given.eb_n0_db {
        let ratio = Decibels(within("channel.eb_n0_db", ratio, -20.0, 100.0)?);
        channel = channel.with(Noise::eb_n0(&line.signal, Carrier::Main, codes, ratio, Seed(given.seed)));
    }
    let loss = within("channel.attenuation_db", given.attenuation_db, 0.0, 200.0)?;
    Ok(channel.with(Gain(10_f64.powf(-loss / 20.0) as f32)))
}
