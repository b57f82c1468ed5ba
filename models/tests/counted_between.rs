//! The counted line between two stations: wrong devices and wrong grounds turn it red, and drawn runs on a longer line find nothing.

mod common;
mod drawn;

use atc_models::block::fault::Kind;
use atc_models::interlocking::between::Lives;
use atc_models::interlocking::counted_between::{
    Around, CountedBetween, Failure, Faults, Purpose, State, Wiring, Withdraws, cut_sets, wrong,
};
use atc_models::{Subject, Verdict};
use common::outcome;
use drawn::Drawn;
use std::collections::HashSet;

const LIVES: Lives = Lives { permission: 1, residual: 1 };

fn model(faults: Vec<Faults>) -> CountedBetween<1> {
    CountedBetween::new(2, 2, LIVES, faults, Purpose::Safe).orderly()
}

/// What of a model is not as expected.
fn failed(model: CountedBetween<1>) -> Vec<String> {
    let outcome = outcome(model);
    assert!(outcome.complete);
    let failed = outcome.properties.iter().filter(|property| !property.ok());
    failed.map(|property| format!("{}: {:?}", property.name, property.verdict)).collect()
}

/// Each of these turns these claims red; the kernel's devices keep all of them in the same model.
#[track_caller]
fn red(faults: Vec<Faults>, wiring: Wiring, claims: &[&str]) {
    assert!(failed(model(faults.clone())).is_empty(), "the kernel's");
    let outcome = outcome(model(faults).wired(wiring));
    let failed = outcome.properties.iter().filter(|property| property.verdict == Verdict::Failed);
    assert_eq!(failed.map(|property| property.name.as_str()).collect::<Vec<_>>(), claims, "{wiring:?}");
}

fn starts() -> Vec<Faults> {
    [Around::SenderStarts, Around::ReceiverStarts].map(|around| Faults::around(around, true)).into()
}

const ACCIDENT: [&str; 3] = ["never-met", "sections-occupied", "proceed-over-clear"];

#[test]
fn a_joint_that_holds_nothing_turns_red() {
    red(vec![Faults::NONE], Wiring::HoldsNothing, &ACCIDENT);
}

#[test]
fn a_count_that_is_believed_only_while_it_agrees_turns_red() {
    red(Failure::Counting(Kind::Missed).single(2, 1), Wiring::OnlyWhileCounting, &ACCIDENT);
}

#[test]
fn a_receiver_that_permits_while_its_count_is_not_verified_turns_red() {
    red(starts(), Wiring::PermitsUnverified, &["permits-what-is-counted"]);
}

#[test]
fn a_sender_that_believes_a_permission_for_ever_turns_red() {
    red(starts(), Wiring::BelievesForEver, &["sent-by-permission"]);
}

/// The ground is what the claims look at: trains that go on along the line without a telegram meet.
#[test]
fn trains_without_a_telegram_turn_red() {
    let mut heedless = model(vec![Faults::NONE]);
    heedless.heedless = true;
    assert_eq!(failed(heedless), ["never-met: Failed"]);
}

/// What is free to fail in every cycle includes what fails once.
#[test]
fn what_fails_once_is_found_with_what_fails_at_will() {
    let pair = [Kind::Missed, Kind::CheckInLost].map(Failure::Counting);
    let sets = cut_sets::places(&pair, 2, 1);
    let at_will = failed(model(sets.clone()));
    let once = failed(model(sets).once());
    assert!(once.contains(&"never-met: Failed".to_owned()) && once.iter().all(|it| at_will.contains(it)), "{once:?}");
}

/// Every state that is reached from these.
fn reachable(model: &CountedBetween<1>, from: impl IntoIterator<Item = State>) -> HashSet<State> {
    let mut seen: HashSet<State> = from.into_iter().collect();
    let mut pending: Vec<State> = seen.iter().copied().collect();
    let mut cycles = Vec::new();
    while let Some(state) = pending.pop() {
        cycles.clear();
        model.actions(&state, &mut cycles);
        let after = cycles.iter().filter_map(|cycle| model.next(&state, cycle));
        pending.extend(after.filter(|after| seen.insert(*after)));
    }
    seen
}

/// When the receiver starts again with a train wholly on the line, it can be commanded so that the train comes in: a counted line has one direction
/// only (WAY-10), so that the neighbour has sent every train on it (ILK-25).
#[test]
fn a_receiver_that_starts_again_lets_in_a_train_that_is_on_the_line() {
    let model = model(vec![Faults::around(Around::ReceiverStarts, true)]);
    let (sections, throat) = (2..4, 4);
    let on_the_line = |state: &State| {
        let stands = state.trains.iter().any(|train| sections.contains(&train.rear) && sections.contains(&train.front));
        stands
            && state
                .trains
                .iter()
                .all(|train| train.since > LIVES.residual && !(throat..=throat + 1).contains(&train.front))
    };
    let mut struck = Vec::new();
    let mut cycles = Vec::new();
    for state in reachable(&model, model.initial()) {
        cycles.clear();
        model.actions(&state, &mut cycles);
        let starts =
            cycles.iter().filter(|cycle| cycle.outcomes[1].started).filter_map(|cycle| model.next(&state, cycle));
        struck.extend(starts.filter(on_the_line).map(|state| State { faults: Faults::NONE, ..state }));
    }
    assert!(struck.len() > 100, "{}", struck.len());
    let after = reachable(&model, struck);
    assert!(after.iter().any(|state| state.trains.iter().any(|train| train.front == throat)));
    assert!(after.iter().all(|state| state.wrong == 0));
}

/// Runs of `depth` cycles, each from a drawn one of the initial states. The first state in which something is wrong; and how often a train was wholly
/// in the receiver's platform, its place `end`.
fn swarm<const B: usize>(model: &CountedBetween<B>, runs: u64, depth: usize, end: u8) -> (Option<State>, usize) {
    let initial = model.initial();
    let (mut cycles, mut arrived) = (Vec::new(), 0);
    for run in 0..runs {
        let mut drawn = Drawn(run);
        let mut state = initial[drawn.below(initial.len())];
        for _ in 0..depth {
            cycles.clear();
            model.actions(&state, &mut cycles);
            if cycles.is_empty() {
                break;
            }
            state = model.next(&state, &cycles[drawn.below(cycles.len())]).expect("a state");
            if state.wrong != 0 {
                return (Some(state), arrived);
            }
            arrived += usize::from(state.trains.iter().any(|train| train.rear == end));
        }
    }
    (None, arrived)
}

/// Two blocks of two sections, three trains, any pair of faults that is no cut set, free to fail in every cycle.
#[test]
fn drawn_runs_on_two_blocks_find_nothing_but_with_a_cut_set() {
    let name = |kinds: &[Failure]| kinds.iter().map(|kind| kind.name()).collect::<Vec<_>>();
    let cuts = ["check-in-lost", "phantom-detection", "spurious-check-out", "wrong-reset"];
    let is_cut =
        |kinds: &[Failure]| name(kinds).contains(&"missed-detection") && cuts.iter().any(|it| name(kinds).contains(it));
    let (bad, good): (Vec<_>, Vec<_>) = cut_sets::candidates().into_iter().partition(|kinds| is_cut(kinds));
    assert_eq!((bad.len(), good.len()), (4, 100));
    let places = |sets: Vec<Vec<Failure>>| sets.iter().flat_map(|kinds| cut_sets::places(kinds, 2, 2)).collect();
    let new = |faults| CountedBetween::<2>::new(2, 3, LIVES, faults, Purpose::Safe);
    let mut model = new(places(good));
    model.withdraws = Withdraws::InUse;
    let (found, arrived) = swarm(&model, 600, 150, 7);
    assert_eq!(found, None);
    assert!(arrived > 200, "{arrived}");
    let (found, _) = swarm(&new(places(bad)).orderly(), 600, 150, 7);
    assert!(found.is_some_and(|state| state.wrong & wrong::UNREPORTED != 0));
}
