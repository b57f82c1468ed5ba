//! `oracle line check` on the command line: its exit codes, its messages, its JSON.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};

use atc_tests::device;

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).ancestors().nth(2).expect("in the checkout").to_path_buf()
}

fn check(folder: &Path, arguments: &[&str]) -> Output {
    let mut command = Command::new(device::oracle());
    command.args(["line", "check"]).args(arguments).current_dir(folder).stdin(Stdio::null());
    command.output().expect("the oracle runs")
}

fn text(bytes: &[u8]) -> &str {
    std::str::from_utf8(bytes).expect("UTF-8")
}

/// The example in a folder of its own, with one change in the line's file.
fn changed(from: &str, to: &str) -> tempfile::TempDir {
    let folder = tempfile::tempdir().expect("a folder");
    for name in ["line.toml", "westham.toml", "eastham.toml"] {
        let text = fs::read_to_string(root().join("line/examples").join(name)).expect("there");
        assert!(name != "line.toml" || text.contains(from), "{from}");
        let text = if name == "line.toml" { text.replacen(from, to, 1) } else { text };
        fs::write(folder.path().join(name), text).expect("written");
    }
    folder
}

/// The reply that `line/README.md` shows.
#[test]
fn the_example_breaks_no_rule() {
    let output = check(&root(), &["line/examples/line.toml"]);
    assert_eq!(output.status.code(), Some(0), "{}", text(&output.stderr));
    assert_eq!(text(&output.stdout), "line/examples/line.toml: no broken rule; 48 checks met\n");
    assert!(output.stderr.is_empty());
    let readme = fs::read_to_string(root().join("line/README.md")).expect("there");
    assert!(readme.contains(text(&output.stdout)));
}

#[test]
fn a_line_without_stations_is_told_what_is_not_held_against_it() {
    let output = check(&root(), &["evidence/examples/my-line.toml", "--derived"]);
    assert_eq!(output.status.code(), Some(0), "{}", text(&output.stderr));
    let said = text(&output.stdout);
    assert!(said.starts_with("evidence/examples/my-line.toml: no broken rule; 14 checks met\n"), "{said}");
    assert!(said.contains("not applicable, as the line names no station: station,"), "{said}");
    assert!(said.contains("Longest interruption without a needless stop: 700 ms (70 cycles)"), "{said}");
}

#[test]
fn a_rule_between_line_and_station_is_told_with_both_places() {
    let folder = changed("life_ms = 3300", "life_ms = 3320");
    let output = check(folder.path(), &["line.toml"]);
    assert_eq!(output.status.code(), Some(1));
    assert!(text(&output.stdout).starts_with("line.toml: 1 broken rule; 47 checks met\n"), "{}", text(&output.stdout));
    let lines: Vec<_> = text(&output.stderr).lines().collect();
    assert_eq!(lines.len(), 2, "{lines:?}");
    assert!(
        lines[0].starts_with("westham.toml:8:19: Westham: ") && lines[0].ends_with("[telegram-lives]"),
        "{lines:?}"
    );
    assert!(lines[0].contains("(against line.toml:"), "{lines:?}");

    let output = check(folder.path(), &["line.toml", "--json"]);
    assert_eq!(output.status.code(), Some(1));
    let told: serde_json::Value = serde_json::from_slice(&output.stdout).expect("JSON");
    assert_eq!((&told["line"], &told["sound"]), (&serde_json::json!("Ham line"), &serde_json::json!(false)));
    let checks = told["checks"].as_array().expect("a list");
    let broken: Vec<_> = checks.iter().filter(|check| check["outcome"]["is"] == "broken").collect();
    assert_eq!((broken.len(), &broken[0]["rule"]), (1, &serde_json::json!("telegram-lives")));
    assert_eq!(broken[0]["outcome"]["why"].as_array().map(Vec::len), Some(2));
}

#[test]
fn a_rule_of_the_kernel_is_1_and_what_cannot_be_read_is_2() {
    for (from, to, code, rule) in [
        ("shortened_operate_ms = 100", "shortened_operate_ms = 300", 1, "TIME-2"),
        ("cycle_ms = 10", "cycle = 10", 2, "form"),
        ("file = \"westham.toml\"", "file = \"nowhere.toml\"", 2, "form"),
    ] {
        let folder = changed(from, to);
        let output = check(folder.path(), &["line.toml", "--json"]);
        assert_eq!(output.status.code(), Some(code), "{to}");
        let told: serde_json::Value = serde_json::from_slice(&output.stdout).expect("JSON");
        assert_eq!((&told["line"], &told["sound"]), (&serde_json::Value::Null, &serde_json::json!(false)));
        assert_eq!(told["problems"][0]["rule"], rule, "{told}");
        assert!(text(&output.stderr).starts_with("line.toml:"), "{}", text(&output.stderr));
    }
    let output = check(&root(), &["nowhere.toml"]);
    assert_eq!(output.status.code(), Some(2));
    assert!(text(&output.stderr).starts_with("nowhere.toml: cannot be read: "), "{}", text(&output.stderr));
}
