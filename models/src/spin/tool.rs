//! SPIN and the C compiler as processes, and what the checkers that they make print.

use crate::twin::Twin;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::sync::atomic::{AtomicUsize, Ordering};
use std::{env, fs, io, process};

/// How every checker is compiled: for safety, and without partial order reduction, so that every state is stored.
pub(crate) const CHECKER: &[&str] = &["-DSAFETY", "-DNOREDUCE"];

/// For one that only counts states.
pub(crate) const COUNTER: &[&str] = &["-DSAFETY", "-DNOREDUCE", "-DNOCLAIM"];

/// The deepest path, in steps within cycles, and the minutes, that a search may take. Beyond either it has no result. Room for more would
/// cost more than the searches: it is cleared first.
const SEARCH: &[&str] = &["-E", "-m400000", "-w20", "-Q10"];

/// SPIN, found.
#[derive(Clone, Debug)]
pub struct Spin {
    path: PathBuf,
    version: String,
}

/// What a checker counted.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Counted {
    /// Stored states.
    pub states: u64,
    /// Steps, the way into the initial state included.
    pub steps: u64,
}

/// The checkout that this was built in.
fn checkout() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR")).parent().unwrap_or(Path::new("."))
}

impl Spin {
    /// SPIN 6.5 or later on PATH, or that of `ci/install-provers`; and a C compiler for what it writes.
    ///
    /// # Errors
    /// What is missing. `PROVERS=none` in the environment: everything.
    pub fn find() -> Result<Self, String> {
        if env::var_os("PROVERS").is_some_and(|word| word == "none") {
            return Err("PROVERS=none: no prover is used".to_owned());
        }
        let on_path = env::var_os("PATH").unwrap_or_default();
        let folders = env::split_paths(&on_path).chain([checkout().join("target/provers/bin")]);
        let mut found = folders.map(|folder| folder.join("spin")).filter_map(|path| {
            let version = version(&path)?;
            Some(Self { path, version })
        });
        let spin =
            found.next().ok_or("no spin 6.5 or later on PATH or in target/provers; ci/install-provers fetches it")?;
        run(Command::new("gcc").arg("--version")).map_err(|_| "no gcc on PATH, which spin needs")?;
        Ok(spin)
    }

    /// Its version, as it says itself.
    pub fn version(&self) -> &str {
        &self.version
    }

    /// Writes the checker of `twin` in C into `folder`.
    pub(crate) fn generate(&self, folder: &Folder, twin: &Twin) -> Result<(), String> {
        let file = folder.0.join("model.pml");
        fs::write(&file, twin.promela.as_bytes()).map_err(|error| cannot("write", &file, &error))?;
        let defined = twin.parameters.iter().map(|(name, value)| format!("-D{name}={value}"));
        let mut command = Command::new(&self.path);
        let said = run(command.args(defined).args(["-a", "model.pml"]).current_dir(&folder.0))?;
        if folder.0.join("pan.c").is_file() { Ok(()) } else { Err(format!("spin: {}", first_error(&said))) }
    }
}

/// The version of SPIN at `path`; nothing if it is none, or too old. (Another tool of that name says something else.)
fn version(path: &Path) -> Option<String> {
    if !path.is_file() {
        return None;
    }
    let said = run(Command::new(path).arg("-V")).ok()?;
    let version = said.strip_prefix("Spin Version ")?.split_whitespace().next()?;
    let mut parts = version.split('.').map(|part| part.parse::<u32>().ok());
    let number = (parts.next()??, parts.next()??);
    (number >= (6, 5)).then(|| version.to_owned())
}

/// A folder of its own under `target/spin`, removed in the end.
pub(crate) struct Folder(PathBuf);

impl Folder {
    pub(crate) fn new(name: &str) -> Result<Self, String> {
        static NEXT: AtomicUsize = AtomicUsize::new(0);
        let number = NEXT.fetch_add(1, Ordering::Relaxed);
        let folder = checkout().join("target/spin").join(format!("{name}-{}-{number}", process::id()));
        fs::create_dir_all(&folder).map_err(|error| cannot("make", &folder, &error))?;
        Ok(Self(folder))
    }

    /// The checker in C, compiled with these options.
    pub(crate) fn compile(&self, name: &str, options: &[&str]) -> Result<Checker<'_>, String> {
        let file = self.0.join(name);
        let mut gcc = Command::new("gcc");
        run(gcc.args(options).args(["-w", "-o", name, "pan.c"]).current_dir(&self.0))?;
        Ok(Checker { folder: self, file })
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        // What is left over is in the way of nobody.
        let _ = fs::remove_dir_all(&self.0);
    }
}

fn cannot(what: &str, file: &Path, error: &io::Error) -> String {
    format!("cannot {what} {}: {error}", file.display())
}

/// A compiled checker.
pub(crate) struct Checker<'f> {
    folder: &'f Folder,
    file: PathBuf,
}

impl Checker<'_> {
    /// Visits every state; no claim may be in it.
    pub(crate) fn count(&self) -> Result<Counted, String> {
        let said = run(Command::new(&self.file).args(SEARCH).arg("-c0").current_dir(&self.folder.0))?;
        counted(&said)
    }

    /// Whether it finds a path that contradicts the formula `name`.
    pub(crate) fn refutes(&self, name: &str) -> Result<bool, String> {
        let mut command = Command::new(&self.file);
        let said = run(command.args(SEARCH).args(["-N", name]).current_dir(&self.folder.0))?;
        refuted(&said, name)
    }
}

/// Runs a command to its end: all that it said, or why it did not end well.
fn run(command: &mut Command) -> Result<String, String> {
    let name = Path::new(command.get_program()).file_name().unwrap_or_default().to_string_lossy().into_owned();
    let done = command.stdin(Stdio::null()).output().map_err(|error| format!("{name} does not run: {error}"))?;
    let said = format!("{}{}", String::from_utf8_lossy(&done.stdout), String::from_utf8_lossy(&done.stderr));
    if done.status.success() { Ok(said) } else { Err(format!("{name} ({}): {}", done.status, first_error(&said))) }
}

/// The first line that has an error, or the last one.
fn first_error(said: &str) -> &str {
    let mut lines = said.lines().map(str::trim).filter(|line| !line.is_empty());
    let found = lines.clone().find(|line| line.to_lowercase().contains("error"));
    found.or_else(|| lines.next_back()).unwrap_or("it says nothing")
}

/// Why a search did not come to its end, if it did not.
fn broken_off(said: &str) -> Option<String> {
    let marks =
        ["Search not completed", "max search depth too small", "out of memory", "pan: error", "hash table full"];
    let line = said.lines().find(|line| marks.iter().any(|mark| line.contains(mark)))?;
    Some(format!("the search was broken off: {}", line.trim()))
}

/// What a checker that has searched everything says of states and steps.
///
/// # Errors
/// The search is not complete, or its words are not known.
pub fn counted(said: &str) -> Result<Counted, String> {
    if let Some(why) = broken_off(said) {
        return Err(why);
    }
    if figure(said, |line| line.split_once("errors: ").map(|(_, number)| number)) != Some(0) {
        return Err(format!("a count without claims ends in errors: {}", first_error(said)));
    }
    let states = figure(said, |line| line.strip_suffix(" states, stored"));
    let steps = figure(said, |line| line.strip_suffix(" transitions (= stored+matched)"));
    match (states, steps) {
        (Some(states), Some(steps)) => Ok(Counted { states, steps }),
        _ => Err("the checker prints no count".to_owned()),
    }
}

/// Whether a checker has refuted the property `name`.
///
/// # Errors
/// The search is not complete, or its words are not known.
pub fn refuted(said: &str, name: &str) -> Result<bool, String> {
    if !said.lines().any(|line| line == format!("pan: ltl formula {name}")) {
        return Err(format!("the property {name}: {}", first_error(said)));
    }
    match figure(said, |line| line.split_once("errors: ").map(|(_, number)| number)) {
        Some(0) => broken_off(said).map_or(Ok(false), Err),
        Some(_) if said.contains("assertion violated") => Ok(true),
        _ => Err(format!("the property {name}: {}", first_error(said))),
    }
}

/// The number in the first line that has one.
fn figure<'a>(said: &'a str, of: impl Fn(&'a str) -> Option<&'a str>) -> Option<u64> {
    said.lines().map(str::trim).find_map(of)?.trim().parse().ok()
}
