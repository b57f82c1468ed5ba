//! The walks of `oracle conform`, which drive every timer to its limits, over the C border: the same said of every
//! step.

use atc_oracle::conform::case::Expected;
use atc_oracle::conform::walk::{Sizes, case};
use atc_protocol::machine::{aspect, block, pattern, permitted, supervision, telegram, train};
use serde_json::Value;

use crate::wire::Spoken;

/// Cases of each machine.
const CASES: u64 = 150;

pub fn body<T: serde::de::DeserializeOwned>(value: &Value) -> T {
    // From text: a speed is read from its digits.
    serde_json::from_str(&value.to_string()).unwrap_or_else(|error| panic!("{value}: {error}"))
}

/// How many cases there are of a machine, of cases that are rejected, and of steps.
pub fn walked(machine: &str, count: u64, mut look: impl FnMut(&Expected, bool) -> usize) -> (u64, u64, usize) {
    let (mut cases, mut rejected, mut steps) = (0, 0, 0);
    for number in 0..count {
        let expected = case(machine, 20_261_125, number, Sizes::Mixed, None).expect("the machine has walks");
        let refused = expected.start.starts_with(r#"{"rejected""#);
        steps += look(&expected, refused);
        cases += 1;
        rejected += u64::from(refused);
    }
    (cases, rejected, steps)
}

fn walk<M: Spoken>() {
    let found = walked(M::NAME, CASES, |expected, refused| {
        if expected.start.starts_with(r#"{"malformed""#) {
            return 0;
        }
        let started = M::start(&body(&expected.case.config));
        let Some(Ok(mut state)) = started else {
            assert!(refused, "{}: {} is refused", M::NAME, expected.case.config);
            return 0;
        };
        assert!(!refused, "{}: {} is taken, and {} said", M::NAME, expected.case.config, expected.start);
        let mut oracle = M::open(&body(&expected.case.config)).expect("the oracle has walked on it");
        for (number, step) in expected.case.steps.iter().enumerate() {
            let step = M::in_words(body(step));
            let output = oracle.step(&step).expect("a walk has no other");
            let said = M::say(&mut state, &step);
            assert!(said == output, "{}, step {number} of {}", M::NAME, expected.case.config);
        }
        expected.case.steps.len()
    });
    let (cases, rejected, steps) = found;
    println!("{}: {cases} cases, {rejected} of them rejected, {steps} steps", M::NAME);
    assert!(steps > 2000, "too few steps say little: {steps}");
}

#[test]
fn aspects() {
    walk::<aspect::Aspect>();
}

#[test]
fn supervisions() {
    walk::<supervision::Supervised>();
}

#[test]
fn blocks() {
    walk::<block::Counted>();
}

#[test]
fn patterns() {
    walk::<pattern::Braking>();
}

#[test]
fn telegrams() {
    walk::<telegram::Codec>();
}

#[test]
fn permitted_speeds() {
    walk::<permitted::Permitting>();
}

#[test]
fn on_board_devices() {
    walk::<train::OnBoard>();
}
