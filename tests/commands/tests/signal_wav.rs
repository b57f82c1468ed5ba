//! `oracle signal`: what is generated is decoded to the same telegrams and speeds at the stated signal-to-noise ratio; and files and
//! configurations that are wrong are refused, with nothing half-written.

use std::fs;
use std::path::Path;
use std::process::{Command, Output};

use atc_tests::device;
use serde_json::{Value, json};

fn oracle(folder: &Path, arguments: &[&str]) -> Output {
    let output = Command::new(device::oracle()).args(arguments).current_dir(folder).output();
    output.expect("the oracle runs")
}

fn text(bytes: &[u8]) -> String {
    String::from_utf8(bytes.to_vec()).expect("UTF-8")
}

/// Generates and decodes; what was said of `key`, in the order of time.
fn through(config: &str) -> Vec<Value> {
    let folder = tempfile::tempdir().expect("a folder");
    fs::write(folder.path().join("c.toml"), config).expect("a configuration");
    let output = oracle(folder.path(), &["signal", "generate", "c.toml", "s.wav"]);
    assert!(output.status.success(), "{}", text(&output.stderr));
    assert!(output.stdout.is_empty() && output.stderr.is_empty());
    let output = oracle(folder.path(), &["signal", "decode", "s.wav", "--config", "c.toml"]);
    assert!(output.status.success(), "{}", text(&output.stderr));
    text(&output.stdout).lines().map(|line| serde_json::from_str(line).expect("JSON")).collect()
}

fn of<'a>(lines: &'a [Value], key: &str) -> Vec<&'a Value> {
    lines.iter().filter_map(|line| line.get(key)).collect()
}

/// 22 frames of each carrier in 12 s at Eb/N0 = 18 dB and a loss of 20 dB: nearly all of them, in their order, with what was
/// configured, and none that was not sent; and the speed of the code, with no other in between.
#[test]
fn the_same_telegrams_and_speeds_at_18_db() {
    for seed in 1..=5 {
        let lines = through(&format!(
            "[recording]\nduration_s = 12\n[section]\nnumber = 7\nbeyond_exit_m = 400\nspeed_km_h = 65\nlength_m = 250\n\
             gradient_permille = -12\ncurve_km_h = 75\nrestriction_km_h = 90\n[code]\nspeed_km_h = 45\n\
             [channel]\nattenuation_db = 20\neb_n0_db = 18\nseed = {seed}\n"
        ));
        let fixed = [
            ("main", json!({"section":7,"beyond_exit_m":400,"speed_rank":5})),
            ("sub", json!({"section":7,"length_m":250,"gradient_permille":-12,"curve_rank":6,"restriction_rank":7})),
        ];
        for (kind, expected) in fixed {
            let mut counters = Vec::new();
            for telegram in of(&lines, kind) {
                let mut telegram = telegram.clone();
                let counter = telegram.as_object_mut().and_then(|fields| fields.remove("counter"));
                counters.push(counter.and_then(|counter| counter.as_u64()).expect("a counter"));
                assert_eq!(telegram, expected);
            }
            assert!(counters.windows(2).all(|pair| pair[0] < pair[1]), "{counters:?}");
            assert!(counters.len() >= 20 && counters.last() <= Some(&21), "{kind} at seed {seed}: {counters:?}");
        }
        let speeds: Vec<_> = of(&lines, "code").iter().map(|code| code["speed_km_h"].clone()).collect();
        assert_eq!(speeds, [json!(45)], "seed {seed}");
        let end = lines.last().expect("an end");
        assert_eq!(end["time_s"], json!(12.0));
        assert_eq!(end["end"]["main"].as_u64(), Some(of(&lines, "main").len() as u64));
    }
}

/// Without noise every telegram is heard, in either coding: the first ends after 106 bits, 0.53 s, and little later is it heard.
#[test]
fn every_telegram_without_noise() {
    for samples in ["pcm16", "float32"] {
        let lines = through(&format!("[recording]\nduration_s = 5.6\nsamples = \"{samples}\"\n"));
        for kind in ["main", "sub"] {
            let counters: Vec<_> =
                of(&lines, kind).iter().filter_map(|telegram| telegram["counter"].as_u64()).collect();
            assert_eq!(counters, (0..10).collect::<Vec<_>>(), "{kind}");
            let first = lines.iter().find(|line| line.get(kind).is_some()).expect("one");
            let late = first["time_s"].as_f64().expect("a time") - 0.53;
            assert!((0.0..0.15).contains(&late), "{late}");
        }
    }
}

/// All speeds of the standard codes; a pair given as frequencies; a pair that is not in the table; no code.
#[test]
fn the_codes() {
    let speeds = |code: &str| -> Vec<Value> {
        let config = format!("[recording]\nduration_s = 2\n[code]\n{code}\n");
        of(&through(&config), "code").iter().map(|code| code["speed_km_h"].clone()).collect()
    };
    for speed in [15, 25, 45, 55, 75, 90] {
        assert_eq!(speeds(&format!("speed_km_h = {speed}")), [json!(speed)]);
    }
    assert_eq!(speeds("main_hz = 29.0\nsub_hz = 27.0"), [json!(55)]);
    assert_eq!(speeds("main_hz = 29.0\nsub_hz = 21.0"), [] as [Value; 0]);
    assert_eq!(speeds("main_hz = 29.0"), [] as [Value; 0]);
}

/// A line with speeds and codes of its own, on other carriers.
#[test]
fn another_line() {
    let lines = through(
        "[recording]\nduration_s = 3\n[signal]\nmain_carrier_hz = 900\nsub_carrier_hz = 1500\n\
         [line]\nspeeds_km_h = [0, 30, 60.5]\ntolerance_hz = 0.8\n\
         codes = [{ main_hz = 12, sub_hz = 20, speed_km_h = 30 }, { main_hz = 18, sub_hz = 30, speed_km_h = 60.5 }]\n\
         [section]\nspeed_km_h = 60.5\ncurve_km_h = 60.5\nrestriction_km_h = 30\n[code]\nspeed_km_h = 60.5\n",
    );
    assert_eq!(of(&lines, "code").last().expect("a code")["speed_km_h"], json!(60.5));
    assert_eq!(of(&lines, "main")[0]["speed_rank"], json!(2));
    assert_eq!(of(&lines, "sub")[0]["restriction_rank"], json!(1));
}

/// In an interruption nothing is heard, and after it everything again; on an analog line there are codes and no telegrams.
#[test]
fn interruptions_and_analog_lines() {
    let gap = "[recording]\nduration_s = 8\n[channel]\nattenuation_db = 10\neb_n0_db = 20\ninterruptions = [{ start_s = 3, length_s = 2 }]\n";
    let lines = through(gap);
    let times = |kind: &str| -> Vec<f64> {
        lines.iter().filter(|line| line.get(kind).is_some()).filter_map(|line| line["time_s"].as_f64()).collect()
    };
    for kind in ["main", "sub"] {
        assert!(times(kind).iter().all(|time| !(3.1..5.5).contains(time)), "{:?}", times(kind));
        assert!(times(kind).iter().any(|time| *time > 5.5) && times(kind).len() >= 8);
    }
    let speeds: Vec<_> = of(&lines, "code").iter().map(|code| code["speed_km_h"].clone()).collect();
    assert_eq!(speeds, [json!(75), Value::Null, json!(75)]);
    let lines = through(
        "[recording]\nduration_s = 5\n[section]\ntelegrams = false\n[channel]\nattenuation_db = 10\neb_n0_db = 20\n",
    );
    assert_eq!((of(&lines, "main").len(), of(&lines, "sub").len()), (0, 0));
    assert_eq!(of(&lines, "code").last().expect("a code")["speed_km_h"], json!(75));
}

/// The example of the repository, with the standard receiver: it needs no configuration to be read.
#[test]
fn the_example() {
    let example = concat!(env!("CARGO_MANIFEST_DIR"), "/../../oracle/examples/signal.toml");
    let folder = tempfile::tempdir().expect("a folder");
    let output = oracle(folder.path(), &["signal", "generate", example, "s.wav"]);
    assert!(output.status.success(), "{}", text(&output.stderr));
    let output = oracle(folder.path(), &["signal", "decode", "s.wav"]);
    let lines: Vec<Value> =
        text(&output.stdout).lines().map(|line| serde_json::from_str(line).expect("JSON")).collect();
    assert!(of(&lines, "main").len() >= 6 && of(&lines, "sub").len() >= 6);
    assert!(of(&lines, "code").iter().any(|code| code["speed_km_h"] == json!(45)));
}

#[test]
fn every_wrong_configuration_is_named() {
    let cases = [
        ("recording = 1", "c.toml: TOML parse error at line 1, column 13"),
        ("[section]\nlength = 3", "unknown field `length`"),
        ("[section]\nnumber = 65536", "TOML parse error at line 2"),
        ("[recording]\nduration_s = 0", "c.toml: recording.duration_s is 0; it must be 0.001 to 3600"),
        ("[recording]\nduration_s = nan", "recording.duration_s is NaN; it must be"),
        ("[recording]\nsamples = \"mp3\"", "unknown variant `mp3`, expected `pcm16` or `float32`"),
        ("[signal]\nmain_carrier_hz = 5000", "[signal]: the Main carrier with its sidebands reaches 5200 Hz"),
        ("[signal]\nmain_level = 2", "[signal]: main_level is 2; it must be from 0.001 to 1"),
        ("[line]\nspeeds_km_h = [15, 15]", "line.speeds_km_h must have 1 to 16 speeds, strictly rising"),
        (
            "[line]\nspeeds_km_h = [15.05]",
            "line.speeds_km_h[0] is 15.05; it must be 0 to 6553.5, in whole steps of 0.1",
        ),
        ("[line]\ncodes = []", "line.codes is empty"),
        (
            "[line]\ntolerance_hz = 3",
            "line.codes has main_hz = 10 and 15; they must be more than twice line.tolerance_hz = 3 apart",
        ),
        ("[line]\ntolerance_hz = 20", "line.codes has main_hz = 10, not above line.tolerance_hz = 20"),
        (
            "[line]\ncodes = [{ main_hz = 10, sub_hz = 12, speed_km_h = 15 }, { main_hz = 10, sub_hz = 12, speed_km_h = 25 }]",
            "line.codes[1] is a pair of codes that has a speed already",
        ),
        ("[code]\nspeed_km_h = 65", "code.speed_km_h is 65; line.codes has no pair for that speed"),
        (
            "[code]\nspeed_km_h = 75\nmain_hz = 10",
            "[code] has speed_km_h and frequencies; it must have the one or the others",
        ),
        ("[code]\nmain_hz = 5", "[code]: main code is 5; it must be from 8 to 50"),
        ("[section]\nspeed_km_h = 66", "section.speed_km_h is 66; it must be one of line.speeds_km_h: [0.0, 15.0"),
        ("[section]\ncurve_km_h = 66", "section.curve_km_h is 66"),
        ("[section]\nrestriction_km_h = 66", "section.restriction_km_h is 66"),
        ("[section]\nlength_m = 0", "section.length_m is 0; it must be 1 to 65535"),
        ("[channel]\nattenuation_db = -1", "channel.attenuation_db is -1; it must be 0 to 200"),
        ("[channel]\neb_n0_db = 200", "channel.eb_n0_db is 200; it must be -20 to 100"),
        ("[channel]\ninterruptions = [{ start_s = -1, length_s = 1 }]", "channel.interruptions[0].start_s is -1"),
        ("[channel]\ninterruptions = [{ start_s = 1 }]", "missing field `length_s`"),
        ("[channel]\neb_n0_db = -20", "the noise takes the samples over full scale"),
    ];
    for (config, message) in cases {
        let folder = tempfile::tempdir().expect("a folder");
        fs::write(folder.path().join("c.toml"), config).expect("a configuration");
        let output = oracle(folder.path(), &["signal", "generate", "c.toml", "s.wav"]);
        let said = text(&output.stderr);
        assert_eq!(output.status.code(), Some(1), "{config}: {said}");
        assert!(said.starts_with("oracle: c.toml: ") && said.contains(message), "{config}\nwas answered by {said}");
        assert_eq!(fs::read_dir(folder.path()).expect("a folder").count(), 1, "{config} left a file behind");
    }
}

#[test]
fn every_wrong_recording_is_named() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = |name: &str| folder.path().join(name);
    fs::write(path("c.toml"), "[recording]\nduration_s = 1\n").expect("a configuration");
    fs::write(path("fast.toml"), "[signal]\nsample_rate_hz = 16000\n").expect("a configuration");
    assert!(oracle(folder.path(), &["signal", "generate", "c.toml", "good.wav"]).status.success());
    let good = fs::read(path("good.wav")).expect("a recording");
    fs::write(path("cut.wav"), &good[..good.len() / 2]).expect("a file");
    fs::write(path("header.wav"), &good[..30]).expect("a file");
    fs::write(path("empty.wav"), []).expect("a file");
    fs::write(path("foreign.wav"), "this is no recording of anything at all").expect("a file");
    let mut stereo = good.clone();
    stereo[22] = 2;
    stereo[28..32].copy_from_slice(&32_000_u32.to_le_bytes());
    stereo[32] = 4;
    fs::write(path("stereo.wav"), stereo).expect("a file");
    let cases: [(&[&str], &str); 7] = [
        (&["nowhere.wav"], "nowhere.wav: there is no such file"),
        (&["cut.wav"], "cut.wav: "),
        (&["header.wav"], "header.wav: "),
        (&["empty.wav"], "empty.wav: "),
        (&["foreign.wav"], "foreign.wav: is not a WAV file"),
        (&["stereo.wav"], "stereo.wav: has 2 channels; a recording of one channel is needed"),
        (
            &["good.wav", "--config", "fast.toml"],
            "good.wav: has 8000 samples a second, and signal.sample_rate_hz is 16000",
        ),
    ];
    for (arguments, message) in cases {
        let output = oracle(folder.path(), &[&["signal", "decode"], arguments].concat());
        let said = text(&output.stderr);
        assert_eq!(output.status.code(), Some(1), "{arguments:?}: {said}");
        assert!(said.starts_with(&format!("oracle: {message}")), "{arguments:?} was answered by {said}");
        assert!(output.stdout.is_empty(), "{arguments:?} said something");
    }
    let output = oracle(folder.path(), &["signal", "generate", "c.toml", "no/such/folder.wav"]);
    assert!(text(&output.stderr).starts_with("oracle: no/such/folder.wav: cannot be written"));
    let output = oracle(folder.path(), &["signal", "generate", "nowhere.toml", "s.wav"]);
    assert!(text(&output.stderr).starts_with("oracle: nowhere.toml cannot be read"));
    assert!(!path("s.wav").exists());
}
