//! Page one: what is proven, what is not, what is open, what the user must guarantee.
//!
//! The headline is made from the status and the open items. It cannot be better than they are, and they stand before
//! anything that reassures.

use super::parts::{badge, date};
use crate::case::{Case, Condition, Kind, Severity};
use crate::judge::verdict::Verdict;
use maud::{Markup, html};
use std::collections::BTreeMap;

/// Colour and words of the headline.
pub fn headline(case: &Case) -> (&'static str, String) {
    let count = |severity| case.open_items.iter().filter(|item| item.severity == severity).count();
    let (stop, open) = (count(Severity::Stop), count(Severity::Open));
    let worst = Verdict::worst(case.conclusions.iter().map(|one| one.verdict)).unwrap_or(Verdict::NotRun);
    let missing = case.status.missing.len();
    if let Some(partial) = case.run.partial() {
        let (all, some) = (case.evidence.len(), case.evidence.len() - missing);
        let wrong = if stop > 0 { format!(" {} went wrong.", capital(&things(stop))) } else { String::new() };
        return ("red", format!("{partial} {some} of {all} pieces of evidence have a result here.{wrong}"));
    }
    if stop > 0 || worst.is_defect() || case.status.exit_code != 0 {
        ("red", format!("Not shown. {} went wrong, {} open.", things(stop.max(1)), items(open)))
    } else if missing > 0 || !worst.holds() {
        let text = format!("Incomplete: {missing} of {} pieces of evidence have no result.", case.evidence.len());
        ("red", format!("{text} {} open.", capital(&items(open))))
    } else if open > 0 {
        ("amber", format!("All evidence has a result and none is bad. {} open.", capital(&items(open))))
    } else {
        ("green", "All evidence has a result, none is bad, and no item is open.".to_owned())
    }
}

fn things(number: usize) -> String {
    if number == 1 { "One thing".to_owned() } else { format!("{number} things") }
}

fn items(number: usize) -> String {
    match number {
        0 => "no item is".to_owned(),
        1 => "1 item is".to_owned(),
        _ => format!("{number} items are"),
    }
}

fn capital(text: &str) -> String {
    let mut letters = text.chars();
    letters.next().map_or_else(String::new, |first| format!("{}{}", first.to_uppercase(), letters.as_str()))
}

/// Page one.
pub fn render(case: &Case) -> Markup {
    let (colour, words) = headline(case);
    let provenance = &case.provenance;
    let commit = provenance.commit.as_deref().map_or("no commit", |commit| commit.get(..12).unwrap_or(commit));
    html! {
        header {
            h1 { "Safety case" }
            p.soft { (case.title) ". Line: " (case.line.name) "."
                @if let Some(station) = &case.station { " Station: " a href="#layouts" { (station.name) } "." }
                br;
                "Commit " code { (commit) }
                @if provenance.dirty == Some(true) { " with changes" }
                " · sources " code { (provenance.sources_sha256.get(..12).unwrap_or("unknown")) }
                " · " (date(provenance.generated_unix))
            }
            div class={ "banner " (colour) } {
                strong { (words) }
            }
        }
        div.pageone {
            section.wide {
                h3 { "Open items" }
                (open(case))
            }
            section {
                h3 { "What is shown" }
                (counts(case))
            }
            section {
                h3 { "What it says" }
                @for conclusion in &case.conclusions {
                    p { (badge(conclusion.verdict)) " " (conclusion.sentence) }
                }
            }
            section.wide {
                h3 { "What you must guarantee" }
                p { "The results hold only under these conditions (" a href="#conditions" { "details, checks and owners" } ")." }
                (conditions(case))
            }
        }
    }
}

/// What the verdicts mean and what the bounds are, for the page after.
pub fn words(case: &Case) -> Markup {
    let mut bounds: BTreeMap<&str, Vec<&str>> = BTreeMap::new();
    for one in case.evidence.iter().filter(|one| one.kind == Kind::Harness && one.verdict == Verdict::ProvedBounded) {
        bounds.entry(&one.detail).or_default().push(one.id.trim_start_matches("harness:"));
    }
    html! {
        h4 { "What the words mean" }
        table.counts {
            @for verdict in Verdict::ALL {
                tr { td { (badge(verdict)) } td { (verdict.meaning()) } }
            }
        }
        p.small.soft { "The best stands first. Nothing is called better than the worst of what it rests on." }
        @if !bounds.is_empty() {
            h4 #bounds { "The bounds" }
            p.small { "What is proved-bounded holds for everything within its bound; beyond it nothing is proved. For the interlocking " a href="#argument" { "the argument" }
                " says how what is proved of one route, of two and of the parts of a cycle carries to a station." }
            table {
                thead { tr { th style="width:38%" { "Within" } th { "Proved by" } } }
                @for (bound, harnesses) in &bounds {
                    tr { td { (bound) } td.small { (harnesses.join(", ")) } }
                }
            }
        }
    }
}

fn open(case: &Case) -> Markup {
    let shown: Vec<_> = case.open_items.iter().filter(|item| item.severity != Severity::Note).collect();
    let notes: Vec<_> = case.open_items.iter().filter(|item| item.severity == Severity::Note).collect();
    html! {
        @if shown.is_empty() { p { "None." } }
        ul {
            @for item in &shown {
                li {
                    @if item.severity == Severity::Stop { span.badge.failed { "stop" } } @else { span.badge.not-run { "open" } }
                    " " strong { (item.about) } ": " (item.text)
                }
            }
            @for item in &notes {
                li { span.badge.note { "note" } " " strong { (item.about) } ": " (item.text) }
            }
        }
    }
}

fn counts(case: &Case) -> Markup {
    let names = [
        ("harness", "theorem harnesses"),
        ("model", "models"),
        ("mutant", "wrong kernels"),
        ("measured", "measured targets"),
        ("test", "test suites"),
    ];
    html! {
        table.counts {
            @for (kind, name) in names {
                @if let Some(counts) = case.status.counts.get(kind) {
                    tr {
                        td { (name) }
                        td {
                            @for (verdict, number) in counts.iter().rev() {
                                (badge(*verdict)) " " (number) " "
                            }
                            @if kind == "mutant" { span.soft.small { "(tested: rejected; failed: survived)" } }
                        }
                    }
                }
            }
            @if let Some(claims) = claims(case) {
                tr { td { "single claims" } td { (claims) } }
            }
        }
    }
}

fn claims(case: &Case) -> Option<Markup> {
    let mut counts: BTreeMap<Verdict, usize> = BTreeMap::new();
    let harnesses = case.evidence.iter().filter(|one| one.id.starts_with("harness:"));
    for claim in harnesses.flat_map(|one| &one.claims) {
        *counts.entry(claim.verdict).or_default() += 1;
    }
    (!counts.is_empty())
        .then(|| html! { @for (verdict, number) in counts.iter().rev() { (badge(*verdict)) " " (number) " " } })
}

fn conditions(case: &Case) -> Markup {
    let mut by: Vec<(&str, Vec<&Condition>)> = Vec::new();
    for condition in &case.conditions {
        match by.iter_mut().find(|(addressee, _)| *addressee == condition.addressee) {
            Some((_, all)) => all.push(condition),
            None => by.push((&condition.addressee, vec![condition])),
        }
    }
    html! {
        div.by {
            @for (addressee, conditions) in by {
                div {
                    p { strong { (capital(addressee)) } }
                    @for condition in conditions {
                        p { a href={ "#" (condition.number) } { (condition.number) } " " (condition.statement) }
                    }
                }
            }
        }
    }
}
