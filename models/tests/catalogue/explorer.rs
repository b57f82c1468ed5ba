//! What the Explorer shows.

use atc_models::inside::{Shown, Thing, shown};
use atc_models::{Expectation, catalogue, check};
use stateright::Model;
use std::collections::HashSet;

/// Every state that is reached, in the order in which it is reached first.
fn visited(shown: &Shown) -> Vec<Thing> {
    let (mut states, mut seen) = (shown.init_states(), HashSet::new());
    states.retain(|state| seen.insert(state.hash));
    let mut next = 0;
    while let Some(state) = states.get(next).cloned() {
        states.extend(shown.next_states(&state).into_iter().filter(|state| seen.insert(state.hash)));
        next += 1;
    }
    states
}

#[test]
fn the_explorer_has_every_claim() {
    for entry in catalogue() {
        let shown = shown(&entry);
        assert_eq!(shown.properties().len(), shown.0.claims().len(), "{}", entry.name);
    }
}

#[test]
fn the_explorer_sees_the_states_and_judges_the_claims_of_the_search() {
    const SMALL: [&str; 3] = ["interlocking-line", "interlocking-siding-flicker", "interlocking-path-left-out"];
    let mut small = catalogue();
    small.retain(|entry| SMALL.contains(&entry.name));
    assert_eq!(small.len(), SMALL.len());
    for entry in small {
        let outcome = check(&entry, 1);
        let shown = shown(&entry);
        let states: HashSet<u64> = visited(&shown).iter().map(|state| state.hash).collect();
        assert_eq!(states.len(), outcome.unique_states, "{}", entry.name);
        for (number, property) in outcome.properties.iter().enumerate() {
            let wanted = property.expectation != Expectation::AlwaysHolds;
            let found = visited(&shown).iter().any(|state| shown.0.holds(number, state) == wanted);
            assert_eq!(found, property.trace.is_some(), "{}: {}", entry.name, property.name);
        }
    }
}
