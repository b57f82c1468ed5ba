//! WAV files: what is written is heard again, and what cannot be read is refused with its name and the reason.

mod common;

use std::fs;
use std::path::Path;

use atc_waveform::config::TransmitterConfig;
use atc_waveform::transmitter::Transmitter;
use atc_waveform::units::Hertz;
use atc_waveform::wav::{Coding, Recording, read, write};
use common::{Log, OWN, codes, main_telegram, samples, sub_telegram};
use hound::{SampleFormat, WavSpec, WavWriter};

fn recording(config: &TransmitterConfig) -> Recording {
    let mut samples = samples(config, 2.0);
    Transmitter::new(config, codes(2, 2), main_telegram(OWN), sub_telegram(OWN)).fill(&mut samples);
    Recording { sample_rate: config.sample_rate(), samples }
}

#[test]
fn written_and_read() {
    let config = TransmitterConfig::default();
    let folder = tempfile::tempdir().expect("a folder");
    let sent = recording(&config);
    let direct = Log::of(&config, &sent.samples);
    for (coding, name, step) in [(Coding::Float32, "float.wav", 0.0), (Coding::Pcm16, "integer.wav", 0.51 / 32768.0)] {
        let path = folder.path().join(name);
        write(&path, &sent, coding).expect("written");
        let back = read(&path).expect("read");
        assert_eq!((back.sample_rate, back.samples.len()), (sent.sample_rate, sent.samples.len()));
        assert!(back.samples.iter().zip(&sent.samples).all(|(a, b)| (a - b).abs() <= step));
        let log = Log::of(&config, &back.samples);
        assert!(log.main.len() >= 2);
        assert_eq!((log.main, log.sub, log.speeds), (direct.main.clone(), direct.sub.clone(), direct.speeds.clone()));
    }
}

/// Over full scale an integer file is clipped, never wrapped round.
#[test]
fn clipped() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("loud.wav");
    let loud = Recording { sample_rate: Hertz(8000.0), samples: vec![2.0, -2.0, 0.5] };
    write(&path, &loud, Coding::Pcm16).expect("written");
    assert_eq!(read(&path).expect("read").samples, [32767.0 / 32768.0, -1.0, 0.5]);
}

fn refused(path: &Path) -> String {
    let message = read(path).expect_err("refused").to_string();
    let name = path.file_name().and_then(|name| name.to_str()).expect("a name");
    assert!(message.contains(name), "{message}");
    message
}

#[test]
fn files_that_cannot_be_read() {
    let folder = tempfile::tempdir().expect("a folder");
    let at = |name: &str| folder.path().join(name);
    assert!(refused(&at("missing.wav")).ends_with("there is no such file"));

    fs::write(at("text.wav"), "this is no sound").expect("written");
    assert!(refused(&at("text.wav")).contains("is not a WAV file that can be read"));
    fs::write(at("empty.wav"), "").expect("written");
    assert!(refused(&at("empty.wav")).contains("ends too early"));

    let spec = |channels, bits_per_sample, sample_format| WavSpec {
        channels,
        sample_rate: 8000,
        bits_per_sample,
        sample_format,
    };
    let mut stereo = WavWriter::create(at("stereo.wav"), spec(2, 16, SampleFormat::Int)).expect("made");
    for _ in 0..10 {
        stereo.write_sample(0_i16).expect("written");
    }
    stereo.finalize().expect("written");
    assert!(refused(&at("stereo.wav")).ends_with("has 2 channels; a recording of one channel is needed"));

    let mut fine = WavWriter::create(at("24.wav"), spec(1, 24, SampleFormat::Int)).expect("made");
    fine.write_sample(0_i32).expect("written");
    fine.finalize().expect("written");
    assert!(refused(&at("24.wav")).contains("has 24-bit integer samples; 16-bit integer or 32-bit float"));

    let mut odd = WavWriter::create(at("nan.wav"), spec(1, 32, SampleFormat::Float)).expect("made");
    odd.write_sample(0.5_f32).expect("written");
    odd.write_sample(f32::NAN).expect("written");
    odd.finalize().expect("written");
    assert!(refused(&at("nan.wav")).ends_with("sample 1 is NaN, not a finite number"));

    let whole = recording(&TransmitterConfig::default());
    write(&at("whole.wav"), &whole, Coding::Pcm16).expect("written");
    let bytes = fs::read(at("whole.wav")).expect("read");
    fs::write(at("short.wav"), &bytes[..bytes.len() / 2]).expect("written");
    assert!(refused(&at("short.wav")).contains("ends too early"));
}

#[test]
fn files_that_cannot_be_written() {
    let folder = tempfile::tempdir().expect("a folder");
    let sound = Recording { sample_rate: Hertz(8000.0), samples: vec![0.0; 10] };
    let nowhere = folder.path().join("missing").join("a.wav");
    let message = write(&nowhere, &sound, Coding::Pcm16).expect_err("refused").to_string();
    assert!(message.contains("a.wav: cannot be written"), "{message}");
    let half = Recording { sample_rate: Hertz(8000.5), ..sound };
    let message = write(&folder.path().join("b.wav"), &half, Coding::Pcm16).expect_err("refused").to_string();
    assert!(message.ends_with("the sample rate is 8000.5 Hz; it must be a whole number from 1 to 192000"), "{message}");
    // Nothing was left behind.
    assert_eq!(fs::read_dir(folder.path()).expect("there").count(), 0);
}
