//! Runs a program with a time limit and a memory limit, and ends all that it started.

use nix::fcntl::{Flock, FlockArg};
use std::fs::File;
use std::os::unix::process::CommandExt;
use std::path::Path;
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};
use wait_timeout::ChildExt;

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
    let mut child = Command::new("sh")
        .args(["-c", "ulimit -v \"$0\"; exec \"$@\""])
        .arg(job.limits.memory_kib.to_string())
        .arg(job.program)
        .args(job.arguments)
        .envs(job.variable.clone())
        .current_dir(job.folder)
        .stdin(Stdio::null())
        .stdout(open(job.output)?)
        .stderr(open(Path::new(&errors))?)
        .process_group(0)
        .spawn()
        .map_err(|error| format!("{} cannot be started: {error}", job.program.display()))?;
    let group = i32::try_from(child.id()).map(nix::unistd::Pid::from_raw);
    let ended = child.wait_timeout(job.limits.time).map_err(|error| format!("{}: {error}", job.program.display()))?;
    let end = if let Some(status) = ended {
        status.code().map_or(End::Killed, End::Code)
    } else {
        if let Ok(group) = group {
            // It may just have ended; then there is nothing to kill.
            let _ = nix::sys::signal::killpg(group, nix::sys::signal::Signal::SIGKILL);
        }
        let _ = child.wait();
        End::Late
    };
    Ok((end, started.elapsed()))
}
