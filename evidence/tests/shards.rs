//! A run in four shards and one without: the same case, but for times.

use std::path::{Path, PathBuf};
use std::process::{Command, Output};

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).parent().expect("in the checkout").to_path_buf()
}

fn safety_case(arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_safety-case")).args(arguments).current_dir(root()).output().expect("started")
}

fn text(output: &Output) -> String {
    format!("{}{}", String::from_utf8_lossy(&output.stdout), String::from_utf8_lossy(&output.stderr))
}

fn path(path: &Path) -> &str {
    path.to_str().expect("a path")
}

/// Natively and from records only: theorems are tested, the rest is not run or read.
fn run(out: &Path, more: &[&str]) -> Output {
    let log = out.with_file_name("tests.log");
    let tests = "     Running tests/charts.rs (target/debug/deps/charts-02)\n\
                 test result: ok. 4 passed; 0 failed; 0 ignored; 0 measured; 0 filtered out; finished in 0.00s\n";
    std::fs::write(&log, tests).expect("written");
    let fixed = [
        "run",
        "--jobs",
        "1",
        "--native-runs",
        "60",
        "--no-provers",
        "--no-models",
        "--no-measurements",
        "--test-results",
        path(&log),
    ];
    safety_case(&[&fixed[..], &["--out", path(out)], more].concat())
}

fn json(out: &Path) -> serde_json::Value {
    serde_json::from_str(&std::fs::read_to_string(out.join("case.json")).expect("written")).expect("JSON")
}

#[test]
fn four_shards_are_the_same_case_as_one_run() {
    let folder = tempfile::tempdir().expect("a folder");
    let at = |name: &str| folder.path().join(name);
    let (whole, joined) = (at("whole"), at("joined"));
    run(&whole, &[]);
    let names = ["1", "2", "3", "4"].map(|number| at(&format!("shard-{number}")));
    for (number, out) in (1..).zip(&names) {
        let ended = run(out, &["--shard", &format!("{number}/4")]);
        assert!(text(&ended).contains(&format!("This is shard {number}/4 of a run")), "{}", text(&ended));
        assert!(out.join("incomplete").exists(), "a shard is never whole");
        let page = std::fs::read_to_string(out.join("index.html")).expect("written");
        assert!(page.contains("banner red"));
    }
    let merge = |shards: &[&PathBuf]| {
        let folders: Vec<_> = shards.iter().map(|folder| path(folder)).collect();
        safety_case(&[&["merge"], &folders[..], &["--out", path(&joined)]].concat())
    };
    let all: Vec<_> = names.iter().collect();
    let merged = merge(&all);
    let same = safety_case(&["compare", path(&whole), path(&joined)]);
    assert_eq!(same.status.code(), Some(0), "{}\n{}", text(&merged), text(&same));
    assert_eq!(json(&joined)["run"]["joined"].as_array().map(Vec::len), Some(4));
    assert_eq!(json(&joined)["status"], json(&whole)["status"]);
    let tested = |case: &serde_json::Value| {
        case["evidence"].as_array().expect("a list").iter().filter(|one| one["verdict"] == "tested").count()
    };
    assert!(tested(&json(&joined)) > 100);

    // Without one of them: what belongs to it is not run, and nobody calls that the same.
    let merged = merge(&[&names[0], &names[1], &names[3]]);
    assert!(text(&merged).contains("shard 3/4: This shard is missing"), "{}", text(&merged));
    assert!(tested(&json(&joined)) < tested(&json(&whole)) && joined.join("incomplete").exists());
    let same = safety_case(&["compare", path(&whole), path(&joined)]);
    assert_eq!(same.status.code(), Some(1));
    assert!(text(&same).contains("NOT the same"), "{}", text(&same));

    // Of another commit: refused, and nothing is written.
    let file = names[1].join("results.json");
    let said = std::fs::read_to_string(&file).expect("written");
    let mut value: serde_json::Value = serde_json::from_str(&said).expect("JSON");
    value["results"]["provenance"]["folders"]["kernel"] = "00".into();
    std::fs::write(&file, value.to_string()).expect("written");
    std::fs::remove_dir_all(&joined).expect("removed");
    let refused = merge(&all);
    assert_eq!(refused.status.code(), Some(2));
    assert!(text(&refused).contains("shard-2: kernel is not what it is in"), "{}", text(&refused));
    assert!(!joined.exists());
    // No results at all.
    let none = safety_case(&["merge", path(folder.path()), "--out", path(&joined)]);
    assert_eq!(none.status.code(), Some(2));
    assert!(text(&none).contains("results.json: No such file"), "{}", text(&none));
}

#[test]
fn a_part_says_that_it_is_one_and_is_judged_by_itself() {
    let folder = tempfile::tempdir().expect("a folder");
    let out = folder.path().join("case");
    let ended = run(&out, &["--part", "duplex"]);
    assert_eq!(ended.status.code(), Some(0), "{}", text(&ended));
    assert!(out.join("incomplete").exists());
    let page = std::fs::read_to_string(out.join("index.html")).expect("written");
    let banner = page.split("banner red").nth(1).expect("red");
    assert!(
        banner.split("</div>").next().is_some_and(|text| text.contains("Only a part of the railway, duplex, was run."))
    );
    let case = json(&out);
    let evidence = case["evidence"].as_array().expect("a list");
    let of = |id: &str| evidence.iter().find(|one| one["id"] == id).unwrap_or_else(|| panic!("{id}"));
    assert_eq!(of("harness:t_acc_1")["reason"], "left out by --part duplex");
    assert_eq!((&of("harness:t_acc_1")["verdict"], &of("test:all")["verdict"]), (&"not-run".into(), &"not-run".into()));
    let mine = evidence.iter().filter(|one| one["left_out"] == false && one["kind"] == "harness");
    assert!(mine.clone().count() >= 3 && mine.clone().all(|one| one["verdict"] == "tested"));
    // What is required is required of the part: here nothing was proved, and only of it.
    let required = run(&out, &["--part", "duplex", "--require", "proved"]);
    assert_eq!(required.status.code(), Some(1));
    let reasons = json(&out)["status"]["reasons"].to_string();
    assert!(reasons.contains("not proved by the cbmc engine: harness:") && !reasons.contains("t_acc_1"), "{reasons}");
    let unknown = run(&out, &["--part", "points"]);
    assert_eq!(unknown.status.code(), Some(2));
    assert!(text(&unknown).contains("there is no such part; there are aspect, block"), "{}", text(&unknown));
    assert_eq!(run(&out, &["--part", "duplex", "--shard", "1/2"]).status.code(), Some(2));
    assert_eq!(run(&out, &["--shard", "3/2"]).status.code(), Some(2));
}

#[test]
fn the_times_are_told_and_progress_is_seen_without_a_terminal() {
    let folder = tempfile::tempdir().expect("a folder");
    let out = folder.path().join("case");
    let ended = run(&out, &["--part", "supervision"]);
    let errors = String::from_utf8_lossy(&ended.stderr).into_owned();
    assert!(errors.contains("native tests of theorems 0/") && errors.contains(" so far · about "), "{errors}");
    assert!(String::from_utf8_lossy(&ended.stdout).contains("where the time went"), "{}", text(&ended));
    let phases = json(&out)["run"]["phases"].clone();
    assert_eq!(phases[0]["name"], "native tests of theorems");
    assert!(phases[0]["items"].as_u64().is_some_and(|items| items >= 4), "{phases}");
    assert!(std::fs::read_to_string(out.join("index.html")).expect("written").contains("Where the time went"));
}
