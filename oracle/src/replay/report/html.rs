//! A replay as one page: no scripts, nothing to load, printable.

use maud::{Markup, PreEscaped, html};

use super::text::{place, sentence, summary};
use super::{Differing, Report};
use crate::chart::{self, View};
use crate::conform::report::{class, fields_table, frame, instant};
use crate::trace::{Replies, Trace};

/// The page of a replay.
pub fn page(report: &Report) -> String {
    let who = report.profile.implementation.clone().unwrap_or_else(|| "logs".to_owned());
    let title = format!("Replay of {who}");
    let said = if report.agrees {
        "ok"
    } else if report.code() == 0 {
        "left"
    } else {
        "bad"
    };
    let body = html! {
        h1 { (title) }
        p { span class=(said) { (summary(report)) } }
        p {
            "Level " code { (format!("{:?}", report.level).to_lowercase()) } ", sample " code { (report.sample) } ", seed "
            code { (report.seed) } ", oracle " (report.oracle) ", " (instant(report.began))
            ". Agreement is about the steps that were compared, not about all there are."
        }
        (machines(report))
        @if !report.unread.is_empty() {
            h2 { "Not read: " (report.unread_in_all) }
            ul { @for unread in &report.unread { li { (sentence(unread)) } } }
        }
        @for differing in &report.differences { (difference(differing)) }
    };
    frame(&title, &body)
}

fn machines(report: &Report) -> Markup {
    html! {
        table {
            tr {
                th { "machine" } th { "verdict" } th.n { "sessions" } th.n { "agree" } th.n { "differ" }
                th.n { "not to their end" } th.n { "left out" } th.n { "steps the same" } th.n { "steps that differ" }
            }
            @for machine in &report.machines {
                tr {
                    td { (machine.machine) }
                    td {
                        span class=(class(machine.verdict)) { (machine.verdict.name()) }
                        @if let Some(note) = &machine.note { ": " (note) }
                        @for known in report.known(machine) { br; "known: " (known) }
                    }
                    td.n { (machine.sessions) } td.n { (machine.agree) } td.n { (machine.differ) }
                    td.n { (machine.unfinished) } td.n { (machine.skipped) } td.n { (machine.steps) } td.n { (machine.steps_that_differ) }
                }
            }
        }
    }
}

fn difference(differing: &Differing) -> Markup {
    html! {
        h2 { (place(differing)) }
        @if let Some(sentence) = &differing.broken { p.bad { (sentence) } }
        @if !differing.fields.is_empty() { (fields_table(&differing.fields)) }
        @if let Some(line) = differing.late_from_line {
            p { "The step of line " (line) " had no reply before the next step: a reply may be lost there." }
        }
        @for guess in &differing.as_if { p { "The kernel would say the same with " b { (guess) } "." } }
        p { "Steps of this session that differ: " (differing.steps_that_differ) "." }
        @if !differing.session.is_empty() {
            @if let Some(chart) = drawn(differing) {
                figure { (PreEscaped(chart)) figcaption { "What the record says; what differs is red." } }
            }
            p { "The session up to there (" code { "oracle chart --as-recorded" } " draws it):" }
            pre { (differing.session.join("\n")) }
        }
    }
}

/// The chart of a session up to its difference. The last step stands there once more: an output is drawn from the end of its cycle on.
fn drawn(differing: &Differing) -> Option<String> {
    let last = differing.session.iter().rfind(|line| line.starts_with(r#"{"step""#))?;
    let session = [&differing.session[..], std::slice::from_ref(last)].concat().join("\n");
    let trace = Trace::parse(&session).ok()?;
    let view = View { title: Some(differing.machine.clone()), ..View::default() };
    chart::svg(&trace, Replies::AsRecorded, &view).ok()
}
