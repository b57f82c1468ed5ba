//! The case's own sources: `spec/assumptions.toml`, `hazards.toml`, `argument.toml`, `techniques.toml`,
//! `evidence/ratchet.toml` and `evidence/costs.toml`.

use crate::error::{Fault, line_of, read};
use serde::Deserialize;
use serde::de::DeserializeOwned;
use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

/// All of them.
#[derive(Clone, Debug)]
pub struct Data {
    /// What is assumed.
    pub assumptions: Vec<Assumption>,
    /// The hazard log.
    pub hazards: Vec<Hazard>,
    /// The accidents that were found with legal input, and what is against each.
    pub accidents: Vec<Accident>,
    /// The argument.
    pub argument: Argument,
    /// Techniques and tools.
    pub techniques: Techniques,
    /// The least numbers.
    pub ratchet: Ratchet,
    /// How long items take, about.
    pub costs: Costs,
}

/// Something that is assumed: becomes a safety-related application condition.
#[derive(Clone, Debug, Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Assumption {
    /// Its id, as harnesses and models use it.
    pub id: String,
    /// What must be so.
    pub statement: String,
    /// Why it is needed.
    pub why: String,
    /// What may happen otherwise.
    pub hazards: Vec<String>,
    /// Who must see to it.
    pub addressee: String,
    /// How it can be checked.
    pub check: String,
    /// Who answers for it. An assumption without an owner stops the build.
    #[serde(default)]
    pub owner: String,
    /// The beginnings of the bounds (in words) that this assumption carries beyond.
    #[serde(default)]
    pub bounds: Vec<String>,
}

/// A hazard.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Hazard {
    /// H-1, …
    pub id: String,
    /// What it is called.
    pub title: String,
    /// What may come of it.
    pub severity: String,
    /// What leads to it.
    pub causes: Vec<String>,
    /// The goals of the argument that mitigate it.
    pub goals: Vec<String>,
    /// What remains, in words.
    pub remains: String,
}

/// An accident that was found with legal input, and what excludes it now.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Accident {
    /// The session in which it was found.
    pub name: String,
    /// The hazards that it was: ids.
    pub hazards: Vec<String>,
    /// What happened.
    pub happened: String,
    /// The rules against it: requirement ids.
    pub rules: Vec<String>,
    /// Evidence ids: theorems, models and tests.
    pub evidence: Vec<String>,
    /// The assumptions that it rests on besides.
    #[serde(default)]
    pub conditions: Vec<String>,
}

/// The argument.
#[derive(Clone, Debug, Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Argument {
    /// Claims.
    #[serde(default, rename = "goal")]
    pub goals: Vec<Goal>,
    /// How claims are divided.
    #[serde(default, rename = "strategy")]
    pub strategies: Vec<Strategy>,
    /// What the words mean, or where it applies.
    #[serde(default, rename = "context")]
    pub contexts: Vec<Text>,
    /// Why a strategy is sound.
    #[serde(default, rename = "justification")]
    pub justifications: Vec<Text>,
}

impl Argument {
    /// Puts the harnesses of each theorem in the place of its name, `theorem:…`; `harnesses` are theorems and harnesses.
    ///
    /// # Errors
    /// The names of which there is no theorem, and the theorems that no goal names.
    pub fn name_harnesses(&mut self, harnesses: &[(&str, &str)]) -> Result<(), Vec<Fault>> {
        let (mut faults, mut named) = (Vec::new(), BTreeSet::new());
        let mut fault = |text: String| faults.push(Fault::new(&"spec/argument.toml", text));
        for goal in &mut self.goals {
            let lists =
                std::iter::once(&mut goal.evidence).chain(goal.defeaters.iter_mut().map(|doubt| &mut doubt.evidence));
            for (place, list) in lists.enumerate() {
                for reference in std::mem::take(list) {
                    let Some(theorem) = reference.strip_prefix("theorem:") else {
                        list.push(reference);
                        continue;
                    };
                    let of = harnesses.iter().filter(|(its, _)| *its == theorem);
                    let before = list.len();
                    list.extend(of.map(|(_, harness)| format!("harness:{harness}")));
                    if list.len() == before {
                        fault(format!("{}: there is no theorem {theorem}", goal.id));
                    }
                    if place == 0 {
                        named.insert(theorem.to_owned());
                    }
                }
            }
        }
        for theorem in harnesses.iter().map(|(theorem, _)| *theorem).collect::<BTreeSet<_>>() {
            if !named.contains(theorem) {
                fault(format!(
                    "no goal has the evidence \"theorem:{theorem}\": each theorem is named by the goal that it shows"
                ));
            }
        }
        if faults.is_empty() { Ok(()) } else { Err(faults) }
    }
}

/// A claim.
#[derive(Clone, Debug, Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Goal {
    /// G1, …
    pub id: String,
    /// What is claimed.
    pub text: String,
    /// Whether it is a root.
    #[serde(default)]
    pub root: bool,
    /// Goals and strategies below.
    #[serde(default)]
    pub supported_by: Vec<String>,
    /// Evidence ids; `*` at the end stands for all that begin so, and `theorem:…` for every harness of a theorem.
    #[serde(default)]
    pub evidence: Vec<String>,
    /// Contexts and justifications.
    #[serde(default)]
    pub context: Vec<String>,
    /// Assumptions of the argument itself, beyond those of the evidence.
    #[serde(default)]
    pub assumes: Vec<String>,
    /// What would make it wrong.
    #[serde(default, rename = "defeater")]
    pub defeaters: Vec<Defeater>,
}

/// A doubt.
#[derive(Clone, Debug, Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Defeater {
    /// The doubt.
    pub text: String,
    /// The answer, if there is one.
    pub answer: Option<String>,
    /// The evidence that the answer rests on.
    #[serde(default)]
    pub evidence: Vec<String>,
    /// Engines that must have a result for the answer to hold.
    #[serde(default)]
    pub engines: Vec<String>,
}

/// How a claim is divided.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Strategy {
    /// S1, …
    pub id: String,
    /// How.
    pub text: String,
    /// Goals below.
    pub supported_by: Vec<String>,
    /// Contexts and justifications.
    #[serde(default)]
    pub context: Vec<String>,
}

/// A context or a justification.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Text {
    /// C1 or J1, …
    pub id: String,
    /// What it says.
    pub text: String,
}

/// Techniques and tools.
#[derive(Clone, Debug, Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Techniques {
    /// Techniques of EN 50716 Annex A.
    #[serde(default, rename = "technique")]
    pub techniques: Vec<Technique>,
    /// Tools by class.
    #[serde(default, rename = "tool")]
    pub tools: Vec<Tool>,
}

/// A technique.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Technique {
    /// Its name.
    pub name: String,
    /// What is claimed.
    pub claimed: String,
    /// Evidence ids, as in a goal.
    #[serde(default)]
    pub evidence: Vec<String>,
    /// Engines that must have a result for the claim to hold.
    #[serde(default)]
    pub engines: Vec<String>,
}

/// A tool.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Tool {
    /// Its name in the list of versions.
    pub name: String,
    /// T1, T2 or T3.
    pub class: String,
    /// What it does here, and what would detect its faults.
    pub justification: String,
}

/// The least numbers: fewer stops the case, more asks to raise them.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Ratchet {
    /// Harnesses.
    pub harnesses: usize,
    /// Claims of all harnesses.
    pub claims: usize,
    /// Cover points of all harnesses.
    pub covers: usize,
    /// Named wrong kernels.
    pub mutants: usize,
    /// Models.
    pub models: usize,
    /// Requirements.
    pub requirements: usize,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Assumptions {
    assumption: Vec<Assumption>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Hazards {
    hazard: Vec<Hazard>,
    #[serde(default)]
    accident: Vec<Accident>,
}

impl Data {
    /// Reads them all.
    ///
    /// # Errors
    /// A file is missing or has an unknown or missing field; with the file and the line.
    pub fn read(root: &Path) -> Result<Self, Fault> {
        let Hazards { hazard, accident } = file(root, "spec/hazards.toml")?;
        Ok(Self {
            assumptions: file::<Assumptions>(root, "spec/assumptions.toml")?.assumption,
            hazards: hazard,
            accidents: accident,
            argument: file(root, "spec/argument.toml")?,
            techniques: file(root, "spec/techniques.toml")?,
            ratchet: file(root, "evidence/ratchet.toml")?,
            costs: file(root, "evidence/costs.toml")?,
        })
    }
}

/// About how many seconds of one processor items take. No verdict depends on it.
#[derive(Clone, Debug, Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Costs {
    /// Of those that are not named.
    pub each: Each,
    /// Of those that take longest, by evidence id.
    pub longest: BTreeMap<String, f64>,
}

/// About how long one item of a kind takes, in seconds.
#[derive(Clone, Copy, Debug, Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Each {
    /// A theorem.
    pub harness: f64,
    /// A wrong kernel.
    pub mutant: f64,
    /// A model.
    pub model: f64,
    /// All measurements.
    pub measured: f64,
    /// A theorem, tested natively.
    pub native: f64,
    /// All tests.
    pub test: f64,
}

impl Costs {
    /// That of one piece of evidence.
    pub fn of(&self, id: &str) -> f64 {
        let each = match id.split(':').next() {
            Some("harness") => self.each.harness,
            Some("mutant") => self.each.mutant,
            Some("model") => self.each.model,
            Some("measured") => self.each.measured,
            _ => self.each.test,
        };
        self.longest.get(id).copied().unwrap_or(each)
    }
}

fn file<T: DeserializeOwned>(root: &Path, name: &str) -> Result<T, Fault> {
    parse(name, &read(&root.join(name))?)
}

/// The contents of a TOML file.
///
/// # Errors
/// A syntax error, or an unknown or missing field; with the line.
pub fn parse<T: DeserializeOwned>(name: &str, text: &str) -> Result<T, Fault> {
    toml::from_str(text).map_err(|error| {
        let line = error.span().map_or_else(String::new, |span| format!(":{}", line_of(text, span.start)));
        Fault::new(&format!("{name}{line}"), error.message())
    })
}

#[cfg(test)]
mod tests {
    use super::{Argument, Defeater, Goal, Ratchet, parse};

    #[test]
    fn a_fault_in_a_file_has_its_line() {
        let fault = parse::<Ratchet>("ratchet.toml", "harnesses = 1\nclaim = 2\n").expect_err("unknown field");
        assert!(fault.at == "ratchet.toml:2" && fault.text.contains("claim"), "{fault}");
    }

    #[test]
    fn a_goal_names_theorems_and_each_theorem_is_named() {
        let list = |ids: &[&str]| ids.iter().map(|id| (*id).to_owned()).collect::<Vec<_>>();
        let argument = |evidence: &[&str], doubted: &[&str]| {
            let defeaters = vec![Defeater { evidence: list(doubted), ..Defeater::default() }];
            let goal = Goal { id: "G".to_owned(), evidence: list(evidence), defeaters, ..Goal::default() };
            Argument { goals: vec![goal], ..Argument::default() }
        };
        let harnesses = [("T-1", "one"), ("T-2", "two"), ("T-1", "another")];
        let mut good = argument(&["theorem:T-1", "model:m*", "theorem:T-2"], &["theorem:T-1"]);
        good.name_harnesses(&harnesses).expect("good");
        assert_eq!(good.goals[0].evidence, list(&["harness:one", "harness:another", "model:m*", "harness:two"]));
        assert_eq!(good.goals[0].defeaters[0].evidence, list(&["harness:one", "harness:another"]));
        // Harnesses by name, or in a defeater alone, do not name their theorem: the next one of it would be of no goal.
        for (evidence, doubted, told) in [
            (&["theorem:T-1", "theorem:T-3", "theorem:T-2"][..], &[][..], "there is no theorem T-3"),
            (&["theorem:T-1", "harness:two"], &["theorem:T-2"], "theorem:T-2"),
        ] {
            let faults = argument(evidence, doubted).name_harnesses(&harnesses).expect_err("wrong");
            assert!(faults.len() == 1 && faults[0].to_string().contains(told), "{faults:?}");
        }
    }
}
