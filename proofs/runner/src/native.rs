//! The native engine: draws values and runs the harness on them. It tests, and it replays counterexamples.

use crate::report::{ClaimResult, CoverResult, HarnessResult, Verdict};
use atc_proofs::{Engine, Harness};
use proptest::prelude::RngCore;
use proptest::test_runner::{RngAlgorithm, TestRng};
use std::collections::BTreeSet;
use std::ops::RangeInclusive;
use std::time::Instant;

/// One run of a harness.
#[derive(Clone, Debug, Default)]
pub struct Run {
    /// Every value that was drawn: what it is, and the value.
    pub drawn: Vec<(&'static str, u16)>,
    /// The assumptions about the world that were met, held or not.
    pub supposed: BTreeSet<&'static str>,
    /// Whether all assumptions held. If not, claims and cover points say nothing.
    pub accepted: bool,
    /// Claims that were made: number and whether it held.
    pub claims: Vec<(u32, bool)>,
    /// Cover points that were reached.
    pub covered: Vec<u32>,
    /// Which of the drawn values is the case: a prover is given it apart.
    pub picked: Option<usize>,
}

impl Run {
    /// The numbers of the claims that failed.
    pub fn failed(&self) -> Vec<u32> {
        let mut failed: Vec<_> =
            self.claims.iter().filter(|(_, held)| self.accepted && !held).map(|(number, _)| *number).collect();
        failed.dedup();
        failed
    }
}

/// Where the values come from.
enum Source<'a> {
    Random(&'a mut TestRng),
    /// As recorded; 0 when they run out.
    Tape(std::slice::Iter<'a, u16>),
    /// As a prover has them: the case, and the others in order.
    Proved(u16, std::slice::Iter<'a, u16>),
}

struct Native<'a> {
    source: Source<'a>,
    run: Run,
}

/// A value of 32 random bits: one in 64 is any; of the others a quarter is an end of what is likely, and the rest is evenly in it.
///
/// One draw a value, and no more than this: drawing is what testing natively spends its time on.
fn drawn_of(bits: u32, likely: &RangeInclusive<u16>) -> u16 {
    let (first, last) = (*likely.start(), *likely.end());
    // The upper half of the bits.
    let any = bits >> 16;
    let within = match (bits >> 6) & 7 {
        _ if first > last || bits.is_multiple_of(64) => any,
        0 => u32::from(first),
        1 => u32::from(last),
        _ => u32::from(first) + ((any * (u32::from(last - first) + 1)) >> 16),
    };
    u16::try_from(within).unwrap_or(last)
}

impl Engine for Native<'_> {
    fn word(&mut self, what: &'static str, likely: RangeInclusive<u16>) -> u16 {
        let value = match &mut self.source {
            Source::Random(random) => drawn_of(random.next_u32(), &likely),
            Source::Tape(values) | Source::Proved(_, values) => values.next().copied().unwrap_or(0),
        };
        self.run.drawn.push((what, value));
        value
    }

    fn choose(&mut self, what: &'static str, cases: usize) -> usize {
        let last = u16::try_from(cases).unwrap_or(u16::MAX).saturating_sub(1);
        self.run.picked = Some(self.run.drawn.len());
        let value = if let Source::Proved(case, _) = self.source {
            case
        } else {
            let value = self.word(what, 0..=last);
            self.run.drawn.pop();
            value
        };
        let value = value.min(last);
        self.run.drawn.push((what, value));
        usize::from(value)
    }

    fn assume(&mut self, holds: bool) {
        self.run.accepted &= holds;
    }

    fn suppose(&mut self, id: &'static str, holds: bool) {
        self.run.supposed.insert(id);
        self.assume(holds);
    }

    fn claim(&mut self, number: u32, holds: bool) {
        self.run.claims.push((number, holds));
    }

    fn cover(&mut self, number: u32, reached: bool) {
        if reached {
            self.run.covered.push(number);
        }
    }
}

fn run(harness: &Harness, source: Source) -> Run {
    let mut native = Native { source, run: Run { accepted: true, ..Run::default() } };
    (harness.run)(&mut native);
    native.run
}

/// Runs the harness on these values, in order.
pub fn replay(harness: &Harness, values: &[u16]) -> Run {
    run(harness, Source::Tape(values.iter()))
}

/// Runs the harness on what a prover says of this case.
pub fn replay_case(harness: &Harness, case: usize, values: &[u16]) -> Run {
    run(harness, Source::Proved(u16::try_from(case).unwrap_or(u16::MAX), values.iter()))
}

/// So many runs on drawn values, always the same ones; and behind them some that meet the assumptions, where there are few.
pub fn drawn(harness: &Harness, runs: usize) -> Vec<Run> {
    const ACCEPTED: usize = 64;
    let mut random = TestRng::deterministic_rng(RngAlgorithm::ChaCha);
    let mut all: Vec<_> = (0..runs).map(|_| run(harness, Source::Random(&mut random))).collect();
    let few = ACCEPTED.saturating_sub(all.iter().filter(|run| run.accepted).count());
    let more = (0..runs.saturating_mul(200)).map(|_| run(harness, Source::Random(&mut random)));
    all.extend(more.filter(|run| run.accepted).take(few));
    all
}

/// The assumptions about the world that `runs` runs on drawn values meet, always on the same ones.
pub fn supposed(harness: &Harness, runs: usize) -> BTreeSet<&'static str> {
    let mut random = TestRng::deterministic_rng(RngAlgorithm::ChaCha);
    let mut supposed = BTreeSet::new();
    for _ in 0..runs {
        supposed.extend(run(harness, Source::Random(&mut random)).supposed);
    }
    supposed
}

/// Draws values until `accepted` runs have met the harness's assumptions (or 200 times as many were drawn), always
/// the same ones. A harness that draws one value gets all 65 536 of them.
pub fn test(harness: &Harness, accepted: usize) -> HarnessResult {
    let started = Instant::now();
    let mut random = TestRng::deterministic_rng(RngAlgorithm::ChaCha);
    let first = replay(harness, &[0]);
    let single = first.accepted && first.drawn.len() == 1;
    let mut made = vec![false; harness.claims.len()];
    let mut failed: Vec<Option<Vec<u16>>> = vec![None; harness.claims.len()];
    let mut hit = vec![false; harness.covers.len()];
    let (mut runs, mut met) = (0, 0);
    let most = if single { 1 << 16 } else { accepted.saturating_mul(200) };
    while runs < most && (single || met < accepted) {
        let run = if single {
            replay(harness, &[u16::try_from(runs).unwrap_or(u16::MAX)])
        } else {
            run(harness, Source::Random(&mut random))
        };
        runs += 1;
        if !run.accepted {
            continue;
        }
        met += 1;
        for (number, held) in &run.claims {
            let number = *number as usize;
            made[number] = true;
            if !held && failed[number].is_none() {
                failed[number] = Some(run.drawn.iter().map(|(_, value)| *value).collect());
            }
        }
        for number in &run.covered {
            hit[*number as usize] = true;
        }
    }
    let claims: Vec<_> = harness
        .claims
        .iter()
        .zip(made.iter().zip(&failed))
        .map(|(point, (made, failed))| ClaimResult {
            name: point.name.to_owned(),
            verdict: match (failed, made) {
                (Some(_), _) => Verdict::Failed,
                (None, true) => Verdict::Tested,
                (None, false) => Verdict::Vacuous,
            },
        })
        .collect();
    let covers: Vec<_> =
        harness.covers.iter().zip(hit).map(|(point, hit)| CoverResult { name: point.name.to_owned(), hit }).collect();
    let verdict = claims.iter().map(|claim| claim.verdict).max().unwrap_or(Verdict::Vacuous);
    HarnessResult {
        verdict,
        reason: match verdict {
            Verdict::Vacuous => Some(format!("{met} of {runs} runs met the assumptions")),
            Verdict::Failed => Some("a claim failed".to_owned()),
            _ => None,
        },
        seconds: started.elapsed().as_secs_f64(),
        solver: if single { format!("all {runs} values") } else { format!("{met} of {runs} random runs") },
        claims,
        covers,
        counterexample: failed.into_iter().flatten().next(),
        ..blank(harness, "native")
    }
}

/// A result with nothing found out yet.
pub(crate) fn blank(harness: &Harness, engine: &str) -> HarnessResult {
    HarnessResult {
        name: harness.name.to_owned(),
        bound: harness.bound.to_owned(),
        engine: engine.to_owned(),
        verdict: Verdict::NotRun,
        reason: None,
        seconds: 0.0,
        solver: String::new(),
        unwound: 0,
        claims: harness
            .claims
            .iter()
            .map(|point| ClaimResult { name: point.name.to_owned(), verdict: Verdict::NotRun })
            .collect(),
        covers: harness.covers.iter().map(|point| CoverResult { name: point.name.to_owned(), hit: false }).collect(),
        counterexample: None,
    }
}
