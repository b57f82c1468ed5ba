//! The headline, and that nothing reassuring stands above what is open.

use super::{document, headline};
use crate::case::{Case, Conclusion, Derived, Evidence, Kind, Line, OpenItem, Provenance, SCHEMA, Severity, Status};
use crate::verdict::Verdict;

fn case(verdict: Verdict, open: Option<Severity>) -> Case {
    let text = String::new;
    let evidence = Evidence {
        id: "harness:t".to_owned(),
        kind: Kind::Harness,
        title: "t".to_owned(),
        statement: "a < b & c".to_owned(),
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
        techniques: vec![],
        tools: vec![],
        line: Line {
            name: "Line".to_owned(),
            source: text(),
            cycle_ms: 10,
            aspects_km_h: vec![25.0],
            times: vec![],
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
