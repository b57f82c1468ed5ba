//! A run as JUnit: one test case a machine.

use std::time::Duration;

use quick_junit::{NonSuccessKind, Report as Junit, TestCase, TestCaseStatus, TestSuite};

use super::{Report, Word, text};

/// A test case.
pub(crate) struct Entry {
    /// Its name and its class.
    pub(crate) name: String,
    pub(crate) class: &'static str,
    /// Agreement is a success, what was not compared is skipped, what is broken is an error, and all else a failure.
    pub(crate) verdict: Word,
    /// One line, and all there is to say; for what agrees neither is written.
    pub(crate) message: String,
    pub(crate) description: String,
    /// How long it took.
    pub(crate) time: Duration,
}

/// The report as JUnit XML.
///
/// # Errors
/// If it cannot be written, which memory does not do.
pub fn junit(report: &Report) -> Result<String, String> {
    let entries = report.machines.iter().map(|machine| {
        let alone = Report { machines: vec![machine.clone()], ..report.clone() };
        let description = text(&alone);
        let message = match machine.verdict {
            Word::NotCompared => machine.note.clone().unwrap_or_default(),
            _ => machine.note.clone().unwrap_or_else(|| summary(&description)),
        };
        let time = Duration::from_secs_f64(machine.seconds.max(0.0));
        let (name, class) = (machine.machine.clone(), "conformance");
        Entry { name, class, verdict: machine.verdict, message, description, time }
    });
    let suite = report.implementation.clone().unwrap_or_else(|| report.command.clone());
    write_junit("oracle conform", suite, entries)
}

/// Test cases as JUnit XML.
///
/// # Errors
/// If it cannot be written, which memory does not do.
pub(crate) fn write_junit(of: &str, suite: String, entries: impl IntoIterator<Item = Entry>) -> Result<String, String> {
    let mut suite = TestSuite::new(suite);
    for entry in entries {
        let status = match entry.verdict {
            Word::Agrees => TestCaseStatus::success(),
            Word::NotCompared => {
                let mut status = TestCaseStatus::skipped();
                status.set_message(entry.message);
                status
            }
            Word::Differs | Word::KnownDifferenceGone | Word::Broken => {
                let kind = if entry.verdict == Word::Broken { NonSuccessKind::Error } else { NonSuccessKind::Failure };
                let mut status = TestCaseStatus::non_success(kind);
                status.set_type(entry.verdict.name()).set_message(entry.message).set_description(entry.description);
                status
            }
        };
        let mut case = TestCase::new(entry.name, status);
        case.set_classname(entry.class).set_time(entry.time);
        suite.add_test_case(case);
    }
    let mut junit = Junit::new(of);
    junit.add_test_suite(suite);
    junit.to_string().map_err(|error| error.to_string())
}

/// The line of the first field.
fn summary(said: &str) -> String {
    said.lines().nth(2).unwrap_or_default().trim().to_owned()
}
