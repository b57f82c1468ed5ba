//! Old rules put back: the adversary and the models on a kernel that is wrong in a named way.
//!
//! A copy of the sources below `target/old-rules/` has every mutant of the interlocking in it whose change can be selected (`schemata.rs`).
//! It is compiled once, into two programs; which mutants they run with is named in the environment when they start. With none named they
//! run the kernel as it is.

use crate::copied::{Files, VARIABLE, once, read, rewrite, selector, settle, text};
use crate::importer;
use crate::mutant::{is_together, list};
use crate::process::only_run;
use crate::schemata::{Change, instrument, with_cells};
use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};
use std::process::Command;

/// What the programs read besides the members of the workspace.
const DATA: &str = "layouts";

/// What stands before the version of the copied packages: 0.1.0 becomes 90.1.0.
const VERSION: &str = "9";

/// A program that is compiled from the copy.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Program {
    /// The adversary of `tests/adversary/`.
    Adversary,
    /// The command of `models/`.
    Models,
    /// What imports stations of others.
    Importers,
    /// What holds the test vectors against the kernel.
    Vectors,
}

impl Program {
    const ALL: [Self; 4] = [Self::Adversary, Self::Models, Self::Importers, Self::Vectors];

    /// Its name in the checkout, the manifest that has it, and its source.
    const fn is(self) -> [&'static str; 3] {
        match self {
            Self::Adversary => ["adversary", "tests/adversary/Cargo.toml", "tests/adversary/src/bin/adversary.rs"],
            Self::Models => ["models", "models/Cargo.toml", "models/src/main.rs"],
            Self::Importers => ["importers", "tests/adversary/Cargo.toml", "tests/adversary/src/bin/importers.rs"],
            Self::Vectors => ["vectors", "tests/adversary/Cargo.toml", "tests/adversary/src/bin/vectors.rs"],
        }
    }

    /// Its name here: beside the program of the checkout, and never in its place.
    pub fn name(self) -> String {
        format!("old-rules-{}", self.is()[0])
    }
}

/// The programs, compiled.
#[derive(Clone, Debug)]
pub struct Programs {
    root: PathBuf,
    folder: PathBuf,
    mutants: BTreeSet<String>,
}

impl Programs {
    /// The program, to be run with these mutants.
    ///
    /// # Errors
    /// A mutant that is not in it.
    pub fn with(&self, program: Program, mutants: &[&str]) -> Result<Command, String> {
        if let Some(name) = mutants.iter().find(|name| !self.mutants.contains(**name)) {
            return Err(format!("`{name}` is no mutant of the interlocking that can be selected"));
        }
        let mut command = Command::new(self.folder.join(program.name()));
        command.env(VARIABLE, mutants.join(","));
        Ok(command)
    }

    /// The mutants that are in it.
    pub fn mutants(&self) -> &BTreeSet<String> {
        &self.mutants
    }

    /// What holds the vectors against these mutants, one after the other; against all, if none is named.
    ///
    /// # Errors
    /// A mutant that is not in it, or the list of them cannot be written.
    pub fn vectors(&self, mutants: &[&str]) -> Result<Command, String> {
        self.with(Program::Vectors, mutants)?;
        let all = list(&self.root)?;
        let wanted = |name: &str| self.mutants.contains(name) && (mutants.is_empty() || mutants.contains(&name));
        let lines = all.iter().filter(|mutant| wanted(&mutant.name)).map(|mutant| {
            let (first, rest) = mutant.file.split_once('/').unwrap_or((&mutant.file, ""));
            let folder = if rest.is_empty() { first.trim_end_matches(".rs") } else { first };
            format!("{}\t{folder}\n", mutant.name)
        });
        let path = self.root.join("target/old-rules/mutants.tsv");
        let text: String = lines.collect();
        std::fs::write(&path, text).map_err(|error| format!("{}: {error}", path.display()))?;
        let mut command = self.with(Program::Vectors, &[])?;
        command.arg("--mutants").arg(path);
        Ok(command)
    }

    /// The faults that the adversary knows, each with the mutants that put the old rule back: `tests/adversary/src/known.rs`.
    ///
    /// # Errors
    /// The adversary does not say them, or one of the mutants is not in it.
    pub fn known(&self) -> Result<Vec<Fault>, String> {
        let said = said(self.with(Program::Adversary, &[])?.arg("--known"))?.1;
        let all = said.lines().map(|line| {
            let [name, mutants, cycles, model] = line.split('\t').collect::<Vec<_>>()[..] else {
                return Err(format!("the adversary knows `{line}`"));
            };
            let mutants: Vec<String> = mutants.split(',').map(ToOwned::to_owned).collect();
            self.with(Program::Adversary, &mutants.iter().map(String::as_str).collect::<Vec<_>>())?;
            let cycles = cycles.parse().map_err(|error| format!("{name}: {cycles}: {error}"))?;
            Ok(Fault { name: name.to_owned(), mutants, cycles, model: model.to_owned() })
        });
        all.collect()
    }

    /// Hunts as the adversary does for the fault, with these mutants, for as many cycles as it is found in.
    ///
    /// # Errors
    /// The adversary fails, or breaks a condition.
    pub fn hunt(&self, fault: &Fault, mutants: &[String]) -> Result<Hunted, String> {
        let mut adversary = self.with(Program::Adversary, &mutants.iter().map(String::as_str).collect::<Vec<_>>())?;
        adversary.args(["--fault", &fault.name, "--cycles", &fault.cycles.to_string(), "--small", "no"]);
        let (code, said) = said(adversary.current_dir(&self.root))?;
        let number = |line: &str| line.strip_prefix("an accident after ")?.split(' ').next()?.parse().ok();
        let accident = said.lines().find_map(|line| line.split("ACCIDENT: ").nth(1)).map(ToOwned::to_owned);
        let found = said.lines().find_map(number).zip(accident);
        let is_sound = said.contains("; 0 accidents under a broken condition") && !said.contains("BROKEN");
        if !is_sound || code != i32::from(found.is_some()) {
            return Err(format!("{}: the adversary's own fault: {said}", fault.name));
        }
        Ok(Hunted { found })
    }

    /// What of the model is not as expected with these mutants: the names of its claims.
    ///
    /// # Errors
    /// It does not say so.
    pub fn unexpected(&self, model: &str, mutants: &[String]) -> Result<Vec<String>, String> {
        let mut models = self.with(Program::Models, &mutants.iter().map(String::as_str).collect::<Vec<_>>())?;
        match said(models.args(["check", "--jobs", "1", model]))? {
            (0, _) => Ok(Vec::new()),
            (1, said) if said.contains("NOT AS EXPECTED") => {
                let claims = said.lines().filter_map(|line| line.strip_prefix("    ")?.split(" (").next());
                Ok(claims.map(ToOwned::to_owned).collect())
            }
            (code, said) => Err(format!("{model}: exit code {code}: {said}")),
        }
    }
}

/// A fault that was found once: the mutants that put the old rule back, and what finds it then.
#[derive(Clone, Debug)]
pub struct Fault {
    /// Its name.
    pub name: String,
    /// The mutants.
    pub mutants: Vec<String>,
    /// Cycles in which the adversary finds it.
    pub cycles: u64,
    /// The model that finds it.
    pub model: String,
}

/// What a hunt came to.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Hunted {
    /// The cycles until the accident, and the accident.
    pub found: Option<(u64, String)>,
}

/// What the program prints, and its exit code.
fn said(command: &mut Command) -> Result<(i32, String), String> {
    let name = command.get_program().to_string_lossy().into_owned();
    let output = command.output().map_err(|error| format!("{name}: {error}"))?;
    let code = output.status.code().filter(|code| (0..2).contains(code));
    let errors = || String::from_utf8_lossy(&output.stderr).into_owned();
    let code = code.ok_or_else(|| format!("{name}: {}: {}", output.status, errors()))?;
    Ok((code, String::from_utf8_lossy(&output.stdout).into_owned()))
}

/// Compiles the programs, in the profile of this one. What is there and still right is kept.
///
/// # Errors
/// A broken `proofs/mutants.toml`, sources that are not as they are expected to be, or what the compiler said.
pub fn build(root: &Path, programs: &[Program]) -> Result<Programs, String> {
    let folder = root.join("target").join("old-rules");
    let _lock = only_run(&folder)?;
    let sources = folder.join("sources");
    let mut files = BTreeMap::new();
    for name in folders(root)? {
        read(root, &PathBuf::from(name), &mut files)?;
    }
    for name in ["Cargo.toml", "Cargo.lock"] {
        files.insert(PathBuf::from(name), text(&root.join(name))?.into_bytes());
    }
    let mutants = put_in(root, &mut files)?;
    settle(&sources, &files)?;
    let profile = if cfg!(debug_assertions) { "dev" } else { "release" };
    let mut cargo = Command::new(std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into()));
    cargo.current_dir(&sources).args(["build", "--offline", "--quiet", "--profile", profile]);
    // As the tests are built, as in ci/evidence: what others have written is there already.
    cargo.args(["--workspace", "--test", "contracts"]);
    cargo.arg("--target-dir").arg(root.join("target"));
    // The hunts are short: optimised, it takes longer to compile than it runs.
    cargo.arg("--config").arg(format!("profile.{profile}.package.atc-adversary.opt-level=1"));
    for program in programs {
        cargo.args(["--bin", &program.name()]);
    }
    let said = cargo.output().map_err(|error| format!("cargo: {error}"))?;
    if !said.status.success() {
        let errors = String::from_utf8_lossy(&said.stderr);
        let first: Vec<&str> = errors.lines().skip_while(|line| !line.starts_with("error")).take(12).collect();
        return Err(format!("the kernel with old rules does not compile:\n{}", first.join("\n")));
    }
    let built = if profile == "dev" { "debug" } else { profile };
    Ok(Programs { root: root.to_owned(), folder: root.join("target").join(built), mutants })
}

/// What the programs are compiled from: the workspace's folders, and the data.
fn folders(root: &Path) -> Result<BTreeSet<String>, String> {
    let path = root.join("Cargo.toml");
    let manifest: toml::Table =
        toml::from_str(&text(&path)?).map_err(|error| format!("{}: {error}", path.display()))?;
    let members =
        manifest.get("workspace").and_then(|workspace| workspace.get("members")).and_then(|all| all.as_array());
    let members = members.ok_or_else(|| format!("{}: no members of the workspace", path.display()))?;
    let folder = |member: &str| member.split('/').next().unwrap_or_default().to_owned();
    Ok(members.iter().filter_map(|member| member.as_str()).map(folder).chain([DATA.to_owned()]).collect())
}

/// Puts the mutants in, and what selects them. Their names.
fn put_in(root: &Path, files: &mut Files) -> Result<BTreeSet<String>, String> {
    let chosen: Vec<_> = list(root)?.into_iter().filter(|mutant| !mutant.alone && is_together(root, mutant)).collect();
    let (below, above): (Vec<_>, Vec<_>) = chosen.iter().partition(|mutant| mutant.path().starts_with("arithmetic/"));
    for (library, rest, mutants) in [
        ("arithmetic/src/lib.rs", "return Err(())", &below),
        ("kernel/src/lib.rs", "return atc_arithmetic::choose(name)", &above),
    ] {
        let mut changes: BTreeMap<String, Vec<Change>> = BTreeMap::new();
        for (number, mutant) in mutants.iter().enumerate() {
            let change = Change { number, find: &mutant.find, replace: &mutant.replace };
            changes.entry(mutant.path()).or_default().push(change);
        }
        for (path, changes) in changes {
            rewrite(files, &path, |text| instrument(text, &changes))?;
        }
        let names: Vec<&str> = mutants.iter().map(|mutant| mutant.name.as_str()).collect();
        rewrite(files, library, |text| with_cells(text, names.len(), &selector(&names, rest)))?;
    }
    let importers = importer::list(root)?;
    importer::put_in(&importers, files)?;
    rewrite(files, "Cargo.toml", |text| {
        // Cargo tells packages apart by name and version, not by where the workspace is: without another version these crates would
        // stand in the place of the checkout's in `target/`.
        let begins = "[workspace.package]\nversion = \"";
        once(text, begins, &format!("{begins}{VERSION}"))
    })?;
    // What is a library of C has no version in the name of its file either.
    rewrite(files, "film/kernel/Cargo.toml", |text| {
        once(text, "crate-type = [\"cdylib\", \"rlib\"]", "crate-type = [\"rlib\"]")
    })?;
    for program in Program::ALL {
        let [name, manifest, main] = program.is();
        let new = program.name();
        rewrite(files, manifest, |text| {
            once(text, &format!("[[bin]]\nname = \"{name}\""), &format!("[[bin]]\nname = \"{new}\""))
        })?;
        let begins = "fn main() -> ExitCode {\n";
        let library = if program == Program::Importers { "atc_layout" } else { "atc_kernel" };
        rewrite(files, main, |text| once(text, begins, &format!("{begins}    {library}::select();\n")))?;
    }
    rewrite(files, "tests/adversary/src/bin/vectors.rs", |text| {
        once(
            text,
            "fn choose(_name: &str) -> bool {\n    false\n}",
            "fn choose(name: &str) -> bool {\n    atc_kernel::choose(name).is_ok()\n}",
        )
    })?;
    let names = chosen.iter().map(|mutant| mutant.name.as_str());
    let all = names.chain(importers.iter().map(|importer| importer.name.as_str()));
    Ok(all.map(ToOwned::to_owned).collect())
}
