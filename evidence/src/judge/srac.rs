//! Safety-related application conditions: derived from what the evidence assumes, not remembered.

use crate::case::Condition;
use crate::error::Fault;
use crate::sources::data::{self, Assumption};
use crate::sources::{models, proofs};
use std::collections::{BTreeMap, BTreeSet};

const AT: &str = "spec/assumptions.toml";

/// Who uses each assumption: harnesses, bounds, models and goals.
pub fn uses(
    assumptions: &[Assumption],
    harnesses: &[proofs::HarnessInfo],
    models: &[models::ModelInfo],
    argument: &data::Argument,
) -> BTreeMap<String, BTreeSet<String>> {
    let mut uses: BTreeMap<String, BTreeSet<String>> = BTreeMap::new();
    let mut add = |id: &str, user: String| {
        uses.entry(id.to_owned()).or_default().insert(user);
    };
    for harness in harnesses {
        let user = format!("harness:{}", harness.name);
        for id in &harness.assumptions {
            add(id, user.clone());
        }
        for carrier in carriers(assumptions, &harness.bound) {
            add(&carrier.id, format!("{user} (bound)"));
        }
    }
    for model in models {
        for id in &model.assumptions {
            add(id, format!("model:{}", model.name));
        }
    }
    for goal in &argument.goals {
        for id in &goal.assumes {
            add(id, goal.id.clone());
        }
    }
    uses
}

/// The assumptions that carry a result beyond its bound.
fn carriers<'a>(assumptions: &'a [Assumption], bound: &'a str) -> impl Iterator<Item = &'a Assumption> {
    let fits = move |one: &&Assumption| !bound.is_empty() && one.bounds.iter().any(|start| bound.starts_with(start));
    assumptions.iter().filter(fits)
}

/// Every assumption that is used must be listed once and owned; every bound must be carried by one.
///
/// # Errors
/// All faults that were found, each with the assumption's name.
pub fn check(
    assumptions: &[Assumption],
    uses: &BTreeMap<String, BTreeSet<String>>,
    harnesses: &[proofs::HarnessInfo],
    hazards: &[data::Hazard],
) -> Result<(), Vec<Fault>> {
    let mut faults = Vec::new();
    let mut fault = |text: String| faults.push(Fault::new(&AT, text));
    let mut listed = BTreeSet::new();
    for one in assumptions {
        if !listed.insert(one.id.as_str()) {
            fault(format!("the assumption \"{}\" is there twice", one.id));
        }
        if one.owner.trim().is_empty() {
            fault(format!("nobody owns the assumption \"{}\": give it an owner", one.id));
        }
        for (field, text) in [("statement", &one.statement), ("addressee", &one.addressee), ("check", &one.check)] {
            if text.trim().is_empty() {
                fault(format!("the assumption \"{}\" has no {field}", one.id));
            }
        }
        for hazard in one.hazards.iter().filter(|id| !hazards.iter().any(|hazard| hazard.id == **id)) {
            fault(format!("the assumption \"{}\" names the hazard {hazard}, which is not in the log", one.id));
        }
    }
    for (id, users) in uses.iter().filter(|(id, _)| !listed.contains(id.as_str())) {
        let users = crate::judge::verdict::list(&users.iter().cloned().collect::<Vec<_>>(), 3);
        fault(format!("the assumption \"{id}\" is used by {users} and not listed: add it, with an owner"));
    }
    for harness in harnesses.iter().filter(|harness| !harness.bound.is_empty()) {
        if carriers(assumptions, &harness.bound).next().is_none() {
            let (name, bound) = (&harness.name, &harness.bound);
            fault(format!("harness:{name} is bounded (\"{bound}\") and no assumption carries it further"));
        }
    }
    if faults.is_empty() { Ok(()) } else { Err(faults) }
}

/// The numbered conditions, in the order of the file. One that nobody uses keeps its number and says so.
pub fn conditions(assumptions: &[Assumption], uses: &BTreeMap<String, BTreeSet<String>>) -> Vec<Condition> {
    let text = |text: &str| text.split_whitespace().collect::<Vec<_>>().join(" ");
    assumptions
        .iter()
        .zip(1..)
        .map(|(one, number)| Condition {
            number: format!("SRAC-{number}"),
            id: one.id.clone(),
            statement: text(&one.statement),
            why: text(&one.why),
            hazards: one.hazards.clone(),
            addressee: text(&one.addressee),
            check: text(&one.check),
            owner: text(&one.owner),
            used_by: uses.get(&one.id).map(|users| users.iter().cloned().collect()).unwrap_or_default(),
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::{check, conditions, uses};
    use crate::sources::data::{Argument, Assumption};
    use crate::sources::proofs::HarnessInfo;

    fn harness(assumption: &str, bound: &str) -> HarnessInfo {
        HarnessInfo {
            name: "t".to_owned(),
            theorem: "T".to_owned(),
            statement: String::new(),
            requirements: vec![],
            assumptions: vec![assumption.to_owned()],
            bound: bound.to_owned(),
            claims: vec![],
            covers: vec![],
            at: None,
        }
    }

    fn assumption(id: &str, owner: &str) -> Assumption {
        Assumption {
            id: id.to_owned(),
            statement: "s".to_owned(),
            addressee: "a".to_owned(),
            check: "c".to_owned(),
            owner: owner.to_owned(),
            bounds: vec!["4 aspects".to_owned()],
            ..Assumption::default()
        }
    }

    fn faults(assumptions: &[Assumption], harness: HarnessInfo) -> String {
        let harnesses = [harness];
        let uses = uses(assumptions, &harnesses, &[], &Argument::default());
        let faults = check(assumptions, &uses, &harnesses, &[]).err().unwrap_or_default();
        faults.iter().map(ToString::to_string).collect::<Vec<_>>().join("\n")
    }

    #[test]
    fn an_owned_and_listed_assumption_passes_and_gets_a_number() {
        let all = [assumption("same-input", "supplier")];
        assert_eq!(faults(&all, harness("same-input", "4 aspects; 16 elsewhere")), "");
        let uses = uses(&all, &[harness("same-input", "4 aspects")], &[], &Argument::default());
        let numbered = conditions(&all, &uses);
        assert_eq!((numbered[0].number.as_str(), numbered[0].used_by.len()), ("SRAC-1", 2));
    }

    #[test]
    fn an_assumption_that_nobody_owns_or_lists_is_named() {
        let all = [assumption("same-input", " ")];
        assert!(faults(&all, harness("same-input", "")).contains("nobody owns the assumption \"same-input\""));
        let all = [assumption("same-input", "supplier")];
        let missing = faults(&all, harness("single-fault", ""));
        assert!(missing.contains("\"single-fault\" is used by harness:t"), "{missing}");
        assert!(faults(&all, harness("same-input", "2 points")).contains("no assumption carries it"));
        let twice = [assumption("same-input", "x"), assumption("same-input", "x")];
        assert!(faults(&twice, harness("same-input", "")).contains("is there twice"));
    }
}
