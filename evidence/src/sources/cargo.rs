//! Cargo, on the checkout that the case is about and with nothing of another one.

use crate::cli::times;
use std::io;
use std::os::unix::process::CommandExt;
use std::path::Path;
use std::process::{Command, ExitStatus, Stdio};
use std::time::{Duration, Instant};

/// Runs a program and ends with it. However its own parent ends, the program and all that it has started end too: their group is
/// killed when the other end of the pipe at its input is closed.
const GUARD: &str = r#"
exec 3<&0 </dev/null
"$@" 3<&- &
child=$!
{ read -r _ <&3; kill -s KILL 0; } >/dev/null 2>&1 &
watch=$!
exec 3<&-
wait "$child"
status=$?
kill -s KILL "$watch" 2>/dev/null
exit "$status"
"#;

/// What else to ask of `cargo build`, so that what the tests have built is not built again: with a test in the selection, the
/// dependencies have the same features as there. It is the smallest of the tests.
pub const AS_IN_TESTS: [&str; 4] = ["--locked", "--workspace", "--test", "contracts"];

/// Cargo at `root`, without an input; to be run by [`status`]. It builds into `root/target`, whatever the environment or a configuration file names: in a
/// folder that checkouts share, Cargo can take a binary of one for that of another, and its results would be credited to these
/// sources.
pub fn command(root: &Path) -> Command {
    in_checkout(root, Path::new(&std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into())))
}

/// The same of a program that runs cargo.
pub fn in_checkout(root: &Path, program: &Path) -> Command {
    let mut command = guarded(root, program);
    let target = root.join("target");
    // The second is where newer versions put everything but what is asked for: test binaries as well.
    command.env("CARGO_TARGET_DIR", &target).env("CARGO_BUILD_BUILD_DIR", &target);
    command
}

/// A program at `root`, without an input; to be run by [`status`].
pub fn guarded(root: &Path, program: &Path) -> Command {
    let mut command = Command::new("sh");
    command.args(["-c", GUARD, "sh"]).arg(program);
    command.current_dir(root).stdin(Stdio::piped()).process_group(0);
    command
}

/// Runs what [`command`] has made to its end, or to this limit: nothing then. Nothing that it started is left.
///
/// # Errors
/// It cannot be started or waited for.
pub fn status(command: &mut Command, limit: Option<Duration>) -> io::Result<Option<ExitStatus>> {
    let mut child = command.spawn()?;
    // Waiting would close it.
    let pipe = child.stdin.take();
    let start = Instant::now();
    loop {
        if let Some(status) = child.try_wait()? {
            return Ok(Some(status));
        }
        if limit.is_some_and(|limit| start.elapsed() > limit) {
            drop(pipe);
            child.wait()?;
            return Ok(None);
        }
        std::thread::sleep(Duration::from_millis(50));
    }
}

/// The same of what runs beside the phases of a run; also its seconds of processors, which no phase is charged with.
///
/// # Errors
/// It cannot be started or waited for.
pub fn status_beside(command: &mut Command) -> io::Result<(ExitStatus, f64)> {
    let mut child = command.spawn()?;
    let _pipe = child.stdin.take();
    loop {
        if let Some((status, seconds)) = times::beside(|| child.try_wait().transpose()) {
            return Ok((status?, seconds));
        }
        std::thread::sleep(Duration::from_millis(50));
    }
}

#[cfg(test)]
mod checks {
    use crate::sources::tests::{self, Run};
    use std::fs::{self, File};
    use std::path::{Path, PathBuf};
    use std::time::{Duration, SystemTime};

    /// A checkout of one package with one test, last changed so many seconds ago, whose configuration names a folder for builds.
    fn checkout(folder: &Path, builds: &Path, test: &str, seconds_ago: u64) -> PathBuf {
        fs::create_dir_all(folder.join("src")).expect("a folder");
        fs::create_dir_all(folder.join(".cargo")).expect("a folder");
        let config = format!(
            "[build]\ntarget-dir = {0:?}\nbuild-dir = {0:?}\n[net]\noffline = true\n",
            builds.display().to_string()
        );
        let manifest = "[package]\nname = \"one\"\nedition = \"2021\"\n[lib]\ndoctest = false\n[workspace]\n";
        for (name, text) in [(".cargo/config.toml", config.as_str()), ("Cargo.toml", manifest), ("src/lib.rs", test)] {
            let path = folder.join(name);
            fs::write(&path, text).expect("written");
            let changed = SystemTime::now() - Duration::from_secs(seconds_ago);
            File::options()
                .write(true)
                .open(&path)
                .and_then(|file| file.set_modified(changed))
                .expect("its time is set");
        }
        folder.to_path_buf()
    }

    /// Two checkouts whose configuration names one folder for builds; the sources of the second are older than what the first built.
    #[test]
    fn no_test_binary_of_another_checkout_is_credited() {
        let folder = tempfile::tempdir().expect("a folder");
        let at = |name: &str| folder.path().join(name);
        let good = checkout(&at("good"), &at("shared"), "#[test]\nfn one() {}\n", 3600);
        let bad = checkout(&at("bad"), &at("shared"), "#[test]\nfn one() {\n    panic!()\n}\n", 7200);
        for (root, counts) in [(good, (1, 0)), (bad, (0, 1))] {
            let Run::Ran { suites, success } = tests::run(&root, &at("log"), &["--workspace"]).expect("cargo runs")
            else {
                panic!("it ran")
            };
            let log = fs::read_to_string(at("log")).expect("a log");
            let [suite] = &suites[..] else { panic!("one suite: {log}") };
            assert_eq!((suite.passed, suite.failed, success), (counts.0, counts.1, counts.1 == 0), "{log}");
            assert!(log.contains("(target/debug/"), "{log}");
        }
        assert!(!at("shared").exists(), "something was built outside the checkouts");
    }
}
