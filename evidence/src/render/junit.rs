//! The results in the JUnit form that build servers read.

use crate::case::{Case, Evidence, Kind};
use crate::judge::verdict::Verdict;
use quick_junit::{NonSuccessKind, Report, TestCase, TestCaseStatus, TestSuite};
use std::time::Duration;

/// The report as XML.
///
/// # Errors
/// The text cannot be written as XML.
pub fn xml(case: &Case) -> Result<String, String> {
    let mut report = Report::new("safety-case");
    for kind in [Kind::Harness, Kind::Model, Kind::Mutant, Kind::Measured, Kind::Test] {
        let mut suite = TestSuite::new(kind.word());
        for one in case.evidence.iter().filter(|one| one.kind == kind) {
            suite.add_test_case(whole(one));
            for claim in &one.claims {
                let name = format!("{}: {}", claim.name, claim.text);
                suite.add_test_case(self::case(&one.id, &name, claim.verdict, one.reason.as_deref()));
            }
        }
        report.add_test_suite(suite);
    }
    report.to_string().map_err(|error| error.to_string())
}

fn whole(one: &Evidence) -> TestCase {
    let mut test = case(&one.id, &one.title, one.verdict, one.reason.as_deref());
    test.set_time(Duration::try_from_secs_f64(one.seconds).unwrap_or_default());
    test
}

/// Holds: success. Failed or vacuous: failure. No result: error. Not run or stale: skipped.
fn case(class: &str, name: &str, verdict: Verdict, reason: Option<&str>) -> TestCase {
    let mut status = match verdict {
        Verdict::NotRun | Verdict::Stale => TestCaseStatus::skipped(),
        Verdict::Failed | Verdict::Vacuous => TestCaseStatus::non_success(NonSuccessKind::Failure),
        Verdict::Undecided => TestCaseStatus::non_success(NonSuccessKind::Error),
        _ => TestCaseStatus::success(),
    };
    if !verdict.holds() {
        status.set_message(format!("{verdict}: {}", reason.unwrap_or("no reason given")));
    }
    let mut test = TestCase::new(name, status);
    test.set_classname(class);
    test
}
