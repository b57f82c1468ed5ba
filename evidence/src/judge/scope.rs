//! What of the manifest a run looks at: all of it, one part of the railway, or one shard of many.

use crate::error::Fault;
use crate::judge::plan::Plan;
use crate::sources::measured;
use serde::{Deserialize, Serialize};
use std::collections::{BTreeMap, BTreeSet};
use std::fmt;
use std::path::Path;
use std::str::FromStr;

/// The most shards of a run.
const MOST: usize = 10_000;

/// One of so many shards.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
pub struct Shard {
    /// From 1.
    pub number: usize,
    /// How many there are.
    pub of: usize,
}

impl FromStr for Shard {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let numbers = text.split_once('/').and_then(|(number, of)| Some((number.parse().ok()?, of.parse().ok()?)));
        match numbers {
            Some((number, of)) if (1..=of).contains(&number) && of <= MOST => Ok(Self { number, of }),
            _ => Err(format!("a shard is i/n with i from 1 to n and n at most {MOST}, such as 2/4")),
        }
    }
}

impl fmt::Display for Shard {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}/{}", self.number, self.of)
    }
}

/// What a run is about.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Scope {
    /// Everything.
    #[default]
    Whole,
    /// One part of the railway, by the name of the proofs' module.
    Part(String),
    /// One shard.
    Shard(Shard),
}

impl Scope {
    /// The part, if it is one.
    pub fn part(&self) -> Option<String> {
        if let Self::Part(part) = self { Some(part.clone()) } else { None }
    }

    /// The shard, if it is one.
    pub fn shard(&self) -> Option<Shard> {
        if let Self::Shard(shard) = self { Some(*shard) } else { None }
    }

    /// Why something has not been run that is not within.
    pub fn why(&self) -> String {
        match self {
            Self::Whole => "not run".to_owned(),
            Self::Part(part) => format!("left out by --part {part}"),
            Self::Shard(shard) => format!("left out by --shard {shard}"),
        }
    }
}

/// Which tests are run.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Tests {
    /// Those of the whole workspace.
    All,
    /// The test programs that the case names, and the unit tests of every library.
    Named(BTreeSet<String>),
    /// None.
    None,
    /// These: package and test target.
    Some(BTreeSet<(String, String)>),
}

impl Tests {
    /// What cargo is told besides `test`; nothing where there are none to run.
    pub fn arguments(&self) -> Option<Vec<&str>> {
        let mut arguments = vec!["--workspace"];
        match self {
            Self::All => {}
            Self::Named(programs) => {
                arguments.push("--lib");
                arguments.extend(programs.iter().flat_map(|program| ["--test", program]));
            }
            Self::Some(targets) if !targets.is_empty() => {
                arguments.clear();
                let each = |(package, target)| ["--package", package, "--test", target];
                arguments
                    .extend(targets.iter().map(|(package, target)| (package.as_str(), target.as_str())).flat_map(each));
            }
            Self::None | Self::Some(_) => return None,
        }
        Some(arguments)
    }
}

/// The pieces of evidence within a scope.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Chosen {
    /// The ids of harnesses, models, mutants and measured targets.
    pub ids: BTreeSet<String>,
    /// The tests.
    pub tests: Tests,
}

impl Chosen {
    /// What of `plan` is within `scope`.
    ///
    /// # Errors
    /// There is no such part.
    pub fn of(plan: &Plan, scope: &Scope) -> Result<Self, Fault> {
        match scope {
            Scope::Whole => {
                Ok(Self { ids: plan.ids().into_iter().collect(), tests: Tests::Named(plan.test_programs()) })
            }
            Scope::Shard(shard) => {
                let numbers = shards(plan, shard.of);
                let ids = numbers.into_iter().filter(|(_, number)| *number == shard.number).map(|(id, _)| id);
                let named = || Tests::Named(plan.test_programs());
                Ok(Self { ids: ids.collect(), tests: if shard.number == 1 { named() } else { Tests::None } })
            }
            Scope::Part(part) => {
                let known = parts(plan);
                if !known.contains(part) {
                    let known = known.into_iter().collect::<Vec<_>>().join(", ");
                    return Err(Fault::new(
                        &format!("--part {part}"),
                        format!("there is no such part; there are {known}"),
                    ));
                }
                Ok(of_part(plan, part))
            }
        }
    }

    /// With the tests of the whole workspace, where tests are within that a part does not choose.
    #[must_use]
    pub fn with_all_tests(self) -> Self {
        let tests = if matches!(self.tests, Tests::Named(_)) { Tests::All } else { self.tests };
        Self { tests, ..self }
    }

    /// Whether this is within: `harness:…`, `model:…`, `mutant:…` or `measured:…`.
    pub fn has(&self, id: &str) -> bool {
        self.ids.contains(id)
    }

    /// The names of this kind, in the plan's order.
    pub fn names(&self, kind: &str, all: impl IntoIterator<Item = String>) -> Vec<String> {
        all.into_iter().filter(|name| self.has(&format!("{kind}:{name}"))).collect()
    }
}

/// The parts of the railway: the modules of the proofs.
pub fn parts(plan: &Plan) -> BTreeSet<String> {
    plan.harnesses.iter().filter_map(|harness| module(harness.at.as_deref()?)).collect()
}

/// `aspect` of `proofs/src/aspect/steps.rs:12` and of `proofs/src/aspect.rs:12`.
fn module(at: &str) -> Option<String> {
    let rest = at.strip_prefix("proofs/src/")?;
    rest.split(['/', '.']).next().map(ToOwned::to_owned)
}

/// The parts that requirements and theorems of these ids belong to.
fn parts_of<'a>(plan: &Plan, ids: impl IntoIterator<Item = &'a String>) -> BTreeSet<String> {
    let mut found = BTreeSet::new();
    for id in ids {
        let pages = plan.requirements.iter().filter(|one| one.id == *id).map(|one| page(&one.at));
        let modules =
            plan.harnesses.iter().filter(|one| one.theorem == *id).filter_map(|one| module(one.at.as_deref()?));
        found.extend(pages.chain(modules));
    }
    found
}

/// `aspect` of `spec/aspect.md:12`.
fn page(at: &str) -> String {
    let file = at.rsplit('/').next().unwrap_or(at);
    file.split('.').next().unwrap_or(file).to_owned()
}

fn of_part(plan: &Plan, part: &str) -> Chosen {
    let mut ids = BTreeSet::new();
    let within = |harness: &str| {
        let found = plan.harnesses.iter().find(|one| one.name == harness);
        found.and_then(|one| module(one.at.as_deref()?)).as_deref() == Some(part)
    };
    ids.extend(plan.harnesses.iter().filter(|one| within(&one.name)).map(|one| format!("harness:{}", one.name)));
    let mutants = plan.mutants.iter().filter(|one| one.killers.iter().any(|killer| within(killer)));
    for mutant in mutants {
        ids.insert(format!("mutant:{}", mutant.name));
        // What rejects it must be proved of the right kernel.
        ids.extend(mutant.killers.iter().map(|killer| format!("harness:{killer}")));
    }
    let models = plan.models.iter().filter(|one| parts_of(plan, &one.requirements).contains(part));
    ids.extend(models.map(|one| format!("model:{}", one.name)));
    ids.extend(measured::TARGETS.iter().filter(|one| one.part == part).map(|one| measured::id(one.name)));
    let named = plan.mentions.iter().map(|(id, at)| (plan.requirements.iter().find(|one| one.id == *id), at));
    let quoted = plan.citations.iter().filter(|cite| cite.is_test);
    let quoted = quoted.map(|cite| (plan.requirements.iter().find(|one| one.anchor == cite.anchor), &cite.at));
    let mine = named.chain(quoted).filter(|(one, _)| one.is_some_and(|one| page(&one.at) == part));
    Chosen { ids, tests: Tests::Some(mine.filter_map(|(_, at)| target(at)).collect()) }
}

/// Package and test target of `models/tests/spin.rs:7`; nothing for a file that is no target of its own.
fn target(at: &str) -> Option<(String, String)> {
    let path = Path::new(at.rsplit_once(':').map_or(at, |(path, _)| path));
    let mut names = path.iter().map(|name| name.to_string_lossy());
    let (mut package, mut tests, mut name) = (names.next()?, names.next()?, names.next()?);
    // A crate below `tests/`.
    if package == "tests" && tests != "tests" {
        (package, tests, name) = (tests, name, names.next()?);
    }
    let inside = names.next();
    let is_target = inside.is_none() && name.ends_with(".rs") || inside.is_some() && name != "common";
    (tests == "tests" && is_target).then(|| (format!("atc-{package}"), name.trim_end_matches(".rs").to_owned()))
}

/// The shard (from 1) of every piece of evidence but the tests. Mutants go with those that the same harness rejects, as
/// they are compiled together; the measurements are one run.
pub fn shards(plan: &Plan, of: usize) -> BTreeMap<String, usize> {
    let mut units: BTreeMap<String, (f64, Vec<String>)> = BTreeMap::new();
    for id in plan.ids() {
        let (kind, name) = id.split_once(':').unwrap_or(("", &id));
        let mutant = plan.mutants.iter().find(|one| kind == "mutant" && one.name == name);
        let unit = match mutant.and_then(|one| one.killers.first()) {
            Some(harness) => format!("mutants of {harness}"),
            None if kind == "measured" => "the measurements".to_owned(),
            None => id.clone(),
        };
        let cost = if kind == "measured" { 0.0 } else { plan.data.costs.of(&id) };
        let entry = units.entry(unit).or_insert((0.0, Vec::new()));
        entry.0 += cost;
        entry.1.push(id);
    }
    if let Some(unit) = units.get_mut("the measurements") {
        unit.0 = plan.data.costs.each.measured;
    }
    // The first shard has the tests as well.
    let mut loads = vec![0.0; of];
    loads[0] = if of > 1 { plan.data.costs.each.test } else { 0.0 };
    let costs: Vec<_> = units.iter().map(|(name, (cost, _))| (name.clone(), *cost)).collect();
    let numbers = assign(&costs, loads);
    let of_unit = |name: &str| numbers.get(name).copied().unwrap_or(1);
    units.iter().flat_map(|(name, (_, ids))| ids.iter().map(move |id| (id.clone(), of_unit(name)))).collect()
}

/// The number (from 1) of the shard of every item: the longest first, each to the shard that has least to do.
pub fn assign(items: &[(String, f64)], mut loads: Vec<f64>) -> BTreeMap<String, usize> {
    let mut order: Vec<_> = items.iter().collect();
    order.sort_by(|(one, a), (other, b)| b.total_cmp(a).then_with(|| one.cmp(other)));
    let mut numbers = BTreeMap::new();
    for (name, cost) in order {
        let least = loads.iter().enumerate().min_by(|(_, a), (_, b)| a.total_cmp(b)).map_or(0, |(place, _)| place);
        if let Some(load) = loads.get_mut(least) {
            *load += cost;
        }
        numbers.insert(name.clone(), least + 1);
    }
    numbers
}

#[cfg(test)]
#[path = "scope_tests.rs"]
mod tests;
