//! A run on a terminal.

use std::fmt::Write as _;

use serde_json::Value;

use super::{First, OfMachine, Report, Word};
use crate::conform::fields::Difference;

/// The longest value that is printed whole, in characters.
const LONG: usize = 200;

/// The report as text, with the whole trace of every difference.
pub fn text(report: &Report) -> String {
    let mut text = String::new();
    for machine in &report.machines {
        of_machine(&mut text, report, machine);
    }
    let count = |word: Word| report.machines.iter().filter(|machine| machine.verdict == word).count();
    let steps: u64 = report.machines.iter().map(|machine| machine.steps).sum();
    let verdict = if report.agrees { "AGREES" } else { "DIFFERS" };
    let verdict = if count(Word::NotCompared) == report.machines.len() { "NOTHING WAS COMPARED" } else { verdict };
    let (agree, of) = (count(Word::Agrees), report.machines.len());
    let left = match count(Word::NotCompared) {
        0 => String::new(),
        left => format!(", {left} not compared"),
    };
    let _ =
        writeln!(text, "{verdict}: {agree} of {of} machines agree{left}; {steps} steps the same, seed {}", report.seed);
    if !report.stderr.is_empty() && !report.agrees {
        let _ = writeln!(text, "the other side said last on standard error:\n{}", indent(&report.stderr));
    }
    text
}

/// One line, and the difference below it if there is one.
fn of_machine(text: &mut String, report: &Report, machine: &OfMachine) {
    let OfMachine { machine: name, cases, steps, seconds, .. } = machine;
    let word = machine.verdict.name();
    let _ = writeln!(text, "{name}: {word} ({cases} cases, {steps} steps the same, {seconds:.1} s)");
    if let Some(note) = &machine.note {
        let _ = writeln!(text, "  {note}");
    }
    if let Some([used, all]) = machine.routes_used {
        let _ = writeln!(text, "  {used} of {all} routes were in use");
    }
    if !machine.undecided.is_empty() {
        let _ = writeln!(text, "  no walk decides: {}", machine.undecided.join(", "));
    }
    for known in &machine.known {
        let _ = writeln!(text, "  known difference, seen again: {known}");
    }
    if let Some(first) = &machine.difference {
        difference(text, report, first);
    }
}

fn difference(text: &mut String, report: &Report, first: &First) {
    let place = first.step.map_or_else(|| first.at.to_owned(), |step| format!("step {step}"));
    let _ = writeln!(text, "  at {place} of the trace below (seed {}):", report.seed);
    fields_text(text, &first.fields);
    if let Some((_, sentence)) = &first.broken {
        let _ = writeln!(text, "    {sentence}");
    }
    for guess in &first.as_if {
        let _ = writeln!(text, "  the kernel would say the same with {guess}");
    }
    if !first.requirements.is_empty() {
        let _ = writeln!(text, "  requirements: {}", first.requirements.join(", "));
    }
    let how = match (first.again, first.minimal) {
        (false, _) => {
            "it did not show a second time: it hangs on time, chance or what went before; the trace is as it was"
        }
        (true, true) => "no step can be left out",
        (true, false) => "time for shrinking ran out: steps may be left to leave out (--shrink-time gives it longer)",
    };
    let _ = writeln!(text, "  trace of {} steps, {how}:", first.steps);
    for line in &first.trace {
        let _ = writeln!(text, "{line}");
    }
}

/// A line for each field.
pub(crate) fn fields_text(text: &mut String, fields: &[Difference]) {
    for field in fields {
        let Difference { field: name, dangerous, .. } = field;
        let mark = if *dangerous { "  DANGEROUS" } else { "" };
        let (expected, got) = (value(field.expected.as_ref()), value(field.got.as_ref()));
        let _ = writeln!(text, "    {name}: expected {expected}, got {got}{mark}");
    }
}

/// A value in a line.
pub(super) fn value(value: Option<&Value>) -> String {
    let text = value.map_or_else(|| "nothing".to_owned(), ToString::to_string);
    if text.chars().count() <= LONG { text } else { format!("{}…", text.chars().take(LONG).collect::<String>()) }
}

fn indent(text: &str) -> String {
    text.lines().map(|line| format!("  {line}")).collect::<Vec<_>>().join("\n")
}
