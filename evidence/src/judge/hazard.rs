//! The hazard log: what mitigates each hazard, as far as it is shown, and what is left to the user.

use crate::case::{Accident, Condition, CutSet, Evidence, Hazard, Node};
use crate::error::Fault;
use crate::judge::argument::{leaves, resolve};
use crate::judge::verdict::Verdict;
use crate::sources::data;
use std::collections::BTreeSet;

/// Every hazard is there once and has a goal, and every goal that it names is there.
///
/// # Errors
/// All faults that were found.
pub fn check(hazards: &[data::Hazard], argument: &data::Argument) -> Result<(), Vec<Fault>> {
    let mut faults = Vec::new();
    let mut ids = BTreeSet::new();
    for hazard in hazards {
        let mut fault = |text: String| faults.push(Fault::new(&"spec/hazards.toml", format!("{} {text}", hazard.id)));
        if !ids.insert(&hazard.id) {
            fault("is there twice".to_owned());
        }
        if hazard.goals.is_empty() {
            fault("has no goal that mitigates it".to_owned());
        }
        for goal in hazard.goals.iter().filter(|id| !argument.goals.iter().any(|goal| goal.id == **id)) {
            fault(format!("names the goal {goal}, which the argument does not have"));
        }
    }
    if hazards.is_empty() {
        faults.push(Fault::new(&"spec/hazards.toml", "there is no hazard"));
    }
    if faults.is_empty() { Ok(()) } else { Err(faults) }
}

/// Every accident is of a hazard, has a rule that the specification has, evidence that there can be, and conditions that are listed.
///
/// # Errors
/// All faults that were found.
pub fn check_accidents(data: &data::Data, requirements: &[String], known: &[String]) -> Result<(), Vec<Fault>> {
    let mut faults = Vec::new();
    let mut names = BTreeSet::new();
    for accident in &data.accidents {
        let mut fault =
            |text: String| faults.push(Fault::new(&"spec/hazards.toml", format!("{} {text}", accident.name)));
        if !names.insert(&accident.name) {
            fault("is there twice".to_owned());
        }
        if accident.hazards.is_empty() || accident.rules.is_empty() || accident.evidence.is_empty() {
            fault("needs a hazard, a rule and evidence".to_owned());
        }
        for id in accident.hazards.iter().filter(|id| !data.hazards.iter().any(|hazard| hazard.id == **id)) {
            fault(format!("is of the hazard {id}, which the log does not have"));
        }
        for id in accident.rules.iter().filter(|id| !requirements.contains(id)) {
            fault(format!("names the rule {id}, which no file of spec/ has"));
        }
        for id in accident.conditions.iter().filter(|id| !data.assumptions.iter().any(|one| one.id == **id)) {
            fault(format!("names the condition {id}, which spec/assumptions.toml does not have"));
        }
        for reason in accident.evidence.iter().filter_map(|reference| resolve(reference, known).err()) {
            fault(reason);
        }
    }
    if faults.is_empty() { Ok(()) } else { Err(faults) }
}

/// The accidents with what the run has shown of what excludes them.
pub fn accidents(accidents: &[data::Accident], evidence: &[Evidence], conditions: &[Condition]) -> Vec<Accident> {
    let known: Vec<_> = evidence.iter().map(|one| one.id.clone()).collect();
    let row = |accident: &data::Accident| {
        let ids = accident.evidence.iter().flat_map(|reference| resolve(reference, &known).unwrap_or_default());
        let excluded_by: Vec<String> = ids.collect();
        let verdicts = evidence.iter().filter(|one| excluded_by.contains(&one.id)).map(|one| one.verdict);
        let number = |id: &String| conditions.iter().find(|one| one.id == *id).map(|one| one.number.clone());
        Accident {
            name: accident.name.clone(),
            hazards: accident.hazards.clone(),
            happened: accident.happened.clone(),
            rules: accident.rules.clone(),
            verdict: Verdict::worst(verdicts).unwrap_or(Verdict::NotRun),
            excluded_by,
            conditions: accident.conditions.iter().filter_map(number).collect(),
        }
    };
    accidents.iter().map(row).collect()
}

/// The log with what the run has shown.
pub fn log(
    hazards: &[data::Hazard],
    nodes: &[Node],
    evidence: &[Evidence],
    conditions: &[Condition],
    cut_sets: &[CutSet],
) -> Vec<Hazard> {
    let known: Vec<_> = evidence.iter().map(|one| one.id.clone()).collect();
    hazards
        .iter()
        .map(|hazard| {
            let mut mitigated_by: Vec<String> = Vec::new();
            for id in hazard.goals.iter().flat_map(|goal| leaves(nodes, goal, &known)) {
                if !mitigated_by.contains(&id) {
                    mitigated_by.push(id);
                }
            }
            let verdicts = nodes.iter().filter(|node| hazard.goals.contains(&node.id)).filter_map(|node| node.verdict);
            let requirements: BTreeSet<_> = evidence
                .iter()
                .filter(|one| mitigated_by.contains(&one.id))
                .flat_map(|one| one.requirements.iter().cloned())
                .collect();
            Hazard {
                id: hazard.id.clone(),
                title: hazard.title.clone(),
                severity: hazard.severity.clone(),
                causes: hazard.causes.clone(),
                verdict: Verdict::worst(verdicts).unwrap_or(Verdict::NotRun),
                mitigated_by,
                requirements: requirements.into_iter().collect(),
                residual: conditions
                    .iter()
                    .filter(|condition| condition.hazards.contains(&hazard.id))
                    .map(|condition| condition.number.clone())
                    .collect(),
                cut_sets: cut_sets
                    .iter()
                    .filter(|set| set.hazards.contains(&hazard.id))
                    .map(|set| set.number.clone())
                    .collect(),
                remains: hazard.remains.split_whitespace().collect::<Vec<_>>().join(" "),
            }
        })
        .collect()
}
