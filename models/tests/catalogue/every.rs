//! Every model of the catalogue: its expectations, its size, its names and its traces.

use crate::OUTCOMES;
use crate::large::LARGE;
use crate::unique_states::UNIQUE_STATES;
use atc_kernel::aspect::{Acceptance, AspectSet, State, Times, step};
use atc_models::bursts::{Bursts, duty_cycle};
use atc_models::comparison::{Comparison, Extra};
use atc_models::interruption::Interruption;
use atc_models::line::{ASPECTS_KM_H, COARSE, DEFAULT, EARLY, LATE};
use atc_models::reception::claims::{Bound, Purpose};
use atc_models::reception::{Environment, Ground, Longest, Reception};
use atc_models::{Expectation, Limits, Subject, Trace, Verdict, catalogue, check, check_within};
use atc_protocol::machine::aspect::Config;
use atc_protocol::{Kmh, Session};
use serde_json::Value;
use std::collections::{BTreeSet, HashSet};
use std::hash::Hash;
use std::time::Duration;

#[test]
fn every_expectation_is_met() {
    for outcome in OUTCOMES.iter() {
        for property in &outcome.properties {
            assert!(property.ok(), "{}, {}: {:?}", outcome.model, property.name, property.verdict);
            let traced = property.expectation != Expectation::AlwaysHolds;
            assert_eq!(property.trace.is_some(), traced, "{}, {}", outcome.model, property.name);
        }
        assert!(outcome.ok(), "{}", outcome.model);
    }
}

#[test]
fn the_unique_states_are_pinned() {
    let counted: Vec<_> = OUTCOMES.iter().map(|outcome| (outcome.model.as_str(), outcome.unique_states)).collect();
    assert_eq!(counted, UNIQUE_STATES);
}

/// The ids of `spec/assumptions.toml`.
fn known() -> BTreeSet<&'static str> {
    let lines = include_str!("../../../spec/assumptions.toml").lines();
    lines.filter_map(|line| line.strip_prefix("id = \"")?.strip_suffix('"')).collect()
}

#[test]
fn names_are_unique_and_assumptions_are_known() {
    assert!(LARGE.iter().all(|name| catalogue().iter().any(|entry| entry.name == *name)));
    let known = known();
    let mut used = BTreeSet::new();
    let mut names = BTreeSet::new();
    for entry in catalogue() {
        assert!(names.insert(entry.name), "{} twice", entry.name);
        used.extend(entry.in_force.iter().chain(entry.lifted));
        assert!(entry.in_force.iter().all(|id| !entry.lifted.contains(id)), "{}: in force and lifted", entry.name);
    }
    for outcome in OUTCOMES.iter() {
        let mut names = BTreeSet::new();
        for property in &outcome.properties {
            assert!(names.insert(&property.name), "{}: {} twice", outcome.model, property.name);
            let hazard = property.expectation == Expectation::HazardFound;
            assert_eq!(hazard, !property.excluded_by.is_empty(), "{}: {}", outcome.model, property.name);
            let assumed = property.excluded_by.iter().filter(|id| !is_requirement(id));
            for id in assumed {
                assert!(known.contains(id.as_str()), "{id}");
                assert!(outcome.assumptions_lifted.contains(id), "{}: {id} excludes, and is not lifted", outcome.model);
            }
        }
    }
    // Others are of proofs and of the argument; one that nothing uses is an open item of the case.
    let unknown: Vec<_> = used.difference(&known).collect();
    assert!(used.len() > 30 && unknown.is_empty(), "{} used, unknown: {unknown:?}", used.len());
}

fn is_requirement(id: &str) -> bool {
    ["ACC-", "BLK-", "PER-", "ILK-"].iter().any(|part| id.starts_with(part))
}

#[test]
fn every_assumption_that_excludes_a_hazard_is_in_force_in_a_model_that_keeps_a_bound() {
    let excluding = OUTCOMES.iter().flat_map(|o| &o.properties).flat_map(|p| &p.excluded_by);
    for id in excluding.filter(|id| !is_requirement(id)) {
        let kept = OUTCOMES.iter().any(|outcome| {
            let hazard = outcome.properties.iter().any(|p| p.expectation == Expectation::HazardFound);
            outcome.assumptions_in_force.contains(id) && !hazard
        });
        assert!(kept, "{id}");
    }
}

#[test]
fn threads_change_nothing() {
    for name in ["any-detections", "exposure", "burst-loops"] {
        let entry = catalogue().into_iter().find(|entry| entry.name == name).expect("in the catalogue");
        let outcome = check(&entry, 3);
        let pinned = UNIQUE_STATES.iter().find(|(pinned, _)| *pinned == name).map(|(_, states)| *states);
        assert!(outcome.ok());
        assert_eq!(Some(outcome.unique_states), pinned);
    }
}

#[test]
fn a_search_that_is_cut_short_does_not_pass() {
    for name in ["any-detections", "interruption-late", "misread-short"] {
        let entry = catalogue().into_iter().find(|entry| entry.name == name).expect("in the catalogue");
        let time = Limits::default().time;
        for limits in [
            Limits { states: 0, time },
            Limits { states: 1, time },
            Limits { states: 50, time },
            Limits { time: Duration::ZERO, ..Limits::default() },
        ] {
            let outcome = check_within(&entry, 1, limits);
            assert!(!outcome.complete && !outcome.ok(), "{name} {limits:?}");
            let passed = outcome.properties.iter().filter(|property| property.verdict == Verdict::ModelChecked);
            assert_eq!(passed.count(), 0, "{name} {limits:?}");
            let absent = outcome.properties.iter().filter(|property| property.verdict == Verdict::NotFound);
            assert_eq!(absent.count(), 0, "{name} {limits:?}");
        }
    }
}

#[test]
fn one_state_less_than_there_are_is_incomplete() {
    let entry = catalogue().into_iter().find(|entry| entry.name == "interruption-late").expect("in the catalogue");
    let (_, states) = UNIQUE_STATES.iter().find(|(name, _)| *name == entry.name).expect("pinned");
    let within = |states| check_within(&entry, 1, Limits { states, ..Limits::default() });
    assert!(!within(states - 1).complete);
    assert!(within(*states).complete);
}

/// A search of its own: no fingerprints, no early end.
fn reachable<S: Subject<State: Eq>>(model: &S) -> usize {
    let mut pending = model.initial();
    let mut seen: HashSet<S::State> = pending.iter().cloned().collect();
    let mut actions = Vec::new();
    while let Some(state) = pending.pop() {
        model.actions(&state, &mut actions);
        for action in actions.drain(..) {
            pending.extend(model.next(&state, &action).filter(|next| insert(&mut seen, next)));
        }
    }
    seen.len()
}

fn insert<T: Clone + Eq + Hash>(seen: &mut HashSet<T>, item: &T) -> bool {
    !seen.contains(item) && seen.insert(item.clone())
}

#[test]
fn a_plain_search_counts_the_same_states() {
    let usual = [Extra::Credit, Extra::Mask, Extra::Rise];
    let short = Environment {
        ground: Ground::Any { dwell: 1, silence: true },
        interruption: Longest::Unlimited,
        between: 0,
        burst: 1,
        spacing: 1,
    };
    let exposure = Reception::<Acceptance<2>, 2>::new(LATE, short, Purpose::Exposure(Bound::ShortBursts));
    let counted = [
        ("any-detections", reachable(&Comparison::<Acceptance<2>, 2>::new(COARSE, &usual))),
        ("any-detections-three", reachable(&Comparison::<Acceptance<3>, 3>::new(EARLY, &usual))),
        ("interruption", reachable(&Interruption::<Acceptance<1>>::new(DEFAULT))),
        ("exposure-late", reachable(&exposure)),
        ("burst-loops", reachable(&Bursts::<Acceptance<1>>::new(COARSE, COARSE.ticks()))),
    ];
    for counted in counted {
        assert!(UNIQUE_STATES.contains(&counted), "{counted:?}");
    }
}

fn config(trace: &Trace) -> Config {
    serde_json::from_str(&trace.config.to_string()).expect("a configuration")
}

fn times(config: &Config) -> Times {
    config.times().expect("the configuration of a trace is valid")
}

fn km_h(value: &serde_json::Value) -> Vec<u16> {
    serde_json::from_value(value.clone()).expect("speeds")
}

fn detected(km_h: &[u16]) -> AspectSet {
    let rank = |speed: &u16| ASPECTS_KM_H.iter().position(|known| known == speed).expect("a known speed");
    AspectSet::from_bits(km_h.iter().fold(0, |set, speed| set | 1 << rank(speed)))
}

#[test]
fn a_loop_leads_back_to_its_own_start() {
    let mut loops = 0;
    for outcome in OUTCOMES.iter() {
        for property in outcome.properties.iter().filter(|p| p.expectation == Expectation::HazardFound) {
            let Some(trace) = &property.trace else { continue };
            let Some(start) = trace.loop_start else { continue };
            loops += 1;
            let conventional = outcome.model.contains("conventional") || property.name.contains("conventional");
            let line = times(&config(trace));
            let times = if conventional { line.conventional() } else { line };
            let mut state = State::<4>::INITIAL;
            let mut at_start = state;
            let mut displayed = 0;
            for (place, cycle) in trace.steps.iter().enumerate() {
                if place == start {
                    at_start = state;
                }
                let (next, display) = step(times, state, detected(&km_h(&cycle.input["detected_km_h"])));
                state = next;
                if place >= start {
                    assert_eq!(cycle.words["sent_km_h"], serde_json::json!([]), "the ground sends nothing in the loop");
                    displayed += usize::from(display.aspect().is_some());
                }
            }
            assert_eq!(state, at_start, "{}: {}", outcome.model, property.name);
            let length = trace.steps.len() - start;
            let gaps = property.name == "returns-for-ever";
            assert!(if gaps { (1..length).contains(&displayed) } else { displayed == length }, "{}", property.name);
        }
    }
    assert_eq!(loops, 7);
}

#[test]
fn the_default_duty_cycles_are_those_of_the_specification() {
    let times = DEFAULT.ticks();
    assert_eq!(duty_cycle(times), (10, 80));
    assert_eq!(duty_cycle(times.conventional()), (30, 80));
}

#[test]
fn a_trace_is_a_case_for_the_oracle() {
    let traces = OUTCOMES.iter().flat_map(|o| &o.properties).filter_map(|p| p.trace.as_ref());
    for trace in traces.filter(|trace| trace.machine == "aspect-acceptance") {
        let text = trace.trace_jsonl();
        let mut lines = text.lines().map(|line| serde_json::from_str::<serde_json::Value>(line).expect("JSON"));
        let start = lines.next().expect("a start");
        assert_eq!(start["start"]["protocol"], 1);
        assert_eq!(start["start"]["machine"], "aspect-acceptance");
        assert_eq!(start["start"]["config"], trace.config);
        let config = config(trace);
        let mut state = State::<16>::INITIAL;
        for _ in &trace.steps {
            let input = lines.next().expect("a step");
            let km_h = km_h(&input["step"]["detected_km_h"]);
            assert!(km_h.iter().all(|speed| config.aspects_km_h.contains(&Kmh(i32::from(*speed) * 10))));
            let (next, display) = step(times(&config), state, detected(&km_h));
            state = next;
            let expected = display.aspect().map(|aspect| ASPECTS_KM_H[usize::from(aspect.rank())]);
            let output = lines.next().expect("an output");
            assert_eq!(output["output"]["display_km_h"], serde_json::json!(expected));
        }
        assert_eq!(lines.next(), None);
        assert_eq!(
            serde_json::from_str::<Trace>(&serde_json::to_string(trace).expect("JSON")).expect("a trace"),
            *trace
        );
    }
}

/// The protocol's machine reads what the model's kernel read, and answers as it did: in every field that the trace has.
#[test]
fn the_oracle_agrees_with_every_trace() {
    let mut steps = 0;
    for outcome in OUTCOMES.iter() {
        let found = outcome.properties.iter().filter_map(|property| property.trace.as_ref());
        for trace in found.chain(outcome.cut_sets.iter().map(|cut| &cut.trace)) {
            let mut session = Session::new();
            let mut answer = |line: &str| {
                let mut reply = Vec::new();
                session.answer(line.as_bytes(), &mut reply);
                serde_json::from_slice::<Value>(&reply).expect("JSON")
            };
            let text = trace.trace_jsonl();
            let (asked, told): (Vec<_>, Vec<_>) = text.lines().partition(|line| !line.starts_with("{\"output\""));
            assert_eq!((asked.len(), told.len()), (trace.steps.len() + 1, trace.steps.len()), "{}", outcome.model);
            let replies: Vec<_> = asked.into_iter().map(&mut answer).collect();
            assert!(replies[0]["started"].is_object(), "{}: {}", outcome.model, replies[0]);
            for (reply, step) in replies[1..].iter().zip(&trace.steps) {
                for (field, told) in step.output.as_object().expect("an output") {
                    assert_eq!(&reply["output"][field], told, "{}: {field}", outcome.model);
                }
                steps += 1;
            }
        }
    }
    assert!(steps > 5000, "{steps} steps");
}
