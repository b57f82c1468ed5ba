//! Which kinds of fault together let trains meet: a search of its own for each kind, and for each pair of kinds.
//!
//! What may still fail is a part of the state. So the states from which a search that found no accident went on are safe for good, and no later
//! search visits them again: after the first of two faults the other one alone is left, whichever was the first.

use super::{CountedBetween, Cycle, Failure, Faults, State, wrong};
use crate::outcome::CutSet;
use crate::subject::{Limits, Subject};
use ahash::AHashSet;
use std::time::Instant;

/// Every set of one or two kinds, the smaller first. A pair of one kind is of two places.
pub fn candidates() -> Vec<Vec<Failure>> {
    let all = Failure::all();
    let ones = all.iter().map(|kind| vec![*kind]);
    let twos = all.iter().enumerate().flat_map(|(place, one)| all[place..].iter().map(|other| vec![*one, *other]));
    ones.chain(twos).collect()
}

/// The places of a set of kinds: every way to choose one for each.
pub fn places(kinds: &[Failure], sections: u8, blocks: u8) -> Vec<Faults> {
    let mut all = vec![Faults::NONE];
    for kind in kinds {
        let singles = kind.single(sections, blocks);
        all = all.iter().flat_map(|some| singles.iter().map(|one| some.and(*one))).collect();
    }
    all.sort_unstable();
    all.dedup();
    all
}

/// Searches from `model`'s initial states, not beyond those that were visited before. The path to an accident, if there is one: then nothing of
/// this search counts as visited; else all of it is safe from now on. `None`: the limits were reached.
fn search<const B: usize>(
    model: &CountedBetween<B>,
    visited: &mut AHashSet<State>,
    limits: Limits,
    start: Instant,
) -> Option<Vec<(State, Option<Cycle>)>> {
    let mut states: Vec<(State, usize)> = Vec::new();
    let mut cycles = Vec::new();
    let mut next = 0;
    for state in model.initial() {
        if visited.insert(state) {
            states.push((state, usize::MAX));
        }
    }
    while let Some((state, _)) = states.get(next).copied() {
        if visited.len() > limits.states || next.is_multiple_of(1024) && start.elapsed() >= limits.time {
            return None;
        }
        model.actions(&state, &mut cycles);
        for cycle in cycles.drain(..) {
            let Some(after) = model.next(&state, &cycle) else { continue };
            if visited.insert(after) {
                states.push((after, next));
                if after.wrong & wrong::MET != 0 {
                    for (state, _) in &states {
                        visited.remove(state);
                    }
                    return Some(path(model, &states));
                }
            }
        }
        next += 1;
    }
    Some(Vec::new())
}

/// The way to the last of these states.
fn path<const B: usize>(model: &CountedBetween<B>, states: &[(State, usize)]) -> Vec<(State, Option<Cycle>)> {
    let mut way = Vec::new();
    let mut place = states.len() - 1;
    while place != usize::MAX {
        way.push(states[place].0);
        place = states[place].1;
    }
    way.reverse();
    let mut path = Vec::new();
    for (place, state) in way.iter().enumerate() {
        let step = way.get(place + 1).and_then(|after| {
            let mut cycles = Vec::new();
            model.actions(state, &mut cycles);
            cycles.into_iter().find(|cycle| model.next(state, cycle) == Some(*after))
        });
        path.push((*state, step));
    }
    path
}

/// Every minimal cut set of one or two kinds, each with its shortest trace. `None`: not every state was visited.
pub(super) fn enumerate<const B: usize>(model: &CountedBetween<B>, limits: Limits) -> Option<Vec<CutSet>> {
    let start = Instant::now();
    let mut visited = AHashSet::new();
    let mut found: Vec<(Vec<Failure>, CutSet)> = Vec::new();
    for kinds in candidates() {
        let within =
            |smaller: &[Failure]| smaller.len() < kinds.len() && smaller.iter().all(|kind| kinds.contains(kind));
        if found.iter().any(|(smaller, _)| within(smaller)) {
            continue;
        }
        let model = model.with(places(&kinds, model.sections, CountedBetween::<B>::blocks()));
        let path = search(&model, &mut visited, limits, start)?;
        if path.is_empty() {
            continue;
        }
        let texts: Vec<_> = kinds.iter().map(|kind| kind.text()).collect();
        let cut = CutSet {
            faults: kinds.iter().map(|kind| kind.name().to_owned()).collect(),
            text: format!(
                "Two trains are in one place of a counted line between two stations: {}.",
                texts.join(", and ")
            ),
            excluded_by: excluded_by(&kinds),
            trace: model.trace(&path),
        };
        found.push((kinds, cut));
    }
    Some(found.into_iter().map(|(_, cut)| cut).collect())
}

fn excluded_by(kinds: &[Failure]) -> Vec<String> {
    let counting: Vec<_> =
        kinds.iter().filter_map(|kind| if let Failure::Counting(kind) = kind { Some(*kind) } else { None }).collect();
    if counting.len() == kinds.len() { crate::block::cut_sets::excluded_by(&counting) } else { Vec::new() }
}
