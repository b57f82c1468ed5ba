//! What the line says, without a clock.

use super::{Progress, Work, in_programs, last_of, span};
use std::collections::BTreeSet;
use std::time::Duration;

fn work(name: &str, items: usize, cost: f64) -> Work {
    Work { name: name.to_owned(), items: (0..items).map(|place| (format!("{name}{place}"), cost)).collect() }
}

#[test]
fn the_line_says_what_is_done_what_is_left_and_what_runs() {
    let progress = Progress::new(vec![work("proofs", 10, 20.0), work("models", 2, 100.0)], 2);
    progress.begin("proofs");
    // Nothing is known yet: 400 s of a processor on two, and one second has shown nothing.
    let line = progress.line(Duration::from_secs(1));
    assert!(line.starts_with("proofs 0/10 · 1 s so far · about 3 m left"), "{line}");
    for place in 0..9 {
        progress.done(&format!("proofs{place}"));
        progress.done(&format!("proofs{place}"));
    }
    // 180 s of 400 in a minute: at (180 + 240) / (60 + 120) a second, 220 are left for 94.
    let line = progress.line(Duration::from_mins(1));
    assert_eq!(line, "proofs 9/10 · 1 m so far · about 2 m left · now proofs9");
    progress.end();
    progress.begin("models");
    progress.running("a-station");
    let line = progress.line(Duration::from_secs(190));
    assert!(line.starts_with("models 0/2 · 3 m 10 s so far · about "), "{line}");
    assert!(line.ends_with(" · now a-station"), "{line}");
    progress.end();
    assert!(progress.line(Duration::from_secs(200)).contains("about 0 s left"));
}

#[test]
fn a_phase_that_nobody_announced_is_shown() {
    let progress = Progress::new(Vec::new(), 1);
    progress.begin("tests");
    progress.done("anything");
    assert!(progress.line(Duration::from_secs(5)).starts_with("tests · 5 s so far"));
}

#[test]
fn a_build_is_followed_by_its_log() {
    let folder = tempfile::tempdir().expect("a folder");
    let log = folder.path().join("log");
    let says = |text: &str| {
        std::fs::write(&log, text).expect("written");
        last_of(&log)
    };
    assert_eq!(says(""), None);
    assert_eq!(says("   Compiling atc-kernel v0.1.0 (/x)\n"), Some("compiling atc-kernel".to_owned()));
    let running = "   Compiling a v1\n     Running tests/charts.rs (target/debug/deps/charts-02)\n\nrunning 4 tests\ntest a ... ok\n";
    assert_eq!(says(running), Some("running tests/charts.rs".to_owned()));
    assert_eq!(says("    Blocking waiting for file lock\n"), Some("waiting for another Cargo".to_owned()));
    assert_eq!(last_of(&folder.path().join("none")), None);
}

#[cfg(target_os = "linux")]
#[test]
fn programs_that_run_tell_what_they_are_about() {
    let mut child = std::process::Command::new("sh").args(["-c", "sleep 60; :", "/x/t_ilk_4.c"]).spawn().expect("sh");
    let names: BTreeSet<_> = ["t_ilk_4", "t_ilk_40", "t_ilk"].into();
    let mut found = BTreeSet::new();
    for _ in 0..100 {
        found = in_programs(&names);
        if !found.is_empty() {
            break;
        }
        std::thread::sleep(Duration::from_millis(20));
    }
    child.kill().expect("killed");
    child.wait().expect("ended");
    assert_eq!(found.into_iter().collect::<Vec<_>>(), ["t_ilk_4"]);
}

#[test]
fn times_are_short() {
    assert_eq!([0, 59, 60, 61].map(|seconds| span(Duration::from_secs(seconds))), ["0 s", "59 s", "1 m", "1 m 1 s"]);
}
