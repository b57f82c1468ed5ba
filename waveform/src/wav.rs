//! WAV files, in and out: so that anyone can listen to a signal, plot it, or feed a recording.

use std::fmt;
use std::io::{Cursor, ErrorKind};
use std::path::{Path, PathBuf};

use hound::{SampleFormat, WavReader, WavSpec, WavWriter};

use crate::units::Hertz;

/// How samples are written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Coding {
    /// 16-bit integers; what is over full scale is clipped.
    Pcm16,
    /// 32-bit floating point.
    Float32,
}

/// A recording of one channel.
#[derive(Clone, Debug, PartialEq)]
pub struct Recording {
    /// Samples in a second.
    pub sample_rate: Hertz,
    /// The samples, as parts of full scale.
    pub samples: Vec<f32>,
}

/// A WAV file that cannot be read or written: which, and why.
#[derive(Debug)]
pub struct WavError {
    /// The file.
    pub path: PathBuf,
    /// The reason, and what would be right.
    pub reason: String,
}

impl fmt::Display for WavError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}: {}", self.path.display(), self.reason)
    }
}

impl std::error::Error for WavError {}

/// Reads a WAV file of one channel, 16-bit integer or 32-bit float.
///
/// # Errors
/// [`WavError`]: the file cannot be read, is no WAV file, ends too early, has more channels, another coding, or samples that
/// are no numbers.
pub fn read(path: &Path) -> Result<Recording, WavError> {
    let error = |reason: String| WavError { path: path.to_owned(), reason };
    let mut reader = WavReader::open(path).map_err(|e| error(reading(&e)))?;
    let spec = reader.spec();
    if spec.channels != 1 {
        return Err(error(format!("has {} channels; a recording of one channel is needed", spec.channels)));
    }
    let samples: Result<Vec<f32>, hound::Error> = match (spec.sample_format, spec.bits_per_sample) {
        (SampleFormat::Int, 16) => {
            reader.samples::<i16>().map(|sample| sample.map(|sample| f32::from(sample) / 32768.0)).collect()
        }
        (SampleFormat::Float, 32) => reader.samples::<f32>().collect(),
        (format, bits) => {
            let format = if format == SampleFormat::Int { "integer" } else { "float" };
            return Err(error(format!(
                "has {bits}-bit {format} samples; 16-bit integer or 32-bit float samples are needed"
            )));
        }
    };
    let samples = samples.map_err(|e| error(reading(&e)))?;
    if let Some(place) = samples.iter().position(|sample| !sample.is_finite()) {
        return Err(error(format!("sample {place} is {}, not a finite number", samples[place])));
    }
    Ok(Recording { sample_rate: Hertz(f64::from(spec.sample_rate)), samples })
}

fn reading(error: &hound::Error) -> String {
    match error {
        hound::Error::IoError(error) if error.kind() == ErrorKind::NotFound => "there is no such file".into(),
        hound::Error::IoError(error) if matches!(error.kind(), ErrorKind::UnexpectedEof | ErrorKind::Other) => {
            format!("ends too early to be a WAV file, or in the middle of a sample ({error})")
        }
        hound::Error::IoError(error) => format!("cannot be read: {error}"),
        hound::Error::FormatError(reason) => format!("is not a WAV file that can be read: {reason}"),
        other => format!("is not a WAV file that can be read: {other}"),
    }
}

/// Writes samples as a WAV file of one channel. The file appears complete or not at all.
///
/// # Errors
/// [`WavError`]: the file cannot be written, or the sample rate is not a whole number of hertz from 1 to 192 000.
#[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // Checked; casts of samples saturate.
pub fn write(path: &Path, recording: &Recording, coding: Coding) -> Result<(), WavError> {
    let error = |reason: String| WavError { path: path.to_owned(), reason };
    let rate = recording.sample_rate.0;
    if rate.fract() != 0.0 || !(1.0..=192_000.0).contains(&rate) {
        return Err(error(format!("the sample rate is {rate} Hz; it must be a whole number from 1 to 192000")));
    }
    let (bits_per_sample, sample_format) = match coding {
        Coding::Pcm16 => (16, SampleFormat::Int),
        Coding::Float32 => (32, SampleFormat::Float),
    };
    let spec = WavSpec { channels: 1, sample_rate: rate as u32, bits_per_sample, sample_format };
    let writing = |e: &dyn fmt::Display| error(format!("cannot be written: {e}"));
    let mut bytes = Cursor::new(Vec::new());
    let mut writer = WavWriter::new(&mut bytes, spec).map_err(|e| writing(&e))?;
    for &sample in &recording.samples {
        let written = match coding {
            Coding::Pcm16 => writer.write_sample((f64::from(sample) * 32768.0).round() as i16),
            Coding::Float32 => writer.write_sample(sample),
        };
        written.map_err(|e| writing(&e))?;
    }
    writer.finalize().map_err(|e| writing(&e))?;
    atc_files::write(path, bytes.get_ref()).map_err(|e| writing(&e))
}
