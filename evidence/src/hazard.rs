//! The hazard log: what mitigates each hazard, as far as it is shown, and what is left to the user.

use crate::argument::leaves;
use crate::case::{Condition, CutSet, Evidence, Hazard, Node};
use crate::data;
use crate::error::Fault;
use crate::verdict::Verdict;
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
