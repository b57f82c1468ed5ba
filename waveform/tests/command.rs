//! The program itself: what it refuses, and that it writes nothing then.

use std::fs;
use std::process::{Command, Output};

fn waveform(arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_waveform")).args(arguments).output().expect("started")
}

#[test]
fn a_folder_that_cannot_be_made() {
    let folder = tempfile::tempdir().expect("a folder");
    let file = folder.path().join("file");
    fs::write(&file, "").expect("written");
    let out = file.join("out");
    let output = waveform(&["bench", "--quick", "--out", out.to_str().expect("text")]);
    assert_eq!(output.status.code(), Some(1));
    let message = String::from_utf8_lossy(&output.stderr);
    assert!(message.starts_with("waveform: ") && message.contains("out: cannot be made: "), "{message}");
}

#[test]
fn arguments_that_cannot_be() {
    for arguments in [vec!["bench"], vec!["bench", "--out", "x", "--seed", "-1"], vec!["listen"], vec![]] {
        let output = waveform(&arguments);
        assert_eq!(output.status.code(), Some(2), "{arguments:?}");
        assert!(!output.stderr.is_empty());
    }
}
