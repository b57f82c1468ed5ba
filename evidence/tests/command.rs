//! The command as its users meet it: with real sources, and with results that are left out or wrong on purpose.

use std::path::{Path, PathBuf};
use std::process::{Command, Output};

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).parent().expect("in the checkout").to_path_buf()
}

fn safety_case(arguments: &[&str]) -> Output {
    let root = root();
    let mut command = Command::new(env!("CARGO_BIN_EXE_safety-case"));
    command.args(arguments).current_dir(root).output().expect("started")
}

fn text(output: &Output) -> String {
    format!("{}{}", String::from_utf8_lossy(&output.stdout), String::from_utf8_lossy(&output.stderr))
}

/// Runs nothing: everything is "not run".
fn bare(out: &Path, more: &[&str]) -> Output {
    let out = out.to_str().expect("a path");
    let without = ["--no-provers", "--no-native", "--no-models", "--no-tests"];
    let measured = if more.contains(&"--measurements") { &[][..] } else { &["--no-measurements"][..] };
    safety_case(&[&["run", "--out", out], &without[..], measured, more].concat())
}

fn json(out: &Path) -> serde_json::Value {
    serde_json::from_str(&std::fs::read_to_string(out.join("case.json")).expect("written")).expect("JSON")
}

#[test]
fn a_case_without_results_says_so_and_fits_its_schema() {
    let folder = tempfile::tempdir().expect("a folder");
    let out = folder.path().join("case");
    let run = bare(&out, &[]);
    assert_eq!(run.status.code(), Some(0), "{}", text(&run));
    assert!(out.join("incomplete").exists());
    assert!(text(&run).contains("Incomplete"), "{}", text(&run));
    let case = json(&out);
    let schema: serde_json::Value =
        serde_json::from_str(&std::fs::read_to_string(out.join("case.schema.json")).expect("written")).expect("JSON");
    let validator = jsonschema::validator_for(&schema).expect("a schema");
    assert_eq!(validator.iter_errors(&case).map(|error| error.to_string()).collect::<Vec<_>>(), Vec::<String>::new());
    let not_run = case["evidence"].as_array().expect("a list").iter().all(|one| one["verdict"] == "not-run");
    assert!(not_run);
    let page = std::fs::read_to_string(out.join("index.html")).expect("written");
    assert!(page.contains("has not been run") && !page.contains("is proved for all"));
    for file in [
        "gsn.yaml",
        "junit.xml",
        "case.sarif",
        "hazards.csv",
        "accidents.csv",
        "srac.csv",
        "traceability.csv",
        "SHA256SUMS",
    ] {
        assert!(out.join(file).exists(), "{file}");
    }
    // The same, but proofs are required.
    let required = bare(&out, &["--require", "proved"]);
    assert_eq!(required.status.code(), Some(1));
    assert!(text(&required).contains("not proved by the cbmc engine"));
    // It is not to be verified, as it is incomplete.
    let verified = safety_case(&["verify", out.to_str().expect("a path")]);
    assert_eq!(verified.status.code(), Some(1));
    assert!(text(&verified).contains("the case is incomplete"));
}

#[test]
fn a_measurement_without_figures_ends_the_run_badly() {
    let folder = tempfile::tempdir().expect("a folder");
    let (out, empty) = (folder.path().join("case"), folder.path().join("measured"));
    std::fs::create_dir(&empty).expect("a folder");
    let run = bare(&out, &["--measurements", empty.to_str().expect("a path")]);
    assert_eq!(run.status.code(), Some(1), "{}", text(&run));
    assert!(text(&run).contains("measured:ber-coherent is undecided"), "{}", text(&run));
    assert!(text(&run).contains("bench.json: No such file"), "{}", text(&run));
    let page = std::fs::read_to_string(out.join("index.html")).expect("written");
    assert!(page.contains("There are no figures."));
    let both = bare(&out, &["--measurements", "here", "--no-measurements"]);
    assert_eq!(both.status.code(), Some(2));
}

#[test]
fn a_station_has_a_case_of_its_own_and_a_broken_rule_ends_it_badly() {
    let folder = tempfile::tempdir().expect("a folder");
    let out = folder.path().join("case");
    let layout = root().join("layouts/passing-loop.toml");
    let run = bare(&out, &["--layout", layout.to_str().expect("a path")]);
    assert_eq!(run.status.code(), Some(0), "{}", text(&run));
    let page = std::fs::read_to_string(out.join("station.html")).expect("written");
    assert!(page.contains("Not to be signed: every rule is kept, but") && page.contains("<svg"));
    assert!(!page.contains("is proved for all") && !page.contains("To be confirmed and signed"), "nothing was run");
    for file in ["station/track-plan.svg", "station/control-table.html", "station/layout.toml"] {
        assert!(out.join(file).exists(), "{file}");
        assert!(std::fs::read_to_string(out.join("SHA256SUMS")).expect("written").contains(file), "{file}");
    }
    let schema: serde_json::Value =
        serde_json::from_str(&std::fs::read_to_string(out.join("case.schema.json")).expect("written")).expect("JSON");
    assert!(jsonschema::validator_for(&schema).expect("a schema").is_valid(&json(&out)));

    // A name with a space must not hide it.
    let bad = folder.path().join("a bad station.toml");
    let good = std::fs::read_to_string(&layout).expect("there");
    std::fs::write(&bad, format!("{good}\n[times]\nclear_ms = 1000\n")).expect("written");
    let run = bare(&out, &["--layout", bad.to_str().expect("a path")]);
    assert_eq!(run.status.code(), Some(1), "{}", text(&run));
    assert!(text(&run).contains("clear_ms must be at least 2000"), "{}", text(&run));
    let reasons = json(&out)["status"]["reasons"].to_string();
    assert_eq!(reasons.matches("[clear-under-shunt]").count(), 1, "{reasons}");
    assert_eq!(json(&out)["station"]["theorems"], serde_json::json!([]));
    let page = std::fs::read_to_string(out.join("station.html")).expect("written");
    assert!(page.contains("Not to be signed: the layout is refused") && page.contains("No theorem holds for it"));

    let missing = bare(&folder.path().join("other"), &["--layout", "nowhere.toml"]);
    assert_eq!(missing.status.code(), Some(2));
    assert!(text(&missing).contains("nowhere.toml: cannot be read"), "{}", text(&missing));
    assert!(!folder.path().join("other").exists(), "nothing half-written");
}

/// A new station costs no run: the case of one that was rendered for it is that of a run with it.
#[test]
fn a_case_is_rendered_for_a_station_as_it_is_run_for_it() {
    let folder = tempfile::tempdir().expect("a folder");
    let layout = root().join("layouts/junction.toml");
    let good = layout.to_str().expect("a path");
    let bad = folder.path().join("bad.toml");
    let text_of = std::fs::read_to_string(&layout).expect("there");
    std::fs::write(&bad, format!("{text_of}\n[times]\nclear_ms = 1000\n")).expect("written");
    let bad = bad.to_str().expect("a path");
    let (plain, run, at) = (folder.path().join("plain"), folder.path().join("run"), folder.path().join("at"));
    bare(&plain, &[]);
    let rendered = |from: &Path, layout: &str| {
        let (from, out) = (from.to_str().expect("a path"), at.to_str().expect("a path"));
        safety_case(&["render", "--from", from, "--layout", layout, "--out", out])
    };
    let same = || {
        let (one, other) = (json(&run), json(&at));
        for field in ["station", "open_items", "conclusions", "status"] {
            assert_eq!(one[field], other[field], "{field}");
        }
    };
    bare(&run, &["--layout", good]);
    assert_eq!(rendered(&plain, good).status.code(), Some(0));
    same();
    assert!(std::fs::read_to_string(at.join("station.html")).expect("written").contains("<svg"));
    let broken = bare(&run, &["--layout", bad]);
    assert_eq!(broken.status.code(), Some(1));
    assert_eq!(rendered(&plain, bad).status.code(), Some(1));
    same();
    // And back: what the former station broke is gone.
    bare(&run, &["--layout", good]);
    assert_eq!(rendered(&at.clone(), good).status.code(), Some(0));
    same();
    let missing = rendered(&plain, "nowhere.toml");
    assert_eq!(missing.status.code(), Some(2), "{}", text(&missing));
    let in_place = safety_case(&["render", "--from", plain.to_str().expect("a path"), "--layout", good]);
    assert_eq!(in_place.status.code(), Some(2), "a case is not turned into a station's in place");
    let plain = plain.to_str().expect("a path");
    let in_place = safety_case(&["render", "--from", plain, "--layout", good, "--out", plain]);
    assert_eq!(in_place.status.code(), Some(2));
    assert!(text(&in_place).contains("name another folder") && !Path::new(plain).join("station.html").exists());
}

/// The lines from where a result of `case.sarif` says that something stands, or nothing without a place.
fn lines(result: &serde_json::Value) -> Option<Vec<String>> {
    let place = &result["locations"][0]["physicalLocation"];
    let file = place["artifactLocation"]["uri"].as_str()?;
    assert_eq!(place["artifactLocation"]["uriBaseId"], "SRCROOT");
    let number = usize::try_from(place["region"]["startLine"].as_u64().expect("a line")).expect("small");
    let text = std::fs::read_to_string(root().join(file)).expect("relative to the checkout");
    Some(text.lines().skip(number - 1).map(ToOwned::to_owned).collect())
}

#[test]
fn the_sarif_names_all_evidence_that_was_not_run_and_where_it_stands() {
    let folder = tempfile::tempdir().expect("a folder");
    let out = folder.path().join("case");
    bare(&out, &[]);
    let written = std::fs::read_to_string(out.join("case.sarif")).expect("written");
    let sarif: serde_json::Value = serde_json::from_str(&written).expect("JSON");
    let schema = serde_json::from_str(include_str!("sarif.schema.json")).expect("JSON");
    let validator = jsonschema::validator_for(&schema).expect("a schema");
    assert_eq!(validator.iter_errors(&sarif).map(|error| error.to_string()).collect::<Vec<_>>(), Vec::<String>::new());
    assert_eq!(sarif["runs"][0]["invocations"][0]["executionSuccessful"], false);

    let mutants = std::fs::read_to_string(root().join("proofs/mutants.toml")).expect("there");
    let mutants: toml::Table = toml::from_str(&mutants).expect("TOML");
    let results = sarif["runs"][0]["results"].as_array().expect("a list");
    for one in json(&out)["evidence"].as_array().expect("a list") {
        let mine = |result: &&serde_json::Value| result["partialFingerprints"]["evidenceId/v1"] == one["id"];
        let [result] = results.iter().filter(mine).collect::<Vec<_>>()[..] else { panic!("one result: {}", one["id"]) };
        assert_eq!((&result["ruleId"], &result["level"]), (&"not-run".into(), &"warning".into()));
        let id = one["id"].as_str().expect("an id");
        if let Some(name) = id.strip_prefix("harness:") {
            // The statement stands between the beginning of a harness and its name.
            let lines = lines(result).expect("a place");
            assert_eq!(lines[0], "harness! {", "{id}");
            let first = lines[1..].iter().map(|line| line.trim()).find(|line| !line.starts_with("///"));
            assert_eq!(first, Some(format!("{name}(e)").as_str()));
        } else if let Some(name) = id.strip_prefix("mutant:") {
            let all = mutants["mutant"].as_array().expect("a list");
            let mutant = all.iter().find(|one| one["name"].as_str() == Some(name)).expect("there");
            let find = mutant["find"].as_str().and_then(|text| text.lines().next()).expect("a text");
            assert!(lines(result).expect("a place")[0].contains(find), "{id}");
        }
    }
    // The open items have a result each, but those that only group the evidence.
    let items = results.iter().filter(|result| result["partialFingerprints"]["openItem/v1"].is_string()).count();
    let case = json(&out);
    let open = case["open_items"].as_array().expect("a list").iter();
    let more = open.filter(|one| !one["text"].as_str().expect("a text").starts_with("not-run: ")).count();
    assert!(more > 0 && items == more, "{items} of {more}");
}

#[test]
fn the_committed_schema_is_the_types() {
    let committed = std::fs::read_to_string(root().join("evidence/case.schema.json")).expect("committed");
    assert!(
        committed == String::from_utf8_lossy(&safety_case(&["schema"]).stdout),
        "run: safety-case schema > evidence/case.schema.json"
    );
}

#[test]
fn a_bad_line_is_refused_and_nothing_is_written() {
    let folder = tempfile::tempdir().expect("a folder");
    let (out, config) = (folder.path().join("case"), folder.path().join("bad.toml"));
    let example = std::fs::read_to_string(root().join("evidence/examples/my-line.toml")).expect("there");
    std::fs::write(&config, example.replace("shortened_operate_ms = 100", "shortened_operate_ms = 300"))
        .expect("written");
    let run = bare(&out, &["--config", config.to_str().expect("a path")]);
    assert_eq!(run.status.code(), Some(2));
    assert!(text(&run).contains("bad.toml:18:24: rule TIME-2 is broken: shortened_operate_ms (T5)"), "{}", text(&run));
    assert!(!out.exists());
}

/// A station that counts on less than its trains do ends the run badly, with both places on the page.
#[test]
fn a_line_with_stations_is_held_against_them() {
    let folder = tempfile::tempdir().expect("a folder");
    let examples = root().join("line/examples");
    for name in ["line.toml", "westham.toml", "eastham.toml"] {
        std::fs::copy(examples.join(name), folder.path().join(name)).expect("copied");
    }
    let (out, config) = (folder.path().join("case"), folder.path().join("line.toml"));
    let config = config.to_str().expect("a path");
    let run = bare(&out, &["--config", config]);
    assert_eq!(run.status.code(), Some(0), "{}", text(&run));
    let outcomes = |out: &Path| {
        let checks = json(out)["line"]["checks"].as_array().expect("a list").clone();
        checks.iter().filter(|check| check["outcome"]["is"] == "broken").cloned().collect::<Vec<_>>()
    };
    assert!(outcomes(&out).is_empty());

    let text_of = std::fs::read_to_string(config).expect("there");
    assert_eq!(text_of.matches("life_ms = 3300").count(), 1, "the example's life of a telegram");
    std::fs::write(config, text_of.replace("life_ms = 3300", "life_ms = 3320")).expect("written");
    let run = bare(&out, &["--config", config]);
    assert_eq!(run.status.code(), Some(1), "{}", text(&run));
    let found = outcomes(&out);
    assert_eq!((found.len(), &found[0]["rule"]), (1, &serde_json::json!("telegram-lives")), "{found:?}");
    let finding = &found[0]["outcome"]["why"][0];
    let place = |field: &str| finding[field].as_str().expect("a place").to_owned();
    assert!(place("at").ends_with("westham.toml:8:19") && place("against").contains("line.toml:"), "{finding}");
    let page = std::fs::read_to_string(out.join("index.html")).expect("written");
    assert!(page.contains(&place("at")) && page.contains(&place("against")));
    let reasons = json(&out)["status"]["reasons"].to_string();
    assert_eq!(reasons.matches("[telegram-lives]").count(), 2, "one for each station: {reasons}");
}

#[test]
fn a_folder_with_other_files_is_left_alone() {
    let folder = tempfile::tempdir().expect("a folder");
    std::fs::write(folder.path().join("thesis.txt"), "years of work").expect("written");
    let run = bare(folder.path(), &[]);
    assert_eq!(run.status.code(), Some(2), "{}", text(&run));
    assert!(folder.path().join("thesis.txt").exists());
}

#[test]
fn an_import_of_other_sources_is_stale_and_one_of_no_engine_is_refused() {
    let folder = tempfile::tempdir().expect("a folder");
    let (out, file) = (folder.path().join("case"), folder.path().join("kani.json"));
    let campaign = |engine: &str| {
        serde_json::json!({
            "schema": atc_prover::report::SCHEMA,
            "engine": engine,
            "provenance": {
                "commit": null, "dirty": null, "cargo_lock_sha256": "", "sources_sha256": "0000", "tools": {},
                "flags": [], "aspects": 4, "started_unix": 0, "seconds": 1.0
            },
            "harnesses": [{
                "name": "sup_3", "theorem": "SUP-3", "statement": "", "requirements": [], "assumptions": [],
                "bound": "", "engine": engine, "verdict": "proved", "reason": null, "seconds": 1.0, "solver": "",
                "claims": [], "covers": [], "counterexample": null
            }]
        })
        .to_string()
    };
    std::fs::write(&file, campaign("kani")).expect("written");
    let run = bare(&out, &["--import", file.to_str().expect("a path")]);
    let case = json(&out);
    let verdict = case["evidence"].as_array().expect("a list").iter().find(|one| one["id"] == "harness:sup_3");
    // No claim of its own, so no result at all; and were it one, it would be stale.
    assert_eq!(verdict.expect("there")["verdict"], "undecided", "{}", text(&run));
    assert_eq!(run.status.code(), Some(1));
    std::fs::write(&file, campaign("oracle of Delphi")).expect("written");
    let refused = bare(&out, &["--import", file.to_str().expect("a path")]);
    assert_eq!(refused.status.code(), Some(2));
    assert!(text(&refused).contains("the engine \"oracle of Delphi\" is not known"));
}

#[test]
fn outcomes_of_models_are_taken_from_a_file_and_wrong_ones_are_refused() {
    let folder = tempfile::tempdir().expect("a folder");
    let (out, file) = (folder.path().join("case"), folder.path().join("outcomes.json"));
    let entry = atc_models::catalogue().into_iter().find(|entry| entry.name == "change-heard").expect("there");
    let found = serde_json::to_value(atc_models::check(&entry, 1)).expect("JSON");
    let given = |commit: &serde_json::Value, outcomes: serde_json::Value| {
        let text = serde_json::json!({"commit": commit, "outcomes": outcomes}).to_string();
        std::fs::write(&file, text).expect("written");
        // On a clean checkout without provers what an earlier run has found would stand.
        let _ = std::fs::remove_dir_all(&out);
        bare(&out, &["--outcomes", file.to_str().expect("a path")])
    };
    let verdict = |name: &str| {
        let list = json(&out)["evidence"].as_array().expect("a list").clone();
        list.into_iter().find(|one| one["id"] == format!("model:{name}")).expect("there")["verdict"].clone()
    };
    let said = given(&"another".into(), serde_json::json!([found]));
    assert!(text(&said).contains("of another commit"), "{}", text(&said));
    assert_eq!(verdict("change-heard"), "not-run");
    let (commit, dirty) = (json(&out)["provenance"]["commit"].clone(), json(&out)["provenance"]["dirty"].clone());
    let commit = if commit.is_null() { "none".into() } else { commit };
    let run = |outcomes| given(&commit, outcomes);
    run(serde_json::json!([found]));
    // While somebody works on the checkout nothing is taken.
    let taken = if dirty == false { "model-checked" } else { "not-run" };
    assert_eq!((verdict("change-heard"), verdict("misread")), (taken.into(), "not-run".into()));
    let told = json(&out)["open_items"].to_string().contains("1 of them were searched by the tests of this commit");
    assert_eq!(told, dirty == false);
    // A search that did not come to its end is none.
    let mut half = found.clone();
    half["complete"] = false.into();
    run(serde_json::json!([half]));
    assert_eq!(verdict("change-heard"), "not-run");
    let mut other = found.clone();
    other["model"] = "other".into();
    for (wrong, says) in [
        (serde_json::json!([found, found]), "the model \"change-heard\" is there twice"),
        (serde_json::json!([other]), "the model \"other\" is not known"),
        (serde_json::json!(1), "no outcomes of models"),
    ] {
        let refused = run(wrong);
        assert_eq!(refused.status.code(), Some(2));
        assert!(text(&refused).contains(says), "{}", text(&refused));
    }
}

#[test]
fn a_changed_file_is_noticed_and_stale_results_are_marked() {
    let folder = tempfile::tempdir().expect("a folder");
    let out = folder.path().join("case");
    let log = folder.path().join("tests.log");
    let line = "     Running unittests src/lib.rs (target/debug/deps/atc_kernel-01)\n\
                test result: ok. 3 passed; 0 failed; 0 ignored; 0 measured; 0 filtered out; finished in 0.00s\n";
    std::fs::write(&log, line).expect("written");
    let (path, log) = (out.to_str().expect("a path"), log.to_str().expect("a path"));
    let without = ["--no-provers", "--no-native", "--no-models", "--no-measurements"];
    let run = safety_case(&[&["run", "--out", path, "--test-results", log], &without[..]].concat());
    // The argument names suites that are not in this log.
    assert!(text(&run).contains("the argument names this suite, and it is not in the run"), "{}", text(&run));
    let all = |case: &serde_json::Value| {
        let list = case["evidence"].as_array().expect("a list").clone();
        list.into_iter().find(|one| one["id"] == "test:all").expect("there")["verdict"].clone()
    };
    assert_eq!(all(&json(&out)), "tested");

    // The case says that it was made from another kernel.
    let stored = std::fs::read_to_string(out.join("case.json")).expect("written");
    let hash = json(&out)["provenance"]["folders"]["kernel"].as_str().expect("a hash").to_owned();
    std::fs::write(out.join("case.json"), stored.replace(&hash, "0000")).expect("written");
    let verified = safety_case(&["verify", path, "--models", "0"]);
    assert!(text(&verified).contains("case.json: its contents have changed"), "{}", text(&verified));
    assert!(text(&verified).contains("kernel is not what the case was made from"), "{}", text(&verified));
    let rendered = safety_case(&["render", "--from", path]);
    assert!(text(&rendered).contains("kernel has changed since the engines ran"), "{}", text(&rendered));
    assert_eq!(all(&json(&out)), "stale");
    assert!(out.join("incomplete").exists());
}
