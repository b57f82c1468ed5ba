//! Theorems: what the harnesses are, and what the engines say of them.
//!
//! A result is credited with nothing that it does not show itself: every claim that the harness has must be in the
//! result with its own verdict, every cover point must be hit, and a word that is not known counts as no result.

use super::owned;
use crate::case::{Claim, Cover, Engine, EngineResult, Evidence, Kind};

use crate::judge::verdict::Verdict;
use atc_prover::reals;
use atc_prover::report::{Campaign, HarnessResult, Verdict as Said};
use serde::{Deserialize, Serialize};

/// What a harness is, apart from any result.
#[derive(Clone, Debug)]
pub struct HarnessInfo {
    /// The harness's name.
    pub name: String,
    /// The theorem's name.
    pub theorem: String,
    /// The theorem in plain English.
    pub statement: String,
    /// The requirements that it proves.
    pub requirements: Vec<String>,
    /// The ids of what it assumes.
    pub assumptions: Vec<String>,
    /// Its bound in words; empty if there is none.
    pub bound: String,
    /// Its claims: name and text.
    pub claims: Vec<(String, String)>,
    /// Its cover points: name and text.
    pub covers: Vec<(String, String)>,
    /// `proofs/src/….rs:12`, if it is known.
    pub at: Option<String>,
}

/// The harnesses of `atc-proofs`, in its order.
pub fn catalogue() -> Vec<HarnessInfo> {
    let points = |points: &[atc_proofs::Point]| {
        points.iter().map(|point| (point.name.to_owned(), point.text.to_owned())).collect()
    };
    atc_proofs::HARNESSES
        .iter()
        .copied()
        .flatten()
        .map(|harness| HarnessInfo {
            name: harness.name.to_owned(),
            theorem: harness.theorem.to_owned(),
            statement: harness.statement.trim().to_owned(),
            requirements: owned(harness.requirements),
            assumptions: owned(harness.assumptions),
            bound: harness.bound.to_owned(),
            claims: points(harness.claims),
            covers: points(harness.covers),
            at: Some(format!("{}:{}", harness.file.replace('\\', "/"), harness.line)),
        })
        .collect()
}

/// One engine's campaign, and whether it belongs to these sources.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Campaigned {
    /// The results.
    pub campaign: Campaign,
    /// Where it comes from: a run, or a file.
    pub source: String,
    /// Whether its sources are not these.
    pub stale: bool,
}

/// The engines that may take part: name, what it looks at, whether it proves, and the command that runs it.
pub const ENGINES: &[(&str, &str, bool, &str)] = &[
    (
        "cbmc",
        "the compiled, optimised code (Rust to WebAssembly to C), bit by bit",
        true,
        "ci/install-provers && cargo run --release -p atc-prover -- prove",
    ),
    (
        "kani",
        "the compiler's intermediate form (MIR), bit by bit",
        true,
        "cargo kani -p atc-proofs -Z function-contracts -Z unstable-options --export-json target/kani.json \
         && cargo run -p atc-proofs -- kani import target/kani.json, then --import target/proofs/kani.json",
    ),
    (
        "creusot",
        "the contracts of the arithmetic, over all numbers; for Creusot 0.11, Why3 1.8.2, Z3 4.13.3, cvc5 1.3.2",
        true,
        "cargo update -p creusot-std --precise 0.11.0 && cargo creusot prove",
    ),
    (
        "native",
        "the machine code of this computer, on chosen values: tests, no proof",
        false,
        "cargo run --release -p atc-prover -- prove --engine native",
    ),
    (
        "reals",
        "the algebra of a train's motion, over all real numbers, by Z3: theorems of no code",
        true,
        "ci/install-provers && cargo run -p atc-prover -- prove --engine reals",
    ),
];

/// The evidence of every harness, and for every engine how far it went.
pub fn evidence(harnesses: &[HarnessInfo], campaigns: &[Campaigned]) -> (Vec<Evidence>, Vec<Engine>) {
    // In the order of the table above, whichever ran first.
    let place = |run: &&Campaigned| ENGINES.iter().position(|(name, ..)| *name == run.campaign.engine);
    let mut campaigns: Vec<&Campaigned> = campaigns.iter().collect();
    campaigns.sort_by_key(|run| place(run).unwrap_or(usize::MAX));
    let evidence = harnesses.iter().map(|harness| one(harness, &campaigns)).collect();
    let engines = ENGINES
        .iter()
        .map(|(name, what, proves, command)| {
            let mine: Vec<_> = campaigns.iter().filter(|run| run.campaign.engine == *name).collect();
            let asked: Vec<_> =
                harnesses.iter().filter(|harness| mine.iter().any(|run| is_asked(harness, run))).collect();
            let verdicts: Vec<_> = asked
                .iter()
                .filter_map(|harness| mine.iter().map(|run| judge(harness, run).verdict).min())
                .filter(|_| !mine.is_empty())
                .collect();
            let held = verdicts.iter().filter(|verdict| verdict.holds()).count();
            let word = if *proves { "proved" } else { "tested" };
            let source = mine.iter().map(|run| run.source.clone()).collect::<Vec<_>>().join(", ");
            Engine {
                name: (*name).to_owned(),
                what: (*what).to_owned(),
                verdict: Verdict::worst(verdicts).unwrap_or(Verdict::NotRun),
                summary: if mine.is_empty() {
                    "no result".to_owned()
                } else {
                    format!("{held} of {} harnesses {word} ({source})", asked.len())
                },
                command: (*command).to_owned(),
            }
        })
        .collect();
    (evidence, engines)
}

/// Whether the engine has anything to say of the harness: the algebra is of a few.
fn is_asked(harness: &HarnessInfo, run: &Campaigned) -> bool {
    run.campaign.engine != reals::ENGINE || run.campaign.harnesses.iter().any(|result| result.name == harness.name)
}

/// The evidence of one harness: the best result of any engine that looks at the code, unless one of them refutes it. The algebra is of no code: what it
/// proves stands beside, and makes no bound of the code's proof go away.
fn one(harness: &HarnessInfo, campaigns: &[&Campaigned]) -> Evidence {
    let asked = campaigns.iter().copied().filter(|run| is_asked(harness, run));
    let judged: Vec<_> = asked.map(|run| (run, judge(harness, run))).collect();
    let refuted = judged.iter().filter(|(_, one)| matches!(one.verdict, Verdict::Failed | Verdict::Vacuous));
    // "Undecided" is worse than "not run" in the order, and must not hide behind it: take it if nothing holds.
    let of_code = |run: &Campaigned| run.campaign.engine != reals::ENGINE;
    let best =
        judged.iter().filter(|(run, one)| of_code(run) && one.verdict.holds()).min_by_key(|(_, one)| one.verdict);
    let worst = judged.iter().filter(|(run, _)| of_code(run)).max_by_key(|(_, one)| one.verdict);
    let chosen = refuted.max_by_key(|(_, one)| one.verdict).or(best).or(worst);
    let none = || Judged::nothing(harness, Verdict::NotRun, "no engine has run it");
    let (engine, judgement) = chosen.map_or_else(|| ("", none()), |(run, one)| (&run.campaign.engine, one.clone()));
    Evidence {
        id: format!("harness:{}", harness.name),
        kind: Kind::Harness,
        title: format!("{} ({})", harness.theorem, harness.name),
        statement: harness.statement.clone(),
        at: harness.at.clone(),
        verdict: judgement.verdict,
        detail: if judgement.bound.is_empty() { engine.to_owned() } else { judgement.bound },
        left_out: false,
        reason: judgement.reason,
        requirements: harness.requirements.clone(),
        assumptions: harness.assumptions.clone(),
        claims: judgement.claims,
        covers: judgement.covers,
        engines: judged
            .into_iter()
            .map(|(run, one)| EngineResult {
                engine: run.campaign.engine.clone(),
                verdict: one.verdict,
                note: one.reason.unwrap_or_default(),
                seconds: one.seconds,
            })
            .collect(),
        killed_by: Vec::new(),
        seconds: judgement.seconds,
        counterexample: judgement.counterexample,
    }
}

/// What one engine's result on one harness is worth.
#[derive(Clone)]
struct Judged {
    verdict: Verdict,
    reason: Option<String>,
    bound: String,
    seconds: f64,
    claims: Vec<Claim>,
    covers: Vec<Cover>,
    counterexample: Option<Vec<u16>>,
}

impl Judged {
    fn nothing(harness: &HarnessInfo, verdict: Verdict, reason: &str) -> Self {
        let claim = |(name, text): &(String, String)| Claim { name: name.clone(), text: text.clone(), verdict };
        let cover = |(name, text): &(String, String)| Cover { name: name.clone(), text: text.clone(), hit: None };
        Self {
            verdict,
            reason: Some(reason.to_owned()),
            bound: harness.bound.clone(),
            seconds: 0.0,
            claims: harness.claims.iter().map(claim).collect(),
            covers: harness.covers.iter().map(cover).collect(),
            counterexample: None,
        }
    }
}

fn judge(harness: &HarnessInfo, run: &Campaigned) -> Judged {
    let engine = run.campaign.engine.as_str();
    let results: Vec<_> = run.campaign.harnesses.iter().filter(|result| result.name == harness.name).collect();
    let result = match results[..] {
        [] => return Judged::nothing(harness, Verdict::NotRun, &format!("{engine}: no result for this harness")),
        [result] => result,
        _ => return Judged::nothing(harness, Verdict::Undecided, &format!("{engine}: more than one result")),
    };
    let proves = proves(engine);
    let (holds, word) = match (result.verdict, proves) {
        (Said::Proved, true) if result.bound.is_empty() => (Verdict::Proved, Said::Proved),
        (Said::Proved, true) => (Verdict::ProvedBounded, Said::Proved),
        (Said::Tested, _) | (Said::Vacuous, false) => (Verdict::Tested, Said::Tested),
        _ => (Verdict::Undecided, Said::Error),
    };
    let claims: Vec<_> = harness.claims.iter().map(|point| claim(point, result, holds, word, !proves)).collect();
    // Without an answer nothing is known of a cover point, whatever the report has in its place.
    let answered = !matches!(result.verdict, Said::NotRun | Said::Timeout | Said::Error);
    let covers: Vec<_> = harness
        .covers
        .iter()
        .map(|(name, text)| {
            let found = result.covers.iter().find(|cover| cover.name == *name);
            Cover { name: name.clone(), text: text.clone(), hit: found.filter(|_| answered).map(|cover| cover.hit) }
        })
        .collect();
    let (mut verdict, mut reason) = overall(harness, result, engine, holds, &claims, &covers);
    if run.stale && verdict < Verdict::Stale {
        verdict = Verdict::Stale;
        reason = Some(format!("{engine}: the result belongs to other sources of kernel and proofs than these"));
    }
    Judged {
        verdict,
        reason,
        bound: result.bound.clone(),
        seconds: result.seconds,
        claims: claims.into_iter().map(|one| Claim { verdict: one.verdict.max(stale(run)), ..one }).collect(),
        covers,
        counterexample: result.counterexample.clone(),
    }
}

/// Whether this engine proves; the others test.
fn proves(engine: &str) -> bool {
    ENGINES.iter().any(|(name, _, proves, _)| *name == engine && *proves)
}

fn stale(run: &Campaigned) -> Verdict {
    if run.stale { Verdict::Stale } else { Verdict::Proved }
}

fn claim((name, text): &(String, String), result: &HarnessResult, holds: Verdict, word: Said, tester: bool) -> Claim {
    let found: Vec<_> = result.claims.iter().filter(|claim| claim.name == *name).collect();
    let verdict = match found[..] {
        [claim] => match claim.verdict {
            Said::Failed => Verdict::Failed,
            Said::Vacuous if tester => Verdict::NotRun,
            Said::Vacuous => Verdict::Vacuous,
            Said::NotRun => Verdict::NotRun,
            known if word != Said::Error && known == word => holds,
            _ => Verdict::Undecided,
        },
        [] if result.verdict == Said::NotRun => Verdict::NotRun,
        _ => Verdict::Undecided,
    };
    Claim { name: name.clone(), text: text.clone(), verdict }
}

/// The verdict of the whole result: what it says, unless a part of it says worse.
fn overall(
    harness: &HarnessInfo,
    result: &HarnessResult,
    engine: &str,
    holds: Verdict,
    claims: &[Claim],
    covers: &[Cover],
) -> (Verdict, Option<String>) {
    let given = || result.reason.clone().unwrap_or_else(|| "no reason given".to_owned());
    let because = |text: String| Some(format!("{engine}: {text}"));
    let said = match result.verdict {
        Said::Proved | Said::Tested if holds.holds() => (holds, None),
        Said::Proved | Said::Tested => {
            (Verdict::Undecided, because(format!("this engine cannot say \"{}\"", result.verdict.as_str())))
        }
        Said::Failed => (Verdict::Failed, because(failed(claims, result))),
        // A tester draws some values; what they do not reach may still be reached. The claims tell what was tested.
        Said::Vacuous if !proves(engine) => (Verdict::Tested, because(given())),
        Said::Vacuous => (Verdict::Vacuous, because(given())),
        Said::NotRun => return (Verdict::NotRun, because(given())),
        Said::Timeout => (Verdict::Undecided, because(format!("time limit: {}", given()))),
        Said::Error => (Verdict::Undecided, because(format!("no result: {}", given()))),
    };
    let mut worst = said;
    let mut missed = Vec::new();
    let mut take = |verdict: Verdict, text: String| {
        if verdict > worst.0 {
            worst = (verdict, because(text));
        }
    };
    for one in claims {
        take(one.verdict, format!("claim {} is {}", one.name, one.verdict));
    }
    for one in covers {
        match one.hit {
            Some(true) => {}
            Some(false) if !proves(engine) => {
                missed.push(one.name.as_str());
            }
            Some(false) => take(Verdict::Vacuous, format!("cover point {} is not reached", one.name)),
            None => take(Verdict::Undecided, format!("no word on cover point {}", one.name)),
        }
    }
    let unknown = result.claims.iter().find(|one| !harness.claims.iter().any(|(name, _)| *name == one.name));
    if let Some(unknown) = unknown {
        take(Verdict::Stale, format!("the result has a claim {} that the harness does not have", unknown.name));
    }
    if harness.claims.is_empty() {
        take(Verdict::Vacuous, "the harness claims nothing".to_owned());
    }
    if result.counterexample.is_some() {
        take(Verdict::Failed, "the result has a counterexample".to_owned());
    }
    if worst.0.holds() && !missed.is_empty() {
        worst.1 = because(format!("the values that were drawn miss {}", missed.join(", ")));
    }
    worst
}

fn failed(claims: &[Claim], result: &HarnessResult) -> String {
    let red: Vec<_> = claims.iter().filter(|one| one.verdict == Verdict::Failed).map(|one| one.name.clone()).collect();
    match (&result.reason, red.is_empty()) {
        (Some(reason), true) => reason.clone(),
        (Some(reason), false) => format!("{} ({reason})", red.join(", ")),
        (None, _) => {
            format!("counterexample to {}", if red.is_empty() { "a claim".to_owned() } else { red.join(", ") })
        }
    }
}

#[cfg(test)]
#[path = "proofs_tests.rs"]
mod tests;
