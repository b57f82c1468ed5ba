//! The headline, and that nothing reassuring stands above what is open.

use super::{document, headline};
use crate::case::{
    Case, Chart, Conclusion, CutSet, Derived, Evidence, Excluded, FailureMode, Kind, Line, Measurements, OpenItem,
    Provenance, SCHEMA, SecondOpinion, Severity, Status,
};
use crate::verdict::Verdict;

pub fn case(verdict: Verdict, open: Option<Severity>) -> Case {
    let text = String::new;
    let evidence = Evidence {
        id: "harness:t".to_owned(),
        kind: Kind::Harness,
        title: "t".to_owned(),
        statement: "a < b & c".to_owned(),
        at: None,
        verdict,
        detail: text(),
        reason: None,
        requirements: vec![],
        assumptions: vec![],
        claims: vec![],
        covers: vec![],
        engines: vec![],
        killed_by: vec![],
        seconds: 1.0,
        counterexample: None,
    };
    let missing = if verdict.is_result() { vec![] } else { vec![evidence.id.clone()] };
    let about = "ACC-1".to_owned();
    let item = |severity| OpenItem { severity, about: about.clone(), text: "Something is open.".to_owned() };
    Case {
        schema: SCHEMA,
        title: "A kernel".to_owned(),
        provenance: Provenance::default(),
        status: Status { complete: missing.is_empty(), missing, ..Status::default() },
        conclusions: vec![Conclusion {
            node: "G".to_owned(),
            verdict,
            sentence: verdict.conclusion("G", &["harness:t".to_owned()], &[]),
        }],
        open_items: open.map(item).into_iter().collect(),
        evidence: vec![evidence],
        engines: vec![],
        argument: vec![],
        conditions: vec![],
        hazards: vec![],
        requirements: vec![],
        models: vec![],
        cut_sets: vec![],
        failure_modes: vec![],
        second_opinions: vec![],
        measurements: Measurements::default(),
        techniques: vec![],
        tools: vec![],
        line: Line {
            name: "Line".to_owned(),
            source: text(),
            cycle_ms: 10,
            aspects_km_h: vec![25.0],
            times: vec![],
            blocks: vec![],
            sections: vec![],
            derived: Vec::<Derived>::new(),
            notes: vec![],
            theorems: vec![],
            checks: vec![],
        },
    }
}

#[test]
fn the_headline_is_green_only_with_nothing_open() {
    assert_eq!(headline(&case(Verdict::Proved, None)).0, "green");
    assert_eq!(headline(&case(Verdict::Proved, Some(Severity::Note))).0, "green");
    assert_eq!(headline(&case(Verdict::Proved, Some(Severity::Open))).0, "amber");
    assert_eq!(headline(&case(Verdict::Proved, Some(Severity::Stop))).0, "red");
    for verdict in Verdict::ALL.into_iter().filter(|verdict| !verdict.holds()) {
        assert_eq!(headline(&case(verdict, None)).0, "red", "{verdict}");
    }
}

#[test]
fn what_is_open_stands_above_what_is_shown() {
    let page = document(&case(Verdict::Proved, Some(Severity::Open)));
    let place = |text: &str| page.find(text).unwrap_or_else(|| panic!("{text} is not on the page"));
    assert!(place("1 item is open") < place("Something is open."));
    assert!(place("Something is open.") < place("What is shown"));
    assert!(place("What is shown") < place("is proved for all inputs"));
    assert!(!page.contains("no item is open"));
}

#[test]
fn the_page_needs_nothing_else_and_escapes_its_text() {
    let page = document(&case(Verdict::Proved, None));
    assert!(page.contains("a &lt; b &amp; c"));
    for outside in ["<script", "src=", "<link", "@import", "url(http"] {
        assert!(!page.contains(outside), "{outside}");
    }
}

#[test]
fn a_cut_set_stands_with_its_owner_and_its_chart() {
    let mut case = case(Verdict::Proved, None);
    assert!(document(&case).contains("The models have not been run."));
    let words = |text: &str| text.to_owned();
    case.cut_sets = vec![CutSet {
        number: words("CS-1"),
        faults: vec![words("check-in-lost"), words("missed-detection")],
        text: words("A section is reported free."),
        hazards: vec![words("H-7")],
        excluded_by: vec![Excluded {
            condition: words("SRAC-9"),
            assumption: words("check-in-fail-safe"),
            owner: words("the maker of the loops"),
        }],
        found_by: vec![words("model:m")],
        chart: Chart { name: words("CS-1"), caption: words("c"), svg: words("<svg>way</svg>"), trace: words("") },
    }];
    let mode = |safe| FailureMode {
        fault: words("check-in-lost"),
        text: words("t"),
        safe,
        effect: words("all occupied"),
        states: 1_000,
        model: words("model:m"),
    };
    case.failure_modes = vec![mode(true), mode(true), mode(false)];
    let page = document(&case);
    for part in ["check-in lost", "the maker of the loops", "<svg>way</svg>", "SRAC-9", "2 faults", ">unsafe<"] {
        assert!(page.contains(part), "{part}");
    }
    // The same word of two models is one row, with the states of both; another word is another row.
    assert!(page.contains("2\u{202f}000") && page.contains(">1\u{202f}000<"));
}

#[test]
fn a_second_opinion_that_differs_is_seen() {
    let mut case = case(Verdict::Proved, None);
    assert!(document(&case).contains("No other checker has looked at a model."));
    let opinion = |verdict| SecondOpinion {
        model: "model:m".to_owned(),
        tool: "spin".to_owned(),
        version: Some("6.5.2".to_owned()),
        first_states: Some(7),
        states: Some(8),
        verdict,
        reason: None,
        seconds: 1.0,
    };
    case.second_opinions = vec![opinion(Verdict::Failed)];
    assert!(document(&case).contains("<strong>differs</strong>"));
    case.second_opinions = vec![opinion(Verdict::ModelChecked)];
    let page = document(&case);
    assert!(page.contains("agrees") && page.contains("6.5.2") && !page.contains("<strong>differs</strong>"));
}
