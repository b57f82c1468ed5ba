//! Minimal cut sets with their charts, the failure-mode table, and the second opinions on the models.

use super::parts::{anchor, badge, seconds};
use crate::case::{Case, CutSet, FailureMode};
use crate::judge::verdict::{Verdict, list};
use crate::sources::models::thousands;
use maud::{Markup, PreEscaped, html};

/// Section 4.8.
pub fn render(case: &Case) -> Markup {
    html! {
        h3 #cutsets { "4.8 Minimal cut sets and failure modes" }
        p { "A minimal cut set is a set of faults that together reach a hazard, and no part of which does. These are all that the models \
             have, up to the number of faults that was searched; for a block of any size T-BLK-6 says which sums of faults can. Each \
             is excluded by a condition that somebody owns; one that nobody owns stops the generation of this document." }
        (cut_sets(case))
        (lifted(case))
        (failure_modes(&case.failure_modes))
        @if !case.cut_sets.is_empty() {
            h4 { "The shortest way to each" }
            p { "Drawn from the kernel: every trace was run through it again. In " code { "traces/" } " as records." }
            @for set in &case.cut_sets { (figure(set)) }
        }
    }
}

fn cut_sets(case: &Case) -> Markup {
    if case.cut_sets.is_empty() {
        let run = case.models.iter().any(|model| model.unique_states.is_some());
        let words =
            if run { "No model that was searched enumerates cut sets." } else { "The models have not been run." };
        return html! { p { (badge(Verdict::NotRun)) " " (words) } };
    }
    html! {
        table.fixed {
            thead { tr { th style="width:9%" { "Number" } th style="width:20%" { "Faults" } th style="width:26%" { "What happens" } th style="width:9%" { "Reaches" } th style="width:21%" { "Excluded by (owner)" } th style="width:15%" { "Found by" } } }
            @for set in &case.cut_sets {
                tr id=(set.number) {
                    td { strong { (set.number) } p.small.soft { (order(set.faults.len())) } }
                    td { @for (place, fault) in set.faults.iter().enumerate() { @if place > 0 { " and " br; } strong { (words(fault)) } } }
                    td { (set.text) " " a.small href={ "#chart-" (set.number) } { "chart" } }
                    td { @for id in &set.hazards { a href={ "#" (id) } { (id) } " " } }
                    td.small {
                        @for one in &set.excluded_by {
                            p { a href={ "#" (one.condition) } { (one.condition) } " " (one.assumption) br; span.soft { (one.owner) } }
                        }
                    }
                    td.small { @for id in &set.found_by { a href={ "#" (anchor(id)) } { (id.trim_start_matches("model:")) } br; } }
                }
            }
        }
    }
}

fn order(faults: usize) -> String {
    match faults {
        1 => "one fault".to_owned(),
        _ => format!("{faults} faults"),
    }
}

/// A kebab-case id as words.
fn words(id: &str) -> String {
    id.replace('-', " ").replace("check in", "check-in").replace("check out", "check-out")
}

/// What the models find when a condition is lifted: events that no fault of the equipment is needed for.
fn lifted(case: &Case) -> Markup {
    let condition = |id: &String| case.conditions.iter().find(|condition| condition.id == *id);
    let found = case
        .models
        .iter()
        .flat_map(|model| model.properties.iter().map(move |property| (model, property)))
        .filter(|(_, property)| property.excluded_by.iter().any(|id| condition(id).is_some()))
        .filter(|(model, _)| case.cut_sets.iter().all(|set| !set.found_by.contains(&model.id)));
    // Models that say the same of the same conditions are one row, with the worst verdict of them.
    let mut rows: Vec<(&str, &[String], Vec<&str>, Verdict)> = Vec::new();
    for (model, property) in found {
        let statement = statement(case, &model.id);
        match rows.iter_mut().find(|row| (row.0, row.1) == (statement, property.excluded_by.as_slice())) {
            Some((_, _, models, verdict)) => {
                models.push(&model.id);
                models.dedup();
                *verdict = property.verdict.max(*verdict);
            }
            None => rows.push((statement, &property.excluded_by, vec![&model.id], property.verdict)),
        }
    }
    html! {
        h4 #lifted { "Hazards found when a condition is lifted" }
        @if rows.is_empty() {
            p { (badge(Verdict::NotRun)) " No model that was searched lifts a condition." }
        } @else {
            p { "Each of these models gives up one condition on purpose and must find the hazard; so each of the conditions is needed. The chart \
                 of each is in 4.5." }
            table.fixed {
                thead { tr { th style="width:24%" { "Condition (owner)" } th style="width:42%" { "What is found without it" } th style="width:20%" { "Model" } th style="width:14%" { "Verdict" } } }
                @for (statement, excluded_by, models, verdict) in rows {
                    tr {
                        td.small { @for one in excluded_by.iter().filter_map(condition) {
                            p { a href={ "#" (one.number) } { (one.number) } " " (one.id) br; span.soft { (one.owner) } } } }
                        td { (statement) }
                        td.small { @for id in models { a href={ "#" (anchor(id)) } { (id.trim_start_matches("model:")) } br; } }
                        td { (badge(verdict)) }
                    }
                }
            }
        }
    }
}

fn statement<'a>(case: &'a Case, id: &str) -> &'a str {
    case.evidence.iter().find(|one| one.id == id).map_or("", |one| one.statement.as_str())
}

fn figure(set: &CutSet) -> Markup {
    html! {
        figure id={ "chart-" (set.number) } {
            figcaption {
                strong { (set.number) " " (set.faults.iter().map(|fault| words(fault)).collect::<Vec<_>>().join(" and ")) ": " }
                (set.chart.caption)
            }
            @if !set.chart.svg.is_empty() { div.chart { (PreEscaped(&set.chart.svg)) } }
        }
    }
}

/// The rows of several models that say the same, once.
fn merged(modes: &[FailureMode]) -> Vec<(&FailureMode, Vec<String>, u64)> {
    let mut rows: Vec<(&FailureMode, Vec<String>, u64)> = Vec::new();
    for mode in modes {
        let same = |row: &FailureMode| (&row.fault, row.safe, &row.effect) == (&mode.fault, mode.safe, &mode.effect);
        let model = mode.model.trim_start_matches("model:").to_owned();
        match rows.iter_mut().find(|(row, ..)| same(row)) {
            Some((_, models, states)) => {
                models.push(model);
                *states += mode.states;
            }
            None => rows.push((mode, vec![model], mode.states)),
        }
    }
    // One fault after the other, as they come.
    let first = |fault: &str| modes.iter().position(|mode| mode.fault == fault);
    rows.sort_by_key(|(mode, ..)| first(&mode.fault));
    rows
}

fn failure_modes(modes: &[FailureMode]) -> Markup {
    html! {
        h4 #failuremodes { "Failure modes: one fault at a time" }
        @if modes.is_empty() {
            p { (badge(Verdict::NotRun)) " No model that was searched says what a single fault does." }
        } @else {
            p { "What one fault of each kind does at worst, at any time and for as long as it likes, everything else being in order. "
                em { "Safe" } " means: no section with the head or the tail of a train is ever reported free." }
            table {
                thead { tr { th style="width:18%" { "Fault" } th { "What it is" } th { "Safe" } th style="width:22%" { "What is reported" } th.num { "States" } th style="width:16%" { "In" } } }
                @for (mode, models, states) in merged(modes) {
                    tr {
                        td { strong { (words(&mode.fault)) } }
                        td { (mode.text) }
                        td { @if mode.safe { span.badge.model-checked { "safe" } } @else { span.badge.failed { "unsafe" } } }
                        td { (mode.effect) }
                        td.num { (usize::try_from(states).map_or_else(|_| states.to_string(), thousands)) }
                        td.small { (list(&models, 2)) }
                    }
                }
            }
        }
    }
}

/// What another checker says, for the section on models.
pub fn second_opinions(case: &Case) -> Markup {
    let states = |number: Option<u64>| match number.map(usize::try_from) {
        Some(Ok(number)) => thousands(number),
        _ => "–".to_owned(),
    };
    html! {
        h4 #second { "A second opinion" }
        p { "The models of block counting are written a second time, for another checker. It must find as many states and come to the same \
             verdicts; one that differs makes the model fail." }
        @if case.second_opinions.is_empty() {
            p { (badge(Verdict::NotRun)) " No other checker has looked at a model." }
        } @else {
            table {
                thead { tr { th { "Model" } th { "Checker" } th.num { "States, Stateright" } th.num { "States, this one" } th { "Verdict" } th.num { "Time" } } }
                @for one in &case.second_opinions {
                    tr {
                        td { a href={ "#" (anchor(&one.model)) } { code { (one.model.trim_start_matches("model:")) } } }
                        td { (one.tool) " " span.soft { (one.version.as_deref().unwrap_or_default()) } }
                        td.num { (states(one.first_states)) }
                        td.num { (states(one.states)) }
                        td { (badge(one.verdict)) " "
                            @if one.verdict == Verdict::ModelChecked { "agrees" }
                            @if one.verdict == Verdict::Failed { strong { "differs" } }
                            @if let Some(reason) = &one.reason { p.small { (reason) } } }
                        td.num { (seconds(one.seconds)) }
                    }
                }
            }
        }
    }
}
