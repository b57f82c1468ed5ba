//! What each single fault does, at worst, to a block that was in agreement: is it safe, and does agreement come back?

use super::cut_sets::successors;
use super::device::Counting;
use super::fault::{Faults, Kind};
use super::graph::Graph;
use super::single::{Cycle, Single, State};
use crate::outcome::FailureMode;
use crate::subject::{Limits, Subject};

/// One line for each kind of fault. `None`: not every state was visited.
pub(super) fn failure_modes<D: Counting>(model: &Single<D>, limits: Limits) -> Option<Vec<FailureMode>> {
    let modes = Kind::ALL.iter().map(|kind| {
        let faults = Faults::single(*kind, model.sections, 1);
        let faulty = Single { faults: faults.clone(), ..model.clone() };
        let all = Graph::explore(faulty.initial(), limits, |s| successors(&faulty, s, |_| true), |_| false)?;
        Some(FailureMode {
            fault: kind.name().to_owned(),
            text: format!("{}{}.", kind.text()[..1].to_uppercase(), &kind.text()[1..]),
            safe: all.states.iter().all(|state| !state.hazard),
            effect: effect(model, &faults, limits)?.to_owned(),
            states: all.states.len(),
        })
    });
    modes.collect()
}

/// What is reported from the first agreement on, with these faults. Two heads in one section disturb the comparison without
/// any fault, so here there are none.
fn effect<D: Counting>(model: &Single<D>, faults: &[Faults], limits: Limits) -> Option<&'static str> {
    let model = Single { share: false, faults: vec![Faults::NONE], ..model.clone() };
    let agreeing = |state: &State| model.available(state);
    let unaided = |cycle: &Cycle| cycle.input.reset.is_none();

    let healthy = Graph::explore(model.initial(), limits, |s| successors(&model, s, |_| true), |_| false)?;
    let struck = healthy.states.iter().filter(|state| agreeing(state));
    let struck = struck.flat_map(|state| faults.iter().map(|faults| State { faults: *faults, ..*state }));
    // A reset may be the fault; a right one is the cure, and not given yet.
    let faulty = |cycle: &Cycle| cycle.input.reset.is_none_or(|number| number.0 != model.inside(&cycle.trains));
    let faulty = Graph::explore(struck, limits, |s| successors(&model, s, faulty), |_| false)?;
    if faulty.states.iter().all(|state| state.agree) {
        return Some("none");
    }

    let healed: Vec<_> = faulty.states.iter().map(|state| State { faults: Faults::NONE, ..*state }).collect();
    let ever = |allowed: fn(&Cycle) -> bool| {
        let graph = Graph::explore(healed.iter().copied(), limits, |s| successors(&model, s, allowed), |_| false)?;
        Some(graph.can_reach(agreeing).into_iter().all(|can| can))
    };
    if ever(unaided)? {
        Some("all occupied while it lasts")
    } else if ever(|_| true)? {
        Some("all occupied until a reset")
    } else {
        Some("all occupied for ever")
    }
}
