//! `oracle simulate` on the command line: the real process, its exit codes, messages and files.

use std::fs;
use std::path::Path;
use std::process::{Command, Output, Stdio};

use atc_tests::device;
use serde_json::Value;

const EXAMPLES: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../simulation/examples");

fn simulate(folder: &Path, arguments: &[&str]) -> Output {
    let mut command = Command::new(device::oracle());
    command.arg("simulate").args(arguments).current_dir(folder).stdin(Stdio::null());
    command.output().expect("the oracle runs")
}

fn text(bytes: &[u8]) -> String {
    String::from_utf8(bytes.to_vec()).expect("UTF-8")
}

fn example(name: &str) -> String {
    format!("{EXAMPLES}/{name}")
}

#[test]
fn a_run_writes_events_and_pictures() {
    let folder = tempfile::tempdir().expect("a folder");
    let line = example("three-stations.toml");
    let output = simulate(folder.path(), &[&line, "--time", "400", "-o", "out"]);
    assert!(output.status.success(), "{}", text(&output.stderr));
    assert!(text(&output.stderr).contains("Three stations: 3 stations, 24 circuits, 4 trains; 400 s in"));
    let events = fs::read_to_string(folder.path().join("out/events.jsonl")).expect("events");
    let arrived = |line: &&str| serde_json::from_str::<Value>(line).expect("JSON")["event"] == "arrived";
    assert!(events.lines().filter(arrived).count() >= 2, "{events}");
    for picture in ["diagram.svg", "profile.svg"] {
        let svg = fs::read_to_string(folder.path().join("out").join(picture)).expect(picture);
        assert!(svg.contains("<svg") && svg.trim_end().ends_with("</svg>"), "{picture}");
    }
    // The same without a folder, on standard output.
    let output = simulate(folder.path(), &[&line, "--time", "400"]);
    assert_eq!(text(&output.stdout), events);
}

#[test]
fn harm_is_exit_code_1() {
    let folder = tempfile::tempdir().expect("a folder");
    let line = example("four-tracks.toml");
    let faults = ["--faults", "misread-code,misread-code,misread-code"];
    let beyond = [[line.as_str(), "--time", "500", "--beyond"].as_slice(), &faults].concat();
    let output = simulate(folder.path(), &beyond);
    assert_eq!(output.status.code(), Some(1));
    assert!(text(&output.stderr).contains("UNSAFE: {"), "{}", text(&output.stderr));
    let last = text(&output.stdout);
    // A train that misreads its code is too fast before it runs beyond its stop point.
    assert!(last.lines().last().expect("an event").contains("\"overspeed\""), "{last}");
    // The same faults, as short as they may be.
    let output = simulate(folder.path(), &[[line.as_str(), "--time", "500"].as_slice(), &faults].concat());
    assert!(output.status.success(), "{}", text(&output.stderr));
}

/// An unsafe run of a campaign, with wrong parts and several kinds of faults, can be looked at again by its seed.
#[test]
fn wrong_parts_and_pairs_are_seen_and_found_again() {
    let folder = tempfile::tempdir().expect("a folder");
    let line = example("three-stations.toml");
    let wrong = ["--signal", "telegrams", "--drivers", "heedless", "--defects", "codes-too-high,pattern-too-high"];
    let both = [&[line.as_str(), "--campaign", "1", "--time", "400", "--faults", "late-point"], &wrong[..]].concat();
    let output = simulate(folder.path(), &both);
    let (code, told) = (output.status.code(), text(&output.stdout));
    assert_eq!(code, Some(1), "{told}");
    let row = told.lines().nth(1).expect("a row");
    assert!(row.starts_with("codes-too-high + pattern-too-high + late-point       1       1"), "{row}");
    let (_, event) = row.split_once("seed 1: ").expect("the first unsafe run");
    let again = [&[line.as_str(), "--each", "1", "--time", "400", "--faults", "late-point"], &wrong[..]].concat();
    let output = simulate(folder.path(), &again);
    assert_eq!((output.status.code(), text(&output.stdout).lines().last()), (Some(1), Some(event)));
    // The 171 causes of two things, one after the other: the first of them.
    let pairs = simulate(folder.path(), &[&line, "--campaign", "2", "--pairs", "--time", "100"]);
    let told = text(&pairs.stdout);
    assert!(told.lines().any(|row| row.starts_with("interruption + misread-code")), "{told}");
}

#[test]
fn what_is_rare_is_estimated() {
    let folder = tempfile::tempdir().expect("a folder");
    let line = example("three-stations.toml");
    let rare =
        [line.as_str(), "--rare", "3000", "--faults", "shunt-loss", "--time", "70", "--effort", "4", "-o", "out"];
    let output = simulate(folder.path(), &rare);
    assert!(output.status.success(), "{}", text(&output.stderr));
    let told = text(&output.stdout);
    assert!(told.contains("harm in a run of 70 s: ") && told.contains("of 10 splittings"), "{told}");
    let json = fs::read_to_string(folder.path().join("out/splitting.json")).expect("a file");
    let found = serde_json::from_str::<Value>(&json).expect("JSON")["found"].as_array().map(Vec::len);
    assert_eq!(found, Some(10));
    for (arguments, code, says) in [
        (&["--rare", "0", "--faults", "shunt-loss"][..], 1, "--rare 0: a number of faults in an hour, above 0"),
        (&["--rare", "5", "--faults", "shunt-loss", "--time", "60"], 1, "--time 60: nothing moves for about a minute"),
        (&["--rare", "5"], 2, "--faults"),
        (&["--pairs"], 2, "--campaign"),
        (&["--defects", "brakes"], 2, "there is no such wrong part; there are clears-at-once"),
    ] {
        let output = simulate(folder.path(), &[&[line.as_str()], arguments].concat());
        let told = text(&output.stderr);
        assert!(output.status.code() == Some(code) && told.contains(says), "{arguments:?}: {told}");
    }
}

#[test]
fn a_campaign_tells_what_became_of_each_fault() {
    let folder = tempfile::tempdir().expect("a folder");
    let line = example("three-stations.toml");
    let arguments =
        [line.as_str(), "--campaign", "4", "--time", "200", "--faults", "interruption,late-point", "-o", "out"];
    let output = simulate(folder.path(), &arguments);
    assert!(output.status.success(), "{}", text(&output.stderr));
    let rows: Vec<Vec<String>> =
        text(&output.stdout).lines().map(|row| row.split_whitespace().map(str::to_owned).collect()).collect();
    assert_eq!(
        (&rows[1][..3], &rows[2][..3]),
        (&["interruption", "2", "0"].map(str::to_owned)[..], &["late-point", "2", "0"].map(str::to_owned)[..])
    );
    let json = fs::read_to_string(folder.path().join("out/campaign.json")).expect("a file");
    assert_eq!(serde_json::from_str::<Value>(&json).expect("JSON")["late-point"]["runs"], 2);
}

#[test]
fn what_cannot_be_run_is_said_and_nothing_is_written() {
    let folder = tempfile::tempdir().expect("a folder");
    let line = example("three-stations.toml");
    let line = line.as_str();
    for (arguments, code, says) in [
        (vec!["none.toml"], 1, "none.toml: cannot be read"),
        (vec![line, "--trains", "6"], 1, "6 trains: 1 to 5 are possible"),
        (vec![line, "--profile", "4"], 1, "--profile 4: the trains are 0 to 3"),
        (vec![line, "--campaign", "1", "--time", "60"], 1, "more than 60 s"),
        (vec![line, "--faults", "rain"], 2, "there is no such fault"),
        (vec![line, "--faults", "missed-head"], 1, "missed-head needs a line with [[counted]] blocks"),
        (vec![], 2, "LINE.toml"),
    ] {
        let arguments: Vec<&str> = [arguments.as_slice(), &["-o", "out"]].concat();
        let output = simulate(folder.path(), &arguments);
        assert_eq!(output.status.code(), Some(code), "{arguments:?}");
        assert!(text(&output.stderr).contains(says), "{says:?} is not in {}", text(&output.stderr));
        assert!(!folder.path().join("out").exists());
    }
}

/// What cannot be drawn or counted is refused, with what would be right.
#[test]
fn numbers_that_cannot_be() {
    let folder = tempfile::tempdir().expect("a folder");
    let line = example("three-stations.toml");
    let cases: [(&[&str], &str); 5] = [
        (&["--time", "0", "--faults", "shunt-loss"], "--time 0: a fault needs a time to begin; give 1 or more"),
        (
            &["--time", "60", "--faults", "shunt-loss", "--each", "1"],
            "faults begin after the first minute; a run needs more than 60 s",
        ),
        (&["--faults", "shunt-loss", "--each", "0"], "--each 0: give 1 or more"),
        (&["--campaign", "0"], "--campaign 0: give 1 run or more"),
        (&["--trains", "0"], "0 trains: 1 to"),
    ];
    for (arguments, said) in cases {
        let output = simulate(folder.path(), &[&[line.as_str()], arguments].concat());
        assert_eq!(output.status.code(), Some(1), "{arguments:?}: {}", text(&output.stderr));
        assert!(text(&output.stderr).contains(said), "{arguments:?}: {}", text(&output.stderr));
    }
}
