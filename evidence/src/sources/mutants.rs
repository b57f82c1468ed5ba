//! Named wrong kernels, and what rejects them.

use crate::case::{Evidence, Kind};
use crate::error::{Fault, read};
use crate::judge::verdict::Verdict;
use atc_prover::report::{Kill, MutantResult, MutantVerdict, Mutants};
use std::path::Path;

/// What a wrong kernel is, apart from any result.
#[derive(Clone, Debug)]
pub struct MutantInfo {
    /// Its name.
    pub name: String,
    /// What is wrong with it.
    pub what: String,
    /// The requirements that it breaks.
    pub requirements: Vec<String>,
    /// The place of the text that it changes: `kernel/src/….rs:12`, or below `arithmetic/src`.
    pub at: Option<String>,
    /// That text.
    pub find: String,
    /// The harnesses that are to reject it.
    pub killers: Vec<String>,
}

/// The wrong kernels of `proofs/mutants.toml`, in its order.
///
/// # Errors
/// The file is missing or wrong: a text that does not stand in the kernel exactly once, a harness that is not there.
pub fn catalogue(root: &Path) -> Result<Vec<MutantInfo>, Fault> {
    let all = atc_prover::mutants::list(root).map_err(|error| Fault::new(&"wrong kernels", error))?;
    let one = |mutant: atc_prover::mutants::Mutant| {
        let file = mutant.path();
        let text = read(&root.join(&file))?;
        let line = text.find(&mutant.find).map(|place| text[..place].matches('\n').count() + 1);
        Ok(MutantInfo {
            name: mutant.name,
            what: mutant.what,
            requirements: mutant.requirements,
            at: line.map(|line| format!("{file}:{line}")),
            find: mutant.find,
            killers: mutant.killed_by,
        })
    };
    all.into_iter().map(one).collect()
}

/// The evidence of every wrong kernel. `stale`: the results belong to other sources.
pub fn evidence(catalogue: &[MutantInfo], results: Option<&Mutants>, stale: bool) -> Vec<Evidence> {
    catalogue
        .iter()
        .map(|mutant| {
            let mine: Vec<_> =
                results.iter().flat_map(|all| &all.mutants).filter(|result| result.name == mutant.name).collect();
            let (mut verdict, mut reason) = match mine[..] {
                [] => (Verdict::NotRun, Some("not run".to_owned())),
                [result] => judge(result),
                _ => (Verdict::Undecided, Some("more than one result".to_owned())),
            };
            if stale && verdict < Verdict::Stale {
                (verdict, reason) = (Verdict::Stale, Some("the result belongs to other sources".to_owned()));
            }
            let result = mine.first();
            let killers = result.map(|result| result.killed_by.as_slice()).unwrap_or_default();
            Evidence {
                statement: mutant.what.clone(),
                at: mutant.at.clone(),
                detail: match verdict {
                    Verdict::Tested => killed(killers),
                    Verdict::Failed => "survived".to_owned(),
                    _ => String::new(),
                },
                reason,
                requirements: mutant.requirements.clone(),
                killed_by: killers
                    .iter()
                    .map(|killer| match killer.claims.len() {
                        0 => killer.harness.clone(),
                        _ => format!("{} ({})", killer.harness, killer.claims.join(", ")),
                    })
                    .collect(),
                seconds: result.map_or(0.0, |result| result.seconds),
                ..Evidence::bare(Kind::Mutant, &mutant.name, verdict)
            }
        })
        .collect()
}

/// What shows that a mutant is killed: counterexamples that are kept, or found anew in this run by the prover.
fn killed(killers: &[Kill]) -> String {
    let asked: Vec<_> = killers.iter().filter(|kill| kill.asked).map(|kill| kill.harness.as_str()).collect();
    if asked.is_empty() {
        "killed".to_owned()
    } else {
        format!("killed; the prover was asked, too: {}", asked.join(", "))
    }
}

/// A harness that is not proved of the right kernel shows nothing by rejecting a wrong one. Of those that are `pending`, in
/// another shard or later in this run, nothing is known yet: nor of what they reject.
pub fn only_by_what_holds(mutants: &mut [Evidence], harnesses: &[Evidence], pending: &dyn Fn(&str) -> bool) {
    for one in mutants.iter_mut().filter(|one| one.verdict == Verdict::Tested) {
        let broken = |name: &&str| {
            let harness = harnesses.iter().find(|harness| harness.id == format!("harness:{name}"));
            harness.is_none_or(|harness| harness.verdict > Verdict::ProvedBounded)
        };
        let broken: Option<String> = killers(one).find(|name| broken(name)).map(ToOwned::to_owned);
        if let Some(name) = broken {
            let not_run =
                harnesses.iter().any(|one| one.id == format!("harness:{name}") && one.verdict <= Verdict::NotRun);
            if not_run && pending(&name) {
                one.verdict = Verdict::NotRun;
                one.reason = Some("the proof of what rejects it is not here yet".to_owned());
                one.left_out = true;
            } else {
                one.verdict = Verdict::Undecided;
                one.reason = Some(format!("{name} rejects it, and is not proved of the right kernel"));
            }
        }
    }
}

fn judge(result: &MutantResult) -> (Verdict, Option<String>) {
    let given = result.reason.clone().unwrap_or_else(|| "no reason given".to_owned());
    match result.verdict {
        MutantVerdict::Killed if result.killed_by.is_empty() => {
            (Verdict::Undecided, Some("killed, but by nothing".to_owned()))
        }
        MutantVerdict::Killed => (Verdict::Tested, None),
        MutantVerdict::Survived => (Verdict::Failed, Some("no theorem noticed it".to_owned())),
        MutantVerdict::NotRun => (Verdict::NotRun, Some(given)),
        MutantVerdict::Error => (Verdict::Undecided, Some(given)),
    }
}

/// The harnesses that reject a mutant, from the evidence's own words.
pub fn killers(evidence: &Evidence) -> impl Iterator<Item = &str> {
    evidence.killed_by.iter().filter_map(|killer| killer.split(' ').next())
}

#[cfg(test)]
mod tests {
    use super::{Kill, MutantInfo, evidence, killed, only_by_what_holds};
    use crate::case::{Evidence, Kind};
    use crate::judge::verdict::Verdict;
    use atc_prover::report::{MutantResult, MutantVerdict, Mutants, Provenance, SCHEMA};

    fn kill(harness: &str, asked: bool) -> Kill {
        Kill { harness: harness.to_owned(), claims: vec![], case: 0, counterexample: None, asked }
    }

    #[test]
    fn what_the_prover_was_asked_is_told() {
        assert_eq!(killed(&[kill("t", false), kill("u", false)]), "killed");
        assert_eq!(killed(&[kill("t", false), kill("u", true)]), "killed; the prover was asked, too: u");
    }

    fn verdict(word: MutantVerdict, killed: bool, stale: bool) -> Verdict {
        let (name, what) = ("m".to_owned(), "w".to_owned());
        let catalogue = MutantInfo { name, what, requirements: vec![], at: None, find: String::new(), killers: vec![] };
        let killer = kill("t", false);
        let result = MutantResult {
            name: "m".to_owned(),
            what: "w".to_owned(),
            requirements: vec![],
            file: String::new(),
            change: [String::new(), String::new()],
            verdict: word,
            killed_by: if killed { vec![killer] } else { vec![] },
            reason: None,
            seconds: 0.0,
        };
        let provenance = Provenance { aspects: 4, ..Provenance::default() };
        let mutants = Mutants { schema: SCHEMA, provenance, mutants: vec![result], controls: Vec::new() };
        evidence(&[catalogue], Some(&mutants), stale)[0].verdict
    }

    #[test]
    fn a_mutant_is_killed_only_by_something() {
        use MutantVerdict::{Error, Killed, Survived};
        assert_eq!(verdict(Killed, true, false), Verdict::Tested);
        assert_eq!(verdict(Killed, false, false), Verdict::Undecided);
        assert_eq!(verdict(Survived, false, false), Verdict::Failed);
        assert_eq!(verdict(Error, true, false), Verdict::Undecided);
        assert_eq!(verdict(Killed, true, true), Verdict::Stale);
        assert_eq!(verdict(Survived, false, true), Verdict::Failed);
    }
    #[test]
    fn a_harness_that_is_not_proved_rejects_nothing() {
        let judged = |harnesses: &[Evidence], pending: bool| {
            let killed_by = vec!["t (Claim)".to_owned()];
            let mut mutants = [Evidence { killed_by, ..Evidence::bare(Kind::Mutant, "m", Verdict::Tested) }];
            only_by_what_holds(&mut mutants, harnesses, &|_| pending);
            mutants[0].verdict
        };
        let after = |harnesses: &[Evidence]| judged(harnesses, false);
        let harness = |verdict| [Evidence::bare(Kind::Harness, "t", verdict)];
        assert_eq!(after(&harness(Verdict::ProvedBounded)), Verdict::Tested);
        for bad in [Verdict::Failed, Verdict::Vacuous, Verdict::Undecided, Verdict::NotRun, Verdict::Tested] {
            assert_eq!(after(&harness(bad)), Verdict::Undecided);
        }
        assert_eq!(after(&[]), Verdict::Undecided);
        // What is still to come excuses nothing that is there.
        assert_eq!(judged(&harness(Verdict::NotRun), true), Verdict::NotRun);
        assert_eq!(judged(&harness(Verdict::Tested), true), Verdict::NotRun);
        assert_eq!(judged(&harness(Verdict::Proved), true), Verdict::Tested);
        for bad in [Verdict::Failed, Verdict::Vacuous, Verdict::Undecided, Verdict::Stale] {
            assert_eq!(judged(&harness(bad), true), Verdict::Undecided);
        }
        assert_eq!(judged(&[], true), Verdict::Undecided);
    }
}
