//! A replay on a terminal.

use std::fmt::Write as _;

use super::{Differing, OfMachine, Report, Unread};
use crate::conform::report::{Word, fields_text};

/// The most places without a reading that are told one by one.
const TOLD: usize = 20;

/// The report as text.
pub fn text(report: &Report) -> String {
    let mut text = String::new();
    for differing in &report.differences {
        difference(&mut text, differing);
    }
    let differ: u64 = report.machines.iter().map(|machine| machine.differ).sum();
    let told = report.differences.len() as u64;
    if differ > told {
        let _ =
            writeln!(text, "sessions that differ and are not told here: {} (--differences tells more)", differ - told);
    }
    for unread in report.unread.iter().take(TOLD) {
        let _ = writeln!(text, "not read: {}", sentence(unread));
    }
    if report.unread_in_all > TOLD as u64 {
        let more = report.unread_in_all - TOLD as u64;
        let _ = writeln!(text, "not read, and not told here: {more} (--json has the first 1000 of all)");
    }
    for machine in &report.machines {
        of_machine(&mut text, report, machine);
    }
    let _ = writeln!(text, "{}", summary(report));
    text
}

/// The last line.
pub(super) fn summary(report: &Report) -> String {
    let steps = report.steps();
    let unread = match report.unread_in_all {
        0 => String::new(),
        places => format!("; {} NOT READ", counted(places, "place")),
    };
    let any = |word: Word| report.machines.iter().any(|machine| machine.verdict == word);
    let verdict = if any(Word::Differs) || any(Word::KnownDifferenceGone) {
        "DIFFERS"
    } else if any(Word::Agrees) {
        // What could be read agrees; that not everything could be is said behind it.
        if report.unread_in_all == 0 { "AGREES" } else { "NOT ALL WAS READ, the rest agrees" }
    } else {
        "NOTHING WAS COMPARED"
    };
    let mut parts = format!(
        "{verdict}: {} of {} sessions agree, {steps} steps in {}",
        report.machines.iter().map(|machine| machine.agree).sum::<u64>(),
        report.sessions(),
        counted(report.input.files, "file"),
    );
    if report.left_out > 0 {
        let _ = write!(parts, "; {} sessions are not in the sample {}", report.left_out, report.sample);
    }
    if report.without_stop > 0 {
        let _ = write!(parts, "; {} without a stop", report.without_stop);
    }
    if let Some(shard) = report.shard {
        let _ = write!(parts, "; shard {}/{} alone", shard.index, shard.of);
    }
    let seconds = report.seconds.max(1e-9);
    #[expect(clippy::cast_precision_loss, reason = "a rate")]
    let (rate, size) = (steps as f64 / seconds, report.bytes as f64 / 1e6);
    format!("{parts}{unread}; {size:.1} MB, {seconds:.1} s, {rate:.0} steps/s")
}

/// A number of things.
fn counted(number: u64, thing: &str) -> String {
    format!("{number} {thing}{}", if number == 1 { "" } else { "s" })
}

/// What was not read, in a line.
pub(super) fn sentence(unread: &Unread) -> String {
    let mut text = unread.file.clone();
    if unread.line > 0 {
        let _ = write!(text, ": line {}", unread.line);
    }
    let _ = write!(text, ": {}", unread.reason);
    if let Some(about) = unread.about_line {
        let _ = write!(text, " (see line {about})");
    }
    match unread.lines_passed_over {
        0 => {}
        1 => text.push_str("; 1 line behind it was passed over"),
        lines => {
            let _ = write!(text, "; {lines} lines behind it were passed over");
        }
    }
    text
}

/// Where a difference is, in a line.
pub(super) fn place(differing: &Differing) -> String {
    let Differing { file, line, session_line, machine, at, .. } = differing;
    let place = differing.step.map_or_else(|| format!("the {at}"), |step| format!("step {step}"));
    format!("{file}: line {line}: {machine}, {place} of the session of line {session_line}")
}

fn difference(text: &mut String, differing: &Differing) {
    let _ = writeln!(text, "{}", place(differing));
    fields_text(text, &differing.fields);
    if let Some(sentence) = &differing.broken {
        let _ = writeln!(text, "    {sentence}");
    }
    if let Some(line) = differing.late_from_line {
        let _ =
            writeln!(text, "  the step of line {line} had no reply before the next step: a reply may be lost there");
    }
    for guess in &differing.as_if {
        let _ = writeln!(text, "  the kernel would say the same with {guess}");
    }
    if !differing.requirements.is_empty() {
        let _ = writeln!(text, "  requirements: {}", differing.requirements.join(", "));
    }
    if differing.steps_that_differ > 1 {
        let _ = writeln!(text, "  {} steps of this session differ", differing.steps_that_differ);
    }
}

fn of_machine(text: &mut String, report: &Report, machine: &OfMachine) {
    let OfMachine { sessions, agree, steps, .. } = machine;
    let word = machine.verdict.name();
    let _ = write!(text, "{}: {word} ({agree} of {sessions} sessions agree, {steps} steps the same", machine.machine);
    for (count, what) in [
        (machine.steps_that_differ, "steps that differ"),
        (machine.unfinished, "sessions not read to their end"),
        (machine.skipped, "sessions left out"),
    ] {
        if count > 0 {
            let _ = write!(text, ", {what}: {count}");
        }
    }
    text.push_str(")\n");
    if let Some(note) = &machine.note {
        let _ = writeln!(text, "  {note}");
    }
    for known in report.known(machine) {
        let _ = writeln!(text, "  known difference, seen again: {known}");
    }
}
