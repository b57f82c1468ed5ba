//! When two cases are the same: without their times, and without other chance.

use crate::case::{Case, Matter};
use crate::sources::measured;

/// The case without its times, for a comparison: what is left must be the same however it was run. Of what rejects a mutant the harness is
/// left, and not the claims of the counterexample.
pub fn without_times(mut case: Case) -> Case {
    case.provenance.seconds = 0.0;
    case.provenance.generated_unix = 0;
    case.run.phases.clear();
    case.run.joined.clear();
    case.run.kept_since = None;
    for one in &mut case.evidence {
        one.seconds = 0.0;
        one.engines.iter_mut().for_each(|engine| engine.seconds = 0.0);
        // Which claims fail in the one counterexample that a solver gives is a matter of what was solved together.
        one.killed_by.iter_mut().for_each(|by| *by = by.split(" (").next().unwrap_or_default().to_owned());
    }
    case.second_opinions.iter_mut().for_each(|one| one.seconds = 0.0);
    case.measurements.seconds = 0.0;
    // Who searched a model, the tests or this run, is no matter of what was found.
    case.open_items.retain(|item| item.matter != Matter::Searched);
    // How fast this machine is.
    case.measurements.figures.retain(|figure| figure.group != measured::SPEED);
    case
}
