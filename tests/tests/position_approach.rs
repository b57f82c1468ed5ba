//! The train of `atc_tests::approach`, and the example that is drawn from it.

use atc_oracle::chart::{self, View};
use atc_oracle::trace::{Replies, Trace};
use atc_protocol::machine::Machine as _;
use atc_protocol::machine::position::Positioned;
use atc_tests::approach;

const EXAMPLE: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../oracle/examples/train-position.jsonl");

#[test]
fn the_example_is_this_approach() {
    let now = approach::lines();
    let committed = std::fs::read_to_string(EXAMPLE).unwrap_or_default();
    if committed != now {
        let fresh = concat!(env!("CARGO_TARGET_TMPDIR"), "/train-position.jsonl");
        std::fs::write(fresh, now).expect("a file");
        panic!("renew it: cp {fresh} {EXAMPLE}");
    }
}

/// The interval holds the train in every cycle, and is there whenever both levels are.
#[test]
fn the_truth_is_in_the_interval() {
    let mut machine = Positioned::open(&approach::config()).expect("a sound table");
    let mut known = 0;
    for step in approach::steps() {
        let output = machine.step(&step).expect("a sound step");
        assert!(step.first_db.is_some() || output.interval_m.is_none(), "an interval out of nothing");
        if let Some([nearest, farthest]) = output.interval_m {
            let truth = step.truth_m.expect("the truth");
            assert!(nearest <= truth && truth <= farthest, "{truth} m is not in {nearest} to {farthest} m");
            known += 1;
        }
    }
    assert!(known >= 80, "known in {known} of 100 cycles");
}

/// The chart says whether the truth is inside, and says so loudly if it is not.
#[test]
fn the_chart_tells_a_truth_outside() {
    let draw = |lines: &str| {
        let trace = Trace::parse(lines).expect("a trace");
        chart::svg(&trace, Replies::MustAgree, &View::default()).expect("a chart")
    };
    let lines = approach::lines();
    assert!(draw(&lines).contains("The truth is in the interval whenever there is one."));
    let first = lines.lines().nth(1).expect("a step");
    let wrong = first.replace("\"truth_m\":1382", "\"truth_m\":7");
    assert_ne!(first, wrong);
    let svg = draw(&lines.replacen(first, &wrong, 1));
    assert!(svg.contains("THE TRUTH IS OUTSIDE THE INTERVAL IN 1 CYCLES"), "not told");
}
