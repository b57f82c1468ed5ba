//! What the tests of the models share: the check of a model that is in no catalogue.

use atc_models::{About, Entry, Outcome, Subject, check};

/// Checks a model on one thread.
pub fn outcome<S: Subject>(model: S) -> Outcome {
    let about = About {
        name: "wrong",
        statement: String::new(),
        requirements: &[],
        environment: String::new(),
        in_force: &[],
        lifted: &[],
    };
    check(&Entry::new(about, model), 1)
}
