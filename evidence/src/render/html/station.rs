//! The specific application on the ground: a section of the case, and the station's own page, made to be signed.

use super::checks::rules;
use super::parts::{badge, date, links};
use crate::case::{Case, Confirm, NeededRule, Origin, Station};
use crate::judge::verdict::Verdict;
use crate::render::files::STATION;
use crate::station::conclusion;
use maud::{DOCTYPE, Markup, PreEscaped, html};

/// Section 4.15.
pub fn render(case: &Case) -> Markup {
    html! {
        h3 #layouts { "4.15 Layouts of stations" }
        p { "The theorems on the interlocking hold for every layout that the kernel accepts, so a station has no proofs of its own. Its new \
             obligations are the data checks, and what they cannot see." }
        (needed(&case.needed_rules))
        h4 { "Specific application on the ground" }
        @match &case.station {
            None => p { "No station was given: " code { "safety-case run --layout station.toml" } " adds its case." }
            Some(station) => {
                @let conclusion = conclusion(station);
                p { (badge(conclusion.verdict)) " " (conclusion.sentence) }
                p { "The whole of it, with track plan, control table and data checks, is " a href=(STATION) { "a page of its own" } "." }
                (broken(station))
            }
        }
    }
}

/// Each rule of the theorems, and the theorem that fails without it.
fn needed(rules: &[NeededRule]) -> Markup {
    html! {
        h4 { "Rules that theorems rest on" }
        p { "Each is left out of the validator in a wrong kernel; the theorem that fails then needs it." }
        table {
            thead { tr { th { "Rule" } th { "What it demands" } th { "Left out by" } th { "Fails without it" } th { "Verdict" } } }
            @for one in rules {
                tr {
                    td { code { (one.rule) } }
                    td { (one.text) }
                    td.small { @if one.mutants.is_empty() { span.badge.not-run { "none" } } (links(&one.mutants)) }
                    td.small { @if one.theorems.is_empty() { "–" } (links(&one.theorems)) }
                    td { (badge(one.verdict.unwrap_or(Verdict::NotRun))) }
                }
            }
        }
    }
}

fn broken(station: &Station) -> Markup {
    html! {
        @if station.broken().next().is_some() {
            ul { @for rule in station.broken() { @for found in rule.findings() {
                li { span.badge.failed { "broken" } " " code { (found.at) } ": " (found.what)
                    @if !found.right.is_empty() { "; " (found.right) } " [" (rule.rule) "]" }
            } } }
        }
    }
}

/// The station's own page.
pub fn page(case: &Case, station: &Station) -> String {
    let title = format!("Safety case of a station: {}", station.name);
    html! {
        (DOCTYPE)
        html lang="en" {
            head {
                meta charset="utf-8";
                meta name="viewport" content="width=device-width, initial-scale=1";
                title { (title) }
                style { (PreEscaped(include_str!("style.css"))) (PreEscaped(STYLE)) }
            }
            body {
                (head(case, station))
                (parameters(station))
                (drawing(station))
                (control_table(station))
                (checks(station))
                (confirm(station))
                (conditions(case, station))
                (theorems(case, station))
                (signatures(case, station))
            }
        }
    }
    .into_string()
}

const STYLE: &str = "
.plan-of-station { overflow-x: auto; }
.plan-of-station svg { width: 100%; height: auto; max-height: 150mm; }
.control { font-size: .78rem; line-height: 1.32; }
.control td, .control th { padding: .25rem .45rem .25rem 0; }
.kept { color: #0b5a33; background: #e2f4ea; border-color: #7cc39c; }
.box { display: inline-block; width: 1em; height: 1em; border: 1.2px solid var(--ink); vertical-align: -.12em; }
.sign td { height: 2.6rem; vertical-align: bottom; }
@media print { @page { size: A4 landscape; margin: 12mm; } details { display: block; } }
";

/// Whether all evidence has a result and none is bad.
fn is_good(case: &Case) -> bool {
    case.status.complete && case.status.exit_code == 0
}

/// Whether a prover has shown it.
fn is_proved(verdict: Verdict) -> bool {
    verdict <= Verdict::ProvedBounded
}

fn head(case: &Case, station: &Station) -> Markup {
    let conclusion = conclusion(station);
    let (colour, words) = match (station.is_sound(), is_proved(conclusion.verdict), is_good(case)) {
        (true, true, true) => ("amber", "Every rule is kept. To be confirmed and signed."),
        (true, true, false) => {
            ("red", "Not to be signed: every rule is kept, but the safety case is not complete, or not good.")
        }
        (true, false, _) => {
            ("red", "Not to be signed: every rule is kept, but the theorems are not proved in this run.")
        }
        (false, ..) => ("red", "Not to be signed: the layout is refused."),
    };
    let count = |origin| station.confirm.iter().filter(|one| one.origin == origin).count();
    html! {
        header {
            h1 { (station.name) }
            p.soft { "Specific application of the interlocking, part of the " a href="index.html" { "safety case" } "." br;
                "Layout " code { (station.source) } " · SHA-256 " code { (station.sha256.get(..16).unwrap_or_default()) } " · "
                (date(case.provenance.generated_unix))
            }
            div class={ "banner " (colour) } {
                strong { (words) }
                p { (badge(conclusion.verdict)) " " (conclusion.sentence) }
            }
        }
        (broken(station))
        p { "To be confirmed: " (count(Origin::Reason)) " reasons that stand instead of a protection, "
            (count(Origin::Default) + count(Origin::Import)) " values that the file does not give, " (count(Origin::Derived))
            " that follow from the tracks. Amber is the best that this page can be before somebody has signed it." }
    }
}

fn parameters(station: &Station) -> Markup {
    html! {
        h2 { "1 Parameters" }
        table {
            thead { tr { th { "Parameter" } th { "In the device" } th { "From" } th { "Where it stands" } } }
            @for one in &station.parameters {
                tr { td { (one.name) } td { strong { (one.value) } } td { (one.formula) } td.small { code { (one.source) } } }
            }
        }
    }
}

fn drawing(station: &Station) -> Markup {
    html! {
        h2 { "2 Track plan" }
        @if station.drawing.is_empty() { p.cannot { "None: the tracks of the file are wrong." } }
        @else { figure.plan-of-station { (PreEscaped(station.drawing.clone())) } }
    }
}

fn control_table(station: &Station) -> Markup {
    let column = |name: &str| station.columns.iter().position(|one| one == name);
    let cell = |row: &[String], name: &str| column(name).and_then(|place| row.get(place)).cloned().unwrap_or_default();
    let positions = |row: &[String], normal: &str, reverse: &str| {
        let both = [("N", cell(row, normal)), ("R", cell(row, reverse))];
        both.into_iter()
            .filter(|(_, names)| !names.is_empty())
            .map(|(way, names)| format!("{way}: {names}"))
            .collect::<Vec<_>>()
    };
    let lines = |parts: &[String]| html! { @for part in parts { div { (part) } } };
    let split = |text: String| text.split("; ").filter(|part| !part.is_empty()).map(str::to_owned).collect::<Vec<_>>();
    html! {
        h2 { "3 Control table" }
        @if station.table.is_empty() { p.cannot { "None: see the broken rules." } }
        @else {
            p { "N and R: points in normal and reverse position. The same with matrices of routes against points, circuits and routes: "
                a href="station/control-table.html" { "control-table.html" } "." }
            table.control {
                thead { tr { th { "Route" } th { "Entry" } th { "Path" } th { "Points" } th { "Flank" } th { "Overlap" } th { "Approach" } th { "Conflicts" }
                    th { "Direction, continued by" } th { "Speed, times" } th { "Releases" } } }
                @for row in &station.table {
                    tr {
                        td { strong { (cell(row, "route")) } div.soft { "signal " (cell(row, "signal")) } }
                        td { (cell(row, "entry")) }
                        td { (cell(row, "path")) }
                        td { (lines(&positions(row, "normal", "reverse"))) }
                        td { (lines(&positions(row, "flank normal", "flank reverse"))) }
                        td { (cell(row, "overlap")) (lines(&positions(row, "overlap normal", "overlap reverse"))) }
                        td { (cell(row, "approach")) }
                        td { (lines(&split(cell(row, "conflicts")))) }
                        td { (cell(row, "direction")) @if !cell(row, "continued by").is_empty() { div { "then " (cell(row, "continued by")) } } }
                        td { (cell(row, "speed km/h")) " km/h" (lines(&cell(row, "times").split(", ").map(str::to_owned).collect::<Vec<_>>())) }
                        td { (lines(&split(cell(row, "releases")))) }
                    }
                }
            }
        }
    }
}

fn checks(station: &Station) -> Markup {
    html! {
        h2 { "4 Data checks" }
        p { "Made by the kernel's own check of the plan (" code { "plan-…" } ") and by the reader of layouts. A rule is not checked where another one is broken that it builds on." }
        (rules(&station.checks.iter().collect::<Vec<_>>()))
    }
}

fn confirm(station: &Station) -> Markup {
    let groups = [
        (Origin::Reason, "Reasons that the file gives instead of a protection"),
        (Origin::Default, "Values that the file does not give: the default stands"),
        (Origin::Import, "Values that the imported file does not give: one was assumed"),
        (Origin::Lacking, "What the imported file lacks"),
        (Origin::NotUsed, "What the imported file has and was not used"),
        (Origin::Derived, "What follows from the tracks"),
    ];
    let of = |origin| station.confirm.iter().filter(move |one| one.origin == origin).collect::<Vec<_>>();
    html! {
        h2 { "5 To be confirmed" }
        @for (origin, title) in groups {
            @let mine = of(origin);
            @if !mine.is_empty() {
                h4 { (title) " (" (mine.len()) ")" }
                table { @for (about, rows) in by_subject(&mine) { tr {
                    td style="width:3%" { span.box {} }
                    td style="width:22%" { strong { (about) } }
                    td { @for one in rows { div { (one.text) @if !one.at.is_empty() { " " code.soft { (one.at) } } } } }
                } } }
            }
        }
    }
}

/// What belongs to one subject stands together, in the order in which subjects first appear.
fn by_subject<'a>(all: &[&'a Confirm]) -> Vec<(&'a str, Vec<&'a Confirm>)> {
    let mut groups: Vec<(&str, Vec<&Confirm>)> = Vec::new();
    for one in all {
        match groups.iter_mut().find(|(about, _)| *about == one.about) {
            Some((_, rows)) => rows.push(one),
            None => groups.push((&one.about, vec![one])),
        }
    }
    groups
}

fn conditions(case: &Case, station: &Station) -> Markup {
    html! {
        h2 { "6 Conditions that the station must fulfil" }
        @if station.conditions.is_empty() { p { "None is known." } }
        table.fixed {
            thead { tr { th style="width:4%" {} th style="width:8%" { "Number" } th style="width:28%" { "Condition" } th style="width:24%" { "At this station" } th style="width:24%" { "Check" } th style="width:12%" { "Owner" } } }
            @for one in &station.conditions {
                @if let Some(condition) = case.conditions.iter().find(|condition| condition.number == one.number) {
                    tr {
                        td { span.box {} }
                        td { strong { a href={ "index.html#" (one.number) } { (one.number) } } p.small.soft { (condition.hazards.join(", ")) } }
                        td { (condition.statement) }
                        td { (one.here) }
                        td { (condition.check) }
                        td { (condition.owner) }
                    }
                }
            }
        }
    }
}

fn theorems(case: &Case, station: &Station) -> Markup {
    let of = |id: &str| case.evidence.iter().find(|one| one.id == id);
    html! {
        h2 { "7 Generic theorems that it instantiates" }
        @if station.theorems.is_empty() {
            p.cannot { @if station.is_sound() { "There is no theorem on the interlocking." } @else { "None: they speak only of layouts that keep every rule." } }
        } @else {
            p { (station.theorems.iter().filter(|(_, verdict)| is_proved(*verdict)).count()) " of " (station.theorems.len())
                " are proved. Their claims, one by one, are in " a href="index.html#theorems" { "the case" } "." }
            table {
                thead { tr { th { "Theorem" } th { "It says" } th style="width:22%" { "Proved for" } th { "Verdict" } } }
                @for (id, verdict) in &station.theorems {
                    tr {
                        td.nowrap { (in_case(id)) }
                        td { @if let Some(one) = of(id) { (one.statement) } }
                        td.small { @match verdict {
                            Verdict::Proved => "every size",
                            Verdict::ProvedBounded => @if let Some(one) = of(id) { (one.detail) },
                            _ => "not proved",
                        } }
                        td { (badge(*verdict)) }
                    }
                }
            }
        }
    }
}

/// A link to the row of the evidence in the whole case.
fn in_case(id: &str) -> Markup {
    html! { a href={ "index.html#" (super::parts::anchor(id)) } { code { (id.trim_start_matches("harness:")) } } }
}

fn signatures(case: &Case, station: &Station) -> Markup {
    let roles = [
        "Prepared (application engineer)",
        "Checked (signalling engineer, by eye against the site plan)",
        "Approved (safety assessor)",
    ];
    html! {
        h2 { "8 Signatures" }
        p { "They hold for the layout with the SHA-256 " code { (station.sha256) } ", the sources of kernel and proofs " code { (case.provenance.sources_sha256) }
            @if let Some(checker) = case.provenance.folders.get("layout") { " and the checks of layouts " code { (checker) } }
            ", under the conditions above, and for nothing else." }
        @if !(is_proved(conclusion(station).verdict) && is_good(case)) { p { span.badge.failed { "not to be signed" } " See the top of this page." } }
        table.sign {
            thead { tr { th { "Role" } th { "Name" } th { "Date" } th { "Signature" } } }
            @for role in roles { tr { td { (role) } td {} td {} td {} } }
        }
    }
}
