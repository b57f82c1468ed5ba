//! `oracle conform` and `oracle vectors` on the command line: exit codes, files, messages.

use std::fs;
use std::path::Path;
use std::process::{Command, Output, Stdio};

use atc_tests::device;

fn oracle(folder: &Path, arguments: &[&str]) -> Output {
    let output = Command::new(device::oracle()).args(arguments).current_dir(folder).stdin(Stdio::null()).output();
    output.expect("the oracle runs")
}

fn text(bytes: &[u8]) -> String {
    String::from_utf8(bytes.to_vec()).expect("UTF-8")
}

fn faulty(name: &str) -> String {
    format!("{} {name}", env!("CARGO_BIN_EXE_faulty"))
}

fn names(folder: &Path) -> Vec<String> {
    let entries = fs::read_dir(folder).expect("a folder");
    let mut names: Vec<_> =
        entries.map(|entry| entry.expect("an entry").file_name().to_string_lossy().into()).collect();
    names.sort();
    names
}

/// A difference: exit code 1, a folder with everything, and the traces go through the oracle again.
#[test]
fn a_difference_fills_the_folder() {
    let folder = tempfile::tempdir().expect("a folder");
    let (broken, whole) = (faulty("hold-ahead-ignored"), faulty("none"));
    let common =
        ["--machine", "block-count", "--cases", "60", "--report", "out", "--junit", "j.xml", "--json", "j.json"];
    let run = |command: &str| {
        let arguments = [&["conform", "--impl", command][..], &common[..]].concat();
        oracle(folder.path(), &arguments)
    };
    let differs = run(&broken);
    assert_eq!(differs.status.code(), Some(1), "{}", text(&differs.stderr));
    let said = text(&differs.stdout);
    assert!(said.contains("BLK-5") && said.contains("DANGEROUS") && said.contains("DIFFERS: 0 of 1"), "{said}");
    let out = folder.path().join("out");
    let files = [
        "badge.svg",
        "history.jsonl",
        "index.html",
        "junit.xml",
        "kernel-block-count.jsonl",
        "other-block-count.jsonl",
        "report.json",
        "trace-block-count.jsonl",
        "vector-block-count.jsonl",
    ];
    assert_eq!(names(&out), files);
    assert_eq!(fs::read(folder.path().join("j.json")).expect("JSON"), fs::read(out.join("report.json")).expect("JSON"));
    // The kernel's own session is one, and the other is drawn in red.
    let drawn = oracle(&out, &["chart", "kernel-block-count.jsonl", "-o", "k.svg"]);
    assert!(drawn.status.success(), "{}", text(&drawn.stderr));
    let drawn = oracle(&out, &["chart", "--as-recorded", "other-block-count.jsonl", "-o", "o.svg"]);
    assert_eq!(drawn.status.code(), Some(1), "{}", text(&drawn.stderr));
    let replies =
        device::converse(device::oracle(), fs::read(out.join(files[7])).expect("a trace")).expect("a session");
    assert!(replies.iter().all(|reply| !reply.contains("malformed")), "{replies:?}");
    // Agreement: exit code 0, the old trace is gone, and the page knows of the run before.
    let agrees = run(&whole);
    assert_eq!(agrees.status.code(), Some(0), "{}{}", text(&agrees.stdout), text(&agrees.stderr));
    assert!(!out.join("trace-block-count.jsonl").exists());
    let page = fs::read_to_string(out.join("index.html")).expect("a page");
    assert!(page.contains("Runs before this one") && page.contains("Nothing differs"));
    assert_eq!(fs::read_to_string(out.join("history.jsonl")).expect("a history").lines().count(), 2);
}

/// What is wrong with the arguments or the files of the caller is exit code 2, with a sentence, before anything is run.
#[test]
fn wrong_arguments_are_told() {
    let folder = tempfile::tempdir().expect("a folder");
    let write = |name: &str, text: &str| fs::write(folder.path().join(name), text).expect("a file");
    write("profile.toml", "[[known]]\nmachine = \"block-count\"\nfield = \"colour\"\nreason = \"red\"\n");
    write("config.json", r#"{"sections":0,"max_trains":1,"tail_hold_sections":0}"#);
    let cases: [(&[&str], &str); 8] = [
        (&["--machine", "block"], "there is no machine \"block\"; there are aspect-acceptance"),
        (&["--time", "0s"], "a time is a whole number above 0"),
        (&["--time", "soon"], "such as 60s"),
        (&["--profile", "no.toml"], "no.toml cannot be read"),
        (&["--profile", "profile.toml"], "block-count has no field \"colour\"; it has occupied"),
        (&["--config", "config.json"], "name it with --machine"),
        (
            &["--config", "config.json", "--machine", "block-count"],
            "config.json: block-count does not take it: sections is 0",
        ),
        (&["--vectors", "nowhere"], "nowhere: vectors.json: it cannot be read"),
    ];
    for (arguments, message) in cases {
        let output = oracle(folder.path(), &[&["conform", "--impl", "touch ran"], arguments].concat());
        let said = text(&output.stderr);
        assert_eq!(output.status.code(), Some(2), "{arguments:?}: {said}");
        assert!(said.contains(message), "{arguments:?} was answered by {said}");
    }
    assert_eq!(names(folder.path()), ["config.json", "profile.toml"], "something was run or written");
}

/// Nothing that is compared is no agreement.
#[test]
fn nothing_compared_is_no_agreement() {
    let folder = tempfile::tempdir().expect("a folder");
    let refuses = r#"while read l; do echo '{"rejected":{"reason":"no"}}'; done"#;
    let output = oracle(folder.path(), &["conform", "--impl", refuses, "--time", "4s"]);
    let said = text(&output.stdout);
    assert_eq!(output.status.code(), Some(1), "{said}");
    assert!(said.contains("NOTHING WAS COMPARED"), "{said}");
    // Named, it is a difference.
    let output = oracle(folder.path(), &["conform", "--impl", refuses, "--machine", "block-count", "--cases", "20"]);
    let said = text(&output.stdout);
    assert_eq!(output.status.code(), Some(1), "{said}");
    assert!(said.contains("start: expected \"started\", got \"rejected\""), "{said}");
    // No case at all is asked for: that is an error of the command.
    let output = oracle(folder.path(), &["conform", "--impl", refuses, "--cases", "0"]);
    assert_eq!(output.status.code(), Some(2), "{}", text(&output.stderr));
    assert!(text(&output.stderr).contains("0 is not in 1.."), "{}", text(&output.stderr));
}

#[test]
fn vectors_are_written_and_run() {
    let folder = tempfile::tempdir().expect("a folder");
    let machines = ["--machine", "speed-supervision", "--machine", "telegram-codec"];
    let write =
        |out: &str| oracle(folder.path(), &[&["vectors", "--set", "minimal", "--out", out][..], &machines].concat());
    let written = write("v");
    assert!(written.status.success(), "{}", text(&written.stderr));
    let (first, again) = (folder.path().join("v"), folder.path().join("w"));
    assert!(write("w").status.success());
    for name in names(&first) {
        assert_eq!(
            fs::read(first.join(&name)).expect("a file"),
            fs::read(again.join(&name)).expect("a file"),
            "{name}"
        );
    }
    let run = |command: &str| oracle(folder.path(), &["conform", "--impl", command, "--vectors", "v"]);
    let agrees = run(&faulty("none"));
    assert_eq!(agrees.status.code(), Some(0), "{}", text(&agrees.stdout));
    assert_eq!(run(&faulty("gap-is-a-zero")).status.code(), Some(1));
    // A folder of somebody else's is left alone.
    fs::create_dir(folder.path().join("mine")).expect("a folder");
    fs::write(folder.path().join("mine/letter.txt"), "dear").expect("a file");
    let refused = write("mine");
    assert_eq!(refused.status.code(), Some(2));
    assert!(text(&refused.stderr).contains("holds something else than vectors"), "{}", text(&refused.stderr));
    assert_eq!(names(&folder.path().join("mine")), ["letter.txt"]);
}
