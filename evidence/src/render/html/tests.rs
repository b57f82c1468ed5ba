//! The headline, and that nothing reassuring stands above what is open.

use super::{document, headline, station_page};
use crate::case::{
    Asked, Case, Chart, Conclusion, CutSet, DataCheck, Derived, Evidence, Excluded, FailureMode, Figure, Kind, Line,
    Matter, Measurements, OpenItem, Outcome, Provenance, Run, SCHEMA, SecondOpinion, Severity, Station, Status,
};
use crate::judge::verdict::Verdict;
use crate::sources::measured::HERE;

pub fn case(verdict: Verdict, open: Option<Severity>) -> Case {
    let text = String::new;
    let evidence =
        Evidence { statement: "a < b & c".to_owned(), seconds: 1.0, ..Evidence::bare(Kind::Harness, "t", verdict) };
    let missing = if verdict.is_result() { vec![] } else { vec![evidence.id.clone()] };
    let about = "ACC-1".to_owned();
    let item = |severity| OpenItem {
        severity,
        matter: Matter::Requirement,
        about: about.clone(),
        text: "Something is open.".to_owned(),
    };
    Case {
        schema: SCHEMA,
        title: "A kernel".to_owned(),
        provenance: Provenance::default(),
        run: Run::default(),
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
        accidents: vec![],
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
        needed_rules: vec![],
        station: None,
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

#[test]
fn figures_that_were_read_are_not_said_to_be_of_these_sources() {
    for (source, here) in [(HERE, true), ("read from elsewhere", false)] {
        let mut case = case(Verdict::Tested, None);
        let figure = Figure { unit: "dB".to_owned(), value: Some(0.5), ..Figure::default() };
        case.measurements =
            Measurements { source: source.to_owned(), figures: vec![figure], ..Measurements::default() };
        let page = document(&case);
        assert_eq!(page.contains("of the sources that this document is bound to"), here, "{source}");
        assert_eq!(page.contains("nothing says of which sources"), !here, "{source}");
    }
}

#[test]
fn a_station_is_to_be_signed_only_with_every_rule_kept_and_every_theorem_shown() {
    let rule = |outcome| DataCheck {
        rule: "no-flank".to_owned(),
        text: "t".to_owned(),
        asked: Asked::Engineering,
        scope: "1 route".to_owned(),
        outcome,
    };
    let page = |check, verdict| {
        let station = Station {
            name: "A <b> & C".to_owned(),
            source: "s.toml".to_owned(),
            sha256: "00".to_owned(),
            parameters: vec![],
            checks: vec![rule(check)],
            confirm: vec![],
            conditions: vec![],
            theorems: vec![("harness:t".to_owned(), verdict)],
            drawing: String::new(),
            columns: vec![],
            table: vec![],
            table_page: String::new(),
            layout: String::new(),
        };
        station_page(&case(verdict, None), &station)
    };
    let invites = |page: &str| page.contains("To be confirmed and signed.");
    let forbids = |page: &str| page.contains("Not to be signed: ") && page.contains(">not to be signed</span>");
    let good = page(Outcome::Met, Verdict::ProvedBounded);
    assert!(invites(&good) && !forbids(&good));
    assert!(!page(Outcome::Met, Verdict::Proved).contains("A <b>"));
    for verdict in Verdict::ALL.into_iter().filter(|verdict| !verdict.holds()) {
        let page = page(Outcome::Met, verdict);
        assert!(!invites(&page) && forbids(&page), "{verdict}");
    }
    for check in [Outcome::Broken { why: vec![] }, Outcome::NotChecked] {
        let page = page(check.clone(), Verdict::Proved);
        assert!(!invites(&page) && forbids(&page), "{check:?}");
    }
}
