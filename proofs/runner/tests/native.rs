//! The native engine: every harness on drawn values, and every counterexample that was ever kept.

use atc_prover::campaign::native_campaign;
use atc_prover::report::{HarnessResult, Verdict};
use atc_prover::{Options, harnesses, in_parallel, native, root, select};
use std::collections::BTreeSet;

/// What the native engine says of every harness. `ATC_NATIVE=FILE` has it written to a file, for `safety-case run --import FILE`, which
/// takes it only for these very sources.
fn tested() -> Vec<HarnessResult> {
    let options = Options { jobs: 2, tests: RUNS, ..Options::default() };
    let campaign = native_campaign(&options, &harnesses()).expect("the sources can be read");
    if let Some(file) = std::env::var_os("ATC_NATIVE") {
        let text = serde_json::to_string(&campaign).expect("JSON");
        std::fs::write(&file, text).expect("ATC_NATIVE can be written");
    }
    campaign.harnesses
}

/// As many as `safety-case run` makes.
const RUNS: usize = 4_000;

/// Some drawn values hit most cover points; where they miss one, more are drawn.
#[test]
fn every_harness_holds_on_drawn_values_and_they_hit_its_cover_points() {
    // Hit by CBMC one and all; these are too rare for drawn values.
    let rare: BTreeSet<&str> = RARE.iter().copied().collect();
    let missed = |result: &HarnessResult| -> Vec<String> {
        let about = (&result.reason, &result.counterexample);
        assert_eq!(result.verdict, Verdict::Tested, "{}: {about:?}", result.name);
        let names = result.covers.iter().filter(|cover| !cover.hit);
        let names = names.map(|cover| format!("{}::{}", result.name, cover.name));
        names.filter(|name| !rare.contains(name.as_str())).collect()
    };
    let all = tested();
    let missed: Vec<_> = in_parallel(2, all.len(), |number| {
        let again = || missed(&native::test(harnesses()[number], 20_000));
        if missed(&all[number]).is_empty() { Vec::new() } else { again() }
    });
    let missed = missed.concat();
    assert!(missed.is_empty(), "{missed:?}");
}

const RARE: [&str; 106] = [
    "t_ilk_12::Both",
    "t_ilk_12::GoesOn",
    "t_ilk_12_train::Let",
    "t_ilk_12_train::Behind",
    "t_atc_1_sound::Short",
    "t_ilk_12_unswept::Refused",
    "t_ilk_12_unswept::Own",
    "t_ilk_1::Berth",
    "t_ilk_train_stands::Shared",
    "t_ilk_train_stands::Leaves",
    "t_ilk_train_stands::Starts",
    "t_ilk_train_called::Berth",
    "t_ilk_train_called::Gone",
    "t_ilk_train_called::Withdrawn",
    "t_ilk_8::Moves",
    "t_ilk_8::Needed",
    "t_per_4::Longer",
    "t_atc_1_apart::Chain",
    "t_atc_2_train::Line",
    "t_atc_4::Line",
    "t_way_3::Saturated",
    "t_way_7::Throat",
    "t_ilk_train_start::Runs",
    "t_ilk_train_start::Arrives",
    "t_ilk_train_unswept::Goes",
    "t_ilk_train_unswept::Own",
    "t_ilk_train_unswept::Stops",
    "t_ilk_train_unswept::Slides",
    "t_ilk_train_unswept::Point",
    "t_ilk_train_unswept::Starts",
    "t_ilk_train_unswept::Out",
    "way_words::NoPair",
    "t_way_1::Whole",
    "way_signals::Curve",
    "t_trn_1::Runs",
    "t_trn_1::Last",
    "t_trn_1_distance::Fixed",
    "t_trn_1_distance::Again",
    "t_trn_2::Lower",
    "t_trn_3::Ends",
    "t_trn_3::Code",
    "t_trn_3::Telegram",
    "t_trn_3::Announced",
    "t_trn_6::Narrowed",
    "t_trn_6_inside::New",
    "t_trn_6_inside::Passed",
    "trn_valid::Target",
    "trn_machine::Runs",
    "t_ilk_train_start::Stands",
    "t_ilk_train_start::Line",
    "t_ilk_train_start::Last",
    "t_blk_4::Agreed",
    "t_pos_3::Contradicted",
    "t_ilk_train_points::Let",
    "t_ilk_train_points::Behind",
    "t_ilk_train_points::Undetected",
    "t_ilk_train_points::Late",
    "t_ilk_train_worker::Blocked",
    "t_ilk_train_worker::Behind",
    "t_ilk_train_worker::Runs",
    "t_ilk_train_worker::Before",
    "t_ilk_train_line::Out",
    "t_ilk_train_line::In",
    "t_ilk_train_line::Last",
    "t_ilk_train_line::Worker",
    "t_ilk_8::Moving",
    "t_ilk_9::Train",
    "t_ilk_9::Sent",
    "t_atc_5::Goes",
    "t_ilk_4::Command",
    "t_ilk_9::Toward",
    "t_ilk_9::Away",
    "t_ilk_9::Waits",
    "t_ilk_9::Needs",
    "t_ilk_train_body::Entry",
    "t_ilk_train_body::Path",
    "t_ilk_train_body::Slid",
    "t_ilk_train_body::Restricted",
    "t_ilk_4::Under",
    "t_ilk_8::Becomes",
    "t_lay_2::Line",
    "t_atc_2_train::Far",
    "t_acc_6::Silenced",
    "set_1::Highest",
    "t_ilk_1::Under",
    "t_ilk_7::Again",
    "t_ilk_8::Both",
    "t_atc_1_overlap::Over",
    "t_ilk_4_settled::Proceed",
    "t_ilk_4_settled::Waits",
    "t_ilk_1_starting::Set",
    "t_ilk_1_starting::Over",
    "t_ilk_train::Entered",
    "t_ilk_train::Late",
    "t_ilk_train::Let",
    "t_ilk_train_release::Behind",
    "t_ilk_train_release::Running",
    "t_ilk_train_release::Timed",
    "t_ilk_train_overlap::Stands",
    "t_ilk_train_overlap::Slid",
    "t_atc_1_connect::Mixed",
    "t_atc_5::Turned",
    "t_atc_7::Chain",
    "t_atc_7::Throat",
    "t_atc_7::Other",
    "t_atc_1_apart::Line",
];

#[test]
fn kept_counterexamples_stay_repaired() {
    #[derive(serde::Deserialize)]
    struct Kept {
        harness: String,
        values: Vec<u16>,
    }
    for entry in std::fs::read_dir(root().join("proofs/runner/regressions")).unwrap() {
        let path = entry.unwrap().path();
        let kept: Kept = serde_json::from_str(&std::fs::read_to_string(&path).unwrap()).unwrap();
        let run = native::replay(select(&[kept.harness]).unwrap()[0], &kept.values);
        assert!(run.failed().is_empty(), "{}: {:?}", path.display(), run.failed());
    }
}

#[test]
fn a_replay_draws_exactly_the_values_of_the_tape() {
    let harness = select(&["sup_3".to_owned()]).unwrap()[0];
    let run = native::replay(harness, &[4000, 5]);
    let values: Vec<_> = run.drawn.iter().map(|(_, value)| *value).collect();
    assert_eq!(values, [4000, 5]);
    assert!(run.accepted && run.failed().is_empty());
    assert_eq!(run.covered, [0]);
}

#[test]
fn names_are_unique_and_every_harness_can_fail_and_be_covered() {
    let mut names = BTreeSet::new();
    for harness in harnesses() {
        assert!(names.insert(harness.name), "{} twice", harness.name);
        assert!((1..=8).contains(&harness.claims.len()), "{}", harness.name);
        assert!((1..=8).contains(&harness.covers.len()), "{}", harness.name);
        assert!(!harness.requirements.is_empty(), "{}", harness.name);
    }
}

#[test]
fn a_name_that_matches_nothing_is_an_error() {
    let error = select(&["t_acc_99".to_owned()]).err().unwrap();
    assert!(error.contains("t_acc_99") && error.contains("t_acc_1"), "{error}");
}
