//! A replay as JUnit: one test case a machine, and one for each place that was not read.

use std::time::Duration;

use super::text::{place, sentence, summary};
use super::{Report, text};
use crate::conform::report::{Entry, Word, write_junit};

/// The report as JUnit XML.
///
/// # Errors
/// If it cannot be written, which memory does not do.
pub fn junit(report: &Report) -> Result<String, String> {
    let mut entries = Vec::new();
    for machine in &report.machines {
        let differences =
            report.differences.iter().filter(|one| one.machine == machine.machine).cloned().collect::<Vec<_>>();
        let message = machine.note.clone().or_else(|| differences.first().map(place)).unwrap_or_default();
        let alone = Report {
            machines: vec![machine.clone()],
            differences,
            unread: Vec::new(),
            unread_in_all: 0,
            ..report.clone()
        };
        entries.push(Entry {
            name: machine.machine.clone(),
            class: "replay",
            verdict: machine.verdict,
            message,
            description: text(&alone),
            time: Duration::ZERO,
        });
    }
    for unread in &report.unread {
        entries.push(Entry {
            name: if unread.line > 0 { format!("{}: line {}", unread.file, unread.line) } else { unread.file.clone() },
            class: "replay.not-read",
            verdict: Word::Broken,
            message: sentence(unread),
            description: sentence(unread),
            time: Duration::ZERO,
        });
    }
    if entries.is_empty() {
        entries.push(Entry {
            name: "replay".to_owned(),
            class: "replay",
            verdict: Word::NotCompared,
            message: "nothing was compared".to_owned(),
            description: summary(report),
            time: Duration::ZERO,
        });
    }
    let suite = report.profile.implementation.clone().unwrap_or_else(|| "logs".to_owned());
    write_junit("oracle replay", suite, entries)
}
