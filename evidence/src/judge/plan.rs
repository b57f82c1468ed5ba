//! What is to be shown, before anything runs: the manifest, checked for everything that is known without a result.
//!
//! A case whose sources contradict each other is not built: it would cost minutes of proving to find that out later.

use crate::error::Fault;
use crate::judge::argument;
use crate::judge::hazard;
use crate::judge::srac;
use crate::judge::trace;
use crate::sources::data::{Data, Ratchet};
use crate::sources::requirements::{self, Citation, Requirement};
use crate::sources::{measured, models, mutants, proofs};
use crate::station;
use atc_line::Line;
use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

/// The folders whose comments may quote a requirement.
const QUOTING: &[&str] = &["kernel", "arithmetic/src", "proofs/src", "models", "protocol", "oracle", "tests"];

/// Everything that is known without a result.
#[derive(Clone, Debug)]
pub struct Plan {
    /// The case's own sources.
    pub data: Data,
    /// The harnesses.
    pub harnesses: Vec<proofs::HarnessInfo>,
    /// The models.
    pub models: Vec<models::ModelInfo>,
    /// The wrong kernels.
    pub mutants: Vec<mutants::MutantInfo>,
    /// The requirements.
    pub requirements: Vec<Requirement>,
    /// The quotations of requirements.
    pub citations: Vec<Citation>,
    /// Where tests name a requirement.
    pub mentions: Vec<(String, String)>,
    /// Who uses each assumption.
    pub uses: BTreeMap<String, BTreeSet<String>>,
    /// The line.
    pub line: Line,
    /// The station, if one was given.
    pub station: Option<station::Checked>,
    /// Numbers that could be raised in the ratchet.
    pub raise: Vec<String>,
}

/// Reads everything and checks it.
///
/// # Errors
/// All faults of the first stage that has any.
pub fn plan(
    root: &Path,
    (line, station): (Line, Option<station::Checked>),
    mutants: Vec<mutants::MutantInfo>,
) -> Result<Plan, Vec<Fault>> {
    let one = |fault: Fault| vec![fault];
    let mut data = Data::read(root).map_err(one)?;
    let requirements = requirements::specification(root).map_err(one)?;
    let citations = requirements::citations(root, QUOTING).map_err(one)?;
    let ids: Vec<_> = requirements.iter().map(|requirement| requirement.id.clone()).collect();
    let mentions = trace::mentions(root, &ids).map_err(one)?;
    let (harnesses, models) = (proofs::catalogue(), models::catalogue());
    let theorems: Vec<_> = harnesses.iter().map(|one| (one.theorem.as_str(), one.name.as_str())).collect();
    data.argument.name_harnesses(&theorems)?;
    let uses = srac::uses(&data.assumptions, &harnesses, &models, &data.argument);
    let raise = ratchet(data.ratchet, &count(&harnesses, &models, &mutants, &requirements))?;
    let plan = Plan { data, harnesses, models, mutants, requirements, citations, mentions, uses, line, station, raise };
    plan.check()?;
    Ok(plan)
}

/// What there is to count.
fn count(
    harnesses: &[proofs::HarnessInfo],
    models: &[models::ModelInfo],
    mutants: &[mutants::MutantInfo],
    requirements: &[Requirement],
) -> Ratchet {
    Ratchet {
        harnesses: harnesses.len(),
        claims: harnesses.iter().map(|harness| harness.claims.len()).sum(),
        covers: harnesses.iter().map(|harness| harness.covers.len()).sum(),
        mutants: mutants.len(),
        models: models.len(),
        requirements: requirements.len(),
    }
}

/// Fewer than pinned is a fault; the names of those of which there are more.
///
/// # Errors
/// All numbers that have dropped.
pub fn ratchet(pinned: Ratchet, found: &Ratchet) -> Result<Vec<String>, Vec<Fault>> {
    let pairs = [
        ("harnesses", pinned.harnesses, found.harnesses),
        ("claims", pinned.claims, found.claims),
        ("covers", pinned.covers, found.covers),
        ("mutants", pinned.mutants, found.mutants),
        ("models", pinned.models, found.models),
        ("requirements", pinned.requirements, found.requirements),
    ];
    let fewer: Vec<_> = pairs.iter().filter(|(_, pinned, found)| found < pinned).collect();
    if !fewer.is_empty() {
        let fault = |(name, pinned, found): &&(&str, usize, usize)| {
            let text =
                format!("{found} {name}, and {pinned} are pinned: something was lost, or lower the pin and say why");
            Fault::new(&"evidence/ratchet.toml", text)
        };
        return Err(fewer.iter().map(fault).collect());
    }
    let more = pairs.iter().filter(|(_, pinned, found)| found > pinned);
    Ok(more.map(|(name, pinned, found)| format!("{name}: {pinned} pinned, {found} found")).collect())
}

impl Plan {
    fn check(&self) -> Result<(), Vec<Fault>> {
        let mut faults = Vec::new();
        let mut take = |result: Result<(), Vec<Fault>>| faults.extend(result.err().unwrap_or_default());
        let data = &self.data;
        take(srac::check(&data.assumptions, &self.uses, &self.harnesses, &data.hazards));
        let known: Vec<_> = self.ids().into_iter().chain(self.tests_named()).collect();
        let required: Vec<_> = known
            .iter()
            .filter(|id| ["harness:", "model:", "measured:"].iter().any(|kind| id.starts_with(kind)))
            .cloned()
            .collect();
        take(argument::check(&data.argument, &known, &required));
        take(hazard::check(&data.hazards, &data.argument));
        let rules: Vec<_> = self.requirements.iter().map(|one| one.id.clone()).collect();
        take(hazard::check_accidents(data, &rules, &known));
        let dangling = |at: &str, text: String| Err(vec![Fault::new(&at, text)]);
        for technique in &data.techniques.techniques {
            for reference in &technique.evidence {
                if let Err(text) = argument::resolve(reference, &known) {
                    take(dangling("spec/techniques.toml", format!("\"{}\": {text}", technique.name)));
                }
            }
        }
        for id in data.costs.longest.keys().filter(|id| !known.contains(id)) {
            take(dangling(
                "evidence/costs.toml",
                format!("{id} is no harness, model, wrong kernel or measured target"),
            ));
        }
        let theorems: BTreeSet<_> = self.harnesses.iter().map(|harness| harness.theorem.as_str()).collect();
        let named = self
            .harnesses
            .iter()
            .map(|one| (format!("harness:{}", one.name), &one.requirements))
            .chain(self.mutants.iter().map(|one| (format!("mutant:{}", one.name), &one.requirements)))
            .chain(self.models.iter().map(|one| (format!("model:{}", one.name), &one.requirements)));
        for (user, ids) in named {
            for id in ids {
                let there = self.requirements.iter().any(|one| one.id == *id) || theorems.contains(id.as_str());
                if !there {
                    take(dangling("spec", format!("{user} names {id}, which is no requirement of the specification")));
                }
            }
        }
        if faults.is_empty() { Ok(()) } else { Err(faults) }
    }

    /// The ids of harnesses, models, mutants and measured targets: the manifest, but for the tests.
    pub fn ids(&self) -> Vec<String> {
        let harnesses = self.harnesses.iter().map(|one| format!("harness:{}", one.name));
        let models = self.models.iter().map(|one| format!("model:{}", one.name));
        let mutants = self.mutants.iter().map(|one| format!("mutant:{}", one.name));
        let targets = measured::TARGETS.iter().map(|target| measured::id(target.name));
        harnesses.chain(models).chain(mutants).chain(targets).collect()
    }

    /// The test suites that the argument or a technique names, and the whole of them.
    pub fn tests_named(&self) -> BTreeSet<String> {
        let goals = self.data.argument.goals.iter();
        let doubts = goals.clone().flat_map(|goal| &goal.defeaters).flat_map(|doubt| &doubt.evidence);
        goals
            .flat_map(|goal| &goal.evidence)
            .chain(doubts)
            .chain(self.data.techniques.techniques.iter().flat_map(|technique| &technique.evidence))
            .filter(|id| id.starts_with("test:") && !id.ends_with('*'))
            .cloned()
            .chain(["test:all".to_owned()])
            .collect()
    }

    /// The test programs among them. The others are a library's unit tests, or all that ran.
    pub fn test_programs(&self) -> BTreeSet<String> {
        let named = self.tests_named();
        let names = named.iter().filter_map(|id| id.strip_prefix("test:"));
        names.filter(|name| *name != "all" && !name.starts_with("atc_")).map(ToOwned::to_owned).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::ratchet;
    use crate::sources::data::Ratchet;

    #[test]
    fn a_number_may_rise_and_not_fall() {
        let pinned = Ratchet { harnesses: 3, claims: 9, ..Ratchet::default() };
        let lost = ratchet(pinned, &Ratchet { harnesses: 2, claims: 9, ..Ratchet::default() }).expect_err("lost");
        assert!(lost[0].to_string().contains("2 harnesses, and 3 are pinned"));
        assert_eq!(ratchet(pinned, &pinned), Ok(vec![]));
        let more = ratchet(pinned, &Ratchet { harnesses: 4, claims: 9, ..Ratchet::default() });
        assert_eq!(more, Ok(vec!["harnesses: 3 pinned, 4 found".to_owned()]));
    }
}
