//! Levels, rules and places; that nothing bad is missing, and that the document is SARIF 2.1.0.

use super::json;
use crate::case::{Case, Matter, OpenItem, Requirement, Severity};
use crate::judge::argument::tests::evidence;
use crate::judge::verdict::Verdict;
use crate::render::html::tests;
use serde_json::{Value, json};

/// What the standard asks of the parts that are written here.
const SCHEMA: &str = include_str!("../../tests/sarif.schema.json");

fn document(case: &Case) -> Value {
    let document: Value = serde_json::from_str(&json(case).expect("written")).expect("JSON");
    let schema = serde_json::from_str(SCHEMA).expect("JSON");
    let validator = jsonschema::validator_for(&schema).expect("a schema");
    let errors: Vec<_> = validator.iter_errors(&document).map(|error| error.to_string()).collect();
    assert_eq!(errors, Vec::<String>::new());
    document
}

fn results(document: &Value) -> &Vec<Value> {
    document["runs"][0]["results"].as_array().expect("a list")
}

/// A failed wrong kernel, a harness that has not been run and a good model, and open items about them and more.
fn mixed() -> Case {
    let mut case = tests::case(Verdict::NotRun, None);
    let mut failed = evidence("mutant:m", Verdict::Failed);
    failed.reason = Some("no theorem noticed it".to_owned());
    failed.at = Some("kernel/src/block/count.rs:7".to_owned());
    let mut not_run = evidence("harness:t", Verdict::NotRun);
    not_run.at = Some("proofs/src/time.rs:12".to_owned());
    case.evidence = vec![failed, not_run, evidence("model:n", Verdict::ModelChecked)];
    let item = |severity, matter, about: &str, text: &str| {
        let (about, text) = (about.to_owned(), text.to_owned());
        OpenItem { severity, matter, about, text }
    };
    case.open_items = vec![
        item(Severity::Stop, Matter::Result, "m", "failed: no theorem noticed it"),
        item(Severity::Stop, Matter::LineData, "Line", "BLK-9: NO"),
        item(Severity::Open, Matter::Requirement, "ACC-1, ACC-2", "No line of the code quotes it."),
        item(Severity::Note, Matter::Provenance, "provenance", "Not a git checkout."),
    ];
    case.requirements = ["ACC-1", "ACC-2", "ACC-22"]
        .map(|id| Requirement {
            id: id.to_owned(),
            title: String::new(),
            sentence: String::new(),
            at: format!("spec/aspect.md:{}", id.len()),
            code: vec![],
            harnesses: vec![],
            models: vec![],
            mutants: vec![],
            tests: vec![],
            verdict: Verdict::NotRun,
        })
        .into();
    case
}

#[test]
fn what_is_not_good_has_a_result_with_its_rule_level_and_place() {
    let document = document(&mixed());
    assert_eq!(document["version"], "2.1.0");
    assert!(document["$schema"].as_str().is_some_and(|uri| uri.ends_with("sarif-2.1.0.json")));
    assert_eq!(document["runs"][0]["tool"]["driver"]["name"], "safety-case");
    let place = |file: &str, line: u32| {
        json!({"physicalLocation": {
            "artifactLocation": {"uri": file, "uriBaseId": "SRCROOT"}, "region": {"startLine": line}
        }})
    };
    let found: Vec<_> = results(&document)
        .iter()
        .map(|one| json!([one["ruleId"], one["level"], one["locations"], one["message"]["text"]]))
        .collect();
    let count = place("kernel/src/block/count.rs", 7);
    let time = place("proofs/src/time.rs", 12);
    let spec = place("spec/aspect.md", 5);
    assert_eq!(
        found,
        [
            json!(["failed", "error", [count], "m is failed: no theorem noticed it."]),
            json!(["not-run", "warning", [time], "t is not-run: no reason given."]),
            // The first open item only says again what the first result says.
            json!(["stop", "error", null, "Line: BLK-9: NO"]),
            json!(["open", "warning", [spec, spec], "ACC-1, ACC-2: No line of the code quotes it."]),
            json!(["note", "note", null, "provenance: Not a git checkout."]),
        ]
    );
    assert_eq!(results(&document)[0]["partialFingerprints"], json!({"evidenceId/v1": "mutant:m"}));
    let base = &document["runs"][0]["originalUriBaseIds"];
    assert!(base["SRCROOT"]["description"]["text"].as_str().is_some_and(|text| !text.is_empty()));
}

#[test]
fn every_verdict_has_its_level_and_every_rule_is_described() {
    for verdict in Verdict::ALL {
        let document = document(&tests::case(verdict, None));
        let rules = document["runs"][0]["tool"]["driver"]["rules"].as_array().expect("a list");
        let ids: Vec<_> = rules.iter().map(|rule| rule["id"].as_str().expect("a word")).collect();
        assert_eq!(ids, ["failed", "vacuous", "undecided", "stale", "not-run", "stop", "open", "note"]);
        assert!(rules.iter().all(|rule| rule["shortDescription"]["text"].as_str().is_some_and(|text| text.len() > 1)));
        let level = match verdict {
            Verdict::Failed | Verdict::Vacuous => "error",
            Verdict::Stale | Verdict::NotRun | Verdict::Undecided => "warning",
            Verdict::Proved | Verdict::ProvedBounded | Verdict::ModelChecked | Verdict::Tested | Verdict::Measured => {
                assert_eq!(results(&document).len(), 0, "{verdict}");
                continue;
            }
        };
        let [one] = &results(&document)[..] else { panic!("one result for {verdict}") };
        assert_eq!((one["ruleId"].as_str(), one["level"].as_str()), (Some(verdict.word()), Some(level)));
        let rule = rules.iter().find(|rule| rule["id"] == one["ruleId"]).expect("among the rules");
        assert_eq!(rule["defaultConfiguration"]["level"], level);
    }
}

#[test]
fn an_incomplete_case_without_results_did_not_succeed() {
    let mut case = tests::case(Verdict::Tested, None);
    let invocation = |case: &Case| document(case)["runs"][0]["invocations"][0].clone();
    assert_eq!(invocation(&case)["executionSuccessful"], true);
    case.status.complete = false;
    case.status.exit_code = 1;
    case.status.reasons = vec!["tested, not proved by the cbmc engine: t".to_owned()];
    assert_eq!(results(&document(&case)).len(), 0);
    assert_eq!(
        invocation(&case),
        json!({"executionSuccessful": false, "exitCode": 1, "exitCodeDescription": case.status.reasons[0]})
    );
}

/// What stops the run is a reason by what it is about, and not by its words; a result is told once.
#[test]
fn what_stops_a_run_is_a_reason_whatever_its_name() {
    let mut case = mixed();
    for (matter, about) in
        [(Matter::Ratchet, "A line with spaces"), (Matter::Ratchet, "2 models"), (Matter::Result, "m 2")]
    {
        let text = "BLK-9: NO".to_owned();
        case.open_items.push(OpenItem { severity: Severity::Stop, matter, about: about.to_owned(), text });
    }
    let reasons = crate::judge::build::status(&case, crate::judge::build::Required::NoDefect).reasons;
    for about in ["A line with spaces", "2 models"] {
        assert!(reasons.contains(&format!("{about}: BLK-9: NO")), "{reasons:?}");
    }
    assert!(!reasons.iter().any(|reason| reason.starts_with("m 2")), "{reasons:?}");
}
