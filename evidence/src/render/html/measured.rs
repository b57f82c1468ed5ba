//! What was measured: figures beside theory and targets, and the plots.

use super::parts::{badge, seconds};
use crate::case::{Case, Evidence, Figure, Kind};
use crate::judge::verdict::Verdict;
use crate::sources::measured::{HERE, shown};
use maud::{Markup, PreEscaped, html};

/// Section 4.14.
pub fn render(case: &Case) -> Markup {
    let measured = &case.measurements;
    html! {
        h3 #measured { "4.14 The signal, the position and the line, measured" }
        p { "The waveform package sends telegrams and codes through a simulated channel and rail, and hears them with receivers in \
             floating point, outside the kernel. The simulation runs trains on a line under the kernel's devices, and interrupts their cab signal. " strong { "Figures are measured, and nothing here is proved." }
             " A target that is missed fails; a figure without one is shown only, and so is every time. They discharge no "
             a href="#conditions" { "condition" } ": a device's receivers are for their manufacturer." }
        (targets(case))
        @if measured.figures.is_empty() {
            p { (badge(Verdict::NotRun)) " There are no figures." }
        } @else {
            dl.facts {
                dt { "Run" } dd { (measured.source) @if measured.seconds > 0.0 { ", in " (seconds(measured.seconds)) }
                    @if measured.source == HERE { ", of the sources that this document is bound to" }
                    @else { "; nothing says of which sources" } }
                @for (name, value) in &measured.conditions { dt { (name) } dd { (value) } }
            }
            table {
                thead { tr { th { "Figure" } th.num { "Measured" } th.num { "Theory" } th.num { "Target" } th style="width:31%" { "Of" } th { "Verdict" } } }
                @for (place, figure) in measured.figures.iter().enumerate() {
                    @if place == 0 || measured.figures[place - 1].group != figure.group {
                        tr { td colspan="6" { strong { (figure.group) } } }
                    }
                    (row(case, figure))
                }
            }
            @if !measured.films.is_empty() {
                p { "Accidents of the simulated line, each a page that plays it. Two things are wrong in each; neither alone leads to harm in the                      same run." }
                table {
                    thead { tr { th style="width:32%" { "Film" } th { "What happens" } } }
                    @for film in &measured.films {
                        @let file = format!("films/{}.html", film.name);
                        tr { td { a href=(file) { (file) } } td { (film.caption) } }
                    }
                }
            }
            @for plot in &measured.plots {
                figure id={ "plot-" (plot.name) } {
                    figcaption { (plot.caption) " (" code { "plots/" (plot.name) ".svg" } ")" }
                    div.chart { (PreEscaped(&plot.svg)) }
                }
            }
        }
    }
}

fn of(case: &Case) -> impl Iterator<Item = &Evidence> {
    case.evidence.iter().filter(|one| one.kind == Kind::Measured)
}

fn targets(case: &Case) -> Markup {
    html! {
        table {
            thead { tr { th style="width:19%" { "Target" } th { "What it says" } th style="width:13%" { "Verdict" } th { "Measured" } } }
            @for one in of(case) {
                tr id=(super::parts::anchor(&one.id)) {
                    td { code { (one.title) } }
                    td { (one.statement) }
                    td { (badge(one.verdict)) @if let Some(reason) = &one.reason { p.small { (reason) } } }
                    td.small { (one.detail) }
                }
            }
        }
    }
}

fn row(case: &Case, figure: &Figure) -> Markup {
    let verdict = figure.evidence.as_ref().and_then(|id| of(case).find(|one| one.id == *id)).map(|one| one.verdict);
    let value = |value: Option<f64>| value.map_or_else(|| "–".to_owned(), |value| shown(Some(value), &figure.unit));
    html! {
        tr {
            td { (figure.name) }
            td.num { (value(figure.value)) }
            td.num { (value(figure.theory)) }
            td.num { @match figure.at_most { Some(most) => { "≤ " (value(Some(most))) } None => "–" } }
            td.small { (figure.of) }
            td { @match verdict { Some(verdict) => (badge(verdict)), None => { span.badge.note { "shown" } } } }
        }
    }
}
