//! Cut sets that nobody owns, that are not minimal, and that two models share.

use super::{check, cut_sets, failure_modes};
use crate::case::Condition;
use crate::sources::data::Assumption;
use atc_models::{CutSet, Expectation, FailureMode, Outcome, PropertyOutcome, Step, Trace, Verdict};
use serde_json::{Value, json};

pub fn outcome(model: &str, cut_sets: Vec<CutSet>, failure_modes: Vec<FailureMode>) -> Outcome {
    Outcome {
        model: model.to_owned(),
        statement: "s".to_owned(),
        requirements: vec![],
        parameters: "p".to_owned(),
        assumptions_in_force: vec![],
        assumptions_lifted: vec![],
        complete: true,
        unique_states: 7,
        generated_states: 7,
        max_depth: 1,
        seconds: 0.0,
        properties: vec![],
        cut_sets,
        failure_modes,
    }
}

fn set(faults: &[&str], excluded_by: &[&str], cycles: usize) -> CutSet {
    let owned = |list: &[&str]| list.iter().map(|one| (*one).to_owned()).collect();
    let step = Step { input: json!({}), output: json!({}), words: std::collections::BTreeMap::new() };
    CutSet {
        faults: owned(faults),
        text: format!("In {cycles} cycles."),
        excluded_by: owned(excluded_by),
        trace: Trace { machine: "none".to_owned(), config: Value::Null, steps: vec![step; cycles], loop_start: None },
    }
}

fn mode(fault: &str, safe: bool) -> FailureMode {
    FailureMode {
        fault: fault.to_owned(),
        text: "t".to_owned(),
        safe,
        effect: "all occupied while it lasts".to_owned(),
        states: 3,
    }
}

fn assumption(id: &str, owner: &str) -> Assumption {
    Assumption { id: id.to_owned(), owner: owner.to_owned(), ..Assumption::default() }
}

fn faults(outcomes: &[Outcome]) -> String {
    let assumptions = [assumption("independent", "maker"), assumption("ownerless", " ")];
    let faults = check(outcomes, &assumptions, &["BLK-2".to_owned()]).err().unwrap_or_default();
    faults.iter().map(ToString::to_string).collect::<Vec<_>>().join("\n")
}

#[test]
fn a_cut_set_that_is_owned_passes_and_one_that_nobody_owns_stops() {
    let one = |excluded: &[&str]| faults(&[outcome("m", vec![set(&["a", "b"], excluded, 1)], vec![])]);
    assert_eq!(one(&["independent"]), "");
    assert!(one(&[]).contains("model:m: nobody owns the cut set {a, b}"), "{}", one(&[]));
    assert!(one(&["ownerless"]).contains("nobody owns the cut set {a, b}"));
    assert!(one(&["BLK-6"]).contains("(BLK-6 is not there)"));
    // A second one that is not there is a slip of the pen, though the set is owned.
    let slip = one(&["independent", "independant"]);
    assert!(slip.contains("\"independant\"") && !slip.contains("nobody"), "{slip}");
}

#[test]
fn a_cut_set_is_minimal_and_has_a_fault() {
    let sets = |sets: &[&[&str]]| {
        let sets = sets.iter().map(|faults| set(faults, &["independent"], 1)).collect();
        faults(&[outcome("m", sets, vec![])])
    };
    assert_eq!(sets(&[&["a", "a"], &["a", "b"]]), "");
    assert!(sets(&[&["a"], &["a", "b"]]).contains("{a, b} is not minimal: it contains {a}"));
    assert!(sets(&[&["a", "b"], &["b", "a"]]).contains("is not minimal"));
    assert!(sets(&[&[]]).contains("without a fault"));
}

#[test]
fn a_single_fault_that_is_not_safe_is_owned_as_a_cut_set() {
    let with = |sets| faults(&[outcome("m", sets, vec![mode("a", false), mode("b", true)])]);
    assert!(with(vec![]).contains("nobody owns the fault \"a\""));
    assert!(with(vec![set(&["a", "b"], &["independent"], 1)]).contains("nobody owns the fault \"a\""));
    assert_eq!(with(vec![set(&["a"], &["independent"], 1)]), "");
}

#[test]
fn a_hazard_that_is_found_is_excluded_by_what_there_is() {
    let with = |excluded: &str| {
        let property = PropertyOutcome {
            name: "free".to_owned(),
            text: "t".to_owned(),
            expectation: Expectation::HazardFound,
            verdict: Verdict::Found,
            excluded_by: vec![excluded.to_owned()],
            trace: None,
        };
        faults(&[Outcome { properties: vec![property], ..outcome("m", vec![], vec![]) }])
    };
    assert_eq!((with("independent"), with("BLK-2")), (String::new(), String::new()));
    assert!(with("ownerless").contains("the hazard free is excluded by \"ownerless\""));
    assert!(with("BLK-99").contains("no requirement"));
}

#[test]
fn a_cut_set_of_two_models_is_there_once_with_its_shortest_way() {
    let condition = |number: &str, id: &str| Condition {
        number: number.to_owned(),
        id: id.to_owned(),
        statement: String::new(),
        why: String::new(),
        hazards: vec!["H-7".to_owned()],
        addressee: String::new(),
        check: String::new(),
        owner: format!("owner of {id}"),
        used_by: vec![],
    };
    let conditions = [condition("SRAC-1", "independent"), condition("SRAC-2", "other")];
    let outcomes = [
        outcome("one", vec![set(&["a", "b"], &["independent"], 5), set(&["c"], &["other"], 2)], vec![]),
        outcome("two", vec![set(&["b", "a"], &["other"], 3)], vec![mode("a", true)]),
    ];
    let found = cut_sets(&outcomes, &conditions);
    let numbers: Vec<_> = found.iter().map(|set| (set.number.as_str(), set.faults.join(" "))).collect();
    assert_eq!(numbers, [("CS-1", "c".to_owned()), ("CS-2", "a b".to_owned())]);
    assert_eq!(found[1].text, "In 3 cycles.");
    assert_eq!(found[1].found_by, ["model:one", "model:two"]);
    assert_eq!(found[1].hazards, ["H-7"]);
    let owners: Vec<_> = found[1].excluded_by.iter().map(|one| one.owner.as_str()).collect();
    assert_eq!(owners, ["owner of independent", "owner of other"]);
    assert_eq!(failure_modes(&outcomes)[0].model, "model:two");
}
