//! A run that is killed: no process of it is left, no page of it is green, and the next run is right.
#![cfg(target_os = "linux")]

use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

/// What marks everything that a run started, in its environment.
const MARK: &str = "ATC_TEST_OF_KILLED_RUNS";

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).parent().expect("in the checkout").to_path_buf()
}

fn start(out: &Path, mark: &str, more: &[&str]) -> Child {
    Command::new(env!("CARGO_BIN_EXE_safety-case"))
        .args(["run", "--part", "supervision", "--jobs", "2", "--out"])
        .arg(out)
        .args(more)
        .current_dir(root())
        .env(MARK, mark)
        .stdin(Stdio::null())
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .spawn()
        .expect("started")
}

/// The programs that carry the mark: their command lines.
fn marked(mark: &str) -> Vec<String> {
    let wanted = format!("{MARK}={mark}");
    let mut found = Vec::new();
    for entry in std::fs::read_dir("/proc").expect("Linux").flatten() {
        // Nothing of a program that has ended and is not yet waited for.
        let environment = std::fs::read(entry.path().join("environ")).unwrap_or_default();
        if environment.split(|byte| *byte == 0).any(|one| one == wanted.as_bytes()) {
            let line = std::fs::read(entry.path().join("cmdline")).unwrap_or_default();
            found.push(String::from_utf8_lossy(&line).replace('\0', " "));
        }
    }
    found
}

/// Whether another run in this checkout has the provers: they serve one run at a time, and this one waits.
fn others_prove(mark: &str) -> bool {
    let (own, provers) = (format!("{MARK}={mark}"), root().join("target/provers/").display().to_string());
    let read = |entry: &std::fs::DirEntry, name: &str| std::fs::read(entry.path().join(name)).unwrap_or_default();
    std::fs::read_dir("/proc").expect("Linux").flatten().any(|entry| {
        let is_own = read(&entry, "environ").split(|byte| *byte == 0).any(|one| one == own.as_bytes());
        !is_own && String::from_utf8_lossy(&read(&entry, "cmdline")).contains(&provers)
    })
}

/// Waits until something is so, for at most a minute and a half; whether it became so.
fn until(what: impl Fn() -> bool) -> bool {
    let start = Instant::now();
    while start.elapsed() < Duration::from_secs(90) {
        if what() {
            return true;
        }
        std::thread::sleep(Duration::from_millis(20));
    }
    false
}

fn kill(child: &mut Child, signal: &str) {
    // The shell's own: it is there wherever the runner is.
    let ended = Command::new("sh").args(["-c", "kill -s \"$0\" \"$1\"", signal, &child.id().to_string()]).status();
    assert!(ended.expect("sh").success() || child.try_wait().expect("waited for").is_some());
    child.wait().expect("ended");
}

/// That nothing in the folder can be taken for a good case.
fn is_not_green(out: &Path, when: &str) {
    if !out.exists() {
        return;
    }
    assert!(out.join("incomplete").exists(), "{when}: no mark");
    for page in ["index.html", "station.html"] {
        let text = std::fs::read_to_string(out.join(page)).unwrap_or_default();
        assert!(!text.contains("banner green") && !text.contains("banner amber"), "{when}: {page}");
    }
    let page = std::fs::read_to_string(out.join("index.html")).unwrap_or_default();
    assert!(page.is_empty() || page.contains("banner red"), "{when}");
    let case = std::fs::read_to_string(out.join("case.json")).unwrap_or_default();
    assert!(!case.contains("\"complete\": true"), "{when}");
}

/// Leaves a folder as a run leaves it that ended well.
fn green(out: &Path) {
    std::fs::create_dir_all(out).expect("a folder");
    for page in ["index.html", "station.html"] {
        std::fs::write(out.join(page), "<div class=\"banner green\">").expect("written");
    }
    std::fs::write(out.join("case.json"), "{ \"complete\": true }").expect("written");
    std::fs::write(out.join("SHA256SUMS"), "").expect("written");
}

#[test]
fn a_run_that_is_killed_leaves_no_program_and_no_green_page() {
    let folder = tempfile::tempdir().expect("a folder");
    let out = folder.path().join("case");
    let without = ["--no-tests", "--no-measurements"];
    let provers = root().join("target/provers/tools.json").exists();
    for (place, (signal, moment)) in
        [("KILL", 0), ("TERM", 300), ("INT", 900), ("KILL", 1_700), ("KILL", 0)].iter().enumerate()
    {
        green(&out);
        let mark = format!("{}-{place}", std::process::id());
        let mut child = start(&out, &mark, &without);
        let begun = || std::fs::read_to_string(out.join("index.html")).is_ok_and(|page| page.contains("has not ended"));
        assert!(until(begun), "the page of a run that begins is there early");
        if provers && place > 1 {
            // While a prover or its compiler runs, whichever it is at that moment.
            let busy = || marked(&mark).iter().any(|line| line.contains("/target/provers/"));
            let ended = || !marked(&mark).iter().any(|line| line.contains("safety-case"));
            assert!(until(|| busy() || ended() || others_prove(&mark)), "nothing runs");
        }
        std::thread::sleep(Duration::from_millis(*moment));
        kill(&mut child, signal);
        let when = format!("{signal} at moment {place}");
        assert!(until(|| marked(&mark).is_empty()), "{when}: left behind: {:?}", marked(&mark));
        is_not_green(&out, &when);
    }
    // And the next one, to its end.
    let mark = format!("{}-next", std::process::id());
    let ended = start(&out, &mark, &[&without[..], &["--no-provers", "--no-models"]].concat()).wait().expect("ended");
    assert_eq!(ended.code(), Some(0));
    assert!(marked(&mark).is_empty());
    let case = std::fs::read_to_string(out.join("case.json")).expect("written");
    assert!(case.contains("\"part\": \"supervision\"") && case.contains("\"running\": false"));
    is_not_green(&out, "a part");
}

/// A cargo that is slow to end, and what it has started.
#[test]
fn a_run_that_is_killed_takes_cargo_and_its_tests_along() {
    let folder = tempfile::tempdir().expect("a folder");
    let out = folder.path().join("case");
    let cargo = folder.path().join("cargo");
    std::fs::write(&cargo, "#!/bin/sh\nsleep 600 &\ntrap '' TERM INT\nwait\nwait\n").expect("written");
    let made = Command::new("chmod").arg("+x").arg(&cargo).status().expect("chmod");
    assert!(made.success());
    for (place, signal) in ["TERM", "KILL"].iter().enumerate() {
        let mark = format!("{}-cargo-{place}", std::process::id());
        let mut child = Command::new(env!("CARGO_BIN_EXE_safety-case"))
            .args(["run", "--part", "supervision", "--no-provers", "--no-native", "--no-models", "--out"])
            .arg(&out)
            .current_dir(root())
            .env(MARK, &mark)
            .env("CARGO", &cargo)
            .stdin(Stdio::null())
            .stdout(Stdio::null())
            .stderr(Stdio::null())
            .spawn()
            .expect("started");
        assert!(until(|| marked(&mark).iter().any(|line| line.contains("sleep 600"))), "cargo was started");
        kill(&mut child, signal);
        assert!(until(|| marked(&mark).is_empty()), "{signal}: left behind: {:?}", marked(&mark));
        is_not_green(&out, signal);
    }
}
