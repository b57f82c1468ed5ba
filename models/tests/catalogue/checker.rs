//! What is read from a checker's words, and what is not taken for a result.

use atc_models::inside::{Counted, counted, refuted};

const COUNT: &str = "State-vector 36 byte, depth reached 450, errors: 0\n      101 states, stored\n      610 states, matched\n      \
                     711 transitions (= stored+matched)\n";

#[test]
fn a_count_is_read() {
    assert_eq!(counted(COUNT), Ok(Counted { states: 101, steps: 711 }));
}

#[test]
fn what_is_no_complete_count_is_an_error() {
    for (from, to) in [
        ("errors: 0", "errors: 1"),
        ("101 states, stored", "1.67772e+08 states, stored"),
        ("711 transitions", "transitions"),
        ("State", "Warning: Search not completed\nState"),
        ("State", "error: max search depth too small\nState"),
        ("State", "pan: out of memory\nState"),
    ] {
        assert!(COUNT.contains(from));
        assert!(counted(&COUNT.replacen(from, to, 1)).is_err(), "{to}");
    }
    assert!(counted("").is_err());
}

#[test]
fn a_property_is_refuted_only_by_its_own_violation() {
    let held = format!("pan: ltl formula valid\n{COUNT}");
    assert_eq!(refuted(&held, "valid"), Ok(false));
    let errors = COUNT.replace("errors: 0", "errors: 1");
    let violated = format!("pan: ltl formula valid\npan:1: assertion violated  !(x) (at depth 3)\n{errors}");
    assert_eq!(refuted(&violated, "valid"), Ok(true));
    assert!(refuted(&held, "exact").is_err());
    assert!(refuted("pan: error: cannot find claim 'valid'", "valid").is_err());
    assert!(refuted(&held.replace("errors: 0", "errors: 1"), "valid").is_err());
    assert!(refuted(&format!("{held}Warning: Search not completed"), "valid").is_err());
}
