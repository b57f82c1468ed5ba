//! What two checkers must have in common to agree.

use atc_models::inside::{Counted, difference};
use atc_models::spin::Twin;
use atc_models::{Expectation, Outcome, PropertyOutcome, Verdict};

fn property(expectation: Expectation, verdict: Verdict) -> PropertyOutcome {
    let name = format!("{expectation:?}").to_lowercase();
    PropertyOutcome { name, text: String::new(), expectation, verdict, excluded_by: vec![], trace: None }
}

fn outcome() -> Outcome {
    Outcome {
        model: "m".to_owned(),
        statement: String::new(),
        requirements: vec![],
        parameters: String::new(),
        assumptions_in_force: vec![],
        assumptions_lifted: vec![],
        complete: true,
        unique_states: 10,
        generated_states: 20,
        max_depth: 5,
        seconds: 0.0,
        properties: vec![
            property(Expectation::AlwaysHolds, Verdict::ModelChecked),
            property(Expectation::HazardFound, Verdict::Found),
        ],
        cut_sets: vec![],
        failure_modes: vec![],
    }
}

const TWIN: Twin = Twin { promela: std::borrow::Cow::Borrowed(""), parameters: vec![], chooses: true };
const COUNTED: Counted = Counted { states: 10, steps: 21 };

#[test]
fn the_same_numbers_and_the_same_verdicts_agree() {
    assert_eq!(difference(&TWIN, &outcome(), COUNTED, &[false, true]), None);
    let fixed = Twin { chooses: false, ..TWIN };
    assert_eq!(difference(&fixed, &outcome(), Counted { steps: 20, ..COUNTED }, &[false, true]), None);
}

#[test]
fn any_difference_is_one() {
    let differs = |outcome: &Outcome, counted, refuted: &[bool]| difference(&TWIN, outcome, counted, refuted).is_some();
    assert!(differs(&outcome(), Counted { states: 11, ..COUNTED }, &[false, true]));
    assert!(differs(&outcome(), Counted { steps: 20, ..COUNTED }, &[false, true]));
    assert!(differs(&outcome(), COUNTED, &[true, true]));
    assert!(differs(&outcome(), COUNTED, &[false, false]));
    assert!(differs(&outcome(), COUNTED, &[false]));
    assert!(differs(&Outcome { complete: false, ..outcome() }, COUNTED, &[false, true]));
    assert!(differs(&Outcome { properties: vec![], ..outcome() }, COUNTED, &[]));
    for (place, verdict) in [(0, Verdict::Failed), (0, Verdict::Incomplete), (1, Verdict::NotFound)] {
        let mut other = outcome();
        other.properties[place].verdict = verdict;
        assert!(differs(&other, COUNTED, &[false, true]), "{verdict:?}");
    }
}
