//! `oracle line` on the command line: its exit codes, its messages, its JSON, the configurations that it writes.

use std::fs;
use std::io::Write as _;
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
    assert_eq!(text(&output.stdout), "line/examples/line.toml: no broken rule; 51 checks met\n");
    assert!(output.stderr.is_empty());
    let readme = fs::read_to_string(root().join("line/README.md")).expect("there");
    assert!(readme.contains(text(&output.stdout)));
}

#[test]
fn a_line_without_stations_is_told_what_is_not_held_against_it() {
    let output = check(&root(), &["evidence/examples/my-line.toml", "--derived"]);
    assert_eq!(output.status.code(), Some(0), "{}", text(&output.stderr));
    let said = text(&output.stdout);
    assert!(said.starts_with("evidence/examples/my-line.toml: no broken rule; 15 checks met\n"), "{said}");
    assert!(said.contains("not applicable, as the line names no station: station,"), "{said}");
    assert!(said.contains("Longest interruption without a needless stop: 700 ms (70 cycles)"), "{said}");
}

#[test]
fn a_rule_between_line_and_station_is_told_with_both_places() {
    let folder = changed("life_ms = 3300", "life_ms = 3320");
    let output = check(folder.path(), &["line.toml"]);
    assert_eq!(output.status.code(), Some(1));
    assert!(
        text(&output.stdout).starts_with("line.toml: 1 broken rule; 49 checks met, 1 not made, as a rule is broken\n"),
        "{}",
        text(&output.stdout)
    );
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

fn configs(folder: &Path, to: &str) -> Output {
    let mut command = Command::new(device::oracle());
    command.args(["line", "configs", "line.toml", "-o", to]).current_dir(folder).stdin(Stdio::null());
    command.output().expect("the oracle runs")
}

/// The replies of the oracle to these lines.
fn serve(lines: &[String]) -> Vec<serde_json::Value> {
    let mut serving = Command::new(device::oracle());
    serving.arg("serve").stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::null());
    let mut serving = serving.spawn().expect("the oracle runs");
    serving.stdin.take().expect("open").write_all(lines.join("\n").as_bytes()).expect("written");
    let output = serving.wait_with_output().expect("it ends");
    text(&output.stdout).lines().map(|line| serde_json::from_str(line).expect("JSON")).collect()
}

/// Each device of the example has a file, and its machine starts with it.
#[test]
fn each_device_of_a_line_starts_with_its_configuration() {
    // A calibration, so that trains measure their position, too; and the layout's code of 65 km/h is told as one of 55.
    let levels =
        |slope: f64| (0..17).map(|knot| format!("{:.1}", f64::from(knot) * slope)).collect::<Vec<_>>().join(", ");
    let position = format!(
        "[position]\nspacing_m = 25.6\nlowest_db = [{}]\nhighest_db = [{}]\ntolerance_db = 0.1\nfloor_db = -60\n\n[detection]",
        levels(1.0),
        levels(2.0)
    );
    let folder = changed("[detection]", &position);
    let path = folder.path().join("line.toml");
    let line = fs::read_to_string(&path).expect("there");
    let told = "file = \"westham.toml\"\ncode_speeds_km_h = [15, 25, 45, 55, 55, 75, 90]";
    fs::write(&path, line.replacen("file = \"westham.toml\"", told, 1)).expect("written");
    let output = configs(folder.path(), "made/configs");
    assert_eq!(output.status.code(), Some(0), "{}", text(&output.stderr));
    let names: Vec<_> = text(&output.stdout).lines().collect();
    let stems: Vec<_> = names.iter().filter_map(|name| Path::new(name).file_stem()?.to_str()).collect();
    assert_eq!(
        stems,
        [
            "aspect-acceptance",
            "speed-supervision",
            "block-count-1",
            "block-count-2",
            "braking-pattern",
            "permitted-speed",
            "train-position",
            "train",
            "interlocking-1-Westham",
            "interlocking-2-Eastham",
            "wayside-1-Westham",
            "wayside-2-Eastham",
        ]
    );
    assert_eq!(fs::read_dir(folder.path().join("made/configs")).expect("made").count(), stems.len());
    let read = |name: &str| -> serde_json::Value {
        let file = fs::read_to_string(folder.path().join(format!("made/configs/{name}.json"))).expect("there");
        serde_json::from_str(&file).expect("JSON")
    };
    for stem in &stems {
        let machine = stem.split('-').take_while(|part| !part.starts_with(char::is_numeric));
        let machine = machine.collect::<Vec<_>>().join("-");
        let start = serde_json::json!({"start": {"protocol": 1, "machine": machine, "config": read(stem)}});
        let replies = serve(&[start.to_string()]);
        assert!(replies[0].get("started").is_some(), "{stem}: {}", replies[0]);
    }
    // Nothing of another line is left beside it.
    let again = configs(folder.path(), "made/configs");
    assert_eq!(again.status.code(), Some(1));
    assert!(text(&again.stderr).contains("made/configs cannot be written: it is there and not empty"), "{again:?}");
    // What stands in several places of the file, or in another file, comes together.
    let device = read("wayside-1-Westham");
    assert_eq!(device["life_ms"], 6000, "the layout's telegram age");
    assert_eq!(device["signals"]["circuits"]["E2"]["left"]["section"], 15);
    assert_eq!(device["signals"]["circuits"]["E2"]["left"]["gradient_permille"], -12);
    assert_eq!(device["signals"]["code_speeds_km_h"], serde_json::json!([15, 25, 45, 55, 55, 75, 90]));
    let train = read("train");
    assert_eq!(train["acceptance"]["shortened_operate_ms"], 100);
    assert_eq!(train["permitted"], read("permitted-speed"));
    assert_eq!(train["position"], read("train-position"));
    let pair = serde_json::json!({"main_hz": 41.5, "sub_hz": 38.5, "speed_km_h": 90});
    assert!(
        train["codes"]["pairs"].as_array().expect("pairs").contains(&pair)
            && train["codes"] == device["signals"]["codes"]
    );
    assert_eq!(read("block-count-2")["sections"], 2);
}

/// A circuit over which trains run in one direction has a number for that one, and a transmitter sends to both.
#[test]
fn a_device_that_does_not_start_is_a_broken_rule() {
    let folder = changed(
        "{ station = \"Westham\", circuit = \"P1T\", left = 5, right = 6 }",
        "{ station = \"Westham\", circuit = \"P1T\", right = 6 }",
    );
    let path = folder.path().join("westham.toml");
    let layout = fs::read_to_string(&path).expect("there");
    let (head, routes) = layout.split_once("[[route]]").expect("routes");
    let routes: Vec<_> = routes
        .split("[[route]]")
        .filter(|route| ["W-1", "W-2", "1-E", "2-E"].iter().any(|name| route.contains(&format!("name = \"{name}\""))))
        .collect();
    assert_eq!(routes.len(), 4);
    fs::write(&path, format!("{head}[[route]]{}", routes.join("[[route]]"))).expect("written");
    for output in [check(folder.path(), &["line.toml"]), configs(folder.path(), "made")] {
        assert_eq!(output.status.code(), Some(1), "{}", text(&output.stdout));
        let said = text(&output.stderr);
        assert!(said.contains("the device wayside-1-Westham does not start: "), "{said}");
        assert!(said.contains("circuit P1T of Westham has no number to the left"), "{said}");
        assert_eq!(said.lines().count(), 1, "{said}");
    }
    assert!(!folder.path().join("made").exists(), "nothing is written where a rule is broken");
}
