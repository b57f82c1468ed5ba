//! Block counting: the cut sets twice, what single faults do, traces, and wrong machines that must turn a claim red.

use crate::common::outcome;
use crate::outcomes;
use atc_kernel::Machine;
use atc_kernel::block::{
    Beyond as Exit, Block, Hold, Input, Line, LineInput, LineOutput, LineState, Output, Parts, SectionSet, State,
    Status, TrainCount, step,
};
use atc_kernel::time::Ticks;
use atc_models::block::border::{Layout, Pair, Showing};
use atc_models::block::cut_sets::{enumerate, evaluate};
use atc_models::block::device::{Counting, Real};
use atc_models::block::fault::{Faults, Kind};
use atc_models::block::lines::{Lining, RealLine};
use atc_models::block::single::{Beyond, Single};
use atc_models::{Limits, Outcome, Subject, Trace, Verdict, catalogue};
use serde_json::Value;
use std::collections::BTreeSet;
use std::time::Duration;

#[test]
fn the_search_and_the_direct_evaluation_find_the_same_cut_sets() {
    let expected: BTreeSet<Vec<&str>> = [
        ["check-in-lost", "missed-detection"],
        ["missed-detection", "phantom-detection"],
        ["missed-detection", "spurious-check-out"],
        ["missed-detection", "wrong-reset"],
    ]
    .map(Vec::from)
    .into();
    for (sections, trains) in [(2, 1), (3, 2), (4, 2), (3, 3)] {
        let found = enumerate(&Single::usual(Real, sections, trains, 2), Limits::default()).expect("a complete search");
        let found: BTreeSet<Vec<&str>> =
            found.iter().map(|cut| cut.faults.iter().map(String::as_str).collect()).collect();
        assert_eq!(found, evaluate(u32::from(sections), u32::from(trains)), "{sections} × {trains}");
        assert_eq!(found, expected, "{sections} × {trains}");
    }
}

#[test]
fn the_cut_sets_of_the_catalogue_have_traces_and_owners() {
    let listed: Vec<_> = outcomes(&["block", "border"]).filter(|outcome| !outcome.cut_sets.is_empty()).collect();
    assert_eq!(listed.len(), 3);
    for outcome in listed {
        assert_eq!(outcome.cut_sets.len(), 4, "{}", outcome.model);
        for cut in &outcome.cut_sets {
            assert_eq!(cut.excluded_by.len(), 1, "{:?}", cut.faults);
            assert!(outcome.assumptions_lifted.contains(&cut.excluded_by[0]), "{:?}", cut.faults);
            let last = cut.trace.steps.last().expect("a step");
            assert_eq!(last.words["hazard"], true, "{:?}", cut.faults);
        }
        let modes: Vec<_> =
            outcome.failure_modes.iter().map(|m| (m.fault.as_str(), m.safe, m.effect.as_str())).collect();
        let (lasts, reset) = ("all occupied while it lasts", "all occupied until a reset");
        assert_eq!(
            modes,
            [
                ("check-in-lost", true, reset),
                ("check-in-stuck-on", true, reset),
                ("check-out-lost", true, reset),
                ("missed-detection", true, lasts),
                ("phantom-detection", true, lasts),
                ("spurious-check-out", true, reset),
                ("wrong-reset", true, reset),
            ],
            "{}",
            outcome.model
        );
    }
}

#[test]
fn an_incomplete_search_lists_nothing_and_does_not_pass() {
    let entry = catalogue().into_iter().find(|entry| entry.name == "block-two-faults").expect("in the catalogue");
    for limits in [Limits { states: 100, ..Limits::default() }, Limits { time: Duration::ZERO, ..Limits::default() }] {
        let outcome = atc_models::check_within(&entry, 1, limits);
        assert!(!outcome.complete && !outcome.ok() && outcome.cut_sets.is_empty() && outcome.failure_modes.is_empty());
    }
}

fn traces() -> impl Iterator<Item = (&'static Outcome, &'static Trace)> {
    outcomes(&["block", "border"]).flat_map(|outcome| {
        let properties = outcome.properties.iter().filter_map(|property| property.trace.as_ref());
        properties.chain(outcome.cut_sets.iter().map(|cut| &cut.trace)).map(move |trace| (outcome, trace))
    })
}

fn number(value: &Value) -> u8 {
    u8::try_from(value.as_u64().expect("a number")).expect("a small one")
}

fn sections(value: &Value) -> SectionSet {
    let sections = value.as_array().expect("sections").iter().map(number);
    SectionSet::from_bits(sections.fold(0, |set, section| set | 1 << section))
}

#[test]
fn a_trace_is_a_run_of_the_kernel() {
    let mut steps = 0;
    for (outcome, trace) in traces() {
        assert_eq!(trace.machine, "block-count");
        let hold = Hold::new(number(&trace.config["tail_hold_sections"])).expect("a hold");
        let pass = Ticks(u16::from(number(&trace.config["pass_ms"]) / number(&trace.config["cycle_ms"])));
        let (all, most) = (number(&trace.config["sections"]), number(&trace.config["max_trains"]));
        let block = Block::new(all, most, hold, pass).expect("a block");
        let mut state = block.initial();
        for cycle in &trace.steps {
            let read = Input {
                check_in: cycle.input["check_in"].as_bool().expect("a level"),
                check_out: cycle.input["check_out"].as_bool().expect("a level"),
                present: sections(&cycle.input["present"]),
                reset: cycle.input["reset"].as_u64().map(|_| TrainCount(number(&cycle.input["reset"]))),
                ahead_hold: Hold::new(number(&cycle.input["ahead_hold_sections"])).expect("a hold"),
                ahead_entered: cycle.input["ahead_entered"].as_bool().expect("yes or no"),
            };
            let (next, output) = step(block, state, read);
            state = next;
            assert_eq!(sections(&cycle.output["occupied"]), output.occupied, "{}", outcome.model);
            assert_eq!(number(&cycle.output["behind_hold_sections"]), output.behind_hold.sections());
            assert_eq!(cycle.output["agree"], output.agree);
            assert_eq!(number(&cycle.output["count"]), output.count.0);
            assert_eq!(cycle.output["counting"], output.status == Status::Counting);
            assert_eq!(cycle.output["fault"].is_null(), !matches!(output.status, Status::Fault(_)));
            steps += 1;
        }
    }
    assert!(steps > 100, "{steps}");
}

/// The kernel's machine with a defect.
#[derive(Clone, Debug)]
struct Wrong(Defect);

#[derive(Clone, Copy, Debug, PartialEq)]
enum Defect {
    MoreCountedTrusted,
    NoPassTime,
    CountedByLevel,
    ResetUnchecked,
    NoHold,
    NothingAskedBehind,
    FaultForgotten,
}

impl Counting for Wrong {
    fn step(&self, block: Block, state: State, input: Input) -> (State, Output) {
        let parts = state.parts();
        let heads = input.present.and(block.all()).len();
        let mut before = state;
        let kept = match self.0 {
            Defect::NoHold => Block::new(block.sections(), block.max_trains().0, Hold::NONE, block.pass()),
            _ => Ok(block),
        };
        match self.0 {
            Defect::NoPassTime => {
                before = State::from_parts(Parts { check_in_for: parts.check_in_for.min(1), ..parts });
            }
            Defect::CountedByLevel => before = State::from_parts(Parts { check_in_for: 0, ..parts }),
            Defect::FaultForgotten if matches!(parts.status, Status::Fault(_)) => {
                before = State::from_parts(Parts { status: Status::Counting, ..parts });
            }
            _ => {}
        }
        let (next, output) = step(kept.expect("a block"), before, input);
        let believed = |next: State| {
            let verified = Input { check_in: false, check_out: false, reset: Some(TrainCount(heads)), ..input };
            let (_, report) = step(block, State::INITIAL, verified);
            (next, Output { occupied: report.occupied, behind_hold: report.behind_hold, agree: report.agree, ..output })
        };
        let counting = output.status == Status::Counting;
        match self.0 {
            Defect::MoreCountedTrusted if counting && output.count.0 > heads => believed(next),
            Defect::ResetUnchecked if input.reset.is_some() => {
                believed(State::from_parts(Parts { count: heads, status: Status::Counting, ..next.parts() }))
            }
            Defect::NothingAskedBehind => (next, Output { behind_hold: Hold::NONE, ..output }),
            _ => (next, output),
        }
    }
}

#[track_caller]
fn red<S: Subject>(model: S, property: &str) {
    let outcome = outcome(model);
    assert!(outcome.complete && !outcome.ok(), "{property}");
    let found = outcome.properties.iter().find(|p| p.name == property).expect("a property of the model");
    assert_eq!(found.verdict, Verdict::Failed, "{property}");
}

#[test]
fn wrong_machines_turn_red() {
    for budget in [0, 1] {
        assert!(outcome(Single::usual(Real, 3, 2, budget)).ok());
    }
    let wrong = |defect, budget| Single::usual(Wrong(defect), 3, 2, budget);
    red(wrong(Defect::MoreCountedTrusted, 1), "train-reported");
    red(wrong(Defect::NoHold, 0), "train-reported");
    red(wrong(Defect::NothingAskedBehind, 0), "train-reported");
    red(Single { beyond: Beyond::LoudBorders, ..wrong(Defect::CountedByLevel, 0) }, "exact");
    red(wrong(Defect::ResetUnchecked, 1), "train-reported");
}

#[test]
fn a_wrong_machine_has_more_cut_sets() {
    let cuts = |defect| {
        let found = enumerate(&Single::usual(Wrong(defect), 3, 2, 2), Limits::default()).expect("a complete search");
        found.iter().map(|cut| cut.faults.join(" ")).collect::<Vec<_>>()
    };
    assert!(cuts(Defect::NoPassTime).contains(&"check-in-stuck-on missed-detection".to_owned()));
    assert!(cuts(Defect::FaultForgotten).contains(&"check-in-stuck-on missed-detection".to_owned()));
    assert!(cuts(Defect::MoreCountedTrusted).contains(&"missed-detection".to_owned()));
    let sound = enumerate(&Single::usual(Real, 3, 2, 2), Limits::default()).expect("a complete search");
    assert_eq!(sound.len(), 4);
    assert_eq!(Kind::ALL.len(), 7);
}

/// The kernel's line with a defect.
#[derive(Clone, Debug)]
enum WrongLine {
    /// What the block ahead asks to hold is not passed on.
    HoldLost,
    /// A check-out takes effect at once.
    TakesOverAtOnce,
}

impl Lining for WrongLine {
    fn step(&self, line: &Line<2>, mut state: LineState<2>, input: LineInput<2>) -> (LineState<2>, LineOutput<2>) {
        if let Self::TakesOverAtOnce = self {
            state.borders[1].0 = 16;
        }
        let (next, mut output) = line.step(state, input);
        if let Self::HoldLost = self {
            // Each block alone, with nothing asked from ahead.
            let none = LineInput { beyond: Exit { hold: Hold::NONE, ..input.beyond }, ..input };
            output = line.step(state, none).1;
            let asked = output.blocks[1].behind_hold;
            if asked > Hold::NONE && output.blocks[0].agree {
                output.blocks[0].occupied = input.blocks[0].present;
            }
        }
        (next, output)
    }

    fn takes_over(&self, before: &LineState<2>, input: &LineInput<2>, ahead: &Output) -> bool {
        RealLine.takes_over(before, input, ahead)
    }

    fn is_valid(&self, _: &Line<2>, _: &LineState<2>) -> bool {
        true
    }
}

#[test]
fn wrong_lines_turn_red() {
    let pair = |device: WrongLine, layout| Pair {
        device,
        trains: 2,
        hold: 1,
        pass: 2,
        layout,
        check_out_at_border: true,
        reset_while_crossing: false,
        faults: vec![Faults::NONE],
        showing: Showing::Safe,
    };
    red(pair(WrongLine::HoldLost, Layout::Overlapping), "train-reported");
    red(pair(WrongLine::TakesOverAtOnce, Layout::CheckOutFirst), "in-a-count");
}
