//! Tests: the closing lines of `cargo test`, one for each test binary.
//!
//! What cargo prints is the only stable interface without nightly. So the reading is strict: a binary that was started
//! and has no closing line was killed, and a run in which no test ran is an error, not a success.

use super::cargo;
use crate::case::{Evidence, Kind};
use crate::judge::verdict::Verdict;
use serde::{Deserialize, Serialize};
use std::collections::BTreeSet;
use std::fs::File;
use std::io;
use std::path::{Path, PathBuf};

/// One test binary's closing line.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Suite {
    /// `test:` and the binary's name; `test:doc:` and the crate's for examples in the documentation.
    pub name: String,
    /// Tests that passed.
    pub passed: u64,
    /// Tests that failed.
    pub failed: u64,
    /// Tests that were left out by an attribute.
    pub ignored: u64,
    /// Tests that were left out by a filter.
    pub filtered: u64,
    /// There was a closing line.
    pub finished: bool,
}

/// A whole run.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Run {
    /// Nobody asked for it.
    NotRun(String),
    /// It ran; the exit code if it is known.
    Ran {
        /// One for each binary.
        suites: Vec<Suite>,
        /// Whether cargo ended without complaint.
        success: bool,
    },
}

/// Runs `cargo test` with these arguments on the workspace at `root`, with its output in the file `log`.
///
/// # Errors
/// Cargo cannot be started, or the log cannot be written.
pub fn run(root: &Path, log: &Path, arguments: &[&str]) -> io::Result<Run> {
    let file = File::create(log)?;
    let mut command = cargo::command(root);
    command.args(["test", "--no-fail-fast", "--color=never"]).args(arguments);
    // One file for both streams: the binaries' names are on one, their results on the other, in turn.
    command.stdout(file.try_clone()?).stderr(file);
    let status = cargo::status(&mut command, None)?;
    Ok(parse(&std::fs::read_to_string(log)?, status.is_some_and(|status| status.success())))
}

/// Where the tests write what they find.
#[derive(Clone, Debug)]
pub struct Files {
    /// What they print.
    pub log: PathBuf,
    /// What they find of the models: [`atc_models::Searched`].
    pub outcomes: PathBuf,
    /// What they find of the theorems, natively: a campaign.
    pub native: PathBuf,
}

/// Runs tests of the checkout at `root` as `ci/test` does, beside other work: these programs, or all. Also their seconds of
/// processors.
///
/// # Errors
/// They cannot be started, or the log cannot be written.
pub fn run_beside(root: &Path, files: &Files, programs: Option<&BTreeSet<String>>) -> io::Result<(Run, f64)> {
    // The script keeps the log; what it prints besides is of no use here.
    let said = File::create(files.log.with_extension("said"))?;
    let mut command = cargo::in_checkout(root, &root.join(SCRIPT));
    command
        .arg(&files.log)
        .args(programs.into_iter().flatten())
        .env("ATC_OUTCOMES", &files.outcomes)
        .env("ATC_NATIVE", &files.native);
    command.stdout(said.try_clone()?).stderr(said);
    let (status, seconds) = cargo::status_beside(&mut command)?;
    Ok((parse(&std::fs::read_to_string(&files.log)?, status.success()), seconds))
}

/// What runs them, from the checkout.
pub const SCRIPT: &str = "ci/lib/tests";

/// Reads what `cargo test` printed, both streams in one.
pub fn parse(text: &str, success: bool) -> Run {
    let mut suites: Vec<Suite> = Vec::new();
    for line in text.lines() {
        let line = line.trim();
        if let Some(name) = started(line) {
            suites.push(Suite { name, passed: 0, failed: 0, ignored: 0, filtered: 0, finished: false });
        } else if let Some(numbers) = line.strip_prefix("test result: ") {
            let number = |word: &str| {
                let before = numbers.split([';', '.']).find_map(|part| part.trim().strip_suffix(word))?;
                before.trim().parse::<u64>().ok()
            };
            let known = number("passed").zip(number("failed")).zip(number("ignored")).zip(number("filtered out"));
            if let (Some(suite), Some((((passed, failed), ignored), filtered))) = (suites.last_mut(), known) {
                if suite.finished {
                    // Documentation tests come in parts: those that share a binary, and the others.
                    suite.passed += passed;
                    suite.failed += failed;
                    suite.ignored += ignored;
                    suite.filtered += filtered;
                } else {
                    *suite = Suite { passed, failed, ignored, filtered, finished: true, ..suite.clone() };
                }
            }
        }
    }
    Run::Ran { suites, success }
}

/// `Running unittests src/lib.rs (target/debug/deps/atc_kernel-0123)` or `Doc-tests atc_kernel`.
fn started(line: &str) -> Option<String> {
    if let Some(name) = line.strip_prefix("Doc-tests ") {
        return Some(format!("doc:{name}"));
    }
    let rest = line.strip_prefix("Running ")?;
    let file = rest.strip_suffix(')')?.rsplit('(').next()?.rsplit(['/', '\\']).next()?;
    let (name, _hash) = file.trim_end_matches(".exe").rsplit_once('-')?;
    Some(name.to_owned())
}

/// The evidence: one for each suite that has tests, and `test:all`.
pub fn evidence(run: &Run) -> Vec<Evidence> {
    let (suites, success) = match run {
        Run::NotRun(why) => return vec![one("all", Verdict::NotRun, String::new(), Some(why.clone()))],
        Run::Ran { suites, success } => (suites, *success),
    };
    let mut all: Vec<_> = suites.iter().filter(|suite| !suite.finished || suite.passed + suite.failed > 0).collect();
    all.sort_by(|a, b| a.name.cmp(&b.name));
    // The same name twice (a library and a binary of one crate): one suite.
    let mut merged: Vec<Suite> = Vec::new();
    for suite in all {
        match merged.last_mut() {
            Some(last) if last.name == suite.name => {
                last.passed += suite.passed;
                last.failed += suite.failed;
                last.ignored += suite.ignored;
                last.filtered += suite.filtered;
                last.finished &= suite.finished;
            }
            _ => merged.push(suite.clone()),
        }
    }
    let mut found: Vec<_> = merged.iter().map(judge).collect();
    let sum = |f: fn(&Suite) -> u64| suites.iter().map(f).sum::<u64>();
    let (passed, failed) = (sum(|suite| suite.passed), sum(|suite| suite.failed));
    let (ignored, filtered) = (sum(|suite| suite.ignored), sum(|suite| suite.filtered));
    let detail = numbers(passed, failed, ignored, filtered);
    let worst = Verdict::worst(found.iter().map(|one| one.verdict));
    let (verdict, reason) = match worst {
        _ if passed + failed == 0 => (Verdict::Undecided, Some("no test ran".to_owned())),
        Some(worst) if !worst.holds() => (worst, Some("see the suites".to_owned())),
        _ if !success => (Verdict::Undecided, Some("cargo test ended with an error".to_owned())),
        _ => (Verdict::Tested, None),
    };
    found.push(one("all", verdict, detail, reason));
    found
}

fn judge(suite: &Suite) -> Evidence {
    let detail = numbers(suite.passed, suite.failed, suite.ignored, suite.filtered);
    let (verdict, reason) = if suite.failed > 0 {
        (Verdict::Failed, Some(format!("{} failed", suite.failed)))
    } else if !suite.finished {
        (Verdict::Undecided, Some("started, and no result: killed?".to_owned()))
    } else if suite.filtered > 0 {
        (Verdict::Undecided, Some(format!("{} left out by a filter", suite.filtered)))
    } else {
        (Verdict::Tested, None)
    };
    one(&suite.name, verdict, detail, reason)
}

fn numbers(passed: u64, failed: u64, ignored: u64, filtered: u64) -> String {
    let mut text = format!("{passed} passed");
    for (number, word) in [(failed, "failed"), (ignored, "ignored"), (filtered, "filtered out")] {
        if number > 0 {
            text = format!("{text}, {number} {word}");
        }
    }
    text
}

/// The evidence of one suite.
pub fn one(name: &str, verdict: Verdict, detail: String, reason: Option<String>) -> Evidence {
    let title = if name == "all" { "All tests of this run" } else { name };
    Evidence { title: title.to_owned(), detail, reason, ..Evidence::bare(Kind::Test, name, verdict) }
}

#[cfg(test)]
mod checks {
    use super::{Run, evidence, parse};
    use crate::judge::verdict::Verdict;

    const GOOD: &str = "\
     Running unittests src/lib.rs (target/debug/deps/atc_kernel-01)\n
test result: ok. 3 passed; 0 failed; 1 ignored; 0 measured; 0 filtered out; finished in 0.00s\n
     Running tests/charts.rs (target/debug/deps/charts-02)\n
test result: ok. 4 passed; 0 failed; 0 ignored; 0 measured; 0 filtered out; finished in 0.00s\n
   Doc-tests atc_kernel\n
test result: ok. 1 passed; 0 failed; 0 ignored; 0 measured; 0 filtered out; finished in 0.10s\n";

    fn all(text: &str, success: bool) -> (Verdict, String) {
        let evidence = evidence(&parse(text, success));
        let all = evidence.iter().find(|one| one.id == "test:all").expect("always there");
        (all.verdict, all.detail.clone())
    }

    #[test]
    fn numbers_are_read() {
        assert_eq!(all(GOOD, true), (Verdict::Tested, "8 passed, 1 ignored".to_owned()));
        let ids: Vec<_> = evidence(&parse(GOOD, true)).into_iter().map(|one| one.id).collect();
        assert_eq!(ids, ["test:atc_kernel", "test:charts", "test:doc:atc_kernel", "test:all"]);
    }

    #[test]
    fn no_tests_are_no_success() {
        assert_eq!(all("", true).0, Verdict::Undecided);
        let none = GOOD.replace("3 passed", "0 passed").replace("4 passed", "0 passed").replace("1 passed", "0 passed");
        assert_eq!(all(&none, true).0, Verdict::Undecided);
    }

    #[test]
    fn a_filter_a_killed_binary_a_failure_and_a_bad_exit_are_seen() {
        assert_eq!(all(&GOOD.replace("0 filtered", "2 filtered"), true).0, Verdict::Undecided);
        assert_eq!(all(&GOOD.replace("4 passed; 0 failed", "3 passed; 1 failed"), true).0, Verdict::Failed);
        assert_eq!(all(GOOD, false).0, Verdict::Undecided);
        let killed = GOOD.lines().filter(|line| !line.contains("4 passed")).collect::<Vec<_>>().join("\n");
        assert_eq!(all(&killed, true).0, Verdict::Undecided);
        let not = evidence(&Run::NotRun("--no-tests".to_owned()));
        assert_eq!(not[0].verdict, Verdict::NotRun);
    }
}
