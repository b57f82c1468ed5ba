//! Shards joined into one run, by key. Nothing is taken on trust: what is missing is not run, and where two shards
//! contradict each other the worse verdict counts and an open item says so.

use crate::case::{Matter, OpenItem, Phase, Provenance, Severity};
use crate::error::Fault;
use crate::judge::build::Results;
use crate::judge::scope::{Scope, Shard};
use crate::judge::verdict::Verdict;
use crate::sources::proofs::Campaigned;
use crate::sources::provenance::differences;
use crate::sources::second::{Agreement, Opinion};
use crate::sources::{measured, models, tests};
use atc_models::Outcome;
use atc_prover::report::{Control, HarnessResult, MutantResult, MutantVerdict, Mutants};
use std::cmp::Ordering;
use std::collections::BTreeMap;

/// What is wrong with a model that no shard has searched.
pub const NO_SHARD: &str = "no shard has a result";

/// One run from the runs in these folders.
///
/// # Errors
/// They are of different sources, or of different numbers of shards, or one is no shard.
pub fn join(mut runs: Vec<(String, Results)>) -> Result<Results, Vec<Fault>> {
    check(&runs)?;
    runs.sort_by_key(|(_, run)| run.scope.shard());
    let mut open = Contradictions::default();
    let whose =
        |run: &Results| run.scope.shard().map_or_else(|| "a whole run".to_owned(), |shard| format!("shard {shard}"));
    let names: Vec<_> = runs.iter().map(|(_, run)| whose(run)).collect();
    let there: Vec<_> = runs.iter().filter_map(|(_, run)| run.scope.shard()).collect();
    let of = there.first().map_or(0, |shard| shard.of);
    let all = (1..=of).map(|number| Shard { number, of }).filter(|shard| !there.contains(shard));
    let missing = all.map(|shard| OpenItem {
        severity: Severity::Open,
        matter: Matter::Shard,
        about: format!("shard {shard}"),
        text: "This shard is missing: what belongs to it is not run.".to_owned(),
    });
    let all: Vec<Results> = runs.into_iter().map(|(_, run)| run).collect();
    let mut joined = Results {
        scope: Scope::Whole,
        running: false,
        joined: names.clone(),
        campaigns: Vec::new(),
        mutants: None,
        outcomes: Vec::new(),
        no_outcome: one_word(all.iter().map(|run| run.no_outcome.as_str())),
        opinions: Vec::new(),
        measured: None,
        tests: None,
        provenance: Provenance::default(),
        open: Vec::new(),
        kept_since: None,
        phases: Vec::new(),
    };
    let mut from: BTreeMap<String, usize> = BTreeMap::new();
    for (place, mut run) in all.into_iter().enumerate() {
        run.provenance.tools = compared(&run);
        let mut seen = Seen { from: &mut from, names: &names, place, open: &mut open };
        campaigns(&mut joined.campaigns, run.campaigns, &mut seen);
        mutants(&mut joined.mutants, run.mutants, &mut seen);
        for outcome in run.outcomes {
            seen.enter(&mut joined.outcomes, outcome, "model", |one| one.model.clone(), worse_outcome);
        }
        for opinion in run.opinions {
            seen.enter(
                &mut joined.opinions,
                opinion,
                "second opinion",
                |one| format!("{} {}", one.tool, one.model),
                worse_opinion,
            );
        }
        if let Some(one) = run.measured {
            let mut list: Vec<_> = joined.measured.take().into_iter().collect();
            seen.enter(&mut list, one, "measured", |_| "all".to_owned(), worse_measured);
            joined.measured = list.pop();
        }
        if let Some(one) = run.tests {
            let mut list: Vec<_> = joined.tests.take().into_iter().collect();
            seen.enter(&mut list, one, "test", |_| "all".to_owned(), worse_tests);
            joined.tests = list.pop();
        }
        provenance(&mut joined.provenance, run.provenance, place == 0);
        let named = |phase: Phase| Phase {
            name: format!("{}: {}", names.get(place).map_or("", String::as_str), phase.name),
            ..phase
        };
        joined.phases.extend(run.phases.into_iter().map(named));
        joined.open.extend(run.open);
    }
    in_order(&mut joined);
    joined.open.extend(open.0);
    joined.open.extend(missing);
    Ok(joined)
}

/// The catalogue's order: cut sets are numbered by it.
fn in_order(joined: &mut Results) {
    let order: BTreeMap<_, _> = models::catalogue().into_iter().map(|one| one.name).zip(0_usize..).collect();
    let place = |name: &str| order.get(name).copied().unwrap_or(usize::MAX);
    joined.outcomes.sort_by_key(|one| place(&one.model));
    joined.opinions.sort_by_key(|one| place(&one.model));
}

/// That all are of one run on the same sources.
fn check(runs: &[(String, Results)]) -> Result<(), Vec<Fault>> {
    let Some((first, reference)) = runs.first() else {
        return Err(vec![Fault::new(&"merge", "no folder is given; give the folder of each shard")]);
    };
    let mut faults = Vec::new();
    let of = |run: &Results| run.scope.shard().map_or(1, |shard: Shard| shard.of);
    // Each tool, as the first shard that has it says.
    let mut said: BTreeMap<String, (String, &String)> = BTreeMap::new();
    for (name, run) in runs {
        let mut fault = |text: String| faults.push(Fault::new(name, text));
        if let Scope::Part(part) = &run.scope {
            fault(format!("this is a run of the part {part}; only shards (--shard i/n) and whole runs can be joined"));
        }
        if run.running {
            fault("the run has not ended; run it again".to_owned());
        }
        if of(run) != of(reference) {
            fault(format!(
                "this is one of {} shards, and {first} is one of {}; give shards of one run",
                of(run),
                of(reference)
            ));
        }
        let (mine, theirs) = (&run.provenance, &reference.provenance);
        let commit = |one: &Provenance| one.commit.clone().unwrap_or_else(|| "no commit".to_owned());
        if commit(mine) != commit(theirs) {
            let text = format!("this is of commit {}, and {first} of {}", commit(mine), commit(theirs));
            fault(format!("{text}; run all shards on one commit"));
        }
        let mut differ = differences(theirs, mine);
        if mine.sources_sha256 != theirs.sources_sha256 {
            differ.push("what the provers see".to_owned());
        }
        if mine.aspects != theirs.aspects {
            differ.push("the number of aspects".to_owned());
        }
        if !differ.is_empty() {
            let text =
                format!("{} is not what it is in {first}; run all shards on the same sources", differ.join(", "));
            fault(text);
        }
        for (tool, version) in compared(run) {
            match said.get(&tool) {
                None => drop(said.insert(tool, (version, name))),
                Some((other, _)) if *other == version => {}
                Some((_, first)) => {
                    fault(format!("{tool} is {version}, and another version in {first}; use the same tools"));
                }
            }
        }
    }
    if faults.is_empty() { Ok(()) } else { Err(faults) }
}

/// The tools of a run. One that has proved nothing, as where the tests alone are as much as a shard, has no compiler of provers under `rustc`.
fn compared(run: &Results) -> BTreeMap<String, String> {
    let proves = run.mutants.is_some() || run.campaigns.iter().any(|one| !one.campaign.harnesses.is_empty());
    let mut tools = run.provenance.tools.clone();
    if !proves {
        tools.remove("rustc");
    }
    tools
}

/// Where two shards have the same thing and say different things of it.
#[derive(Default)]
struct Contradictions(Vec<OpenItem>);

struct Seen<'a> {
    from: &'a mut BTreeMap<String, usize>,
    names: &'a [String],
    place: usize,
    open: &'a mut Contradictions,
}

impl Seen<'_> {
    /// Enters one item under its key. If it is there already the worse one stays; `worse` compares them, and equal ones are no
    /// contradiction.
    fn enter<T>(
        &mut self,
        list: &mut Vec<T>,
        new: T,
        kind: &str,
        key: impl Fn(&T) -> String,
        worse: fn(&T, &T) -> Ordering,
    ) {
        let id = format!("{kind}:{}", key(&new));
        let Some(old) = list.iter_mut().find(|old| key(old) == key(&new)) else {
            self.from.insert(id, self.place);
            list.push(new);
            return;
        };
        let order = worse(old, &new);
        if order != Ordering::Equal {
            let name = |place: usize| self.names.get(place).cloned().unwrap_or_default();
            let before = name(self.from.get(&id).copied().unwrap_or(0));
            let text = format!("{before} and {} have different verdicts. The worse one counts.", name(self.place));
            self.open.0.push(OpenItem { severity: Severity::Open, matter: Matter::Contradiction, about: id, text });
        }
        if order == Ordering::Less {
            *old = new;
        }
    }
}

fn campaigns(joined: &mut Vec<Campaigned>, new: Vec<Campaigned>, seen: &mut Seen) {
    for one in new {
        let same = |old: &&mut Campaigned| old.campaign.engine == one.campaign.engine && old.source == one.source;
        let Some(old) = joined.iter_mut().find(same) else {
            for result in &one.campaign.harnesses {
                seen.from.insert(format!("harness:{}, {}", result.name, one.campaign.engine), seen.place);
            }
            joined.push(one);
            continue;
        };
        old.stale |= one.stale;
        old.campaign.provenance.tools.extend(one.campaign.provenance.tools);
        old.campaign.provenance.seconds += one.campaign.provenance.seconds;
        let engine = one.campaign.engine;
        for result in one.campaign.harnesses {
            let key = |one: &HarnessResult| format!("{}, {engine}", one.name);
            seen.enter(&mut old.campaign.harnesses, result, "harness", key, worse_harness);
        }
    }
}

fn mutants(joined: &mut Option<(Mutants, bool)>, new: Option<(Mutants, bool)>, seen: &mut Seen) {
    let Some((new, stale)) = new else { return };
    let Some((old, old_stale)) = joined else {
        for result in &new.mutants {
            seen.from.insert(format!("mutant:{}", result.name), seen.place);
        }
        for control in &new.controls {
            seen.from.insert(format!("control:{}", control.harness), seen.place);
        }
        *joined = Some((new, stale));
        return;
    };
    *old_stale |= stale;
    old.provenance.seconds += new.provenance.seconds;
    for result in new.mutants {
        seen.enter(&mut old.mutants, result, "mutant", |one| one.name.clone(), worse_mutant);
    }
    for control in new.controls {
        let worse = |a: &Control, b: &Control| a.reason.is_some().cmp(&b.reason.is_some());
        seen.enter(&mut old.controls, control, "control", |one| one.harness.clone(), worse);
    }
}

/// One engine's two results on a harness; each claim counts, not the whole alone.
fn worse_harness(one: &HarnessResult, other: &HarnessResult) -> Ordering {
    let claims = |result: &HarnessResult| result.claims.iter().map(|claim| claim.verdict).collect::<Vec<_>>();
    one.verdict.cmp(&other.verdict).then_with(|| claims(one).cmp(&claims(other)))
}

fn worse_mutant(one: &MutantResult, other: &MutantResult) -> Ordering {
    let rank = |result: &MutantResult| match result.verdict {
        MutantVerdict::Killed => 0,
        MutantVerdict::NotRun => 1,
        MutantVerdict::Error => 2,
        MutantVerdict::Survived => 3,
    };
    rank(one).cmp(&rank(other))
}

fn worse_outcome(one: &Outcome, other: &Outcome) -> Ordering {
    // The case's own verdict on each property, and how many states there are.
    let verdicts = |outcome: &Outcome| {
        let about: Vec<_> = models::catalogue().into_iter().filter(|model| model.name == outcome.model).collect();
        let (evidence, _) = models::evidence(&about, std::slice::from_ref(outcome), NO_SHARD);
        let claims = evidence.iter().flat_map(|one| &one.claims).map(|claim| claim.verdict).collect::<Vec<_>>();
        (evidence.first().map_or(Verdict::Undecided, |one| one.verdict), claims, outcome.unique_states)
    };
    verdicts(one).cmp(&verdicts(other))
}

fn worse_opinion(one: &Opinion, other: &Opinion) -> Ordering {
    let rank = |one: &Opinion| match one.verdict {
        Agreement::Agrees => 0,
        Agreement::NotRun => 1,
        Agreement::Differs => 2,
    };
    (rank(one), one.states).cmp(&(rank(other), other.states))
}

fn worse_measured(one: &measured::Run, other: &measured::Run) -> Ordering {
    let verdicts = |run: &measured::Run| {
        let (evidence, _) = measured::evidence(run);
        let verdicts: Vec<_> = evidence.iter().map(|one| one.verdict).collect();
        (Verdict::worst(verdicts.clone()), verdicts)
    };
    verdicts(one).cmp(&verdicts(other))
}

fn worse_tests(one: &tests::Run, other: &tests::Run) -> Ordering {
    let verdicts = |run: &tests::Run| {
        let evidence = tests::evidence(run);
        let worst = Verdict::worst(evidence.iter().map(|one| one.verdict));
        (worst, evidence.into_iter().map(|one| (one.verdict, one.id)).collect::<Vec<_>>())
    };
    verdicts(one).cmp(&verdicts(other))
}

fn provenance(joined: &mut Provenance, new: Provenance, first: bool) {
    let (mut tools, seconds) = (std::mem::take(&mut joined.tools), joined.seconds + new.seconds);
    tools.extend(new.tools.clone());
    let flags = if joined.flags.is_empty() { new.flags.clone() } else { std::mem::take(&mut joined.flags) };
    // One checkout with changes makes the whole one of changed sources.
    let dirty = if first { new.dirty } else { joined.dirty.max(new.dirty) };
    *joined = Provenance { dirty, tools, flags, seconds, ..new };
}

/// What all say, or that no shard has a result.
fn one_word<'a>(mut words: impl Iterator<Item = &'a str>) -> String {
    let first = words.next().unwrap_or(NO_SHARD);
    if words.all(|word| word == first) { first.to_owned() } else { NO_SHARD.to_owned() }
}

#[cfg(test)]
#[path = "merge_tests.rs"]
pub(crate) mod checks;
