//! Where the time of the run went.

use super::parts::seconds;
use crate::case::Run;
use crate::cli::times::named;
use maud::{Markup, html};

/// One row for each phase.
pub fn render(run: &Run) -> Markup {
    html! {
        @if !run.phases.is_empty() {
            h4 #times { "Where the time went" }
            table {
                thead { tr { th { "Phase" } th { "Items" } th { "Clock" } th { "Processors" } th { "Slowest (s)" } } }
                @for phase in &run.phases {
                    tr {
                        td { (phase.name) }
                        td.num { (phase.items) }
                        td.num { (seconds(phase.wall_seconds)) }
                        td.num { (seconds(phase.cpu_seconds)) }
                        td.small { (named(phase)) }
                    }
                }
            }
        }
    }
}
