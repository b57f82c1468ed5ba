//! Runs a program with a limit of CPU time and one of memory, and ends all that it started.

use nix::fcntl::{Flock, FlockArg};
use std::collections::BTreeSet;
use std::fs::File;
use std::io::Write;
use std::os::unix::process::CommandExt;
use std::path::{Path, PathBuf};
use std::process::{Command, ExitStatus, Stdio};
use std::sync::{Mutex, PoisonError};
use std::time::Duration;
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

/// What ran, each with its CPU time and its end: for whoever wants to know where the time goes.
static LEDGER: Mutex<Option<File>> = Mutex::new(None);

/// The folder of the proofs, for one run at a time: another run that wants it waits. What runs is listed there in `runs.tsv`.
///
/// # Errors
/// The folder cannot be made, or the system has no locks.
pub fn only_run(folder: &Path) -> Result<Flock<File>, String> {
    let failed = |error: &dyn std::fmt::Display| format!("{}: {error}", folder.display());
    std::fs::create_dir_all(folder).map_err(|error| failed(&error))?;
    let file = File::create(folder.join("lock")).map_err(|error| failed(&error))?;
    let lock = Flock::lock(file, FlockArg::LockExclusive).map_err(|(_, error)| failed(&error))?;
    let ledger = File::options().create(true).append(true).open(folder.join("runs.tsv"));
    *LEDGER.lock().unwrap_or_else(PoisonError::into_inner) = Some(ledger.map_err(|error| failed(&error))?);
    Ok(lock)
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
    /// CPU time: a machine that has other work to do makes no prover late.
    pub cpu: Duration,
    /// Address space in KiB.
    pub memory_kib: u64,
}

impl Limits {
    /// The wall time after which a program that uses no CPU time is given up: it waits for something that never comes.
    fn wall(&self) -> Duration {
        self.cpu * 30 + Duration::from_mins(2)
    }

    fn cpu_seconds(&self) -> u64 {
        self.cpu.as_secs().max(1)
    }

    /// From when on a program that did not end well is taken to have been ended for its time. The system counts time in two ways, and on a busy machine they
    /// differ: it has ended a program at 30 s that had taken 27.6 s. An answer (10, of CBMC) is thrown away for its last second only.
    fn nearly(&self, status: ExitStatus) -> Duration {
        let limit = Duration::from_secs(self.cpu_seconds());
        let last = limit.saturating_sub(Duration::from_secs(1));
        if status.code() == Some(10) { last } else { last.min(limit * 7 / 8) }
    }
}

/// A program to run: with these arguments and this addition to the environment, in `folder`.
#[derive(Clone, Debug)]
pub struct Job<'a> {
    /// The program.
    pub program: &'a Path,
    /// Its arguments.
    pub arguments: &'a [String],
    /// Variables to set.
    pub variables: &'a [(&'a str, String)],
    /// The current folder.
    pub folder: &'a Path,
    /// The file that its output goes to; its errors go to the same name with `.err` added, its CPU times to that with `.times`.
    pub output: &'a Path,
    /// The limits.
    pub limits: Limits,
}

/// Runs "$@" within the limits, and writes the CPU time that it took. Its standard input is a pipe that only the runner has the other end
/// of: when the runner is gone, for whatever reason, the pipe ends, and the whole process group with it. What is started has the pipe as
/// well, number 3, for what it starts in a group of its own ([`SOLVER`]).
const GUARD: &str = r#"
memory=$1 cpu=$2 times=$3
shift 3
ulimit -v "$memory"
ulimit -S -t "$cpu"
ulimit -H -t "$((cpu + 2))"
exec 3<&0
"$@" </dev/null &
main=$!
{ read -r _ <&3; kill -KILL 0; } &
guard=$!
exec 3<&-
wait "$main"
status=$?
times >"$times"
kill "$guard"
exit "$status"
"#;

/// The shell's word for SIGXCPU.
const OUT_OF_TIME: i32 = 128 + 24;

/// Runs a solver for CBMC, which gives it a process group of its own: it ends when the pipe does.
pub const SOLVER: &str = r#"#!/bin/sh
"$solver" "$@" 3<&- &
main=$!
{ : <&3; } 2>/dev/null && { read -r _ <&3; kill -KILL "$main"; } &
guard=$!
wait "$main"
status=$?
kill "$guard" 2>/dev/null
exit "$status"
"#;

/// Where the errors of a job go whose output goes to `output`.
pub fn errors_of(output: &Path) -> PathBuf {
    beside(output, ".err")
}

fn beside(output: &Path, ending: &str) -> PathBuf {
    let mut name = output.as_os_str().to_owned();
    name.push(ending);
    name.into()
}

/// Runs a program to its end, or to its limits; also the CPU time that it took.
///
/// # Errors
/// The program cannot be started, or the files cannot be written.
pub fn run(job: &Job) -> Result<(End, Duration), String> {
    let open = |path: &Path| File::create(path).map_err(|error| format!("{}: {error}", path.display()));
    let times = beside(job.output, ".times");
    let (output, errors) = (open(job.output)?, open(&errors_of(job.output))?);
    let mut command = Command::new("sh");
    command
        .args(["-c", GUARD, "sh"])
        .arg(job.limits.memory_kib.to_string())
        .arg(job.limits.cpu_seconds().to_string())
        .arg(&times)
        .arg(job.program)
        .args(job.arguments)
        .envs(job.variables.iter().map(|(name, value)| (name, value)))
        .current_dir(job.folder)
        .stdin(Stdio::piped())
        .stdout(output)
        .stderr(errors)
        .process_group(0);
    let failed = |error: &dyn std::fmt::Display| format!("{}: {error}", job.program.display());
    let (mut child, group) = {
        let mut groups = GROUPS.lock().unwrap_or_else(PoisonError::into_inner);
        let child = command.spawn().map_err(|error| format!("{} cannot be started: {error}", job.program.display()))?;
        let group = i32::try_from(child.id()).map_err(|error| failed(&error))?;
        groups.insert(group);
        (child, group)
    };
    // Held to the end. (`wait` closes it.)
    let pipe = child.stdin.take();
    let ended = child.wait_timeout(job.limits.wall());
    if matches!(ended, Ok(None)) {
        end_group(group);
        let _ = child.wait();
    }
    drop(pipe);
    GROUPS.lock().unwrap_or_else(PoisonError::into_inner).remove(&group);
    let status = ended.map_err(|error| failed(&error))?;
    let took = cpu_time(&std::fs::read_to_string(&times).unwrap_or_default());
    let end = match (status, took) {
        (None, _) => End::Late,
        (Some(status), _) if status.code() == Some(OUT_OF_TIME) => End::Late,
        // What a program says when one that it has started was out of time does not matter.
        (Some(status), Some(took)) if !status.success() && took >= job.limits.nearly(status) => End::Late,
        // The shell's word for a signal.
        (Some(status), _) => status.code().filter(|code| *code <= 128).map_or(End::Killed, End::Code),
    };
    if let Some(ledger) = LEDGER.lock().unwrap_or_else(PoisonError::into_inner).as_mut() {
        // It is there to be read by people: no run fails for it.
        let _ = writeln!(ledger, "{}\t{:.2}\t{end:?}", job.output.display(), took.unwrap_or_default().as_secs_f64());
    }
    Ok((end, took.unwrap_or_default()))
}

/// What the children of a shell took, of what its `times` says: user and system time in the second line, as `1m2.3s 0m0.4s`.
fn cpu_time(times: &str) -> Option<Duration> {
    let second = times.lines().nth(1)?;
    let seconds = |text: &str| {
        let (minutes, seconds) = text.strip_suffix('s')?.split_once('m')?;
        Some(minutes.parse::<f64>().ok()? * 60.0 + seconds.replace(',', ".").parse::<f64>().ok()?)
    };
    let parts: Option<Vec<f64>> = second.split_whitespace().map(seconds).collect();
    Duration::try_from_secs_f64(parts?.into_iter().sum()).ok()
}

#[cfg(test)]
mod tests {
    use super::{End, Job, Limits, cpu_time, run};
    use std::path::Path;
    use std::sync::atomic::{AtomicUsize, Ordering};
    use std::time::Duration;

    fn run_here(script: &str, cpu: u64) -> (End, Duration) {
        static RUN: AtomicUsize = AtomicUsize::new(0);
        let run_number = RUN.fetch_add(1, Ordering::Relaxed);
        let folder = std::env::temp_dir().join(format!("atc-process-{}-{run_number}", std::process::id()));
        std::fs::create_dir_all(&folder).expect("a folder");
        let arguments = ["-c".to_owned(), script.to_owned()];
        let limits = Limits { cpu: Duration::from_secs(cpu), memory_kib: 1 << 22 };
        let output = folder.join("out");
        let program = Path::new("/bin/sh");
        let job = Job { program, arguments: &arguments, variables: &[], folder: &folder, output: &output, limits };
        let ended = run(&job).expect("it runs");
        std::fs::remove_dir_all(&folder).expect("removed");
        ended
    }

    #[test]
    fn an_end_is_told_as_it_was() {
        assert_eq!(run_here("exit 10", 5).0, End::Code(10));
        assert_eq!(run_here("kill -KILL $$", 5).0, End::Killed);
    }

    /// Whatever time it is said to have taken.
    #[test]
    fn a_program_that_is_told_so_is_out_of_time() {
        assert_eq!(run_here("kill -XCPU $$", 500).0, End::Late);
    }

    #[test]
    fn waiting_makes_nothing_late() {
        assert_eq!(run_here("sleep 2", 1).0, End::Code(0));
    }

    #[test]
    fn work_is_ended_at_its_limit_whoever_does_it() {
        let (end, took) = run_here("while :; do :; done", 1);
        assert_eq!(end, End::Late);
        // The system looks at the limit now and then, and counts in ticks.
        assert!(took >= Duration::from_millis(500) && took < Duration::from_secs(3), "{took:?}");
        // A child of the program, whose end the program takes for an error.
        assert_eq!(run_here("sh -c 'while :; do :; done' || exit 6", 1).0, End::Late);
    }

    #[test]
    fn times_are_read_in_minutes_and_seconds() {
        assert_eq!(cpu_time("0m0.00s 0m0.01s\n1m2.50s 0m0.25s\n"), Some(Duration::from_millis(62_750)));
        assert_eq!(cpu_time("0m0.00s 0m0.01s\n"), None);
    }
}
