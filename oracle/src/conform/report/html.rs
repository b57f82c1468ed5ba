//! A run as one page: no scripts, nothing to load, printable.

use maud::{DOCTYPE, Markup, PreEscaped, html};

use super::text::value;
use super::{First, OfMachine, Report, Word, badge, charts};
use crate::conform::fields::Difference;
use crate::conform::run::{Run, Verdict};

/// An earlier run, for the table at the foot.
#[derive(Clone, Debug)]
pub struct Past {
    /// When it began, in seconds since 1970.
    pub began: u64,
    /// Its seed.
    pub seed: u64,
    /// How many machines agreed, and of how many.
    pub agree: (u64, u64),
    /// How many steps were the same.
    pub steps: u64,
    /// Its verdict.
    pub agrees: bool,
}

const STYLE: &str = "body{font:15px/1.45 Helvetica,Arial,sans-serif;color:#1a1a1a;max-width:1040px;margin:24px auto;padding:0 16px}\
h1{font-size:24px}h2{font-size:19px;border-top:1px solid #ccc;padding-top:14px;margin-top:30px}\
table{border-collapse:collapse;width:100%}th,td{text-align:left;padding:4px 10px 4px 0;border-bottom:1px solid #ddd;vertical-align:top}\
td.n,th.n{text-align:right}pre{background:#f4f4f4;padding:10px;overflow-x:auto;font-size:12.5px;white-space:pre-wrap;word-break:break-all}\
code{font-size:13px;word-break:break-word}.ok{color:#1c6b30}.bad{color:#b3261e;font-weight:bold}.left{color:#6b5500}\
.danger{color:#b3261e;font-weight:bold}svg{max-width:100%;height:auto}figure{margin:12px 0}figcaption{color:#555}";

/// The page of a run; `past` are the runs before it, the oldest first.
pub fn page(run: &Run, report: &Report, past: &[Past]) -> String {
    let who = report.implementation.clone().unwrap_or_else(|| report.command.clone());
    let title = format!("Conformance of {who}");
    let body = html! {
        p { (PreEscaped(badge(report))) }
        h1 { (title) }
        (summary(report))
        (machines(report))
        @for (machine, of) in run.machines.iter().zip(&report.machines) {
            @if let (Verdict::Differs(trace, _), Some(first)) = (&machine.verdict, &of.difference) {
                (difference(of, first, &charts(trace)))
            }
        }
        @if !report.stderr.is_empty() {
            h2 { "Standard error of the other side, the last of it" }
            pre { (report.stderr) }
        }
        (history(past))
    };
    frame(&title, &body)
}

/// A page of this style.
pub(crate) fn frame(title: &str, body: &Markup) -> String {
    let page = html! {
        (DOCTYPE)
        html lang="en" {
            head {
                meta charset="utf-8";
                meta name="viewport" content="width=device-width, initial-scale=1";
                title { (title) }
                style { (PreEscaped(STYLE)) }
            }
            body { (body) }
        }
    };
    page.into_string()
}

pub(crate) fn class(word: Word) -> &'static str {
    match word {
        Word::Agrees => "ok",
        Word::NotCompared => "left",
        Word::Differs | Word::Broken | Word::KnownDifferenceGone => "bad",
    }
}

fn summary(report: &Report) -> Markup {
    let agree = report.machines.iter().filter(|machine| machine.verdict == Word::Agrees).count();
    let left = report.machines.iter().filter(|machine| machine.verdict == Word::NotCompared).count();
    let of = report.machines.len();
    html! {
        p {
            @if report.agrees {
                span.ok { "Nothing differs: " (agree) " of " (of) " machines agree" }
            } @else if left == of {
                span.left { "Nothing was compared" }
            } @else {
                span.bad { "Differs: " (agree) " of " (of) " machines agree" }
            }
            @if left > 0 { ", " (left) " not compared" }
            ". Agreement is about the steps that were compared, not about all there are."
        }
        p {
            "Command " code { (report.command) } ", seed " code { (report.seed) } ", level "
            code { (format!("{:?}", report.level).to_lowercase()) } ", "
            @if report.vectors { "on vectors, " } @else { "on walks, " }
            "oracle " (report.oracle) ", " (instant(report.began)) "."
        }
    }
}

fn machines(report: &Report) -> Markup {
    html! {
        table {
            tr { th { "machine" } th { "verdict" } th.n { "cases" } th.n { "steps the same" } th.n { "seconds" } }
            @for machine in &report.machines {
                tr {
                    td { @if machine.difference.is_some() { a href=(format!("#{}", machine.machine)) { (machine.machine) } }
                        @else { (machine.machine) } }
                    td {
                        span class=(class(machine.verdict)) { (machine.verdict.name()) }
                        @if let Some(note) = &machine.note { ": " (note) }
                        @if let Some([used, all]) = machine.routes_used { br; (used) " of " (all) " routes were in use" }
                        @if !machine.undecided.is_empty() { br; "no walk decides: " (machine.undecided.join(", ")) }
                        @for known in &machine.known { br; "known: " (known) }
                    }
                    td.n { (machine.cases) } td.n { (machine.steps) } td.n { (format!("{:.1}", machine.seconds)) }
                }
            }
        }
    }
}

fn difference(of: &OfMachine, first: &First, charts: &(Option<String>, Option<String>)) -> Markup {
    let place =
        first.step.map_or_else(|| format!("the {}", first.at), |step| format!("step {step} of {}", first.steps));
    html! {
        h2 id=(of.machine) { (of.machine) ": first difference at " (place) }
        @if let Some((_, sentence)) = &first.broken { p.bad { (sentence) } }
        @if !first.fields.is_empty() { (fields_table(&first.fields)) }
        @for guess in &first.as_if { p { "The kernel would say the same with " b { (guess) } "." } }
        p {
            @if !first.again { "It did not show a second time; the trace is as it was. " }
            @else if first.minimal { "No step can be left out. " }
            @else { "Time for shrinking ran out; steps may be left to leave out. " }
            (first.tries) " candidates were played. The trace, for either side:"
        }
        pre { (first.trace.join("\n")) }
        @for (chart, caption) in [(&charts.0, "The kernel."), (&charts.1, "The other side; what differs is red. The last step is drawn twice, for its output to be seen.")] {
            @if let Some(chart) = chart { figure { (PreEscaped(chart)) figcaption { (caption) } } }
        }
    }
}

/// The fields of a difference.
pub(crate) fn fields_table(fields: &[Difference]) -> Markup {
    html! {
        table {
            tr { th { "field" } th { "expected" } th { "got" } th { "requirements" } }
            @for field in fields {
                tr {
                    td { (field.field) @if field.dangerous { br; span.danger { "dangerous" } } }
                    td { code { (value(field.expected.as_ref())) } }
                    td { code { (value(field.got.as_ref())) } }
                    td { (field.requirements.join(", ")) }
                }
            }
        }
    }
}

fn history(past: &[Past]) -> Markup {
    html! {
        @if !past.is_empty() {
            h2 { "Runs before this one" }
            table {
                tr { th { "began" } th { "verdict" } th.n { "machines that agree" } th.n { "steps the same" } th.n { "seed" } }
                @for run in past.iter().rev().take(20) {
                    tr {
                        td { (instant(run.began)) }
                        td { @if run.agrees { span.ok { "agrees" } } @else { span.bad { "differs" } } }
                        td.n { (run.agree.0) " of " (run.agree.1) } td.n { (run.steps) } td.n { (run.seed) }
                    }
                }
            }
        }
    }
}

/// A time in UTC, from seconds since 1970 (the civil calendar from days, after Howard Hinnant).
pub(crate) fn instant(seconds: u64) -> String {
    let days = seconds / 86_400 + 719_468;
    let (era, of_era) = (days / 146_097, days % 146_097);
    let year_of_era = (of_era - of_era / 1460 + of_era / 36_524 - of_era / 146_096) / 365;
    let of_year = of_era - (365 * year_of_era + year_of_era / 4 - year_of_era / 100);
    let shifted = (5 * of_year + 2) / 153;
    let day = of_year - (153 * shifted + 2) / 5 + 1;
    let month = if shifted < 10 { shifted + 3 } else { shifted - 9 };
    let year = year_of_era + era * 400 + u64::from(month <= 2);
    let (hour, minute) = (seconds % 86_400 / 3600, seconds % 3600 / 60);
    format!("{year}-{month:02}-{day:02} {hour:02}:{minute:02} UTC")
}

#[cfg(test)]
mod tests {
    #[test]
    fn instants_are_dates() {
        assert_eq!(super::instant(0), "1970-01-01 00:00 UTC");
        assert_eq!(super::instant(951_782_399), "2000-02-28 23:59 UTC");
        assert_eq!(super::instant(951_782_400), "2000-02-29 00:00 UTC");
        assert_eq!(super::instant(1_795_545_600), "2026-11-24 18:40 UTC");
    }
}
