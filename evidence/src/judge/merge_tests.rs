//! Shards that belong together, and those that do not; what is missing, and what contradicts itself.

use super::join;
use crate::case::{Provenance, Severity};
use crate::judge::build::Results;
use crate::judge::scope::{Scope, Shard};
use crate::sources::proofs::Campaigned;
use crate::sources::tests::Run;
use atc_prover::report::{
    Campaign, HarnessResult, MutantResult, MutantVerdict, Mutants, Provenance as Said, SCHEMA, Verdict,
};
use std::collections::BTreeMap;

fn harness(name: &str, verdict: Verdict) -> HarnessResult {
    HarnessResult {
        name: name.to_owned(),
        bound: String::new(),
        engine: "cbmc".to_owned(),
        verdict,
        reason: None,
        seconds: 1.0,
        solver: String::new(),
        claims: vec![],
        covers: vec![],
        counterexample: None,
        unwound: 0,
    }
}

fn mutant(name: &str, verdict: MutantVerdict) -> MutantResult {
    MutantResult {
        name: name.to_owned(),
        what: String::new(),
        requirements: vec![],
        file: String::new(),
        change: [String::new(), String::new()],
        verdict,
        killed_by: vec![],
        reason: None,
        seconds: 1.0,
    }
}

pub(crate) fn shard(
    number: usize,
    of: usize,
    harnesses: &[(&str, Verdict)],
    mutants: &[(&str, MutantVerdict)],
) -> (String, Results) {
    let harnesses = harnesses.iter().map(|(name, verdict)| harness(name, *verdict)).collect();
    let campaign = Campaign { schema: SCHEMA, engine: "cbmc".to_owned(), provenance: Said::default(), harnesses };
    let mutants = mutants.iter().map(|(name, verdict)| mutant(name, *verdict)).collect();
    let provenance = Provenance {
        commit: Some("c".to_owned()),
        dirty: Some(false),
        sources_sha256: "s".to_owned(),
        folders: BTreeMap::from([("kernel".to_owned(), "k".to_owned())]),
        tools: BTreeMap::from([("cbmc".to_owned(), "6".to_owned())]),
        ..Provenance::default()
    };
    let results = Results {
        scope: Scope::Shard(Shard { number, of }),
        running: false,
        joined: vec![],
        campaigns: vec![Campaigned { campaign, source: "run here".to_owned(), stale: false }],
        mutants: Some((Mutants { schema: SCHEMA, provenance: Said::default(), mutants, controls: vec![] }, false)),
        outcomes: vec![],
        no_outcome: "no outcome".to_owned(),
        opinions: vec![],
        measured: None,
        tests: (number == 1).then(|| Run::Ran { suites: vec![], success: true }),
        provenance,
        open: vec![],
        kept_since: None,
        phases: vec![],
    };
    (format!("shard-{number}"), results)
}

fn names(results: &Results) -> Vec<(String, Verdict)> {
    let all = results.campaigns.iter().flat_map(|one| &one.campaign.harnesses);
    all.map(|one| (one.name.clone(), one.verdict)).collect()
}

#[test]
fn shards_are_joined_by_key_in_any_order() {
    let (one, two) = (
        shard(1, 2, &[("a", Verdict::Proved)], &[("m", MutantVerdict::Killed)]),
        shard(2, 2, &[("b", Verdict::Failed)], &[("n", MutantVerdict::Survived)]),
    );
    for order in [vec![one.clone(), two.clone()], vec![two, one]] {
        let joined = join(order).expect("they belong together");
        assert_eq!(names(&joined), [("a".to_owned(), Verdict::Proved), ("b".to_owned(), Verdict::Failed)]);
        assert_eq!(joined.campaigns.len(), 1);
        assert_eq!(joined.mutants.as_ref().map(|(all, _)| all.mutants.len()), Some(2));
        assert!(joined.tests.is_some() && joined.open.is_empty() && joined.scope == Scope::Whole);
        assert_eq!(joined.joined, ["shard 1/2", "shard 2/2"]);
    }
}

#[test]
fn the_worse_of_two_verdicts_counts_and_is_an_open_item() {
    for swap in [false, true] {
        let mut all = vec![
            shard(1, 2, &[("a", Verdict::Proved)], &[("m", MutantVerdict::Killed)]),
            shard(2, 2, &[("a", Verdict::Failed)], &[("m", MutantVerdict::Survived)]),
        ];
        if swap {
            let (first, second) = all.split_at_mut(1);
            std::mem::swap(&mut first[0].1.campaigns, &mut second[0].1.campaigns);
            std::mem::swap(&mut first[0].1.mutants, &mut second[0].1.mutants);
        }
        let joined = join(all).expect("they belong together");
        assert_eq!(names(&joined), [("a".to_owned(), Verdict::Failed)]);
        let mutants = joined.mutants.expect("some").0.mutants;
        assert!(mutants.len() == 1 && mutants[0].verdict == MutantVerdict::Survived);
        let about: Vec<_> = joined.open.iter().map(|item| item.about.as_str()).collect();
        assert_eq!(about, ["harness:a, cbmc", "mutant:m"]);
        assert!(
            joined
                .open
                .iter()
                .all(|item| item.severity == Severity::Open && item.text.contains("shard 1/2 and shard 2/2"))
        );
    }
    let same = join(vec![shard(1, 2, &[("a", Verdict::Proved)], &[]), shard(2, 2, &[("a", Verdict::Proved)], &[])]);
    let same = same.expect("they agree");
    assert!(names(&same).len() == 1 && same.open.is_empty());
}

#[test]
fn a_missing_shard_is_named() {
    let joined = join(vec![shard(1, 3, &[], &[]), shard(3, 3, &[], &[])]).expect("they belong together");
    assert!(joined.open.len() == 1 && joined.open[0].about == "shard 2/3", "{:?}", joined.open);
    assert!(joined.open[0].text.contains("not run"));
}

/// Where the tests alone are as much as a shard, it has the machine's compiler, and no provers' one.
#[test]
fn a_shard_that_proves_nothing_has_no_compiler_of_provers() {
    let with = |number: usize, rustc: &str| {
        let mut one = shard(number, 3, &[("t_acc_1", Verdict::Proved)], &[]);
        one.1.provenance.tools.insert("rustc".to_owned(), rustc.to_owned());
        one
    };
    let mut tests = with(1, "1.95");
    (tests.1.campaigns, tests.1.mutants) = (vec![], None);
    let joined = join(vec![tests.clone(), with(2, "1.85"), with(3, "1.85")]).expect("they belong together");
    assert_eq!(joined.provenance.tools["rustc"], "1.85");
    // Of those that prove each is held against the others.
    let faults = join(vec![tests, with(2, "1.85"), with(3, "1.86")]).expect_err("two compilers");
    assert_eq!(faults.len(), 1);
    assert!(faults[0].to_string().contains("rustc is 1.86, and another version in shard-2"), "{}", faults[0]);
}

#[test]
fn what_does_not_belong_together_is_refused() {
    let refused = |change: &dyn Fn(&mut Results), words: &[&str]| {
        let mut other = shard(2, 2, &[], &[]);
        change(&mut other.1);
        let faults = join(vec![shard(1, 2, &[], &[]), other]).expect_err("refused");
        let text = faults.iter().map(ToString::to_string).collect::<Vec<_>>().join("\n");
        assert!(words.iter().all(|word| text.contains(word)) && text.contains("shard-2: "), "{text}");
    };
    refused(&|run| run.provenance.commit = Some("d".to_owned()), &["of commit d, and shard-1 of c", "on one commit"]);
    refused(&|run| run.provenance.sources_sha256 = "t".to_owned(), &["what the provers see is not", "same sources"]);
    refused(&|run| run.provenance.cargo_lock_sha256 = "l".to_owned(), &["Cargo.lock is not what it is in shard-1"]);
    refused(&|run| drop(run.provenance.folders.insert("kernel".to_owned(), "x".to_owned())), &["kernel is not"]);
    refused(&|run| drop(run.provenance.tools.insert("cbmc".to_owned(), "5".to_owned())), &["cbmc is 5"]);
    refused(&|run| run.scope = Scope::Shard(Shard { number: 2, of: 3 }), &["one of 3 shards, and shard-1 is one of 2"]);
    refused(&|run| run.scope = Scope::Part("aspect".to_owned()), &["a run of the part aspect", "only shards"]);
    refused(&|run| run.running = true, &["has not ended"]);
    assert!(join(vec![]).is_err());
}
