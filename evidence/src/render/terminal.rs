//! The summary that the run prints.

use crate::case::{Case, Evidence, Kind, Severity};
use crate::cli::times;
use crate::judge::verdict::Verdict;
use crate::render::html::headline;
use comfy_table::{Attribute, Cell, Color, Table, presets::NOTHING};
use std::fmt::Write;

/// Theorems, models and the rest in numbers; then the open items; then the headline.
pub fn summary(case: &Case) -> String {
    let mut table = Table::new();
    table.load_preset(NOTHING).set_header(["evidence", "verdict", "what belongs with it", "seconds"]);
    let shown = |one: &&Evidence| !one.left_out && matches!(one.kind, Kind::Harness | Kind::Model | Kind::Measured);
    for one in case.evidence.iter().filter(shown) {
        let detail = one.reason.clone().unwrap_or_else(|| one.detail.clone());
        let detail: String = detail.chars().take(60).collect();
        table.add_row([
            Cell::new(&one.id),
            cell(one.verdict),
            Cell::new(detail),
            Cell::new(format!("{:.1}", one.seconds)),
        ]);
    }
    for (kind, counts) in &case.status.counts {
        if kind == "mutant" || kind == "test" {
            for (verdict, number) in counts {
                let id = Cell::new(format!("{kind}: {number}"));
                table.add_row([id, cell(*verdict), Cell::new(""), Cell::new("")]);
            }
        }
    }
    let mut text = format!("{table}\n\n");
    for conclusion in &case.conclusions {
        let _ = writeln!(text, "{}", conclusion.sentence);
    }
    text.push('\n');
    for item in case.open_items.iter().filter(|item| item.severity != Severity::Note) {
        let word = if item.severity == Severity::Stop { "stop" } else { "open" };
        let _ = writeln!(text, "{word}: {}: {}", item.about, item.text);
    }
    for reason in &case.status.reasons {
        let _ = writeln!(text, "exit {}: {reason}", case.status.exit_code);
    }
    format!("{text}\n{}\n{}\n", times::table(&case.run.phases), headline(case).1)
}

fn cell(verdict: Verdict) -> Cell {
    let cell = Cell::new(verdict.word());
    match verdict {
        Verdict::Proved | Verdict::ProvedBounded | Verdict::ModelChecked | Verdict::Tested | Verdict::Measured => {
            cell.fg(Color::Green)
        }
        Verdict::NotRun | Verdict::Stale => cell.fg(Color::Yellow),
        Verdict::Undecided | Verdict::Vacuous | Verdict::Failed => cell.fg(Color::Red).add_attribute(Attribute::Bold),
    }
}
