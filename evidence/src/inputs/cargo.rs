//! Cargo, on the checkout that the case is about and with nothing of another one.

use std::path::Path;
use std::process::{Command, Stdio};

/// Cargo at `root`, without an input. It builds into `root/target`, whatever the environment or a configuration file names: in a
/// folder that checkouts share, Cargo can take a binary of one for that of another, and its results would be credited to these
/// sources.
pub fn command(root: &Path) -> Command {
    let mut command = Command::new(std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into()));
    let target = root.join("target");
    // The second is where newer versions put everything but what is asked for: test binaries as well.
    command.env("CARGO_TARGET_DIR", &target).env("CARGO_BUILD_BUILD_DIR", &target);
    command.current_dir(root).stdin(Stdio::null());
    command
}

#[cfg(test)]
mod checks {
    use crate::inputs::tests::{self, Run};
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
            let Run::Ran { suites, success } = tests::run(&root, &at("log")).expect("cargo runs") else {
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
