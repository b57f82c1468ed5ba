//! The permitted speed: wrong devices that must turn a claim red, traces that are runs of the kernel, and the ground truth.

use crate::common::outcome;
use crate::outcomes;
use atc_kernel::Machine;
use atc_kernel::aspect::AspectId;
use atc_kernel::permitted::{Basis, Heard, LineKind, Permission, Permitted, Settings, State, step};
use atc_kernel::speed::KmhTenths;
use atc_kernel::telegram::{Counter, Gradient};
use atc_kernel::time::Ticks;
use atc_models::permitted::device::{Conventional, Device, FixOfAnyCycle, Real};
use atc_models::permitted::layout::{BRAKE_MM_S2, CELL_M, Layout, SPEEDS, Section};
use atc_models::permitted::ride::{Border, Changes, Delivery, Environment, Fix, Odometer, Ride, Small, Transmitter};
use atc_models::permitted::{Purpose, Sight};
use atc_models::{Expectation, Subject, Verdict};
use std::collections::{BTreeSet, HashSet};

#[track_caller]
fn red<D: Device>(model: Ride<D>, property: &str) {
    let sound = Ride::new(Real, model.layout.clone(), model.small, model.environment, model.purpose);
    assert!(outcome(sound).ok(), "{property}: the kernel in the same model");
    let outcome = outcome(model);
    let verdicts: Vec<_> = outcome.properties.iter().map(|p| (p.name.as_str(), p.verdict)).collect();
    assert!(outcome.complete && !outcome.ok(), "{property}: {}, {verdicts:?}", outcome.complete);
    let found = outcome.properties.iter().find(|p| p.name == property).expect("a property of the model");
    assert_eq!(found.verdict, Verdict::Failed, "{property}");
}

/// The kernel's device with a defect.
#[derive(Clone, Copy, Debug)]
enum Wrong {
    /// The code is not compared with the pattern.
    HigherOfTwo,
    /// The telegrams' speed is permitted whatever the code says.
    CodeUnheard,
    /// A main telegram never grows old.
    TargetForEver,
    /// A sub telegram never grows old.
    FixedForEver,
    /// Where a digital line is told after an analog one the code is enough.
    BorderPermits,
    /// Telegrams are fresh for as long as they live.
    StaleIsFresh,
    /// Every telegram is used, whatever its number.
    CounterUnread,
    /// One telegram in order is enough, whatever the run.
    RunOfOne,
    /// Without a sub telegram the section is taken for level and without limit.
    NothingWorse,
    /// Gradients are not read.
    AlwaysLevel,
    /// Limits of sub telegrams are not read.
    NoLimit,
    /// The speed of main telegrams is not read.
    NoMainSpeed,
    /// What the train moves is not taken off.
    NotMoved,
    /// A point that is drawn back is taken to be where the last one was.
    PointKept,
}

impl Device for Wrong {
    fn step(&self, permitted: &Permitted, before: State, mut heard: Heard) -> (State, Permission) {
        let mut state = before;
        let life = permitted.settings().life;
        let in_order = permitted.settings().sequence.run();
        match self {
            Self::CodeUnheard if state.line == LineKind::Digital && heard.analog.is_some() => {
                let (next, permission) = step(permitted, state, heard);
                let (_, alone) = step(permitted, state, Heard { analog: Some(KmhTenths(u16::MAX)), ..heard });
                return (
                    next,
                    Permission { speed: alone.speed.map(|speed| speed.min(KmhTenths(SPEEDS[1]))), ..permission },
                );
            }
            Self::HigherOfTwo => {
                let (next, permission) = step(permitted, state, heard);
                let both = permission.basis == Basis::Both;
                return (next, if both { Permission { speed: heard.analog, ..permission } } else { permission });
            }
            Self::TargetForEver => {
                if let Some(target) = &mut state.target {
                    target.age = Ticks(0);
                }
            }
            Self::FixedForEver => state.fixed.iter_mut().flatten().for_each(|fixed| fixed.age = Ticks(0)),
            Self::BorderPermits if heard.line == Some(LineKind::Digital) && state.line == LineKind::Analog => {
                let (next, permission) = step(permitted, state, heard);
                return (next, Permission { speed: heard.analog, ..permission });
            }
            Self::StaleIsFresh => {
                let settings = Settings { fresh: life, ..*permitted.settings() };
                return step(&Permitted::new(settings).expect("parameters"), state, heard);
            }
            Self::CounterUnread => {
                if let (Some(main), Some(last)) = (heard.main, &mut state.main_stream.last) {
                    last.counter = Counter(main.counter.0.wrapping_sub(1));
                    state.main_stream.in_order = in_order;
                }
            }
            Self::RunOfOne => {
                if state.main_stream.last.is_some() {
                    state.main_stream.in_order = in_order;
                }
            }
            Self::NothingWorse => {
                let settings =
                    Settings { worst: Gradient(0), lowest: AspectId::new(1).expect("a rank"), ..*permitted.settings() };
                return step(&Permitted::new(settings).expect("parameters"), state, heard);
            }
            Self::AlwaysLevel => heard.sub.iter_mut().for_each(|sub| sub.gradient = Gradient(0)),
            Self::NoLimit => {
                let top = AspectId::new(1).expect("a rank");
                heard.sub.iter_mut().for_each(|sub| (sub.curve, sub.restriction) = (top, top));
            }
            Self::NoMainSpeed => {
                heard.main.iter_mut().for_each(|main| main.speed = AspectId::new(1).expect("a rank"));
            }
            Self::NotMoved => heard.moved.0 = 0,
            Self::PointKept => {
                if let (Some(main), Some(target)) = (heard.main, &mut state.target) {
                    target.beyond = main.route.beyond_exit();
                }
            }
            Self::CodeUnheard | Self::BorderPermits => {}
        }
        step(permitted, state, heard)
    }
}

const SAFE: Purpose = Purpose::Safe(&[]);

fn wrong(device: Wrong, layout: &Layout, small: Small, environment: Environment) -> Ride<Wrong> {
    Ride::new(device, layout.clone(), small, environment, SAFE)
}

#[test]
fn wrong_ages_turn_red() {
    let drawn = Layout::digital(&[2, 3, 3], &[5, 5, 7]);
    let codes = Environment { code: Delivery::Always, route: Changes::Any, ..Environment::USUAL };
    let usual = Small::USUAL;
    for device in [Wrong::TargetForEver, Wrong::NoMainSpeed] {
        red(wrong(device, &drawn, usual, codes), "not-above-ground");
    }
    red(wrong(Wrong::PointKept, &drawn, usual, Environment { fix: Fix::Any, ..codes }), "not-above-ground");
    red(wrong(Wrong::TargetForEver, &drawn, usual, codes), "silence-stops");
    red(wrong(Wrong::TargetForEver, &drawn, usual, codes), "stands-in-time");
    let (long, silent) = (Small { life: 4, ..usual }, Environment { code: Delivery::Never, keeps: 4, ..codes });
    red(wrong(Wrong::StaleIsFresh, &drawn, long, silent), "silence-stops");
    let mut restricted = Layout::digital(&[8, 2], &[10]);
    restricted.sections[0].restrictable = true;
    let restriction = Environment { sub: Delivery::Any, restriction: true, ..Environment::USUAL };
    for device in [Wrong::FixedForEver, Wrong::NoLimit] {
        red(wrong(device, &restricted, usual, restriction), "not-above-ground");
    }
}

#[test]
fn wrong_codes_and_lines_turn_red() {
    let mut slow = Layout::digital(&[4, 4], &[8]);
    slow.sections[0].code = 0;
    let codes = Environment { code: Delivery::Any, ..Environment::USUAL };
    red(wrong(Wrong::CodeUnheard, &slow, Small { lowest: 1, ..Small::USUAL }, codes), "not-above-code");
    red(wrong(Wrong::HigherOfTwo, &Layout::digital(&[4, 4], &[4]), Small::USUAL, codes), "not-above-ground");
    let border = Layout {
        sections: vec![Section::plain(LineKind::Analog, 2), Section::plain(LineKind::Digital, 4)],
        points: vec![6],
    };
    red(wrong(Wrong::BorderPermits, &border, Small::USUAL, codes), "silence-stops");
    let analog = Layout { sections: vec![Section::plain(LineKind::Analog, 4)], points: vec![4] };
    let conventional = Ride::new(Conventional, analog, Small::USUAL, codes, SAFE);
    assert!(outcome(conventional).ok());
}

#[test]
fn wrong_counters_turn_red() {
    let drawn = Layout::digital(&[3, 4, 3], &[7, 9]);
    let looping = |telegrams| Environment {
        transmitter: Transmitter::Loops(telegrams),
        route: Changes::Withdrawn,
        code: Delivery::Always,
        keeps: 2 * Small::USUAL.life,
        ..Environment::USUAL
    };
    // Sub telegrams grow old at the same time: without a lower limit to fall back on they hide nothing.
    let run = |run| Small { run, lowest: 1, ..Small::USUAL };
    red(wrong(Wrong::CounterUnread, &drawn, run(1), looping(1)), "not-above-ground");
    red(wrong(Wrong::RunOfOne, &drawn, run(2), looping(2)), "not-above-ground");
}

#[test]
fn wrong_worst_cases_and_distances_turn_red() {
    let mut downhill = Layout::digital(&[3, 4, 3], &[7]);
    downhill.sections[1].gradient = -100;
    let late = Environment { sub: Delivery::Any, fix: Fix::Any, ..Environment::USUAL };
    let steep = Small { lowest: 1, worst: -100, ..Small::USUAL };
    for device in [Wrong::NothingWorse, Wrong::AlwaysLevel] {
        red(wrong(device, &downhill, steep, late), "not-above-ground");
    }
    let layout = Layout::digital(&[6, 3], &[7]);
    let measured = Environment { fix: Fix::Any, ..Environment::USUAL };
    red(wrong(Wrong::NotMoved, &layout, Small::USUAL, measured), "not-above-ground");
    let bounded = Environment { odometer: Odometer::Bounded, ..measured };
    red(wrong(Wrong::NotMoved, &layout, Small::USUAL, bounded), "not-above-ground");
    let crossing = Environment { border: Border::Crossing, ..measured };
    let border = Layout::digital(&[4, 4, 2], &[8]);
    let any = Ride::new(FixOfAnyCycle, border.clone(), Small { margin: 2, ..Small::USUAL }, crossing, SAFE);
    red(any, "not-above-ground");
}

#[test]
fn a_sight_that_is_not_reached_turns_red() {
    let layout = Layout::digital(&[3, 4, 2], &[7]);
    let deaf = Environment { main: Delivery::Never, code: Delivery::Always, ..Environment::USUAL };
    let sights =
        [Sight::Pattern, Sight::RunsDown, Sight::Recovers, Sight::Restricted, Sight::OldPoint, Sight::OldLimit];
    for sight in sights.map(|sight| [sight]) {
        let purpose = Purpose::Safe(Box::leak(Box::new(sight)));
        let outcome = outcome(Ride::new(Real, layout.clone(), Small::USUAL, deaf, purpose));
        assert!(outcome.complete && !outcome.ok(), "{sight:?}");
        assert!(outcome.properties.iter().any(|p| p.verdict == Verdict::NotFound), "{sight:?}");
    }
}

#[test]
fn every_assumption_is_lifted_by_a_model_that_shows_what_happens() {
    let expected: BTreeSet<_> = [
        "limits-reach-over-the-border",
        "odometer-bound",
        "stop-point-life",
        "transmitter-does-not-loop",
        "sub-data-worst",
        "fix-of-the-section-heard",
        "margin-covers-the-crossing",
        "line-is-told",
    ]
    .into();
    let mut excluding = BTreeSet::new();
    for outcome in outcomes(&["permitted"]) {
        for property in outcome.properties.iter().filter(|p| p.expectation == Expectation::HazardFound) {
            let last = property.trace.as_ref().and_then(|trace| trace.steps.last()).expect("a trace");
            assert_eq!(last.words["hazard"], true, "{}", outcome.model);
            excluding.extend(property.excluded_by.iter().map(String::as_str).filter(|id| !id.starts_with("PER-")));
        }
    }
    assert_eq!(excluding, expected);
}

#[test]
fn a_trace_with_true_counters_is_what_the_model_saw_with_relative_ones() {
    let (mut steps, mut wraps) = (0, 0);
    for outcome in outcomes(&["permitted"]) {
        let other = ["permitted-lines-conventional", "permitted-border-fix-of-any-cycle"];
        if other.contains(&outcome.model.as_str()) {
            continue;
        }
        for trace in outcome.properties.iter().filter_map(|property| property.trace.as_ref()) {
            let counters: Vec<_> = trace.steps.iter().filter_map(|s| s.input["main"]["counter"].as_u64()).collect();
            wraps += usize::from(counters.windows(2).any(|pair| pair[1] < pair[0]));
            for step in &trace.steps {
                let model = &step.words["permitted_by_the_model_km_h"];
                assert_eq!(step.output["speed_km_h"], *model, "{}", outcome.model);
                steps += 1;
            }
        }
    }
    assert!(steps > 250 && wraps > 10, "{steps} steps, {wraps} wraps");
}

/// A search of its own: no fingerprints, no early end.
fn reachable<D: Device>(model: &Ride<D>) -> usize {
    let mut pending = model.initial();
    let mut seen: HashSet<_> = pending.iter().copied().collect();
    let mut actions = Vec::new();
    while let Some(state) = pending.pop() {
        model.actions(&state, &mut actions);
        for action in actions.drain(..) {
            pending.extend(model.next(&state, &action).filter(|next| seen.insert(*next)));
        }
    }
    seen.len()
}

#[test]
fn a_plain_search_counts_the_same_states() {
    let layout = Layout::digital(&[6, 3], &[7]);
    let counted =
        |name: &str| outcomes(&["permitted"]).find(|o| o.model == name).expect("in the catalogue").unique_states;
    let odometer = Environment { odometer: Odometer::Bounded, fix: Fix::Any, ..Environment::USUAL };
    let levels = Environment { fix: Fix::Levels, ..Environment::USUAL };
    for (name, environment) in [("permitted-odometer", odometer), ("permitted-position", levels)] {
        assert_eq!(
            reachable(&Ride::new(Real, layout.clone(), Small::USUAL, environment, SAFE)),
            counted(name),
            "{name}"
        );
    }
}

#[test]
fn the_ground_truth_is_the_physics_of_braking() {
    let mut layout = Layout::digital(&[3, 4, 5], &[12]);
    layout.sections[1].gradient = -60;
    layout.sections[2].gradient = 35;
    for place in 0..12_u8 {
        let cells = (place..12).map(|cell| match cell {
            0..=2 => 0.0,
            3..=6 => -60.0,
            _ => 35.0,
        });
        let work: f64 = cells
            .map(|thousandths: f64| {
                (f64::from(BRAKE_MM_S2) / 1000.0 + 9.806_65 * thousandths / 1000.0) * f64::from(CELL_M)
            })
            .sum();
        let exact = (2.0 * work).sqrt() * 36.0;
        for speed in 0..=SPEEDS[1] {
            let off = f64::from(speed) - exact;
            if off.abs() > 0.001 {
                assert_eq!(layout.keeps(speed, place, 0), off < 0.0, "{speed} at {place}");
            }
        }
    }
}

#[test]
fn a_ride_starts_in_the_kernels_initial_state() {
    let layout = Layout::digital(&[3], &[3]);
    let ride = Ride::new(Real, layout, Small::USUAL, Environment::USUAL, SAFE);
    let [state] = ride.initial()[..] else { panic!("one initial state") };
    assert_eq!(state.kept.0, ride.permitted().initial());
}
