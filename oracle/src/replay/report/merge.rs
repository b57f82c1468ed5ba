//! The reports of shards as the report of one run.

use std::collections::{BTreeMap, BTreeSet};

use super::{OfMachine, Report, Unread};
use crate::replay::explain::EXPLAINED;
use crate::replay::unit::MOST_STUCK;
use atc_protocol::machine::KINDS;

/// Joins the reports of shards, each with the name that it has in messages. A shard that is missing is a place that was not read.
///
/// # Errors
/// What does not fit: a report that is no shard, a shard twice, another version, other logs, another profile, level or sample.
pub fn merge(reports: Vec<(String, Report)>) -> Result<Report, String> {
    let mut shards: BTreeMap<u64, (String, Report)> = BTreeMap::new();
    for (name, report) in reports {
        let Some(shard) = report.shard else {
            return Err(format!("{name}: this is the report of all logs, not of a shard (--shard)"));
        };
        if shard.index == 0 || shard.index > shard.of {
            return Err(format!("{name}: there is no shard {}/{}", shard.index, shard.of));
        }
        if let Some((first, other)) = shards.values().next() {
            fits(other, &report).map_err(|what| format!("{name} and {first} do not belong together: {what}"))?;
        }
        if let Some((other, _)) = shards.get(&shard.index) {
            return Err(format!("{name} and {other}: both are shard {}/{}", shard.index, shard.of));
        }
        shards.insert(shard.index, (name, report));
    }
    let missing = shards.values().next().and_then(|(_, report)| report.shard).map(|shard| {
        (1..=shard.of)
            .filter(|index| !shards.contains_key(index))
            .map(|index| format!("shard {index}/{}", shard.of))
            .collect::<Vec<_>>()
    });
    let mut joined: Option<Report> = None;
    for (_, report) in shards.into_values() {
        match &mut joined {
            None => joined = Some(Report { shard: None, ..report }),
            Some(joined) => join(joined, report),
        }
    }
    let mut joined = joined.ok_or_else(|| "there is no report to join".to_owned())?;
    for name in missing.unwrap_or_default() {
        joined.unread_in_all += 1;
        joined.unread.push(Unread::whole(
            name,
            "it is missing: the sessions of this part of the logs are not among these reports",
        ));
    }
    joined.unread.truncate(MOST_STUCK);
    let most = usize::try_from(joined.most_differences).unwrap_or(usize::MAX);
    joined.differences.truncate(most);
    // One run explains only the first ones.
    for differing in joined.differences.iter_mut().skip(EXPLAINED) {
        differing.unexplained();
    }
    joined.judge();
    Ok(joined)
}

fn fits(one: &Report, other: &Report) -> Result<(), String> {
    let shards = |report: &Report| report.shard.map_or(0, |shard| shard.of);
    for (what, same) in [
        ("the form of the report", one.form == other.form),
        ("the version of the oracle", one.oracle == other.oracle),
        ("the number of shards", shards(one) == shards(other)),
        ("the logs (names and lengths)", one.input == other.input),
        ("--sample or its seed", (&one.sample, one.seed) == (&other.sample, other.seed)),
        ("--level", one.level == other.level),
        ("the profile", one.profile == other.profile),
        ("--differences", one.most_differences == other.most_differences),
    ] {
        if !same {
            return Err(format!("they differ in {what}"));
        }
    }
    Ok(())
}

fn join(into: &mut Report, report: Report) {
    into.began = into.began.min(report.began);
    into.seconds += report.seconds;
    into.bytes += report.bytes;
    into.left_out += report.left_out;
    into.without_stop += report.without_stop;
    into.unread_in_all += report.unread_in_all;
    // Shards are in the order of the logs, and so are their lists.
    into.differences.extend(report.differences);
    into.unread.extend(report.unread);
    for machine in report.machines {
        match into.machines.iter_mut().find(|other| other.machine == machine.machine) {
            Some(other) => add(other, &machine),
            None => into.machines.push(machine),
        }
    }
    into.machines.sort_by_key(|machine| KINDS.iter().position(|kind| kind.name == machine.machine));
}

fn add(into: &mut OfMachine, other: &OfMachine) {
    into.sessions += other.sessions;
    into.agree += other.agree;
    into.differ += other.differ;
    into.unfinished += other.unfinished;
    into.skipped += other.skipped;
    into.steps += other.steps;
    into.steps_that_differ += other.steps_that_differ;
    let known: BTreeSet<_> = into.known.iter().chain(&other.known).copied().collect();
    into.known = known.into_iter().collect();
}
