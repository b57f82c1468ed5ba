//! The document: one HTML file that needs nothing else, readable without scripts, printable.

mod argument;
mod checks;
mod drawing;
mod faults;
mod measured;
mod page_one;
mod parts;
mod registers;
mod report;
mod station;
mod theorems;
mod times;

use crate::case::Case;
pub use page_one::headline;
pub use station::page as station_page;

use maud::{DOCTYPE, Markup, PreEscaped, html};

/// The whole document.
pub fn document(case: &Case) -> String {
    let title = format!("Safety case: {}", case.line.name);
    html! {
        (DOCTYPE)
        html lang="en" {
            head {
                meta charset="utf-8";
                meta name="viewport" content="width=device-width, initial-scale=1";
                @if case.run.running { meta http-equiv="refresh" content="10"; }
                title { (title) }
                style { (PreEscaped(include_str!("style.css"))) }
            }
            body {
                (page_one::render(case))
                (contents())
                (page_one::words(case))
                (report::definition(case))
                (report::management(case))
                h2 #technical { "4 Technical safety report" }
                (argument::render(case))
                (theorems::render(case))
                (registers::render(case))
                (measured::render(case))
                (station::render(case))
                (report::ending(case))
            }
        }
    }
    .into_string()
}

fn contents() -> Markup {
    let chapters = [
        ("system", "1 System definition", false),
        ("quality", "2 Quality management report", false),
        ("safety", "3 Safety management report", false),
        ("technical", "4 Technical safety report", false),
        ("argument", "4.1 Argument", true),
        ("engines", "4.2 Engines", true),
        ("theorems", "4.3 Theorems", true),
        ("mutants", "4.4 Wrong kernels", true),
        ("models", "4.5 Models and hazards found", true),
        ("tests", "4.6 Tests", true),
        ("hazards", "4.7 Hazard log", true),
        ("cutsets", "4.8 Cut sets, failure modes", true),
        ("conditions", "4.9 Application conditions", true),
        ("traceability", "4.10 Traceability", true),
        ("techniques", "4.11 Techniques", true),
        ("tools", "4.12 Tools", true),
        ("line", "4.13 Specific application", true),
        ("measured", "4.14 Signal and position, measured", true),
        ("layouts", "4.15 Layouts of stations", true),
        ("related", "5 Related safety cases", false),
        ("conclusion", "6 Conclusion", false),
        ("provenance", "7 Provenance", false),
    ];
    html! {
        nav aria-label="Contents" {
            @for (id, title, sub) in chapters {
                a.sub[sub] href={ "#" (id) } { (title) }
            }
        }
    }
}

#[cfg(test)]
pub(crate) mod tests;
