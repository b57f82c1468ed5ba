//! Each way in which a result could look better than it is, made on purpose.

use super::{Campaigned, HarnessInfo, catalogue, evidence};
use crate::judge::verdict::Verdict;
use atc_prover::report::{Campaign, ClaimResult, CoverResult, HarnessResult, Provenance, SCHEMA, Verdict as Said};

fn harness() -> HarnessInfo {
    HarnessInfo {
        name: "t".to_owned(),
        theorem: "T".to_owned(),
        statement: "It holds.".to_owned(),
        requirements: vec!["ACC-1".to_owned()],
        assumptions: vec![],
        bound: String::new(),
        claims: vec![("A".to_owned(), "a".to_owned()), ("B".to_owned(), "b".to_owned())],
        covers: vec![("C".to_owned(), "c".to_owned())],
        at: None,
    }
}

fn point(name: &str) -> ClaimResult {
    ClaimResult { name: name.to_owned(), verdict: Said::Proved }
}

fn good() -> HarnessResult {
    HarnessResult {
        name: "t".to_owned(),
        bound: String::new(),
        engine: "cbmc".to_owned(),
        verdict: Said::Proved,
        reason: None,
        seconds: 1.0,
        solver: String::new(),
        unwound: 0,
        claims: vec![point("A"), point("B")],
        covers: vec![CoverResult { name: "C".to_owned(), hit: true }],
        counterexample: None,
    }
}

fn provenance() -> Provenance {
    Provenance { aspects: 4, ..Provenance::default() }
}

fn campaign(engine: &str, results: Vec<HarnessResult>) -> Campaigned {
    let campaign = Campaign { schema: SCHEMA, engine: engine.to_owned(), provenance: provenance(), harnesses: results };
    Campaigned { campaign, source: "run".to_owned(), stale: false }
}

fn verdict(result: HarnessResult) -> Verdict {
    evidence(&[harness()], &[campaign("cbmc", vec![result])]).0[0].verdict
}

#[test]
fn a_clean_result_is_proved_and_a_bound_is_kept_with_it() {
    assert_eq!(verdict(good()), Verdict::Proved);
    assert_eq!(verdict(HarnessResult { bound: "4 aspects".to_owned(), ..good() }), Verdict::ProvedBounded);
}

#[test]
fn a_claim_without_its_own_verdict_is_not_credited() {
    let mut result = good();
    result.claims.pop();
    assert_eq!(verdict(result), Verdict::Undecided);
}

#[test]
fn a_claim_twice_is_not_credited() {
    let mut result = good();
    result.claims.push(result.claims[0].clone());
    assert_eq!(verdict(result), Verdict::Undecided);
}

#[test]
fn a_result_of_another_harness_text_is_stale() {
    let mut result = good();
    result.claims.push(point("Old"));
    assert_eq!(verdict(result), Verdict::Stale);
}

#[test]
fn a_clean_word_over_a_failed_claim_is_failed() {
    let mut result = good();
    result.claims[1].verdict = Said::Failed;
    assert_eq!(verdict(result), Verdict::Failed);
    assert_eq!(verdict(HarnessResult { counterexample: Some(vec![1]), ..good() }), Verdict::Failed);
}

#[test]
fn a_cover_point_that_is_missed_or_missing_is_no_proof() {
    let mut result = good();
    result.covers[0].hit = false;
    assert_eq!(verdict(result), Verdict::Vacuous);
    assert_eq!(verdict(HarnessResult { covers: vec![], ..good() }), Verdict::Undecided);
    let mut result = good();
    result.claims[0].verdict = Said::Vacuous;
    assert_eq!(verdict(result), Verdict::Vacuous);
}

#[test]
fn a_killed_prover_is_no_result() {
    for word in [Said::Error, Said::Timeout] {
        let result = HarnessResult { verdict: word, reason: Some("killed".to_owned()), ..good() };
        assert_eq!(verdict(result), Verdict::Undecided, "{word:?}");
    }
    // Nor is it vacuous: what was not reached before it was killed may be reachable.
    let mut late = HarnessResult { verdict: Said::Timeout, reason: Some("600 s".to_owned()), ..good() };
    late.covers[0].hit = false;
    let (all, _) = evidence(&[harness()], &[campaign("cbmc", vec![late])]);
    assert_eq!((all[0].verdict, all[0].covers[0].hit), (Verdict::Undecided, None));
    assert_eq!(all[0].reason.as_deref(), Some("cbmc: time limit: 600 s"));
    // A word that is not known is refused when a report is read.
    let json = serde_json::to_value(good()).map(|mut value| {
        value["verdict"] = "PROVED".into();
        value
    });
    assert!(json.and_then(serde_json::from_value::<HarnessResult>).is_err());
}

#[test]
fn a_missing_result_is_not_run_and_a_filter_that_matches_nothing_proves_nothing() {
    let (all, engines) = evidence(&[harness()], &[campaign("cbmc", vec![])]);
    assert_eq!(all[0].verdict, Verdict::NotRun);
    assert_eq!(engines[0].verdict, Verdict::NotRun);
    assert_eq!(engines[0].summary, "0 of 1 harnesses proved (run)");
}

#[test]
fn two_results_for_one_harness_are_none() {
    let (all, _) = evidence(&[harness()], &[campaign("cbmc", vec![good(), good()])]);
    assert_eq!(all[0].verdict, Verdict::Undecided);
}

/// Whichever ran first, and whichever shard had nothing for one of them.
#[test]
fn engines_stand_in_one_order() {
    let all = [campaign("native", vec![good()]), campaign("cbmc", vec![good()])];
    let of = |campaigns: &[Campaigned]| -> Vec<String> {
        let (evidence, _) = evidence(&[harness()], campaigns);
        evidence[0].engines.iter().map(|engine| engine.engine.clone()).collect()
    };
    let [first, second] = all.clone();
    assert_eq!(of(&all), of(&[second, first]));
    assert_eq!(of(&all).len(), 2);
}

#[test]
fn a_tester_cannot_prove() {
    let (all, _) = evidence(&[harness()], &[campaign("native", vec![good()])]);
    assert_eq!(all[0].verdict, Verdict::Undecided);
}

#[test]
fn stale_results_stay_stale_and_a_refutation_is_never_outvoted() {
    let mut old = campaign("cbmc", vec![good()]);
    old.stale = true;
    let (all, _) = evidence(&[harness()], &[old.clone()]);
    assert_eq!(all[0].verdict, Verdict::Stale);
    assert!(all[0].claims.iter().all(|claim| claim.verdict == Verdict::Stale));
    let bad = HarnessResult { verdict: Said::Failed, ..good() };
    let (all, _) = evidence(&[harness()], &[campaign("cbmc", vec![good()]), campaign("kani", vec![bad])]);
    assert_eq!(all[0].verdict, Verdict::Failed);
}

/// The algebra may refute a theorem, and never takes the place of a proof of the code.
#[test]
fn what_is_proved_of_no_code_stands_beside() {
    let bounded = HarnessResult { bound: "4 aspects".to_owned(), ..good() };
    let of = |campaigns: &[Campaigned]| evidence(&[harness()], campaigns).0.remove(0);
    let both = of(&[campaign("cbmc", vec![bounded.clone()]), campaign("reals", vec![good()])]);
    assert_eq!((both.verdict, both.engines[1].verdict), (Verdict::ProvedBounded, Verdict::Proved));
    assert_eq!(of(&[campaign("reals", vec![good()])]).verdict, Verdict::NotRun);
    let wrong = HarnessResult { verdict: Said::Failed, ..good() };
    assert_eq!(of(&[campaign("cbmc", vec![bounded]), campaign("reals", vec![wrong])]).verdict, Verdict::Failed);
}

#[test]
fn the_real_catalogue_has_unique_names_and_no_empty_harness() {
    let all = catalogue();
    let names: std::collections::BTreeSet<_> = all.iter().map(|harness| harness.name.clone()).collect();
    assert_eq!(names.len(), all.len());
    assert!(all.iter().all(|one| !one.claims.is_empty() && !one.covers.is_empty() && !one.requirements.is_empty()));
}

#[test]
fn what_a_tester_misses_is_no_proof_that_it_cannot_be_reached() {
    let mut missed = good();
    missed.verdict = Said::Vacuous;
    missed.covers[0].hit = false;
    for claim in &mut missed.claims {
        claim.verdict = Said::Tested;
    }
    let (alone, engines) = evidence(&[harness()], &[campaign("native", vec![missed.clone()])]);
    assert_eq!((alone[0].verdict, engines[3].verdict), (Verdict::Tested, Verdict::Tested));
    assert!(alone[0].reason.as_ref().is_some_and(|reason| reason.contains("miss C")), "{:?}", alone[0].reason);
    // A claim that no value reached was not tested.
    let mut idle = missed.clone();
    idle.claims[0].verdict = Said::Vacuous;
    assert_eq!(evidence(&[harness()], &[campaign("native", vec![idle])]).0[0].verdict, Verdict::NotRun);
    let (both, _) = evidence(&[harness()], &[campaign("native", vec![missed]), campaign("cbmc", vec![good()])]);
    assert_eq!(both[0].verdict, Verdict::Proved);
    let refuted = HarnessResult { verdict: Said::Failed, counterexample: Some(vec![3]), ..good() };
    let (both, _) = evidence(&[harness()], &[campaign("native", vec![refuted]), campaign("cbmc", vec![good()])]);
    assert_eq!((both[0].verdict, both[0].counterexample.clone()), (Verdict::Failed, Some(vec![3])));
}

#[test]
fn a_harness_stands_where_it_says() {
    let root = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
    for harness in catalogue() {
        let at = harness.at.expect("a place");
        let (file, line) = at.rsplit_once(':').expect("file and line");
        let source = std::fs::read_to_string(root.join(file)).unwrap_or_else(|error| panic!("{file}: {error}"));
        let mut lines = source.lines().skip(line.parse::<usize>().expect("a line") - 1);
        assert_eq!(lines.next(), Some("harness! {"), "{at}");
        let name = lines.map(str::trim).find(|line| !line.starts_with("///")).expect("a name");
        assert!(name.starts_with(&format!("{}(", harness.name)), "{at}: {name}");
    }
}
