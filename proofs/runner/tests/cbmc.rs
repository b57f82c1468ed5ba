//! The cbmc engine's guards: what a prover says, or fails to say, is never read as more than it is.

use atc_prover::recorded::Recorded;
use atc_prover::{campaign, is_smaller, mutants, parse_cbmc, root, select, unwound};
use std::collections::BTreeSet;

const DONE: &str = "CBMC version 6.6.0
Starting Bounded Model Checking

** Results:
driver.c function w2c_prover_claim
[w2c_prover_claim.assertion.1] line 212 claim 0: SUCCESS
[w2c_prover_claim.assertion.2] line 212 claim 1: FAILURE

Trace for w2c_prover_claim.assertion.2:

State 33 file driver.c function w2c_prover_word line 155 thread 0
----------------------------------------------------
  drawn=65543u (00000000 00000001 00000000 00000111)
  drawn=0u (00000000 00000000 00000000 00000000)
  other=65536u (00000000 00000001 00000000 00000000)
  drawn=262143u (00000000 00000011 11111111 11111111)

Violated property:
  file driver.c function w2c_prover_claim line 212 thread 0
  claim 1
  holds != 0u

** 1 of 2 failed (2 iterations)
VERIFICATION FAILED";

#[test]
fn verdicts_and_counterexamples_are_read() {
    let answer = parse_cbmc(DONE).unwrap();
    assert_eq!((answer.claim(0), answer.claim(1), answer.claim(2)), (Some(true), Some(false), None));
    assert_eq!(answer.values["claim 1"], [7, 0, 65_535]);
    assert!(!answer.values.contains_key("claim 0"));
    assert_eq!(answer.other_failure(), None);
}

#[test]
fn a_killed_prover_is_no_pass() {
    // Cut anywhere: never a result.
    for length in 0..DONE.len() {
        assert!(parse_cbmc(&DONE[..length]).is_err(), "cut at {length}");
    }
}

#[test]
fn no_status_unknown_status_and_nothing_checked_are_errors() {
    let without_status = DONE.replace("VERIFICATION", "OTHER");
    assert!(parse_cbmc(&without_status).unwrap_err().contains("no status"));
    let unknown = DONE.replace("SUCCESS", "UNKNOWN");
    assert!(parse_cbmc(&unknown).unwrap_err().contains("UNKNOWN"));
    let empty = "** 0 of 0 failed (1 iterations)\nVERIFICATION SUCCESSFUL";
    assert!(parse_cbmc(empty).unwrap_err().contains("nothing"));
}

#[test]
fn results_that_are_not_all_there_are_an_error() {
    let counts = ["** 0 of 2 failed", "** 1 of 3 failed", "** 1 of 22 failed", "** 2 of 2 failed"];
    for count in counts {
        let other = DONE.replace("** 1 of 2 failed", count);
        assert!(parse_cbmc(&other).unwrap_err().contains("counted"), "{count}");
    }
    let lost = DONE.replace("[w2c_prover_claim.assertion.1] line 212 claim 0: SUCCESS\n", "");
    assert!(parse_cbmc(&lost).unwrap_err().contains("counted"));
    let stranger = DONE.replace("Trace for w2c_prover_claim.assertion.2", "Trace for another");
    assert!(parse_cbmc(&stranger).unwrap_err().contains("no property"));
}

#[test]
fn code_that_the_prover_does_not_see_is_an_error() {
    let warned = format!("**** WARNING: no body for function f\n{DONE}");
    assert!(parse_cbmc(&warned).unwrap_err().contains("no body"));
    let property = DONE.replace("claim 0", "no body for callee f");
    assert!(parse_cbmc(&property).unwrap_err().contains("no body"));
}

#[test]
fn the_longest_loop_is_read_and_held_against_the_bound_for_kani() {
    // Of the one with 65 CBMC has not seen the end.
    let loops = [("sup_3_0.0", 3), ("sup_3_0.1", 62), ("sup_3_0.1", 63), ("sup.2", 64), ("sup.2", 65)];
    let others = [("memcpy.2", 300), ("memset.0", 768)];
    let messages = loops.iter().chain(&others).map(|(name, times)| {
        format!("Unwinding loop w2c_h_{name} iteration {times} (67 max) file driver.c line 9 thread 0\n")
    });
    let looped = messages.collect::<String>() + DONE;
    assert_eq!(parse_cbmc(&looped).unwrap().unwound, 64);
    assert_eq!(parse_cbmc(DONE).unwrap().unwound, 0);
    let harness = select(&["t_ilk_2".to_owned()]).unwrap()[0];
    assert_eq!(harness.unwind, 65);
    assert_eq!(unwound::beyond(harness, 64), None);
    assert!(unwound::beyond(harness, 65).unwrap().contains("65"));
}

#[test]
fn a_trap_is_not_a_claim() {
    let trapped = DONE.replace("claim 1", "trap: panic");
    assert_eq!(parse_cbmc(&trapped).unwrap().other_failure(), Some("trap: panic"));
}

#[test]
fn every_mutant_changes_the_kernel_in_one_place_and_names_its_harnesses() {
    let all = mutants::list(&root()).unwrap();
    assert!(all.len() >= 40, "only {} mutants", all.len());
    assert!(all.iter().all(|mutant| mutant.find != mutant.replace));
}

/// What is missing costs time, and what is too much would be kept for ever.
#[test]
fn every_mutant_has_a_counterexample_of_each_of_its_harnesses() {
    let all = mutants::list(&root()).unwrap();
    let wanted: BTreeSet<(&str, &str)> = all
        .iter()
        .flat_map(|mutant| mutant.killed_by.iter().map(|name| (mutant.name.as_str(), name.as_str())))
        .collect();
    let recorded = Recorded::read(&root()).unwrap();
    let kept: BTreeSet<_> = recorded.pairs().collect();
    let (missing, left): (Vec<_>, Vec<_>) = (wanted.difference(&kept).collect(), kept.difference(&wanted).collect());
    assert!(missing.is_empty() && left.is_empty(), "missing: {missing:?}, left over: {left:?}: mutants NAME --record");
}

#[test]
fn every_requirement_of_a_harness_has_a_mutant() {
    let all = mutants::list(&root()).unwrap();
    for harness in atc_prover::harnesses() {
        for requirement in harness.requirements {
            let known = all.iter().any(|mutant| mutant.requirements.iter().any(|other| other == requirement));
            assert!(known, "no mutant breaks {requirement}");
        }
    }
}

#[test]
fn the_harnesses_that_are_known_to_be_hard_exist() {
    let names: Vec<String> =
        campaign::HARD.iter().map(|(name, _)| name).chain(&mutants::SLOW).map(|name| (*name).to_owned()).collect();
    select(&names).unwrap();
}

/// Where a size depends on what a harness is compiled for, the bound says the size, and the harness has a control.
#[test]
fn every_harness_that_is_smaller_for_a_wrong_kernel_has_a_control() {
    let folder = root().join("proofs/src/interlocking");
    let mut seen = 0;
    for file in std::fs::read_dir(folder).unwrap() {
        let text = std::fs::read_to_string(file.unwrap().path()).unwrap();
        // The paths of the ATC are as long for a wrong kernel.
        let head = text.lines().take_while(|line| !line.starts_with("harness!"));
        let imports = head.filter(|line| !line.starts_with("use super::line::")).collect::<Vec<_>>().join(" ");
        let own = text.contains("const PATH: usize = if cfg!(kani)");
        let sized = !own && ["PLACES", "{PATH, ", " PATH, ", "super::PATH"].iter().any(|word| imports.contains(word));
        let smaller = text.contains("cfg!(small)")
            || imports.contains("super::scene::")
            || imports.contains("super::forgotten::")
            || text.contains("cfg!(any(small, kani))")
            || sized && text.contains("use super::");
        if !smaller || text.contains("pub const ALL") {
            continue;
        }
        for body in text.split("harness! {").skip(1) {
            let name = body.lines().find_map(|line| line.trim().split_once("(e)")).unwrap().0.to_owned();
            let by_size = ["BOUND", "ALONE", "PAIR", "TRAIN", "BESIDE"]
                .iter()
                .any(|bound| body.contains(&format!("    bound {bound};")));
            assert_eq!(is_smaller(select(std::slice::from_ref(&name)).unwrap()[0]), by_size, "{name}");
            seen += usize::from(by_size);
        }
    }
    assert!(seen >= 16, "only {seen}");
}
