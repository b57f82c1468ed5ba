//! The registers: hazard log, conditions, traceability, techniques, tools, the specific application.

use super::checks::rules;
use super::parts::{badge, link, links};
use crate::case::{Case, Line, Outcome};
use maud::{Markup, html};
use std::collections::BTreeMap;

/// Sections 4.7 to 4.13; 4.14 follows in `measured`.
pub fn render(case: &Case) -> Markup {
    html! {
        (hazards(case))
        (accidents(case))
        (super::faults::render(case))
        (conditions(case))
        (traceability(case))
        (techniques(case))
        (tools(case))
        (line(&case.line))
    }
}

fn hazards(case: &Case) -> Markup {
    html! {
        h3 #hazards { "4.7 Hazard log" }
        p { "Hazards at the boundary of the machines. The verdict is the worst of what mitigates the hazard. Rates and risk are for \
             the application's risk analysis." }
        table.fixed {
            thead { tr { th style="width:18%" { "Hazard" } th style="width:19%" { "Causes" } th style="width:25%" { "Mitigated by" } th style="width:13%" { "Verdict" } th style="width:25%" { "Left to the user" } } }
            @for hazard in &case.hazards {
                tr id=(hazard.id) {
                    td { p { strong { (hazard.id) } " " (hazard.title) } p.small.soft { (hazard.severity) } }
                    td { ul { @for cause in &hazard.causes { li { (cause) } } } }
                    td.small { (links(&hazard.mitigated_by)) p.soft { (hazard.requirements.join(", ")) } }
                    td { (badge(hazard.verdict)) }
                    td {
                        p { (hazard.remains) }
                        p.small { @for (place, number) in hazard.residual.iter().enumerate() {
                            @if place > 0 { ", " } a href={ "#" (number) } { (number) } } }
                        @if !hazard.cut_sets.is_empty() {
                            p.small { "Minimal cut sets: " @for number in &hazard.cut_sets { a href={ "#" (number) } { (number) } " " } }
                        }
                    }
                }
            }
        }
    }
}

fn accidents(case: &Case) -> Markup {
    html! {
        h3 #accidents { "4.7.1 Accidents that were found with legal input" }
        p { "Somebody who looked at trains, and not at the formulas, brought them about with an earlier kernel. Each has a rule now; the verdict is the \
             worst of what excludes it. Where conditions are named it rests on them too." }
        table.fixed {
            thead { tr { th style="width:20%" { "Session" } th style="width:30%" { "What happened" } th style="width:12%" { "Rules" } th style="width:25%" { "Excluded by" } th style="width:13%" { "Verdict" } } }
            @for one in &case.accidents {
                tr {
                    td { strong { (one.name) } p.small { @for id in &one.hazards { a href={ "#" (id) } { (id) } " " } } }
                    td { (one.happened) }
                    td.small { @for id in &one.rules { a href={ "#requirement-" (id) } { (id) } " " } }
                    td.small { (links(&one.excluded_by)) p { @for number in &one.conditions { a href={ "#" (number) } { (number) } " " } } }
                    td { (badge(one.verdict)) }
                }
            }
        }
    }
}

fn conditions(case: &Case) -> Markup {
    html! {
        h3 #conditions { "4.9 Safety-related application conditions" }
        p { "Derived from what the proofs, their bounds, the models and the argument assume. An assumption that is not in this list, \
             or that nobody owns, stops the generation of this document." }
        table.fixed {
            thead { tr { th style="width:9%" { "Number" } th style="width:23%" { "Condition" } th style="width:21%" { "Why" } th style="width:21%" { "Check" } th style="width:12%" { "Owner" } th style="width:14%" { "Used by" } } }
            @for one in &case.conditions {
                tr id=(one.number) {
                    td { strong { (one.number) } p.small.soft { (one.hazards.join(", ")) } }
                    td { (one.statement) p.small.soft { (one.id) } }
                    td { (one.why) }
                    td { (one.check) }
                    td { (one.owner) @if one.owner != one.addressee { p.small.soft { "for: " (one.addressee) } } }
                    td.small {
                        @if one.used_by.is_empty() { span.badge.note { "unused" } }
                        (crate::judge::verdict::list(&one.used_by, 4))
                    }
                }
            }
        }
    }
}

fn traceability(case: &Case) -> Markup {
    let nothing = || html! { span.badge.not-run { "none" } };
    html! {
        h3 #traceability { "4.10 Traceability" }
        p { "Requirement, the lines of code that quote it word for word, theorems, wrong kernels, models, tests. The quotations are \
             compared here by the generator itself, and by duvet in " code { "ci/test" } "." }
        table.fixed {
            thead { tr { th style="width:23%" { "Requirement" } th style="width:14%" { "Code" } th style="width:12%" { "Theorems" } th style="width:13%" { "Wrong kernels" } th style="width:12%" { "Models" } th style="width:11%" { "Tests" } th style="width:15%" { "Verdict" } } }
            @for one in &case.requirements {
                tr id={ "requirement-" (one.id) } {
                    td { p { strong { (one.id) } " " (one.title) } p.small { (one.sentence) } p.small.soft { (one.at) } }
                    td.small { @if one.code.is_empty() { (nothing()) } @for at in &one.code { code { (at) } " " } }
                    td.small { @if one.harnesses.is_empty() { (nothing()) } (short(&one.harnesses, 6)) }
                    td.small { @if one.mutants.is_empty() { (nothing()) } (short(&one.mutants, 8)) }
                    td.small { @if one.models.is_empty() { "–" } (short(&one.models, 3)) }
                    td.small { @if one.tests.is_empty() { "–" } (crate::judge::verdict::list(&one.tests, 3)) }
                    td { (badge(one.verdict)) }
                }
            }
        }
    }
}

/// Links without the kind, one a line.
fn short(ids: &[String], most: usize) -> Markup {
    html! {
        @for id in ids.iter().take(most) {
            a href={ "#" (super::parts::anchor(id)) } { (id.split_once(':').map_or(id.as_str(), |(_, name)| name)) } br;
        }
        @if ids.len() > most { span.soft { "and " (ids.len() - most) " more" } }
    }
}

fn techniques(case: &Case) -> Markup {
    html! {
        h3 #techniques { "4.11 Techniques (EN 50716, Annex A)" }
        table {
            thead { tr { th style="width:22%" { "Technique" } th { "What is claimed" } th { "Evidence" } th { "Verdict" } } }
            @for one in &case.techniques {
                tr {
                    td { strong { (one.name) } }
                    td { (one.claimed) }
                    td.small { @for id in &one.evidence { @if id.ends_with('*') { code { (id) } } @else { (link(id)) } " " } }
                    td { @match one.verdict { Some(verdict) => (badge(verdict)), None => { span.badge.note { "inspection" } } } }
                }
            }
        }
    }
}

fn tools(case: &Case) -> Markup {
    html! {
        h3 #tools { "4.12 Tools" }
        table {
            thead { tr { th { "Tool" } th { "Class" } th { "Version" } th { "What it does, and what would detect its faults" } } }
            @for one in &case.tools {
                tr {
                    td { (one.name) }
                    td { (one.class) }
                    td.small { (one.version.as_deref().unwrap_or("not used in this run, or not recorded")) }
                    td { (one.justification) }
                }
            }
        }
    }
}

fn line(line: &Line) -> Markup {
    let holds = line.theorems.iter().filter(|(_, verdict)| verdict.holds()).count();
    html! {
        h3 #line { "4.13 Specific application: " (line.name) }
        p { "The theorems hold for all valid parameters, so a line has no proofs of its own. Its new obligations are the data \
             checks. Source of the parameters: " code { (line.source) } "." }
        p { "Logic cycle " (line.cycle_ms) " ms. Aspects: "
            @for (place, speed) in line.aspects_km_h.iter().enumerate() { @if place > 0 { ", " } (speed) } " km/h." }
        table {
            thead { tr { th { "Time" } th { "Name" } th.num { "Asked for" } th.num { "Cycles" } th.num { "Kept" } th.num { "Margin" } th { "Rounding" } } }
            @for time in &line.times {
                tr {
                    td { strong { (time.symbol) } }
                    td { (time.name) }
                    td.num { (time.asked_ms) " ms" }
                    td.num { (time.ticks) }
                    td.num { (time.kept_ms) " ms" }
                    td.num { (margin(time.asked_ms, time.kept_ms)) }
                    td { (time.rounding) }
                }
            }
        }
        @if !line.blocks.is_empty() {
            table {
                thead { tr { th { "Block" } th { "Lengths of its sections, from the low end" } th.num { "Length" } th.num { "Most trains" } } }
                @for (block, number) in line.blocks.iter().zip(1..) {
                    tr {
                        td { strong { (number) } }
                        td { @for (place, length) in block.sections_m.iter().enumerate() { @if place > 0 { ", " } (length) } " m" }
                        td.num { (block.sections_m.iter().copied().map(u32::from).sum::<u32>()) " m" }
                        td.num { (block.max_trains) }
                    }
                }
            }
        }
        @if !line.sections.is_empty() {
            table {
                thead { tr { th { "Section" } th.num { "Length" } th.num { "Gradient" } th.num { "Limit" } } }
                @for section in &line.sections {
                    tr {
                        td { strong { (section.number) } }
                        td.num { (section.length_m) " m" }
                        td.num { (section.gradient_permille) " ‰" }
                        td.num { (section.limit_km_h) " km/h" }
                    }
                }
            }
        }
        table {
            thead { tr { th { "What follows" } th { "Value" } th { "Formula" } th { "By" } } }
            @for one in &line.derived {
                tr { td { (one.name) } td { strong { (one.value) } } td { (one.formula) } td.small { (one.source) } }
            }
        }
        @if !line.notes.is_empty() {
            h4 { "To look at" }
            ul { @for note in &line.notes { li { (note) } } }
        }
        h4 { "Data checks" }
        (line_checks(line))
        h4 { "Generic theorems that are instantiated" }
        p { (holds) " of " (line.theorems.len()) " have a good result in this run: "
            @for (id, verdict) in &line.theorems { (link(id)) " " (badge(*verdict)) " " } }
    }
}

/// Every rule that is about something; the others in one sentence for each reason.
fn line_checks(line: &Line) -> Markup {
    let mut none: BTreeMap<&str, Vec<&str>> = BTreeMap::new();
    let mut about = Vec::new();
    for check in &line.checks {
        match &check.outcome {
            Outcome::NotApplicable { why } => none.entry(why).or_default().push(&check.rule),
            _ => about.push(check),
        }
    }
    html! {
        (rules(&about))
        @for (why, rules) in none {
            p.small { "Not applicable, as " (why) ": " @for (place, rule) in rules.iter().enumerate() { @if place > 0 { ", " } code { (rule) } } "." }
        }
    }
}

fn margin(asked: u32, kept: u64) -> String {
    let difference = i128::from(kept) - i128::from(asked);
    if difference == 0 { "0 ms".to_owned() } else { format!("{difference:+} ms") }
}
