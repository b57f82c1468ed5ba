//! A run as JUnit: one test case a machine.

use quick_junit::{NonSuccessKind, Report as Junit, TestCase, TestCaseStatus, TestSuite};

use super::{Report, Word, text};

/// The report as JUnit XML.
///
/// # Errors
/// If it cannot be written, which memory does not do.
pub fn junit(report: &Report) -> Result<String, String> {
    let mut suite = TestSuite::new(report.implementation.clone().unwrap_or_else(|| report.command.clone()));
    for machine in &report.machines {
        let alone = Report { machines: vec![machine.clone()], ..report.clone() };
        let said = text(&alone);
        let status = match machine.verdict {
            Word::Agrees => TestCaseStatus::success(),
            Word::NotCompared => {
                let mut status = TestCaseStatus::skipped();
                status.set_message(machine.note.clone().unwrap_or_default());
                status
            }
            Word::Differs | Word::KnownDifferenceGone | Word::Broken => {
                let kind =
                    if machine.verdict == Word::Broken { NonSuccessKind::Error } else { NonSuccessKind::Failure };
                let mut status = TestCaseStatus::non_success(kind);
                status
                    .set_type(machine.verdict.name())
                    .set_message(machine.note.clone().unwrap_or_else(|| summary(&said)))
                    .set_description(said.clone());
                status
            }
        };
        let mut case = TestCase::new(machine.machine.clone(), status);
        case.set_classname("conformance").set_time(std::time::Duration::from_secs_f64(machine.seconds.max(0.0)));
        suite.add_test_case(case);
    }
    let mut junit = Junit::new("oracle conform");
    junit.add_test_suite(suite);
    junit.to_string().map_err(|error| error.to_string())
}

/// The line of the first field.
fn summary(said: &str) -> String {
    said.lines().nth(2).unwrap_or_default().trim().to_owned()
}
