//! Cut sets and failure modes of the models' outcomes: each cut set must be somebody's, each unsafe fault a cut set.

use super::models::{chart, id};
use crate::case::{Condition, CutSet, Excluded, FailureMode};
use crate::error::Fault;
use crate::judge::verdict::list;
use crate::sources::data::Assumption;
use atc_models::{Expectation, Outcome};

/// Every cut set is excluded by an assumption that is listed (and so owned), names none that is not, and is minimal; a
/// single fault that is not safe is a cut set of one; and what excludes a hazard that is found is an assumption that is
/// owned or a requirement.
///
/// # Errors
/// All faults that were found, each with the model and the faults of the set.
pub fn check(outcomes: &[Outcome], assumptions: &[Assumption], requirements: &[String]) -> Result<(), Vec<Fault>> {
    let listed = |id: &String| assumptions.iter().any(|one| one.id == *id && !one.owner.trim().is_empty());
    let mut faults = Vec::new();
    for outcome in outcomes {
        let mut fault = |text: String| faults.push(Fault::new(&id(&outcome.model), text));
        for (place, set) in outcome.cut_sets.iter().enumerate() {
            let name = name(&set.faults);
            if set.faults.is_empty() {
                fault("has a cut set without a fault: the hazard is reached by itself".to_owned());
            }
            if !set.excluded_by.iter().any(listed) {
                fault(format!(
                    "nobody owns the cut set {name}: it is excluded by no assumption of spec/assumptions.toml{}",
                    if set.excluded_by.is_empty() {
                        String::new()
                    } else {
                        format!(" ({} is not there)", list(&set.excluded_by, 3))
                    }
                ));
            }
            for unknown in set.excluded_by.iter().filter(|id| !listed(id)) {
                fault(format!("the cut set {name} is excluded by \"{unknown}\", which is no assumption that is owned"));
            }
            let others = outcome.cut_sets.iter().enumerate().filter(|(other, _)| *other != place);
            for (_, other) in others.filter(|(_, other)| within(&other.faults, &set.faults)) {
                fault(format!("the cut set {name} is not minimal: it contains {}", self::name(&other.faults)));
            }
        }
        for hazard in outcome.properties.iter().filter(|one| one.expectation == Expectation::HazardFound) {
            for unknown in hazard.excluded_by.iter().filter(|id| !listed(id) && !requirements.contains(id)) {
                fault(format!(
                    "the hazard {} is excluded by \"{unknown}\": no assumption that is owned, and no requirement",
                    hazard.name
                ));
            }
        }
        for mode in outcome.failure_modes.iter().filter(|mode| !mode.safe) {
            if !outcome.cut_sets.iter().any(|set| set.faults == [mode.fault.clone()]) {
                fault(format!("nobody owns the fault \"{}\": it is not safe, and it is no cut set", mode.fault));
            }
        }
    }
    if faults.is_empty() { Ok(()) } else { Err(faults) }
}

/// Whether all of `part`, as often as it stands there, is in `whole`.
fn within(part: &[String], whole: &[String]) -> bool {
    let times = |list: &[String], fault: &String| list.iter().filter(|one| *one == fault).count();
    part.iter().all(|fault| times(part, fault) <= times(whole, fault))
}

/// A set in words.
pub fn name(faults: &[String]) -> String {
    format!("{{{}}}", faults.join(", "))
}

/// A cut set and the outcome that has it.
type Found<'a> = (&'a Outcome, &'a atc_models::CutSet);

/// The cut sets of all models, the smallest first. One that several models find is there once, with the shortest trace.
pub fn cut_sets(outcomes: &[Outcome], conditions: &[Condition]) -> Vec<CutSet> {
    let mut found: Vec<(Vec<String>, Vec<Found>)> = Vec::new();
    for (outcome, set) in outcomes.iter().flat_map(|outcome| outcome.cut_sets.iter().map(move |set| (outcome, set))) {
        let mut faults = set.faults.clone();
        faults.sort();
        match found.iter_mut().find(|(known, _)| *known == faults) {
            Some((_, all)) => all.push((outcome, set)),
            None => found.push((faults, vec![(outcome, set)])),
        }
    }
    found.sort_by_key(|(faults, _)| faults.len());
    let merged = found.into_iter().filter_map(|(faults, all)| {
        let (_, shortest) = *all.iter().min_by_key(|(_, set)| set.trace.steps.len())?;
        Some((faults, all, shortest))
    });
    merged
        .zip(1..)
        .map(|((faults, all, shortest), number)| {
            let number = format!("CS-{number}");
            let excludes = |id: &String| all.iter().any(|(_, set)| set.excluded_by.contains(id));
            let mine: Vec<_> = conditions.iter().filter(|condition| excludes(&condition.id)).collect();
            let mut hazards: Vec<_> = mine.iter().flat_map(|condition| condition.hazards.clone()).collect();
            hazards.sort();
            hazards.dedup();
            CutSet {
                chart: chart(&number, &shortest.text, &shortest.trace),
                number,
                faults,
                text: shortest.text.clone(),
                hazards,
                excluded_by: mine
                    .iter()
                    .map(|condition| Excluded {
                        condition: condition.number.clone(),
                        assumption: condition.id.clone(),
                        owner: condition.owner.clone(),
                    })
                    .collect(),
                found_by: all.iter().map(|(outcome, _)| id(&outcome.model)).collect(),
            }
        })
        .collect()
}

/// The failure modes of all models, in their order.
pub fn failure_modes(outcomes: &[Outcome]) -> Vec<FailureMode> {
    let all = outcomes.iter().flat_map(|outcome| outcome.failure_modes.iter().map(move |mode| (outcome, mode)));
    all.map(|(outcome, mode)| FailureMode {
        fault: mode.fault.clone(),
        text: mode.text.clone(),
        safe: mode.safe,
        effect: mode.effect.clone(),
        states: u64::try_from(mode.states).unwrap_or(u64::MAX),
        model: id(&outcome.model),
    })
    .collect()
}

#[cfg(test)]
#[path = "faults_tests.rs"]
mod tests;
