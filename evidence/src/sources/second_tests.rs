//! Opinions that agree, differ, are not run, and that say they agree when their figures do not.

use super::{Agreement, Opinion, check, engine, enter, opinions};
use crate::case::{Evidence, Model};
use crate::judge::verdict::Verdict;
use crate::sources::models::{ModelInfo, evidence};

fn opinion(model: &str, verdict: Agreement, states: Option<u64>) -> Opinion {
    Opinion {
        model: model.to_owned(),
        tool: "spin".to_owned(),
        version: "6.5.2".to_owned(),
        states,
        verdict,
        reason: None,
        seconds: 1.0,
    }
}

/// Two models, both checked, with seven states each.
fn checked() -> (Vec<Evidence>, Vec<Model>) {
    let catalogue = ["block-a", "block-b"].map(|name| ModelInfo {
        name: name.to_owned(),
        statement: "s".to_owned(),
        requirements: vec![],
        assumptions: vec![],
    });
    let (mut evidence, mut models) = evidence(&catalogue, &[], "not run");
    for (evidence, model) in evidence.iter_mut().zip(&mut models) {
        (evidence.verdict, model.unique_states) = (Verdict::ModelChecked, Some(7));
    }
    (evidence, models)
}

fn judged(verdict: Agreement, states: Option<u64>) -> (Verdict, Verdict, Verdict) {
    let (mut evidence, models) = checked();
    let opinions = opinions(&[opinion("block-a", verdict, states)], &models);
    enter(&opinions, &mut evidence);
    // The other model is not touched.
    assert_eq!((evidence[1].verdict, evidence[1].engines.len()), (Verdict::ModelChecked, 0));
    assert_eq!(evidence[0].engines[0].verdict, opinions[0].verdict);
    (opinions[0].verdict, evidence[0].verdict, engine(&opinions).verdict)
}

#[test]
fn one_that_differs_refutes_the_model() {
    use Verdict::{Failed, ModelChecked, NotRun, Undecided};
    assert_eq!(judged(Agreement::Agrees, Some(7)), (ModelChecked, ModelChecked, ModelChecked));
    assert_eq!(judged(Agreement::Differs, Some(7)), (Failed, Failed, Failed));
    assert_eq!(judged(Agreement::NotRun, None), (NotRun, ModelChecked, NotRun));
    // It says that it agrees, and has seen other states, or none.
    assert_eq!(judged(Agreement::Agrees, Some(8)), (Undecided, Undecided, Undecided));
    assert_eq!(judged(Agreement::Agrees, None), (Undecided, Undecided, Undecided));
}

#[test]
fn without_any_opinion_the_engine_is_not_run() {
    assert_eq!(engine(&[]).verdict, Verdict::NotRun);
    let none = opinions(&[opinion("block-c", Agreement::Agrees, Some(7))], &checked().1);
    assert_eq!(none[0].verdict, Verdict::Undecided);
}

#[test]
fn an_opinion_on_no_model_and_a_second_one_on_the_same_are_refused() {
    let models = ["block-a".to_owned()];
    let faults = |opinions: &[Opinion]| {
        let faults = check(opinions, &models).err().unwrap_or_default();
        faults.iter().map(ToString::to_string).collect::<Vec<_>>().join("\n")
    };
    let one = opinion("block-a", Agreement::Agrees, Some(7));
    assert_eq!(faults(std::slice::from_ref(&one)), "");
    assert!(faults(&[one.clone(), one]).contains("two second opinions"));
    assert!(faults(&[opinion("block-c", Agreement::NotRun, None)]).contains("not in the catalogue"));
}
