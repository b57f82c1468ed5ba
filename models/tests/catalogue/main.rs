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

use atc_models::{Outcome, Searched, catalogue, check};
use std::process::Command;
use std::sync::LazyLock;

/// What every model but the largest shows. `ATC_OUTCOMES=FILE` has it written to a file, for `safety-case run --outcomes FILE`, if the
/// checkout is that of a commit without a change.
static OUTCOMES: LazyLock<Vec<Outcome>> = LazyLock::new(|| {
    let entries: Vec<_> = catalogue().into_iter().filter(|entry| !large::LARGE.contains(&entry.name)).collect();
    let outcomes = atc_models::in_parallel(&entries, 2, |entry| check(entry, 1), |_| ());
    if let Some((file, commit)) = std::env::var_os("ATC_OUTCOMES").zip(commit()) {
        let text = serde_json::to_string(&Searched { commit, outcomes: outcomes.clone() }).expect("JSON");
        std::fs::write(&file, text).expect("ATC_OUTCOMES can be written");
    }
    outcomes
});

/// The commit, if nothing has changed since and git is here to say so.
fn commit() -> Option<String> {
    let git = |arguments: &[&str]| {
        let output = Command::new("git").args(arguments).current_dir(env!("CARGO_MANIFEST_DIR")).output().ok()?;
        output.status.success().then(|| String::from_utf8_lossy(&output.stdout).trim().to_owned())
    };
    let root = git(&["rev-parse", "--show-toplevel"])?;
    git(&["-C", &root, "status", "--porcelain"])?.is_empty().then(|| git(&["rev-parse", "HEAD"]))?
}

/// What the models show whose names begin with one of these words.
fn outcomes(words: &[&str]) -> impl Iterator<Item = &'static Outcome> {
    OUTCOMES.iter().filter(move |outcome| words.iter().any(|word| outcome.model.starts_with(word)))
}
