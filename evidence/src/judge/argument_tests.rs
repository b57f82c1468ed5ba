//! Dangling, circular and unused parts of an argument, and the worst child.

use super::{build, check, conclusions};
use crate::case::{Engine, Evidence, Kind};
use crate::judge::verdict::Verdict;
use crate::sources::data::{Argument, parse};

const GOOD: &str = r#"
    [[goal]]
    id = "G1"
    text = "It is safe."
    root = true
    supported_by = ["S1"]
    context = ["C1"]
    [[goal.defeater]]
    text = "The prover may be wrong."
    answer = "A second one agrees."
    engines = ["kani"]
    [[strategy]]
    id = "S1"
    text = "By machine."
    supported_by = ["G2", "G3"]
    [[goal]]
    id = "G2"
    text = "One."
    evidence = ["harness:a"]
    [[goal]]
    id = "G3"
    text = "Two."
    evidence = ["model:*", "harness:a"]
    [[context]]
    id = "C1"
    text = "Here."
"#;

fn faults(text: &str) -> String {
    let argument: Argument = parse("argument.toml", text).expect("readable");
    let known = ["harness:a", "model:m", "model:n"].map(str::to_owned);
    let faults = check(&argument, &known, &known).err().unwrap_or_default();
    faults.iter().map(ToString::to_string).collect::<Vec<_>>().join("\n")
}

pub fn evidence(id: &str, verdict: Verdict) -> Evidence {
    let (kind, name) = id.split_once(':').expect("an id");
    let kinds = [Kind::Harness, Kind::Model, Kind::Mutant, Kind::Measured, Kind::Test];
    let kind = kinds.into_iter().find(|known| known.word() == kind).expect("a kind");
    Evidence {
        detail: "4 aspects".to_owned(),
        requirements: vec!["ACC-1".to_owned()],
        ..Evidence::bare(kind, name, verdict)
    }
}

#[test]
fn a_good_argument_passes() {
    assert_eq!(faults(GOOD), "");
}

#[test]
fn every_dangling_end_is_named() {
    assert!(faults(&GOOD.replace("harness:a", "harness:b")).contains("there is no evidence harness:b"));
    assert!(faults(&GOOD.replace("harness:a", "model:m")).contains("harness:a is evidence of no goal"));
    assert!(faults(&GOOD.replace("model:*", "model:m")).contains("model:n is evidence of no goal"));
    assert!(faults(&GOOD.replace("[\"G2\", \"G3\"]", "[\"G2\"]")).contains("G3 supports nothing"));
    assert!(faults(&GOOD.replace("[\"G2\", \"G3\"]", "[\"G2\", \"G3\", \"G4\"]")).contains("G4, which is not there"));
    assert!(faults(&GOOD.replace("[\"C1\"]", "[\"C2\"]")).contains("C2, which is not there"));
    assert!(faults(&GOOD.replace("[\"harness:a\"]", "[]")).contains("G2 has neither"));
    assert!(faults(&GOOD.replace("id = \"G3\"", "id = \"G2\"")).contains("an id is there twice"));
    assert!(faults(&GOOD.replace("root = true", "")).contains("no goal is a root"));
}

#[test]
fn a_top_claim_needs_a_doubt_and_no_goal_supports_itself() {
    let (before, rest) = GOOD.split_once("[[goal.defeater]]").expect("there");
    let (_, after) = rest.split_once("[[strategy]]").expect("there");
    assert!(faults(&format!("{before}[[strategy]]{after}")).contains("no defeater"));
    let circle = GOOD.replace("text = \"One.\"", "text = \"One.\"\nsupported_by = [\"S1\"]");
    assert!(faults(&circle).contains("supports itself"), "{}", faults(&circle));
}

#[test]
fn the_root_takes_the_worst_and_the_sentence_names_it() {
    let argument: Argument = parse("argument.toml", GOOD).expect("readable");
    for (verdict, words) in [
        (Verdict::Proved, "4 aspects"),
        (Verdict::ModelChecked, "exhaustive search of finite models (model:n)"),
        (Verdict::NotRun, "is not shown: model:n has not been run"),
        (Verdict::Failed, "model:n failed"),
    ] {
        let all = [
            evidence("harness:a", Verdict::ProvedBounded),
            evidence("model:m", Verdict::Proved),
            evidence("model:n", verdict),
        ];
        let nodes = build(&argument, &all, &[], &[]);
        let conclusion = conclusions(&nodes, &all, &[]).remove(0);
        assert_eq!(conclusion.verdict, verdict.max(Verdict::ProvedBounded));
        assert!(conclusion.sentence.contains(words), "{}", conclusion.sentence);
    }
}

#[test]
fn an_answer_without_its_evidence_is_open() {
    let argument: Argument = parse("argument.toml", GOOD).expect("readable");
    let all = [evidence("harness:a", Verdict::Proved), evidence("model:m", Verdict::Proved)];
    let open = |verdict| {
        let text = String::new;
        let engine = Engine { name: "kani".to_owned(), what: text(), verdict, summary: text(), command: text() };
        build(&argument, &all, &[], &[engine])[0].defeaters[0].open
    };
    assert!(open(Verdict::NotRun) && open(Verdict::Stale) && open(Verdict::Failed));
    assert!(!open(Verdict::Proved));
}
