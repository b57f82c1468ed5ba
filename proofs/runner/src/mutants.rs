//! Named wrong kernels. Each is a change of a line or two in a copy of the kernel and its arithmetic; a theorem that is proved of the
//! kernel must fail on it.

use crate::campaign::{Options, flags, in_parallel};
use crate::cbmc::{Question, ask_in_turn};
use crate::compile::{STACK, compile};
use crate::control::{controls, is_smaller};
use crate::process::only_run;
use crate::report::{Control, Kill, MutantResult, MutantVerdict, Mutants, SCHEMA};
use crate::tools::Tools;
use crate::{provenance, root, select};
use serde::Deserialize;
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

/// A mutant, as `proofs/mutants.toml` has it.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Mutant {
    /// Its name, unique.
    pub name: String,
    /// What is wrong with it, in a sentence.
    pub what: String,
    /// The requirements that it breaks.
    pub requirements: Vec<String>,
    /// The file: from the kernel's `src`, or from the checkout if it begins with `arithmetic/src/`.
    pub file: String,
    /// The text to replace; it stands in the file exactly once.
    pub find: String,
    /// What replaces it.
    pub replace: String,
    /// The harnesses that must reject it: each one on its own.
    pub killed_by: Vec<String>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct File {
    mutant: Vec<Mutant>,
}

/// The mutants of `proofs/mutants.toml`, checked against the kernel and the harnesses of this checkout.
///
/// # Errors
/// What is wrong with the file: a text that does not stand in the kernel exactly once, an unknown harness.
pub fn list(root: &Path) -> Result<Vec<Mutant>, String> {
    let path = root.join("proofs").join("mutants.toml");
    let text = std::fs::read_to_string(&path).map_err(|error| format!("{}: {error}", path.display()))?;
    let file: File = toml::from_str(&text).map_err(|error| format!("{}: {error}", path.display()))?;
    for (place, mutant) in file.mutant.iter().enumerate() {
        let wrong = |reason: String| Err(format!("proofs/mutants.toml: mutant `{}`: {reason}", mutant.name));
        if file.mutant[..place].iter().any(|other| other.name == mutant.name) {
            return wrong("the name is taken".to_owned());
        }
        if mutant.killed_by.is_empty() {
            return wrong("no harness is to reject it".to_owned());
        }
        if let Err(reason) = select(&mutant.killed_by).map(drop).and(changed(root, mutant).map(drop)) {
            return wrong(reason);
        }
    }
    Ok(file.mutant)
}

impl Mutant {
    /// The file that it changes, from the checkout.
    pub fn path(&self) -> String {
        if self.file.starts_with("arithmetic/src/") { self.file.clone() } else { format!("kernel/src/{}", self.file) }
    }
}

/// The text of the file that the mutant changes, changed.
fn changed(root: &Path, mutant: &Mutant) -> Result<String, String> {
    let path = root.join(mutant.path());
    let text = std::fs::read_to_string(&path).map_err(|error| format!("{}: {error}", path.display()))?;
    match text.matches(&mutant.find).count() {
        1 => Ok(text.replacen(&mutant.find, &mutant.replace, 1)),
        count => Err(format!("`{}` stands {count} times in {}, not once", mutant.find, mutant.file)),
    }
}

/// Tries the harnesses of each mutant (all of them, if no name is given). `progress` hears of every result.
///
/// # Errors
/// A name that no mutant has, or a broken `proofs/mutants.toml`.
pub fn mutants(
    options: &Options,
    names: &[String],
    progress: &(dyn Fn(&MutantResult) + Sync),
) -> Result<Mutants, String> {
    let root = root();
    let _lock = only_run(&root.join("target").join("proofs"))?;
    let started = Instant::now();
    let all = list(&root)?;
    if let Some(name) = names.iter().find(|name| !all.iter().any(|mutant| mutant.name == **name)) {
        let known: Vec<_> = all.iter().map(|mutant| mutant.name.as_str()).collect();
        return Err(format!("there is no mutant `{name}`; the mutants are {}", known.join(", ")));
    }
    let chosen: Vec<_> = all.iter().filter(|mutant| names.is_empty() || names.contains(&mutant.name)).collect();
    let tools = Tools::find(&root);
    let versions = tools.as_ref().map(|tools| tools.versions.clone()).unwrap_or_default();
    let mut provenance = provenance::of(&root, versions, flags(options.solver))?;
    let killers: BTreeSet<String> = chosen.iter().flat_map(|mutant| mutant.killed_by.iter().cloned()).collect();
    let controls = match &tools {
        Ok(tools) => controls(tools, &root, options, &select(&killers.into_iter().collect::<Vec<_>>())?)?,
        Err(_) => Vec::new(),
    };
    let results = in_parallel(options.jobs, chosen.len(), |index| {
        let mutant = chosen[index];
        let started = Instant::now();
        let (verdict, killed_by, reason) = match &tools {
            Ok(tools) => trusted(&controls, mutant)
                .and_then(|()| attempt(tools, &root, mutant, options))
                .unwrap_or_else(|reason| (MutantVerdict::Error, Vec::new(), Some(reason))),
            Err(reason) => (MutantVerdict::NotRun, Vec::new(), Some(reason.clone())),
        };
        let result = MutantResult {
            name: mutant.name.clone(),
            what: mutant.what.clone(),
            requirements: mutant.requirements.clone(),
            file: mutant.path(),
            change: [mutant.find.clone(), mutant.replace.clone()],
            verdict,
            killed_by,
            reason,
            seconds: started.elapsed().as_secs_f64(),
        };
        progress(&result);
        result
    });
    provenance.seconds = started.elapsed().as_secs_f64();
    Ok(Mutants { schema: SCHEMA, provenance, mutants: results, controls })
}

/// A harness that rejects the right kernel too shows nothing by rejecting a wrong one.
fn trusted(controls: &[Control], mutant: &Mutant) -> Result<(), String> {
    for name in &mutant.killed_by {
        let control = controls.iter().find(|control| control.harness == *name);
        match control.map(|control| &control.reason) {
            Some(Some(reason)) => return Err(format!("the control failed: {reason}")),
            None if select(std::slice::from_ref(name))?.into_iter().any(is_smaller) => {
                return Err(format!("there is no control of {name}"));
            }
            Some(None) | None => {}
        }
    }
    Ok(())
}

type Attempt = (MutantVerdict, Vec<Kill>, Option<String>);

fn attempt(tools: &Tools, root: &Path, mutant: &Mutant, options: &Options) -> Result<Attempt, String> {
    let folder = root.join("target").join("proofs").join("mutants").join(&mutant.name);
    let sources = folder.join("sources");
    if sources.exists() {
        std::fs::remove_dir_all(&sources).map_err(|error| format!("{}: {error}", sources.display()))?;
    }
    for folder in ["arithmetic/src", "kernel/src", "proofs/src"] {
        copy(&root.join(folder), &sources.join(folder))?;
    }
    crate::compile::write(&sources.join(mutant.path()), &changed(root, mutant)?)?;
    let compiled = compile(tools, &sources, &folder.join("build"), options.aspects, &mutant.killed_by)?;
    let mut killed = Vec::new();
    let mut reasons = Vec::new();
    for harness in select(&mutant.killed_by)? {
        let mut claims: Vec<String> = Vec::new();
        let mut counterexample = None;
        let folder = compiled.to_c(tools, harness.name, STACK)?;
        let first = (!SLOW.contains(&harness.name)).then_some(FIRST);
        for case in 0..harness.cases {
            let question = Question {
                case: (case, harness.cases),
                ..Question::proof(harness.name, options.solver, options.limit)
            };
            let answer = ask_in_turn(tools, &folder, &question, first);
            let (answer, _) = answer.map_err(|silence| silence.of(harness.name))?;
            let names = harness.claims.iter().enumerate();
            claims.extend(
                names
                    .filter(|(number, _)| answer.claim(*number) == Some(false))
                    .map(|(_, claim)| claim.name.to_owned()),
            );
            counterexample = counterexample
                .or_else(|| answer.values.iter().find(|(what, _)| what.starts_with("claim ")).map(|(_, v)| v.clone()));
            // A panic is what the theorem of totality is about. Any other trap, a stack that runs out say, is the harness's own.
            claims.extend(answer.other_failure().filter(|what| *what == "trap: panic").map(ToOwned::to_owned));
            if !claims.is_empty() {
                break;
            }
        }
        if claims.is_empty() {
            reasons.push(format!("{} does not reject it", harness.name));
        } else {
            killed.push(Kill { harness: harness.name.to_owned(), claims, counterexample });
        }
    }
    // Every harness that is named must reject it: a theorem that no longer does has become weaker.
    let verdict = if reasons.is_empty() { MutantVerdict::Killed } else { MutantVerdict::Survived };
    Ok((verdict, killed, (!reasons.is_empty()).then(|| reasons.join("; "))))
}

/// The harnesses on whose mutants MiniSat is known to have no answer in the time that it is given; found by running them, and a matter of
/// time only.
pub const SLOW: [&str; 5] = ["t_per_4", "t_per_4_fix", "t_per_7", "per_machine", "t_pos_1"];

/// What is wrong is found more easily than that nothing is: MiniSat gets some time, and Kissat what that leaves.
const FIRST: Duration = Duration::from_secs(40);

fn copy(from: &Path, to: &PathBuf) -> Result<(), String> {
    let failed = |error: std::io::Error| format!("{}: {error}", from.display());
    std::fs::create_dir_all(to).map_err(failed)?;
    for entry in std::fs::read_dir(from).map_err(failed)? {
        let entry = entry.map_err(failed)?;
        let target = to.join(entry.file_name());
        if entry.path().is_dir() {
            copy(&entry.path(), &target)?;
        } else {
            std::fs::copy(entry.path(), &target).map_err(failed)?;
        }
    }
    Ok(())
}
