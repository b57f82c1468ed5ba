//! What the specification says "for a re-implementation", by experiment.

use atc_protocol::Session;
use serde_json::{Value, json};

/// The replies to these lines.
fn replies(lines: &[Value]) -> Vec<Value> {
    let mut session = Session::new();
    let answer = |line: &Value| {
        let mut reply = Vec::new();
        session.answer(line.to_string().as_bytes(), &mut reply);
        serde_json::from_slice(&reply).expect("a reply is JSON")
    };
    lines.iter().map(answer).collect()
}

fn block() -> Value {
    let config = json!({"sections": 2, "max_trains": 1, "tail_hold_sections": 0, "pass_ms": 30, "cycle_ms": 10});
    json!({"start": {"protocol": 1, "machine": "block-count", "config": config}})
}

fn step(check_in: bool, check_out: bool, present: &[u8], more: &Value) -> Value {
    let mut body = json!({"check_in": check_in, "check_out": check_out, "present": present});
    let fields = body.as_object_mut().expect("an object");
    fields.extend(more.as_object().expect("an object").clone());
    json!({"step": body})
}

/// One train in the block, whose check-out is pending.
fn pending() -> Vec<Value> {
    vec![
        block(),
        step(false, false, &[], &json!({"reset": 0})),
        step(true, false, &[0], &json!({})),
        step(false, false, &[1], &json!({})),
        step(false, true, &[], &json!({"ahead_entered": false})),
    ]
}

#[test]
fn a_reset_in_the_cycle_in_which_the_last_pending_check_out_is_taken_over_is_refused() {
    let taken = step(false, false, &[], &json!({"ahead_entered": true}));
    let last = replies(&[pending(), vec![taken]].concat()).pop().expect("a reply");
    assert_eq!((&last["output"]["count"], &last["output"]["agree"]), (&json!(0), &json!(true)), "{last}");
    let reset = step(false, false, &[], &json!({"ahead_entered": true, "reset": 0}));
    let last = replies(&[pending(), vec![reset.clone()]].concat()).pop().expect("a reply");
    assert_eq!((&last["output"]["counting"], &last["output"]["count"]), (&json!(false), &json!(0)), "{last}");
    // It has forgotten what was pending: the same reset is accepted in the next cycle.
    let last = replies(&[pending(), vec![reset.clone(), reset]].concat()).pop().expect("a reply");
    assert_eq!(last["output"]["counting"], json!(true), "{last}");
}

#[test]
fn the_first_contradiction_is_latched_and_stays() {
    // A second train comes in, and one goes out of a block that has none left to go: the check-in is told.
    let both = step(true, true, &[], &json!({"ahead_entered": false}));
    let off = step(false, false, &[], &json!({"ahead_entered": false}));
    let all = replies(&[pending(), vec![off.clone(), both, off]].concat());
    let fault = |back: usize| all[all.len() - back]["output"]["fault"].clone();
    assert_eq!((fault(2), fault(1)), (json!("check-in-at-maximum"), json!("check-in-at-maximum")), "{all:?}");
    // A check-in that stays on is looked at before both: with a pass time of three cycles in the fourth.
    let on = || step(true, false, &[0], &json!({}));
    let all = replies(&[block(), step(false, false, &[], &json!({"reset": 0})), on(), on(), on(), on()]);
    let faults: Vec<&Value> = all.iter().skip(2).map(|reply| &reply["output"]["fault"]).collect();
    assert_eq!(faults, [&Value::Null, &Value::Null, &Value::Null, &json!("check-in-stays-on")]);
}

/// JSON Schema takes 10.0 for an integer, and so does the oracle.
#[test]
fn a_whole_number_may_be_written_with_a_fraction_of_nothing() {
    let start = json!({"start": {"protocol": 1, "machine": "block-count", "config": {
        "sections": 2.0, "max_trains": 1, "tail_hold_sections": 0.0, "cycle_ms": 10.0}}});
    let all = replies(&[start, step(false, false, &[], &json!({"reset": 0.0}))]);
    assert_eq!(all[1]["output"]["counting"], json!(true), "{all:?}");
    let half = json!({"start": {"protocol": 1, "machine": "block-count", "config": {
        "sections": 2.5, "max_trains": 1, "tail_hold_sections": 0}}});
    assert!(replies(&[half])[0].get("malformed").is_some());
}
