//! Which faults together reach the hazard of one block: by search, and by direct evaluation of the comparison.

use super::device::Counting;
use super::fault::{Faults, Kind};
use super::graph::Graph;
use super::single::{Cycle, Single, State};
use crate::outcome::CutSet;
use crate::subject::{Limits, Subject};
use std::collections::BTreeSet;

/// The states after `state`, by the steps that `allowed` lets pass.
pub(super) fn successors<D: Counting>(
    model: &Single<D>,
    state: &State,
    allowed: impl Fn(&Cycle) -> bool,
) -> Vec<(Cycle, State)> {
    let mut cycles = Vec::new();
    model.actions(state, &mut cycles);
    cycles.retain(allowed);
    cycles.into_iter().filter_map(|cycle| model.next(state, &cycle).map(|next| (cycle, next))).collect()
}

/// Every multiset of one or two kinds, the smaller first, each in the order of the names.
pub fn candidates() -> Vec<Vec<Kind>> {
    let ones = Kind::ALL.iter().map(|kind| vec![*kind]);
    let twos =
        Kind::ALL.iter().enumerate().flat_map(|(place, one)| Kind::ALL[place..].iter().map(|other| vec![*one, *other]));
    ones.chain(twos).collect()
}

/// Every minimal cut set of `model`, each with its shortest trace; a search of its own for each candidate. `None`: not every
/// state was visited. With no fault at all the hazard must be out of reach, or there is nothing to cut.
pub fn enumerate<D: Counting>(model: &Single<D>, limits: Limits) -> Option<Vec<CutSet>> {
    let mut found: Vec<(Vec<Kind>, CutSet)> = Vec::new();
    for kinds in candidates() {
        // A set of which a part reaches the hazard is not minimal. (Pairs only: a part is one kind.)
        if found
            .iter()
            .any(|(smaller, _)| smaller.len() < kinds.len() && smaller.iter().all(|kind| kinds.contains(kind)))
        {
            continue;
        }
        let mut faults = vec![Faults::NONE];
        for kind in &kinds {
            let singles = Faults::single(*kind, model.sections, 1);
            faults = faults.iter().flat_map(|some| singles.iter().map(|one| some.and(*one))).collect();
        }
        let model = Single { faults, ..model.clone() };
        let graph = Graph::explore(model.initial(), limits, |s| successors(&model, s, |_| true), |s| s.hazard)?;
        let path = graph.path_to_last();
        if path.last().is_some_and(|(last, _)| last.hazard) {
            let texts: Vec<_> = kinds.iter().map(|kind| kind.text()).collect();
            let cut = CutSet {
                faults: kinds.iter().map(|kind| kind.name().to_owned()).collect(),
                text: format!("A section with a train in it is reported free: {}.", texts.join(", and ")),
                excluded_by: excluded_by(&kinds),
                trace: model.trace(&path),
            };
            found.push((kinds, cut));
        }
    }
    Some(found.into_iter().map(|(_, cut)| cut).collect())
}

/// The assumptions of which each alone excludes these kinds together.
pub(crate) fn excluded_by(kinds: &[Kind]) -> Vec<String> {
    let detectors = kinds.iter().all(|kind| matches!(kind, Kind::Missed | Kind::Phantom));
    let independent = detectors.then_some("independent-detectors");
    kinds.iter().filter_map(|kind| kind.assumption()).chain(independent).map(ToOwned::to_owned).collect()
}

/// What a set of faults can do to the numbers that are compared.
#[derive(Clone, Copy, Default)]
struct Reach {
    /// How many heads may be missed, and how many heard that are not there.
    missed: u32,
    phantom: u32,
    /// Whether the count may be any number under the trains, or over them.
    under: bool,
    over: bool,
}

/// The minimal cut sets of one or two kinds, by direct evaluation: of every set of sections with heads, every number of trains
/// in them, every missed and phantom detection and every wrong count that the kinds allow, is there one with equal counts and a
/// head that is not heard? No machine, no trains that move, no time: theorem T-BLK-6 counts just the same.
pub fn evaluate(sections: u32, trains: u32) -> BTreeSet<Vec<&'static str>> {
    let mut found: BTreeSet<Vec<&'static str>> = BTreeSet::new();
    for kinds in candidates() {
        let names: Vec<_> = kinds.iter().map(|kind| kind.name()).collect();
        let minimal =
            !found.iter().any(|smaller| smaller.len() < names.len() && smaller.iter().all(|name| names.contains(name)));
        if minimal && dangerous(sections, trains, reach(&kinds)) {
            found.insert(names);
        }
    }
    found
}

fn reach(kinds: &[Kind]) -> Reach {
    let mut reach = Reach::default();
    for kind in kinds {
        match kind {
            Kind::Missed => reach.missed += 1,
            Kind::Phantom => reach.phantom += 1,
            Kind::CheckInLost | Kind::SpuriousCheckOut => reach.under = true,
            Kind::CheckInStuckOn | Kind::CheckOutLost => reach.over = true,
            Kind::WrongReset => (reach.under, reach.over) = (true, true),
        }
    }
    reach
}

fn dangerous(sections: u32, trains: u32, reach: Reach) -> bool {
    let sets = 0..1_u32 << sections;
    let mut tried = sets.clone().flat_map(|heads| sets.clone().map(move |present| (heads, present)));
    tried.any(|(heads, present)| {
        let missed = (heads & !present).count_ones();
        let phantom = (present & !heads).count_ones();
        let possible = missed <= reach.missed && phantom <= reach.phantom && missed > 0;
        // As many trains as sections with heads, or more: some share one.
        possible
            && (heads.count_ones()..=trains).any(|inside| {
                let count = present.count_ones();
                count <= trains && (count == inside || count < inside && reach.under || count > inside && reach.over)
            })
    })
}
