//! Rules with their verdicts, for a line and for a station.

use crate::case::{Asked, DataCheck, Outcome};
use maud::{Markup, html};

/// The table of these checks, by who asks for them.
pub fn rules(checks: &[&DataCheck]) -> Markup {
    let groups = [
        (Asked::Theorems, "Rules that theorems rest on"),
        (Asked::Engineering, "Rules of engineering"),
        (Asked::Form, "Rules of the form"),
    ];
    let mark = |outcome: &Outcome| match outcome {
        Outcome::Met => html! { span.badge.kept { "kept" } },
        Outcome::Broken { .. } => html! { span.badge.failed { "broken" } },
        Outcome::NotChecked => html! { span.badge.not-run { "not checked" } },
        Outcome::NotApplicable { why } => html! { span.badge.not-run { "not applicable" } div.small { (why) } },
    };
    html! {
        table {
            thead { tr { th { "Verdict" } th { "Rule" } th { "What it demands" } th { "Held against" } th { "Where it is broken" } } }
            @for (asked, title) in groups {
                @let mine: Vec<_> = checks.iter().filter(|check| check.asked == asked).collect();
                @if !mine.is_empty() { tr { td colspan="5" { strong { (title) } } } }
                @for check in mine {
                    tr {
                        td { (mark(&check.outcome)) }
                        td { code { (check.rule) } }
                        td { (check.text) }
                        td { (check.scope) }
                        td.small { @for one in check.findings() { div {
                            code { (one.at) } ": " (one.what) @if !one.right.is_empty() { "; " (one.right) }
                            @if let Some(against) = &one.against { " (against " code { (against) } ")" }
                        } } }
                    }
                }
            }
        }
    }
}
