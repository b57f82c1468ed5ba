//! Runs a program with a time limit and a memory limit, and ends all that it started.

use nix::fcntl::{Flock, FlockArg};
use std::collections::BTreeSet;
use std::fs::File;
use std::os::unix::process::CommandExt;
use std::path::Path;
use std::process::{Command, Stdio};
use std::sync::{Mutex, PoisonError};
use std::time::{Duration, Instant};
use wait_timeout::ChildExt;

/// The process groups of the programs that run. Each has its own, so that its end takes along what it started; so an interrupt
/// of this program does not reach them by itself.
static GROUPS: Mutex<BTreeSet<i32>> = Mutex::new(BTreeSet::new());

/// Lets an interrupt (Ctrl-C), a hang-up or a request to end take along the programs that run: exit code 130.
///
/// # Errors
/// The system has no such signals, or another handler was set.
pub fn end_all_on_interrupt() -> Result<(), String> {
    let end = || {
        // Held until the exit: nothing is started any more.
        let groups = GROUPS.lock().unwrap_or_else(PoisonError::into_inner);
        for group in groups.iter() {
            end_group(*group);
        }
        std::process::exit(130);
    };
    ctrlc::set_handler(end).map_err(|error| format!("interrupts cannot be handled: {error}"))
}

/// Kills a process group. It may just have ended; then there is nothing to kill.
fn end_group(group: i32) {
    let _ = nix::sys::signal::killpg(nix::unistd::Pid::from_raw(group), nix::sys::signal::Signal::SIGKILL);
}

/// The folder of the proofs, for one run at a time: another run that wants it waits.
///
/// # Errors
/// The folder cannot be made, or the system has no locks.
pub fn only_run(folder: &Path) -> Result<Flock<File>, String> {
    let failed = |error: &dyn std::fmt::Display| format!("{}: {error}", folder.display());
    std::fs::create_dir_all(folder).map_err(|error| failed(&error))?;
    let file = File::create(folder.join("lock")).map_err(|error| failed(&error))?;
    Flock::lock(file, FlockArg::LockExclusive).map_err(|(_, error)| failed(&error))
}

/// How a program ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum End {
    /// With this exit code.
    Code(i32),
    /// By a signal, which is what happens when memory runs out.
    Killed,
    /// Not within the time limit; it was killed.
    Late,
}

/// The limits of one run.
#[derive(Clone, Copy, Debug)]
pub struct Limits {
    /// Wall time.
    pub time: Duration,
    /// Address space in KiB.
    pub memory_kib: u64,
}

/// A program to run: with these arguments and this addition to the environment, in `folder`.
#[derive(Clone, Debug)]
pub struct Job<'a> {
    /// The program.
    pub program: &'a Path,
    /// Its arguments.
    pub arguments: &'a [String],
    /// A variable to set.
    pub variable: Option<(&'a str, String)>,
    /// The current folder.
    pub folder: &'a Path,
    /// The file that its output goes to; its errors go to the same name with `.err` added.
    pub output: &'a Path,
    /// The limits.
    pub limits: Limits,
}

/// Runs a program to its end, or to its limits.
///
/// # Errors
/// The program cannot be started, or the files cannot be written.
pub fn run(job: &Job) -> Result<(End, Duration), String> {
    let open = |path: &Path| File::create(path).map_err(|error| format!("{}: {error}", path.display()));
    let mut errors = job.output.as_os_str().to_owned();
    errors.push(".err");
    let started = Instant::now();
    let (output, errors) = (open(job.output)?, open(Path::new(&errors))?);
    let (mut child, group) = {
        let mut groups = GROUPS.lock().unwrap_or_else(PoisonError::into_inner);
        let child = Command::new("sh")
            .args(["-c", "ulimit -v \"$0\"; exec \"$@\""])
            .arg(job.limits.memory_kib.to_string())
            .arg(job.program)
            .args(job.arguments)
            .envs(job.variable.clone())
            .current_dir(job.folder)
            .stdin(Stdio::null())
            .stdout(output)
            .stderr(errors)
            .process_group(0)
            .spawn()
            .map_err(|error| format!("{} cannot be started: {error}", job.program.display()))?;
        let group = i32::try_from(child.id()).map_err(|error| format!("{}: {error}", job.program.display()))?;
        groups.insert(group);
        (child, group)
    };
    let ended = child.wait_timeout(job.limits.time);
    if matches!(ended, Ok(None)) {
        end_group(group);
        let _ = child.wait();
    }
    GROUPS.lock().unwrap_or_else(PoisonError::into_inner).remove(&group);
    let end = match ended.map_err(|error| format!("{}: {error}", job.program.display()))? {
        Some(status) => status.code().map_or(End::Killed, End::Code),
        None => End::Late,
    };
    Ok((end, started.elapsed()))
}
