//! The results: engines, theorems, wrong kernels, models, tests.

use super::parts::{anchor, badge, links, seconds};
use crate::case::{Case, Evidence, Kind, Model};
use crate::judge::verdict::Verdict;
use crate::sources::models::thousands;
use maud::{Markup, PreEscaped, html};

/// Sections 4.2 to 4.6.
pub fn render(case: &Case) -> Markup {
    html! {
        (engines(case))
        (theorems(case))
        (mutants(case))
        (models(case))
        (tests(case))
    }
}

fn of(case: &Case, kind: Kind) -> impl Iterator<Item = &Evidence> {
    case.evidence.iter().filter(move |one| one.kind == kind)
}

fn engines(case: &Case) -> Markup {
    html! {
        h3 #engines { "4.2 Engines" }
        p { "All provers run the same harnesses. A harness has the best result of any engine, unless one refutes it. Two engines \
             that look at different things and agree are worth more than one. For the models " code { "spin" } " is the second engine \
             beside Stateright (4.5); " code { "waveform" } " measures, and proves nothing (4.14)." }
        table {
            thead { tr { th { "Engine" } th { "Looks at" } th { "Worst result" } th { "Results" } th { "To run it" } } }
            @for engine in &case.engines {
                tr {
                    td { strong { (engine.name) } }
                    td { (engine.what) }
                    td { (badge(engine.verdict)) }
                    td { (engine.summary) }
                    td { code { (engine.command) } }
                }
            }
        }
    }
}

fn theorems(case: &Case) -> Markup {
    html! {
        h3 #theorems { "4.3 Theorems" }
        p { "Each harness takes one step of the real kernel from an arbitrary valid state, with arbitrary valid parameters and \
             input. Every claim has a verdict of its own and must be reachable; every cover point must be hit." }
        table {
            thead { tr {
                th style="width:25%" { "Theorem" } th { "Claims and cover points" } th style="width:17%" { "Verdict" } th.num { "Time" }
            } }
            @for one in of(case, Kind::Harness) {
                tr id=(anchor(&one.id)) {
                    td {
                        p { strong { (one.title) } }
                        p { (one.statement) }
                        p.small.soft { (one.requirements.join(", "))
                            @if !one.assumptions.is_empty() { br; "assumes " (one.assumptions.join(", ")) } }
                    }
                    td {
                        @for claim in &one.claims {
                            div.claim { (badge(claim.verdict)) span { strong { (claim.name) } ": " (claim.text) } }
                        }
                        @for cover in &one.covers {
                            div.claim {
                                @match cover.hit {
                                    Some(true) => { span.badge.note { "cover: hit" } }
                                    Some(false) => { span.badge.vacuous { "not reached" } }
                                    None => { span.badge.not-run { "no word" } }
                                }
                                span.soft { strong { (cover.name) } ": " (cover.text) }
                            }
                        }
                    }
                    td {
                        p { (badge(one.verdict)) }
                        @if !one.detail.is_empty() { p.small { (one.detail) } }
                        @if let Some(reason) = &one.reason { p.small { (reason) } }
                        @if one.counterexample.is_some() { p.small { "see " code { "counterexamples/" } } }
                        @for engine in &one.engines {
                            p.small.soft { (engine.engine) ": " (engine.verdict.word()) }
                        }
                    }
                    td.num { (seconds(one.seconds)) }
                }
            }
        }
    }
}

fn mutants(case: &Case) -> Markup {
    html! {
        h3 #mutants { "4.4 Wrong kernels" }
        p { "Each is the kernel with one fault put in on purpose. A theorem that does not notice is too weak. "
            em { "tested" } " means: rejected; " em { "failed" } " means: it survived. For each there are counterexamples that the prover found \
             once, in the theorem as it is proved. All are run, on this very code: with the fault a claim must fail, without it none. Where the provers are \
             installed, some theorems, drawn by the hash of the sources, are given to the prover with the faults once more, and it must reject \
             them; so is every fault whose counterexample does not fail any more. A theorem that is not proved of the right kernel rejects nothing." }
        @if of(case, Kind::Mutant).next().is_none() { p.cannot { "No wrong kernel is listed." } }
        table {
            thead { tr { th { "Wrong kernel" } th { "What is wrong" } th { "Breaks" } th { "Verdict" } th { "Rejected by (claims)" } th.num { "Time" } } }
            @for one in of(case, Kind::Mutant) {
                tr id=(anchor(&one.id)) {
                    td { code { (one.title) } }
                    td { (one.statement) }
                    td { (one.requirements.join(", ")) }
                    td { (badge(one.verdict)) @if let Some(reason) = &one.reason { p.small { (reason) } } }
                    td.small { (one.killed_by.join("; ")) @if let Some((_, asked)) = one.detail.split_once("; ") { p.small { (asked) } } }
                    td.num { (seconds(one.seconds)) }
                }
            }
        }
    }
}

fn models(case: &Case) -> Markup {
    html! {
        h3 #models { "4.5 Models and hazards found" }
        p { "Every reachable state is visited. Some models lift an assumption on purpose: there the hazard must be found, and the \
             shortest way to it is drawn. A model that should find a hazard and does not is a failure." }
        table {
            thead { tr { th style="width:17%" { "Model" } th { "Statement" } th { "Verdict" } th.num { "States" } th.num { "Time" } } }
            @for one in of(case, Kind::Model) {
                tr {
                    td { a href={ "#" (anchor(&one.id)) } { code { (one.title) } } }
                    td { (one.statement) }
                    td { (badge(one.verdict)) @if let Some(reason) = &one.reason { p.small { (reason) } } }
                    td.num { (case.models.iter().find(|model| model.id == one.id).and_then(|m| m.unique_states).map_or_else(|| "–".to_owned(), states)) }
                    td.num { (seconds(one.seconds)) }
                }
            }
        }
        (super::faults::second_opinions(case))
        h4 { "Model by model" }
        p { "The same hazard for want of the same condition is not drawn twice; every trace and chart is in " code { "traces/" } "." }
        @for model in &case.models { (details(case, model)) }
    }
}

fn states(number: u64) -> String {
    usize::try_from(number).map_or_else(|_| number.to_string(), thousands)
}

fn details(case: &Case, model: &Model) -> Markup {
    html! {
        h4 id=(anchor(&model.id)) { (model.id.trim_start_matches("model:")) }
        @if model.properties.is_empty() { p.soft { "Not run." } }
        @if !model.parameters.is_empty() {
            dl.facts { @for (name, value) in &model.parameters { dt { (name) } dd { (value) } } }
        }
        @if !model.properties.is_empty() {
            table {
                thead { tr { th style="width:18%" { "Property" } th { "Sentence" } th style="width:24%" { "Expected" } th { "Found" } th { "Verdict" } } }
                @for one in &model.properties {
                    tr {
                        td { code { (one.name) } }
                        td { (one.text) }
                        td { (one.expected) }
                        td { (one.found) }
                        td { (badge(one.verdict)) }
                    }
                }
            }
        }
        @for chart in &model.charts {
            @let first = first(case, model, &chart.name);
            @if first == Some(model.id.as_str()) || chart.svg.is_empty() {
                figure {
                    figcaption { strong { (chart.name) } ": " (chart.caption) }
                    div.chart { (PreEscaped(&chart.svg)) }
                }
            } @else if let Some(first) = first {
                p.small.soft { (chart.name) ": drawn at " a href={ "#" (anchor(first)) } { (first.trim_start_matches("model:")) } "." }
            }
        }
    }
}

/// The first model with a chart of this property where the same conditions exclude it.
fn first<'a>(case: &'a Case, model: &Model, name: &str) -> Option<&'a str> {
    let lifted = |model: &Model| -> Vec<String> {
        let of = model.properties.iter().filter(|one| one.name == name);
        of.flat_map(|one| one.excluded_by.iter().cloned()).collect()
    };
    let wanted = lifted(model);
    let has = |other: &Model| other.charts.iter().any(|chart| chart.name == name && !chart.svg.is_empty());
    case.models.iter().find(|other| has(other) && lifted(other) == wanted).map(|other| other.id.as_str())
}

fn tests(case: &Case) -> Markup {
    html! {
        h3 #tests { "4.6 Tests" }
        p { "The closing lines of " code { "cargo test" } ". A run in which no test ran, or a suite without a closing line, is an error." }
        table {
            thead { tr { th { "Suite" } th { "Verdict" } th { "Tests" } th { "Remark" } } }
            @for one in of(case, Kind::Test) {
                tr id=(anchor(&one.id)) {
                    td { (one.title) }
                    td { (badge(one.verdict)) }
                    td { (one.detail) }
                    td { (one.reason.as_deref().unwrap_or_default()) }
                }
            }
        }
        @if of(case, Kind::Test).any(|one| one.verdict == Verdict::NotRun) {
            p.cannot { "To run them: leave out --no-tests. Results of evidence: " (links(&["test:all".to_owned()])) }
        }
    }
}
