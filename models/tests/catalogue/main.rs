//! The models of the catalogue. Each is checked once, and what it shows is looked at from all sides.

#[path = "../common/mod.rs"]
mod common;
#[path = "../meeting/mod.rs"]
mod meeting;

mod agreement;
mod block;
mod checker;
mod claimed;
mod every;
mod explorer;
mod interlocking;
mod large;
mod line;
mod permitted;
mod unique_states;

use atc_models::{Outcome, catalogue, check};
use std::sync::LazyLock;

/// What every model but the largest shows. `ATC_OUTCOMES=FILE` has it written to a file, for `safety-case run --outcomes FILE`.
static OUTCOMES: LazyLock<Vec<Outcome>> = LazyLock::new(|| {
    let entries: Vec<_> = catalogue().into_iter().filter(|entry| !large::LARGE.contains(&entry.name)).collect();
    let outcomes = atc_models::in_parallel(&entries, 2, |entry| check(entry, 1), |_| ());
    if let Some(file) = std::env::var_os("ATC_OUTCOMES") {
        let text = serde_json::to_string(&outcomes).expect("JSON");
        std::fs::write(&file, text).expect("ATC_OUTCOMES can be written");
    }
    outcomes
});

/// What the models show whose names begin with one of these words.
fn outcomes(words: &[&str]) -> impl Iterator<Item = &'static Outcome> {
    OUTCOMES.iter().filter(move |outcome| words.iter().any(|word| outcome.model.starts_with(word)))
}
